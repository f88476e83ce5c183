//! Files dragged onto the window.

use crate::drag::{Drag, address};
use crate::screen::Screen;
use crate::window::{Editor, SOON, alone, rest, same, settled};
use dragonfly_kit::eventually;
use dragonfly_kit::folder::{Folder, data};

/// The viewport, without the name of the file in its corner.
const VIEWPORT: [u32; 4] = [320, 90, 680, 360];

#[test]
fn a_model_that_is_dropped_is_opened_and_anything_else_is_refused() {
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

    // Held over the window it is announced; taken away again nothing has happened.
    assert!(drag.hold(window, &[address(&model)]), "the window does not take files");
    eventually(SOON, || screen.part(VIEWPORT) != fox);
    drag.leave(window);
    same(&screen, &settled(&screen, VIEWPORT), &fox, "what was only held over the window changed it");

    // No model: said, and what is open stays.
    assert!(drag.hold(window, &[address(&text)]));
    drag.drop(window);
    editor.hears("no model.glb", 1, SOON);
    assert!(editor.lines.last().is_some_and(|line| line.contains("WARN")), "{}", editor.log());
    same(&screen, &settled(&screen, VIEWPORT), &fox, "a file that is no model changed the picture");
    screen.window("Fox.glb", SOON);

    // A model: opened, whatever its name is.
    assert!(drag.hold(window, &[address(&model)]));
    drag.drop(window);
    editor.hears("Opened Füchsin & 100 % mehr.glb", 1, SOON);
    assert_eq!(screen.window("Füchsin & 100 % mehr.glb", SOON), window);
    eventually(SOON, || screen.part(VIEWPORT) != fox);

    // Several: the first, and it is said that the others stay closed.
    let several = [data("gltf/Fox.glb"), folder.join("second.gltf"), model];
    assert!(drag.hold(window, &several.map(|path| address(&path))));
    drag.drop(window);
    editor.hears("Opened Fox.glb", 2, SOON);
    editor.hears("Only one model can be open: 2 further files were not opened", 1, SOON);
    screen.window("Fox.glb", SOON);

    screen.close(window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("ERROR"), "{}", editor.log());
}
