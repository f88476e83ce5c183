//! Drags in the real window: an unfinished drag is neither saved nor undone, it ends when the window loses the focus, and
//! no key and no button stays held when its release event never arrives.

use crate::screen::{key, pass};
use crate::window::{SOON, alone};
use crate::window_visit::Visit;
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_picture::gizmo::Handle;
use std::fs;
use std::time::Duration;

/// The thing that is dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    Gizmo,
    Field,
    Keys,
}

const ALL: [What; 3] = [What::Gizmo, What::Field, What::Keys];

impl What {
    /// Starts the drag, and returns in the middle of it.
    #[track_caller]
    fn begins(self, visit: &mut Visit) {
        let done: usize = visit.shown("done").parse().expect("a number");
        let (x, y) = self.place(visit);
        if self == Self::Keys {
            // The keys are close together: a drag from one that is not selected would draw a box.
            visit.screen.click(x, y);
            visit.control("Time of the key");
        }
        visit.screen.point(x, y);
        pass(visit.screen.pace);
        visit.screen.hold();
        for by in 1..12 {
            visit.screen.point(x + 3 * by, y + 2 * by * i16::from(self == Self::Gizmo));
            pass(Duration::from_millis(10));
        }
        visit.until_shown("done", &(done + 1).to_string());
    }

    fn place(self, visit: &mut Visit) -> (i16, i16) {
        let middle = |control: &serde_json::Value| {
            let at = |at: usize| control["place"][at].as_f64().expect("a place");
            ((at(0) + at(2) / 2.0) as i16, (at(1) + at(3) / 2.0) as i16)
        };
        match self {
            Self::Gizmo => {
                let ring = visit.inside().handle("b_Head_05", Handle::Ring);
                (ring.x as i16, ring.y as i16)
            }
            Self::Field => middle(&visit.control("Rotation result Z")),
            // The first key of the first listed bone: at the start of the take, where the playhead is.
            Self::Keys => {
                let track = visit.control("Time track");
                let left = track["place"][0].as_f64().expect("a place");
                (left as i16 + 16, 586)
            }
        }
    }
}

#[test]
fn during_a_drag_nothing_is_saved_or_undone() {
    let _one = alone();
    let mut visit = Visit::new("dragging-keys");
    let original = fs::read(&visit.file).unwrap();
    visit.pick_head();
    for (number, what) in ALL.into_iter().enumerate() {
        println!("{what:?}");
        what.begins(&mut visit);
        visit.screen.keep(&format!("dragging-{what:?}"));
        for letter in [key::S, key::Z, key::Q, key::O] {
            visit.control_and(letter);
        }
        // The drag continues.
        visit.screen.release_button();
        visit.until_steps(number + 1, number + 1);
        assert!(fs::read(&visit.file).unwrap() == original, "{what:?}: the middle of a drag was saved");
        let log = visit.editor.log();
        assert!(!log.contains("Saved") && !log.contains("asked what becomes"), "{what:?}: {log}");
    }
    let saved = visit.save();
    assert!(saved == visit.by_stdio(), "another file by --stdio");
    visit.end();
}

#[test]
fn closing_the_window_during_a_drag_discards_the_drag() {
    let _one = alone();
    for what in ALL {
        println!("{what:?}");
        let mut visit = Visit::new(&format!("dragging-closed-{what:?}"));
        visit.pick_head();
        // One complete edit.
        What::Field.begins(&mut visit);
        visit.screen.release_button();
        visit.go_on(0);
        what.begins(&mut visit);
        visit.screen.close(visit.editor.window);
        visit.editor.wait_for_log("asked what becomes of unsaved work", 1, SOON);
        visit.until_steps(1, 1);
        visit.screen.release_button();
        visit.screen.press(key::ENTER);
        assert_eq!(visit.editor.ends(SOON).code(), Some(0), "{}", visit.editor.log());
        let saved = fs::read(&visit.file).unwrap();
        assert!(saved == visit.by_stdio(), "{what:?}: another file by --stdio");
        let mut desk = TestDocument::new(&visit.folder.join("look"));
        let view = desk.open(&visit.file);
        let asked = visit.asked();
        assert!(asked.iter().any(|request| request["do"] == "cancel"), "{what:?}: {asked:?}");
        drop(view);
    }
}

#[test]
fn losing_the_focus_cancels_a_drag_and_leaves_nothing_held() {
    let _one = alone();
    let mut visit = Visit::new("dragging-lost");
    let original = fs::read(&visit.file).unwrap();
    visit.pick_head();
    for (number, what) in ALL.into_iter().enumerate() {
        println!("{what:?}");
        // The step that the round before this one undid can be redone after each cancelled drag.
        let undone = number.min(1);
        what.begins(&mut visit);
        visit.screen.key(key::CONTROL, true);
        pass(visit.screen.pace);
        visit.screen.leave();
        visit.until_steps(0, undone);
        // The window does not receive these releases.
        visit.screen.key(key::CONTROL, false);
        let (x, y) = what.place(&mut visit);
        visit.screen.point(x + 90, y + 40);
        pass(visit.screen.pace);
        visit.screen.focus(visit.editor.window);
        for by in 0..10 {
            visit.screen.point(x + 90 - 5 * by, y + 40 - 3 * by);
            pass(Duration::from_millis(5));
        }
        visit.screen.release_button();
        // No key is held: an arrow alone moves one frame, not one second.
        visit.screen.press(key::RIGHT);
        visit.until("one frame later", |visit| {
            let time: f32 = visit.shown("time").parse().ok()?;
            ((time - 1.0 / 24.0).abs() < 1e-3).then_some(())
        });
        visit.screen.press(key::HOME);
        visit.until_shown("time", "0.0");
        visit.until_steps(0, undone);
        // The same thing can be dragged again, as one step.
        if visit.shown("bone") != "b_Head_05" {
            visit.pick_head();
        }
        what.begins(&mut visit);
        visit.screen.release_button();
        visit.until_steps(1, 1);
        visit.control_and(key::Z);
        visit.until_steps(0, 1);
        // A cancelled drag gives back the undone step.
        visit.screen.press(key::HOME);
        what.begins(&mut visit);
        visit.screen.press(key::ESCAPE);
        visit.screen.release_button();
        visit.until_steps(0, 1);
    }
    assert!(visit.save() == original);
    visit.end();
}
