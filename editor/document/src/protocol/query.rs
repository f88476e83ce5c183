//! Queries: what a client can read of a document.

use super::scene_answers::SceneAnswers;
use crate::adapter::{ModelAdapter, TakeVersions};
use crate::edit::{BoneRef, Property, TakeRef, TextRef};
use crate::history::Edited;
use dragonfly_anim::sample::sample_track;
use serde::Deserialize;
use serde_json::{Value, json};

/// A query: data of the document that a client reads.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "query", rename_all = "snake_case", deny_unknown_fields)]
pub enum Query {
    /// The takes: name, start, end, number of keys, whether anything was changed, how many poses are pending.
    Takes,
    /// The bones: name, parent.
    Bones,
    /// The steps of the history, how many are done, whether all is saved.
    History,
    /// Original, change and result of a bone at a time, and what is pending there, relative to its parent.
    Pose {
        /// The take.
        take: TakeRef,
        /// Seconds.
        time: f32,
        /// The bone.
        bone: BoneRef,
    },
    /// The texts of a scene or project: name, number of bytes.
    Texts,
    /// A text.
    Text {
        /// The text; the main one if absent.
        #[serde(default)]
        text: Option<TextRef>,
    },
    /// The errors of a scene, and notes about what is probably not meant.
    ///
    /// `errors` and `notes` are lists in the order of `text`, the name of the script or of the first script of a project; where the project
    /// has none that can be read, of the project. Each has `line`, `column`, the bytes `from` and `to`, `message` and `help`; an error in
    /// an included file has its `file`, `line`, `column`, `from` and `to` there as `inside`, and its own place is that of the `include`. A
    /// project has `texts`, too: a list with `text`, `errors` and `notes` of itself, of each of its scripts that is read, and of its lines if
    /// they are wrong. Only
    /// where there are any, `lines` has `text` and `errors` of its file of lines, and `edits` is a list of sentences about edits of models
    /// that are not applied. A text has at most 100 errors.
    Errors,
    /// The length of a scene, and when each of its actions begins and ends, in seconds.
    Schedule,
    /// The keys of a bone: times of each channel.
    Keys {
        /// The take.
        take: TakeRef,
        /// The bone.
        bone: BoneRef,
    },
}

impl Query {
    /// Returns the answer.
    ///
    /// # Errors
    ///
    /// The reason why there is no answer: a take, bone or text does not exist, the time is not finite, or the script has errors.
    pub(super) fn answer(&self, edited: &Edited, scene: &mut SceneAnswers) -> Result<Value, String> {
        let adapter = edited.adapter();
        match self {
            Self::Takes => Ok(adapter.slots().iter().map(|slot| take(slot)).collect()),
            Self::Bones => Ok(bones(adapter)),
            Self::History => {
                let (steps, done) = edited.steps();
                let steps: Vec<_> = steps.iter().map(|step| step.edit.label()).collect();
                Ok(json!({"steps": steps, "done": done, "saved": edited.is_saved()}))
            }
            Self::Pose { take, time, bone } => {
                let (slot, bone) = found(adapter, take, bone)?;
                if !time.is_finite() {
                    return Err(format!("a time cannot be {time}"));
                }
                Ok(pose(adapter, slot, *time, bone))
            }
            Self::Texts => Ok(SceneAnswers::texts(adapter.texts())),
            Self::Text { text } => SceneAnswers::text(adapter, text.as_ref()),
            Self::Errors => scene.errors(adapter.texts()),
            Self::Schedule => scene.schedule(adapter.texts()),
            Self::Keys { take, bone } => {
                let (slot, bone) = found(adapter, take, bone)?;
                let track = slot.result.tracks.get(bone as usize);
                let times = |property| match (track, property) {
                    (None, _) => Vec::new(),
                    (Some(track), Property::Translation) => track.translation.times.to_vec(),
                    (Some(track), Property::Rotation) => track.rotation.times.to_vec(),
                    (Some(track), Property::Scale) => track.scale.times.to_vec(),
                };
                Ok(Property::ALL
                    .into_iter()
                    .map(|property| (property.name().to_owned(), json!(times(property))))
                    .collect())
            }
        }
    }
}

fn found<'a>(
    adapter: &'a ModelAdapter,
    take: &TakeRef,
    bone: &BoneRef,
) -> Result<(&'a TakeVersions, u32), String> {
    let slot = adapter.take(take).map_err(|error| error.to_string())?;
    Ok((slot, adapter.bone(bone).map_err(|error| error.to_string())?))
}

fn take(slot: &TakeVersions) -> Value {
    let take = &slot.result;
    let changed = slot.changed().next().is_some();
    json!({"name": take.name, "start": take.start, "end": take.end(), "keys": take.keys(), "changed": changed,
           "origin": slot.origin, "pending": slot.pending_poses()})
}

fn bones(adapter: &ModelAdapter) -> Value {
    let bones = &adapter.skeleton().bones;
    bones.iter().map(|bone| json!({"name": bone.name, "parent": bone.parent, "node": bone.node})).collect()
}

fn pose(adapter: &ModelAdapter, slot: &TakeVersions, time: f32, bone: u32) -> Value {
    let rules = &adapter.skeleton().bones[bone as usize];
    let [original, result] = [&slot.original, &slot.result].map(|take| {
        let pose =
            take.tracks.get(bone as usize).map_or(rules.rest, |track| sample_track(track, rules, time));
        json!({"translation": pose.translation.to_array(), "rotation": pose.rotation.to_array(),
               "scale": pose.scale.to_array()})
    });
    let changes: serde_json::Map<String, Value> = Property::ALL
        .into_iter()
        .filter_map(|property| {
            let key = slot.key_at(bone, property, time)?;
            Some((property.name().to_owned(), json!(slot.change(bone, property, key))))
        })
        .collect();
    let pending: serde_json::Map<String, Value> = slot
        .pending_at(time)
        .and_then(|at| at.of(bone))
        .into_iter()
        .flat_map(|pose| {
            Property::ALL.into_iter().filter_map(|property| {
                let count = if property == Property::Rotation { 4 } else { 3 };
                Some((property.name().to_owned(), json!(pose.get(property)?[..count])))
            })
        })
        .collect();
    json!({"original": original, "change": changes, "result": result, "pending": pending})
}
