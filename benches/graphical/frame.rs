//! The work of one frame: the real sampler at the clock's time, then vertices moved on the processor in place of a device;
//! and a look whether what was sampled is one document.

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

/// Vertices of the mesh; a frame draws it several times, as shadow, reflection and picture.
const VERTICES: usize = 5_000;
/// What a frame is to cost.
const COST: Duration = Duration::from_millis(3);

/// Everything that frames keep from one to the next, so that drawing allocates nothing.
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
    /// Draws `draws` times; `thorough` looks at every bone for what does not fit together.
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

    /// How often a frame must draw to cost three milliseconds here, undisturbed.
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

    /// Begins a frame for the clock's time `now`; the driver will hold it up for `stall`.
    pub fn begin(&mut self, now: f32, stall: Duration) {
        (self.time, self.stall, self.seen) = (now, stall, None);
    }

    /// Samples the shown take. All that the frame needs of the document is read here.
    pub fn read(&mut self, entry: &TakeEntry) {
        self.read_copy(entry.mark(self.thorough), &entry.result);
    }

    /// What must be found in a copy of the shown take of this entry; asked for together with the copy.
    pub fn mark(&self, entry: &TakeEntry) -> EditMark {
        entry.mark(self.thorough)
    }

    /// The same for a copy of the take, and the mark that belongs to it.
    pub fn read_copy(&mut self, mark: EditMark, take: &Take) {
        let time = loop_time(self.time, take.start, take.length);
        sample_take(Some(take), &self.skeleton, time, &mut self.poses);
        self.torn += u64::from(mark.is_torn(take));
        self.seen = Some(mark);
    }

    /// Draws what was read; needs nothing of the document any more.
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

    /// For those who hold a view for the whole frame: is it still the one that was read?
    pub fn confirm(&mut self, entry: &TakeEntry) {
        let now = entry.mark(self.thorough);
        let same = self.seen.is_some_and(|seen| seen.number == now.number);
        self.torn += u64::from(!same || now.is_torn(&entry.result));
    }

    /// The newest edit that this frame shows; `None` when it read nothing.
    pub fn seen(&self) -> Option<u64> {
        self.seen.map(|mark| mark.number)
    }

    /// How many looks found things that do not belong together.
    pub fn torn(&self) -> u64 {
        self.torn
    }
}

/// What the main thread wants to know and does not know itself.
#[derive(Clone, Copy, Debug)]
pub struct PoseQuestion {
    /// Where is this bone of the shown take, relative to its parent,
    pub bone: usize,
    /// at this time?
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
    /// The answer that `entry`, the shown take, gives.
    pub fn answer(&self, entry: &TakeEntry, skeleton: &Skeleton) -> PoseAnswer {
        let track = &entry.result.tracks[self.bone];
        let pose = dragonfly_anim::sample::sample_track(track, &skeleton.bones[self.bone], self.time);
        PoseAnswer { number: entry.number, pose }
    }
}

/// The shown take among all.
pub fn shown(takes: &[TakeEntry]) -> &TakeEntry {
    &takes[SHOWN]
}
