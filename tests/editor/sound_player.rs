//! Sounds play along the playhead, once their samples are read.

use crate::scene_bench::{FOXES, scene};
use crate::scene_lines::run;
use crate::scene_sounds::{LIMIT, forwarding, move_to, peaks, thunder, write_thunder};
use crate::workbench::Workbench;
use dragonfly::app::sound_player::{SamplesAnswer, SoundPlayer};
use dragonfly::panels::commands::Id;
use dragonfly::panels::sound::SoundSettings;
use dragonfly::panels::status::MessageSeverity;
use dragonfly::panels::{Request, State};
use dragonfly_document::SoundSource;
use dragonfly_kit::folder::Folder;
use dragonfly_runtime::{Address, Thread};
use dragonfly_sound::{OutputError, OutputVoice, SoundOutput};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::mpsc;
use std::time::Duration;

/// A player whose device is the test.
struct PlayerBench {
    player: SoundPlayer,
    voice: Rc<RefCell<Option<OutputVoice>>>,
    address: Address<SamplesAnswer>,
    answers: mpsc::Receiver<SamplesAnswer>,
    _thread: Thread,
}

impl PlayerBench {
    fn new() -> Self {
        let voice = Rc::new(RefCell::new(None));
        let to = Rc::clone(&voice);
        let player = SoundPlayer::with_output(move || {
            let (output, voice) = SoundOutput::without_device();
            *to.borrow_mut() = Some(voice);
            Ok(output)
        });
        let (thread, address, answers) = forwarding();
        Self { player, voice, address, answers, _thread: thread }
    }

    fn update(&mut self, state: &mut State) {
        self.player.update(state, &self.address);
    }

    /// Waits for samples that are being read.
    fn read(&mut self, state: &mut State) {
        let answer = self.answers.recv_timeout(LIMIT).expect("samples");
        self.player.receive(state, answer);
        self.update(state);
    }

    /// Returns how loud it is when the playhead is at `time`, seconds: the mean of the magnitudes of a twentieth of a second.
    fn loudness(&mut self, state: &State, time: f64) -> f32 {
        let clock = state.read().playback;
        let ahead = (time - clock.anchor_time) / f64::from(clock.speed);
        let at = clock.anchor + Duration::from_secs_f64(ahead);
        let mut frames = vec![[0.0; 2]; 2_400];
        let mut voice = self.voice.borrow_mut();
        voice.as_mut().expect("an open device").fill(at, 48_000, &mut frames);
        frames.iter().map(|frame| frame[0].abs()).sum::<f32>() / 2_400.0
    }
}

/// Returns the scene with a thunder, whose file is in `folder`.
fn thunder_in(folder: &Folder) -> Workbench {
    write_thunder(&folder.join("thunder.wav"));
    let mut bench = scene(&thunder());
    move_to(&mut bench, folder);
    bench
}

#[test]
fn the_sounds_of_a_scene_play_where_its_script_has_them_until_playback_stops() {
    let folder = Folder::new("scene-audible");
    let mut bench = thunder_in(&folder);
    bench.state.scene_sounds().receive("thunder.wav", Ok(peaks()));
    bench.state.scene_sounds().receive("none.wav", Err("it is missing".to_owned()));
    let mut window = bench.window();
    let mut player = PlayerBench::new();
    player.update(&mut window.state_mut().state);
    assert!(player.voice.borrow().is_none(), "no device is opened before something plays");
    run(&mut window, Id::PlayPause);
    let state = &mut window.state_mut().state;
    player.update(state);
    assert_eq!(player.loudness(state, 1.2), 0.0, "its samples are not read yet");
    player.read(state);
    for (time, is_loud) in [(0.5, false), (1.2, true), (1.7, true), (2.3, false)] {
        assert_eq!(player.loudness(state, time) > 0.2, is_loud, "{time} s");
    }
    run(&mut window, Id::PlayPause);
    let state = &mut window.state_mut().state;
    player.update(state);
    assert_eq!(player.loudness(state, 1.2), 0.0);
    // The samples are still in memory.
    run(&mut window, Id::PlayPause);
    let state = &mut window.state_mut().state;
    player.update(state);
    assert!(player.loudness(state, 1.2) > 0.2);
}

#[test]
fn the_sound_of_a_take_plays_from_its_frame_on() {
    let folder = Folder::new("take-audible");
    let file = folder.join("thunder.wav");
    write_thunder(&file);
    let mut bench = Workbench::full();
    bench.state.execute(Request::FrameRate(24));
    bench.state.execute(Request::Sound(SoundSettings { file: file.clone(), start: 12 }));
    bench.state.sound().read(Ok(peaks()));
    let mut window = bench.window();
    run(&mut window, Id::PlayPause);
    let mut player = PlayerBench::new();
    let state = &mut window.state_mut().state;
    player.update(state);
    player.read(state);
    for (time, is_loud) in [(0.3, false), (0.6, true), (0.9, true)] {
        assert_eq!(player.loudness(state, time) > 0.2, is_loud, "{time} s");
    }
}

