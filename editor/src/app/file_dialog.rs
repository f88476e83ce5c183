//! The system's dialogs for files, run in a thread of their own: they may take minutes to answer.

use crate::panels::FileChoice;
use dragonfly_document::{Offer, Then, formats};
use dragonfly_runtime::{Address, Job, JobContext};
use std::path::PathBuf;

/// The purpose of a file dialog.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Purpose {
    /// Choose a model to open.
    Open,
    /// Choose a model with whose takes others are compared.
    Compare,
    /// Find this file, which was moved, to restore its unsaved work.
    Find(Box<Offer>),
    /// Choose another file or a folder.
    Choose(FileChoice),
    /// Choose where to save.
    Save {
        /// Whether to save a copy, so that the document keeps its own file.
        copy: bool,
        /// The action to run after saving.
        then: Option<Then>,
        /// The name that is proposed.
        name: String,
    },
}

/// The answer of a file dialog.
#[derive(Debug)]
pub(super) struct Answer {
    /// The purpose of the dialog.
    pub purpose: Purpose,
    /// The other files, where several can be chosen.
    pub others: Vec<PathBuf>,
    /// The file; `None` where the user cancelled, or where there is no such dialog: the system does not report which.
    pub file: Option<PathBuf>,
    /// Whether the answer came faster than a user can act: probably there is no dialog at all.
    pub quick: bool,
}

/// No user closes a dialog in less time than this, seconds.
const HUMAN: f32 = 0.25;

/// Shows a dialog; the answer goes to `to`.
pub(super) fn ask(purpose: Purpose, folder: Option<PathBuf>, to: Address<Answer>) -> std::io::Result<()> {
    let asked = purpose.clone();
    let work = move |_: &JobContext<Answer>| {
        let begun = std::time::Instant::now();
        let mut dialog = rfd::AsyncFileDialog::new();
        if let Some(folder) = folder {
            dialog = dialog.set_directory(folder);
        }
        let mut others = Vec::new();
        let file = match &purpose {
            Purpose::Open | Purpose::Compare | Purpose::Find(_) => {
                let title = match &purpose {
                    Purpose::Find(offer) => format!("Where is {} now?", offer.title),
                    Purpose::Compare => "Compare with a take of another model".to_owned(),
                    _ => "Open a model or a scene".to_owned(),
                };
                let mut extensions = formats().extensions();
                let opens = matches!(purpose, Purpose::Open);
                if opens {
                    extensions.extend(["xml", "meproj"]);
                }
                let name = if opens { "Models and scenes" } else { "Models" };
                let dialog = dialog.set_title(title).add_filter(name, &extensions);
                pollster::block_on(dialog.add_filter("All files", &["*"]).pick_file())
            }
            Purpose::Choose(choice) => {
                let dialog = dialog.set_title(choice.title());
                match choice.filter() {
                    None => pollster::block_on(dialog.pick_folder()),
                    Some((name, extensions)) => {
                        let dialog = dialog.add_filter(name, &extensions).add_filter("All files", &["*"]);
                        if matches!(choice, FileChoice::Takes | FileChoice::MappedTakes) {
                            let mut files =
                                pollster::block_on(dialog.pick_files()).unwrap_or_default().into_iter();
                            let first = files.next();
                            others.extend(files.map(|file| file.path().to_owned()));
                            first
                        } else {
                            pollster::block_on(dialog.pick_file())
                        }
                    }
                }
            }
            Purpose::Save { copy, name, .. } => {
                let title = if *copy { "Save a copy" } else { "Save as" };
                pollster::block_on(dialog.set_title(title).set_file_name(name).save_file())
            }
        };
        let file = file.map(|file| file.path().to_owned());
        let quick = file.is_none() && begun.elapsed().as_secs_f32() < HUMAN;
        Answer { purpose, file, others, quick }
    };
    // Detached: a dialog of the system cannot be cancelled, and the program does not wait for it at its end.
    Job::start(&to, "file dialog", work, move |_| Answer {
        purpose: asked,
        file: None,
        others: Vec::new(),
        quick: true,
    })?
    .detach();
    Ok(())
}
