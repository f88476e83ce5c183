//! The frame rate of a written file: as low as the keys and the curves between them allow.

use super::check as code;
use super::scene_pose::{ScenePose, SceneSampler};
use crate::data::{Channel, Interpolation, Skeleton, Take, Track};
use crate::format::losses::Losses;
use crate::frames::{FramesError, MOST_POSES, OFF_FRAME, frames_over};
use glam::{DVec3, Vec3};

/// Largest share of the size of the figure by which a bone may be off its curve between two frames.
const TOLERANCE: f64 = 1e-3;

/// Largest frame rate that is chosen for keys and curves; an even grid of keys may be finer.
const HIGHEST: f64 = 240.0;

/// Frame rates that programs use, ascending; of the others, that of the keys is used.
const USUAL: [f64; 12] = [12.0, 15.0, 24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 90.0, 100.0, 120.0, 240.0];

/// Frames per second where no rate has all keys at frames.
const DEFAULT: f64 = 30.0;

/// Largest rate of keys that is used as it is, in frames per second.
const MOST_KEYS: f64 = 1000.0;

/// Places between two frames at which the distance to the curves is measured.
const BETWEEN: [f64; 3] = [0.25, 0.5, 0.75];

/// Share of a frame by which a key is off its frame because of rounding.
const EXACT: f64 = 0.002;

/// Share of the size of the figure that is not worth a line.
const NOTHING: f64 = 1e-6;

/// The frames of a written file.
pub(super) struct FrameGrid {
    /// Time of the first frame in the take, in seconds.
    pub(super) start: f64,
    /// Frames per second.
    pub(super) rate: f64,
    /// At least 1.
    pub(super) frames: usize,
}

impl FrameGrid {
    /// Returns the time of a frame in the take, in seconds.
    pub(super) fn time(&self, frame: usize) -> f64 {
        self.start + frame as f64 / self.rate
    }

    /// Returns the frames of a take, and lists keys that are between them, and how far bones are from the curves there.
    pub(super) fn of(
        take: &Take,
        skeleton: &Skeleton,
        sampler: &mut SceneSampler<'_>,
        losses: &mut Losses,
    ) -> Result<Self, FramesError> {
        let (start, end) = take.range_of_keys().unwrap_or((0.0, 0.0));
        let (start, length) = (f64::from(start), f64::from(end) - f64::from(start));
        let mut grid = Self::at(rate_of_keys(take, start), start, length, skeleton.len())?;
        let off = keys_off(take, &grid);
        if off > 0 || !is_straight(take, skeleton) {
            grid = between_curves(grid, length, skeleton, sampler, losses)?;
        }
        let off = keys_off(take, &grid);
        if off > 0 {
            let rate = grid.rate;
            let text = format!(
                "{off} keys are not at one of {rate} frames per second; the frames have the values of the curves"
            );
            losses.add("/animation/takes/0/tracks".to_owned(), code::KEYS_BETWEEN_FRAMES, text);
        }
        Ok(grid)
    }

    fn at(rate: f64, start: f64, length: f64, bones: usize) -> Result<Self, FramesError> {
        let frames = frames_over(length, rate);
        if frames.saturating_mul(bones) > MOST_POSES {
            return Err(FramesError::TooMany { frames, bones });
        }
        Ok(Self { start, rate, frames })
    }
}

