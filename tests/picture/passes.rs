//! Render passes: their order, their documentation, and the data that other threads set for them.

use dragonfly_picture::pass::{self, PassLayer};
use dragonfly_picture::{Appearance, Appearances};

#[test]
fn the_architecture_lists_the_passes_in_their_order() {
    let passes = pass::all().list;
    let names: Vec<String> = passes.iter().map(|pass| format!("`{}`", pass.borrow().name())).collect();
    let text = include_str!("../../ARCHITECTURE.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let list = format!("The passes, in order: {} (", names.join(", "));
    assert!(text.contains(&list), "ARCHITECTURE.md should contain: {list}");
}

#[test]
fn passes_of_the_scene_come_before_those_of_the_window() {
    let layers: Vec<PassLayer> = pass::all().list.iter().map(|pass| pass.borrow().layer()).collect();
    assert!(layers.is_sorted_by_key(|layer| *layer == PassLayer::Window), "{layers:?}");
}

#[derive(Clone, Debug, Default, PartialEq)]
struct First(u32);

#[derive(Clone, Debug, Default, PartialEq)]
struct Second(String);

impl Appearance for First {}

impl Appearance for Second {}

#[test]
fn setting_an_appearance_replaces_the_earlier_value_of_its_type() {
    let mut appearances = Appearances::default();
    assert_eq!(appearances.get::<First>(), None);
    appearances.set(First(1));
    appearances.set(Second("text".to_owned()));
    appearances.set(First(2));
    assert_eq!(appearances.get(), Some(&First(2)));
    assert_eq!(appearances.get(), Some(&Second("text".to_owned())));
}
