//! Random models of valid structure with any numbers.

use dragonfly_anim::data::{
    AlphaMode, AnimationData, Bone, Channel, Filter, Image, Influence, Interpolation, Material, Mesh,
    MeshInstance, Metallic, ModelData, MorphTarget, MorphTrack, Phong, Primitive, Skeleton, Skin, Take,
    TextureRef, TextureTransform, Track, Transform, Vertices, Wrap,
};
use dragonfly_kit::random::Random;
use glam::{Mat4, Quat, Vec2, Vec3, Vec4};
use std::sync::Arc;

/// Makes random models from one seed.
pub(crate) struct RandomModels {
    pub(crate) random: Random,
    /// Probability that a number is any 32 bits: NaN, infinity, subnormal.
    pub(crate) odd: f32,
}

impl RandomModels {
    fn chance(&mut self, chance: f32) -> bool {
        self.random.unit() < chance
    }

    fn number(&mut self) -> f32 {
        if self.chance(self.odd) {
            let bits = self.random.bits() as u32;
            // Every second one is a NaN with a payload and a sign.
            f32::from_bits(if bits & 1 == 0 { bits } else { bits | 0x7f80_0000 })
        } else {
            self.random.between(-2.0, 2.0)
        }
    }

    fn floats<const N: usize>(&mut self) -> [f32; N] {
        [(); N].map(|()| self.number())
    }

    fn v2(&mut self) -> Vec2 {
        self.floats().into()
    }

    fn v3(&mut self) -> Vec3 {
        self.floats().into()
    }

    fn v4(&mut self) -> Vec4 {
        self.floats().into()
    }

    fn quat(&mut self) -> Quat {
        Quat::from_array(self.floats())
    }

    fn mat4(&mut self) -> Mat4 {
        Mat4::from_cols_array(&self.floats())
    }

    fn list<T>(&mut self, count: usize, mut make: impl FnMut(&mut Self) -> T) -> Vec<T> {
        (0..count).map(|_| make(self)).collect()
    }

    /// Returns a column that may be missing.
    fn column<T>(&mut self, count: usize, make: impl FnMut(&mut Self) -> T) -> Vec<T> {
        let count = if self.chance(0.6) { count } else { 0 };
        self.list(count, make)
    }

    fn name(&mut self) -> String {
        self.random.choice(&["", "hip", "Žofie", "name with spaces", "骨"]).to_owned()
    }

    fn maybe(&mut self, below: usize) -> Option<u32> {
        (below > 0 && self.chance(0.7)).then(|| self.random.below(below) as u32)
    }

    fn node(&mut self) -> Option<u32> {
        let number = self.random.bits() as u32;
        // The largest number has no special meaning here.
        if self.chance(0.2) { Some(u32::MAX) } else { self.chance(0.5).then_some(number) }
    }

    fn interpolation(&mut self) -> Interpolation {
        self.random.choice(&[
            Interpolation::Step,
            Interpolation::Linear,
            Interpolation::CubicSpline,
            Interpolation::Closest,
        ])
    }

    /// Returns key times of few possible values, so that several channels often share some; sometimes the times do not
    /// increase, or are not finite.
    fn times(&mut self, keys: usize) -> Vec<f32> {
        let mut times = self.list(keys, |maker| maker.random.below(6) as f32 / 4.0 - 0.0);
        if !self.chance(self.odd) {
            times.sort_by(f32::total_cmp);
            times.dedup();
        } else if let Some(time) = times.first_mut() {
            *time = self.number();
        }
        times
    }

    fn channel<T>(&mut self, make: impl FnMut(&mut Self) -> T) -> Channel<T> {
        let keys = self.random.below(5);
        let (times, interpolation) = (self.times(keys), self.interpolation());
        let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let values = self.list(times.len() * parts, make);
        Channel { times: times.into(), values: values.into(), interpolation }
    }

    fn texture(&mut self, images: usize) -> Option<TextureRef> {
        let image = self.maybe(images)?;
        let wraps = [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge];
        let filters = [Filter::Nearest, Filter::Linear];
        let transform = TextureTransform { offset: self.v2(), rotation: self.number(), scale: self.v2() };
        Some(TextureRef {
            image,
            set: self.random.below(2) as u32,
            wrap: [self.random.choice(&wraps), self.random.choice(&wraps)],
            magnify: self.random.choice(&filters),
            minify: self.random.choice(&filters),
            mip: self.chance(0.5),
            transform,
        })
    }

    fn material(&mut self, images: usize) -> Material {
        let modes = [AlphaMode::Opaque, AlphaMode::Mask(self.number()), AlphaMode::Blend];
        Material {
            name: self.name(),
            base_color: self.v4(),
            base_color_texture: self.texture(images),
            metallic: Metallic { metallic: self.number(), roughness: self.number() },
            metallic_roughness_texture: self.texture(images),
            phong: Phong {
                ambient: self.v3(),
                diffuse: self.v3(),
                specular: self.v3(),
                specular_power: self.number(),
            },
            use_phong: self.chance(0.5),
            normal_texture: self.texture(images),
            normal_scale: self.number(),
            occlusion_texture: self.texture(images),
            occlusion_strength: self.number(),
            emissive: self.v3(),
            emissive_texture: self.texture(images),
            alpha_mode: self.random.choice(&modes),
            double_sided: self.chance(0.5),
            unlit: self.chance(0.5),
        }
    }

