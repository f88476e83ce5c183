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
    let mut finder = LoopFinder::new(frames, search, 0);
    finder.step(usize::MAX);
    finder.found().first().copied()
}

/// A search for loops in progress, so that a program can search a long take without a pause.
#[derive(Clone, Debug)]
pub struct LoopFinder {
    table: Features,
    least: usize,
    most: usize,
    /// Number of frames within which two loops count as the same one.
    near: usize,
    stride: usize,
    /// The next pair of the grid; `None` when the grid was searched.
    next: Option<(usize, usize)>,
    best: Vec<FoundLoop>,
}

impl LoopFinder {
    /// Begins a search. Of loops whose ends are both within `near` frames of those of a better one, only that one is found.
    pub fn new(frames: &TakeFrames, search: &LoopSearch, near: usize) -> Self {
        let least = ((search.least * frames.rate()).ceil().max(1.0)) as usize;
        let most = ((search.most * frames.rate()).floor()).max(0.0) as usize;
        let count = frames.len();
        let mut stride = 1;
        while (count / stride).pow(2) / 2 > MOST_PAIRS {
            stride += 1;
        }
        let is_possible = count > least && most >= least && frames.bones() > 0;
        Self {
            table: Features::of(frames, search),
            least,
            most,
            near,
            stride,
            next: is_possible.then_some((0, least)),
            best: Vec::new(),
        }
    }

    /// Compares at most `pairs` pairs of frames. Returns whether the search is complete.
    pub fn step(&mut self, pairs: usize) -> bool {
        let count = self.table.len();
        for _ in 0..pairs {
            let Some((first, last)) = self.next else { return true };
            if last < count && last - first <= self.most {
                self.insert(first, last);
                self.next = Some((first, last + self.stride));
                continue;
            }
            let first = first + self.stride;
            self.next = (first + self.least < count).then_some((first, first + self.least));
            if self.next.is_none() {
                self.refine();
            }
        }
        self.next.is_none()
    }

    /// Returns the loops found so far, at most 16, the lowest cost first, of equal ones the longest.
    pub fn found(&self) -> &[FoundLoop] {
        &self.best
    }

    /// Compares all frames around the best pairs of the grid.
    fn refine(&mut self) {
        if self.stride == 1 {
            return;
        }
        let stride = self.stride;
        for coarse in self.best.clone() {
            for first in coarse.first.saturating_sub(stride)..=coarse.first + stride {
                for last in coarse.last.saturating_sub(stride).max(first)..=coarse.last + stride {
                    let is_allowed =
                        last < self.table.len() && (self.least..=self.most).contains(&(last - first));
                    if is_allowed {
                        self.insert(first, last);
                    }
                }
            }
        }
    }

    /// Inserts a loop in the list of the best.
    fn insert(&mut self, first: usize, last: usize) {
        let found = FoundLoop { first, last, cost: self.table.cost(first, last) };
        let length = |found: &FoundLoop| found.last - found.first;
        let order = |a: &FoundLoop, b: &FoundLoop| a.cost.total_cmp(&b.cost).then(length(b).cmp(&length(a)));
        let at = self.best.partition_point(|other| order(other, &found).is_le());
        if at >= REFINED {
            return;
        }
        let near = self.near;
        let is_near =
            |other: &FoundLoop| other.first.abs_diff(first) <= near && other.last.abs_diff(last) <= near;
        if self.best[..at].iter().any(is_near) {
            return;
        }
        self.best.insert(at, found);
        let mut index = 0;
        self.best.retain(|other| {
            index += 1;
            index <= at + 1 || !is_near(other)
        });
        self.best.truncate(REFINED);
    }
}

/// Positions and weighted velocities of all bones at all frames.
#[derive(Clone, Debug)]
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

    /// Returns the number of frames.
    fn len(&self) -> usize {
        self.rows.len() / self.bones.max(1)
    }

    fn cost(&self, first: usize, last: usize) -> f32 {
        let row = |frame: usize| &self.rows[frame * self.bones..(frame + 1) * self.bones];
        let pairs = row(first).iter().zip(row(last));
        let sum: f32 = pairs.map(|(a, b)| a[0].distance_squared(b[0]) + a[1].distance_squared(b[1])).sum();
        (sum / self.bones as f32).sqrt()
    }
}
