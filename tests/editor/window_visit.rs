//! A simulated user with a file in the real window, who sends keys and mouse input; the accessibility tree is read from
//! the log.

use crate::program::threads;
use crate::screen::{Screen, key};
use crate::stdio::StdioSession;
use crate::window::{Editor, SOON, eventually_shows_something};
use crate::window_bone_rotation::{ExpectedWindow, numbers, shown};
use dragonfly_kit::document::test_document::fox;
use dragonfly_kit::folder::{Folder, data};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Log filter with everything that the tests read.
const LOG: &str =
    "error,dragonfly=info,dragonfly::shown=debug,dragonfly::asked=debug,dragonfly::reader=debug";

/// A running editor, its screen, and the trace of its state.
pub(crate) struct Visit {
    // Dropped before its screen.
    pub(crate) editor: Editor,
    pub(crate) screen: Screen,
    /// A copy of Fox.
    pub(crate) file: PathBuf,
    pub(crate) folder: Folder,
    /// The newest accessibility data of each control.
    controls: BTreeMap<u64, Value>,
    /// Number of log lines that were read.
    read: usize,
    saved: usize,
}

fn start(screen: &mut Screen, folder: &Folder, file: &Path, more: &[&str]) -> Editor {
    let autosave = folder.join("autosave").display().to_string();
    let arguments = [&["--autosave", &autosave], more].concat();
    let mut editor = Editor::open_file(screen, file, &arguments, &[("DRAGONFLY_LOG", LOG)]);
    let title = file.file_name().expect("a file").to_string_lossy().into_owned();
    editor.window = screen.any_window(&[&title, &format!("• {title}")], SOON);
    screen.focus(editor.window);
    screen.point(i16::MAX, i16::MAX);
    editor
}

impl Visit {
    /// Opens a copy of Fox, pauses, and goes to the start.
    pub(crate) fn new(name: &str) -> Self {
        Self::with(name, &[])
    }

    /// Does the same as `new`, with more arguments.
    pub(crate) fn with(name: &str, more: &[&str]) -> Self {
        let folder = Folder::new(name);
        let file = fox(&folder);
        let mut screen = Screen::new(name, 1280, 800);
        let editor = start(&mut screen, &folder, &file, more);
        let mut visit = Self { editor, screen, file, folder, controls: BTreeMap::new(), read: 0, saved: 0 };
        eventually_shows_something(&visit.screen);
        visit.pause_at_start();
        visit
    }

    /// Opens a scene whose models are a copy of Fox.
    pub(crate) fn of_scene(name: &str, text: &str) -> Self {
        let folder = Folder::new(name);
        fox(&folder);
        let file = folder.join("scene.xml");
        std::fs::write(&file, text).unwrap();
        let mut screen = Screen::new(name, 1280, 800);
        let editor = start(&mut screen, &folder, &file, &[]);
        Self { editor, screen, file, folder, controls: BTreeMap::new(), read: 0, saved: 0 }
    }

    /// Opens a project, the first of these files, in a folder with a copy of Fox.
    pub(crate) fn of_project(name: &str, files: &[(&str, &str)]) -> Self {
        let folder = Folder::new(name);
        fox(&folder);
        for (name, text) in files {
            std::fs::write(folder.join(name), text).unwrap();
        }
        let file = folder.join(files[0].0);
        let mut screen = Screen::new(name, 1280, 800);
        let editor = start(&mut screen, &folder, &file, &[]);
        Self { editor, screen, file, folder, controls: BTreeMap::new(), read: 0, saved: 0 }
    }

    /// Starts the program again after it has ended, on a new screen if one is named.
    pub(crate) fn again(&mut self, screen: Option<&str>) {
        if let Some(name) = screen {
            self.screen = Screen::new(name, 1280, 800);
        }
        self.editor = start(&mut self.screen, &self.folder, &self.file, &[]);
        (self.controls, self.read, self.saved) = (BTreeMap::new(), 0, 0);
    }

    /// Pauses, and goes to the start.
    #[track_caller]
    pub(crate) fn pause_at_start(&mut self) {
        self.screen.press(key::SPACE);
        self.go_to_the_start();
    }

    /// Goes to the start of the take: the position of the playhead after unsaved work was restored.
    #[track_caller]
    pub(crate) fn go_to_the_start(&mut self) {
        self.screen.press(key::HOME);
        self.until_shown("time", "0.0");
    }

    /// Returns the newest value of a field in the state trace of the window.
    #[track_caller]
    pub(crate) fn shown(&mut self, field: &str) -> String {
        shown(&mut self.editor, field).expect("it is told")
    }

    /// Waits until `holds` returns a value.
    #[track_caller]
    pub(crate) fn until<T>(&mut self, what: &str, mut holds: impl FnMut(&mut Self) -> Option<T>) -> T {
        let deadline = Instant::now() + SOON;
        loop {
            self.listen();
            if let Some(found) = holds(self) {
                return found;
            }
            if Instant::now() > deadline {
                self.screen.keep("waiting");
                println!("{}", threads(self.editor.process()));
                panic!("never: {what}; there are {:?}", self.names());
            }
            std::thread::park_timeout(Duration::from_millis(20));
        }
    }

    /// Waits until a field of the state trace has this value.
    #[track_caller]
    pub(crate) fn until_shown(&mut self, field: &str, wanted: &str) {
        self.until(&format!("{field} = {wanted}"), |visit| {
            (shown(&mut visit.editor, field).as_deref() == Some(wanted)).then_some(())
        });
    }

