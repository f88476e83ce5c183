//! Panics in a thread of the window: the other threads continue, the user is informed, and no work is lost.

use crate::screen::{key, pass};
use crate::window::{SOON, alone, eventually_shows_something};
use crate::window_visit::Visit;
use dragonfly_picture::gizmo::Handle;
use std::time::Duration;

/// Drags the ring of the gizmo at the selected head.
fn drag_ring(visit: &mut Visit) {
    let ring = visit.inside().handle("b_Head_05", Handle::Ring);
    visit.screen.point(ring.x as i16, ring.y as i16);
    visit.screen.hold();
    for by in 1..8 {
        visit.screen.point(ring.x as i16 + 2 * by, ring.y as i16 + 3 * by);
    }
    visit.screen.release_button();
}

/// Rotates the selected head by a drag, after which `done` steps are applied.
fn turn(visit: &mut Visit, done: usize) {
    drag_ring(visit);
    visit.until_shown("done", &done.to_string());
}

/// Moves the mouse over an empty area for a while: input that may be lost.
fn stir(visit: &mut Visit) {
    for by in 0..20 {
        visit.screen.point(500 + by, 440);
        pass(Duration::from_millis(10));
    }
}

#[test]
fn a_panic_in_the_main_or_graphics_thread_loses_no_work_and_the_window_continues() {
    let _one = alone();
    for (place, object) in [
        ("panels", "Interface in thread main failed"),
        ("input", "Handling input failed in the main thread"),
        ("message", "Graphics in thread graphics failed"),
        ("frame", "Graphics in thread graphics failed"),
    ] {
        println!("{place}");
        let mut visit = Visit::with(&format!("mistake-{place}"), &["--fail", &format!("{place}:2:2")]);
        visit.pick_head();
        turn(&mut visit, 1);
        visit.go_on(1);
        turn(&mut visit, 2);
        stir(&mut visit);
        // A message is shown.
        let told = format!("{object}: injected fault. Nothing that you did is lost");
        visit.until("it is told", |visit| {
            let lines = visit.editor.lines.iter().filter(|line| line.contains(&told));
            (lines.count() >= 2).then_some(())
        });
        visit.control(&format!("Messages: {told}"));
        eventually_shows_something(&visit.screen);
        // The window keeps working.
        visit.go_on(1);
        turn(&mut visit, 3);
        visit.control_and(key::Z);
        visit.until_steps(2, 3);
        visit.control_and(key::Y);
        visit.until_steps(3, 3);
        visit.screen.keep(&format!("mistake-{place}"));
        let saved = visit.save();
        assert!(saved == visit.by_stdio(), "{place}: another file by --stdio");
        visit.end();
    }
}

#[test]
fn repeated_panics_end_the_program_cleanly_and_the_next_start_restores_the_work() {
    let _one = alone();
    for place in ["panels", "input", "message", "frame"] {
        println!("{place}");
        let mut visit = Visit::with(&format!("mistakes-{place}"), &["--fail", &format!("{place}:1:9")]);
        visit.pick_head();
        drag_ring(&mut visit);
        stir(&mut visit);
        let status = visit.editor.ends(SOON);
        let log = visit.editor.log();
        assert_eq!(status.code(), Some(3), "{place}: {status}\n{log}");
        assert!(log.contains("internal error, a bug of the program: "), "{place}: {log}");
        assert!(log.contains("Your work is recorded"), "{place}: {log}");
        visit.again(None);
        visit.editor.wait_for_log("offered unsaved work", 1, SOON);
        visit.screen.press(key::ENTER);
        visit.editor.wait_for_log("Restored the unsaved work of Fox.glb: 1 step", 1, SOON);
        visit.go_to_the_start();
        visit.save();
        visit.end();
    }
}
