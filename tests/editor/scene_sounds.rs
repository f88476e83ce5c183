//! Sounds of a scene: which are read, and the messages about them.

use crate::scene_bench::{FOXES, scene};
use crate::scene_script::{put_cursor, type_text};
use crate::workbench::{Window, Workbench};
use dragonfly::app::scene_sounds::{SceneSoundAnswer, SceneSoundLoader};
use dragonfly::panels::scene::{SceneRequest, SceneSound};
use dragonfly::panels::{Request, State};
use dragonfly_document::{Cancel, DocumentMessage, FileView, SoundPeaks, SoundSource, View};
use dragonfly_kit::folder::Folder;
use dragonfly_runtime::{Address, Context, Receiver, Thread};
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::sync::{Arc, mpsc};
use std::time::Duration;

/// The foxes with a thunder of half a second at one second, twice, and one that is missing.
pub(crate) fn thunder() -> String {
    let sounds =
        "<sound src=\"thunder.wav\" begin=\"1\" repeat=\"2\"/>\n    <sound src=\"none.wav\" begin=\"2\"/>";
    FOXES.replace("    <title", &format!("    {sounds}\n    <title"))
}

/// Returns the peaks of half a second of full loudness.
pub(crate) fn peaks() -> SoundPeaks {
    let folder = Folder::new("scene-sound");
    let path = folder.join("thunder.wav");
    write_thunder(&path);
    SoundSource::File(path).peaks(&Cancel::default()).expect("a sound")
}

pub(crate) fn write_thunder(path: &Path) {
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: 8000,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut writer = hound::WavWriter::create(path, spec).expect("a file");
    (0..4000)
        .for_each(|at| writer.write_sample(if at % 2 == 0 { i16::MAX } else { i16::MIN }).expect("a sample"));
    writer.finalize().expect("a file");
}

/// Longer than a sound takes to be read on a busy machine.
pub(crate) const LIMIT: Duration = Duration::from_secs(30);

/// Passes what it receives on to a test.
pub(crate) struct Forward<M>(mpsc::Sender<M>);

impl<M: Send + 'static> Receiver for Forward<M> {
    type Message = M;

    fn receive(&mut self, message: M, _: &mut Context) {
        // The test may be over.
        let _ = self.0.send(message);
    }
}

/// Returns a thread with an address whose messages come to the test.
pub(crate) fn forwarding<M: Send + 'static>() -> (Thread, Address<M>, mpsc::Receiver<M>) {
    let (sender, messages) = mpsc::channel();
    let thread = Thread::start("test").expect("a thread");
    let address = thread.handle().register_receiver(move |_| Forward(sender));
    (thread, address, messages)
}

/// Says that the scene is a file in a folder.
pub(crate) fn move_to(bench: &mut Workbench, folder: &Folder) {
    let view = bench.state.read().view.cloned().expect("a view");
    let file = FileView { path: Some(folder.join("scene.xml")), ..FileView::clone(&view.file) };
    bench.state.show(View { file: Arc::new(file), generation: view.generation + 1, ..view });
}

/// Reads all sounds of a scene that are wanted. Returns the messages for the document.
fn read_all(
    loader: &mut SceneSoundLoader,
    state: &mut State,
    (address, answers): (&Address<SceneSoundAnswer>, &mpsc::Receiver<SceneSoundAnswer>),
) -> Vec<DocumentMessage> {
    let mut messages = Vec::new();
    loader.update(state, address);
    let is_read = |state: &State, name: &str| {
        !matches!(state.read().scene_editing.sounds().get(name), None | Some(SceneSound::Reading))
    };
    let names = |state: &State| -> Vec<String> {
        let plan = state.read().scene().and_then(|scene| scene.plan.clone()).expect("a plan");
        plan.sounds().iter().map(|sound| sound.source.to_string()).collect()
    };
    while names(state).iter().any(|name| !is_read(state, name)) {
        let answer = answers.recv_timeout(LIMIT).expect("each sound is answered");
        messages.extend(loader.receive(state, answer));
        loader.update(state, address);
    }
    messages
}

