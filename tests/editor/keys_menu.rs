//! The menu of commands for keys: all entries are seen at once in a small window, and each command is in it or in a menu of it.

use crate::timeline_rig::Animator;
use dragonfly::panels::commands::{self, Category, Id};
use egui_kittest::kittest::Queryable;

#[test]
fn the_menu_of_keys_is_not_higher_than_a_window_of_720_points() {
    let mut animator = Animator::with_bone(3);
    animator.harness.get_by_label("Keys").click();
    animator.steps(3);
    for entry in ["Select all keys", "Insert a frame", "Ruler in seconds"] {
        let rect = animator.harness.get_by_label_contains(entry).rect();
        assert!(rect.top() > 0.0 && rect.bottom() < 720.0, "{entry}: {rect}");
    }
}

#[test]
fn every_command_for_keys_is_in_the_menu_or_in_a_menu_of_it() {
    let mut animator = Animator::with_bone(3);
    animator.harness.get_by_label("Keys").click();
    animator.steps(3);
    let listed = |animator: &Animator, id: Id| {
        animator.harness.query_all_by_label_contains(commands::get(id).title).count() > 0
    };
    let all = commands::of(Category::Keys).iter().map(|command| command.id);
    // These open at the pointer what is in menus here.
    let mut left: Vec<Id> = all.filter(|id| ![Id::InterpolationMenu, Id::TangentMenu].contains(id)).collect();
    left.retain(|&id| !listed(&animator, id));
    for menu in ["Move, scale", "Interpolation", "Tangents", "Events, markers", "Play range"] {
        let at = animator.harness.get_by_label_contains(menu).rect().center();
        animator.click(at);
        animator.steps(3);
        left.retain(|&id| !listed(&animator, id));
    }
    assert!(left.is_empty(), "{left:?}");
}
