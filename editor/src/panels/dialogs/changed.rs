//! Somebody else changed the file that is open, or took it away.

use super::{Ask, Tone};
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::SaveOrder;
use dragonfly_store::FileState;

#[derive(Clone, Copy)]
enum Choice {
    Overwrite,
    SaveAs,
    Reload,
    Cancel,
}

pub(super) fn show(ask: &mut Ask<'_>, file: FileState, order: Option<&SaveOrder>) {
    ask.ui.set_width(480.0);
    let Some(view) = &ask.state.view else { return };
    let (title, saved) = (view.file.title.clone(), view.history.saved);
    let gone = file == FileState::Missing;
    let then = order.and_then(|order| order.then.clone());
    ask.title(&if gone { format!("{title} is gone") } else { format!("{title} was changed on the disk") });
    ask.says(if gone {
        "Another program removed or moved the file. What is open here is still whole."
    } else if order.is_some() {
        "Another program wrote to the file since it was opened, so it was not overwritten."
    } else {
        "Another program wrote to the file since it was opened."
    });
    if !saved && !gone {
        ask.adds("What you did here is not saved. Reloading gives it up; it lies in the bin of the autosave folder for a while.");
    }
    let reload = ("Reload", "Shows what is on the disk now", if saved { Tone::First } else { Tone::Loses });
    let overwrite = (
        "Overwrite",
        "Puts what is open here in its place; the other version is kept in the autosave folder",
    );
    let save_as = ("Save as…", "Keeps both", Tone::Plain, Choice::SaveAs);
    let cancel = ("Cancel", "Does nothing now", Tone::Plain, Choice::Cancel);
    let pressed = if gone {
        let write = ("Save again", "Writes it where it was", Tone::First, Choice::Overwrite);
        ask.buttons(&[write, save_as, cancel])
    } else if saved && order.is_none() {
        let reload = (reload.0, reload.1, reload.2, Choice::Reload);
        ask.buttons(&[reload, cancel, save_as, (overwrite.0, overwrite.1, Tone::Loses, Choice::Overwrite)])
    } else {
        let reload = (reload.0, reload.1, Tone::Loses, Choice::Reload);
        let save_as = (save_as.0, save_as.1, Tone::First, Choice::SaveAs);
        ask.buttons(&[save_as, cancel, (overwrite.0, overwrite.1, Tone::Loses, Choice::Overwrite), reload])
    };
    let request = match pressed {
        Some(Choice::Overwrite) => {
            Request::Answer(FileAction::Save(SaveOrder { anyway: true, ..SaveOrder::own(then) }))
        }
        Some(Choice::SaveAs) => Request::Answer(FileAction::Where { copy: false, then }),
        Some(Choice::Reload) => Request::Answer(FileAction::Reload),
        Some(Choice::Cancel) => Request::Dismiss,
        None => return,
    };
    ask.requests.push(request);
}
