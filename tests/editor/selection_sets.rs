//! Selection sets: named, colored sets of bones, listed above the skeleton and remembered with the file.

use crate::timeline_rig::Animator;
use dragonfly::panels::commands::Id;
use dragonfly::panels::selection_sets::{COLORS, MOST, SetAction};
use dragonfly::panels::{Request, Settings, State};
use dragonfly_document::View;
use dragonfly_document::bones::Choice;
use dragonfly_kit::document::fixture;
use egui_kittest::kittest::Queryable;
use std::time::Instant;

fn file(title: &str) -> View {
    fixture::view(title, fixture::skeleton(3), &[("Walk", 1.0, 5)])
}

fn state() -> State {
    let mut state = State::new(Settings::default(), Instant::now());
    state.show(file("Fox.glb"));
    state
}

fn select(state: &mut State, bones: &[u32]) {
    state.execute(Request::SelectBones(bones.to_vec(), Choice::Replace));
}

fn sets(state: &State) -> Vec<(String, Vec<u32>)> {
    state.read().sets.list().iter().map(|set| (set.name.clone(), set.bones.clone())).collect()
}

fn selected(state: &State) -> Vec<u32> {
    let mut bones = state.read().selection.bones().to_vec();
    bones.sort_unstable();
    bones
}

/// Returns a state with two sets: bones 2 and 3, and bones 3 and 4.
fn two_sets() -> State {
    let mut state = state();
    for bones in [[2, 3], [3, 4]] {
        select(&mut state, &bones);
        state.execute(Request::Command(Id::SaveSelectionSet));
    }
    state
}

#[test]
fn the_selection_is_saved_as_a_set_with_a_name_and_a_color() {
    let state = two_sets();
    assert_eq!(sets(&state), [("Set 1".to_owned(), vec![2, 3]), ("Set 2".to_owned(), vec![3, 4])]);
    let colors: Vec<_> = state.read().sets.list().iter().map(|set| set.color).collect();
    assert_eq!(colors, COLORS[..2]);
}

#[test]
fn sets_are_selected_added_to_the_selection_and_removed_from_it() {
    let mut state = two_sets();
    state.execute(Request::Sets(SetAction::Select(0)));
    assert_eq!(selected(&state), [2, 3]);
    state.execute(Request::Sets(SetAction::Extend(1)));
    assert_eq!(selected(&state), [2, 3, 4]);
    state.execute(Request::Sets(SetAction::Subtract(0)));
    assert_eq!(selected(&state), [4]);
    state.execute(Request::Sets(SetAction::Select(7)));
    assert_eq!(selected(&state), [0; 0], "there is no such set");
}

#[test]
fn commands_go_through_the_sets_and_change_the_one_selected_last() {
    let mut state = two_sets();
    state.execute(Request::Command(Id::NextSelectionSet));
    assert_eq!(selected(&state), [2, 3], "after the last comes the first");
    state.execute(Request::Command(Id::PreviousSelectionSet));
    assert_eq!(selected(&state), [3, 4]);
    select(&mut state, &[1, 4]);
    state.execute(Request::Command(Id::AddToSelectionSet));
    assert_eq!(sets(&state)[1].1, [1, 3, 4]);
    state.execute(Request::Command(Id::RemoveFromSelectionSet));
    assert_eq!(sets(&state)[1].1, [3]);
    // A set without bones is none.
    select(&mut state, &[3]);
    state.execute(Request::Command(Id::RemoveFromSelectionSet));
    assert_eq!(sets(&state), [("Set 1".to_owned(), vec![2, 3])]);
}

#[test]
fn sets_are_renamed_colored_and_deleted() {
    let mut state = two_sets();
    state.execute(Request::Sets(SetAction::Rename(0, "  Left arm ".to_owned())));
    state.execute(Request::Sets(SetAction::Rename(1, "  ".to_owned())));
    state.execute(Request::Sets(SetAction::Color(1, [1, 2, 3])));
    assert_eq!(state.read().sets.list()[1].color, [1, 2, 3]);
    let names: Vec<String> = sets(&state).into_iter().map(|set| set.0).collect();
    assert_eq!(names, ["Left arm", "Set 2"], "a blank name is none");
    state.execute(Request::Sets(SetAction::Remove(0)));
    state.execute(Request::Sets(SetAction::Remove(9)));
    assert_eq!(sets(&state), [("Set 2".to_owned(), vec![3, 4])]);
    for _ in 0..MOST + 5 {
        state.execute(Request::Sets(SetAction::Save));
    }
    assert_eq!(sets(&state).len(), MOST);
}

#[test]
fn sets_are_remembered_with_their_file_by_the_names_of_bones() {
    let mut first = two_sets();
    first.execute(Request::Sets(SetAction::Rename(0, "Left".to_owned())));
    let text = first.side_files().unsaved_marks().expect("changed");
    assert!(text.contains("\"Left\"") && text.contains("rib_00_left_inner"), "{text}");
    let before = sets(&first);
    first.show(file("Crow.glb"));
    assert_eq!(sets(&first), [], "another file");
    let mut again = State::new(Settings::default(), Instant::now());
    again.side_files().read_marks(&text);
    again.show(file("Crow.glb"));
    assert_eq!(sets(&again), []);
    again.show(file("Fox.glb"));
    assert_eq!(sets(&again), before);
    assert_eq!(again.side_files().unsaved_marks(), None, "as it was read");
    again.execute(Request::Sets(SetAction::Remove(0)));
    again.execute(Request::Sets(SetAction::Remove(0)));
    let text = again.side_files().unsaved_marks().expect("changed");
    assert!(!text.contains("Fox"), "{text}");
}

#[test]
fn a_click_on_a_chip_selects_shift_adds_and_ctrl_removes() {
    let mut animator = Animator::new(fixture::full());
    for bones in [vec![2, 3], vec![5]] {
        animator.request(Request::SelectBones(bones, Choice::Replace));
        animator.request(Request::Command(Id::SaveSelectionSet));
    }
    assert!(animator.said().contains("Saved 1 bone as Set 2"), "{}", animator.said());
    let chosen = |animator: &Animator| selected(&animator.harness.state().state);
    let click = |animator: &mut Animator, name: &str, held: egui::Modifiers| {
        animator.hold(held);
        let at = animator.harness.get_by_label(name).rect().center();
        animator.click(at);
        animator.hold(egui::Modifiers::NONE);
    };
    click(&mut animator, "Selection set Set 1", egui::Modifiers::NONE);
    assert_eq!(chosen(&animator), [2, 3]);
    click(&mut animator, "Selection set Set 2", egui::Modifiers::SHIFT);
    assert_eq!(chosen(&animator), [2, 3, 5]);
    click(&mut animator, "Selection set Set 1", egui::Modifiers::COMMAND);
    assert_eq!(chosen(&animator), [5]);
}
