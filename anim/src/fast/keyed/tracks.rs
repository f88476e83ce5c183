//! Blocks of eight bones that are keyed at the same times.

use super::super::between::Way;
use super::super::grid::{Grid, Place};
use super::super::simd::{LANES, Simd};

/// One key of eight bones: `N` coordinates of eight numbers.
pub(super) type Key<const N: usize> = [[f32; LANES]; N];

/// A block and its keys.
type Track<const N: usize> = (u32, Vec<Key<N>>);

/// Tracks with the same key times. Key `k` of track `t` is at `k * blocks.len() + t`.
#[derive(Clone, Debug)]
pub(super) struct Tracks<const N: usize> {
    grid: Grid,
    blocks: Vec<u32>,
    keys: Vec<Key<N>>,
}

impl<const N: usize> Tracks<N> {
    /// Groups tracks (block, its times, a key for each) by equal times.
    pub(super) fn collect(tracks: Vec<(u32, Grid, Vec<Key<N>>)>) -> Vec<Self> {
        let mut groups: Vec<(Grid, Vec<Track<N>>)> = Vec::new();
        for (block, grid, keys) in tracks {
            match groups.iter_mut().find(|group| group.0 == grid) {
                Some(group) => group.1.push((block, keys)),
                None => groups.push((grid, vec![(block, keys)])),
            }
        }
        let group = |(grid, tracks): (Grid, Vec<Track<N>>)| {
            let keys = (0..grid.times().len()).flat_map(|key| tracks.iter().map(move |track| track.1[key]));
            Self { keys: keys.collect(), blocks: tracks.iter().map(|track| track.0).collect(), grid }
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
    ) -> (Way<S>, impl Iterator<Item = (u32, &Key<N>, &Key<N>)>) {
        let Place { key, mix } = self.grid.find(time);
        let count = self.blocks.len();
        let two = self.keys.get(key * count..(key + 2) * count).unwrap_or(&[]);
        let (before, after) = two.split_at(two.len() / 2);
        let keys = self.blocks.iter().zip(before).zip(after);
        (Way::new(mix), keys.map(|((&block, before), after)| (block, before, after)))
    }
}
