//! Marks of bones, remembered for each file: which bones are muted, soloed, locked and pinned, and towards which bone elbows
//! bend; the things of a scene that are hidden and locked; selection sets; the frame rate and the unit of length that were chosen for the file; its reference picture and its sound. They are stored with the program's settings and never in the model's file.

use super::keys::channel::BoneNames;
use super::keys::{BoneFlag, BoneFlags};
use super::reference::settings::{relative_to, resolved};
use super::reference::{ReferenceSettings, ReferenceTrack};
use super::scene::SceneMarks;
use super::selection_sets::{SelectionSet, SelectionSets};
use super::sound::{SoundSettings, SoundTrack};
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_document::View;
use dragonfly_document::edit::BoneRef;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Name of the file in the program's own folder.
pub const FILE: &str = "marks.json";
/// Maximum number of files that are remembered: those in which marks were set last.
pub const FILES: usize = 50;
/// Maximum length of the text, bytes; the older files are forgotten first.
const LONGEST: usize = 900_000;

/// The marks of one file. Bones are stored by name if the name is unique, so that they are found again in a file that was
/// exported again.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
struct FileMarks {
    path: String,
    mute: Vec<BoneRef>,
    solo: Vec<BoneRef>,
    lock: Vec<BoneRef>,
    pins: Vec<BoneRef>,
    pole: Option<BoneRef>,
    #[serde(skip_serializing_if = "Option::is_none")]
    frame_rate: Option<u32>,
    /// Meters in one unit of length, where the user set them.
    #[serde(skip_serializing_if = "Option::is_none")]
    meters_per_unit: Option<f32>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sets: Vec<SetMarks>,
    /// Its path is relative to the folder of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<ReferenceSettings>,
    /// Its path is relative to the folder of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    sound: Option<SoundSettings>,
    /// The hidden things of a scene.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    hidden_things: Vec<Box<str>>,
    /// The locked things of a scene.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    locked_things: Vec<Box<str>>,
}

/// A selection set as it is stored.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
struct SetMarks {
    name: String,
    color: [u8; 3],
    bones: Vec<BoneRef>,
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
    /// The marks that were noted last.
    noted: Option<Noted>,
    unsaved: bool,
}

#[derive(Clone, Debug)]
struct Noted {
    /// Path of the file; a model that is saved elsewhere keeps its marks.
    path: Option<PathBuf>,
    /// Version of the flags.
    version: u64,
    pins: Vec<BoneIndex>,
    pole: Option<BoneIndex>,
    frame_rate: Option<u32>,
    meters_per_unit: Option<f32>,
    /// Version of the selection sets.
    sets: u64,
    /// Version of the reference picture.
    reference: u64,
    /// Version of the sound.
    sound: u64,
    /// Version of the marks of the things of a scene.
    things: Option<u64>,
}

#[derive(Serialize, Deserialize)]
#[serde(default)]
#[derive(Default)]
struct StoredMarks {
    files: Vec<FileMarks>,
}

impl Marks {
    /// Reads the text of the file; a damaged text counts as one without marks.
    pub(super) fn read(text: &str) -> Self {
        let mut files = serde_json::from_str::<StoredMarks>(text).unwrap_or_default().files;
        files.truncate(FILES);
        Self { files, ..Self::default() }
    }

    /// Returns the text of the file; if it would be too long the older files are forgotten.
    fn write(&mut self) -> String {
        loop {
            let stored = StoredMarks { files: self.files.clone() };
            // Plain data can always be serialized.
            let text = serde_json::to_string_pretty(&stored).unwrap_or_default();
            if text.len() <= LONGEST || self.files.is_empty() {
                return text;
            }
            self.files.truncate(self.files.len() / 2);
        }
    }
}

