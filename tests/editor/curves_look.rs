//! How curves are shown: normalized, one under the pointer, colors of bones, steps of values.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::curves::look::CurvesLook;
use dragonfly::panels::theme::{DARK, LIGHT};
use egui::{Color32, Modifiers, Pos2, Shape, pos2, vec2};
use egui_kittest::kittest::Queryable;
use glam::EulerRot;

/// Returns the angles of a key of bone 3, degrees.
fn angles(animator: &Animator, key: usize) -> [f32; 3] {
    let rotation = animator.edited.adapter().slots()[0].result.tracks[3].rotation.value(key).unwrap();
    let (x, y, z) = rotation.to_euler(EulerRot::XYZ);
    [x, y, z].map(f32::to_degrees)
}

fn looking(bone: u32, look: CurvesLook) -> Animator {
    let mut animator = Animator::with_bone(bone);
    animator.request(Request::CurvesLook(look));
    animator.steps(3);
    animator
}

/// Returns the position of the z curve at a key in a normalized view.
fn normalized_place(animator: &Animator, key: usize) -> Pos2 {
    let curves = animator.curves();
    let all: Vec<f32> = (0..41).map(|key| angles(animator, key)[2]).collect();
    let (low, high) =
        all.iter().fold((f32::MAX, f32::MIN), |(low, high), &one| (low.min(one), high.max(one)));
    let part = ((all[key] - low) / (high - low) * 2.0 - 1.0 + 1.16) / 2.32;
    pos2(animator.x_in(curves, animator.key(key)), curves.bottom() - part * curves.height())
}

#[test]
fn a_normalized_curve_fills_the_height_and_its_key_stays_under_the_pointer_with_true_values() {
    let mut animator = looking(3, CurvesLook { normalized: true, ..CurvesLook::default() });
    for component in ["Component X", "Component Y"] {
        animator.harness.get_by_label(component).click();
        animator.steps(2);
    }
    let all: Vec<f32> = (0..41).map(|key| angles(&animator, key)[2]).collect();
    let span = all.iter().copied().fold(f32::MIN, f32::max) - all.iter().copied().fold(f32::MAX, f32::min);
    let (at, height) = (normalized_place(&animator, 8), animator.curves().height());
    animator.drag(at, at - vec2(0.0, 40.0));
    let wanted = all[8] + 40.0 / height * 2.32 / 2.0 * span;
    assert!((angles(&animator, 8)[2] - wanted).abs() < 0.05 * span, "{} {wanted}", angles(&animator, 8)[2]);
    animator.release(at - vec2(0.0, 40.0));
    assert_eq!(animator.selected(), 1, "the key was under the pointer");
    assert_eq!(animator.edited.steps().0.len(), 1);
}

#[test]
fn a_dragged_key_goes_to_multiples_of_the_step_and_ctrl_moves_it_freely() {
    for ctrl in [false, true] {
        let mut animator = looking(3, CurvesLook { value_step: 5.0, ..CurvesLook::default() });
        for component in ["Component X", "Component Y"] {
            animator.harness.get_by_label(component).click();
            animator.steps(2);
        }
        animator.request(Request::CurvesLook(CurvesLook { value_step: 5.0, normalized: true, solo: false }));
        animator.steps(2);
        let (before, at) = (angles(&animator, 8)[2], normalized_place(&animator, 8));
        if ctrl {
            animator.hold(Modifiers::COMMAND);
        }
        animator.drag(at, at - vec2(0.0, 43.0));
        animator.release(at - vec2(0.0, 43.0));
        let after = angles(&animator, 8)[2];
        assert!((after - before).abs() > 1.0, "{before} → {after}");
        let off = (after / 5.0 - (after / 5.0).round()).abs() * 5.0;
        assert_eq!(off < 0.01, !ctrl, "{after} with Ctrl: {ctrl}");
    }
}

/// Returns the colors of what is drawn over the curves.
fn colors(animator: &Animator) -> Vec<Color32> {
    let curves = animator.curves();
    let mut all = Vec::new();
    for shape in &animator.harness.output().shapes {
        if shape.clip_rect.center().distance(curves.center()) < 2.0
            && let Shape::Mesh(mesh) = &shape.shape
        {
            all.extend(mesh.vertices.iter().map(|vertex| vertex.color));
        }
    }
    all
}

