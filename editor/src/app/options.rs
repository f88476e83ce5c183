//! How the editor is started.

use dragonfly_document::Source;
use dragonfly_document::edit::Edit;
use std::path::PathBuf;
use std::str::FromStr;

/// How the editor is started.
#[derive(Clone, Debug)]
pub struct Options {
    /// The model that is opened first.
    pub source: Source,
    /// Number of further files that were given: one is open at a time, and a message says so.
    pub passed_over: usize,
    /// Loses the graphics device after this number of drawn frames while time passes, to test that nothing is lost.
    pub lose_device_every: Option<u32>,
    /// Continues to draw however often the device is lost, where the editor would pause: for tests of device loss.
    pub never_pause: bool,
    /// Folder of the settings; `None` for the system's usual folder.
    pub settings_folder: Option<PathBuf>,
    /// Folder in which unsaved changes are recorded; `None` for a folder next to the settings where those have one of their own,
    /// otherwise the system's usual folder.
    pub autosave_folder: Option<PathBuf>,
    /// Edits applied once the first model is open, as if the user made them: for tests.
    pub edits: Vec<Edit>,
    /// Number of the change at which the document fails, to test that nothing is lost.
    pub fail_at: Option<u32>,
    /// A failure of another part of the program, for the same test.
    pub mistake: Option<Mistake>,
}

/// A failure on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// The part that fails.
    pub part: Part,
    /// Number of steps that must be done before.
    pub steps: usize,
    /// Number of failures.
    pub times: u32,
}

/// A part of the program that can fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The main thread, while it draws the panels.
    Panels,
    /// The main thread, while it handles an input.
    Input,
    /// The graphics thread, while it handles a message.
    Message,
    /// The graphics thread, while it draws.
    Picture,
}

impl Mistake {
    /// Returns true, and counts one failure down, if the failure is due now.
    pub(super) fn is_made(&mut self, part: Part, steps: usize) -> bool {
        let made = self.part == part && self.times > 0 && steps >= self.steps;
        self.times -= u32::from(made);
        made
    }
}

impl FromStr for Mistake {
    type Err = &'static str;

    /// Parses `panels:3` or `panels:3:5`: part, steps, number of failures.
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
    /// Returns the options that open the built-in model.
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
