//! Masks: weights of the bones in a blend.

use crate::support::bone;
use dragonfly_anim::blend::{Mask, NoSuchBone};
use dragonfly_anim::data::Skeleton;
use glam::Vec3;

fn chain() -> Skeleton {
    let bone = |name: &str, parent| bone(name, parent, Vec3::Y);
    Skeleton {
        bones: vec![
            bone("hip", None),
            bone("spine", Some(0)),
            bone("leg", Some(0)),
            bone("chest", Some(1)),
            bone("head", Some(3)),
            bone("leg", Some(0)),
            bone("hat", Some(4)),
        ],
    }
}

#[test]
fn a_mask_is_made_from_a_branch_or_from_names() {
    let skeleton = chain();
    assert_eq!(Mask::of_branch(&skeleton, 1).weights(), [0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]);
    assert_eq!(Mask::of_branch(&skeleton, 7), Mask::uniform(7, 0.0));
    let named = Mask::of_names(&skeleton, ["leg", "hat"]).unwrap();
    assert_eq!(named.weights(), [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0], "all bones with the name");
    let error = Mask::of_names(&skeleton, ["hat", "wing"]).unwrap_err();
    assert_eq!(error, NoSuchBone { name: "wing".to_owned(), bones: 7 });
    assert_eq!(error.to_string(), "the mask needs a bone called \"wing\"; the skeleton (7 bones) has none");
    assert_eq!(Mask::from_weights([f32::NAN, -1.0, 0.25, 7.0]).weights(), [0.0, 0.0, 0.25, 1.0]);
}

#[test]
fn a_feathered_mask_increases_gradually() {
    let skeleton = chain();
    let mask = Mask::of_branch(&skeleton, 1).feathered(&skeleton, 2);
    assert_eq!(mask.weights(), [0.0, 1.0 / 3.0, 0.0, 2.0 / 3.0, 1.0, 0.0, 1.0]);
    assert_eq!(Mask::of_branch(&skeleton, 1).feathered(&skeleton, 0), Mask::of_branch(&skeleton, 1));
    let all = Mask::uniform(7, 1.0).feathered(&skeleton, 1);
    assert_eq!(all.weights(), [0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
    assert!(
        Mask::uniform(7, 1.0).feathered(&skeleton, usize::MAX).weights().iter().all(|weight| *weight < 1e-6)
    );
    // A mask of another length, and a parent after its child.
    assert_eq!(Mask::uniform(9, 1.0).feathered(&skeleton, 1).weights()[7..], [0.5, 0.5]);
    let mut broken = chain();
    broken.bones[1].parent = Some(6);
    assert_eq!(Mask::of_branch(&broken, 1).weights(), [0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]);
    assert_eq!(Mask::of_branch(&broken, 6).weights()[1], 0.0);
    assert_eq!(
        Mask::uniform(7, 1.0).feathered(&broken, 1).weights()[..2],
        [0.5, 0.5],
        "as if it had no parent"
    );
}

#[test]
fn masks_are_combined() {
    let (a, b) = (Mask::from_weights([0.0, 0.5, 1.0]), Mask::from_weights([1.0, 0.5]));
    assert_eq!(a.clone().times(&b).weights(), [0.0, 0.25, 0.0]);
    assert_eq!(a.clone().or(&b).weights(), [1.0, 0.5, 1.0]);
    assert_eq!(a.clone().inverted().weights(), [1.0, 0.5, 0.0]);
    let mut changed = a;
    changed.set(0, 2.0);
    changed.set(9, 1.0);
    assert_eq!((changed.weight(0), changed.weight(9)), (1.0, 0.0));
}
