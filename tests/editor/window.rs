//! The whole program as the user meets it: a real window on a private screen, driven by keys and mouse.

use crate::program::{dragonfly, dragonfly_with_faults, threads, wait};
use crate::screen::{Screen, Window, key, pass};
use dragonfly_kit::folder::{Folder, data};
use dragonfly_kit::picture::complaints;
use image::RgbaImage;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, ExitStatus, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Timeout that no operation reaches, even on a busy machine that renders on the CPU.
pub(crate) const SOON: Duration = Duration::from_secs(60);

/// Center of the viewport in a window of 1280 × 720: left, top, width, height.
const VIEWPORT: [u32; 4] = [320, 90, 680, 360];

/// Positions of 0.67 and 2.00 seconds on the ruler of Fox's first take, and of the button that plays and pauses.
const EARLY: (i16, i16) = (308, 533);
const LATE: (i16, i16) = (508, 533);
const PLAY: (i16, i16) = (124, 507);

/// Command line switches of the program with injected faults.
const FAULT_SWITCHES: [&str; 5] = ["--edits", "--fail-at", "--fail", "--lose-device", "--never-pause"];

/// Lock that allows one window at a time: two of them on two cores only slow each other down.
static ONE: Mutex<()> = Mutex::new(());

pub(crate) fn alone() -> MutexGuard<'static, ()> {
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A running editor process.
pub(crate) struct Editor {
    child: Child,
    said: Receiver<String>,
    pub(crate) lines: Vec<String>,
    pub(crate) window: Window,
    /// Environment variables of the process.
    variables: Vec<String>,
    _settings: Folder,
}

impl Editor {
    /// Starts it with Fox, and waits until the model is loaded.
    pub(crate) fn open(screen: &mut Screen, arguments: &[&str], environment: &[(&str, &str)]) -> Self {
        let mut editor = Self::open_file(screen, &data("gltf/Fox.glb"), arguments, environment);
        editor.window = screen.window("Fox.glb", SOON);
        screen.focus(editor.window);
        // The mouse pointer would be part of the screenshot.
        screen.point(i16::MAX, i16::MAX);
        editor
    }

    /// Starts it with any file, and waits until the model is loaded, without looking for its window.
    pub(crate) fn open_file(
        screen: &mut Screen,
        file: &Path,
        arguments: &[&str],
        environment: &[(&str, &str)],
    ) -> Self {
        // A previous process is dropped only after the next one has started.
        static STARTS: AtomicUsize = AtomicUsize::new(0);
        let settings = Folder::new(&format!("settings-{}", STARTS.fetch_add(1, Ordering::Relaxed)));
        let faults = arguments.iter().any(|argument| FAULT_SWITCHES.contains(argument));
        let mut program = if faults { dragonfly_with_faults(arguments) } else { dragonfly(arguments) };
        if !arguments.contains(&"--settings") {
            program.arg("--settings").arg(settings.path());
        }
        let mut child = program
            .arg(file)
            .env("DISPLAY", screen.display())
            .env("XDG_RUNTIME_DIR", settings.path())
            .env("DRAGONFLY_LOG", "error,dragonfly=info")
            .envs(environment.iter().copied())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let (sender, said) = channel();
        let stderr = BufReader::new(child.stderr.take().expect("piped"));
        let read = move || stderr.lines().map_while(Result::ok).try_for_each(|line| sender.send(line));
        std::thread::Builder::new().name("reader".to_owned()).spawn(read).expect("a thread");
        let variables = environment.iter().map(|(name, _)| (*name).to_owned()).collect();
        let mut editor = Self { child, said, lines: Vec::new(), window: 0, variables, _settings: settings };
        editor.wait_for_log("Opened ", 1, SOON);
        screen.program = Some(editor.child.id());
        editor
    }

