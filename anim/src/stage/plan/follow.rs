//! Movement along a path: how far one is at which time, and at which time of the take.
//!
//! A take on the way is played by distance: its clock runs so that the distance of its stride is the distance on the path. So its feet fit at
//! any speed. With `Φ` the time of the take since the start, `C` the length of a cycle, `D` its distance and `m(τ)` the distance within it:
//!
//! ```text
//! Φ(t) = ease(t / T) · Φ_end              travel(Φ) = ⌊Φ / C⌋ D + m(Φ mod C)            travel(Φ_end) = length of the path
//! ```

use super::placement::{Placement, facing_of};
use crate::stage::ease::StageEase;
use crate::stage::ground::SceneGround;
use crate::stage::model::{StageModel, StageTake};
use crate::stage::path::StagePath;
use crate::stage::time::{StageTime, TICKS_PER_SECOND};
use glam::DVec3;
use std::sync::Arc;

/// The direction of a thing on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PathHeading {
    /// Along the path.
    Along,
    /// In one direction, radians.
    Fixed(f64),
}

/// The height of a way.
#[derive(Clone, Debug)]
pub(super) enum WayGround {
    /// Its own.
    Off,
    /// That of the plane, meters.
    Plane(f64),
    /// That of the ground props; that of the plane where there are none.
    Mesh(Arc<SceneGround>),
}

/// A take that is played by distance.
#[derive(Clone, Debug)]
pub(super) struct PathStride {
    pub(super) model: Arc<StageModel>,
    pub(super) take: usize,
    /// Meters in one length of the model.
    scale: f64,
    /// Distance of a cycle, meters.
    cycle: f64,
    /// Direction in which the take goes, to-root space.
    direction: DVec3,
}

impl PathStride {
    /// Returns the stride of a take; `None` for one that does not go anywhere.
    pub(super) fn new(model: &Arc<StageModel>, take: usize, scale: f64) -> Option<Self> {
        let own = model.takes().get(take)?;
        let stride = own.stride().filter(|_| own.length() > StageTime::ZERO)?;
        let cycle = stride.distance * scale;
        (cycle > 1e-6).then(|| Self {
            model: Arc::clone(model),
            take,
            scale,
            cycle,
            direction: stride.direction,
        })
    }

    pub(super) fn take(&self) -> &StageTake {
        &self.model.takes()[self.take]
    }

    /// Returns the distance of a cycle, meters.
    pub(super) fn cycle(&self) -> f64 {
        self.cycle
    }

    /// Returns the length of a cycle in seconds.
    pub(super) fn seconds(&self) -> f64 {
        self.take().length().seconds()
    }

    /// Returns the movement within a cycle at a time of it: along the direction of the take, and what is left, meters.
    fn within(&self, time: f64) -> (f64, DVec3) {
        let take = self.take();
        if !take.travels() {
            let share = take.stride().map_or(0.0, |stride| stride.share(time / self.seconds()));
            return (self.cycle * share, DVec3::ZERO);
        }
        let moved = take.movement(StageTime::from_seconds(time)).translation.as_dvec3() * self.scale;
        let along = moved.dot(self.direction);
        (along, moved - self.direction * along)
    }

    /// Returns the distance at the time `phase` of the take, and the offset from the path, meters.
    fn travel(&self, phase: f64) -> (f64, DVec3) {
        let loops = (phase / self.seconds()).floor();
        let (along, aside) = self.within(phase - loops * self.seconds());
        (loops * self.cycle + along, aside)
    }

    /// Returns the time of the take at which the distance is reached first.
    pub(super) fn phase_at(&self, distance: f64) -> f64 {
        let loops = (distance / self.cycle).floor();
        let rest = distance - loops * self.cycle;
        let (mut low, mut high) = (0.0, self.seconds());
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.within(middle).0 < rest { low = middle } else { high = middle }
        }
        loops * self.seconds() + 0.5 * (low + high)
    }
}

/// A thing on a path.
#[derive(Clone, Debug)]
pub(super) struct PathFollower {
    pub(super) path: Arc<StagePath>,
    pub(super) ground: WayGround,
    /// Duration of the whole way; of one lap where it repeats without an end.
    pub(super) total: StageTime,
    /// Meters of the whole way, or of one lap.
    pub(super) distance: f64,
    pub(super) is_endless: bool,
    pub(super) ease: StageEase,
    pub(super) heading: PathHeading,
    pub(super) stride: Option<PathStride>,
    /// Time of the take at the end of the way, seconds.
    pub(super) phase_end: f64,
    /// Whether feet in contact stay where they are.
    pub(super) keeps_feet: bool,
}

impl PathFollower {
    /// Returns the share of the way, or the number of laps.
    fn progress(&self, after: StageTime) -> f64 {
        if self.total <= StageTime::ZERO {
            return 1.0;
        }
        let x = after.ticks() as f64 / self.total.ticks() as f64;
        if self.is_endless { x.max(0.0) } else { self.ease.at(x) }
    }

    /// Returns the time of the take in seconds since the start; 0 without a take.
    pub(super) fn phase(&self, after: StageTime) -> f64 {
        self.progress(after) * self.phase_end
    }

    /// Returns the time after the start at which the take has reached `phase`, clamped to the way.
    pub(super) fn after_phase(&self, phase: f64) -> StageTime {
        let share = if self.phase_end > 0.0 { phase / self.phase_end } else { 0.0 };
        let x = if self.is_endless { share.max(0.0) } else { self.ease.inverse(share) };
        StageTime::from_seconds(x * self.total.ticks() as f64 / TICKS_PER_SECOND as f64)
    }

    /// Returns the placement `after` the start; `fallback` is the direction where the path has none.
    pub(super) fn placement(&self, after: StageTime, fallback: f64) -> Placement {
        let progress = self.progress(after);
        let (distance, aside, forward) = match &self.stride {
            Some(stride) => {
                let (distance, aside) = stride.travel(progress * self.phase_end);
                (distance, aside, facing_of(stride.direction).unwrap_or(0.0))
            }
            None => (progress * self.distance, DVec3::ZERO, 0.0),
        };
        let length = self.path.length();
        // A take may step back at its start and beyond the end of the way at its end.
        let distance = if self.is_endless { distance.max(0.0) } else { distance.max(0.0).min(self.distance) };
        let laps = if length > 0.0 { (distance / length).floor() } else { 0.0 };
        let rest = distance - laps * length;
        // The end of the last lap is not the start of another one.
        let is_end = !self.is_endless && distance >= self.distance * (1.0 - 1e-9);
        let spot = self.path.at(if is_end && rest < 1e-6 * length { length } else { rest });
        let facing = match self.heading {
            PathHeading::Along => facing_of(spot.direction).map_or(fallback, |along| along - forward),
            PathHeading::Fixed(facing) => facing,
        };
        let mut placement = Placement { position: spot.position, facing };
        placement.position += placement.rotation() * aside;
        placement.position.y = match &self.ground {
            WayGround::Off => placement.position.y,
            WayGround::Plane(height) => *height,
            WayGround::Mesh(ground) => {
                ground.nearest(placement.position).map_or(ground.plane, |surface| surface.height)
            }
        };
        placement
    }
}

impl PathFollower {
    /// Returns the time in the take, after its start, `after` the start.
    pub(super) fn take_time(&self, after: StageTime) -> StageTime {
        let Some(stride) = &self.stride else { return StageTime::ZERO };
        let phase = self.phase(after);
        let loops = (phase / stride.seconds()).floor();
        StageTime::from_seconds(phase - loops * stride.seconds())
    }
}
