//! The view of the curves: how many are drawn, what fits, and the name of the bone.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{
    BoneRef, Edit, KeyInterpolation, Property, SetInterpolation, SetTangents, TakeRef,
};
use dragonfly_kit::document::fixture;
use egui::{Pos2, Rect, Shape};
use egui_kittest::kittest::Queryable;

/// Returns the vertices of what is drawn over the curves.
fn vertices(animator: &Animator) -> Vec<Pos2> {
    let curves = animator.curves();
    let mut all = Vec::new();
    for shape in &animator.harness.output().shapes {
        if shape.clip_rect.center().distance(curves.center()) < 2.0
            && let Shape::Mesh(mesh) = &shape.shape
        {
            all.extend(mesh.vertices.iter().map(|vertex| vertex.pos));
        }
    }
    all
}

/// Returns the texts that are drawn in the panel of the curves, with their rectangles.
fn texts(animator: &Animator) -> Vec<(String, Rect)> {
    // The bar and the ruler are above them.
    let (mut curves, shapes) = (animator.curves(), animator.harness.output().shapes.iter());
    curves.min.y -= 54.0;
    shapes
        .filter_map(|shape| match &shape.shape {
            Shape::Text(text) if curves.contains(text.pos) => {
                Some((text.galley.text().to_owned(), text.galley.rect.translate(text.pos.to_vec2())))
            }
            _ => None,
        })
        .collect()
}

/// Sets the interpolation of bone 3 to spline, with steep tangents at key 8.
fn overshooting() -> Animator {
    let mut animator = Animator::with_bone(3);
    let take = TakeRef::Index(0);
    let spline = Edit::SetInterpolation(SetInterpolation {
        take: take.clone(),
        bones: Vec::new(),
        properties: vec![Property::Rotation],
        interpolation: KeyInterpolation::CubicSpline,
    });
    animator.request(Request::Change(Change::Edit(spline, None)));
    let steep = vec![0.0, 0.0, 60.0, 0.0];
    let tangents = Edit::SetTangents(SetTangents {
        take,
        time: animator.key(8),
        bone: BoneRef::Index(3),
        property: Property::Rotation,
        arrive: Some(steep.clone()),
        leave: Some(steep),
    });
    animator.request(Request::Change(Change::Edit(tangents, None)));
    animator.steps(4);
    animator
}

#[test]
fn fit_shows_the_whole_curve_between_its_keys_and_the_handles_of_its_tangents() {
    let mut animator = overshooting();
    let (at, curves) = (animator.at(animator.key(8), 2), animator.curves());
    let inside = |animator: &Animator| {
        let outside = vertices(animator).into_iter().filter(|at| !curves.y_range().contains(at.y));
        outside.count()
    };
    animator.harness.get_by_label("Fit the curves").click();
    animator.steps(4);
    assert_eq!(inside(&animator), 0, "the curve between the keys");
    animator.click(at);
    assert_eq!(animator.selected(), 1);
    animator.harness.get_by_label("Fit the curves").click();
    animator.steps(4);
    let mut circles = Vec::new();
    for shape in &animator.harness.output().shapes {
        if let Shape::Circle(circle) = &shape.shape
            && curves.expand(60.0).contains(circle.center)
        {
            circles.push(circle.center);
        }
    }
    assert!(!circles.is_empty(), "there are handles");
    for center in circles {
        assert!(curves.y_range().contains(center.y), "the handle at {center} in {curves}");
    }
}

#[test]
fn the_name_of_the_bone_does_not_lie_on_the_curves() {
    let animator = Animator::with_bone(3);
    let name = texts(&animator).into_iter().find(|(text, _)| text == "rib_00_left_middle");
    let (_, rect) = name.expect("the name is drawn");
    let keys_begin = animator.x_in(animator.curves(), 0.0);
    let on_it = vertices(&animator).into_iter().filter(|at| at.x > keys_begin && rect.contains(*at)).count();
    assert_eq!(on_it, 0, "vertices of the curves in {rect}");
    assert!(!animator.curves().intersects(rect.shrink(1.0)), "{rect} is in the curves");
}

#[test]
fn more_curves_than_are_drawn_are_counted_in_the_label() {
    let skeleton = fixture::skeleton(30);
    let view = fixture::view("Many.glb", skeleton, &[("Walk", 1.0, 6)]);
    let mut animator = Animator::new(view);
    let label = |animator: &Animator, part: &str| texts(animator).into_iter().any(|(text, _)| text == part);
    let forty: Vec<u32> = (0..40).collect();
    animator.request(Request::SelectBones(forty, Choice::Replace));
    animator.steps(4);
    assert!(label(&animator, "40 bones"), "{:?}", texts(&animator));
    animator.request(Request::Command(Id::SelectAll));
    animator.steps(4);
    let count = animator.harness.state().state.read().selection.bones().len();
    assert!(label(&animator, &format!("64 of {count} bones")), "{:?}", texts(&animator));
}
