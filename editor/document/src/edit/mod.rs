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
mod label;
mod lines;
mod mode;
mod pose;
mod target;

pub use copied::{CopiedChannel, CopiedKey};
pub use examples::{EXAMPLES, Example};
pub use lines::{LONGEST_LINE, LineError, parse_lines};
pub use mode::{Between, NewKey, ResetTo};
pub use pose::{BonePose, PoseAt};
pub use target::{BoneRef, KeySet, Property, SAME_TIME, TakeRef};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grows when a reader of today could misunderstand an edit of tomorrow.
pub const VERSION: u32 = 1;

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
        /// Channels that stand still in steps (two equal keys, as exporters write what does not move) become linear first, so
        /// that the pose is moved to, not jumped to.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        unstep: bool,
    },
    /// Gives bones poses at several times at once: several [`Self::Set`] in one step.
    SetMany {
        /// Which take.
        take: TakeRef,
        /// The times, each with its poses.
        at: Vec<PoseAt>,
        /// Channels that stand still in steps (two equal keys, as exporters write what does not move) become linear first, so
        /// that the pose is moved to, not jumped to.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        unstep: bool,
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
        /// Channels that stand still in steps (two equal keys, as exporters write what does not move) become linear first, so
        /// that the pose is moved to, not jumped to.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        unstep: bool,
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
        /// Channels that stand still in steps (two equal keys, as exporters write what does not move) become linear first, so
        /// that the pose is moved to, not jumped to.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        unstep: bool,
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
        /// Channels that stand still in steps (two equal keys, as exporters write what does not move) become linear first, so
        /// that the pose is moved to, not jumped to.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        unstep: bool,
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
        /// Only in channels that have keys, also of bones that are named.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        keyed_only: bool,
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
        /// What is left moves to where the take began.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        to_start: bool,
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
