//! What is remembered of each file that was open: which bones are muted, soloed, locked and pinned, and towards which one
//! elbows bend. It lies beside the program's settings and never in the model's file.

use super::keys::{BoneFlag, BoneFlags};
use super::pose_commands::named;
use super::state::State;
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_document::View;
use dragonfly_document::edit::BoneRef;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Its name in the program's own folder.
pub const FILE: &str = "marks.json";
/// How many files are remembered: those in which marks were set last.
pub const FILES: usize = 50;
/// Bytes of the text at most; the older files go first.
const LONGEST: usize = 900_000;

/// The marks of one file. Bones go by name where that names one alone, so that they are found again in a file that was
/// exported anew.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
struct FileMarks {
    path: String,
    mute: Vec<BoneRef>,
    solo: Vec<BoneRef>,
    lock: Vec<BoneRef>,
    pins: Vec<BoneRef>,
    pole: Option<BoneRef>,
}

impl FileMarks {
    fn is_empty(&self) -> bool {
        *self == Self { path: self.path.clone(), ..Self::default() }
    }

    fn flag(&self, flag: BoneFlag) -> &[BoneRef] {
        match flag {
            BoneFlag::Mute => &self.mute,
            BoneFlag::Solo => &self.solo,
            BoneFlag::Lock => &self.lock,
        }
    }
}

/// The marks of all files that are remembered.
#[derive(Clone, Debug, Default)]
pub struct Marks {
    /// Newest first.
    files: Vec<FileMarks>,
    /// What was looked at last.
    noted: Option<Noted>,
    unsaved: bool,
}

#[derive(Clone, Debug)]
struct Noted {
    /// Of the file; a model that is saved elsewhere takes its marks along.
    path: Option<PathBuf>,
    /// Of the flags.
    version: u64,
    pins: Vec<BoneIndex>,
    pole: Option<BoneIndex>,
}

#[derive(Serialize, Deserialize)]
#[serde(default)]
#[derive(Default)]
struct Stored {
    files: Vec<FileMarks>,
}

impl Marks {
    /// From the text of a file; a damaged one holds none.
    fn read(text: &str) -> Self {
        let mut files = serde_json::from_str::<Stored>(text).unwrap_or_default().files;
        files.truncate(FILES);
        Self { files, ..Self::default() }
    }

    /// The text of a file; where it would be too long the older files are forgotten.
    fn write(&mut self) -> String {
        loop {
            let stored = Stored { files: self.files.clone() };
            // Plain data always has a text.
            let text = serde_json::to_string_pretty(&stored).unwrap_or_default();
            if text.len() <= LONGEST || self.files.is_empty() {
                return text;
            }
            self.files.truncate(self.files.len() / 2);
        }
    }
}

impl State {
    /// Takes what was remembered, before a model is open.
    pub fn read_marks(&mut self, text: &str) {
        self.marks = Marks::read(text);
    }

    /// What is to be remembered, when it changed since the last call.
    pub fn unsaved_marks(&mut self) -> Option<String> {
        self.note_marks();
        std::mem::take(&mut self.marks.unsaved).then(|| self.marks.write())
    }

    /// Notes the marks of the model that is open, where they changed.
    pub(super) fn note_marks(&mut self) {
        let Some(view) = &self.view else { return };
        let version = self.keys.flags.version();
        let same = |noted: &Noted| {
            (&noted.path, noted.version, &noted.pins, noted.pole)
                == (&view.file.path, version, &self.pins, self.ik.pole)
        };
        if self.marks.noted.as_ref().is_some_and(same) {
            return;
        }
        let path = view.file.key();
        // What was opened just now has what was remembered of it.
        let first = self.marks.noted.replace(self.noted(view)).is_none();
        let marks =
            of(path, &view.loaded.model.animation.skeleton, &self.keys.flags, &self.pins, self.ik.pole);
        let at = self.marks.files.iter().position(|file| file.path == marks.path);
        if at.is_some_and(|at| self.marks.files[at] == marks) || (first && marks.is_empty() && at.is_none()) {
            return;
        }
        at.map(|at| self.marks.files.remove(at));
        if !marks.is_empty() {
            self.marks.files.insert(0, marks);
            self.marks.files.truncate(FILES);
        }
        self.marks.unsaved = true;
    }

    /// Gives the model that was opened just now the marks that its file had.
    pub(super) fn recall_marks(&mut self) {
        self.marks.noted = None;
        let Some(view) = self.view.clone() else { return };
        let path = view.file.key();
        let skeleton = &view.loaded.model.animation.skeleton;
        let index = |bone: &BoneRef| match bone {
            BoneRef::Index(bone) => Some(*bone).filter(|&bone| (bone as usize) < skeleton.len()),
            BoneRef::Name(name) => skeleton.find(name),
        };
        let Some(marks) = self.marks.files.iter().find(|file| file.path == path) else { return };
        for flag in BoneFlag::ALL {
            for bone in marks.flag(flag).iter().filter_map(index) {
                self.keys.flags.set(flag, bone, true);
            }
        }
        self.pins = marks.pins.iter().filter_map(index).collect();
        self.ik.pole = marks.pole.as_ref().and_then(index);
        self.marks.noted = Some(self.noted(&view));
    }

    fn noted(&self, view: &View) -> Noted {
        let (pins, pole) = (self.pins.clone(), self.ik.pole);
        Noted { path: view.file.path.clone(), version: self.keys.flags.version(), pins, pole }
    }
}

/// What is marked now, as it is kept.
fn of(
    path: String,
    skeleton: &Skeleton,
    flags: &BoneFlags,
    pins: &[BoneIndex],
    pole: Option<BoneIndex>,
) -> FileMarks {
    let list = |flag| flags.of(flag).map(|bone| named(skeleton, bone)).collect();
    FileMarks {
        path,
        mute: list(BoneFlag::Mute),
        solo: list(BoneFlag::Solo),
        lock: list(BoneFlag::Lock),
        pins: pins.iter().map(|&bone| named(skeleton, bone)).collect(),
        pole: pole.map(|bone| named(skeleton, bone)),
    }
}