    /// Waits until `done` of `steps` undo steps are applied.
    #[track_caller]
    pub(crate) fn until_steps(&mut self, done: usize, steps: usize) {
        self.until_shown("done", &done.to_string());
        self.until_shown("steps", &steps.to_string());
    }

    fn listen(&mut self) {
        self.editor.listen();
        for line in &self.editor.lines[self.read..] {
            let Some((_, told)) = line.split_once("dragonfly::reader: ") else { continue };
            let told: Value = serde_json::from_str(told).expect("an object");
            let id = told["id"].as_u64().expect("a number");
            if told["gone"] == true {
                self.controls.remove(&id);
            } else {
                self.controls.insert(id, told);
            }
        }
        self.read = self.editor.lines.len();
    }

    fn names(&self) -> Vec<&str> {
        self.controls.values().filter_map(|control| control["name"].as_str()).collect()
    }

    /// Returns the current accessibility data of the control whose name starts with `name`.
    pub(crate) fn control_now(&mut self, name: &str) -> Option<Value> {
        self.listen();
        let named = |wanted: &&Value| wanted["name"].as_str().is_some_and(|text| text == name);
        let begins = |wanted: &&Value| wanted["name"].as_str().is_some_and(|text| text.starts_with(name));
        let is_label = |wanted: &&Value| wanted["role"] == "Label";
        let mut all = self.controls.values().filter(named).chain(self.controls.values().filter(begins));
        all.find(|control| !is_label(control)).cloned()
    }

    /// Waits for that control, and returns its accessibility data.
    #[track_caller]
    pub(crate) fn control(&mut self, name: &str) -> Value {
        self.until(&format!("a control called {name:?}"), |visit| visit.control_now(name))
    }

    /// Waits until the value of a number field is near `wanted`, and returns it.
    #[track_caller]
    pub(crate) fn until_number(&mut self, name: &str, wanted: f64, within: f64) -> f64 {
        self.until(&format!("{name} = {wanted}"), |visit| {
            let number = visit.control_now(name)?["number"].as_f64()?;
            ((number - wanted).abs() <= within).then_some(number)
        })
    }

    /// Clicks in the middle of a control.
    #[track_caller]
    pub(crate) fn click_on(&mut self, name: &str) {
        let control = self.control(name);
        let [x, y, width, height] = [0, 1, 2, 3].map(|at| control["place"][at].as_f64().expect("a place"));
        self.screen.click((x + width / 2.0) as i16, (y + height / 2.0) as i16);
    }

    /// Presses Ctrl and a key.
    pub(crate) fn control_and(&mut self, key: u8) {
        self.screen.press_with(key::CONTROL, key);
    }

    /// Saves with the keyboard.
    #[track_caller]
    pub(crate) fn save(&mut self) -> Vec<u8> {
        self.control_and(key::S);
        self.saved += 1;
        let name = self.file.file_name().expect("a file").to_string_lossy().into_owned();
        self.editor.wait_for_log(&format!("Saved {name}"), self.saved, SOON);
        std::fs::read(&self.file).expect("it is there")
    }

    /// Returns the requests that the window has sent to its document, each as a `--stdio` line.
    pub(crate) fn asked(&mut self) -> Vec<Value> {
        self.listen();
        let told = self.editor.lines.iter().filter_map(|line| line.split_once("dragonfly::asked: "));
        told.map(|(_, line)| serde_json::from_str(line).expect("an object")).collect()
    }

    /// Returns the file that `dragonfly --stdio` writes for the same requests; it refuses the same ones.
    #[track_caller]
    pub(crate) fn by_stdio(&mut self) -> Vec<u8> {
        let mut talk = StdioSession::about(&data("gltf/Fox.glb"));
        for line in self.asked() {
            talk.say(&line.to_string());
        }
        let told = self.folder.join("told.glb");
        talk.ask(&json!({"do": "save", "to": told}));
        talk.end();
        std::fs::read(told).expect("it was written")
    }

    /// Returns the expected state of the window at the current time, computed by the test.
    pub(crate) fn inside(&mut self) -> ExpectedWindow {
        let mut inside = ExpectedWindow::new(numbers(&self.shown("viewport")));
        let time = self.shown("time").parse().expect("seconds");
        inside.state.execute(dragonfly::panels::Request::Seek(time));
        inside
    }

    /// Moves the playhead forward by `frames` of the frames that the keys of the fox are on. Returns its time, seconds.
    #[track_caller]
    pub(crate) fn go_on(&mut self, frames: usize) -> f32 {
        let start = self.shown("time");
        (0..frames).for_each(|_| self.screen.press(key::RIGHT));
        let time = start.parse::<f32>().expect("seconds") + frames as f32 / 24.0;
        self.until("the time", |visit| {
            let shown: f32 = visit.shown("time").parse().ok()?;
            ((shown - time).abs() < 1e-3).then_some(shown)
        })
    }

    /// Selects the head with a click in the viewport.
    #[track_caller]
    pub(crate) fn pick_head(&mut self) {
        let mut inside = self.inside();
        // If only skin is visible, the click hits the skin.
        let neck = inside.middle("b_Head_05", "b_Neck_04");
        let head = inside.middle("b_Head_05", "b_Head_05").lerp(neck, -0.6);
        self.screen.click(head.x as i16, head.y as i16);
        self.until_shown("bone", "b_Head_05");
    }

    /// Closes the window, which has nothing to ask.
    #[track_caller]
    pub(crate) fn end(mut self) {
        self.screen.close(self.editor.window);
        assert_eq!(self.editor.ends(SOON).code(), Some(0), "{}", self.editor.log());
    }
}
