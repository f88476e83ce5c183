//! The built-in model: a dragonfly, about one unit long, made entirely by code.
//!
//! [`build`] makes the file from nothing: skeleton, skinned surfaces, painted textures and three
//! takes. The program itself carries the finished file, [`DRAGONFLY_GLB`], so that opening it
//! costs nothing; a test keeps the two equal.

mod body;
mod chart;
mod glb;
mod head;
mod legs;
mod mesh;
mod num;
mod paint;
mod skeleton;
mod stance;
mod takes;
mod texture;
mod veins;
mod wing_plan;
mod wings;

/// The finished model: a binary glTF 2.0 file of under one megabyte.
///
/// Y is up, the animal faces +Z and is about one unit long. Its takes are `hover` (2 s, loops),
/// `cruise` (1.5 s, loops) and `land` (3.2 s, ends standing on `y = 0`).
pub const DRAGONFLY_GLB: &[u8] = include_bytes!("../../assets/dragonfly.glb");

/// Builds the bytes of [`DRAGONFLY_GLB`] again; every call returns the same.
///
/// It paints and packs every texture, which takes about a second.
pub fn build() -> Vec<u8> {
    glb::write(&model())
}

fn model() -> glb::Model {
    let mut trunk = mesh::DemoMesh::default();
    body::add(&mut trunk);
    head::add(&mut trunk);
    legs::add(&mut trunk);
    let mut eyes = mesh::DemoMesh::default();
    head::add_eye(&mut eyes);
    let mut sheets = mesh::DemoMesh::default();
    wings::add(&mut sheets);
    let mut meshes = [trunk, eyes, sheets];
    meshes.iter_mut().for_each(mesh::DemoMesh::mirror);
    glb::Model { bones: skeleton::bones(), meshes, pictures: texture::pictures(), takes: takes::takes() }
}

#[cfg(test)]
mod tests {
    use super::takes::{DemoPath, DemoTrack};
    use super::*;
    use glam::{Mat4, Quat, Vec3};
    use serde_json::Value;

    fn document(file: &[u8]) -> (Value, &[u8]) {
        let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
        let json = serde_json::from_slice(&file[20..20 + length]).unwrap();
        (json, &file[28 + length..])
    }

    fn last(track: &DemoTrack) -> &[f32] {
        let width = if track.path == DemoPath::Rotation { 4 } else { 3 };
        let end = track.values.len() - if track.cubic { width } else { 0 };
        &track.values[end - width..end]
    }

    #[test]
    fn every_build_gives_the_same_bytes() {
        assert!(build() == build());
    }

    #[test]
    fn the_embedded_file_equals_the_built_one() {
        let built = build();
        if std::env::var_os("DRAGONFLY_REWRITE").is_some() {
            let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/dragonfly.glb");
            std::fs::write(path, &built).unwrap();
        }
        // The embedded file is the one at compile time: a second build agrees.
        assert!(built == DRAGONFLY_GLB, "DRAGONFLY_REWRITE=1 cargo test -p dragonfly-document embedded");
    }

    #[test]
    fn the_file_is_smaller_than_a_megabyte_and_its_lengths_agree() {
        assert!(DRAGONFLY_GLB.len() < 1_000_000);
        assert_eq!(&DRAGONFLY_GLB[..4], b"glTF");
        let size = u32::from_le_bytes(DRAGONFLY_GLB[8..12].try_into().unwrap());
        assert_eq!(size as usize, DRAGONFLY_GLB.len());
        let (json, binary) = document(DRAGONFLY_GLB);
        assert_eq!(json["buffers"][0]["byteLength"].as_u64().unwrap() as usize, binary.len());
        for view in json["bufferViews"].as_array().unwrap() {
            assert_eq!(view["byteOffset"].as_u64().unwrap() % 4, 0);
        }
    }

