//! The best loop in a long take.
//!
//! The cost of the loop from frame `i` to frame `j` is the mean over the bones of squared distances, with velocities
//! weighted by the seconds of one frame window `w` (after Kovar, Gleicher, Pighin, "Motion graphs", 2002, §3.1):
//!
//! ```text
//! cost(i, j) = 1/B Σ |p_i − p_j|² + w² |v_i − v_j|²        √cost is reported, in the model's unit
//! ```
//!
//! Frames are first compared on a grid so coarse that at most 2¹⁸ pairs are computed, then all frames
//! around the best pairs of the grid.

use super::gap::relative;
use crate::data::BoneIndex;
use crate::frames::TakeFrames;
use crate::motion::Axis;
use glam::Vec3;

/// Largest number of pairs of frames on the grid.
pub(super) const MOST_PAIRS: usize = 1 << 18;

/// Number of pairs of the grid around which all frames are compared.
const REFINED: usize = 16;

/// What to search for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopSearch {
    /// Shortest loop in seconds.
    pub least: f32,
    /// Longest loop in seconds.
    pub most: f32,
    /// The bone whose movement on the ground is left out.
    pub travel: Option<BoneIndex>,
    /// The axis that points up.
    pub up: Axis,
    /// Seconds by which differences of velocity are multiplied.
    pub velocity_weight: f32,
}

impl Default for LoopSearch {
    /// Returns a search for loops from half a second on, of any length, without travel; velocities weigh a tenth of a second.
    fn default() -> Self {
        Self { least: 0.5, most: f32::INFINITY, travel: None, up: Axis::Y, velocity_weight: 0.1 }
    }
}

/// A range of frames that repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundLoop {
    /// The first frame.
    pub first: usize,
    /// The frame that equals the first best.
    pub last: usize,
    /// Root of the mean squared distance of the two, in the model's unit.
    pub cost: f32,
}

/// Returns the loop with the lowest cost, the longest of equal ones; `None` where the take is shorter than the shortest loop.
pub fn find_loop(frames: &TakeFrames, search: &LoopSearch) -> Option<FoundLoop> {
    let least = ((search.least * frames.rate()).ceil().max(1.0)) as usize;
    let most = ((search.most * frames.rate()).floor()).max(0.0) as usize;
    let count = frames.len();
    if count <= least || most < least || frames.bones() == 0 {
        return None;
    }
    let table = Features::of(frames, search);
    let mut stride = 1;
    while (count / stride).pow(2) / 2 > MOST_PAIRS {
        stride += 1;
    }
    let allowed = |first: usize, last: usize| last < count && (least..=most).contains(&(last - first));
    let mut best: Vec<FoundLoop> = Vec::new();
    for first in (0..count).step_by(stride) {
        for last in (first + least..count).step_by(stride).filter(|&last| allowed(first, last)) {
            insert(&mut best, table.found(first, last));
        }
    }
    if stride > 1 {
        for coarse in best.clone() {
            for first in coarse.first.saturating_sub(stride)..=coarse.first + stride {
                let around = coarse.last.saturating_sub(stride).max(first)..=coarse.last + stride;
                for last in around.filter(|&last| allowed(first, last)) {
                    insert(&mut best, table.found(first, last));
                }
            }
        }
    }
    best.first().copied()
}

/// Inserts a loop in a list of the best, the lowest cost first, of equal ones the longest.
fn insert(best: &mut Vec<FoundLoop>, found: FoundLoop) {
    let length = |found: &FoundLoop| found.last - found.first;
    let at = best.partition_point(|other| {
        other.cost.total_cmp(&found.cost).then(length(&found).cmp(&length(other))).is_le()
    });
    if at < REFINED {
        best.insert(at, found);
        best.truncate(REFINED);
    }
}

/// Positions and weighted velocities of all bones at all frames.
struct Features {
    bones: usize,
    rows: Vec<[Vec3; 2]>,
}

impl Features {
    fn of(frames: &TakeFrames, search: &LoopSearch) -> Self {
        let travel = search.travel.filter(|&travel| (travel as usize) < frames.bones());
        let last = frames.len() - 1;
        let mut rows = Vec::with_capacity(frames.len() * frames.bones());
        for frame in 0..frames.len() {
            for bone in 0..frames.bones() as BoneIndex {
                let at = |frame: usize| relative(frames, frame, bone, travel, search.up);
                let (before, after) = (frame.saturating_sub(1), (frame + 1).min(last));
                let seconds = (after - before).max(1) as f32 / frames.rate();
                let velocity = (at(after) - at(before)) / seconds;
                rows.push([at(frame), velocity * search.velocity_weight]);
            }
        }
        Self { bones: frames.bones(), rows }
    }

    fn found(&self, first: usize, last: usize) -> FoundLoop {
        FoundLoop { first, last, cost: self.cost(first, last) }
    }

    fn cost(&self, first: usize, last: usize) -> f32 {
        let row = |frame: usize| &self.rows[frame * self.bones..(frame + 1) * self.bones];
        let pairs = row(first).iter().zip(row(last));
        let sum: f32 = pairs.map(|(a, b)| a[0].distance_squared(b[0]) + a[1].distance_squared(b[1])).sum();
        (sum / self.bones as f32).sqrt()
    }
}
