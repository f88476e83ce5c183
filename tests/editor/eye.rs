//! The eye buttons in the tree of the skeleton, and the names over the viewport.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::{self, Id};
use dragonfly_document::Change;
use dragonfly_document::edit::{Edit, RenameTake, TakeRef};
use dragonfly_kit::document::fixture;
use egui::Modifiers;
use egui_kittest::kittest::Queryable;

fn click(animator: &mut Animator, label: &str) {
    let at = animator.harness.get_by_label(label).rect().center();
    animator.click(at);
}

#[test]
fn the_eye_button_toggles_a_bone_and_with_shift_its_descendants() {
    let mut animator = Animator::new(fixture::full());
    animator.request(Request::Select(Some(2)));
    let hidden = |animator: &Animator| -> Vec<u32> {
        (0..12).filter(|&bone| animator.harness.state().state.read().hidden.is_hidden(bone)).collect()
    };
    click(&mut animator, "Hide rib_00_left_inner");
    assert_eq!(hidden(&animator), [2]);
    assert_eq!(animator.harness.state().state.read().selected(), None, "hidden bones are not selected");
    click(&mut animator, "Show rib_00_left_inner");
    assert_eq!(hidden(&animator), [0; 0]);
    assert_eq!(animator.harness.state().state.read().selected(), None, "an eye selects nothing");
    for modifiers in [Modifiers::SHIFT, Modifiers::ALT] {
        animator.hold(modifiers);
        click(&mut animator, "Hide rib_00_left_inner");
        assert_eq!(hidden(&animator), [2, 3, 4], "with the whole rib");
        click(&mut animator, "Show rib_00_left_inner");
        assert_eq!(hidden(&animator), [0; 0]);
        animator.hold(Modifiers::NONE);
    }
}

#[test]
fn a_long_take_name_is_cut_before_the_viewport_buttons() {
    let mut animator = Animator::new(fixture::full());
    let long = "walk ".repeat(60);
    let rename = Edit::RenameTake(RenameTake { take: TakeRef::Index(0), name: long.clone() });
    animator.request(Request::Change(Change::Edit(rename, None)));
    animator.steps(2);
    let viewport = animator.harness.state().state.read().viewport;
    let tools = animator.harness.query_all_by_label(commands::get(Id::ToggleSurface).title);
    let tools = tools.map(|node| node.rect()).find(|rect| viewport.contains_rect(*rect)).unwrap();
    let names: Vec<egui::Rect> = animator
        .harness
        .query_all_by_label(format!("Shown take: {long}").as_str())
        .map(|node| node.rect())
        .filter(|rect| viewport.contains_rect(*rect))
        .collect();
    let [name] = names[..] else { panic!("{names:?}") };
    assert!(name.right() < tools.left(), "{name:?} {tools:?}");
    assert!(name.width() > 100.0, "{name:?}");
}
