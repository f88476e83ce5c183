//! The names of what is open, with a dot before those of which something is not saved.

use super::PanelContext;

impl PanelContext<'_> {
    /// Returns whether nothing of the document that is shown is unsaved: it is in its file, or the project of a model keeps it.
    pub fn is_saved(&self) -> bool {
        self.view.is_none_or(|view| view.history.saved && self.pending_poses().1 == 0)
    }

    /// Returns the title of the window: the name of the document, and that of the scene in which it is edited.
    pub fn window_title(&self) -> String {
        let Some(view) = self.view else { return "Dragonfly".to_owned() };
        let project = view.scene.as_ref().and_then(|scene| scene.project.as_ref()?.name());
        let name = match view.file.path {
            Some(_) => project.unwrap_or(&view.file.title),
            None => "Untitled",
        };
        format!("{} – Dragonfly", self.name_in_scene(name))
    }

    /// Returns the name of the document, and that of the scene in which it is edited.
    pub(in crate::panels) fn name_in_scene(&self, name: &str) -> String {
        let name = title_with_dot(name, self.is_saved());
        match self.view.and_then(|view| view.waiting_scene.as_ref()) {
            Some(scene) => format!("{name} in {}", title_with_dot(&scene.title, scene.saved)),
            None => name,
        }
    }
}

/// Returns the title of a document, with a dot before it while something of it is unsaved.
pub(in crate::panels) fn title_with_dot(title: &str, is_saved: bool) -> String {
    format!("{}{title}", if is_saved { "" } else { "• " })
}
