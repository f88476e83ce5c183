//! Comparison of a model with what is read from the file that was written of it.

use crate::support::read_here;
use dragonfly_anim::data::{AlphaMode, ModelData, TextureRef};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::Warning;
use dragonfly_fbx::code::FBX_KEYS;
use dragonfly_fbx::{ExportPreset, FbxOptions, export_with};
use glam::{Mat4, Vec3};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// A model, and the model that was read from its file.
pub(crate) struct RoundTrip {
    pub(crate) before: Evaluator,
    pub(crate) after: Evaluator,
    pub(crate) lost: Vec<Warning>,
    pub(crate) bytes: Vec<u8>,
    /// Conventions that the reader found.
    pub(crate) conventions: String,
}

/// A corner of a triangle: primitive and vertex.
type Corner = (usize, usize);

impl RoundTrip {
    /// Writes a model and reads the file again.
    pub(crate) fn of(model: ModelData, preset: Option<&'static ExportPreset>) -> Self {
        let plan = export_with(&model, "model.fbx", &FbxOptions { preset, ..FbxOptions::default() })
            .expect("a model that can be written");
        assert_eq!(plan.files.len(), 1, "images are in the file");
        let bytes = plan.files[0].bytes.clone();
        let read = read_here(&bytes).expect("a file that can be read");
        // The reader gives up on rotations past the pole of the angles within less than a thousandth of a second.
        let others = read.warnings.iter().filter(|warning| warning.code != FBX_KEYS);
        assert_eq!(others.count(), 0, "{:?}", read.warnings);
        Self {
            before: Evaluator::new(Arc::new(model)),
            after: Evaluator::new(Arc::new(read.model)),
            lost: plan.lost,
            bytes,
            conventions: read.conversion.to_string(),
        }
    }

    /// Returns whether a loss contains these words.
    pub(crate) fn loses(&self, words: &str) -> bool {
        self.lost.iter().any(|lost| lost.text.contains(words))
    }

