//! Entries of a journal as JSON: each change, and from time to time a snapshot of all.

use super::base_skeleton::BaseSkeleton;
use super::edit::{Edit, VERSION};
use super::history::{Edited, Gesture};
use super::{Source, base};
use crate::demo::DRAGONFLY_GLB;
use dragonfly_anim::data::Take;
use dragonfly_anim::format::{Conventions, Handedness, UpAxis};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// One entry. Failed changes are not recorded, so each of them can be applied again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case")]
pub(super) enum Recorded<'a> {
    /// A program starts or resumes the journal: later gestures are different from earlier ones.
    Begin(EditsOrigin),
    /// An edit. Each edit of a gesture replaces the one before.
    Edit {
        edit: Cow<'a, Edit>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        gesture: Option<Gesture>,
    },
    /// A gesture was cancelled.
    Cancel { gesture: Gesture },
    /// Undo or redo until exactly this many steps are applied.
    GoTo { steps: usize },
}

/// The model to which the edits belong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct EditsOrigin {
    /// Version of the vocabulary of edits.
    pub(super) version: u32,
    /// Checksum of the built-in model, where that one is edited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) built_in: Option<u64>,
    /// The file that was read for a document that has no file now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) source: Option<String>,
    /// Units, axes and frame rate that the user chose for the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    conventions: Option<RecordedConventions>,
}

/// [`Conventions`] as JSON.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct RecordedConventions {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    meters_per_unit: Option<f32>,
    /// Position among [`UpAxis::ALL`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    up: Option<u8>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    left_handed: Option<bool>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    frame_rate: Option<f32>,
}

impl From<Conventions> for RecordedConventions {
    fn from(chosen: Conventions) -> Self {
        Self {
            meters_per_unit: chosen.meters_per_unit,
            up: chosen.up.map(|up| up as u8),
            left_handed: chosen.handedness.map(|hand| hand == Handedness::Left),
            frame_rate: chosen.frame_rate,
        }
    }
}

impl From<RecordedConventions> for Conventions {
    fn from(recorded: RecordedConventions) -> Self {
        Self {
            meters_per_unit: recorded.meters_per_unit,
            up: recorded.up.and_then(|up| UpAxis::ALL.get(usize::from(up)).copied()),
            handedness: recorded.left_handed.map(Handedness::of_left),
            frame_rate: recorded.frame_rate,
        }
    }
}

impl EditsOrigin {
    /// Describes a model that was read from `source` and is not saved yet, or the document of the journal where
    /// `None`, which was read with these conventions.
    pub(super) fn new(source: Option<&Source>, chosen: Conventions) -> Self {
        let (built_in, source) = match source {
            None => (None, None),
            Some(Source::BuiltIn) => (Some(built_in_hash()), None),
            Some(Source::File(path) | Source::FileAs(path, _)) => (None, path.to_str().map(str::to_owned)),
        };
        let conventions = (chosen != Conventions::default()).then(|| chosen.into());
        Self { version: VERSION, built_in, source, conventions }
    }

    /// Returns the model that was read for a document without a file; `None` where the document has a file.
    pub(super) fn source(&self) -> Option<Source> {
        match (&self.source, self.built_in) {
            (Some(path), _) => Some(Source::of(path.into(), self.conventions())),
            (None, Some(_)) => Some(Source::BuiltIn),
            (None, None) => None,
        }
    }

    /// Returns the units, axes and frame rate that the user chose for the file.
    pub(super) fn conventions(&self) -> Conventions {
        self.conventions.map(Conventions::from).unwrap_or_default()
    }
}

/// Returns the checksum by which versions of the built-in model are distinguished.
pub(super) fn built_in_hash() -> u64 {
    dragonfly_store::hash(DRAGONFLY_GLB)
}

/// A snapshot of the whole history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Snapshot {
    pub(super) about: EditsOrigin,
    /// The edits of the steps; of a gesture, its last one.
    pub(super) steps: Vec<Edit>,
    /// Number of steps that are applied.
    pub(super) done: usize,
    /// Number of steps that were applied at the last save, where that state can be reached.
    pub(super) saved: Option<usize>,
    /// Whether the takes with which the history starts follow. If not, the history starts with those of the file.
    pub(super) has_base: bool,
    /// The skeleton with which the history starts, where edits added root bones; otherwise it is that of the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) skeleton: Option<BaseSkeleton>,
    /// The texts with which the history starts, as names and contents; none for a model, and where it starts with those of the file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) texts: Vec<(String, String)>,
}

impl Snapshot {
    /// Writes a snapshot of `edited`, whose history started with the takes `base`, or else with those of the file. Where the oldest
    /// steps were removed, the takes before the first one that is left are written.
    pub(super) fn bytes(
        about: EditsOrigin,
        edited: &Edited,
        base: Option<&[Arc<Take>]>,
    ) -> serde_json::Result<Vec<u8>> {
        let base = if edited.is_cut() {
            let mut first = edited.clone();
            first.go_to(0);
            Some(base::write(&first.adapter().saved_takes()))
        } else {
            base.map(base::write)
        };
        let (steps, done) = edited.steps();
        let steps = steps.iter().map(|step| step.edit.clone()).collect();
        let skeleton = Some(edited.base_skeleton()).filter(|base| base.has_roots()).cloned();
        let (saved, has_base) = (edited.saved(), base.is_some());
        let texts = edited.base_texts().list().iter().filter(|_| has_base);
        let texts = texts.map(|file| (file.name.to_string(), file.text.to_string())).collect();
        let snapshot = Self { about, steps, done, saved, has_base, skeleton, texts };
        let mut bytes = vec![0; 4];
        serde_json::to_writer(&mut bytes, &snapshot)?;
        let length = u32::try_from(bytes.len() - 4).unwrap_or(u32::MAX);
        bytes[..4].copy_from_slice(&length.to_le_bytes());
        bytes.extend(base.unwrap_or_default());
        Ok(bytes)
    }

    /// Reads a snapshot and its base from `bytes`.
    pub(super) fn read(bytes: &[u8]) -> Option<(Self, Option<&[u8]>)> {
        let (length, rest) = bytes.split_first_chunk::<4>()?;
        let (text, base) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        let snapshot: Self = serde_json::from_slice(text).ok()?;
        let base = snapshot.has_base.then_some(base);
        Some((snapshot, base))
    }
}
