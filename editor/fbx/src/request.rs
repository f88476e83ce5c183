//! The request: limits and choices, which the parent sends before the bytes of the file.

use crate::answer::{frame, unframe};
use dragonfly_anim::format::{Conventions, Handedness, UpAxis};
use serde::{Deserialize, Serialize};
use std::io::{self, Read};

/// First bytes of a request.
const MAGIC: &[u8; 8] = b"DFLYFBX?";

/// Largest request that a child reads.
const LONGEST: u32 = 4096;

/// Limits and choices of one import.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ParseRequest {
    /// Bytes of memory that the import may still use.
    pub(crate) memory: u64,
    meters_per_unit: Option<f32>,
    /// Axis that points up: 0 x, 1 y, 2 z.
    up: Option<u8>,
    /// Whether the axes are left-handed.
    is_left: Option<bool>,
    frame_rate: Option<f32>,
}

impl ParseRequest {
    /// Returns the request for an import with these choices.
    pub(crate) fn new(memory: u64, conventions: &Conventions) -> Self {
        Self {
            memory,
            meters_per_unit: conventions.meters_per_unit,
            up: conventions.up.map(|up| up as u8),
            is_left: conventions.handedness.map(|handedness| handedness == Handedness::Left),
            frame_rate: conventions.frame_rate,
        }
    }

    /// Returns the choices of the user.
    pub(crate) fn conventions(&self) -> Conventions {
        Conventions {
            meters_per_unit: self.meters_per_unit,
            up: self.up.and_then(up_axis),
            handedness: self.is_left.map(Handedness::of_left),
            frame_rate: self.frame_rate,
        }
    }

    /// Returns the bytes that go before those of the file.
    pub(crate) fn to_bytes(self) -> Vec<u8> {
        frame(MAGIC, &serde_json::to_vec(&self).unwrap_or_default())
    }

    /// Reads a request from the start of a stream.
    pub(crate) fn read(stream: &mut impl Read) -> io::Result<Self> {
        let mut start = [0; 12];
        stream.read_exact(&mut start)?;
        let (_, length) = unframe(MAGIC, &start).ok_or_else(|| io::Error::other("no request"))?;
        let mut json = vec![0; length.min(LONGEST) as usize];
        stream.read_exact(&mut json)?;
        serde_json::from_slice(&json).map_err(io::Error::other)
    }
}

/// Returns the axis of this number.
pub(crate) fn up_axis(number: u8) -> Option<UpAxis> {
    UpAxis::ALL.get(usize::from(number)).copied()
}
