//! Full screen mode, with F11 and from the menu, on a desktop with a window manager.

use crate::manager;
use crate::screen::{Screen, key};
use crate::window::{Editor, SOON, alone, colors, rest, same, settled};
use dragonfly_kit::eventually;

/// The viewport, in the window as it opens.
const VIEWPORT: [u32; 4] = [320, 90, 680, 360];

/// The menu "View" and its entry "Full screen".
const MENU: [(i16, i16); 2] = [(350, 14), (380, 571)];

#[test]
fn f11_and_the_menu_toggle_full_screen() {
    let _one = alone();
    let mut screen = Screen::new("full", 1600, 1000);
    manager::start(&screen);
    let mut editor = Editor::open(&mut screen, &[], &[]);
    let window = editor.window;
    let whole = rest(&mut screen, VIEWPORT);
    let before = screen.place(window);
    assert_eq!(before[2..], [1280, 720]);
    for way in ["key", "key", "menu"] {
        let toggle = |screen: &mut Screen| match way {
            "key" => screen.press(key::F11),
            _ => {
                MENU.into_iter().for_each(|(x, y)| screen.click(x, y));
                // The pointer is moved away, so that nothing is highlighted under it.
                screen.point(i16::MAX, i16::MAX);
            }
        };
        toggle(&mut screen);
        eventually(SOON, || screen.place(window) == [0, 0, 1600, 1000]);
        // The area around the former window, which was black, is now drawn to the last pixel.
        eventually(SOON, || colors(&screen.part([1400, 0, 200, 1000])) > 20);
        let full = settled(&screen, [0, 0, 1600, 1000]);
        for (x, y) in [(1599, 0), (1599, 999), (0, 999)] {
            assert_ne!(full.get_pixel(x, y).0[..3], [0, 0, 0], "{way}: {x}, {y} is black");
        }
        toggle(&mut screen);
        eventually(SOON, || screen.place(window) == before);
        same(
            &screen,
            &settled(&screen, VIEWPORT),
            &whole,
            "entering and leaving full screen changed the picture",
        );
    }
    screen.close(window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("ERROR"), "{}", editor.log());
}
