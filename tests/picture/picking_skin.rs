//! A click on the skin picks the bone with the most influence there, in the animated pose.

use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::hit::{HitPose, HitTree};
use dragonfly_document::bones::{BoneSelection, Choice, HiddenBones};
use dragonfly_kit::document::arm;
use dragonfly_picture::camera::CameraRay;
use dragonfly_picture::pick::{SkinHit, pick_skin};
use glam::Vec3;
use std::sync::Arc;

struct Skin {
    evaluator: Evaluator,
    pose: HitPose,
}

impl Skin {
    fn at(time: f32) -> Self {
        let model = Arc::clone(&arm::loaded().model);
        let tree = Arc::new(HitTree::of(&model).unwrap());
        let mut evaluator = Evaluator::new(model);
        evaluator.pose(Some(0), time);
        let mut pose = HitPose::new(tree);
        pose.refit(&evaluator);
        Self { evaluator, pose }
    }

    fn hits(&mut self, ray: &CameraRay, hidden: &HiddenBones) -> Vec<SkinHit> {
        let mut hits = Vec::new();
        pick_skin(&mut self.pose, &self.evaluator, ray, hidden, &mut hits);
        hits
    }
}

fn towards(point: Vec3) -> CameraRay {
    CameraRay { origin: point + Vec3::Z * 10.0, direction: -Vec3::Z }
}

#[test]
fn a_click_on_the_deformed_skin_picks_the_bone_with_most_influence() {
    let mut skin = Skin::at(0.0);
    let none = HiddenBones::default();
    // Weights change from one bone to the next between 0.5 and 1.5, and 1.5 and 2.5.
    for (height, bone) in [(0.2, 0), (0.8, 0), (1.2, 1), (1.8, 1), (2.8, 2)] {
        let hits = skin.hits(&towards(Vec3::Y * height + Vec3::X * 0.1), &none);
        assert_eq!(hits.first().map(|hit| hit.bone), Some(bone), "{height}");
        assert!((hits[0].position.y - height).abs() < 1e-4);
        assert!((hits[0].distance - 9.77).abs() < 0.05, "{}", hits[0].distance);
    }
    assert!(skin.hits(&towards(Vec3::X * 3.0), &none).is_empty());
    // The tip is at another place in the bent pose.
    let tip = |skin: &Skin| skin.evaluator.to_root()[2].transform_point3(Vec3::Y * 0.8);
    let mut bent = Skin::at(arm::LENGTH);
    assert!(tip(&bent).distance(tip(&skin)) > 0.5);
    let hits = bent.hits(&towards(tip(&bent)), &none);
    assert_eq!(hits.first().map(|hit| hit.bone), Some(2));
}

#[test]
fn a_ray_hits_the_front_and_then_the_back_of_the_skin_and_skips_hidden_bones() {
    let mut skin = Skin::at(0.0);
    // The ray enters at the tip and leaves at the other side near the root.
    let (enter, leave) = (Vec3::new(0.25, 2.8, 0.05), Vec3::new(-0.25, 0.2, 0.05));
    let direction = (leave - enter).normalize();
    let ray = CameraRay { origin: enter - direction * 3.0, direction };
    let hits = skin.hits(&ray, &HiddenBones::default());
    let bones: Vec<u32> = hits.iter().map(|hit| hit.bone).collect();
    assert_eq!(bones, [2, 0], "{hits:?}");
    assert!(hits.is_sorted_by(|a, b| a.distance < b.distance), "{hits:?}");
    let mut hidden = HiddenBones::default();
    let mut selection = BoneSelection::new(arm::BONES);
    selection.click(Some(bones[0]), Choice::Replace);
    hidden.hide(&mut selection);
    let seen: Vec<u32> = skin.hits(&ray, &hidden).iter().map(|hit| hit.bone).collect();
    assert_eq!(seen, bones[1..]);
}

#[test]
fn an_invalid_ray_hits_nothing() {
    let mut skin = Skin::at(0.0);
    for (origin, direction) in
        [(Vec3::NAN, Vec3::Z), (Vec3::ZERO, Vec3::ZERO), (Vec3::ZERO, Vec3::NAN), (Vec3::INFINITY, Vec3::Z)]
    {
        assert!(skin.hits(&CameraRay { origin, direction }, &HiddenBones::default()).is_empty());
    }
    // A ray from the inside, and one from far away where floats are coarse: the search ends for
    // both.
    skin.hits(&CameraRay { origin: Vec3::Y, direction: Vec3::Y }, &HiddenBones::default());
    skin.hits(&CameraRay { origin: Vec3::new(0.0, 1.0, 1e8), direction: -Vec3::Z }, &HiddenBones::default());
}
