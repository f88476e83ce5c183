//! Where the file of unsaved work is now: typed, for desktops without a dialog for files; and what becomes of the work
//! where the file that was chosen is another one.

use super::{Ask, Tone};
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::{Decision, Offer, Source};
use egui::{Key, TextEdit, TextStyle};
use std::path::{Path, PathBuf};

/// The path that stands in the field at first: where it was.
pub(super) fn proposal(offer: &Offer) -> String {
    offer.found.document.as_ref().map_or_else(String::new, |path| path.display().to_string())
}

pub(super) fn show(ask: &mut Ask<'_>, offer: &Offer, other: Option<&Path>, path: &mut String) {
    ask.ui.set_width(520.0);
    match other {
        Some(other) => is_another(ask, offer, other),
        None => typed(ask, offer, path),
    }
}

#[derive(Clone, Copy)]
enum Choice {
    Another,
    Beside,
    Later,
}

fn is_another(ask: &mut Ask<'_>, offer: &Offer, other: &Path) {
    let name = other.file_name().unwrap_or_default().to_string_lossy().into_owned();
    ask.title(&format!("{name} is another file"));
    ask.says(format!("It does not hold what {} held when the work was done.", offer.title));
    ask.adds("Opened beside, the work is done again on what this file holds, as a document of its own. The file itself stays as it is.");
    let pressed = ask.buttons(&[
        ("Choose another…", "Looks for the file once more", Tone::First, Choice::Another),
        (
            "Open beside",
            "Does the work again on this file, as a document of its own",
            Tone::Plain,
            Choice::Beside,
        ),
        ("Later", "Leaves the work where it is, and asks another time", Tone::Plain, Choice::Later),
    ]);
    let request = match pressed {
        Some(Choice::Another) => Request::Answer(FileAction::Find(Box::new(offer.clone()))),
        Some(Choice::Beside) => {
            let offer = Offer { source: Some(Source::File(other.to_owned())), ..offer.clone() };
            Request::Answer(FileAction::Decide(Box::new(offer), Decision::Beside))
        }
        Some(Choice::Later) => Request::Dismiss,
        None => return,
    };
    ask.requests.push(request);
}

fn typed(ask: &mut Ask<'_>, offer: &Offer, path: &mut String) {
    ask.title(&format!("Where is {} now?", offer.title));
    let field = TextEdit::singleline(path).desired_width(f32::INFINITY).font(TextStyle::Monospace);
    let response = ask.ui.add(field.margin(egui::Margin::symmetric(10, 7)));
    let response = response.accessible_name("Path of the file");
    if ask.fresh {
        response.request_focus();
    }
    let entered = response.lost_focus() && ask.ui.input(|input| input.key_pressed(Key::Enter));
    let fresh = std::mem::replace(&mut ask.fresh, false);
    let open = ("Open", "Opens the file with the work, if it holds what it held then", Tone::First, true);
    let cancel = ("Cancel", "Leaves the work where it is", Tone::Plain, false);
    let pressed = ask.buttons(&[open, cancel]);
    ask.fresh = fresh;
    let wanted = path.trim().trim_matches('"');
    if (entered || pressed == Some(true)) && !wanted.is_empty() {
        let deed = FileAction::FoundAt(Box::new(offer.clone()), PathBuf::from(wanted));
        ask.requests.push(Request::Answer(deed));
    } else if pressed == Some(false) {
        ask.requests.push(Request::Dismiss);
    }
}
