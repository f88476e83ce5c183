//! The samples of a track of an MP4 that grows: sizes, durations and places, and the part of them that is played.

use dragonfly_anim::stage::time::StageRate;
use shiguredo_mp4::boxes::SampleEntry;
use std::num::NonZeroU32;

/// Lowest number of ticks in a second: some players round times of coarser ones.
const FEWEST_TICKS: u32 = 10_000;

/// Samples that follow each other in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleChunk {
    /// Offset from the first sample of the file.
    pub(super) offset: u64,
    pub(super) samples: u32,
}

/// Kind of a track, with what only that kind has.
#[derive(Clone, Debug)]
pub(super) enum TrackKind {
    /// Pictures: their size, and the numbers, from 1, of those that need no other one.
    Pictures { size: [u16; 2], whole: Vec<NonZeroU32> },
    /// Sound: the number of packets that a decoder needs before the one from which it plays.
    Sound { roll: u16 },
}

/// The part of a track that is played, in ticks.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlayedPart {
    /// Ticks at the start that are decoded only.
    pub(super) skip: u64,
    /// Ticks that are played.
    pub(super) played: u64,
}

/// The samples of a track.
#[derive(Clone, Debug)]
pub(super) struct TrackTable {
    pub(super) kind: TrackKind,
    pub(super) entry: SampleEntry,
    /// Ticks in a second.
    pub(super) timescale: NonZeroU32,
    /// Numbers of samples that follow each other, and the duration of each.
    pub(super) durations: Vec<(u32, u32)>,
    pub(super) sizes: Vec<u32>,
    pub(super) chunks: Vec<SampleChunk>,
    /// The part that is played; `None` for all.
    pub(super) edit: Option<PlayedPart>,
    /// Duration of all samples.
    duration: u64,
}

impl TrackTable {
    pub(super) fn new(kind: TrackKind, entry: SampleEntry, timescale: NonZeroU32) -> Self {
        let (durations, sizes, chunks) = (Vec::new(), Vec::new(), Vec::new());
        Self { kind, entry, timescale, durations, sizes, chunks, edit: None, duration: 0 }
    }

    /// Returns the duration of all samples.
    pub(super) fn duration(&self) -> u64 {
        self.duration
    }

    /// Returns the duration of what is played.
    pub(super) fn played(&self) -> u64 {
        self.edit.map_or(self.duration, |edit| edit.played)
    }

    /// Returns the duration of what is played in other ticks, rounded up.
    pub(super) fn played_in(&self, timescale: NonZeroU32) -> u64 {
        self.ticks_in(timescale).div_ceil(u128::from(self.timescale.get())) as u64
    }

    /// Returns the duration of what is played in other ticks, rounded down: a part of another track that is this long does not end after it.
    pub(super) fn played_within(&self, timescale: NonZeroU32) -> u64 {
        (self.ticks_in(timescale) / u128::from(self.timescale.get())) as u64
    }

    fn ticks_in(&self, timescale: NonZeroU32) -> u128 {
        u128::from(self.played()) * u128::from(timescale.get())
    }

    /// Adds a sample at an offset; `opens` begins a chunk with it.
    pub(super) fn add(&mut self, offset: u64, size: u32, duration: u32, opens: bool) {
        match self.chunks.last_mut().filter(|_| !opens) {
            Some(chunk) => chunk.samples += 1,
            None => self.chunks.push(SampleChunk { offset, samples: 1 }),
        }
        match self.durations.last_mut().filter(|(_, each)| *each == duration) {
            Some((count, _)) => *count += 1,
            None => self.durations.push((1, duration)),
        }
        self.sizes.push(size);
        self.duration += u64::from(duration);
    }

