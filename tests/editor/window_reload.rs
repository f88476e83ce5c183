//! Reading the open file again in the real window: the take, the playhead, the selected bones and the camera stay.

use crate::screen::key;
use crate::window::{SOON, alone};
use crate::window_visit::Visit;
use dragonfly_kit::document::new_version::{new_version, reverse};

/// Finds a command in the palette, and runs it.
fn run(visit: &mut Visit, words: &str) {
    visit.screen.press(key::F3);
    visit.control("Find a command or a take");
    for letter in words.chars() {
        visit.screen.press(if letter == ' ' { key::SPACE } else { key::of(letter) });
    }
    visit.screen.press(key::ENTER);
}

#[test]
fn a_file_that_is_read_again_keeps_take_playhead_selection_and_camera() {
    let _one = alone();
    let mut visit = Visit::new("reload-keeps");
    run(&mut visit, "next take");
    visit.until_shown("take", "Walk");
    visit.go_on(5);
    visit.pick_head();
    // The view from the right is another one than that of a file that was just opened.
    let before = visit.shown("camera");
    visit.screen.press(key::of('3'));
    let camera = visit.until("another camera", |visit| {
        let camera = visit.shown("camera");
        (camera != before).then_some(camera)
    });
    // Another program writes bones and takes in another order.
    let bytes = std::fs::read(&visit.file).expect("the file");
    std::fs::write(&visit.file, new_version(&bytes, reverse)).expect("written");
    run(&mut visit, "reload with changes");
    visit.editor.wait_for_log("Loaded the file again", 1, SOON);
    // The state is traced while nothing plays: a file that was just opened would play its first take.
    visit.go_on(1);
    let now = ["bone", "take", "bones", "camera"].map(|field| visit.shown(field));
    assert_eq!(now, ["b_Head_05".to_owned(), "Walk".to_owned(), "1".to_owned(), camera]);
    visit.end();
}
