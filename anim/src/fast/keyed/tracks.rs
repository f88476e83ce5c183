//! Blocks of eight bones that are keyed at the same times.

use super::super::key_table::{KeyPosition, KeyTable};
use super::super::simd::{LANES, Simd};
use super::super::slerp::FastSlerp;

/// One key of eight bones: `N` coordinates of eight numbers.
pub(super) type BlockKey<const N: usize> = [[f32; LANES]; N];

/// A block and its keys.
type BlockTrack<const N: usize> = (u32, Vec<BlockKey<N>>);

/// Tracks with the same key times. Key `k` of track `t` is at `k * blocks.len() + t`.
#[derive(Clone, Debug)]
pub(super) struct Tracks<const N: usize> {
    key_table: KeyTable,
    blocks: Vec<u32>,
    keys: Vec<BlockKey<N>>,
}

impl<const N: usize> Tracks<N> {
    /// Groups tracks (block, its times, a key for each) by equal times.
    pub(super) fn collect(tracks: Vec<(u32, KeyTable, Vec<BlockKey<N>>)>) -> Vec<Self> {
        let mut groups: Vec<(KeyTable, Vec<BlockTrack<N>>)> = Vec::new();
        for (block, key_table, keys) in tracks {
            match groups.iter_mut().find(|group| group.0 == key_table) {
                Some(group) => group.1.push((block, keys)),
                None => groups.push((key_table, vec![(block, keys)])),
            }
        }
        let group = |(key_table, tracks): (KeyTable, Vec<BlockTrack<N>>)| {
            let keys =
                (0..key_table.times().len()).flat_map(|key| tracks.iter().map(move |track| track.1[key]));
            Self { keys: keys.collect(), blocks: tracks.iter().map(|track| track.0).collect(), key_table }
        };
        groups.into_iter().map(group).collect()
    }

    pub(super) fn key_bytes(&self) -> usize {
        size_of_val(self.keys.as_slice())
    }

    /// Iterates over every block with its keys before and after `time`, and the fraction between them.
    #[inline(always)]
    pub(super) fn around<S: Simd>(
        &self,
        time: f32,
    ) -> (FastSlerp<S>, impl Iterator<Item = (u32, &BlockKey<N>, &BlockKey<N>)>) {
        let KeyPosition { key, mix } = self.key_table.find(time);
        let count = self.blocks.len();
        let two = self.keys.get(key * count..(key + 2) * count).unwrap_or(&[]);
        let (before, after) = two.split_at(two.len() / 2);
        let keys = self.blocks.iter().zip(before).zip(after);
        (FastSlerp::new(mix), keys.map(|((&block, before), after)| (block, before, after)))
    }
}
