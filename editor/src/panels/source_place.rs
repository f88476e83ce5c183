//! The place of the skeleton of another model next to the open one, at about its size.

use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Skeleton, Take, Transform};
use dragonfly_anim::sample::sample_take;
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
    /// Returns the place of `source` at the left of `target`, as high, and on the same floor at the start of `take`: the rest pose of
    /// many captures hangs below the ground. `figures` returns which bones of both count; where none does, all do.
    pub(super) fn beside(
        target: &Skeleton,
        source: &Skeleton,
        take: Option<&Take>,
        figures: [&dyn Fn(usize) -> bool; 2],
    ) -> Self {
        let ([low, high], [from, to]) = (bounds(target, None, figures[0]), bounds(source, None, figures[1]));
        let height = (high - low).y;
        let ratio = height / (to - from).y;
        let scale = if ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 };
        let [from, to] = bounds(source, take, figures[1]);
        let offset = Vec3::new(
            low.x - GAP * height - scale * to.x,
            low.y - scale * from.y,
            0.5 * (low.z + high.z - scale * (from.z + to.z)),
        );
        Self { scale, offset: if offset.is_finite() { offset } else { Vec3::ZERO } }
    }
}

/// Returns the corners of the box around the joints of a skeleton at the start of a take, or at rest.
fn bounds(skeleton: &Skeleton, take: Option<&Take>, counts: &dyn Fn(usize) -> bool) -> [Vec3; 2] {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];
    sample_take(take, skeleton, take.map_or(0.0, |take| take.start), &mut poses);
    to_root(skeleton, &poses, &mut matrices);
    let any = (0..skeleton.len()).any(counts);
    let joints = matrices.iter().enumerate().filter(|(bone, _)| !any || counts(*bone));
    let mut places = joints.map(|(_, matrix)| matrix.w_axis.truncate()).filter(|place| place.is_finite());
    let first = places.next().unwrap_or(Vec3::ZERO);
    places.fold([first; 2], |[low, high], place| [low.min(place), high.max(place)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_anim::data::{Bone, Channel, Interpolation, Track};

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
        let SourcePlace { scale, offset } = SourcePlace::beside(&target, &source, None, [&all, &all]);
        let [low, high] = bounds(&source, None, &all).map(|place| scale * place + offset);
        assert!((low.y - 0.5).abs() < 1e-4 && (high.y - 2.5).abs() < 1e-4, "{low} {high}");
        // The target begins at 0; the dialog is at its right.
        assert!((high.x + GAP * 2.0).abs() < 1e-4, "{high}");
    }

    #[test]
    fn a_capture_whose_rest_pose_hangs_below_the_ground_stands_on_the_floor_in_its_take() {
        let (target, source) = (figure(2.0, 0.0), figure(2.0, -2.0));
        let all = |_: usize| true;
        let raised = Channel::new([1.0], [Vec3::new(3.0, 0.1, 0.0)], Interpolation::Linear);
        let tracks =
            vec![Track { translation: raised, ..Track::default() }, Track { bone: 1, ..Track::default() }];
        let take = Take { start: 1.0, tracks, ..Take::default() };
        let SourcePlace { scale, offset } = SourcePlace::beside(&target, &source, Some(&take), [&all, &all]);
        let [low, high] = bounds(&source, Some(&take), &all).map(|place| scale * place + offset);
        assert!(low.y.abs() < 1e-4 && (high.y - 2.0).abs() < 1e-4, "{low} {high}");
        assert!((high.x + GAP * 2.0).abs() < 1e-4, "{high}");
    }

    #[test]
    fn skeletons_without_a_height_keep_their_size() {
        let flat = figure(0.0, 0.0);
        let all = |_: usize| true;
        assert_eq!(SourcePlace::beside(&flat, &flat, None, [&all, &all]).scale, 1.0);
        let none = Skeleton { bones: Vec::new() };
        assert_eq!(SourcePlace::beside(&none, &flat, None, [&all, &all]).offset, Vec3::ZERO);
    }
}