    /// Waits until the log contains `times` lines with `word`.
    #[track_caller]
    pub(crate) fn wait_for_log(&mut self, word: &str, times: usize, limit: Duration) {
        let deadline = Instant::now() + limit;
        loop {
            let count = self.lines.iter().filter(|line| line.contains(word)).count();
            if count >= times {
                return;
            }
            match self.said.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
                Ok(line) => self.lines.push(line),
                Err(RecvTimeoutError::Timeout) => {
                    println!("{}", threads(self.process()));
                    panic!("\"{word}\" was said {count} of {times} times within {limit:?}:\n{}", self.log());
                }
                Err(RecvTimeoutError::Disconnected) => panic!("the program ended:\n{}", self.log()),
            }
        }
    }

    /// Reads the log lines written so far.
    pub(crate) fn listen(&mut self) {
        self.lines.extend(self.said.try_iter());
    }

    pub(crate) fn log(&mut self) -> String {
        self.lines.extend(self.said.try_iter());
        self.lines.join("\n")
    }

    /// Waits until the process exits by itself.
    #[track_caller]
    pub(crate) fn ends(&mut self, limit: Duration) -> ExitStatus {
        let status = wait(&mut self.child, limit);
        self.listen_to_the_end();
        status
    }

    /// Reads the log to its last line.
    fn listen_to_the_end(&mut self) {
        while let Ok(line) = self.said.recv() {
            self.lines.push(line);
        }
    }

    /// Returns the process id.
    pub(crate) fn process(&self) -> u32 {
        self.child.id()
    }

    /// Kills the process, as the system does with one that does not react.
    pub(crate) fn kill(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }

    /// Returns the processor time used so far, in hundredths of a second.
    fn processor_time(&self) -> u64 {
        let stat =
            std::fs::read_to_string(format!("/proc/{}/stat", self.child.id())).expect("a running process");
        let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
        fields[11].parse::<u64>().expect("a number") + fields[12].parse::<u64>().expect("a number")
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
        self.listen_to_the_end();
        if std::thread::panicking() {
            eprintln!("what the editor said:\n{}", self.log());
        } else {
            complaints::none_in(&self.log(), self.variables.iter().map(OsStr::new));
        }
    }
}

/// Returns the image of a part of the screen once it no longer changes and the program is idle: on a busy machine the
/// image can stay unchanged for a second only because the program was not scheduled.
#[track_caller]
pub(crate) fn settled(screen: &Screen, part: [u32; 4]) -> RgbaImage {
    let deadline = Instant::now() + SOON;
    let mut last = screen.part(part);
    let mut since = Instant::now();
    while since.elapsed() < Duration::from_millis(900) {
        if Instant::now() > deadline {
            screen.keep("restless");
            panic!("the picture did not come to rest within {SOON:?}");
        }
        pass(Duration::from_millis(100));
        let now = screen.part(part);
        if now != last || screen.program.is_some_and(works) {
            (last, since) = (now, Instant::now());
        }
    }
    last
}

/// Returns whether a thread of this program runs or waits for a processor.
fn works(program: u32) -> bool {
    let threads = std::fs::read_dir(format!("/proc/{program}/task")).into_iter().flatten().flatten();
    let stat = |thread: std::fs::DirEntry| std::fs::read_to_string(thread.path().join("stat")).ok();
    // The state follows the name, which is in brackets and may contain any character.
    threads.filter_map(stat).any(|stat| {
        stat.rsplit(')').next().is_some_and(|rest| rest.starts_with(" R") || rest.starts_with(" D"))
    })
}

/// Returns the number of different colors: a blank or broken image has few.
pub(crate) fn colors(picture: &RgbaImage) -> usize {
    picture.pixels().collect::<std::collections::HashSet<_>>().len()
}

/// Compares images without printing a million numbers when they differ.
#[track_caller]
pub(crate) fn same(screen: &Screen, now: &RgbaImage, before: &RgbaImage, otherwise: &str) {
    let different = now.pixels().zip(before.pixels()).filter(|(now, before)| now != before).count();
    if different > 0 || now.dimensions() != before.dimensions() {
        screen.keep("another-picture");
        panic!("{otherwise}: {different} of {} pixels differ", now.pixels().len());
    }
}

#[track_caller]
pub(crate) fn eventually_shows_something(screen: &Screen) {
    let deadline = Instant::now() + SOON;
    while colors(&screen.part(VIEWPORT)) < 200 {
        if Instant::now() > deadline {
            screen.keep("nothing");
            panic!("the viewport shows nothing");
        }
        pass(Duration::from_millis(100));
    }
}

/// Pauses, and goes to the first frame with the keyboard.
pub(crate) fn rest(screen: &mut Screen, part: [u32; 4]) -> RgbaImage {
    screen.press(key::SPACE);
    screen.press(key::HOME);
    settled(screen, part)
}

