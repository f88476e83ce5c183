//! What the journal holds of a document, as JSON: each change that was done, and now and then all of them at once.

use super::Source;
use super::edit::{Edit, VERSION};
use super::history::{Edited, Gesture};
use crate::demo::DRAGONFLY_GLB;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// One record. What went wrong is not recorded, so each of them can be done again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case")]
pub(super) enum Recorded<'a> {
    /// A program begins, or goes on: gestures from here on are none of those before.
    Begin(About),
    /// An edit; of a gesture, its newest form.
    Edit {
        edit: Cow<'a, Edit>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        gesture: Option<Gesture>,
    },
    /// The gesture as if it had never begun.
    Cancel { gesture: Gesture },
    /// As many steps are done as this.
    GoTo { steps: usize },
}

/// For whom the edits are meant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct About {
    /// Of the vocabulary of edits.
    pub(super) version: u32,
    /// The checksum of the model that is part of the program, where that one is edited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) built_in: Option<u64>,
    /// The file that was read for what is a document without a file now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) source: Option<String>,
}

impl About {
    /// For what was read from `source` and is saved nowhere yet, or for the document of the journal.
    pub(super) fn new(source: Option<&Source>) -> Self {
        let (built_in, source) = match source {
            None => (None, None),
            Some(Source::BuiltIn) => (Some(built_in_hash()), None),
            Some(Source::File(path)) => (None, path.to_str().map(str::to_owned)),
        };
        Self { version: VERSION, built_in, source }
    }

    /// What was read, where the journal does not say it.
    pub(super) fn source(&self) -> Option<Source> {
        match (&self.source, self.built_in) {
            (Some(path), _) => Some(Source::File(path.into())),
            (None, Some(_)) => Some(Source::BuiltIn),
            (None, None) => None,
        }
    }
}

/// Tells the built-in model of this program from that of another version.
pub(super) fn built_in_hash() -> u64 {
    dragonfly_store::hash(DRAGONFLY_GLB)
}

/// The whole history at once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Snapshot {
    pub(super) about: About,
    /// The steps; of a gesture, what it came to.
    pub(super) steps: Vec<Edit>,
    /// How many of them are done.
    pub(super) done: usize,
    /// How many were done when the file was saved, where that can be reached.
    pub(super) saved: Option<usize>,
    /// Do the takes with which the steps began follow? Else they are those of the file.
    pub(super) has_base: bool,
}

impl Snapshot {
    /// `edited`, which began with the takes in `base` or else with those of the file.
    pub(super) fn bytes(about: About, edited: &Edited, base: Option<&[u8]>) -> serde_json::Result<Vec<u8>> {
        let (steps, done) = edited.steps();
        let steps = steps.iter().map(|step| step.edit.clone()).collect();
        let snapshot = Self { about, steps, done, saved: edited.saved(), has_base: base.is_some() };
        let mut bytes = vec![0; 4];
        serde_json::to_writer(&mut bytes, &snapshot)?;
        let length = u32::try_from(bytes.len() - 4).unwrap_or(u32::MAX);
        bytes[..4].copy_from_slice(&length.to_le_bytes());
        bytes.extend(base.unwrap_or_default());
        Ok(bytes)
    }

    /// The snapshot in `bytes`, and its base.
    pub(super) fn read(bytes: &[u8]) -> Option<(Self, Option<&[u8]>)> {
        let (length, rest) = bytes.split_first_chunk::<4>()?;
        let (text, base) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        let snapshot: Self = serde_json::from_slice(text).ok()?;
        let base = snapshot.has_base.then_some(base);
        Some((snapshot, base))
    }
}
