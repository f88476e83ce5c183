//! Files in the settings folder apart from the settings: the markers of each model, and the marks of bones.

use super::actions::show;
use super::marks::Marks;
use super::workspace::Workspace;

/// Markers and marks as the text of their files.
pub struct SideFiles<'a> {
    workspace: &'a mut Workspace,
}

impl<'a> SideFiles<'a> {
    /// Returns the side files of a workspace.
    pub(super) fn of(workspace: &'a mut Workspace) -> Self {
        Self { workspace }
    }

    /// Returns the file that holds the markers of the model, once after it was opened.
    pub fn wanted_markers(&mut self) -> Option<String> {
        self.workspace.keys.markers_mut().wanted()
    }

    /// Reads the text of the file of markers.
    pub fn read_markers(&mut self, text: &str) {
        if let Some(view) = self.workspace.model.view() {
            self.workspace.keys.markers_mut().read(text, &view.slots);
        }
    }

    /// Returns the file of markers and its text, when they changed since the last call.
    pub fn unsaved_markers(&mut self) -> Option<(String, String)> {
        let view = self.workspace.model.view()?;
        self.workspace.keys.markers_mut().unsaved(&view.slots)
    }

    /// Reads the marks of bones that are remembered, before a model is open.
    pub fn read_marks(&mut self, text: &str) {
        self.workspace.marks = Marks::read(text);
    }

    /// Returns the text of the marks of bones, when they changed since the last call.
    pub fn unsaved_marks(&mut self) -> Option<String> {
        show::note_marks(self.workspace);
        self.workspace.marks.unsaved()
    }
}
