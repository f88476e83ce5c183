//! The vocabulary of edits: everything that can be done to a model's takes, as values.
//!
//! The mouse, panels, menus, the command line, scripts and standard input all make these, and nothing else changes a
//! document. In JSON an edit is an object with its name in `"edit"`:
//!
//! ```json
//! {"edit": "set", "take": "Survey", "time": 0.5, "poses": [{"bone": "b_Head_05", "rotation": [0, 0, 0.26, 0.97]}]}
//! ```
//!
//! Times are seconds, on the clock of the take. Bones and takes go by name or by number. A number that is not finite, a
//! bone that there is not, a time where no key is: an error that says so, and nothing changes.

mod copied;
mod examples;
mod lines;
mod target;

pub use copied::{CopiedChannel, CopiedKey};
pub use examples::{EXAMPLES, Example};
pub use lines::{LONGEST_LINE, LineError, parse_lines};
pub use target::{BoneRef, KeySet, Property, SAME_TIME, TakeRef};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grows when a reader of today could misunderstand an edit of tomorrow.
pub const VERSION: u32 = 1;

/// Parts of a bone's pose; what is left out stays as it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BonePose {
    /// Which bone.
    pub bone: BoneRef,
    /// Metres, parent space.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub translation: Option<[f32; 3]>,
    /// Quaternion x, y, z, w, parent space; made unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[f32; 4]>,
    /// Factors per axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<[f32; 3]>,
}

/// Poses at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PoseAt {
    /// Seconds.
    pub time: f32,
    /// The poses wanted; one for each bone.
    pub poses: Vec<BonePose>,
}

/// What a reset leads back to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ResetTo {
    /// The pose as it was read: the change is taken away, bit for bit.
    #[default]
    Original,
    /// The pose of the bone when nothing animates it.
    Rest,
}

/// What a new key holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NewKey {
    /// What the key before it holds, exactly (thesis §2.2.2.4); before the first key: what the first one holds.
    #[default]
    Predecessor,
    /// What the take shows at that time, so that the motion stays as it is.
    Current,
}

/// How a channel finds what lies between its keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Between {
    /// The key before.
    Step,
    /// Mixed by distance.
    Linear,
    /// A spline with tangents; those of a channel that had none are chosen so that it runs smoothly through its keys.
    CubicSpline,
}

