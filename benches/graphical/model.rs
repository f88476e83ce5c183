//! The animated model: a skeleton, takes, and a mesh to draw, of any size and always the same for a size.

use super::document::{SharedDocument, TakeEntry, stamped};
use dragonfly_anim::data::{
    Bone, Channel, Influence, Interpolation, Primitive, Skeleton, Skin, Take, Track, Transform, Vertices,
};
use dragonfly_kit::random::Random;
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

/// Size of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelSize {
    /// Number of bones of the skeleton.
    pub bones: usize,
    /// Number of takes of the document.
    pub takes: usize,
    /// Number of keys of every channel.
    pub keys: usize,
}

impl ModelSize {
    /// A size for tests.
    pub const TINY: Self = Self { bones: 6, takes: 3, keys: 12 };
    /// A typical document: 540,000 keys, counted over translation, rotation and scale.
    pub const USUAL: Self = Self { bones: 60, takes: 10, keys: 300 };
    /// Motion capture, two minutes for each take: 5.4 million keys.
    pub const LONG: Self = Self { bones: 60, takes: 4, keys: 7_500 };
    /// A day of motion capture: 43 million keys, eight minutes for each take.
    pub const HUGE: Self = Self { bones: 60, takes: 8, keys: 29_862 };

    /// Returns a document of this size without changes.
    pub fn document(self) -> SharedDocument {
        let mut random = Random::new(7);
        let skeleton = Arc::new(self.skeleton());
        let times: Arc<[f32]> = (0..self.keys).map(|key| key as f32 / 60.0).collect();
        // Without changes, all bones share one column of identities.
        let nothing = Arc::new(self.take(&times, "changes", {
            let translation = column(&times, self.keys, |_| Vec3::ZERO);
            let rotation = column(&times, self.keys, |_| Quat::IDENTITY);
            let scale = column(&times, self.keys, |_| Vec3::ONE);
            move |bone| Track {
                bone,
                translation: translation.clone(),
                rotation: rotation.clone(),
                scale: scale.clone(),
            }
        }));
        let takes = (0..self.takes).map(|index| {
            let take = self.take(&times, &format!("take {index}"), |bone| {
                let (speed, phase) = (random.between(0.5, 4.0), random.between(0.0, 6.0));
                let swing = |key: usize| (key as f32 / 60.0 * speed + phase).sin();
                Track {
                    bone,
                    translation: column(&times, self.keys, |key| Vec3::new(0.02 * swing(key), 0.1, 0.0)),
                    rotation: column(&times, self.keys, |key| Quat::from_rotation_z(0.3 * swing(key))),
                    scale: column(&times, self.keys, |_| Vec3::ONE),
                }
            });
            TakeEntry::new(Arc::new(take), Arc::clone(&nothing))
        });
        SharedDocument { takes: takes.collect(), skeleton }
    }

    /// Returns changes of every key of a take, as made by edit `number`.
    pub fn changes(self, times: &Arc<[f32]>, number: u64) -> Take {
        let turn = Quat::from_rotation_y((number % 100) as f32 * 0.01);
        self.take(times, "changes", |bone| Track {
            bone,
            translation: column(times, self.keys, |_| Vec3::ZERO),
            rotation: column(times, self.keys, |_| turn),
            scale: column(times, self.keys, |_| stamped(number)),
        })
    }

    fn take(self, times: &Arc<[f32]>, name: &str, track: impl FnMut(u32) -> Track) -> Take {
        let length = times.last().copied().unwrap_or(0.0);
        let tracks = (0..self.bones as u32).map(track).collect();
        Take { name: name.to_owned(), start: 0.0, length, tracks, ..Take::default() }
    }

    /// Returns a spine with limbs: the parent of every bone is one of the three before it.
    fn skeleton(self) -> Skeleton {
        let bone = |index: usize| Bone {
            name: format!("bone {index}"),
            parent: (index > 0).then(|| index.saturating_sub(1 + index % 3) as u32),
            rest: Transform { translation: Vec3::Y * 0.1, ..Transform::IDENTITY },
            rest_matrix: None,
            offset: Mat4::IDENTITY,
            node: None,
        };
        Skeleton { bones: (0..self.bones).map(bone).collect() }
    }
}

fn column<T>(times: &Arc<[f32]>, keys: usize, value: impl FnMut(usize) -> T) -> Channel<T> {
    let values = (0..keys).map(value).collect();
    Channel { times: Arc::clone(times), values, interpolation: Interpolation::Linear }
}

/// Returns a mesh of this number of vertices, each with four bones.
pub fn mesh(bones: usize, vertices: usize) -> (Skin, Primitive) {
    let mut random = Random::new(11);
    let point = |random: &mut Random| Vec3::new(random.unit(), random.unit(), random.unit());
    let positions = (0..vertices).map(|_| point(&mut random)).collect();
    let influence = |index: usize| Influence {
        joint: ((index / 4 * 7 + index % 4) % bones) as u16,
        weight: [0.4, 0.3, 0.2, 0.1][index % 4],
    };
    let vertices = Vertices {
        positions,
        influences: (0..vertices * 4).map(influence).collect(),
        influences_per_vertex: 4,
        ..Vertices::default()
    };
    let skin = Skin {
        name: "skin".to_owned(),
        bones: (0..bones as u32).collect(),
        offsets: vec![Mat4::IDENTITY; bones],
    };
    (skin, Primitive { vertices, ..Primitive::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_have_the_number_of_keys_of_their_size() {
        assert_eq!(ModelSize::USUAL.document().keys(), 540_000);
        let ModelSize { bones, takes, keys } = ModelSize::HUGE;
        assert!((43_000_000..43_100_000).contains(&(bones * takes * keys * 3)));
    }
}
