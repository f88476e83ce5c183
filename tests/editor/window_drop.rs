//! Files dragged onto the window.

use crate::drag::{Drag, address};
use crate::screen::Screen;
use crate::window::{Editor, SOON, alone, rest, same, settled};
use dragonfly_kit::eventually;
use dragonfly_kit::folder::{Folder, data};

/// The viewport, without the file name in its corner.
const VIEWPORT: [u32; 4] = [320, 90, 680, 360];

#[test]
fn a_dropped_model_is_opened_several_become_takes_and_other_files_are_refused() {
    let _one = alone();
    let folder = Folder::new("dropped");
    let model = folder.join("Füchsin & 100 % mehr.glb");
    std::fs::copy(data("gltf/SimpleSkin_embedded.gltf"), folder.join("second.gltf")).expect("a file");
    std::fs::copy(data("gltf/Fox_skeleton.glb"), &model).expect("a file");
    let text = folder.join("no model.glb");
    std::fs::write(&text, "Dear diary").expect("a file");
    let mut screen = Screen::new("drop", 1280, 800);
    let mut editor = Editor::open(&mut screen, &[], &[]);
    let window = editor.window;
    let fox = rest(&mut screen, VIEWPORT);
    let mut drag = Drag::new(&screen);

    // A file held over the window is announced; dragged away again it changes nothing.
    assert!(drag.hold(window, &[address(&model)]), "the window does not take files");
    eventually(SOON, || screen.part(VIEWPORT) != fox);
    drag.leave(window);
    same(&screen, &settled(&screen, VIEWPORT), &fox, "what was only held over the window changed it");

    // A file that is no model: a message is shown, and the open document stays.
    assert!(drag.hold(window, &[address(&text)]));
    drag.drop(window);
    editor.wait_for_log("no model.glb", 1, SOON);
    assert!(editor.lines.last().is_some_and(|line| line.contains("WARN")), "{}", editor.log());
    same(&screen, &settled(&screen, VIEWPORT), &fox, "a file that is no model changed the picture");
    screen.window("Fox.glb", SOON);

    // A model is opened, whatever its name is.
    assert!(drag.hold(window, &[address(&model)]));
    drag.drop(window);
    editor.wait_for_log("Opened Füchsin & 100 % mehr.glb", 1, SOON);
    assert_eq!(screen.window("Füchsin & 100 % mehr.glb", SOON), window);
    eventually(SOON, || screen.part(VIEWPORT) != fox);

    // Several files are takes for the open model: those whose bones do not fit are reported, and nothing changes.
    std::fs::copy(data("gltf/SimpleSkin_embedded.gltf"), folder.join("third.gltf")).expect("a file");
    let several = [folder.join("second.gltf"), folder.join("third.gltf")];
    assert!(drag.hold(window, &several.map(|path| address(&path))));
    drag.drop(window);
    editor.wait_for_log("second.gltf: no bone has the name of a bone of the model", 1, SOON);
    screen.window("Füchsin & 100 % mehr.glb", SOON);

    screen.close(window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("ERROR"), "{}", editor.log());
}