/// One thing done to a document.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "edit", rename_all = "snake_case", deny_unknown_fields)]
pub enum Edit {
    /// Gives bones a pose at a time. Where a channel has no key there, one is added that keeps the motion.
    Set {
        /// Which take.
        take: TakeRef,
        /// Seconds.
        time: f32,
        /// The poses wanted; one for each bone.
        poses: Vec<BonePose>,
    },
    /// Gives bones poses at several times at once: several [`Self::Set`] in one step.
    SetMany {
        /// Which take.
        take: TakeRef,
        /// The times, each with its poses.
        at: Vec<PoseAt>,
    },
    /// Moves, turns, scales bones on top of the pose they have at a time: translations are added (parent space),
    /// rotations multiplied from the left (parent space), scales multiplied.
    Offset {
        /// Which take.
        take: TakeRef,
        /// Seconds.
        time: f32,
        /// What comes on top; one for each bone.
        poses: Vec<BonePose>,
    },
    /// Takes changes back at a time.
    Reset {
        /// Which take.
        take: TakeRef,
        /// Seconds.
        time: f32,
        /// Which bones; all where empty.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        bones: Vec<BoneRef>,
        /// Which of their channels; all three where empty.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        properties: Vec<Property>,
        /// What to go back to.
        #[serde(default)]
        to: ResetTo,
    },
    /// Shows bones in a pose at a time without keys: it is part of the document and of undo, and of no saved file until it
    /// is keyed. What was pending of these channels there is replaced.
    Pend {
        /// Which take.
        take: TakeRef,
        /// Seconds.
        time: f32,
        /// The poses wanted; one for each bone.
        poses: Vec<BonePose>,
    },
    /// Puts copied poses on. Bones that this model has not are passed over.
    Paste {
        /// Which take.
        take: TakeRef,
        /// Seconds.
        time: f32,
        /// The poses that were copied; one for each bone.
        poses: Vec<BonePose>,
        /// On the other side: which bone that is is guessed from names, and the pose is mirrored.
        #[serde(default)]
        mirrored: bool,
        /// As pending poses instead of keys.
        #[serde(default)]
        pending: bool,
    },
    /// Turns pending poses into keys.
    KeyPending {
        /// Which take.
        take: TakeRef,
        /// Seconds; all times where none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        time: Option<f32>,
        /// Which bones; all where empty.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        bones: Vec<BoneRef>,
    },
    /// Gives pending poses up.
    DropPending {
        /// Which take.
        take: TakeRef,
        /// Seconds; all times where none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        time: Option<f32>,
        /// Which bones; all where empty.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        bones: Vec<BoneRef>,
    },
    /// Adds keys at a time, in the channels that have keys or, where bones are named, in the named ones.
    AddKeys {
        /// Which take.
        take: TakeRef,
        /// Seconds.
        time: f32,
        /// Which bones; all where empty.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        bones: Vec<BoneRef>,
        /// Which of their channels; all three where empty.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        properties: Vec<Property>,
        /// What they hold.
        #[serde(default)]
        value: NewKey,
    },
    /// Deletes keys. The last key of a take stays.
    DeleteKeys {
        /// Which take.
        take: TakeRef,
        /// Which keys.
        keys: Vec<KeySet>,
    },
    /// Moves keys in time. A key that comes to lie on another takes its place.
    MoveKeys {
        /// Which take.
        take: TakeRef,
        /// Which keys.
        keys: Vec<KeySet>,
        /// Seconds; negative is earlier.
        by: f32,
    },
    /// Scales the times of keys about a time; tangents keep their shape. A negative factor turns them round.
    ScaleKeys {
        /// Which take.
        take: TakeRef,
        /// Which keys.
        keys: Vec<KeySet>,
        /// Seconds: what stays where it is.
        about: f32,
        /// Not zero.
        factor: f32,
    },
    /// Copies keys to other times.
    DuplicateKeys {
        /// Which take.
        take: TakeRef,
        /// Which keys.
        keys: Vec<KeySet>,
        /// Seconds from each key to its copy.
        by: f32,
    },
    /// Puts copied keys in, with exactly what they held. A key that comes to lie on another takes its place. Bones that this
    /// model has not are passed over.
    PasteKeys {
        /// Which take.
        take: TakeRef,
        /// Seconds: where the first of them goes, as a rule.
        time: f32,
        /// The keys, by channels.
        channels: Vec<CopiedChannel>,
    },
    /// Moves every key at or after a time, in all channels: room is made, or taken away with what is in it.
    Ripple {
        /// Which take.
        take: TakeRef,
        /// Seconds.
        from: f32,
        /// Seconds; negative closes a gap, and the keys in it go.
        by: f32,
    },
    /// Moves keys to whole frames.
    SnapKeys {
        /// Which take.
        take: TakeRef,
        /// Which keys.
        keys: Vec<KeySet>,
        /// Frames a second, 1 to 1000; frame 0 is at 0 s.
        rate: f32,
    },
    /// Says how channels find what lies between their keys.
    SetInterpolation {
        /// Which take.
        take: TakeRef,
        /// Which bones; all where empty.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        bones: Vec<BoneRef>,
        /// Which of their channels; all three where empty.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        properties: Vec<Property>,
        /// How.
        interpolation: Between,
    },
    /// Sets the tangents of a key of a spline, in units a second; what is left out stays.
    SetTangents {
        /// Which take.
        take: TakeRef,
        /// Seconds: which key.
        time: f32,
        /// Which bone.
        bone: BoneRef,
        /// Which channel.
        property: Property,
        /// Arriving; three numbers, for rotations four.
        #[serde(default, rename = "in", skip_serializing_if = "Option::is_none")]
        arrive: Option<Vec<f32>>,
        /// Leaving.
        #[serde(default, rename = "out", skip_serializing_if = "Option::is_none")]
        leave: Option<Vec<f32>>,
    },
    /// Makes a take: a copy of one, or the rest pose as one key a bone.
    CreateTake {
        /// Its name.
        name: String,
        /// The take to copy; none: the rest pose.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        copy: Option<TakeRef>,
        /// Place in the list; none: behind the copied one, or last.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at: Option<usize>,
    },
    /// Deletes a take. The last one stays.
    DeleteTake {
        /// Which take.
        take: TakeRef,
    },
    /// Gives a take another name.
    RenameTake {
        /// Which take.
        take: TakeRef,
        /// Its name from now on.
        name: String,
    },
    /// Moves a take to another place in the list.
    MoveTake {
        /// Which take.
        take: TakeRef,
        /// Its place from now on.
        to: usize,
    },
    /// Cuts a take in two: what lies after the time goes into a new take behind it, which begins at 0 s.
    SplitTake {
        /// Which take.
        take: TakeRef,
        /// Seconds; both parts get a key there.
        time: f32,
        /// Name of the second part.
        name: String,
    },
    /// Leaves what lies between two times; keys are added at the cuts, so the motion in between stays.
    TrimTake {
        /// Which take.
        take: TakeRef,
        /// Seconds.
        from: f32,
        /// Seconds, not before `from`.
        to: f32,
    },
    /// Plays a take from its end: each key changes its place in the range of the take.
    ReverseTake {
        /// Which take.
        take: TakeRef,
    },
    /// Gives a take another start and another length: all keys are moved and scaled with it.
    RetimeTake {
        /// Which take.
        take: TakeRef,
        /// Seconds; none: as it is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        start: Option<f32>,
        /// Seconds, more than 0; none: as it is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        length: Option<f32>,
    },
}

