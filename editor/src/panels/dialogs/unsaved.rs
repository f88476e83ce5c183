//! Something is not saved, and the person wants to leave it.

use super::{Ask, Tone};
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::{SaveOrder, Then};

#[derive(Clone, Copy)]
enum Choice {
    Save,
    DoNotSave,
    Cancel,
}

pub(super) fn show(ask: &mut Ask<'_>, then: &Then) {
    ask.ui.set_width(440.0);
    let title = ask.state.view.map_or(String::new(), |view| view.file.title.clone());
    ask.title(&format!("Save {title}?"));
    ask.says(match then {
        Then::Quit => "It has changes that are in no file yet, and the program is about to end.".to_owned(),
        Then::Open(source) => {
            format!("It has changes that are in no file yet, and {} is about to be opened.", source.title())
        }
    });
    if let Some(last) = ask.state.view.and_then(|view| view.history.last_unsaved()) {
        ask.adds(last);
    }
    let save = ("Save", "Saves, then goes on", Tone::First, Choice::Save);
    let cancel = ("Cancel", "Goes back to work", Tone::Plain, Choice::Cancel);
    let lose = (
        "Don't save",
        "Goes on without saving; the changes lie in the bin of the autosave folder for a while",
        Tone::Loses,
        Choice::DoNotSave,
    );
    let request = match ask.buttons(&[save, cancel, lose]) {
        Some(Choice::Save) => Request::Answer(FileAction::Save(SaveOrder::own(Some(then.clone())))),
        Some(Choice::DoNotSave) => Request::Answer(FileAction::DoNotSave(then.clone())),
        Some(Choice::Cancel) => Request::Dismiss,
        None => return,
    };
    ask.requests.push(request);
}