    /// Returns the size of the model in meters at rest.
    pub(crate) fn size(&mut self) -> f32 {
        self.before.pose(None, 0.0);
        let bones = self.before.to_root().iter().map(|matrix| matrix.w_axis.truncate());
        let all: Vec<Vec3> = bones.chain(self.before.all_positions()).collect();
        let (low, high) =
            all.iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), at| (low.min(*at), high.max(*at)));
        if all.is_empty() { 1.0 } else { (high - low).length().max(1e-3) }
    }

    /// Returns the bone that was read for each bone.
    pub(crate) fn bones(&self) -> Vec<usize> {
        self.bones_at("")
    }

    /// Returns the bone that was read for each bone, below a root if one was added; and whether it was.
    pub(crate) fn bones_below_root(&self) -> (Vec<usize>, bool) {
        let count = |model: &ModelData| model.animation.skeleton.len();
        let is_added = count(self.after.model()) > count(self.before.model());
        (self.bones_at(if is_added { "/0" } else { "" }), is_added)
    }

    fn bones_at(&self, top: &str) -> Vec<usize> {
        let places = |model: &ModelData, top: &str| {
            let mut children: HashMap<Option<u32>, usize> = HashMap::new();
            let mut places: Vec<String> = Vec::new();
            for bone in &model.animation.skeleton.bones {
                let number = children.entry(bone.parent).or_default();
                let parent = bone.parent.map_or(top, |parent| &places[parent as usize]);
                places.push(format!("{parent}/{number}"));
                *number += 1;
            }
            places
        };
        let after = places(self.after.model(), "");
        let known: HashMap<&String, usize> =
            after.iter().enumerate().map(|(at, place)| (place, at)).collect();
        places(self.before.model(), top).iter().map(|place| known[place]).collect()
    }

    /// Returns the largest difference of a bone between both models at a time: of positions relative to `size`, of axes relative
    /// to their length.
    pub(crate) fn bone_difference(&mut self, take: Option<usize>, time: f32, size: f32) -> (f32, String) {
        self.before.pose(take, time);
        self.after.pose(take, time);
        let mut worst = (0.0, String::new());
        for (bone, after) in self.bones().into_iter().enumerate() {
            let difference =
                matrix_difference(self.before.to_root()[bone], self.after.to_root()[after], size);
            if difference > worst.0 || difference.is_nan() {
                let name = &self.before.model().animation.skeleton.bones[bone].name;
                worst = (difference, format!("bone {name} in {take:?} at {time} s"));
            }
        }
        worst
    }

    /// Returns the instance that was read for each instance.
    pub(crate) fn instances(&self) -> Vec<usize> {
        let bones = self.bones();
        let after = self.after.model();
        let mut waiting: BTreeMap<(String, Option<u32>), Vec<usize>> = BTreeMap::new();
        for (number, instance) in after.instances.iter().enumerate().rev() {
            let name = after.meshes[instance.mesh as usize].name.clone();
            let bone = if instance.skin.is_some() { None } else { instance.bone };
            waiting.entry((name, bone)).or_default().push(number);
        }
        let before = self.before.model();
        let found = before.instances.iter().map(|instance| {
            let name = &before.meshes[instance.mesh as usize].name;
            let name = if name.is_empty() { "Mesh".to_owned() } else { name.clone() };
            let bone = if instance.skin.is_some() { None } else { instance.bone };
            let key = (name, bone.map(|bone| bones[bone as usize] as u32));
            waiting.get_mut(&key).and_then(Vec::pop).unwrap_or_else(|| panic!("no mesh {key:?} was read"))
        });
        found.collect()
    }

    /// Returns the largest difference of a deformed vertex relative to `size` in the poses that were set last.
    pub(crate) fn vertex_difference(&self, size: f32) -> f32 {
        let mut worst = 0.0_f32;
        for (before, after) in self.instances().into_iter().enumerate() {
            let (a, b) = (deformed(&self.before, before), deformed(&self.after, after));
            let (a_corners, b_corners) = (corners(&self.before, before), corners(&self.after, after));
            assert_eq!(a_corners.len(), b_corners.len(), "triangles of instance {before}");
            for ((a_part, a_at), (b_part, b_at)) in a_corners.into_iter().zip(b_corners) {
                let difference = a[a_part][a_at].distance(b[b_part][b_at]) / size;
                worst = if difference.is_nan() { f32::INFINITY } else { worst.max(difference) };
            }
        }
        worst
    }

    /// Compares the attributes of all vertices: normals, texture coordinates, colors, and influences of bones.
    pub(crate) fn compare_vertices(&self, name: &str) {
        let bones = self.bones();
        for (before, after) in self.instances().into_iter().enumerate() {
            let (a, b) = (self.before.model(), self.after.model());
            let (a_instance, b_instance) = (&a.instances[before], &b.instances[after]);
            let joints = |model: &ModelData, skin: Option<u32>, map: &dyn Fn(u32) -> usize| -> Vec<usize> {
                let skin = skin.map(|skin| &model.skins[skin as usize].bones);
                skin.into_iter().flatten().map(|&bone| map(bone)).collect()
            };
            let a_joints = joints(a, a_instance.skin, &|bone| bones[bone as usize]);
            let b_joints = joints(b, b_instance.skin, &|bone| bone as usize);
            let corners = corners(&self.before, before).into_iter().zip(corners(&self.after, after));
            for ((a_part, a_at), (b_part, b_at)) in corners {
                let a = &a.meshes[a_instance.mesh as usize].primitives[a_part].vertices;
                let b = &b.meshes[b_instance.mesh as usize].primitives[b_part].vertices;
                if a_instance.to_bone.determinant().abs() > 1e-6 && a.normals[a_at].length() > 0.5 {
                    let normals = a.normals[a_at].normalize().distance(b.normals[b_at]);
                    assert!(normals < 1e-4, "{name}: normals differ by {normals}");
                }
                for set in 0..2 {
                    if let Some(uv) = a.texture_coordinates[set].get(a_at) {
                        let read = b.texture_coordinates[set][b_at];
                        assert!(uv.distance(read) < 1e-5 * uv.length().max(1.0), "{name}: {uv} and {read}");
                    }
                }
                if let Some(color) = a.colors.get(a_at) {
                    let clamped = color.clamp(glam::Vec4::ZERO, glam::Vec4::ONE);
                    assert!(clamped.distance(b.colors[b_at]) < 1e-5, "{name}: a color");
                }
                if a_instance.skin.is_some() {
                    let weights = |list: &[dragonfly_anim::data::Influence], joints: &[usize]| {
                        let mut sums: BTreeMap<usize, f32> = BTreeMap::new();
                        for influence in list.iter().filter(|influence| influence.weight > 0.0) {
                            *sums.entry(joints[usize::from(influence.joint)]).or_default() +=
                                influence.weight;
                        }
                        sums
                    };
                    let (a, b) = (
                        weights(a.influences_of(a_at), &a_joints),
                        weights(b.influences_of(b_at), &b_joints),
                    );
                    for bone in a.keys().chain(b.keys()) {
                        let weight = |sums: &BTreeMap<usize, f32>| sums.get(bone).copied().unwrap_or(0.0);
                        assert!((weight(&a) - weight(&b)).abs() < 1e-3, "{name}: {a:?} and {b:?}");
                    }
                }
            }
        }
    }

    /// Compares materials and images, as far as they are not listed as lost.
    pub(crate) fn compare_materials(&self, name: &str) {
        let (a, b) = (self.before.model(), self.after.model());
        assert!(b.materials.len() >= a.materials.len(), "{name}: materials");
        for (number, (before, after)) in a.materials.iter().zip(&b.materials).enumerate() {
            let place = format!("{name}: material {number}");
            assert_eq!(before.name, after.name, "{place}");
            let is_gray = before.base_color.truncate() == Vec3::splat(before.base_color.x);
            if before.base_color_texture.is_none() || is_gray {
                let (was, is) = (before.base_color.truncate(), after.base_color.truncate());
                assert!(was.distance(is) < 2e-3, "{place}: {was} and {is}");
            }
            if before.alpha_mode == AlphaMode::Blend && before.base_color.w > 0.0 {
                assert!((before.base_color.w - after.base_color.w).abs() < 1e-5, "{place}: alpha");
            }
            let emissive = before.emissive.clamp(Vec3::ZERO, Vec3::ONE);
            assert!(emissive.distance(after.emissive) < 1e-5, "{place}: emission");
            if !before.use_phong {
                let roughness = (before.metallic.roughness - after.metallic.roughness).abs();
                assert!(roughness < 1e-4, "{place}: roughness {roughness}");
                let metallic = (before.metallic.metallic - after.metallic.metallic).abs();
                assert!(metallic < 1e-6, "{place}: metallic {metallic}");
            }
            let bytes = |model: &ModelData, texture: &Option<TextureRef>| {
                let image = model.images.get(texture.as_ref()?.image as usize)?;
                (!image.bytes.is_empty()).then(|| Arc::clone(&image.bytes))
            };
            let pairs = [
                (&before.base_color_texture, &after.base_color_texture),
                (&before.emissive_texture, &after.emissive_texture),
                (&before.normal_texture, &after.normal_texture),
            ];
            for (was, is) in pairs {
                assert_eq!(bytes(a, was), bytes(b, is), "{place}: a texture");
                if let (Some(was), Some(is)) = (was, is) {
                    assert_eq!(was.set, is.set, "{place}");
                    let scale = was.transform.scale.distance(is.transform.scale);
                    let offset = was.transform.offset.distance(is.transform.offset);
                    assert!(was.transform.rotation != 0.0 || scale + offset < 1e-4, "{place}: a transform");
                }
            }
        }
    }
}