#[test]
fn a_model_opens_plays_scrubs_pauses_and_closes_cleanly() {
    let _one = alone();
    let mut screen = Screen::new("life", 1280, 800);
    let mut editor = Editor::open(&mut screen, &[], &[]);
    eventually_shows_something(&screen);

    // The model plays as soon as it is opened.
    let before = screen.part(VIEWPORT);
    pass(Duration::from_millis(500));
    // Half a second is enough for a program that is scheduled.
    let deadline = Instant::now() + SOON;
    while screen.program.is_some_and(works) && before == screen.part(VIEWPORT) && Instant::now() < deadline {
        pass(Duration::from_millis(100));
    }
    assert!(before != screen.part(VIEWPORT), "the picture did not change within half a second");

    // A click on the timeline changes the pose, to the same one each time.
    screen.click(PLAY.0, PLAY.1);
    screen.click(LATE.0, LATE.1);
    let late = settled(&screen, VIEWPORT);
    screen.click(EARLY.0, EARLY.1);
    let early = settled(&screen, VIEWPORT);
    assert!(late != early, "a click on the timeline did not move the pose");
    screen.click(LATE.0, LATE.1);
    same(&screen, &settled(&screen, VIEWPORT), &late, "the same time shows another pose");

    // While paused it uses no processor time, once the last message has passed.
    let deadline = Instant::now() + SOON;
    loop {
        let used = editor.processor_time();
        pass(Duration::from_secs(2));
        let used = editor.processor_time() - used;
        if used < 10 {
            break;
        }
        assert!(Instant::now() < deadline, "{used} hundredths of a second of work in two seconds of rest");
    }

    // It exits when asked, quickly, in order, without warnings.
    screen.close(editor.window);
    let asked = Instant::now();
    let status = editor.ends(Duration::from_secs(20));
    assert!(asked.elapsed() < Duration::from_secs(2), "closing took {:?}", asked.elapsed());
    assert_eq!(status.code(), Some(0), "{}", editor.log());
    let log = editor.log();
    let complaints: Vec<&str> =
        log.lines().filter(|line| line.contains("WARN") || line.contains("ERROR")).collect();
    assert!(complaints.is_empty(), "{complaints:?}");
    let steps: Vec<usize> = log
        .lines()
        .filter(|line| line.contains("dragonfly::timeline"))
        .filter_map(|line| line.split("step=").nth(1)?.split_whitespace().next()?.parse().ok())
        .collect();
    assert_eq!(steps, (1..=11).collect::<Vec<_>>(), "the steps of start and stop\n{log}");
}

#[test]
fn a_hundred_device_losses_lose_no_data() {
    let _one = alone();
    let mut screen = Screen::new("losses", 1280, 800);
    let whole = {
        let mut editor = Editor::open(&mut screen, &[], &[]);
        eventually_shows_something(&screen);
        let whole = rest(&mut screen, VIEWPORT);
        screen.close(editor.window);
        assert_eq!(editor.ends(SOON).code(), Some(0));
        whole
    };
    let mut editor = Editor::open(&mut screen, &["--lose-device", "1"], &[]);
    editor.wait_for_log("the graphics device was lost", 100, 4 * SOON);
    let after = rest(&mut screen, VIEWPORT);
    same(&screen, &after, &whole, "a hundred losses changed the picture");
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}

#[test]
fn resizing_and_hiding_the_window_does_not_stop_the_program() {
    let _one = alone();
    let mut screen = Screen::new("sizes", 1280, 800);
    let mut editor = Editor::open(&mut screen, &[], &[]);
    eventually_shows_something(&screen);
    let whole = rest(&mut screen, VIEWPORT);
    let seed = dragonfly_kit::random::seed(7);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = dragonfly_kit::random::Random::new(seed);
    for step in 0..1000 {
        let (width, height) = match step % 50 {
            0 => (1, 1),
            10 => (16_384, 2),
            20 => (2, 16_384),
            _ => (1 + random.below(1500) as u32, 1 + random.below(1000) as u32),
        };
        screen.resize(editor.window, width, height);
        if step % 40 == 7 {
            screen.show(editor.window, false);
            screen.show(editor.window, true);
        }
        // Now and then the window gets the time to draw in its current size.
        if step % 20 == 19 {
            pass(Duration::from_millis(60));
        }
    }
    screen.show(editor.window, true);
    screen.resize(editor.window, 1280, 720);
    same(&screen, &settled(&screen, VIEWPORT), &whole, "many sizes changed the picture");
    screen.focus(editor.window);
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("ERROR"), "{}", editor.log());
}

#[test]
fn destroying_the_window_from_outside_ends_the_program_without_a_crash() {
    let _one = alone();
    let mut screen = Screen::new("destroyed", 1280, 800);
    // The window is destroyed before anything was drawn, and after, while it plays.
    for shown in [false, true, false, true, true] {
        let mut editor = Editor::open(&mut screen, &[], &[]);
        if shown {
            eventually_shows_something(&screen);
        }
        screen.destroy(editor.window);
        let status = editor.ends(SOON);
        let log = editor.log();
        assert_eq!(status.code(), Some(3), "{status}: {log}");
        assert!(log.contains("the window was destroyed by another program"), "{log}");
        assert!(log.contains("step=10") && !log.contains("panic"), "{log}");
    }
}

/// Checks only that the program ends: Xlib itself exits when its server is gone, in the middle of any other thread's
/// work, and safe code cannot change that. Usually the exit code is 1, but a driver that is drawing can end the program
/// by a signal instead.
#[test]
fn the_program_ends_when_its_x_server_dies() {
    let _one = alone();
    let mut screen = Screen::new("gone", 1280, 800);
    let mut editor = Editor::open(&mut screen, &[], &[]);
    eventually_shows_something(&screen);
    screen.kill();
    let status = editor.ends(SOON);
    assert_ne!(status.code(), Some(0), "the program must report an error when its screen is gone");
}
