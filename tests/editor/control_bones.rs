//! Bones are selected by click, by region, by neighborhood and by side.

use crate::gizmo_rig::Rig;
use dragonfly::control::Modifiers;
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_document::bones::{BoneSelection, Choice, HiddenBones, MirrorPairs};
use dragonfly_kit::random::{Random, seed};
use dragonfly_picture::pick::ClickCycle;
use dragonfly_picture::pick::{Lasso, Region, bones_in_region};
use glam::{Vec2, Vec3};
use std::collections::BTreeSet;

#[test]
fn repeated_clicks_at_one_position_cycle_through_the_bones_under_the_pointer() {
    let mut cycle = ClickCycle::default();
    let at = Vec2::new(100.0, 100.0);
    let hits = [7, 3, 5];
    let chosen: Vec<_> = (0..5).map(|_| cycle.click(at, &hits).unwrap()).collect();
    assert_eq!(chosen, [7, 3, 5, 7, 3]);
    assert_eq!(
        cycle.click(at + Vec2::new(3.9, 0.0), &hits),
        Some(5),
        "within four points it is the same place"
    );
    assert_eq!(cycle.click(at + Vec2::new(4.1, 0.0), &hits), Some(7), "further away it is another");
    // Positions are compared with that of the first click, so small movements add up.
    let mut cycle = ClickCycle::default();
    let creeping: Vec<_> =
        (0..4).map(|step| cycle.click(at + Vec2::X * (2 * step) as f32, &[7, 3, 5, 9]).unwrap()).collect();
    assert_eq!(creeping, [7, 3, 5, 7]);
    // The pose changed between the clicks: the hits are in another order, or the chosen bone is no longer hit.
    let mut cycle = ClickCycle::default();
    cycle.click(at, &hits);
    assert_eq!(cycle.click(at, &[3, 7, 5]), Some(5), "the bone behind the chosen one");
    assert_eq!(cycle.click(at, &[1, 2]), Some(1));
    assert_eq!(cycle.click(at, &[]), None);
    assert_eq!(cycle.click(at, &[1, 2]), Some(1), "after a miss the cycle starts again");
    assert_eq!(cycle.click(at, &[1]), Some(1));
    cycle.forget();
    assert_eq!(cycle.click(at, &[1, 2]), Some(1));
}

#[test]
fn a_bone_is_in_a_region_if_its_joint_or_midpoint_is() {
    let shapes = [
        (0, Vec3::ZERO, Vec3::X * 10.0),
        (1, Vec3::X * 10.0, Vec3::X * 20.0),
        (2, Vec3::X * 20.0, Vec3::X * 21.0),
        (2, Vec3::X * 20.0, Vec3::new(20.0, 40.0, 0.0)),
        (3, Vec3::new(0.0, 0.0, -1.0), Vec3::new(9.0, 0.0, -1.0)),
    ];
    let to_screen = |place: Vec3| (place.z >= 0.0).then_some(place.truncate());
    let inside = |region: Region<'_>| {
        let mut out = vec![99];
        bones_in_region(&region, shapes.into_iter(), to_screen, &mut out);
        out
    };
    assert_eq!(inside(Region::Box(Vec2::new(4.0, -1.0), Vec2::new(11.0, 1.0))), [0, 1], "middle, joint");
    assert_eq!(inside(Region::Box(Vec2::new(11.0, 1.0), Vec2::new(4.0, -1.0))), [0, 1], "any two corners");
    assert_eq!(inside(Region::Box(Vec2::new(6.0, -1.0), Vec2::new(9.0, 1.0))), [0_u32; 0], "only touched");
    assert_eq!(inside(Region::Box(Vec2::new(19.0, 10.0), Vec2::new(25.0, 30.0))), [2], "one of its shapes");
    assert_eq!(
        inside(Region::Box(Vec2::splat(-100.0), Vec2::splat(100.0))),
        [0, 1, 2],
        "not behind the camera"
    );
    let line = [Vec2::new(-5.0, -5.0), Vec2::new(6.0, -5.0), Vec2::new(6.0, 5.0), Vec2::new(-5.0, 5.0)];
    assert_eq!(inside(Region::Lasso(&line)), [0]);
    assert_eq!(inside(Region::Lasso(&[])), [0_u32; 0]);
    assert_eq!(inside(Region::Lasso(&line[..2])), [0_u32; 0]);
}

