//! The file dialog of the desktop.

use crate::drag::address;
use crate::portal::{Answer, Bus, Portal};
use crate::screen::{Screen, key, pass};
use crate::window::{Editor, SOON, alone, eventually_shows_something, rest, same, settled};
use dragonfly_kit::document::test_document::{TestDocument, copy_after_kill, turn};
use dragonfly_kit::eventually;
use dragonfly_kit::folder::{Folder, data};
use std::time::Duration;

const VIEWPORT: [u32; 4] = [320, 90, 680, 360];

/// Environment variable with the address of the bus.
const BUS: &str = "DBUS_SESSION_BUS_ADDRESS";

#[test]
fn the_chosen_file_is_opened_and_cancelling_the_dialog_changes_nothing() {
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
    assert_eq!(question.title, "Open a model or a scene");
    for option in ["filters", "current_folder"] {
        assert!(question.options.iter().any(|found| found == option), "{option}: {:?}", question.options);
    }
    // A second request opens no second dialog, even if the user does not see the first one, hidden by the window.
    screen.press_with(key::CONTROL, key::O);
    editor.wait_for_log("The dialog for opening files is open already", 1, SOON);
    // The window keeps working while the dialog is open.
    let before = screen.part(VIEWPORT);
    eventually(SOON, || screen.part(VIEWPORT) != before);
    let fox = rest(&mut screen, VIEWPORT);
    portal.answer(&question, &Answer::Nothing);
    editor.wait_for_log("No file was chosen", 1, SOON);
    same(&screen, &settled(&screen, VIEWPORT), &fox, "a dialog that was closed changed the picture");

    screen.press_with(key::CONTROL, key::O);
    let question = portal.question(SOON);
    portal.answer(&question, &Answer::File(address(&model)));
    editor.wait_for_log("Opened Füchsin & 100 % mehr.glb", 1, SOON);
    assert_eq!(screen.window("Füchsin & 100 % mehr.glb", SOON), window);
    eventually(SOON, || screen.part(VIEWPORT) != fox);

    screen.close(window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("ERROR"), "{}", editor.log());
}

#[test]
fn the_folder_of_poses_is_chosen_in_the_dialog() {
    let _one = alone();
    let folder = Folder::new("poses-chosen");
    let poses = folder.join("Pösen & more");
    std::fs::create_dir(&poses).expect("a folder");
    let bus = Bus::new();
    let portal = Portal::new(&bus);
    let mut screen = Screen::new("folder", 1280, 800);
    let mut editor = Editor::open(&mut screen, &[], &[(BUS, bus.address())]);
    eventually_shows_something(&screen);
    screen.press(key::F3);
    screen.type_text("choose");
    screen.press(key::SPACE);
    screen.type_text("pose");
    screen.press(key::ENTER);
    let question = portal.question(SOON);
    assert_eq!(question.title, "Choose the folder of poses");
    assert!(question.options.iter().any(|option| option == "directory"), "{:?}", question.options);
    portal.answer(&question, &Answer::File(address(&poses)));
    editor.wait_for_log("The folder of poses is", 1, SOON);
    assert!(editor.log().contains("Pösen & more"), "{}", editor.log());
    // The system's dialog is closed without a folder.
    screen.press(key::F3);
    screen.type_text("choose");
    screen.press(key::SPACE);
    screen.type_text("pose");
    screen.press(key::ENTER);
    let question = portal.question(SOON);
    pass(Duration::from_millis(400));
    portal.answer(&question, &Answer::Nothing);
    editor.wait_for_log("No folder was chosen", 1, SOON);
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
fn without_a_file_dialog_a_message_is_shown_and_the_path_can_be_typed() {
    let _one = alone();
    let bus = Bus::new();
    let mut screen = Screen::new("no-dialog", 1280, 800);
    for address in [bus.address(), "unix:path=/nonexistent"] {
        // The search path is empty, so no other program can show a dialog.
        let environment = [(BUS, address), ("PATH", "/nonexistent")];
        let mut editor = Editor::open(&mut screen, &[], &environment);
        let closed = rest(&mut screen, VIEWPORT);
        screen.press_with(key::CONTROL, key::O);
        editor.wait_for_log("This desktop has no dialog for opening files; type the path instead", 1, SOON);
        // The path field covers a part of the viewport.
        eventually(SOON, || screen.part(VIEWPORT) != closed);
        screen.close(editor.window);
        assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    }
}

#[test]
fn work_on_a_renamed_file_continues_in_the_chosen_file() {
    let _one = alone();
    let folder = Folder::new("renamed");
    let model = folder.join("Fox.glb");
    std::fs::copy(data("gltf/Fox.glb"), &model).expect("a file");
    let mut desk = TestDocument::new(&folder.join("first"));
    desk.open(&model);
    desk.edit(turn(0.5));
    desk.edit(turn(0.9));
    desk.view();
    let autosave = folder.join("second");
    copy_after_kill(&folder.join("first"), &autosave);
    let moved = folder.join("Füchsin & mehr.glb");
    std::fs::rename(&model, &moved).expect("renamed");
    let other = data("gltf/Fox_skeleton.glb");
    let (bus, mut screen) = (Bus::new(), Screen::new("renamed", 1280, 800));
    let arguments = ["--autosave", autosave.to_str().expect("a name")];
    {
        let portal = Portal::new(&bus);
        let mut editor = Editor::open(&mut screen, &arguments, &[(BUS, bus.address())]);
        editor.wait_for_log("offered unsaved work", 1, SOON);
        screen.press(key::ENTER);
        let question = portal.question(SOON);
        assert_eq!(question.title, "Where is Fox.glb now?");
        // After the user has closed the dialog, which takes some time, the question is still there.
        pass(Duration::from_millis(400));
        portal.answer(&question, &Answer::Nothing);
        editor.wait_for_log("No file was chosen", 1, SOON);
        screen.press(key::ENTER);
        portal.answer(&portal.question(SOON), &Answer::File(address(&other)));
        editor.wait_for_log("reported that it is another file", 1, SOON);
        screen.press(key::ENTER);
        portal.answer(&portal.question(SOON), &Answer::File(address(&moved)));
        editor.wait_for_log("Restored the unsaved work of Füchsin & mehr.glb: 2 steps", 1, SOON);
        screen.window("• Füchsin & mehr.glb", SOON);
        editor.kill();
    }
    // Without a file dialog the path is typed; the field contains the last known path.
    let back = folder.join("Fox.glb");
    std::fs::rename(&moved, &back).expect("renamed");
    let environment = [(BUS, "unix:path=/nonexistent"), ("PATH", "/nonexistent")];
    let mut editor = Editor::open(&mut screen, &arguments, &environment);
    editor.wait_for_log("offered unsaved work", 1, SOON);
    screen.press(key::ENTER);
    editor.wait_for_log("asked where a file is now", 1, SOON);
    screen.press_with(key::CONTROL, key::of('a'));
    screen.type_path(back.to_str().expect("a name"));
    screen.press(key::ENTER);
    editor.wait_for_log("Restored the unsaved work of Fox.glb: 2 steps", 1, SOON);
    editor.kill();
}
