//! Large files, made in code.

use dragonfly_anim::data::{Channel, Interpolation, ModelData, Take};
use dragonfly_anim::format::{NoFiles, ReadOptions, gltf, read};
use dragonfly_kit::figures::root;
use glam::{Quat, Vec3};
use std::fmt::Write;
use std::sync::Arc;

/// Joints of the BVH file.
const JOINTS: usize = 60;

/// Rows of the BVH file.
const FRAMES: usize = 20_000;

/// Vertices along one side of the surface of the OBJ file: 500 000 triangles.
const SIDE: usize = 501;

/// Keys of each channel of the glTF file: with 30 bones of three channels, 90 000 keys.
const KEYS: usize = 1_000;

/// Bones of the glTF file.
const BONES: usize = 30;

/// Returns a BVH file of [`JOINTS`] joints in one chain and [`FRAMES`] rows.
pub(crate) fn bvh() -> Vec<u8> {
    let mut text = "HIERARCHY\n".to_owned();
    for joint in 0..JOINTS {
        let (word, positions, count) =
            if joint == 0 { ("ROOT", "Xposition Yposition Zposition ", 6) } else { ("JOINT", "", 3) };
        let _ = writeln!(text, "{word} joint{joint}\n{{\nOFFSET 0 2.5 0");
        let _ = writeln!(text, "CHANNELS {count} {positions}Zrotation Xrotation Yrotation");
    }
    text += "End Site\n{\nOFFSET 0 2.5 0\n}\n";
    text += &"}\n".repeat(JOINTS);
    let _ = writeln!(text, "MOTION\nFrames: {FRAMES}\nFrame Time: 0.00833333");
    for frame in 0..FRAMES {
        for number in 0..3 * JOINTS + 3 {
            let value = 40.0 * (frame as f32 * 0.01 + number as f32).sin();
            let _ = write!(text, "{value:.6} ");
        }
        text.push('\n');
    }
    text.into_bytes()
}

/// Returns an OBJ file of a surface with normals and texture coordinates.
pub(crate) fn obj() -> Vec<u8> {
    let mut text = String::new();
    for index in 0..SIDE * SIDE {
        let (x, z) = ((index % SIDE) as f32 * 0.01, (index / SIDE) as f32 * 0.01);
        let _ = writeln!(text, "v {x:.6} {:.6} {z:.6}", (x * 3.0).sin() * (z * 2.0).cos());
    }
    for index in 0..SIDE * SIDE {
        let part = |at: usize| at as f32 / (SIDE - 1) as f32;
        let _ = writeln!(text, "vt {:.6} {:.6}", part(index % SIDE), part(index / SIDE));
    }
    for index in 0..SIDE * SIDE {
        let normal = Vec3::new((index as f32 * 0.1).sin() * 0.3, 1.0, 0.1).normalize();
        let _ = writeln!(text, "vn {:.5} {:.5} {:.5}", normal.x, normal.y, normal.z);
    }
    for row in 0..SIDE - 1 {
        for column in 0..SIDE - 1 {
            let first = row * SIDE + column + 1;
            let [a, b, c, d] = [first, first + 1, first + SIDE + 1, first + SIDE];
            let _ = writeln!(
                text,
                "f {a}/{a}/{a} {c}/{c}/{c} {b}/{b}/{b}\nf {a}/{a}/{a} {d}/{d}/{d} {c}/{c}/{c}"
            );
        }
    }
    text.into_bytes()
}

/// Returns the rig of the benchmarks with all takes `repeated` times.
///
/// # Panics
/// If the rig cannot be read.
pub(crate) fn rig(repeated: usize) -> ModelData {
    let bytes = std::fs::read(root().join("tests/data/bench/pab.glb")).expect("the rig of the benchmarks");
    let mut model = read("pab.glb", &bytes, &NoFiles, &ReadOptions::default()).expect("a model").model;
    let takes = model.animation.takes.clone();
    for number in 1..repeated {
        let renamed = takes
            .iter()
            .map(|take| Arc::new(Take { name: format!("{}{number}", take.name), ..(**take).clone() }));
        model.animation.takes.extend(renamed);
    }
    model
}

/// Returns a GLB file with 90 000 keys.
///
/// # Panics
/// If the rig cannot be read or written.
pub(crate) fn glb() -> Vec<u8> {
    let mut model = rig(1);
    let times: Arc<[f32]> = (0..KEYS).map(|key| key as f32 / 30.0).collect();
    let mut take = (*model.animation.takes[0]).clone();
    (take.start, take.length) = (0.0, times[KEYS - 1]);
    take.morphs.clear();
    for (bone, track) in take.tracks.iter_mut().enumerate() {
        *track = Default::default();
        if bone < BONES {
            let angle = |key: usize| (key as f32 * 0.02 + bone as f32).sin();
            let rotations: Vec<Quat> = (0..KEYS).map(|key| Quat::from_rotation_x(angle(key))).collect();
            let places: Vec<Vec3> = (0..KEYS).map(|key| Vec3::new(0.0, 0.1, angle(key) * 0.01)).collect();
            let scales: Vec<Vec3> = (0..KEYS).map(|key| Vec3::splat(1.0 + angle(key) * 0.01)).collect();
            track.rotation = Channel::new(Arc::clone(&times), rotations, Interpolation::Linear);
            track.translation = Channel::new(Arc::clone(&times), places, Interpolation::Linear);
            track.scale = Channel::new(Arc::clone(&times), scales, Interpolation::Linear);
        }
    }
    model.animation.takes = vec![Arc::new(take)];
    let export = gltf::GLB.export.expect("GLB is written");
    export(&model, "keys.glb").expect("a GLB").files.pop().expect("one file").bytes
}
