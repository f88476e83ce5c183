//! Input is handled immediately even while a driver thread reads from the same X connection: a thread that waits on the
//! connection also reads events meant for other threads, and drivers wait in threads of their own.

use crate::fixture_layer::Layer;
use crate::screen::{Screen, key, pass};
use crate::window::{Editor, SOON, alone, eventually_shows_something};
use crate::window_bone_rotation::{numbers, shown, wait_for};
use std::time::Duration;

/// Time for which the test layer reads after each frame.
const READS: Duration = Duration::from_millis(600);

#[test]
fn keys_and_close_requests_are_handled_while_a_driver_thread_reads() {
    let _one = alone();
    let layer = Layer::new("heard");
    let mut environment = layer.environment("none", 0, 0);
    environment.push(("FAULT_READS".to_owned(), READS.as_millis().to_string()));
    environment.push(("DRAGONFLY_LOG".to_owned(), "error,dragonfly=info,dragonfly::shown=debug".to_owned()));
    let environment: Vec<(&str, &str)> =
        environment.iter().map(|(name, value)| (&**name, &**value)).collect();
    let mut screen = Screen::new("heard", 1280, 800);
    let mut editor = Editor::open(&mut screen, &[], &environment);
    eventually_shows_something(&screen);
    screen.press(key::SPACE);
    screen.press(key::HOME);
    wait_for(&mut editor, &screen, "the start", |editor| shown(editor, "time").as_deref() == Some("0.0"));
    let [x, y, ..] = numbers::<4>(&shown(&mut editor, "viewport").expect("told"));
    let mut last = "0.0".to_owned();
    // Playback is paused, and only input wakes the program.
    for turn in 0..5 {
        // The pointer moves: a frame is drawn, and the thread starts to read.
        screen.point(x as i16 + 20 + turn, y as i16 + 100);
        pass(READS / 4);
        screen.press(key::RIGHT);
        wait_for(&mut editor, &screen, "the next frame", |editor| {
            let now = shown(editor, "time").expect("told");
            let moved = now != last;
            last = now;
            moved
        });
        pass(2 * READS);
    }
    screen.point(x as i16 + 20, y as i16 + 20);
    pass(READS / 4);
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}