    /// Returns the offset of a sample, counted from 0; `None` if there is none with this number.
    pub(super) fn offset_of(&self, sample: usize) -> Option<u64> {
        let mut first = 0;
        for chunk in &self.chunks {
            let after = first + chunk.samples as usize;
            if sample < after {
                let before = self.sizes.get(first..sample)?.iter().map(|size| u64::from(*size));
                return Some(chunk.offset + before.sum::<u64>());
            }
            first = after;
        }
        None
    }

    /// Removes the samples from an offset on, which is the end of a sample.
    pub(super) fn cut(&mut self, offset: u64) {
        let mut left = self.sizes.len();
        while let Some(chunk) = self.chunks.pop() {
            let first = left - chunk.samples as usize;
            let mut start = chunk.offset;
            let kept = self.sizes[first..left].iter().take_while(|size| {
                let is_before = start < offset;
                start += u64::from(**size);
                is_before
            });
            let kept = kept.count();
            left = first + kept;
            if kept > 0 {
                self.chunks.push(SampleChunk { samples: kept as u32, ..chunk });
                break;
            }
        }
        let mut removed = self.sizes.len() - left;
        self.sizes.truncate(left);
        while let Some((count, each)) = self.durations.last_mut().filter(|_| removed > 0) {
            let fewer = removed.min(*count as usize);
            *count -= fewer as u32;
            removed -= fewer;
            self.duration -= fewer as u64 * u64::from(*each);
            if *count == 0 {
                self.durations.pop();
            }
        }
        match &mut self.kind {
            TrackKind::Pictures { whole, .. } => {
                whole.truncate(whole.partition_point(|number| number.get() as usize <= left));
            }
            TrackKind::Sound { .. } => {}
        }
    }
}

/// Returns ticks in a second and in a frame, so that the rate is exact.
pub(super) fn ticks(rate: StageRate) -> (NonZeroU32, u32) {
    let (frames, seconds) = rate.fraction();
    let mut by = 1;
    while frames * by < FEWEST_TICKS {
        by *= 2;
    }
    (NonZeroU32::MIN.saturating_add(frames * by - 1), seconds * by)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mp4::label::plain_box;

    #[test]
    fn a_track_that_is_cut_is_one_that_ended_there() {
        let number = |number| NonZeroU32::new(number).unwrap();
        let track = |count: usize| {
            let kind = TrackKind::Pictures { size: [2, 2], whole: Vec::new() };
            let entry = SampleEntry::Unknown(plain_box(*b"test", Vec::new()));
            let mut track = TrackTable::new(kind, entry, number(24));
            let mut offset = 0;
            for at in 0..count {
                let size = 10 + at as u32;
                // Chunks of three samples, with other samples of 100 bytes between them; the fifth sample and all later ones are longer.
                if at % 3 == 0 {
                    offset += 100;
                    let TrackKind::Pictures { whole, .. } = &mut track.kind else { unreachable!() };
                    whole.push(number(at as u32 + 1));
                }
                track.add(offset, size, if at < 4 { 1 } else { 2 }, at % 3 == 0);
                offset += u64::from(size);
            }
            track
        };
        let whole = track(11);
        for kept in 0..=11 {
            let mut cut = whole.clone();
            cut.cut(whole.offset_of(kept).unwrap_or(u64::MAX));
            assert_eq!(format!("{cut:?}"), format!("{:?}", track(kept)), "{kept} samples");
        }
        assert_eq!(whole.offset_of(4), Some(100 + 10 + 11 + 12 + 100 + 13));
        assert_eq!(whole.offset_of(11), None);
    }

    #[test]
    fn ticks_keep_the_rate_exactly() {
        for text in ["24", "24000/1001", "12.5", "1", "1000", "4294967295/4294967294"] {
            let rate = StageRate::parse(text).unwrap();
            let (second, frame) = ticks(rate);
            let (frames, seconds) = rate.fraction();
            assert!(second.get() >= FEWEST_TICKS);
            assert_eq!(
                u64::from(second.get()) * u64::from(seconds),
                u64::from(frame) * u64::from(frames),
                "{text}"
            );
        }
    }
}
