//! The question when files for the scene are outside of its folder.

use super::ask::{Ask, Tone};
use super::kind::QuestionKind;
use super::line_list::line_list;
use crate::panels::dropped_files::WantedFiles;
use crate::panels::request::Request;
use dragonfly_document::SceneFile;

/// Files for the scene are outside of its folder.
#[derive(Clone, Debug, PartialEq)]
pub struct CopyQuestion {
    /// All files, and what they are for.
    pub wanted: Box<WantedFiles>,
}

impl QuestionKind for CopyQuestion {
    fn name(&self) -> &'static str {
        "asked whether files are copied into the folder of the scene"
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(520.0);
        let outside: Vec<&SceneFile> = self.wanted.files.outside().collect();
        match outside.as_slice() {
            [file] => {
                let beside = match file.beside.len() {
                    0 => String::new(),
                    1 => " and its file".to_owned(),
                    files => format!(" and its {files} files"),
                };
                ask.title(&format!("Copy {}{beside} into {}/?", title(file), file.kind.folder()));
                ask.says(format!(
                    "{} is outside of the project's folder, and a scene names only files in it.",
                    title(file)
                ));
                ask.adds(file.path.display().to_string());
            }
            files => {
                ask.title(&format!("Copy {} files into the project's folder?", files.len()));
                ask.says("They are outside of the project's folder, and a scene names only files in it.");
                let line = |file: &&SceneFile| {
                    let beside = match file.beside.len() {
                        0 => String::new(),
                        files => format!(" (+ {files})"),
                    };
                    format!("{}/ ← {}{beside}", file.kind.folder(), file.path.display())
                };
                line_list(ask.ui, &files.iter().map(line).collect::<Vec<_>>());
            }
        }
        ask.adds("Files that are there are not overwritten.");
        let copy = ("Copy", "Copy them, and use the copies", Tone::First, true);
        let cancel = ("Cancel", "Change nothing", Tone::Plain, false);
        match ask.buttons(&[copy, cancel]) {
            Some(true) => ask.requests.push(Request::CopyFiles(self.wanted.clone())),
            Some(false) => ask.requests.push(Request::Dismiss),
            None => {}
        }
    }
}

fn title(file: &SceneFile) -> String {
    file.path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