impl Edit {
    /// The take it is about; `None` where it makes one.
    pub fn take(&self) -> Option<&TakeRef> {
        match self {
            Self::CreateTake { .. } => None,
            Self::Set { take, .. }
            | Self::SetMany { take, .. }
            | Self::Offset { take, .. }
            | Self::Reset { take, .. }
            | Self::Pend { take, .. }
            | Self::Paste { take, .. }
            | Self::KeyPending { take, .. }
            | Self::DropPending { take, .. }
            | Self::AddKeys { take, .. }
            | Self::DeleteKeys { take, .. }
            | Self::MoveKeys { take, .. }
            | Self::ScaleKeys { take, .. }
            | Self::DuplicateKeys { take, .. }
            | Self::PasteKeys { take, .. }
            | Self::Ripple { take, .. }
            | Self::SnapKeys { take, .. }
            | Self::SetInterpolation { take, .. }
            | Self::SetTangents { take, .. }
            | Self::DeleteTake { take }
            | Self::RenameTake { take, .. }
            | Self::MoveTake { take, .. }
            | Self::SplitTake { take, .. }
            | Self::TrimTake { take, .. }
            | Self::ReverseTake { take }
            | Self::RetimeTake { take, .. } => Some(take),
        }
    }

    /// For the history and the undo command: what was done, in a few words.
    pub fn label(&self) -> &'static str {
        match self {
            Self::Set { poses, .. } | Self::Offset { poses, .. } => pose_label(poses),
            Self::SetMany { at, .. } => at.first().map_or("Pose", |at| pose_label(&at.poses)),
            Self::Reset { to: ResetTo::Original, .. } => "Reset to original",
            Self::Reset { to: ResetTo::Rest, .. } => "Reset to rest pose",
            Self::Pend { poses, .. } => pending_label(poses),
            Self::Paste { mirrored: false, .. } => "Paste pose",
            Self::Paste { mirrored: true, .. } => "Paste pose mirrored",
            Self::KeyPending { .. } => "Key pending poses",
            Self::DropPending { .. } => "Drop pending poses",
            Self::AddKeys { .. } => "Add keys",
            Self::DeleteKeys { .. } => "Delete keys",
            Self::MoveKeys { .. } => "Move keys",
            Self::ScaleKeys { .. } => "Scale keys",
            Self::DuplicateKeys { .. } => "Duplicate keys",
            Self::PasteKeys { .. } => "Paste keys",
            Self::Ripple { .. } => "Ripple",
            Self::SnapKeys { .. } => "Snap keys to frames",
            Self::SetInterpolation { .. } => "Set interpolation",
            Self::SetTangents { .. } => "Set tangents",
            Self::CreateTake { copy: None, .. } => "Create take",
            Self::CreateTake { copy: Some(_), .. } => "Duplicate take",
            Self::DeleteTake { .. } => "Delete take",
            Self::RenameTake { .. } => "Rename take",
            Self::MoveTake { .. } => "Move take",
            Self::SplitTake { .. } => "Split take",
            Self::TrimTake { .. } => "Trim take",
            Self::ReverseTake { .. } => "Reverse take",
            Self::RetimeTake { .. } => "Retime take",
        }
    }
}

/// The same for poses that wait to be keyed.
fn pending_label(poses: &[BonePose]) -> &'static str {
    match pose_label(poses) {
        "Move" => "Move (pending)",
        "Rotate" => "Rotate (pending)",
        "Scale" => "Scale (pending)",
        _ => "Pose (pending)",
    }
}

/// Moved, turned, scaled, or several of these.
fn pose_label(poses: &[BonePose]) -> &'static str {
    let any = |has: fn(&BonePose) -> bool| poses.iter().any(has);
    let parts = (
        any(|pose| pose.translation.is_some()),
        any(|pose| pose.rotation.is_some()),
        any(|pose| pose.scale.is_some()),
    );
    match parts {
        (true, false, false) => "Move",
        (false, true, false) => "Rotate",
        (false, false, true) => "Scale",
        _ => "Pose",
    }
}