/// The marks of the model that is open.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoneMarks<'a> {
    /// Muted, soloed and locked bones.
    pub(super) flags: &'a BoneFlags,
    /// Pinned bones.
    pub(super) pins: &'a [BoneIndex],
    /// The bone towards which elbows and knees bend.
    pub(super) pole: Option<BoneIndex>,
    /// The frame rate that was chosen for the file.
    pub(super) frame_rate: Option<u32>,
    /// Meters in one unit of length that were set for the file.
    pub(super) meters_per_unit: Option<f32>,
    /// The selection sets.
    pub(super) sets: &'a SelectionSets,
    /// The reference picture.
    pub(super) reference: &'a ReferenceTrack,
    /// The sound.
    pub(super) sound: &'a SoundTrack,
    /// The things of a scene; `None` while a model is open.
    pub(super) things: Option<SceneMarks<'a>>,
}

/// Marks that were found again for a model.
#[derive(Clone, Debug, Default)]
pub(super) struct RecalledMarks {
    /// Flags of bones.
    pub(super) flags: Vec<(BoneFlag, BoneIndex)>,
    /// Pinned bones.
    pub(super) pins: Vec<BoneIndex>,
    /// The bone towards which elbows and knees bend.
    pub(super) pole: Option<BoneIndex>,
    /// The frame rate that was chosen for the file.
    pub(super) frame_rate: Option<u32>,
    /// Meters in one unit of length that were set for the file.
    pub(super) meters_per_unit: Option<f32>,
    /// The selection sets.
    pub(super) sets: Vec<SelectionSet>,
    /// The reference picture.
    pub(super) reference: Option<ReferenceSettings>,
    /// The sound.
    pub(super) sound: Option<SoundSettings>,
    /// The hidden things of a scene.
    pub(super) hidden_things: Vec<Box<str>>,
    /// The locked things of a scene.
    pub(super) locked_things: Vec<Box<str>>,
}

impl Marks {
    /// Returns the text of the file when the marks changed since the last call.
    pub(super) fn unsaved(&mut self) -> Option<String> {
        std::mem::take(&mut self.unsaved).then(|| self.write())
    }

    /// Notes the marks of the model that is open, if they changed.
    pub(super) fn note(&mut self, view: &View, now: BoneMarks<'_>) {
        let same = |noted: &Noted| {
            let versions = (noted.version, noted.sets, noted.reference, noted.sound, noted.things);
            (&noted.path, versions, &noted.pins[..], noted.pole, (noted.frame_rate, noted.meters_per_unit))
                == (
                    &view.file.path,
                    (
                        now.flags.version(),
                        now.sets.version(),
                        now.reference.version(),
                        now.sound.version(),
                        now.things.map(|things| things.version),
                    ),
                    now.pins,
                    now.pole,
                    (now.frame_rate, now.meters_per_unit),
                )
        };
        if self.noted.as_ref().is_some_and(same) {
            return;
        }
        // A model that was just opened has the marks that were remembered of it.
        let first = self.noted.replace(Noted::of(view, now)).is_none();
        let folder = folder_of(view);
        let marks =
            FileMarks::of(view.file.key(), folder.as_deref(), &view.loaded.model.animation.skeleton, now);
        let at = self.files.iter().position(|file| file.path == marks.path);
        if at.is_some_and(|at| self.files[at] == marks) || (first && marks.is_empty() && at.is_none()) {
            return;
        }
        at.map(|at| self.files.remove(at));
        if !marks.is_empty() {
            self.files.insert(0, marks);
            self.files.truncate(FILES);
        }
        self.unsaved = true;
    }