#[test]
fn a_lasso_contains_what_it_encloses_and_has_at_most_2048_points() {
    let mut lasso = Lasso::default();
    lasso.begin(Vec2::new(200.0, 100.0));
    for step in 0..100_000 {
        let angle = step as f32 / 100_000.0 * std::f32::consts::TAU;
        lasso.push(Vec2::splat(100.0) + Vec2::from_angle(angle) * 100.0);
        lasso.push(Vec2::NAN);
    }
    let Region::Lasso(line) = lasso.region() else { panic!() };
    assert!((100..400).contains(&line.len()), "{}", line.len());
    for (point, inside) in [((100.0, 100.0), true), ((20.0, 100.0), true), ((10.0, 10.0), false)] {
        assert_eq!(lasso.region().holds(Vec2::new(point.0, point.1)), inside, "{point:?}");
    }
    for step in 0..100_000 {
        lasso.push(Vec2::new((step % 700) as f32 * 3.0, step as f32));
    }
    let Region::Lasso(line) = lasso.region() else { panic!() };
    assert!(line.len() <= 2048);
    // A point that the line winds around twice is inside too.
    let twice: Vec<Vec2> = [0.0, 2.1, 4.2, 6.3, 8.4, 10.5].map(|angle| Vec2::from_angle(angle) * 10.0).into();
    assert!(Region::Lasso(&twice).holds(Vec2::ZERO));
}

/// 0 – (1 – (2 – 3), 4 – 5), 6 a root of its own.
fn tree() -> Skeleton {
    let parents = [None, Some(0), Some(1), Some(2), Some(1), Some(4), None];
    Rig::of(&parents, vec![Transform::IDENTITY; 7]).skeleton
}

fn select(bones: &[u32]) -> BoneSelection {
    let mut selection = BoneSelection::new(7);
    selection.choose(bones, Choice::Replace);
    selection
}

#[test]
fn a_click_with_shift_adds_a_bone_and_with_ctrl_toggles_it() {
    let mut selection = select(&[]);
    let none = Modifiers::default();
    selection.click(Some(3), Choice::from(none));
    selection.click(Some(1), Choice::from(Modifiers { shift: true, ..none }));
    assert_eq!((selection.bones(), selection.active()), (&[3, 1][..], Some(1)));
    selection.click(Some(3), Choice::from(Modifiers { shift: true, ..none }));
    assert_eq!(selection.bones(), [1, 3], "it becomes the active one");
    let ctrl = Choice::from(Modifiers { ctrl: true, ..none });
    selection.click(Some(1), ctrl);
    assert_eq!(selection.bones(), [3]);
    selection.click(Some(1), ctrl);
    assert_eq!(selection.bones(), [3, 1]);
    selection.click(None, Choice::Add);
    assert_eq!(selection.bones(), [3, 1], "beside all bones, Shift leaves what is there");
    selection.click(None, Choice::Replace);
    assert_eq!(selection.bones(), [0_u32; 0]);
    selection.choose(&[1, 2, 2, 99], Choice::Add);
    selection.choose(&[2, 2, 4], Choice::Toggle);
    assert!(selection.contains(1) && selection.contains(4) && !selection.contains(99));
    let list: BTreeSet<_> = selection.bones().iter().collect();
    assert_eq!(list.len(), selection.bones().len(), "each once");
}

#[test]
fn selecting_parents_children_and_descendants_skips_hidden_bones() {
    let (tree, mut hidden) = (tree(), HiddenBones::default());
    let after = |bones: &[u32], hidden: &HiddenBones, act: &dyn Fn(&mut BoneSelection, &HiddenBones)| {
        let mut selection = select(bones);
        act(&mut selection, hidden);
        selection.bones().to_vec()
    };
    let parents = |s: &mut BoneSelection, h: &HiddenBones| s.parents(&tree, h, false);
    let with_parents = |s: &mut BoneSelection, h: &HiddenBones| s.parents(&tree, h, true);
    let children = |s: &mut BoneSelection, h: &HiddenBones| s.children(&tree, h, false);
    let descendants = |s: &mut BoneSelection, h: &HiddenBones| s.descendants(&tree, h);
    assert_eq!(after(&[3], &hidden, &parents), [2]);
    assert_eq!(after(&[3, 5], &hidden, &parents), [2, 4]);
    assert_eq!(after(&[2, 4], &hidden, &parents), [1]);
    assert_eq!(after(&[0, 6], &hidden, &parents), [0, 6], "roots stay");
    assert_eq!(after(&[3], &hidden, &with_parents), [3, 2]);
    assert_eq!(after(&[1], &hidden, &children), [2, 4]);
    assert_eq!(after(&[1, 3], &hidden, &children), [3, 2, 4], "ends stay");
    assert_eq!(after(&[1, 2], &hidden, &children), [2, 3, 4], "a child that was selected, too");
    assert_eq!(after(&[1], &hidden, &descendants), [1, 2, 3, 4, 5]);
    assert_eq!(after(&[6], &hidden, &descendants), [6]);
    hidden.hide(&mut select(&[2]));
    assert_eq!(after(&[3], &hidden, &parents), [1]);
    assert_eq!(after(&[1], &hidden, &children), [3, 4]);
    assert_eq!(after(&[1], &hidden, &descendants), [1, 3, 4, 5]);
    assert_eq!(after(&[3], &hidden, &|s, h| s.grow(&tree, h)), [3, 1]);
    assert_eq!(after(&[3], &hidden, &|s, h| s.invert(h)), [0, 1, 4, 5, 6]);
    assert_eq!(after(&[3, 1], &hidden, &|s, h| s.all(h)), [0, 3, 4, 5, 6, 1], "the active one stays that");
}

