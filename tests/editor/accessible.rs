//! Screen readers can announce the entire window: every control in every panel has a name.

use crate::workbench::{Window, Workbench};
use dragonfly::panels::Request;
use dragonfly_document::{Source, View, load_model};
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};
use std::sync::Arc;

/// Returns whether a role is that of a control that the user operates.
fn is_control(role: Role) -> bool {
    matches!(
        role,
        Role::Button
            | Role::CheckBox
            | Role::ComboBox
            | Role::Link
            | Role::ListItem
            | Role::MenuItem
            | Role::RadioButton
            | Role::Slider
            | Role::SpinButton
            | Role::Switch
            | Role::Tab
            | Role::TextInput
            | Role::TreeItem
    )
}

fn nameless(window: &Window) -> Vec<String> {
    window
        .root()
        .children_recursive()
        .filter(|node| is_control(node.accesskit_node().role()))
        .filter(|node| {
            let node = node.accesskit_node();
            node.label().is_none_or(|label| label.trim().is_empty())
                && node.placeholder().is_none_or(str::is_empty)
        })
        .map(|node| format!("{:?} at {:?}", node.accesskit_node().role(), node.rect()))
        .collect()
}

fn fox() -> View {
    let source = Source::File(dragonfly_kit::folder::data("gltf/Fox.glb"));
    let loaded = load_model(&source, &mut |_| {}, &Default::default()).expect("the fox");
    View::opened(1, Arc::new(loaded))
}

#[test]
fn every_control_of_the_window_has_an_accessible_name() {
    let mut bench = Workbench::new(Some(fox()));
    bench.state.execute(Request::Select(Some(5)));
    let mut window = bench.window_of(egui::vec2(1600.0, 1000.0), egui::Theme::Dark);
    assert_eq!(nameless(&window), [""; 0]);
    window.get_by_label("Show the quaternion").click();
    for channel in ["translation", "scale"] {
        window.get_by_label(&format!("Sliders for {channel}")).click();
        window.run_steps(2);
    }
    window.run_steps(2);
    assert_eq!(nameless(&window), [""; 0]);
    window.get_by_label("Start and length").click();
    window.run_steps(3);
    assert_eq!(nameless(&window), [""; 0]);
    window.key_press(egui::Key::Escape);
    window.run_steps(2);
    window.get_by_label("History").click();
    window.run_steps(3);
    assert_eq!(nameless(&window), [""; 0]);
    window.key_press(egui::Key::F2);
    window.run_steps(3);
    assert_eq!(nameless(&window), [""; 0]);
}
