//! A reader that knows only the thesis's layout, with elements of the thesis's size, reads every file.

use super::frame::number;
use crate::doors::data;
use crate::support::{angle_between, assert_near};
use dragonfly_anim::data::Transform;
use dragonfly_anim::format::{NoFiles, ReadOptions, dfm, read};
use dragonfly_anim::sample::{mix, sample_take};
use glam::{Mat4, Quat, Vec3};

/// Reads numbers from the front of a file.
struct Flat<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Flat<'_> {
    fn u(&mut self) -> u32 {
        self.at += 4;
        number(self.bytes, self.at - 4).unwrap()
    }

    fn f(&mut self) -> f32 {
        f32::from_bits(self.u())
    }

    fn v3(&mut self) -> Vec3 {
        Vec3::new(self.f(), self.f(), self.f())
    }

    /// Reads an element and skips the fields that `read` does not know.
    fn element<T>(&mut self, size: u32, read: impl FnOnce(&mut Self) -> T) -> T {
        let end = self.at + size as usize;
        let element = read(self);
        assert!(self.at <= end);
        self.at = end;
        element
    }

    /// Reads count, size and elements.
    fn elements<T>(&mut self, mut read: impl FnMut(&mut Self) -> T) -> Vec<T> {
        let (count, size) = (self.u(), self.u());
        (0..count).map(|_| self.element(size, &mut read)).collect()
    }
}

struct ThesisKeyframe {
    time: f32,
    pose: Transform,
}

/// The content of the thesis's part, as far as the tests need it.
struct ThesisModel {
    positions: Vec<Vec3>,
    /// Bones and weights of each vertex.
    skinning: Vec<([u32; 4], [f32; 4])>,
    materials: Vec<u32>,
    indices: Vec<u32>,
    attributes: Vec<u32>,
    diffuse: Vec<Vec3>,
    /// Parent and offset.
    bones: Vec<(u32, Mat4)>,
    /// Start, length, and the key-frames of each bone.
    takes: Vec<(f32, f32, Vec<Vec<ThesisKeyframe>>)>,
}

fn read_flat(bytes: &[u8]) -> ThesisModel {
    let mut flat = Flat { bytes, at: 0 };
    assert_eq!(flat.u() as usize, bytes.len());
    let vertices = flat.elements(|flat| {
        let position = flat.v3();
        flat.at += 12 + 16;
        let bones = [flat.u(), flat.u(), flat.u(), flat.u()];
        let weights = [flat.f(), flat.f(), flat.f(), flat.f()];
        (position, (bones, weights), flat.u())
    });
    let indices = flat.elements(Flat::u);
    let attributes = flat.elements(Flat::u);
    let diffuse = flat.elements(Flat::v3);
    let bones = flat.elements(|flat| {
        let (parent, _index) = (flat.u(), flat.u());
        (parent, Mat4::from_cols_array(&[(); 16].map(|()| flat.f())))
    });
    let (count, take, track, keyframe) = (flat.u(), flat.u(), flat.u(), flat.u());
    let takes = (0..count).map(|_| {
        let (start, length, tracks) = flat.element(take, |flat| (flat.f(), flat.f(), flat.u()));
        let tracks = (0..tracks).map(|index| {
            let (bone, keyframes) = flat.element(track, |flat| (flat.u(), flat.u()));
            assert_eq!(bone, index);
            let read = |flat: &mut Flat<'_>| {
                let (time, translation, scale) = (flat.f(), flat.v3(), flat.v3());
                let rotation = Quat::from_xyzw(flat.f(), flat.f(), flat.f(), flat.f());
                ThesisKeyframe { time, pose: Transform { translation, rotation, scale } }
            };
            (0..keyframes).map(|_| flat.element(keyframe, read)).collect()
        });
        (start, length, tracks.collect())
    });
    let takes = takes.collect();
    ThesisModel {
        positions: vertices.iter().map(|vertex| vertex.0).collect(),
        skinning: vertices.iter().map(|vertex| vertex.1).collect(),
        materials: vertices.iter().map(|vertex| vertex.2).collect(),
        indices,
        attributes,
        diffuse,
        bones,
        takes,
    }
}

/// The thesis's linear interpolation of a bone's key-frames.
fn interpolate(keyframes: &[ThesisKeyframe], time: f32) -> Transform {
    let after = keyframes.iter().position(|key| key.time > time).unwrap_or(keyframes.len());
    let (before, after) = (&keyframes[after.max(1) - 1], &keyframes[after.min(keyframes.len() - 1)]);
    let span = after.time - before.time;
    let part = if span > 0.0 { (time - before.time) / span } else { 0.0 };
    Transform {
        translation: before.pose.translation.lerp(after.pose.translation, part),
        rotation: mix::slerp(before.pose.rotation, after.pose.rotation, part),
        scale: before.pose.scale.lerp(after.pose.scale, part),
    }
}

#[test]
fn a_reader_of_the_thesis_layout_finds_geometry_skeleton_and_motion() {
    let file = std::fs::read(data().join("gltf/Fox.glb")).unwrap();
    let model = read("Fox.glb", &file, &NoFiles, &ReadOptions::default()).unwrap().model;
    let flat = read_flat(&dfm::write(&model).unwrap());
    let primitive = &model.meshes[0].primitives[0];
    assert_eq!(flat.positions, primitive.vertices.positions);
    assert_eq!(flat.indices, primitive.indices);
    assert!(
        flat.materials.iter().chain(&flat.attributes).all(|&material| Some(material) == primitive.material)
    );
    assert_eq!(flat.attributes.len(), flat.positions.len());
    assert_eq!(flat.diffuse, [model.materials[0].phong.diffuse]);
    // Bones, not joints: they index the skeleton.
    let skin = &model.skins[0];
    for (index, (bones, weights)) in flat.skinning.iter().enumerate() {
        for (slot, influence) in primitive.vertices.influences_of(index).iter().enumerate() {
            assert_eq!(bones[slot], skin.bones[usize::from(influence.joint)]);
            assert_eq!(weights[slot], influence.weight);
        }
    }
    let bones = &model.animation.skeleton.bones;
    assert_eq!(flat.bones.len(), bones.len());
    for (flat, bone) in flat.bones.iter().zip(bones) {
        assert_eq!(*flat, (bone.parent.unwrap_or(u32::MAX), bone.offset));
    }
    assert_eq!(flat.takes.len(), 3);
    let mut poses = vec![Transform::IDENTITY; bones.len()];
    for ((start, length, tracks), take) in flat.takes.iter().zip(&model.animation.takes) {
        assert_eq!((*start, *length), (take.start, take.length));
        for step in 0..=20 {
            let time = start + length * step as f32 / 20.0;
            sample_take(Some(take), &model.animation.skeleton, time, &mut poses);
            for (keyframes, pose) in tracks.iter().zip(&poses).filter(|(keyframes, _)| !keyframes.is_empty())
            {
                let got = interpolate(keyframes, time);
                assert_near(
                    Mat4::from_translation(got.translation),
                    Mat4::from_translation(pose.translation),
                    1e-5,
                );
                assert_near(Mat4::from_scale(got.scale), Mat4::from_scale(pose.scale), 1e-5);
                assert!(angle_between(got.rotation, pose.rotation) < 1e-3);
            }
        }
    }
}
