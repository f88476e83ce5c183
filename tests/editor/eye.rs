//! The eye buttons in the tree of the skeleton, and the names over the viewport.

use crate::panels::Bench;
use crate::shots::{self, PictureFolder};
use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::{self, Id};
use dragonfly_document::Change;
use dragonfly_document::edit::{Edit, RenameTake, TakeRef};
use dragonfly_kit::document::fixture;
use egui::Modifiers;
use egui_kittest::kittest::{NodeT, Queryable};

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

#[test]
fn hidden_bones_long_names_and_the_menu_of_ghosts_are_drawn() {
    let Some(shots) = PictureFolder::new() else { return };
    for (name, theme) in [("dark", egui::Theme::Dark), ("light", egui::Theme::Light)] {
        let long = "Walk with a limp and look over the left shoulder now and then, third try".repeat(2);
        let view = fixture::view("Fox.glb", fixture::skeleton(9), &[(long.as_str(), 2.0, 12)]);
        let mut bench = Bench::new(Some(view));
        bench.state.execute(Request::Hide { bones: vec![3, 4], hide: true });
        bench.state.execute(Request::Select(Some(6)));
        let frame = |ui: &mut egui::Ui, bench: &mut Bench| bench.frame(ui);
        let mut harness = shots::drawn(bench, [1280.0, 720.0], 1.0, theme, frame);
        harness.run_steps(6);
        let row = harness.get_by_label("Hide rib_00_right_inner").rect();
        harness.event(egui::Event::PointerMoved(row.center()));
        harness.run_steps(20);
        shots.save(&mut harness, &format!("eyes_{name}"));
        let view = harness.get_by_label("View").rect();
        harness.event(egui::Event::PointerMoved(view.center()));
        harness.run_steps(2);
        harness.get_by_label("View").click();
        harness.run_steps(4);
        // The submenu; the button in the viewport has the same label, and is switched on or off.
        let is_menu = |node: &egui_kittest::Node<'_>| node.accesskit_node().toggled().is_none();
        harness.query_all_by_label("Ghosts").find(is_menu).expect("a submenu").click();
        harness.run_steps(6);
        shots.save(&mut harness, &format!("ghosts_menu_{name}"));
    }
}
