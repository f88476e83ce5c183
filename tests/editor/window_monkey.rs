//! Random input does no harm: the window reacts, nothing is lost, everything can be undone.

use crate::screen::{key, pass};
use crate::window::{SOON, alone};
use crate::window_visit::Visit;
use dragonfly_document::Change;
use dragonfly_kit::document::test_document::{TestDocument, same_takes};
use dragonfly_kit::random::{Random, seed};
use rustix::process::{Pid, Signal, kill_process};
use std::os::unix::process::ExitStatusExt;
use std::time::{Duration, Instant};

/// Keys that are pressed: all that type a character, and those that move, end and delete.
fn keys() -> Vec<u8> {
    let signs = "1234567890-=qwertyuiopasdfghjklzxcvbnm,./".chars().map(key::of);
    // Tab, Enter, Space, Backspace, the arrows and their neighbors, Delete; function keys except those that find commands (a
    // random one may be Quit) and that toggle full screen.
    let others = [23, 36, 65, 22, 111, 113, 114, 116, 110, 115, 112, 117, 119, 67, 68, 70, 71, 72, 73];
    signs.chain(others).collect()
}

/// Returns whether Ctrl with this key opens another file, saves, quits, or opens the command search.
fn leads_away(key: u8) -> bool {
    "oqsp".chars().any(|sign| key::of(sign) == key)
}

#[test]
fn two_thousand_random_inputs_lose_nothing() {
    let _one = alone();
    let seed = seed(11);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let mut visit = Visit::new("monkey");
    visit.pick_head();
    let keys = keys();
    let pause = visit.screen.pace;
    visit.screen.pace = Duration::from_millis(6);
    let began = Instant::now();
    for round in 0..2000 {
        // Positions are below the menus.
        let mut place = || [random.below(1280) as i16, 40 + random.below(760) as i16];
        let [mut from, to] = [place(), place()];
        match random.below(8) {
            0..3 => {
                let held = [key::CONTROL, key::SHIFT, key::ALT].into_iter().filter(|_| random.below(5) == 0);
                let held: Vec<u8> = held.collect();
                let key = random.choice(&keys);
                if held.contains(&key::CONTROL) && leads_away(key) {
                    continue;
                }
                held.iter().for_each(|&held| visit.screen.key(held, true));
                visit.screen.press(key);
                held.iter().for_each(|&held| visit.screen.key(held, false));
            }
            3 => {
                visit.screen.point(from[0], from[1]);
                let button = random.choice(&[1, 1, 1, 2, 3, 4, 5]);
                visit.screen.button(button, true);
                visit.screen.button(button, false);
            }
            4..6 => {
                // Positions of drags: mostly in the viewport and among the number fields of the bone.
                match random.below(3) {
                    0 => from = [540 + random.below(200) as i16, 200 + random.below(200) as i16],
                    1 => from = [1040 + random.below(220) as i16, 60 + random.below(400) as i16],
                    _ => {}
                }
                visit.screen.point(from[0], from[1]);
                let button = random.choice(&[1, 1, 1, 2, 3]);
                visit.screen.button(button, true);
                for part in 1..=4 {
                    let way = |axis: usize| from[axis] + (to[axis] - from[axis]) / 40 * part;
                    visit.screen.point(way(0), way(1));
                    // Longer than drawing a frame takes; otherwise the window never sees the drag.
                    pass(Duration::from_millis(5));
                }
                visit.screen.button(button, false);
            }
            _ => visit.screen.point(from[0], from[1]),
        }
        if round % 20 == 0 {
            visit.screen.press(key::ESCAPE);
            // In the viewport, where a click probably hits the fox.
            let near = |random: &mut Random| random.below(200) as i16;
            let (x, y) = (540 + near(&mut random), 200 + near(&mut random));
            visit.screen.click(x, y);
        }
    }
    println!("the actions took {:?}", began.elapsed());
    visit.screen.pace = pause;
    (0..4).for_each(|_| visit.screen.press(key::ESCAPE));

    // The window reacts, and it saves the same bytes that `--stdio` writes for the same requests.
    let saved = visit.save();
    let asked = visit.asked();
    println!("{} changes were asked for", asked.len());
    // A loaded machine draws few frames, and the window then sees few of the drags.
    assert!(asked.len() > 5);
    assert!(saved == visit.by_stdio(), "another file by --stdio");
    visit.editor.kill();

    // The journal opens, and undoing all of it gives the takes of the file.
    let mut fresh = TestDocument::new(&visit.folder.join("fresh"));
    let original = fresh.open(&dragonfly_kit::folder::data("gltf/Fox.glb"));
    let mut desk = TestDocument::new(&visit.folder.join("autosave"));
    let view = desk.open(&visit.file);
    println!("{} of {} steps are done", view.history.done, view.history.steps.len());
    let steps = view.history.steps.len();
    assert!(steps > 0);
    // The random input may have undone all of it.
    desk.change(Change::GoTo(steps));
    let last = desk.wait_for_view(|view| view.history.done == steps);
    desk.change(Change::GoTo(0));
    let first = desk.wait_for_view(|view| view.history.done == 0);
    same_takes(&original, &first);
    assert!(!first.takes.iter().eq(last.takes.iter()), "nothing was changed");
    println!("all of it took {:?}", began.elapsed());
}

#[test]
fn random_inputs_in_a_narrow_window_cause_no_failure() {
    let _one = alone();
    let seed = seed(12);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let mut visit = Visit::new("monkey-narrow");
    let keys = keys();
    let pause = visit.screen.pace;
    visit.screen.pace = Duration::from_millis(6);
    for round in 0..60 {
        let (width, height) = (300 + random.below(301) as u32, 200 + random.below(521) as u32);
        visit.screen.resize(visit.editor.window, width, height);
        let place =
            |random: &mut Random| (random.below(width as usize) as i16, random.below(height as usize) as i16);
        let (x, y) = place(&mut random);
        visit.screen.point(x, y);
        // Box and lasso selection show a text next to the pointer until the drag.
        visit.screen.press_with(key::SHIFT, key::of(random.choice(&['b', 'l'])));
        pass(Duration::from_millis(30));
        for _ in 0..4 {
            let (x, y) = place(&mut random);
            match random.below(3) {
                0 => visit.screen.click(x, y.max(40)),
                1 => {
                    visit.screen.hold();
                    visit.screen.point(x, y);
                    pass(Duration::from_millis(20));
                    visit.screen.release_button();
                }
                _ => visit.screen.press(random.choice(&keys)),
            }
        }
        if round % 5 == 0 {
            visit.screen.press(key::ESCAPE);
        }
    }
    visit.screen.pace = pause;
    (0..4).for_each(|_| visit.screen.press(key::ESCAPE));
    // It still reacts: it ends in order when it is asked to.
    let process = Pid::from_raw(visit.editor.process() as i32).expect("a number");
    kill_process(process, Signal::TERM).expect("it runs");
    assert_eq!(visit.editor.ends(SOON).signal(), Some(Signal::TERM.as_raw()));
    let log = visit.editor.log();
    let failed = |line: &&str| line.contains("panic") || line.contains("input failed");
    assert_eq!(log.lines().find(failed), None);
    assert!(log.contains("step=10"));
}
