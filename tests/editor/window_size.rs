//! The window opens with the size that it had at the last end.

use crate::screen::Screen;
use crate::window::{Editor, SOON, alone};
use dragonfly_kit::eventually;
use dragonfly_kit::folder::Folder;

#[test]
fn the_window_opens_with_its_last_size() {
    let _one = alone();
    let mut screen = Screen::new("size", 1280, 800);
    let folder = Folder::new("window-size");
    let arguments = ["--settings", folder.path().to_str().unwrap()];
    let mut editor = Editor::open(&mut screen, &arguments, &[]);
    let window = editor.window;
    assert_eq!(screen.place(window)[2..], [1280, 720]);
    screen.resize(window, 900, 600);
    eventually(SOON, || screen.place(window)[2..] == [900, 600]);
    screen.close(window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    drop(editor);
    let mut editor = Editor::open(&mut screen, &arguments, &[]);
    assert_eq!(screen.place(editor.window)[2..], [900, 600]);
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}
