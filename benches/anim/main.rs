//! What a pose costs: `cargo bench -p dragonfly-anim`.

mod compressed;
mod hit;

use dragonfly_anim::animation::Animation;
use dragonfly_anim::data::{AnimationData, Bone, Channel, Interpolation, Skeleton, Take, Track, Transform};
use dragonfly_kit::bench::measure;
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

const BONES: usize = 64;
const KEYS: usize = 120;

fn main() {
    let mut animation = Animation::new(chain());
    let mut time = 0.0_f32;
    let mut next = move || {
        time = (time + 1.0 / 60.0) % 4.0;
        time
    };
    measure("anim/open/to_root_64_bones_forward", 10, || animation.to_root_bone_poses(Some(0), next()).len());
    measure("anim/open/rest_pose_64_bones", 10, || animation.to_root_bone_poses(None, 0.0).len());
    compressed::run();
    hit::run();
}

/// A chain of bones that all turn and move.
fn chain() -> AnimationData {
    let bones = (0..BONES as u32).map(|index| Bone {
        name: format!("bone_{index}"),
        parent: index.checked_sub(1),
        rest: Transform { translation: Vec3::Y, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::from_translation(-Vec3::Y * index as f32),
        node: None,
    });
    let skeleton = Skeleton { bones: bones.collect() };
    let times: Arc<[f32]> = (0..KEYS).map(|key| key as f32 / 30.0).collect();
    let tracks = (0..BONES as u32).map(|bone| {
        let turn = |key: usize| Quat::from_rotation_z((key as f32 * 0.1 + bone as f32).sin() * 0.2);
        let step = |key: usize| Vec3::new(0.0, 1.0 + (key as f32 * 0.2).cos() * 0.01, 0.0);
        Track {
            bone,
            translation: Channel::new(
                Arc::clone(&times),
                (0..KEYS).map(step).collect::<Vec<_>>(),
                Interpolation::Linear,
            ),
            rotation: Channel::new(
                Arc::clone(&times),
                (0..KEYS).map(turn).collect::<Vec<_>>(),
                Interpolation::Linear,
            ),
            scale: Channel::default(),
        }
    });
    let take = Take {
        name: "bend".to_owned(),
        start: 0.0,
        length: (KEYS - 1) as f32 / 30.0,
        tracks: tracks.collect(),
        morphs: Vec::new(),
    };
    AnimationData { skeleton: Arc::new(skeleton), takes: vec![Arc::new(take)] }
}
