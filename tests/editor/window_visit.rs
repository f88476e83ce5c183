//! A person with a file at the real window: hands on the keys and the mouse, and ears that hear what a screen reader tells.

use crate::program::threads;
use crate::screen::{Screen, key};
use crate::stdio::Talk;
use crate::window::{Editor, SOON, eventually_shows_something};
use crate::window_hands::{Inside, numbers, shown};
use dragonfly_kit::document::test_document::fox;
use dragonfly_kit::folder::{Folder, data};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What the log must tell for it.
const LOG: &str =
    "error,dragonfly=info,dragonfly::shown=debug,dragonfly::asked=debug,dragonfly::reader=debug";

/// See the module.
pub(crate) struct Visit {
    // Ends before its screen.
    pub(crate) editor: Editor,
    pub(crate) screen: Screen,
    /// A copy of Fox.
    pub(crate) file: PathBuf,
    pub(crate) folder: Folder,
    /// What the reader told of each control.
    controls: BTreeMap<u64, Value>,
    /// Lines of the log that were read.
    read: usize,
    saved: usize,
}

fn start(screen: &mut Screen, folder: &Folder, file: &Path, more: &[&str]) -> Editor {
    let autosave = folder.join("autosave").display().to_string();
    let arguments = [&["--autosave", &autosave], more].concat();
    let mut editor = Editor::open_file(screen, file, &arguments, &[("DRAGONFLY_LOG", LOG)]);
    editor.window = screen.any_window(&["Fox.glb", "• Fox.glb"], SOON);
    screen.focus(editor.window);
    screen.point(i16::MAX, i16::MAX);
    editor
}

impl Visit {
    /// Opens a copy of Fox, pauses, and goes to the start.
    pub(crate) fn new(name: &str) -> Self {
        Self::with(name, &[])
    }

    /// The same, started with more arguments.
    pub(crate) fn with(name: &str, more: &[&str]) -> Self {
        let folder = Folder::new(name);
        let file = fox(&folder);
        let mut screen = Screen::new(name, 1280, 800);
        let editor = start(&mut screen, &folder, &file, more);
        let mut visit = Self { editor, screen, file, folder, controls: BTreeMap::new(), read: 0, saved: 0 };
        eventually_shows_something(&visit.screen);
        visit.stand_still();
        visit
    }

    /// Starts the program once more, after it ended or was ended; on another screen where there is none any more.
    pub(crate) fn again(&mut self, screen: Option<&str>) {
        if let Some(name) = screen {
            self.screen = Screen::new(name, 1280, 800);
        }
        self.editor = start(&mut self.screen, &self.folder, &self.file, &[]);
        (self.controls, self.read, self.saved) = (BTreeMap::new(), 0, 0);
    }

    /// Pauses, and goes to the start.
    #[track_caller]
    pub(crate) fn stand_still(&mut self) {
        self.screen.press(key::SPACE);
        self.go_to_the_start();
    }

    /// Goes to the start, where time stands: also when work was brought back.
    #[track_caller]
    pub(crate) fn go_to_the_start(&mut self) {
        self.screen.press(key::HOME);
        self.until_shown("time", "0.0");
    }

    /// The newest value of a field that the window tells of what it shows.
    #[track_caller]
    pub(crate) fn shown(&mut self, field: &str) -> String {
        shown(&mut self.editor, field).expect("it is told")
    }

    /// Waits until something is so.
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

    /// Waits until the window tells this of what it shows.
    #[track_caller]
    pub(crate) fn until_shown(&mut self, field: &str, wanted: &str) {
        self.until(&format!("{field} = {wanted}"), |visit| {
            (shown(&mut visit.editor, field).as_deref() == Some(wanted)).then_some(())
        });
    }

    /// Waits until so many steps are done, of so many.
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

    /// What a reader tells now of the control whose name begins like this.
    pub(crate) fn control_now(&mut self, name: &str) -> Option<Value> {
        self.listen();
        let named = |wanted: &&Value| wanted["name"].as_str().is_some_and(|text| text == name);
        let begins = |wanted: &&Value| wanted["name"].as_str().is_some_and(|text| text.starts_with(name));
        let is_label = |wanted: &&Value| wanted["role"] == "Label";
        let mut all = self.controls.values().filter(named).chain(self.controls.values().filter(begins));
        all.find(|control| !is_label(control)).cloned()
    }

    /// The same, as soon as it is there.
    #[track_caller]
    pub(crate) fn control(&mut self, name: &str) -> Value {
        self.until(&format!("a control called {name:?}"), |visit| visit.control_now(name))
    }

    /// The number that a reader tells of a field, once it is near this.
    #[track_caller]
    pub(crate) fn until_number(&mut self, name: &str, wanted: f64, within: f64) -> f64 {
        self.until(&format!("{name} = {wanted}"), |visit| {
            let number = visit.control_now(name)?["number"].as_f64()?;
            ((number - wanted).abs() <= within).then_some(number)
        })
    }

    /// Clicks at the middle of a control.
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
        self.editor.hears("Saved Fox.glb", self.saved, SOON);
        std::fs::read(&self.file).expect("it is there")
    }

    /// What the window asked its document so far, each as a line of a conversation.
    pub(crate) fn asked(&mut self) -> Vec<Value> {
        self.listen();
        let told = self.editor.lines.iter().filter_map(|line| line.split_once("dragonfly::asked: "));
        told.map(|(_, line)| serde_json::from_str(line).expect("an object")).collect()
    }

    /// The file that `dragonfly --stdio` writes when it is asked the same; what was refused here is refused there.
    #[track_caller]
    pub(crate) fn by_stdio(&mut self) -> Vec<u8> {
        let mut talk = Talk::about(&data("gltf/Fox.glb"));
        for line in self.asked() {
            talk.say(&line.to_string());
        }
        let told = self.folder.join("told.glb");
        talk.ask(&json!({"do": "save", "to": told}));
        talk.end();
        std::fs::read(told).expect("it was written")
    }

    /// The state of the window, as a test outside of it computes it, at the time shown.
    pub(crate) fn inside(&mut self) -> Inside {
        let mut inside = Inside::new(numbers(&self.shown("viewport")));
        let time = self.shown("time").parse().expect("seconds");
        inside.state.execute(dragonfly::panels::Request::Seek(time));
        inside
    }

    /// Goes some frames on, of those that the keys of the fox lie on; to which time, seconds.
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

    /// Selects the head with a click into the picture.
    #[track_caller]
    pub(crate) fn pick_head(&mut self) {
        let mut inside = self.inside();
        // Where nothing but skin is seen, the skin is met.
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