#[test]
fn the_curve_under_the_pointer_is_drawn_strongly_and_all_others_faintly() {
    let mut animator = looking(3, CurvesLook { solo: true, ..CurvesLook::default() });
    let strong = |animator: &Animator, axis: usize| colors(animator).contains(&DARK.axes[axis]);
    assert!((0..3).all(|axis| strong(&animator, axis)), "without a pointer all are strong");
    let values: Vec<f32> = (0..41).map(|key| angles(&animator, key)[2]).collect();
    let (low, high) = values.iter().fold((0.0_f32, 0.0_f32), |(low, high), &z| (low.min(z), high.max(z)));
    let (middle, span) = ((low + high) / 2.0, (high - low) * 1.16);
    let crest = (0..41).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap();
    let curves = animator.curves();
    let part = (values[crest] - (middle - span / 2.0)) / span;
    let at = pos2(animator.x_in(curves, animator.key(crest)), curves.bottom() - part * curves.height());
    animator.move_to(at);
    animator.steps(3);
    assert_eq!([0, 1, 2].map(|axis| strong(&animator, axis)), [false, false, true]);
    animator.request(Request::Command(Id::SoloCurves));
    animator.move_to(at + vec2(0.5, 0.0));
    animator.steps(2);
    assert!((0..3).all(|axis| strong(&animator, axis)));
}

#[test]
fn the_curves_of_several_bones_have_the_colors_of_their_bones() {
    let mut animator = Animator::with_bone(3);
    assert!(!colors(&animator).contains(&DARK.bone_hue(0, 2)));
    animator.request(Request::SelectBones(vec![3, 4], dragonfly_document::bones::Choice::Replace));
    animator.steps(3);
    for bone in 0..2 {
        assert!(colors(&animator).contains(&DARK.bone_hue(bone, 2)), "bone {bone}");
    }
    assert!(!colors(&animator).contains(&DARK.axes[2]));
}

/// Returns the linear light of a color.
fn light(color: Color32) -> [f64; 3] {
    [color.r(), color.g(), color.b()].map(|part| {
        let part = f64::from(part) / 255.0;
        if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
    })
}

fn times(matrix: [[f64; 3]; 3], light: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row.iter().zip(light).map(|(a, b)| a * b).sum())
}

/// Returns the contrast of two colors as WCAG 2 defines it.
fn contrast(a: Color32, b: Color32) -> f64 {
    let [a, b] = [a, b].map(|color| times([[0.2126, 0.7152, 0.0722]; 3], light(color))[0] + 0.05);
    a.max(b) / a.min(b)
}

/// Returns a color in Oklab (Ottosson 2020).
fn oklab(light: [f64; 3]) -> [f64; 3] {
    let cones = times(
        [
            [0.4122214708, 0.5363325363, 0.0514459929],
            [0.2119034982, 0.6806995451, 0.1073969566],
            [0.0883024619, 0.2817188376, 0.6299787005],
        ],
        light,
    );
    times(
        [
            [0.2104542553, 0.7936177850, -0.0040720468],
            [1.9779984951, -2.4285922050, 0.4505937099],
            [0.0259040371, 0.7827717662, -0.8086757660],
        ],
        cones.map(f64::cbrt),
    )
}

#[test]
fn the_colors_of_bones_are_legible_and_distinct_for_color_blind_users() {
    // Full deficiencies by Machado, Oliveira and Fernandes 2009.
    let senses = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
    ];
    for theme in [DARK, LIGHT] {
        for bone in 0..6 {
            for component in 0..3 {
                let found = contrast(theme.bone_hue(bone, component), theme.sunken);
                assert!(found >= 3.0, "bone {bone}, component {component}: {found}");
            }
            for (other, sense) in (0..bone).flat_map(|other| senses.map(|sense| (other, sense))) {
                let [a, b] = [bone, other].map(|bone| {
                    let seen = times(sense, light(theme.bone_hue(bone, 1)));
                    oklab(seen.map(|part| part.clamp(0.0, 1.0)))
                });
                let apart = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                assert!(apart >= 0.06, "bones {other} and {bone} in a theme of {}: {apart}", theme.dark);
            }
        }
        assert!(contrast(theme.weak, theme.sunken) >= 4.5, "the text of the empty panel");
    }
}

#[test]
fn outside_its_keys_a_curve_is_dashed() {
    let animator = Animator::with_bone(3);
    let (curves, last) = (animator.curves(), animator.x_in(animator.curves(), animator.key(40)));
    let mut columns = std::collections::BTreeSet::new();
    for shape in &animator.harness.output().shapes {
        if shape.clip_rect.center().distance(curves.center()) < 2.0
            && let Shape::Mesh(mesh) = &shape.shape
        {
            let after = mesh.vertices.iter().filter(|vertex| vertex.pos.x > last + 8.0);
            columns.extend(after.map(|vertex| vertex.pos.x.round() as i32));
        }
    }
    let columns: Vec<i32> = columns.into_iter().collect();
    assert!(columns.len() >= 3, "{columns:?}");
    assert!(columns.windows(2).all(|pair| pair[1] - pair[0] <= 5), "dashes of 4 points: {columns:?}");
}