    #[test]
    fn bone_names_are_unique_and_parents_precede_their_children() {
        let bones = skeleton::bones();
        assert!((25..=60).contains(&bones.len()));
        assert_eq!(bones.len(), skeleton::COUNT);
        for (i, bone) in bones.iter().enumerate() {
            assert!(bone.parent.is_none_or(|p| p < i), "{}", bone.name);
            assert!(bones[..i].iter().all(|b| b.name != bone.name), "{}", bone.name);
            let twin = &bones[skeleton::mirrored(i)];
            let name = bone.name.replace("left", "*").replace("right", "left").replace('*', "right");
            assert_eq!(twin.name, name);
            assert_eq!(twin.head, Vec3::new(-bone.head.x, bone.head.y, bone.head.z));
        }
        for name in ["thorax", "abdomen_1", "abdomen_8", "wing_fore_left_1", "leg_fore_left_femur"] {
            assert!(bones.iter().any(|b| b.name == name), "{name}");
        }
    }

    #[test]
    fn vertex_weights_sum_to_one_and_normals_are_orthogonal_to_tangents() {
        for mesh in &model().meshes {
            assert!(!mesh.indices.is_empty());
            for v in &mesh.vertices {
                assert_eq!(v.bind.weights.iter().map(|&w| u32::from(w)).sum::<u32>(), 255);
                for k in 0..4 {
                    assert!(usize::from(v.bind.joints[k]) < skeleton::COUNT);
                    assert!(v.bind.weights[k] > 0 || v.bind.joints[k] == 0);
                }
                assert!((v.normal.length() - 1.0).abs() < 1e-4);
                assert!((v.tangent.truncate().length() - 1.0).abs() < 1e-4);
                assert!(v.normal.dot(v.tangent.truncate()).abs() < 1e-3);
            }
        }
    }

    #[test]
    fn the_model_has_three_takes_and_those_that_loop_end_as_they_start() {
        let takes = takes::takes();
        let names: Vec<_> = takes.iter().map(|t| t.name).collect();
        assert_eq!(names, ["hover", "cruise", "land"]);
        for take in &takes {
            for track in &take.tracks {
                assert!(track.values.iter().all(|x| x.is_finite()));
                assert!(track.times.windows(2).all(|w| w[0] < w[1]));
                assert_eq!(track.times[0], 0.0);
                let width = if track.path == DemoPath::Rotation { 4 } else { 3 };
                let rows = if track.cubic { 3 } else { 1 };
                assert_eq!(track.values.len(), track.times.len() * width * rows);
                if take.name != "land" {
                    let row = width * rows;
                    let tail = &track.values[track.values.len() - row..];
                    assert_eq!(&track.values[..row], tail, "{} {}", take.name, track.bone);
                }
            }
        }
    }

    #[test]
    fn the_landing_ends_with_six_feet_on_the_ground() {
        let bones = skeleton::bones();
        let takes = takes::takes();
        let mut world: Vec<Mat4> = Vec::new();
        for (i, bone) in bones.iter().enumerate() {
            let above = bone.parent.map_or(Vec3::ZERO, |p| bones[p].head);
            let (mut place, mut turn) = (bone.head - above, Quat::IDENTITY);
            for track in takes[2].tracks.iter().filter(|t| t.bone == i) {
                match track.path {
                    DemoPath::Rotation => turn = Quat::from_slice(last(track)),
                    DemoPath::Translation => place = Vec3::from_slice(last(track)),
                }
            }
            let local = Mat4::from_rotation_translation(turn, place);
            world.push(bone.parent.map_or(local, |p| world[p] * local));
        }
        for side in skeleton::SIDES {
            for (pair, joints) in skeleton::LEG_JOINTS.iter().enumerate() {
                let bone = skeleton::leg(side, pair, 3);
                let toe = skeleton::on_side(side, joints[4]);
                let now = world[bone].transform_point3(toe - bones[bone].head);
                assert!((now - toe).length() < 2e-3, "{} {now} {toe}", bones[bone].name);
            }
        }
    }
}
