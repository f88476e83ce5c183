//! Decoded frames of a reference, within a budget of memory.

use dragonfly_document::DecodedImage;
use dragonfly_picture::ReferencePicture;
use std::collections::HashMap;

/// Frames by index; the least recently used ones are dropped where the budget is exceeded.
#[derive(Debug)]
pub(super) struct FrameCache {
    frames: HashMap<usize, CachedFrame>,
    /// Bytes of all frames, and the most that they may have.
    bytes: u64,
    budget: u64,
    /// Counts the uses.
    uses: u64,
}

#[derive(Debug)]
struct CachedFrame {
    picture: ReferencePicture,
    used: u64,
}

fn size(picture: &DecodedImage) -> u64 {
    picture.pixels.len() as u64
}

impl FrameCache {
    /// Returns an empty cache for frames of at most this many bytes together; the newest frame is kept in any case.
    pub(super) fn new(budget: u64) -> Self {
        Self { frames: HashMap::new(), bytes: 0, budget, uses: 0 }
    }

    /// Removes all frames.
    pub(super) fn clear(&mut self) {
        self.frames.clear();
        self.bytes = 0;
    }

    /// Returns whether a frame is there.
    pub(super) fn has(&self, frame: usize) -> bool {
        self.frames.contains_key(&frame)
    }

    /// Returns a frame and notes its use.
    pub(super) fn get(&mut self, frame: usize) -> Option<&ReferencePicture> {
        self.uses += 1;
        let found = self.frames.get_mut(&frame)?;
        found.used = self.uses;
        Some(&found.picture)
    }

    /// Returns the number of frames as large as this one that fit into half of the budget.
    pub(super) fn room(&self, of: [u32; 2]) -> usize {
        let bytes = (u64::from(of[0]) * u64::from(of[1]) * 4).max(1);
        (self.budget / 2 / bytes) as usize
    }

    /// Inserts a frame, and drops others until the budget is kept.
    pub(super) fn insert(&mut self, frame: usize, picture: ReferencePicture) {
        self.uses += 1;
        self.bytes += size(&picture.0);
        if let Some(old) = self.frames.insert(frame, CachedFrame { picture, used: self.uses }) {
            self.bytes -= size(&old.picture.0);
        }
        while self.bytes > self.budget && self.frames.len() > 1 {
            let oldest = self.frames.iter().min_by_key(|(_, frame)| frame.used).map(|(at, _)| *at);
            let Some(gone) = oldest.and_then(|at| self.frames.remove(&at)) else { return };
            self.bytes -= size(&gone.picture.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    fn picture(bytes: usize) -> ReferencePicture {
        let image = DecodedImage { width: bytes as u32 / 4, height: 1, pixels: vec![0; bytes] };
        ReferencePicture(Arc::new(image))
    }

    #[test]
    fn the_frames_that_were_used_least_recently_are_dropped_beyond_the_budget() {
        let mut cache = FrameCache::new(1000);
        for frame in 0..10 {
            cache.insert(frame, picture(100));
        }
        assert!(cache.get(0).is_some());
        cache.insert(10, picture(200));
        let there: Vec<usize> = (0..11).filter(|&frame| cache.has(frame)).collect();
        assert_eq!(there, [0, 3, 4, 5, 6, 7, 8, 9, 10]);
        assert_eq!(cache.bytes, 1000);
        // The newest frame is kept although it is larger than the budget.
        cache.insert(11, picture(4000));
        assert!(cache.has(11) && cache.frames.len() == 1 && cache.bytes == 4000);
        cache.insert(11, picture(40));
        assert_eq!(cache.bytes, 40);
        assert_eq!(cache.room([5, 5]), 5);
    }
}
