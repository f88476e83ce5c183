//! The desktop's dialog for opening files.

use crate::drag::address;
use crate::portal::{Answer, Bus, Portal};
use crate::program::{Folder, data};
use crate::screen::{Screen, key};
use crate::window::{Editor, SOON, alone, eventually_shows_something, rest, same, settled};
use dragonfly_kit::eventually;

const VIEWPORT: [u32; 4] = [320, 90, 680, 360];

/// The program asks in this variable where the bus is.
const BUS: &str = "DBUS_SESSION_BUS_ADDRESS";

#[test]
fn the_file_that_is_chosen_in_the_dialog_is_opened_and_a_closed_dialog_changes_nothing() {
    let _one = alone();
    let folder = Folder::new("chosen");
    let model = folder.join("Füchsin & 100 % mehr.glb");
    std::fs::copy(data("gltf/Fox_skeleton.glb"), &model).expect("a file");
    let bus = Bus::new();
    let portal = Portal::new(&bus);
    let mut screen = Screen::new("dialog", 1280, 800);
    let mut editor = Editor::open(&mut screen, &[], &[(BUS, bus.address())]);
    let window = editor.window;
    eventually_shows_something(&screen);

    screen.press_with(key::CONTROL, key::O);
    let question = portal.question(SOON);
    assert_eq!(question.title, "Open a model");
    for option in ["filters", "current_folder"] {
        assert!(question.options.iter().any(|found| found == option), "{option}: {:?}", question.options);
    }
    // One dialog is enough, also for who does not see it behind the window.
    screen.press_with(key::CONTROL, key::O);
    editor.hears("The dialog for opening files is open already", 1, SOON);
    // The window lives on while the dialog is open.
    let before = screen.part(VIEWPORT);
    eventually(SOON, || screen.part(VIEWPORT) != before);
    let fox = rest(&mut screen, VIEWPORT);
    portal.answer(&question, &Answer::Nothing);
    editor.hears("No file was chosen", 1, SOON);
    same(&screen, &settled(&screen, VIEWPORT), &fox, "a dialog that was closed changed the picture");

    screen.press_with(key::CONTROL, key::O);
    let question = portal.question(SOON);
    portal.answer(&question, &Answer::File(address(&model)));
    editor.hears("Opened Füchsin & 100 % mehr.glb", 1, SOON);
    assert_eq!(screen.window("Füchsin & 100 % mehr.glb", SOON), window);
    eventually(SOON, || screen.part(VIEWPORT) != fox);

    screen.close(window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("ERROR"), "{}", editor.log());
}

#[test]
fn the_program_ends_while_the_dialog_is_open() {
    let _one = alone();
    let bus = Bus::new();
    let portal = Portal::new(&bus);
    let mut screen = Screen::new("left-open", 1280, 800);
    let mut editor = Editor::open(&mut screen, &[], &[(BUS, bus.address())]);
    screen.press_with(key::CONTROL, key::O);
    portal.question(SOON);
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}

#[test]
fn a_desktop_without_a_dialog_is_told_and_the_path_can_be_typed() {
    let _one = alone();
    let bus = Bus::new();
    let mut screen = Screen::new("no-dialog", 1280, 800);
    for address in [bus.address(), "unix:path=/nonexistent"] {
        // Nor any program that would show one instead.
        let environment = [(BUS, address), ("PATH", "/nonexistent")];
        let mut editor = Editor::open(&mut screen, &[], &environment);
        let closed = rest(&mut screen, VIEWPORT);
        screen.press_with(key::CONTROL, key::O);
        editor.hears("This desktop has no dialog for opening files; type the path instead", 1, SOON);
        // The field for the path lies over the picture.
        eventually(SOON, || screen.part(VIEWPORT) != closed);
        screen.close(editor.window);
        assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    }
}