#[test]
fn growing_adds_adjacent_bones_and_shrinking_again_keeps_the_original_ones() {
    let (tree, hidden) = (tree(), HiddenBones::default());
    let mut selection = select(&[2]);
    selection.grow(&tree, &hidden);
    assert_eq!(BTreeSet::from_iter(selection.bones().iter().copied()), BTreeSet::from([1, 2, 3]));
    selection.shrink(&tree, &hidden);
    assert_eq!(BTreeSet::from_iter(selection.bones().iter().copied()), BTreeSet::from([2, 3]));
    let seed = seed(61);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    for _ in 0..1_000 {
        let chosen: Vec<u32> = (0..7).filter(|_| random.below(2) == 0).collect();
        let mut hidden = HiddenBones::default();
        hidden.hide(&mut select(&(0..7).filter(|_| random.below(5) == 0).collect::<Vec<_>>()));
        let mut selection = select(&chosen);
        selection.retain_shown(&hidden);
        let before = selection.clone();
        selection.grow(&tree, &hidden);
        assert!(before.bones().iter().all(|&bone| selection.contains(bone)));
        assert!(selection.bones().iter().all(|&bone| !hidden.is_hidden(bone)));
        selection.shrink(&tree, &hidden);
        assert!(before.bones().iter().all(|&bone| selection.contains(bone)), "nothing is lost by both");
        selection = before.clone();
        selection.invert(&hidden);
        selection.invert(&hidden);
        let set = |of: &BoneSelection| BTreeSet::from_iter(of.bones().iter().copied());
        assert_eq!(set(&selection), set(&before), "twice inverted is as before");
    }
}

#[test]
fn hiding_bones_deselects_them_and_showing_bones_selects_them() {
    let mut hidden = HiddenBones::default();
    let mut selection = select(&[2, 3]);
    hidden.hide(&mut selection);
    assert_eq!(selection.bones(), [0_u32; 0]);
    assert!(hidden.is_hidden(2) && !hidden.is_hidden(4) && !hidden.is_hidden(99));
    let mut hits = vec![1, 2, 3, 4];
    hidden.retain_shown(&mut hits);
    assert_eq!(hits, [1, 4]);
    selection.click(Some(4), Choice::Replace);
    hidden.show_all(&mut selection);
    assert_eq!(selection.bones(), [2, 3]);
    assert!(hidden.is_empty());
    hidden.show_all(&mut selection);
    assert_eq!(selection.bones(), [2, 3], "nothing was hidden: nothing changes");
    hidden.hide_others(&selection);
    assert_eq!((0..7).filter(|&bone| !hidden.is_hidden(bone)).collect::<Vec<_>>(), [2, 3]);
}

#[test]
fn mirroring_the_selection_selects_the_other_side_and_keeps_center_bones() {
    let names = ["Hips", "Arm.L", "Arm.R", "Leg.L", "Leg.R", "Tail", "Horn.L"];
    let pairs = MirrorPairs::of_names(&names);
    let hidden = HiddenBones::default();
    let mut selection = select(&[0, 3, 1]);
    selection.mirror(&pairs, &hidden, false);
    assert_eq!(selection.bones(), [0, 4, 2], "the active one leads to the active one");
    selection.mirror(&pairs, &hidden, true);
    assert_eq!(selection.bones(), [0, 4, 2, 3, 1]);
    let mut selection = select(&[6]);
    selection.mirror(&pairs, &hidden, false);
    assert_eq!(selection.bones(), [6]);
}