/// Returns the deformed vertices of an instance, primitive by primitive.
fn deformed(evaluator: &Evaluator, instance: usize) -> Vec<Vec<Vec3>> {
    let primitives = evaluator.primitives(instance).iter().enumerate();
    let positions = primitives.map(|(number, primitive)| {
        let mut positions = vec![Vec3::ZERO; primitive.vertices.len()];
        evaluator.positions(instance, number, &mut positions);
        positions
    });
    positions.collect()
}

/// Returns the corners of the triangles of an instance, those of one material together.
fn corners(evaluator: &Evaluator, instance: usize) -> Vec<Corner> {
    let primitives = evaluator.primitives(instance);
    let mut materials: Vec<Option<u32>> = Vec::new();
    for primitive in primitives.iter().filter(|primitive| !primitive.indices.is_empty()) {
        if !materials.contains(&primitive.material) {
            materials.push(primitive.material);
        }
    }
    let mut corners = Vec::new();
    for material in materials {
        for (number, primitive) in primitives.iter().enumerate().filter(|(_, one)| one.material == material) {
            corners.extend(primitive.indices.iter().map(|&vertex| (number, vertex as usize)));
        }
    }
    corners
}

fn matrix_difference(a: Mat4, b: Mat4, size: f32) -> f32 {
    let origin = a.w_axis.distance(b.w_axis) / size;
    let axes = [(a.x_axis, b.x_axis), (a.y_axis, b.y_axis), (a.z_axis, b.z_axis)];
    let axes = axes.map(|(a, b)| a.distance(b) / a.length().max(1e-3));
    axes.into_iter().fold(origin, |worst, axis| if axis.is_nan() { f32::INFINITY } else { worst.max(axis) })
}