/// Returns what is known of a sound: `reading`, `read`, or the reason why it cannot be read.
fn known(state: &State, name: &str) -> String {
    match state.read().scene_editing.sounds().get(name) {
        None => "nothing".to_owned(),
        Some(SceneSound::Reading) => "reading".to_owned(),
        Some(SceneSound::Read(_)) => "read".to_owned(),
        Some(SceneSound::Problem(reason)) => reason.to_string(),
    }
}

#[cfg(unix)]
#[test]
fn a_sound_that_is_a_pipe_or_outside_of_the_folder_is_refused_and_the_others_are_read() {
    let (folder, outside) = (Folder::new("scene-pipe"), Folder::new("scene-outside"));
    let made = std::process::Command::new("mkfifo").arg(folder.join("pipe.wav")).status().expect("mkfifo");
    assert!(made.success());
    write_thunder(&outside.join("thunder.wav"));
    write_thunder(&folder.join("thunder.wav"));
    std::os::unix::fs::symlink(outside.join("thunder.wav"), folder.join("link.wav")).expect("a link");
    let sound = |name: &str| format!("    <sound src=\"{name}\"/>\n");
    let sounds: String = ["pipe.wav", "link.wav", "thunder.wav"].map(sound).concat();
    let mut bench = scene(&FOXES.replace("    <title", &format!("{sounds}    <title")));
    move_to(&mut bench, &folder);
    let (_thread, address, answers) = forwarding();
    let messages = read_all(&mut SceneSoundLoader::default(), &mut bench.state, (&address, &answers));
    let below = |name: &str| SoundSource::Below { folder: folder.path().to_owned(), name: name.to_owned() };
    let lengths = [("pipe.wav", None), ("link.wav", None), ("thunder.wav", Some(0.5))];
    let lengths = lengths.map(|(name, seconds)| (below(name), seconds)).to_vec();
    assert_eq!(messages, [DocumentMessage::SoundsRead(lengths)], "the document is sent all lengths at once");
    let known = |name: &str| known(&bench.state, name);
    assert_eq!(known("pipe.wav"), "pipe.wav is a pipe, not a regular file");
    assert_eq!(known("link.wav"), "link.wav leads out of the model's folder");
    assert_eq!(known("thunder.wav"), "read");
}

#[test]
fn a_name_that_is_being_typed_is_read_when_it_is_complete_and_without_messages() {
    let folder = Folder::new("scene-typed");
    write_thunder(&folder.join("thunder.wav"));
    let script = FOXES.replace("    <title", "    <sound src=\"t\"/>\n    <title");
    let mut window = scene(&script).window();
    move_to(window.state_mut(), &folder);
    let (_thread, address, answers) = forwarding();
    let mut loader = SceneSoundLoader::default();
    let mut read = |window: &mut Window| {
        read_all(&mut loader, &mut window.state_mut().state, (&address, &answers));
        window.run_steps(2);
    };
    read(&mut window);
    assert_eq!(known(&window.state().state, "t"), "t does not exist");
    put_cursor(&mut window, script.find("src=\"t").expect("a sound") + 6);
    let mut typed = String::from("t");
    let mut idle = SceneSoundLoader::default();
    for letter in "hunder".chars() {
        type_text(&mut window, &letter.to_string());
        typed.push(letter);
        idle.update(&mut window.state_mut().state, &address);
        assert_eq!(known(&window.state().state, &typed), "nothing", "{typed} is a part of a name");
    }
    type_text(&mut window, ".wav");
    // More than the second after which a word is over.
    window.run_steps(90);
    read(&mut window);
    assert_eq!(known(&window.state().state, "thunder.wav"), "read");
    assert_eq!(known(&window.state().state, "t"), "nothing", "the script does not name it any more");
    let lines: Vec<String> =
        window.state().state.read().status.lines().map(|message| message.text.clone()).collect();
    assert!(!lines.iter().any(|line| line.contains("No sound")), "{lines:?}");
}

