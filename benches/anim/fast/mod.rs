//! The fast path, at every level of the machine; takes with their keys as they are, and compressed.

mod bones;
mod characters;
mod vertices;

use crate::case::Case;
use crate::model::Subject;
use dragonfly_anim::compressed::{CompressedTake, CompressionSettings, compress};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{
    KeyedTake, Matrix34, Playable, Pose, Rig, RootPoses, SkinBinding, final_poses, matrix, sample, to_root,
};
use std::sync::OnceLock;

/// A subject brought to the layout of the fast path.
struct Ready {
    subject: &'static Subject,
    rig: Rig,
    binding: SkinBinding,
    keyed: OnceLock<Vec<KeyedTake>>,
    compressed: OnceLock<Vec<CompressedTake>>,
}

/// A form of takes that can be played.
trait Form: Playable + Sized + 'static {
    /// Who plays it at a level, as a part of a name.
    fn way(level: SimdLevel) -> String;

    /// The takes of `ready` in this form.
    fn takes(ready: &'static Ready) -> &'static [Self];
}

/// Keys as they are, 32 bits a number.
impl Form for KeyedTake {
    fn way(level: SimdLevel) -> String {
        level.name().to_owned()
    }

    fn takes(ready: &'static Ready) -> &'static [Self] {
        let animation = &ready.subject.model.animation;
        let keyed = |take| KeyedTake::new(&animation.skeleton, take);
        ready.keyed.get_or_init(|| animation.takes.iter().map(|take| keyed(take)).collect())
    }
}

/// Compressed to 0.1 mm at 3 cm.
impl Form for CompressedTake {
    fn way(level: SimdLevel) -> String {
        format!("{}/compressed", level.name())
    }

    fn takes(ready: &'static Ready) -> &'static [Self] {
        let animation = &ready.subject.model.animation;
        let settings =
            CompressionSettings { everywhere: ready.subject.exactness, ..CompressionSettings::default() };
        let made = |take| compress(take, &animation.skeleton, &settings).expect("a take of a small model").0;
        ready.compressed.get_or_init(|| animation.takes.iter().map(|take| made(take)).collect())
    }
}

impl Ready {
    fn new(subject: &'static Subject) -> &'static Self {
        let rig = Rig::new(&subject.model.animation.skeleton);
        let binding = SkinBinding::new(&rig, subject.skin());
        Box::leak(Box::new(Self {
            subject,
            rig,
            binding,
            keyed: OnceLock::new(),
            compressed: OnceLock::new(),
        }))
    }

    /// The pose of take `take`, counted round, a part `part` of its length in.
    fn pose(&'static self, take: usize, part: f32) -> Pose {
        let takes = KeyedTake::takes(self);
        let take = &takes[take % takes.len()];
        let mut pose = self.rig.rest().clone();
        sample(SimdLevel::best(), take, take.start() + take.length() * part, pose.blocks_mut());
        pose
    }

    /// The to-root matrices of some pose.
    fn roots(&'static self) -> RootPoses {
        let mut roots = RootPoses::new(&self.rig);
        to_root(SimdLevel::best(), &self.rig, self.pose(0, 0.4).blocks(), &mut roots);
        roots
    }

    /// The final matrices of the same pose.
    fn finals(&'static self) -> Vec<Matrix34> {
        let mut finals = vec![matrix::IDENTITY; self.binding.joints()];
        final_poses(SimdLevel::best(), &self.binding, &self.roots(), &mut finals);
        finals
    }
}

pub(crate) fn cases(subject: &'static Subject) -> Vec<Case> {
    let ready = Ready::new(subject);
    SimdLevel::all().into_iter().flat_map(|level| at_level(ready, level)).collect()
}

fn at_level(ready: &'static Ready, level: SimdLevel) -> Vec<Case> {
    let mut cases = bones::sampling::<KeyedTake>(ready, level);
    cases.extend(bones::sampling::<CompressedTake>(ready, level));
    cases.extend(bones::matrices(ready, level));
    cases.extend(bones::blending(ready, level));
    cases.extend(bones::additive(ready, level));
    cases.push(bones::reaching(ready, level));
    cases.extend(vertices::skinning(ready, level));
    cases.extend(characters::cases::<KeyedTake>(ready, level));
    cases.extend(characters::cases::<CompressedTake>(ready, level));
    cases
}