    fn primitive(&mut self, materials: usize, joints: usize, targets: usize) -> Primitive {
        let count = self.random.below(5);
        let per_vertex = if joints == 0 { 0 } else { self.random.choice(&[0, 1, 4, 8]) };
        let triangles = if count == 0 { 0 } else { self.random.below(4) };
        Primitive {
            vertices: Vertices {
                positions: self.list(count, Self::v3),
                normals: self.column(count, Self::v3),
                tangents: self.column(count, Self::v4),
                texture_coordinates: [self.column(count, Self::v2), self.column(count, Self::v2)],
                colors: self.column(count, Self::v4),
                influences: self.list(count * per_vertex, |maker| Influence {
                    joint: maker.random.below(joints) as u16,
                    weight: maker.number(),
                }),
                influences_per_vertex: per_vertex,
            },
            indices: self.list(triangles * 3, |maker| maker.random.below(count) as u32),
            material: self.maybe(materials),
            morph_targets: self.list(targets, |maker| MorphTarget {
                name: maker.name(),
                positions: maker.column(count, Self::v3),
                normals: maker.column(count, Self::v3),
                tangents: maker.column(count, Self::v3),
            }),
        }
    }

    fn bone(&mut self, index: usize) -> Bone {
        Bone {
            name: self.name(),
            parent: self.maybe(index),
            rest: Transform { translation: self.v3(), rotation: self.quat(), scale: self.v3() },
            rest_matrix: self.chance(0.3).then(|| self.mat4()),
            offset: self.mat4(),
            node: self.node(),
        }
    }

    fn take(&mut self, bones: usize, targets: &[usize]) -> Take {
        Take {
            name: self.name(),
            start: self.number(),
            length: self.number(),
            tracks: (0..bones as u32)
                .map(|bone| Track {
                    bone,
                    translation: self.channel(Self::v3),
                    rotation: self.channel(Self::quat),
                    scale: self.channel(Self::v3),
                })
                .collect(),
            morphs: targets
                .iter()
                .enumerate()
                .map(|(instance, &targets)| self.morph(instance, targets))
                .collect(),
            ..Take::default()
        }
    }

    fn morph(&mut self, instance: usize, targets: usize) -> MorphTrack {
        let (times, interpolation) = (self.times(3), self.interpolation());
        let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let weights = self.list(times.len() * targets * parts, Self::number);
        let (instance, targets) = (instance as u32, targets as u32);
        MorphTrack { instance, targets, times: times.into(), weights: weights.into(), interpolation }
    }

    /// Returns a model with some of every feature, or without it.
    pub(crate) fn model(&mut self) -> ModelData {
        let [images, materials, bones, skins, meshes, instances, takes] =
            [3, 3, 4, 3, 3, 4, 3].map(|most| self.random.below(most));
        let skins = if bones == 0 { 0 } else { skins };
        let joints = if skins == 0 { 0 } else { 3 };
        let meshes = self.list(meshes, |maker| {
            let (primitives, targets) = (maker.random.below(3), maker.random.below(3));
            Mesh {
                name: maker.name(),
                primitives: maker.list(primitives, |maker| maker.primitive(materials, joints, targets)),
                morph_weights: maker.list(targets, Self::number),
            }
        });
        let instances = if meshes.is_empty() { 0 } else { instances };
        let instances = self.list(instances, |maker| {
            let mesh = maker.random.below(meshes.len());
            MeshInstance {
                mesh: mesh as u32,
                node: maker.node(),
                skin: maker.maybe(skins),
                bone: maker.maybe(bones),
                to_bone: maker.mat4(),
                morph_weights: maker.list(meshes[mesh].morph_weights.len(), Self::number),
            }
        });
        let targets: Vec<usize> = instances.iter().map(|instance| instance.morph_weights.len()).collect();
        ModelData {
            avatar: Default::default(),
            name: self.name(),
            instances,
            skins: self.list(skins, |maker| Skin {
                name: maker.name(),
                bones: maker.list(joints, |maker| maker.random.below(bones) as u32),
                offsets: maker.list(joints, Self::mat4),
            }),
            materials: self.list(materials, |maker| maker.material(images)),
            images: self.list(images, |maker| Image {
                name: maker.name(),
                file_name: maker.chance(0.5).then(|| maker.name()),
                mime: maker.name(),
                bytes: maker.list(5, |maker| maker.random.bits() as u8).into(),
                width: maker.random.bits() as u32,
                height: maker.random.bits() as u32,
            }),
            animation: AnimationData {
                skeleton: Arc::new(Skeleton { bones: (0..bones).map(|index| self.bone(index)).collect() }),
                takes: (0..takes).map(|_| Arc::new(self.take(bones, &targets))).collect(),
            },
            meshes,
        }
    }
}
