//! A model made in code, so that panels can be tested without a file: a spine with ribs, three takes.

use dragonfly_anim::bounds::bounds_of_pose;
use dragonfly_anim::data::{
    AnimationData, Bone, Channel, Interpolation, Material, ModelData, Skeleton, Take, Track, Transform,
};
use dragonfly_document::images::ImageSurvey;
use dragonfly_document::{LoadedModel, View};
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

/// Returns a bone at `offset` from its parent.
fn bone(name: &str, parent: Option<u32>, offset: Vec3) -> Bone {
    Bone {
        name: name.to_owned(),
        parent,
        rest: Transform { translation: offset, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    }
}

/// Returns a skeleton with `spine` vertebrae, each with a pair of ribs of three bones.
pub fn skeleton(spine: u32) -> Skeleton {
    let mut bones = vec![bone("root", None, Vec3::ZERO)];
    let mut last = 0;
    for vertebra in 0..spine {
        let own = bones.len() as u32;
        bones.push(bone(&format!("spine_{vertebra:02}"), Some(last), Vec3::Y * 0.1));
        for (side, sign) in [("left", -1.0), ("right", 1.0)] {
            let mut above = own;
            for part in ["inner", "middle", "tip"] {
                let index = bones.len() as u32;
                let name = format!("rib_{vertebra:02}_{side}_{part}");
                bones.push(bone(&name, Some(above), Vec3::new(sign * 0.08, 0.0, 0.01)));
                above = index;
            }
        }
        last = own;
    }
    Skeleton { bones }
}

/// Returns a take that rotates every bone, with `keys` keys per bone.
pub fn take(name: &str, skeleton: &Skeleton, length: f32, keys: usize) -> Take {
    // The last key is exactly at the end of the take.
    let at =
        |key: usize| if key + 1 == keys { length } else { key as f32 * length / (keys - 1).max(1) as f32 };
    let times: Arc<[f32]> = (0..keys).map(at).collect();
    let tracks = (0..skeleton.len() as u32).map(|bone| {
        let turn = |time: &f32| Quat::from_rotation_z((time * 3.0 + bone as f32).sin() * 0.2);
        let rotation = Channel::new(
            Arc::clone(&times),
            times.iter().map(turn).collect::<Vec<_>>(),
            Interpolation::Linear,
        );
        let mut track = Track { bone, rotation, ..Track::default() };
        if bone == 0 {
            let few: Vec<f32> = times.iter().copied().step_by(5).collect();
            let values: Vec<Vec3> = few.iter().map(|time| Vec3::Y * time.sin() * 0.1).collect();
            track.translation = Channel::new(few, values, Interpolation::Linear);
        }
        track
    });
    Take { name: name.to_owned(), start: 0.0, length, tracks: tracks.collect(), ..Take::default() }
}

/// Returns a view with bones, takes, a material and a warning.
pub fn full() -> View {
    view("Fox.glb", skeleton(9), &[("Survey", 3.417, 41), ("Walk", 0.708, 18), ("Run", 1.158, 26)])
}

/// Returns a view whose topmost bone is its hips.
pub fn hips_on_top() -> View {
    let mut skeleton = skeleton(9);
    skeleton.bones[0].name = "hips".to_owned();
    view("Hips.glb", skeleton, &[("Survey", 3.417, 41), ("Walk", 0.708, 18)])
}

/// Returns a view of `skeleton` with takes of these names, lengths and numbers of keys.
pub fn view(title: &str, skeleton: Skeleton, takes: &[(&str, f32, usize)]) -> View {
    let takes =
        takes.iter().map(|(name, length, keys)| Arc::new(take(name, &skeleton, *length, *keys))).collect();
    let model = Arc::new(ModelData {
        name: title.to_owned(),
        materials: vec![Material::default()],
        animation: AnimationData { skeleton: Arc::new(skeleton), takes },
        ..ModelData::default()
    });
    let bounds = bounds_of_pose(&model, None, 0.0);
    let loaded = LoadedModel {
        conversion: Default::default(),
        title: title.to_owned(),
        path: Some(title.into()),
        format: Some(dragonfly_anim::format::gltf::GLB),
        model,
        bounds,
        images: ImageSurvey::default(),
        warnings: vec!["material 0 uses KHR_materials_clearcoat, which is not shown".to_owned()],
        notes: vec!["/meshes/0/primitives/0/attributes: TEXCOORD_2 is not used".to_owned()],
    };
    View::opened(1, Arc::new(loaded))
}

/// Returns the view of a file without content.
pub fn empty() -> View {
    let mut view = view("empty.gltf", Skeleton::default(), &[]);
    view.generation = 2;
    view
}
