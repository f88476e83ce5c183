//! Daily tasks of an animator: how many actions each takes here and in Blender, and a user whose actions are counted.
//!
//! An action is a click, a drag, a chord of keys or a typed value. The numbers for Blender are from daily practice, with default
//! settings and shortcuts; `README.md` shows the table.

use crate::timeline_rig::Animator;
use dragonfly_anim::data::Take;
use dragonfly_document::View;
use dragonfly_kit::document::fixture;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use std::sync::Arc;

/// Tasks, the number of actions, and their number in Blender.
pub(crate) const TASKS: &[(&str, usize, usize)] = &[
    ("open a file by its path", 2, 3),
    ("look from the front, the right and the top", 3, 3),
    ("play, and change the take", 2, 4),
    ("find a bone by its name", 3, 3),
    ("undo, and redo", 2, 2),
    ("go back to an earlier step", 2, 3),
    ("create a take", 1, 1),
    ("choose a bone, and rotate it by a typed number", 2, 3),
    ("rotate by 30° about Z (shortcuts of Blender)", 4, 4),
    ("key the selected bone", 1, 1),
    ("choose a bone, and rotate it over the whole take", 4, 5),
    ("choose a bone, and smooth its curves", 3, 3),
    ("make a loop seamless", 3, 4),
    ("copy a pose to another take", 3, 6),
    ("copy a pose, and paste it mirrored", 2, 2),
    ("ghosts, and the motion path", 2, 7),
    ("select keys with a box, move, delete, undo", 4, 4),
    ("slow down a part, with the keys after it", 2, 4),
    ("set the play range to the selected keys", 1, 2),
    ("step interpolation of the selected keys", 2, 2),
    ("auto tangents of the selected keys", 2, 2),
    ("choose a key, and drag its tangent", 2, 2),
    ("lock the feet over a take", 3, 10),
    ("save", 1, 1),
    ("save as", 2, 2),
];

/// A user whose actions are counted.
pub(crate) struct User {
    pub(crate) animator: Animator,
    pub(crate) actions: usize,
}

/// The name of the bone that is edited, and its index.
pub(crate) const BONE: (&str, u32) = ("rib_00_left_middle", 3);

impl User {
    pub(crate) fn new() -> Self {
        Self::with(fixture::full())
    }

    pub(crate) fn with(view: View) -> Self {
        Self { animator: Animator::new(view), actions: 0 }
    }

    pub(crate) fn chord(&mut self, modifiers: Modifiers, key: Key) {
        self.actions += 1;
        self.animator.harness.key_press_modifiers(modifiers, key);
        self.animator.steps(3);
    }

    pub(crate) fn click(&mut self, label: &str) {
        self.actions += 1;
        self.animator.harness.get_by_label(label).click();
        self.animator.steps(3);
    }

    /// Clicks an entry of a menu, whose label begins with its title; a shortcut follows it.
    pub(crate) fn menu(&mut self, menu: &str, entry: &str) {
        self.click(menu);
        self.actions += 1;
        let entries = self.animator.harness.query_all_by_label_contains(entry);
        entries.last().unwrap_or_else(|| panic!("no entry {entry}")).click();
        self.animator.steps(3);
    }

    pub(crate) fn typed(&mut self, field: &str, value: &str) {
        self.actions += 1;
        self.animator.harness.get_by_label(field).click();
        self.animator.steps(2);
        self.animator.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.animator.steps(1);
        self.animator.harness.event(Event::Text(value.to_owned()));
        self.animator.steps(2);
        self.animator.harness.key_press(Key::Enter);
        self.animator.steps(3);
    }

    /// Selects the bone in the list, as a click on its skin does.
    pub(crate) fn select_bone(&mut self) {
        self.click(BONE.0);
        assert_eq!(self.animator.harness.state().state.read().selection.bones(), [BONE.1]);
    }

    pub(crate) fn take(&self, index: usize) -> Arc<Take> {
        Arc::clone(&self.animator.edited.adapter().slots()[index].result)
    }

    /// Copies, and pastes what was copied with a chord: the tests have no clipboard of a desktop.
    pub(crate) fn copy(&mut self) -> String {
        self.actions += 1;
        self.animator.harness.event(Event::Copy);
        self.animator.steps(3);
        let effects = &self.animator.harness.state().effects;
        let copied = effects.iter().rev().find_map(|effect| match effect {
            dragonfly::panels::Effect::Copy(text) => Some(text.clone()),
            _ => None,
        });
        copied.expect("something was copied")
    }

    pub(crate) fn paste(&mut self, text: String, mirrored: bool) {
        self.actions += 1;
        self.animator.request(dragonfly::panels::Request::PastePose { text, mirrored });
    }

    /// Checks that the actions since there were `from` of them are those of the task in [`TASKS`].
    #[track_caller]
    pub(crate) fn has_done(&self, task: &str, from: usize) {
        let listed = TASKS.iter().find(|(name, ..)| *name == task);
        let (_, ours, blender) = listed.unwrap_or_else(|| panic!("{task} is not in the table"));
        assert_eq!(self.actions - from, *ours, "{task}: actions, {blender} in Blender");
    }
}

#[test]
fn no_task_takes_more_actions_than_in_blender_and_the_page_shows_all() {
    let mut table = "| task | here | Blender |\n| --- | --: | --: |\n".to_owned();
    for (task, ours, blender) in TASKS {
        assert!(ours <= blender, "{task}: {ours} actions, {blender} in Blender");
        table += &format!("| {task} | {ours} | {blender} |\n");
    }
    let page = include_str!("README.md");
    assert!(
        page.contains(&format!("<!-- tasks -->\n{table}<!-- end -->\n")),
        "put this into the page:\n{table}"
    );
}

#[test]
fn every_task_of_the_table_is_done_by_a_test() {
    let tests = concat!(include_str!("tasks.rs"), include_str!("tasks_everyday.rs"));
    for (task, ..) in TASKS {
        assert!(tests.contains(&format!("has_done(\"{task}\"")), "{task}");
    }
}
