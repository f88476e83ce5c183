//! The question where the file of unsaved work is now, with a field for the path, for desktops without a file dialog;
//! and the question what to do with the work if the chosen file is a different one.

use super::ask::{Ask, PathPart, Tone};
use super::kind::QuestionKind;
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::{Decision, DocumentMessage, Offer, Source, View};
use std::path::{Path, PathBuf};

/// Asks for the current path of the file that unsaved work belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct FindQuestion {
    /// The work.
    pub offer: Box<Offer>,
    /// The file that the user chose, if its content is not that of the expected file; `None` asks for a path.
    pub other: Option<PathBuf>,
}

impl QuestionKind for FindQuestion {
    fn name(&self) -> &'static str {
        if self.other.is_none() { "asked where a file is now" } else { "reported that it is another file" }
    }

    /// Returns the path where the file was.
    fn proposal(&self, _view: Option<&View>) -> String {
        let path = self.offer.found.document.as_ref();
        path.map_or_else(String::new, |path| path.display().to_string())
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(520.0);
        match &self.other {
            Some(other) => is_another(ask, &self.offer, other),
            None => typed(ask, &self.offer),
        }
    }
}

#[derive(Clone, Copy)]
enum FindChoice {
    Another,
    Beside,
    Later,
}

fn is_another(ask: &mut Ask<'_>, offer: &Offer, other: &Path) {
    let name = other.file_name().unwrap_or_default().to_string_lossy().into_owned();
    ask.title(&format!("{name} is a different file"));
    ask.says(format!("Its content is not what {} contained when the work was done.", offer.title));
    ask.adds("Opened as a copy, the work is applied to the content of this file, in a separate document. The file itself is not changed.");
    let pressed = ask.buttons(&[
        ("Choose another…", "Choose another file", Tone::First, FindChoice::Another),
        (
            "Open as a copy",
            "Apply the work to this file, in a separate document",
            Tone::Plain,
            FindChoice::Beside,
        ),
        ("Later", "Keep the work and ask again later", Tone::Plain, FindChoice::Later),
    ]);
    let request = match pressed {
        Some(FindChoice::Another) => Request::Answer(FileAction::Find(Box::new(offer.clone()))),
        Some(FindChoice::Beside) => {
            let chosen = offer.source.as_ref().map(Source::conventions).unwrap_or_default();
            let offer = Offer { source: Some(Source::of(other.to_owned(), chosen)), ..offer.clone() };
            Request::Answer(FileAction::Send(DocumentMessage::Decide(Box::new(offer), Decision::Beside)))
        }
        Some(FindChoice::Later) => Request::Dismiss,
        None => return,
    };
    ask.requests.push(request);
}

fn typed(ask: &mut Ask<'_>, offer: &Offer) {
    ask.title(&format!("Where is {} now?", offer.title));
    let open = ("Open", "Open the file with the work, if its content is unchanged");
    if let Some(path) =
        ask.path("Path of the file", open, ("Cancel", "Keep the work for later"), PathPart::Nothing)
    {
        let action = FileAction::Send(DocumentMessage::FoundAt(Box::new(offer.clone()), path));
        ask.requests.push(Request::Answer(action));
    }
}