#[test]
fn a_sound_that_could_not_be_read_is_read_again_when_its_file_may_be_there() {
    let folder = Folder::new("scene-later");
    let mut bench = scene(&FOXES.replace("    <title", "    <sound src=\"thunder.wav\"/>\n    <title"));
    move_to(&mut bench, &folder);
    let (thread, address, answers) = forwarding();
    let mut loader = SceneSoundLoader::default();
    read_all(&mut loader, &mut bench.state, (&address, &answers));
    assert_eq!(known(&bench.state, "thunder.wav"), "thunder.wav does not exist");
    write_thunder(&folder.join("thunder.wav"));
    // As the program does when its window is used again.
    bench.state.scene_sounds().look_again();
    read_all(&mut loader, &mut bench.state, (&address, &answers));
    assert_eq!(known(&bench.state, "thunder.wav"), "read");
    bench.state.scene_sounds().receive("thunder.wav", Err("damaged".to_owned()));
    bench.state.scene_sounds().look_again();
    // No job is started for a thread that has ended.
    drop(thread);
    loader.update(&mut bench.state, &address);
    let reason = known(&bench.state, "thunder.wav");
    assert!(reason.starts_with("thunder.wav: ") && reason.contains("stopped"), "{reason}");
}

#[test]
fn a_sound_is_read_again_when_its_file_changed_or_the_scene_is_in_another_folder() {
    let (folder, other) = (Folder::new("scene-changed"), Folder::new("scene-moved"));
    let mut bench = scene(&FOXES.replace("    <title", "    <sound src=\"thunder.wav\"/>\n    <title"));
    move_to(&mut bench, &folder);
    let path = folder.join("thunder.wav");
    write_thunder(&path);
    let (_thread, address, answers) = forwarding();
    let mut loader = SceneSoundLoader::default();
    let mut again = |state: &mut State| {
        state.scene_sounds().look_again();
        loader.update(state, &address);
        let answer = answers.recv_timeout(LIMIT).expect("the sound is looked at");
        loader.receive(state, answer)
    };
    let length = |folder: &Folder, seconds: Option<f64>| {
        let source = SoundSource::Below { folder: folder.path().to_owned(), name: "thunder.wav".to_owned() };
        Some(DocumentMessage::SoundsRead(vec![(source, seconds)]))
    };
    assert_eq!(again(&mut bench.state), length(&folder, Some(0.5)));
    assert_eq!(again(&mut bench.state), None, "the file is as it was");
    assert_eq!(known(&bench.state, "thunder.wav"), "read");
    // Another program writes twice as much.
    let twice = std::fs::read(&path).expect("a sound");
    let spec = hound::WavReader::new(&*twice).expect("a sound").spec();
    let mut writer = hound::WavWriter::create(&path, spec).expect("a file");
    (0..8000).for_each(|_| writer.write_sample(i16::MAX).expect("a sample"));
    writer.finalize().expect("a file");
    assert_eq!(again(&mut bench.state), length(&folder, Some(1.0)));
    std::fs::remove_file(&path).expect("a file");
    assert_eq!(again(&mut bench.state), length(&folder, None), "its length is not known any more");
    write_thunder(&other.join("thunder.wav"));
    move_to(&mut bench, &other);
    assert_eq!(again(&mut bench.state), length(&other, Some(0.5)));
    write_thunder(&path);
    move_to(&mut bench, &folder);
    assert_eq!(again(&mut bench.state), length(&folder, Some(0.5)), "what was read elsewhere does not count");
}