/// Returns a multiple of the rate of `grid` at which bones are near their curves between frames too, and lists how near.
fn between_curves(
    mut grid: FrameGrid,
    length: f64,
    skeleton: &Skeleton,
    sampler: &mut SceneSampler<'_>,
    losses: &mut Losses,
) -> Result<FrameGrid, FramesError> {
    let parents: Vec<Option<usize>> =
        skeleton.bones.iter().map(|bone| bone.parent.map(|parent| parent as usize)).collect();
    let size = (0..grid.frames).map(|frame| sampler.pose(grid.time(frame)).extent()).fold(0.0, f64::max);
    loop {
        let finer = (grid.rate * 2.0 <= HIGHEST)
            .then(|| FrameGrid::at(grid.rate * 2.0, grid.start, length, skeleton.len()).ok())
            .flatten();
        let most = if finer.is_some() { size * TOLERANCE } else { f64::INFINITY };
        match (farthest(&grid, sampler, &parents, most), finer) {
            (distance, Some(finer)) if distance > most => grid = finer,
            (distance, _) => {
                let share = if size > 0.0 { distance / size } else { 0.0 };
                if share > NOTHING {
                    let (rate, millimeters) = (grid.rate, distance * 1e3);
                    let text = format!(
                        "curves become {rate} frames per second; between frames bones are up to {millimeters:.3} mm \
                         ({:.3} % of the size) off",
                        share * 100.0
                    );
                    losses.add("/animation/takes/0".to_owned(), code::INTERPOLATION_NOT_STORED, text);
                }
                return Ok(grid);
            }
        }
    }
}

/// Returns the largest distance in meters of a bone from its curve between two frames; any distance above `most` ends the search.
fn farthest(grid: &FrameGrid, sampler: &mut SceneSampler<'_>, parents: &[Option<usize>], most: f64) -> f64 {
    let mut farthest = 0.0_f64;
    let mut before: ScenePose = sampler.pose(grid.time(0));
    for frame in 1..grid.frames {
        let after = sampler.pose(grid.time(frame));
        for mix in BETWEEN {
            let curves = sampler.pose(grid.time(frame - 1) + mix / grid.rate);
            let mixed: Vec<DVec3> = before.mixed(&after, mix, parents);
            let distances = mixed.iter().zip(&curves.positions).map(|(mixed, curve)| mixed.distance(*curve));
            farthest = distances.fold(farthest, f64::max);
        }
        if farthest > most {
            break;
        }
        before = after;
    }
    farthest
}

/// Returns the lowest usual rate at which every key is at a frame, otherwise that of evenly spaced keys, otherwise 30.
fn rate_of_keys(take: &Take, start: f64) -> f64 {
    let longest = times(take).max_by_key(|times| times.len()).unwrap_or_default();
    let [first, .., last] = longest else { return DEFAULT };
    let even = (longest.len() - 1) as f64 / (f64::from(*last) - f64::from(*first));
    let even = Some(even).filter(|even| (1.0..=MOST_KEYS).contains(even));
    let found = |most: f64| {
        let fits = |rate: &f64| offsets(take, start, *rate).all(|off| off <= most);
        USUAL.into_iter().find(fits).or(even.filter(fits))
    };
    found(EXACT).or_else(|| found(OFF_FRAME)).unwrap_or(DEFAULT)
}

fn keys_off(take: &Take, grid: &FrameGrid) -> usize {
    offsets(take, grid.start, grid.rate).filter(|&off| off > OFF_FRAME).count()
}

/// Returns for each key the distance from its frame, as a share of a frame.
fn offsets(take: &Take, start: f64, rate: f64) -> impl Iterator<Item = f64> {
    times(take).flatten().map(move |&time| {
        let frame = (f64::from(time) - start) * rate;
        (frame - frame.round()).abs()
    })
}

/// Returns the times of the keys of every channel of every bone.
fn times(take: &Take) -> impl Iterator<Item = &[f32]> {
    take.tracks
        .iter()
        .flat_map(|track| [&*track.translation.times, &*track.rotation.times, &*track.scale.times])
}

/// Returns whether lines between frames that have all keys are the curves themselves.
fn is_straight(take: &Take, skeleton: &Skeleton) -> bool {
    let is_even = |scale: Vec3| (scale - scale.x).abs().max_element() < 1e-6;
    let is_rigid = skeleton.bones.iter().all(|bone| bone.rest_matrix.is_none() && is_even(bone.rest.scale));
    let is_line =
        |track: &Track| is_linear(&track.translation) && is_linear(&track.rotation) && track.scale.is_empty();
    is_rigid && take.tracks.iter().all(is_line)
}

fn is_linear<T>(channel: &Channel<T>) -> bool {
    channel.interpolation == Interpolation::Linear || channel.times.len() < 2
}
