//! Sizes of a growing file after each of its last frames, so that a movie can end before frames for which the disk has no room.

use crate::error::MovieError;
use std::collections::VecDeque;

/// Number of bytes at the end of a file in which frames are remembered: what was not written yet is less than half of it.
const REMEMBERED: u64 = 512 << 10;

/// Sizes of a file after its last frames.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrameEnds {
    frames: u64,
    ends: VecDeque<u64>,
}

impl FrameEnds {
    /// Returns the number of frames.
    pub(crate) fn frames(&self) -> u64 {
        self.frames
    }

    /// Returns the size of the file after the last frame; 0 without frames.
    pub(crate) fn whole(&self) -> u64 {
        self.ends.back().copied().unwrap_or(0)
    }

    /// Adds a frame, after which the file has a size.
    pub(crate) fn add(&mut self, size: u64) {
        self.frames += 1;
        self.ends.push_back(size);
        // Two frames are always remembered: the last one can be left out.
        while self.ends.len() > 2 && self.ends.get(1).is_some_and(|end| size - end > REMEMBERED) {
            self.ends.pop_front();
        }
    }

    /// Leaves the last frame out. Returns false, and changes nothing, where the frame before it is not remembered.
    pub(crate) fn leave_out(&mut self) -> bool {
        let can = self.ends.len() > 1;
        if can {
            self.ends.pop_back();
            self.frames -= 1;
        }
        can
    }
}

/// Completes a movie with `close`, again and again with one frame fewer while the disk has no room for it and `leave_out` can leave one out.
pub(crate) fn close_with_room<W>(
    writer: &mut W,
    close: impl Fn(&mut W) -> Result<(), MovieError>,
    leave_out: impl Fn(&mut W) -> bool,
) -> Result<(), MovieError> {
    while let Err(error) = close(writer) {
        if !error.is_out_of_room() || !leave_out(writer) {
            return Err(error);
        }
    }
    Ok(())
}

/// Returns a sentence about frames for which the disk had no room; `None` if there are none.
pub(crate) fn left_out(kept: u64, all: u64) -> Option<String> {
    (kept < all)
        .then(|| format!("The last {} of {all} frames were left out, because the disk is full", all - kept))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_frames_are_left_out_one_by_one_as_far_as_they_are_remembered() {
        let mut ends = FrameEnds::default();
        assert_eq!((ends.whole(), ends.leave_out()), (0, false));
        for frame in 1..=1000 {
            ends.add(frame * (2 << 10));
        }
        let mut left = 1000;
        while ends.leave_out() {
            left -= 1;
            assert_eq!((ends.frames(), ends.whole()), (left, left * (2 << 10)));
        }
        assert_eq!(left, 1000 - 512 / 2 - 1);
        let mut large = FrameEnds::default();
        (1..=3).for_each(|frame| large.add(frame << 30));
        assert_eq!((large.leave_out(), large.whole(), large.leave_out()), (true, 2 << 30, false));
    }
}
