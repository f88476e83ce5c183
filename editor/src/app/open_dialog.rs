//! The system's dialog for opening files, asked in a thread of its own: it may take minutes to answer.

use dragonfly_anim::format::FORMATS;
use dragonfly_runtime::Address;
use std::path::PathBuf;

/// What came of it.
#[derive(Debug)]
pub(super) enum Answer {
    /// A file.
    File(PathBuf),
    /// The person changed their mind, or there is no such dialog here: the system does not tell which. `quick` when the
    /// answer came faster than a person can act.
    Nothing {
        /// Probably no dialog at all.
        quick: bool,
    },
}

/// No person closes a dialog in less time than this, seconds.
const HUMAN: f32 = 0.25;

/// Asks; the answer goes to `to`.
pub(super) fn ask(folder: Option<PathBuf>, to: Address<Answer>) -> std::io::Result<()> {
    std::thread::Builder::new().name("open dialog".to_owned()).spawn(move || {
        let begun = std::time::Instant::now();
        let models: Vec<&str> = FORMATS.iter().flat_map(|format| format.extensions).copied().collect();
        let mut dialog = rfd::AsyncFileDialog::new()
            .set_title("Open a model")
            .add_filter("Models", &models)
            .add_filter("All files", &["*"]);
        if let Some(folder) = folder {
            dialog = dialog.set_directory(folder);
        }
        let file = pollster::block_on(dialog.pick_file());
        let answer = match file {
            Some(file) => Answer::File(file.path().to_owned()),
            None => Answer::Nothing { quick: begun.elapsed().as_secs_f32() < HUMAN },
        };
        // The window may be closed by now.
        let _ = to.send(answer);
    })?;
    Ok(())
}
