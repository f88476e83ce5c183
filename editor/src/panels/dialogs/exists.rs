//! The question when the typed name belongs to another file.

use super::ask::{Ask, Tone};
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::{DocumentMessage, SaveOrder};
use std::path::Path;

pub(super) fn show(ask: &mut Ask<'_>, path: &Path, order: &SaveOrder) {
    ask.ui.set_width(440.0);
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    ask.title(&format!("Replace {name}?"));
    ask.says("A file with this name already exists. Its content is kept in the autosave folder for a while.");
    ask.adds(path.display().to_string());
    let replace = ("Replace", "Overwrite the existing file", Tone::Loses, true);
    let cancel = ("Cancel", "Keep the existing file", Tone::First, false);
    match ask.buttons(&[cancel, replace]) {
        Some(true) => {
            let order = SaveOrder { anyway: true, ..order.clone() };
            ask.requests.push(Request::Answer(FileAction::Send(DocumentMessage::Save(order))));
        }
        Some(false) => ask.requests.push(Request::Dismiss),
        None => {}
    }
}
