//! A command: a row of the table.

use super::id::Id;
use super::when::When;
use crate::panels::request::Effect;
use crate::panels::workspace::Workspace;
use egui::KeyboardShortcut;

/// A command.
#[derive(Clone, Copy, Debug)]
pub struct Command {
    /// Its name in the code.
    pub id: Id,
    /// Its name on the screen.
    pub title: &'static str,
    /// Its keys; tooltips name the first.
    pub shortcuts: &'static [KeyboardShortcut],
    /// The tooltip: the action in one sentence.
    pub help: &'static str,
    /// Condition under which it can be run.
    pub when: When,
    /// Whether a held key runs it again and again, as for commands that step through time.
    pub repeats: bool,
    /// Runs the command. Returns an effect for the program around the panels, if there is one.
    pub(in crate::panels) run: fn(&mut Workspace) -> Option<Effect>,
}
