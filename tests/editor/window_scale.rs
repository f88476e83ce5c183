//! A desktop that changes its scale factor while the program runs.

use crate::manager;
use crate::screen::{Screen, pass};
use crate::window::{Editor, SOON, alone, rest, same, settled};
use crate::wire::{Window, Wire};
use dragonfly_kit::eventually;
use image::RgbaImage;
use std::time::Duration;

/// The size of the window at scale 1, and at 1.5.
const USUAL: [u32; 4] = [0, 0, 1280, 720];
const LARGER: [u32; 4] = [0, 0, 1920, 1080];
/// Height of the screen that the program leaves to the frame of its window, at the larger scale.
const FRAME: u32 = 90;

/// Returns the rectangle without the status line, which shows how long a frame took.
const fn still([x, y, width, height]: [u32; 4]) -> [u32; 4] {
    [x, y, width, height - 40]
}

/// The settings daemon of a desktop (XSETTINGS).
struct Desktop {
    wire: Wire,
    window: Window,
    settings: u32,
    serial: u32,
}

impl Desktop {
    fn new(screen: &Screen, dots_an_inch: u32) -> Self {
        let mut wire = screen.wire();
        let [selection, settings] = ["_XSETTINGS_S0", "_XSETTINGS_SETTINGS"].map(|name| wire.atom(name));
        let window = wire.create_window();
        let mut desktop = Self { wire, window, settings, serial: 0 };
        desktop.set(dots_an_inch);
        desktop.wire.own(selection, window);
        desktop.wire.place(window).expect("our own window");
        desktop
    }

    /// Sets the resolution; 96 is a scale of 1.
    fn set(&mut self, dots_an_inch: u32) {
        const NAME: &[u8] = b"Xft/DPI";
        self.serial += 1;
        // Little-endian, with one setting: its type and name, padded to a whole word, the serial of its last change,
        // its value.
        let mut text = vec![0, 0, 0, 0];
        text.extend(self.serial.to_le_bytes());
        text.extend(1u32.to_le_bytes());
        text.extend([0, 0, NAME.len() as u8, 0]);
        text.extend(NAME);
        text.push(0);
        text.extend(self.serial.to_le_bytes());
        text.extend((dots_an_inch * 1024).to_le_bytes());
        self.wire.say(self.window, self.settings, self.settings, &text);
    }
}

/// Starts the program on its own screen, at scale 1 and paused. Returns its image, and the image of a program that was
/// started at scale 1.5.
fn begin(screen: &mut Screen) -> (Desktop, Editor, [RgbaImage; 2]) {
    let mut desktop = Desktop::new(screen, 144);
    let larger = {
        let mut editor = Editor::open(screen, &[], &[]);
        assert_eq!(screen.place(editor.window), LARGER.map(|side| side as i32));
        let larger = rest(screen, still(LARGER));
        screen.close(editor.window);
        assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
        larger
    };
    desktop.set(96);
    let editor = Editor::open(screen, &[], &[]);
    assert_eq!(screen.place(editor.window), USUAL.map(|side| side as i32));
    let usual = rest(screen, still(USUAL));
    (desktop, editor, [usual, larger])
}

/// Closes the program, which must exit in order, without warnings.
fn end(mut editor: Editor, screen: &mut Screen) {
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("ERROR"), "{}", editor.log());
}

#[test]
fn a_new_scale_gives_the_same_layout_as_starting_with_it() {
    let _one = alone();
    for managed in [false, true] {
        let mut screen = Screen::new("scale", LARGER[2], LARGER[3] + FRAME);
        if managed {
            manager::start(&screen);
        }
        let (mut desktop, editor, [usual, larger]) = begin(&mut screen);
        for _ in 0..2 {
            desktop.set(144);
            eventually(SOON, || screen.place(editor.window) == LARGER.map(|side| side as i32));
            let now = settled(&screen, still(LARGER));
            same(&screen, &now, &larger, "a change to scale 1.5 looks different from a start at scale 1.5");
            desktop.set(96);
            eventually(SOON, || screen.place(editor.window) == USUAL.map(|side| side as i32));
            same(
                &screen,
                &settled(&screen, still(USUAL)),
                &usual,
                "the scale came back, the picture did not",
            );
        }
        end(editor, &mut screen);
    }
}

#[test]
fn a_hundred_scale_changes_leave_the_window_unchanged() {
    let _one = alone();
    let mut screen = Screen::new("scales", LARGER[2], LARGER[3] + FRAME);
    manager::start(&screen);
    let (mut desktop, editor, [usual, _]) = begin(&mut screen);
    let seed = dragonfly_kit::random::seed(7);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = dragonfly_kit::random::Random::new(seed);
    for step in 0..100 {
        desktop.set(72 + random.below(120) as u32);
        // Now and then the program gets the time to draw in its current scale.
        if step % 5 == 4 {
            pass(Duration::from_millis(60));
        }
    }
    desktop.set(96);
    // Sizes are whole pixels, so a hundred roundings may have changed this one slightly.
    settled(&screen, still(USUAL));
    screen.resize(editor.window, USUAL[2], USUAL[3]);
    eventually(SOON, || screen.place(editor.window)[2..] == [USUAL[2] as i32, USUAL[3] as i32]);
    same(&screen, &settled(&screen, still(USUAL)), &usual, "a hundred scales changed the picture");
    end(editor, &mut screen);
}
