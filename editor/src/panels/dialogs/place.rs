//! A field for the path to save at, for desktops without a file dialog.

use super::ask::{Ask, PathPart};
use super::kind::QuestionKind;
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::{DocumentMessage, SaveOrder, SaveTo, Then, View};
use std::path::Path;

/// Asks for the path to save at, which is typed.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceQuestion {
    /// Whether a copy is saved, and the document keeps its own file.
    pub copy: bool,
    /// The action to run after saving.
    pub then: Option<Then>,
}

impl QuestionKind for PlaceQuestion {
    fn name(&self) -> &'static str {
        "asked where to save"
    }

    fn proposal(&self, view: Option<&View>) -> String {
        let Some(view) = view else { return String::new() };
        let read = view.loaded.path.as_deref();
        let own = view.file.path.as_deref();
        // With its folder, also where the file was opened by a relative path.
        let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let beside = |path: &Path, what: &str| {
            let part = |part: Option<&std::ffi::OsStr>| {
                part.map_or_else(String::new, |part| part.to_string_lossy().into_owned())
            };
            let name = format!("{} {what}.{}", part(path.file_stem()), part(path.extension()));
            whole(path).with_file_name(name).display().to_string()
        };
        match (own, read) {
            (Some(path), _) if self.copy => beside(path, "copy"),
            (Some(path), _) => whole(path).display().to_string(),
            (None, Some(path)) => beside(path, "recovered"),
            (None, None) => {
                let folder = std::env::home_dir().unwrap_or_default();
                folder.join("Dragonfly.glb").display().to_string()
            }
        }
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(520.0);
        ask.title(if self.copy { "Save a copy" } else { "Save as" });
        let save = ("Save", "Write the file");
        let entered = ask.path_field("Path to save at", PathPart::Name);
        ask.new_folders();
        if let Some(path) = ask.path_buttons(save, ("Cancel", "Close without saving"), entered) {
            let to = if self.copy { SaveTo::Copy(path) } else { SaveTo::As(path) };
            let order = SaveOrder { to, ..SaveOrder::own(self.then.clone()) };
            ask.requests.push(Request::Answer(FileAction::Send(DocumentMessage::Save(order))));
        }
    }
}
