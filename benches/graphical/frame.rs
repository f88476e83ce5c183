//! The work of one frame: it samples with the real sampler at the clock's time, then transforms vertices on the CPU in
//! place of a GPU, and checks that the sampled data is from one document.

use super::document::{EditMark, TakeEntry};
use super::model::mesh;
use super::script::SHOWN;
use dragonfly_anim::animation::{Animation, final_poses};
use dragonfly_anim::data::{AnimationData, Primitive, Skeleton, Skin, Take, Transform};
use dragonfly_anim::sample::{loop_time, sample_take};
use dragonfly_anim::skin::{Movement, skin_positions};
use glam::{Mat4, Vec3};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Number of vertices of the mesh, which a frame draws several times: for shadow, reflection and image.
const VERTICES: usize = 5_000;
/// Intended duration of a frame.
const COST: Duration = Duration::from_millis(3);

/// Everything that is reused from frame to frame, so that drawing allocates nothing.
pub struct FrameWork {
    skeleton: Arc<Skeleton>,
    animation: Animation,
    poses: Vec<Transform>,
    skin: Skin,
    finals: Vec<Mat4>,
    primitive: Primitive,
    positions: Vec<Vec3>,
    draws: u32,
    thorough: bool,
    stall: Duration,
    time: f32,
    seen: Option<EditMark>,
    torn: u64,
}

impl FrameWork {
    /// Returns the work of frames that draw `draws` times; `thorough` checks every bone for inconsistencies.
    pub fn new(skeleton: Arc<Skeleton>, draws: u32, thorough: bool) -> Self {
        let bones = skeleton.len();
        let (skin, primitive) = mesh(bones, VERTICES);
        let data = AnimationData { skeleton: Arc::clone(&skeleton), takes: Vec::new() };
        Self {
            animation: Animation::new(data),
            skeleton,
            poses: vec![Transform::IDENTITY; bones],
            finals: vec![Mat4::IDENTITY; bones],
            skin,
            positions: vec![Vec3::ZERO; VERTICES],
            primitive,
            draws,
            thorough,
            stall: Duration::ZERO,
            time: 0.0,
            seen: None,
            torn: 0,
        }
    }

    /// Returns the number of draws that take three milliseconds on this machine without background load.
    pub fn calibrate(skeleton: Arc<Skeleton>) -> u32 {
        let mut frame = Self::new(skeleton, 1, false);
        let one = |frame: &mut Self| {
            let begin = Instant::now();
            frame.draw();
            begin.elapsed()
        };
        let quickest = (0..3000).map(|_| one(&mut frame)).min().unwrap_or(COST);
        (COST.as_secs_f64() / quickest.as_secs_f64()).round().max(1.0) as u32
    }

    /// Starts a frame for the clock's time `now`, in which the simulated GPU driver blocks for `stall`.
    pub fn begin(&mut self, now: f32, stall: Duration) {
        (self.time, self.stall, self.seen) = (now, stall, None);
    }

    /// Samples the shown take. Reads all that the frame needs of the document.
    pub fn read(&mut self, entry: &TakeEntry) {
        self.read_copy(entry.mark(self.thorough), &entry.result);
    }

    /// Returns the mark that a copy of the shown take must contain. Called when the copy is made.
    pub fn mark(&self, entry: &TakeEntry) -> EditMark {
        entry.mark(self.thorough)
    }

    /// Samples a copy of the take, with the mark that belongs to it.
    pub fn read_copy(&mut self, mark: EditMark, take: &Take) {
        let time = loop_time(self.time, take.start, take.length);
        sample_take(Some(take), &self.skeleton, time, &mut self.poses);
        self.torn += u64::from(mark.is_torn(take));
        self.seen = Some(mark);
    }

    /// Draws the sampled poses; no longer needs the document.
    pub fn draw(&mut self) {
        let poses = &self.poses;
        self.animation.to_root_bone_poses_with(|mine| mine.copy_from_slice(poses));
        final_poses(&self.skin, self.animation.to_root(), &mut self.finals);
        for _ in 0..self.draws {
            let movement = Movement::Skin(&self.finals);
            skin_positions(&self.primitive, movement, &[], std::hint::black_box(&mut self.positions));
        }
        let until = Instant::now() + self.stall;
        while Instant::now() < until {
            std::thread::park_timeout(until - Instant::now());
        }
    }

    /// Checks that the view is unchanged. For methods that hold a view for the whole frame.
    pub fn confirm(&mut self, entry: &TakeEntry) {
        let now = entry.mark(self.thorough);
        let same = self.seen.is_some_and(|seen| seen.number == now.number);
        self.torn += u64::from(!same || now.is_torn(&entry.result));
    }

    /// Returns the newest edit that this frame shows; `None` when it read nothing.
    pub fn seen(&self) -> Option<u64> {
        self.seen.map(|mark| mark.number)
    }

    /// Returns the number of checks that found inconsistent data.
    pub fn torn(&self) -> u64 {
        self.torn
    }
}

/// A question of the main thread: the pose of a bone relative to its parent.
#[derive(Clone, Copy, Debug)]
pub struct PoseQuestion {
    /// The bone in the shown take.
    pub bone: usize,
    /// The time in the take.
    pub time: f32,
}

/// The pose of the bone, and the newest edit that it contains.
#[derive(Clone, Copy, Debug)]
pub struct PoseAnswer {
    /// Number of that edit.
    pub number: u64,
    /// The pose.
    pub pose: Transform,
}

impl PoseQuestion {
    /// Returns the answer for `entry`, the shown take.
    pub fn answer(&self, entry: &TakeEntry, skeleton: &Skeleton) -> PoseAnswer {
        let track = &entry.result.tracks[self.bone];
        let pose = dragonfly_anim::sample::sample_track(track, &skeleton.bones[self.bone], self.time);
        PoseAnswer { number: entry.number, pose }
    }
}

/// Returns the shown take.
pub fn shown(takes: &[TakeEntry]) -> &TakeEntry {
    &takes[SHOWN]
}