#[test]
fn each_sound_of_a_scene_is_wanted_once() {
    let mut bench = scene(&thunder());
    let wanted = |bench: &crate::workbench::Workbench| {
        let read = bench.state.read();
        let plan = read.scene().and_then(|scene| scene.plan.clone()).expect("a plan");
        read.scene_editing.sounds().wanted(&plan).map(str::to_owned)
    };
    assert_eq!(wanted(&bench).as_deref(), Some("thunder.wav"));
    bench.state.scene_sounds().begin("thunder.wav");
    assert_eq!(wanted(&bench).as_deref(), Some("none.wav"));
    bench.state.scene_sounds().receive("none.wav", Err("none.wav: not found".to_owned()));
    assert_eq!(wanted(&bench), None);
    let opened = bench.state.read().scene_editing.sounds().opened();
    bench.state.show(dragonfly_kit::document::fixture::full());
    assert!(bench.state.read().scene_editing.sounds().opened() > opened, "earlier answers mean nothing");
}

/// Returns the times from and to which waveforms are drawn in the lanes, seconds; `None` without one.
fn drawn(window: &Window) -> Option<[f32; 2]> {
    let canvas = window.query_by_label_contains("Lanes of the scene").expect("lanes").rect();
    // The lanes have a margin of 16 points before the start and after the end.
    let (left, width) = (canvas.left() + 16.0, canvas.width() - 32.0);
    let shown = window.state().state.read().scene_editing.window();
    let meshes = window.output().shapes.iter().filter_map(|shape| match &shape.shape {
        egui::Shape::Mesh(mesh) => Some(mesh),
        _ => None,
    });
    let points = meshes.flat_map(|mesh| mesh.vertices.iter().map(|vertex| vertex.pos));
    let times = points
        .filter(|at| canvas.contains(*at))
        .map(|at| shown.start as f32 + (at.x - left) / width * shown.length as f32);
    let [from, to] = times.fold([f32::MAX, f32::MIN], |[from, to], time| [from.min(time), to.max(time)]);
    (from <= to).then_some([from, to])
}

#[test]
fn the_bar_of_a_sound_has_its_waveform_as_often_as_it_repeats() {
    let mut window = scene(&thunder()).window();
    assert_eq!(drawn(&window), None, "nothing is known of the sound");
    window.state_mut().state.scene_sounds().receive("thunder.wav", Ok(peaks()));
    window.run_steps(2);
    // Two times half a second from one second on; the bar is longer.
    let [from, to] = drawn(&window).expect("a waveform");
    assert!((from - 1.0).abs() < 0.02 && (to - 2.0).abs() < 0.02, "from {from} to {to} s");
}

/// Returns the triangles of all waveforms in the lanes.
fn waveforms(window: &Window) -> Vec<Arc<egui::Mesh>> {
    let canvas = window.query_by_label_contains("Lanes of the scene").expect("lanes").rect();
    let meshes = window.output().shapes.iter().filter_map(|shape| match &shape.shape {
        egui::Shape::Mesh(mesh) if mesh.vertices.iter().any(|vertex| canvas.contains(vertex.pos)) => {
            Some(mesh)
        }
        _ => None,
    });
    meshes.cloned().collect()
}

#[test]
fn a_waveform_is_computed_only_when_something_of_it_changed() {
    let mut window = scene(&thunder()).window();
    window.state_mut().state.scene_sounds().receive("thunder.wav", Ok(peaks()));
    window.run_steps(2);
    let first = waveforms(&window);
    assert_eq!(first.len(), 1);
    window.state_mut().state.execute(Request::Seek(1.5));
    window.run_steps(2);
    assert!(Arc::ptr_eq(&first[0], &waveforms(&window)[0]), "the playhead moves over it");
    let shown = window.state().state.read().scene_editing.window();
    let closer = dragonfly::panels::keys::TimeWindow { length: 0.5 * shown.length, ..shown };
    window.state_mut().state.execute(Request::Scene(SceneRequest::Window(Some(closer))));
    window.run_steps(2);
    let closer = waveforms(&window);
    assert!(closer.len() == 1 && !Arc::ptr_eq(&first[0], &closer[0]), "another part of time is shown");
    assert!(closer[0].vertices.len() > first[0].vertices.len());
}
