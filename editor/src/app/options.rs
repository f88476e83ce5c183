//! How the editor is started.

use dragonfly_document::Source;
use dragonfly_document::edit::Edit;
use std::path::PathBuf;
use std::str::FromStr;

/// How the editor is started.
#[derive(Clone, Debug)]
pub struct Options {
    /// What to open first.
    pub source: Source,
    /// How many more files were asked for: one is open at a time, and the person is told.
    pub passed_over: usize,
    /// While time runs, loses the graphics device after every so many drawn frames, to show that nothing is lost with it.
    pub lose_device_every: Option<u32>,
    /// Draws on however often the device is lost, where the editor would pause: for tests of just that.
    pub never_pause: bool,
    /// Where settings are kept; the system's usual place when it is not given.
    pub settings_folder: Option<PathBuf>,
    /// Where unsaved work is recorded; beside settings that have a folder of their own, else in the system's usual place.
    pub autosave_folder: Option<PathBuf>,
    /// Edits done once the first model is there, as if a person did them: for tests of what becomes of them.
    pub edits: Vec<Edit>,
    /// Lets the document fail at this change, to show that nothing is lost with it.
    pub fail_at: Option<u32>,
    /// Lets another part of the program fail, likewise.
    pub mistake: Option<Mistake>,
}

/// A mistake made on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// Where.
    pub part: Part,
    /// Once so many steps are done.
    pub steps: usize,
    /// So often.
    pub times: u32,
}

/// A part of the program that can fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The main thread, while it draws the panels.
    Panels,
    /// The main thread, while it takes an input.
    Input,
    /// The graphics thread, while it takes a message.
    Message,
    /// The graphics thread, while it draws.
    Picture,
}

impl Mistake {
    /// Is it made now? Then it is made so often less later.
    pub(super) fn is_made(&mut self, part: Part, steps: usize) -> bool {
        let made = self.part == part && self.times > 0 && steps >= self.steps;
        self.times -= u32::from(made);
        made
    }
}

impl FromStr for Mistake {
    type Err = &'static str;

    /// `panels:3` or `panels:3:5`: place, steps, and how often.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let mut parts = text.split(':');
        let part = match parts.next() {
            Some("panels") => Part::Panels,
            Some("input") => Part::Input,
            Some("message") => Part::Message,
            Some("picture") => Part::Picture,
            _ => return Err("the place is panels, input, message or picture"),
        };
        let number = |part: Option<&str>| part.map_or(Ok(1), str::parse).map_err(|_| "a number is wanted");
        let (steps, times) = (number(parts.next())?, number(parts.next())?);
        Ok(Self { part, steps: steps as usize, times })
    }
}

impl Default for Options {
    /// The built-in model.
    fn default() -> Self {
        Self {
            source: Source::BuiltIn,
            passed_over: 0,
            lose_device_every: None,
            never_pause: false,
            settings_folder: None,
            autosave_folder: None,
            edits: Vec::new(),
            fail_at: None,
            mistake: None,
        }
    }
}
