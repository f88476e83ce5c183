//! The reason why an edit cannot be applied.

use super::key_bytes::KEY_BYTES;
use crate::edit::target::{BoneRef, LayerRef, Property, ShapeRef, TakeRef};
use dragonfly_anim::inbetween::UniformTimes;
use dragonfly_anim::limits::{CLIP_SECONDS, KEYS_PER_CHANNEL};
use std::fmt;
use thiserror::Error;

/// The reason why an edit cannot be applied. Nothing has changed then.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum EditError {
    /// The take does not exist.
    #[error("there is no take {}", Quoted(.0))]
    NoTake(TakeRef),
    /// The bone does not exist.
    #[error("there is no bone {}", Quoted(.0))]
    NoBone(BoneRef),
    /// No mesh, or not the given one, has the shape key.
    #[error("there is no shape key {}", Quoted(.0))]
    NoShape(ShapeRef),
    /// A take that is added has two lists of shape keys for one mesh.
    #[error("the shape keys of mesh {0} are given twice")]
    MeshTwice(u32),
    /// The take has no track for the bone.
    #[error("the take has no track for bone {0}")]
    NoTrack(u32),
    /// There is no key at that time.
    #[error("bone {bone} has no {} key at {time} s", property.name())]
    NoKey {
        /// Index of the bone.
        bone: u32,
        /// Which channel.
        property: Property,
        /// Seconds.
        time: f32,
    },
    /// A number is out of range.
    #[error("{what} cannot be {value}")]
    Number {
        /// Name of the number.
        what: &'static str,
        /// The given value.
        value: f32,
    },
    /// A list has a wrong number of numbers.
    #[error("{what} needs {wanted} numbers, not {given}")]
    Count {
        /// Name of the numbers.
        what: &'static str,
        /// Number of numbers needed.
        wanted: usize,
        /// Number of numbers given.
        given: usize,
    },
    /// A rotation has length zero.
    #[error("a rotation must not have length zero")]
    NoRotation,
    /// The original scale has a zero, which no factor turns into another number.
    #[error("bone {bone}: the original scale has a zero, which no factor can change")]
    ZeroScale {
        /// Index of the bone.
        bone: u32,
    },
    /// A key would have a time before 0 s.
    #[error("a key would be at {0} s; times before 0 s cannot be saved")]
    BeforeZero(f32),
    /// A key would be later than any file may have it.
    #[error("a key would be at {0} s; times after {CLIP_SECONDS} s cannot be saved")]
    TooLate(f32),
    /// A channel would have too many keys.
    #[error("a channel would have {keys} keys; at most {KEYS_PER_CHANNEL} can be saved and opened again")]
    TooManyKeys {
        /// Number of keys.
        keys: usize,
    },
    /// The keys of all takes would be too large.
    #[error(
        "the takes would have {} MiB of keys; at most {} MiB can be saved and opened again", bytes >> 20, KEY_BYTES >> 20
    )]
    TooLarge {
        /// Number of bytes.
        bytes: u64,
    },
    /// There is not enough memory for the keys.
    #[error("there is not enough memory for that many keys")]
    NoMemory,
    /// A filter would need too many samples.
    #[error("a channel would be sampled more than {} times; use a lower sample rate", UniformTimes::LARGEST)]
    TooManySamples,
    /// Keys would have the same time.
    #[error("keys would be at the same time; use a larger length")]
    TooShort,
    /// The last key of a take would be deleted.
    #[error("a take must keep at least one key")]
    LastKey,
    /// A name is empty or blank.
    #[error("a take needs a name")]
    NoName,
    /// Another take has the name.
    #[error("another take has the name {0:?}")]
    NameTaken(String),
    /// The last take would be deleted.
    #[error("a model must keep at least one take")]
    LastTake,
    /// The time is outside of the take.
    #[error("{time} s is not between the first key ({start} s) and the last ({end} s)")]
    Outside {
        /// Seconds.
        time: f32,
        /// Seconds.
        start: f32,
        /// Seconds.
        end: f32,
    },
    /// The channel is not a spline.
    #[error("bone {bone}: the {} channel is not a cubic spline and has no tangents", property.name())]
    NoSpline {
        /// Index of the bone.
        bone: u32,
        /// Which channel.
        property: Property,
    },
    /// The edit would change a bone that it does not name, so that no lock of the bone could stop it: a bug in this program.
    #[error("bone {0} would change, although the edit does not name it; this is an error of the program")]
    Unnamed(u32),
    /// Contacts cannot be locked.
    #[error(transparent)]
    Lock(#[from] dragonfly_anim::contact::LockError),
    /// A loop cannot be closed.
    #[error(transparent)]
    Close(#[from] dragonfly_anim::loops::CloseError),
    /// A loop cannot be shifted.
    #[error(transparent)]
    Shift(#[from] dragonfly_anim::loops::ShiftError),
    /// Travel cannot be removed, moved or put back.
    #[error(transparent)]
    Travel(#[from] dragonfly_anim::motion::MotionError),
    /// A root bone cannot be added.
    #[error(transparent)]
    RootBone(#[from] dragonfly_anim::root_bone::RootBoneError),
    /// A take cannot be sampled.
    #[error(transparent)]
    Frames(#[from] dragonfly_anim::frames::FramesError),
    /// The edit is not possible on a layer.
    #[error("\"{0}\" is not possible in a layer; choose the take itself")]
    OnLayer(&'static str),
    /// The edit is not possible on a take with layers.
    #[error("\"{0}\" is not possible in a take with layers; merge them first")]
    HasLayers(&'static str),
    /// The edit is for a layer.
    #[error("\"{0}\" needs a layer, such as {{\"take\": \"Walk\", \"layer\": 0}}")]
    NeedsLayer(&'static str),
    /// The layer does nothing, so no key in it could give the pose.
    #[error("the layer \"{0}\" is muted")]
    MutedLayer(String),
    /// The bone is not in the mask of the layer.
    #[error("bone {bone} is not in the mask of the layer \"{layer}\"")]
    Masked {
        /// Index of the bone.
        bone: u32,
        /// Name of the layer.
        layer: String,
    },
    /// No key of the layer gives the pose.
    #[error(
        "no key of the layer \"{0}\" gives this pose: its weight is 0 there, or a layer above it hides it"
    )]
    HiddenByLayer(String),
    /// A text cannot be edited.
    #[error(transparent)]
    Text(#[from] super::TextEditError),
    /// The edit would change nothing.
    #[error("{0}")]
    Nothing(&'static str),
}

/// Writes a name in quotes and a number without.
struct Quoted<'a, T>(&'a T);

impl fmt::Display for Quoted<'_, TakeRef> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            TakeRef::Index(index) => write!(out, "{index}"),
            TakeRef::Name(name) => write!(out, "{name:?}"),
            TakeRef::Layer { take, layer: LayerRef::Index(layer) } => {
                write!(out, "{}, layer {layer}", Quoted(&**take))
            }
            TakeRef::Layer { take, layer: LayerRef::Name(layer) } => {
                write!(out, "{}, layer {layer:?}", Quoted(&**take))
            }
        }
    }
}

impl fmt::Display for Quoted<'_, BoneRef> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            BoneRef::Index(index) => write!(out, "{index}"),
            BoneRef::Name(name) => write!(out, "{name:?}"),
        }
    }
}

impl fmt::Display for Quoted<'_, ShapeRef> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            ShapeRef::Index(index) => write!(out, "{index}"),
            ShapeRef::Name(name) => write!(out, "{name:?}"),
        }
    }
}
