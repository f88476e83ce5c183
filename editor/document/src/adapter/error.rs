//! Why an edit cannot be done; nothing has changed then.

use super::super::edit::{BoneRef, Property, TakeRef};
use std::fmt;
use thiserror::Error;

/// Why an edit cannot be done.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum EditError {
    /// The take is not there.
    #[error("there is no take {}", Quoted(.0))]
    NoTake(TakeRef),
    /// The bone is not there.
    #[error("there is no bone {}", Quoted(.0))]
    NoBone(BoneRef),
    /// The take has no track for the bone.
    #[error("the take has no track for bone {0}")]
    NoTrack(u32),
    /// No key is where one is needed.
    #[error("bone {bone} has no {} key at {time} s", property.name())]
    NoKey {
        /// Index of the bone.
        bone: u32,
        /// Which channel.
        property: Property,
        /// Seconds.
        time: f32,
    },
    /// A number that cannot be used.
    #[error("{what} cannot be {value}")]
    Number {
        /// Which number.
        what: &'static str,
        /// What it is.
        value: f32,
    },
    /// A column of numbers of another length.
    #[error("{what} takes {wanted} numbers, not {given}")]
    Count {
        /// Which numbers.
        what: &'static str,
        /// How many are needed.
        wanted: usize,
        /// How many are there.
        given: usize,
    },
    /// A rotation without length.
    #[error("a rotation of length zero turns nowhere")]
    NoRotation,
    /// Original × change cannot give this.
    #[error("bone {bone}: the original scale has a zero, and no factor makes anything else of it")]
    ZeroScale {
        /// Index of the bone.
        bone: u32,
    },
    /// A key would lie before the begin of time.
    #[error("a key would come to lie at {0} s; files have no times before 0 s")]
    BeforeZero(f32),
    /// Keys would fall together.
    #[error("keys would come to lie on each other")]
    TooShort,
    /// A take keeps a key.
    #[error("a take keeps at least one key")]
    LastKey,
    /// A name of nothing but spaces.
    #[error("a take needs a name")]
    NoName,
    /// The name of another take.
    #[error("another take is called {0:?}")]
    NameTaken(String),
    /// A document keeps a take.
    #[error("a model keeps at least one take")]
    LastTake,
    /// The time is not inside.
    #[error("{time} s is not between the first key ({start} s) and the last ({end} s)")]
    Outside {
        /// Seconds.
        time: f32,
        /// Seconds.
        start: f32,
        /// Seconds.
        end: f32,
    },
    /// The channel is no spline.
    #[error("bone {bone}: the {} channel is no spline and has no tangents", property.name())]
    NoSpline {
        /// Index of the bone.
        bone: u32,
        /// Which channel.
        property: Property,
    },
    /// Nothing would be done.
    #[error("{0}")]
    Nothing(&'static str),
}

/// A name in quotes, a number without.
struct Quoted<'a, T>(&'a T);

impl fmt::Display for Quoted<'_, TakeRef> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            TakeRef::Index(index) => write!(out, "{index}"),
            TakeRef::Name(name) => write!(out, "{name:?}"),
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