    /// Returns the marks of the file of a model that was just opened; `None` if none are remembered.
    pub(super) fn recall(&mut self, view: &View) -> Option<RecalledMarks> {
        self.noted = None;
        let skeleton = &view.loaded.model.animation.skeleton;
        let index = |bone: &BoneRef| match bone {
            BoneRef::Index(bone) => Some(*bone).filter(|&bone| (bone as usize) < skeleton.len()),
            BoneRef::Name(name) => skeleton.find(name),
        };
        let path = view.file.key();
        let marks = self.files.iter().find(|file| file.path == path)?;
        let set = |set: &SetMarks| SelectionSet {
            name: set.name.clone(),
            color: set.color,
            bones: set.bones.iter().filter_map(index).collect(),
        };
        let of = |flag| marks.flag(flag).iter().filter_map(index).map(move |bone| (flag, bone));
        Some(RecalledMarks {
            flags: BoneFlag::ALL.into_iter().flat_map(of).collect(),
            pins: marks.pins.iter().filter_map(index).collect(),
            pole: marks.pole.as_ref().and_then(index),
            frame_rate: marks.frame_rate,
            meters_per_unit: marks.meters_per_unit,
            sets: marks.sets.iter().map(set).filter(|set| !set.bones.is_empty()).collect(),
            reference: marks.reference.clone().map(|stored| {
                let file = found_again(view, &stored.file);
                ReferenceSettings { file, ..stored }
            }),
            sound: marks.sound.clone().map(|stored| {
                let file = found_again(view, &stored.file);
                SoundSettings { file, ..stored }
            }),
            hidden_things: marks.hidden_things.clone(),
            locked_things: marks.locked_things.clone(),
        })
    }

    /// Notes that a model has the marks that were found again for it.
    pub(super) fn recalled(&mut self, view: &View, now: BoneMarks<'_>) {
        self.noted = Some(Noted::of(view, now));
    }
}

impl Noted {
    fn of(view: &View, now: BoneMarks<'_>) -> Self {
        let BoneMarks { flags, pins, pole, frame_rate, meters_per_unit, sets, reference, sound, things } =
            now;
        let (reference, sound) = (reference.version(), sound.version());
        let path = view.file.path.clone();
        let sets = sets.version();
        Self {
            path,
            version: flags.version(),
            pins: pins.to_vec(),
            pole,
            frame_rate,
            meters_per_unit,
            sets,
            reference,
            sound,
            things: things.map(|things| things.version),
        }
    }
}

/// Returns the folder of the file of a model.
fn folder_of(view: &View) -> Option<PathBuf> {
    let path = view.file.path.as_deref().or(view.loaded.path.as_deref())?;
    path.parent().map(Path::to_owned)
}

/// Returns the path of a file that is stored relative to the folder of a model.
fn found_again(view: &View, stored: &Path) -> PathBuf {
    folder_of(view).map_or_else(|| stored.to_owned(), |folder| resolved(&folder, stored))
}

impl FileMarks {
    /// Returns the marks of a model as they are stored.
    fn of(path: String, folder: Option<&Path>, skeleton: &Skeleton, now: BoneMarks<'_>) -> Self {
        let BoneMarks { flags, pins, pole, frame_rate, meters_per_unit, sets, reference, sound, things } =
            now;
        let stored = |file: &Path| folder.map_or_else(|| file.to_owned(), |folder| relative_to(folder, file));
        let reference = reference.settings().is_chosen().then(|| {
            let settings = reference.settings();
            ReferenceSettings { file: stored(&settings.file), ..settings.clone() }
        });
        let sound = sound.settings().is_chosen().then(|| {
            let settings = sound.settings();
            SoundSettings { file: stored(&settings.file), ..settings.clone() }
        });
        let names = BoneNames::of(skeleton);
        let set = |set: &SelectionSet| SetMarks {
            name: set.name.clone(),
            color: set.color,
            bones: set.bones.iter().map(|&bone| names.reference(bone)).collect(),
        };
        let list = |flag| flags.of(flag).map(|bone| names.reference(bone)).collect();
        Self {
            path,
            mute: list(BoneFlag::Mute),
            solo: list(BoneFlag::Solo),
            lock: list(BoneFlag::Lock),
            pins: pins.iter().map(|&bone| names.reference(bone)).collect(),
            pole: pole.map(|bone| names.reference(bone)),
            frame_rate,
            meters_per_unit,
            sets: sets.list().iter().map(set).collect(),
            reference,
            sound,
            hidden_things: things.map_or(Vec::new(), |things| things.hidden.iter().cloned().collect()),
            locked_things: things.map_or(Vec::new(), |things| things.locked.iter().cloned().collect()),
        }
    }
}
