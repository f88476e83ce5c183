//! The place of the skeleton of another model next to the open one, at about its size.

use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::Skeleton;
use glam::{Mat4, Vec3};

/// Gap between the two skeletons, as a part of the height of the open one.
const GAP: f32 = 0.3;

/// Size and place of the other skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SourcePlace {
    /// Factor of its size.
    pub(super) scale: f32,
    /// Its distance from its place.
    pub(super) offset: Vec3,
}

impl SourcePlace {
    /// Returns the place of `source` at the left of `target`, on the same floor and as high. `figures` returns which
    /// bones of both count; where none does, all do.
    pub(super) fn beside(target: &Skeleton, source: &Skeleton, figures: [&dyn Fn(usize) -> bool; 2]) -> Self {
        let ([low, high], [from, to]) = (bounds(target, figures[0]), bounds(source, figures[1]));
        let height = (high - low).y;
        let ratio = height / (to - from).y;
        let scale = if ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 };
        let offset = Vec3::new(
            low.x - GAP * height - scale * to.x,
            low.y - scale * from.y,
            0.5 * (low.z + high.z - scale * (from.z + to.z)),
        );
        Self { scale, offset: if offset.is_finite() { offset } else { Vec3::ZERO } }
    }
}

/// Returns the corners of the box around the joints of a skeleton at rest.
fn bounds(skeleton: &Skeleton, counts: &dyn Fn(usize) -> bool) -> [Vec3; 2] {
    let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(skeleton, &[], &mut matrices);
    let any = (0..skeleton.len()).any(counts);
    let joints = matrices.iter().enumerate().filter(|(bone, _)| !any || counts(*bone));
    let mut places = joints.map(|(_, matrix)| matrix.w_axis.truncate()).filter(|place| place.is_finite());
    let first = places.next().unwrap_or(Vec3::ZERO);
    places.fold([first; 2], |[low, high], place| [low.min(place), high.max(place)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_anim::data::{Bone, Transform};

    fn figure(height: f32, low: f32) -> Skeleton {
        let bone = |name: &str, parent, translation| Bone {
            name: name.to_owned(),
            parent,
            rest: Transform { translation, ..Transform::IDENTITY },
            rest_matrix: None,
            offset: Mat4::IDENTITY,
            node: None,
        };
        let size = Vec3::new(0.5 * height, height, 0.0);
        Skeleton { bones: vec![bone("foot", None, Vec3::Y * low), bone("head", Some(0), size)] }
    }

    #[test]
    fn a_source_in_centimeters_stands_beside_the_target_on_the_same_floor_and_as_high() {
        let (target, source) = (figure(2.0, 0.5), figure(180.0, -20.0));
        let all = |_: usize| true;
        let SourcePlace { scale, offset } = SourcePlace::beside(&target, &source, [&all, &all]);
        let [low, high] = bounds(&source, &all).map(|place| scale * place + offset);
        assert!((low.y - 0.5).abs() < 1e-4 && (high.y - 2.5).abs() < 1e-4, "{low} {high}");
        // The target begins at 0; the dialog is at its right.
        assert!((high.x + GAP * 2.0).abs() < 1e-4, "{high}");
    }

    #[test]
    fn skeletons_without_a_height_keep_their_size() {
        let flat = figure(0.0, 0.0);
        let all = |_: usize| true;
        assert_eq!(SourcePlace::beside(&flat, &flat, [&all, &all]).scale, 1.0);
        let none = Skeleton { bones: Vec::new() };
        assert_eq!(SourcePlace::beside(&none, &flat, [&all, &all]).offset, Vec3::ZERO);
    }
}