#[test]
fn without_a_device_one_message_explains_the_silence_of_sounds() {
    let tries = Rc::new(Cell::new(0));
    let counted = Rc::clone(&tries);
    let mut player = SoundPlayer::with_output(move || {
        counted.set(counted.get() + 1);
        Err(OutputError::Device("there is no audio device".to_owned()))
    });
    let (_thread, address, _answers) = forwarding();
    let said =
        |state: &State| state.read().status.last().map(|message| message.text.clone()).unwrap_or_default();
    let mut silent = scene(FOXES).window();
    run(&mut silent, Id::PlayPause);
    player.update(&mut silent.state_mut().state, &address);
    assert_eq!(tries.get(), 0, "a scene without sounds");
    let folder = Folder::new("scene-silent");
    let mut bench = scene(&thunder());
    move_to(&mut bench, &folder);
    let mut window = bench.window();
    run(&mut window, Id::PlayPause);
    player.update(&mut window.state_mut().state, &address);
    let text = said(&window.state().state);
    assert!(text.contains("not played") && text.contains("no audio device"), "{text}");
    window.state_mut().state.say(MessageSeverity::Info, "something else");
    player.update(&mut window.state_mut().state, &address);
    assert_eq!((said(&window.state().state), tries.get()), ("something else".to_owned(), 1));
    // Another try with the next playback: the device may be there now.
    for _ in 0..2 {
        run(&mut window, Id::PlayPause);
        player.update(&mut window.state_mut().state, &address);
    }
    assert_eq!((said(&window.state().state), tries.get()), ("something else".to_owned(), 2));
}

#[test]
fn a_sound_that_cannot_be_played_is_named_and_the_others_play() {
    let folder = Folder::new("scene-some-audible");
    let mut bench = thunder_in(&folder);
    for name in ["thunder.wav", "none.wav"] {
        bench.state.scene_sounds().receive(name, Ok(peaks()));
    }
    let mut window = bench.window();
    run(&mut window, Id::PlayPause);
    let mut player = PlayerBench::new();
    let state = &mut window.state_mut().state;
    player.update(state);
    player.read(state);
    player.read(state);
    let text = state.read().status.last().map(|message| message.text.clone()).unwrap_or_default();
    assert!(text.contains("none.wav"), "{text}");
    assert!(player.loudness(state, 1.2) > 0.2);
    let missing = SoundSource::Below { folder: folder.path().to_owned(), name: "none.wav".to_owned() };
    assert!(missing.peaks(&dragonfly_document::Cancel::default()).is_err());
}

/// Returns how loud the device is, in two parts of a twentieth of a second after each other. Each call is a second after the one before.
fn next_loudness(player: &PlayerBench, calls: &Cell<u64>) -> [f32; 2] {
    calls.set(calls.get() + 1);
    let mut voice = player.voice.borrow_mut();
    let Some(voice) = voice.as_mut() else { return [0.0; 2] };
    let begun = std::time::Instant::now() + Duration::from_secs(calls.get());
    [0, 50].map(|after| {
        let mut frames = vec![[0.0; 2]; 2_400];
        voice.fill(begun + Duration::from_millis(after), 48_000, &mut frames);
        frames.iter().map(|frame| frame[0].abs()).sum::<f32>() / 2_400.0
    })
}

#[test]
fn a_short_piece_is_played_at_each_new_time_of_a_paused_playhead_unless_that_is_off() {
    let folder = Folder::new("scene-scrubbed");
    let mut bench = thunder_in(&folder);
    bench.state.scene_sounds().receive("thunder.wav", Ok(peaks()));
    bench.state.scene_sounds().receive("none.wav", Err("it is missing".to_owned()));
    let mut window = bench.window();
    let (mut player, calls) = (PlayerBench::new(), Cell::new(0));
    let scrub = |window: &mut crate::workbench::Window, player: &mut PlayerBench, time: f32| {
        window.state_mut().state.execute(Request::Seek(time));
        player.update(&mut window.state_mut().state);
    };
    player.update(&mut window.state_mut().state);
    assert!(player.voice.borrow().is_none(), "nothing was dragged");
    scrub(&mut window, &mut player, 1.1);
    player.read(&mut window.state_mut().state);
    assert_eq!(next_loudness(&player, &calls), [0.0; 2], "its samples were read meanwhile");
    scrub(&mut window, &mut player, 1.2);
    let [piece, after] = next_loudness(&player, &calls);
    assert!(piece > 0.2 && after == 0.0, "{piece} {after}");
    player.update(&mut window.state_mut().state);
    assert_eq!(next_loudness(&player, &calls), [0.0; 2], "the time is the same");
    scrub(&mut window, &mut player, 0.5);
    assert_eq!(next_loudness(&player, &calls), [0.0; 2], "no sound is there");
    run(&mut window, Id::ToggleScrubSounds);
    scrub(&mut window, &mut player, 1.3);
    assert_eq!(next_loudness(&player, &calls), [0.0; 2], "it is off");
}
