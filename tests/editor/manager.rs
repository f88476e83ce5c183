//! A minimal window manager: it gives windows the rectangles that they request, and makes them full-screen on request
//! (by `_NET_WM_STATE` of the Extended Window Manager Hints).

use crate::screen::Screen;
use crate::wire::{Event, Window, WindowRect, Wire, atom, event, words};
use std::collections::HashMap;
use std::time::Duration;

/// Event mask of a window manager on the root window: requests to map and to configure, and notices that they were done.
const MANAGES: u32 = 1 << 19 | 1 << 20;

/// Longer than any test.
const LIFE: Duration = Duration::from_secs(3600);

struct Manager {
    wire: Wire,
    state: u32,
    full_screen: u32,
    /// Rectangles of full-screen windows before they became full-screen.
    before: HashMap<Window, WindowRect>,
}

/// Starts a window manager for `screen` in another thread. It runs until the screen is closed.
pub(crate) fn start(screen: &Screen) {
    let mut wire = screen.wire();
    let root = wire.root;
    wire.select(root, MANAGES);
    let [state, full_screen, supported, check, name] = [
        "_NET_WM_STATE",
        "_NET_WM_STATE_FULLSCREEN",
        "_NET_SUPPORTED",
        "_NET_SUPPORTING_WM_CHECK",
        "_NET_WM_NAME",
    ]
    .map(|name| wire.atom(name));
    let text = wire.atom("UTF8_STRING");
    let own = wire.create_window();
    for window in [root, own] {
        wire.say_words(window, check, atom::WINDOW, &[own]);
    }
    wire.say(own, name, text, b"manager of a test");
    wire.say_words(root, supported, atom::ATOM, &[state, full_screen, check]);
    // Answered only once all of the above has happened, so programs that start now find a manager.
    wire.place(own).expect("our own window");
    let mut manager = Manager { wire, state, full_screen, before: HashMap::new() };
    let work = move || {
        while let Ok(event) = manager.wire.event(LIFE) {
            manager.hear(&event);
        }
    };
    std::thread::Builder::new().name("manager".to_owned()).spawn(work).expect("a thread");
}

impl Manager {
    fn hear(&mut self, event: &Event) {
        match event.kind() {
            event::MAP_REQUEST => {
                let window = event.word(8);
                self.wire.tell(8, 0, &words(&[window]));
                // The newest window gets the keyboard focus.
                self.wire.tell(42, 2, &words(&[window, 0]));
            }
            event::CONFIGURE_REQUEST => self.configure(event),
            event::CLIENT_MESSAGE if self.is_about_full_screen(event) => {
                self.fill(event.word(4), event.word(12));
            }
            _ => {}
        }
    }

    fn is_about_full_screen(&self, message: &Event) -> bool {
        let states = [message.word(16), message.word(20)];
        message.word(8) == self.state && states.contains(&self.full_screen)
    }

    /// Moves a window to the rectangle it requests, unless it is full-screen.
    fn configure(&mut self, event: &Event) {
        let window = event.word(8);
        let Some(mut place) = self.wire.place(window) else { return };
        let asked = event.short(26);
        for (index, side) in place.iter_mut().enumerate() {
            if asked & (1 << index) != 0 {
                let value = event.short(16 + 2 * index);
                *side = if index < 2 { i32::from(value as i16) } else { value as i32 };
            }
        }
        if let Some(before) = self.before.get_mut(&window) {
            // The rectangle applies when the window leaves full screen.
            *before = place;
        } else {
            self.put(window, place);
        }
    }

    /// Makes a window full-screen (1), restores its rectangle (0), or toggles between the two (2).
    fn fill(&mut self, window: Window, action: u32) {
        let full = self.before.contains_key(&window);
        let wanted = action == 1 || action == 2 && !full;
        if wanted == full {
            return;
        }
        let states: &[u32] = if wanted { &[self.full_screen] } else { &[] };
        self.wire.say_words(window, self.state, atom::ATOM, states);
        if wanted {
            let Some(before) = self.wire.place(window) else { return };
            self.before.insert(window, before);
            let [width, height] = self.wire.size.map(|side| side as i32);
            self.put(window, [0, 0, width, height]);
        } else if let Some(before) = self.before.remove(&window) {
            self.put(window, before);
        }
    }

    /// Moves a window and notifies it, as window managers must even if nothing changed.
    fn put(&mut self, window: Window, place: WindowRect) {
        let [x, y, width, height] = place.map(|side| side as u32);
        self.wire.tell(12, 0, &words(&[window, 0b1111, x, y, width, height]));
        let mut told = vec![event::CONFIGURE_NOTIFY, 0, 0, 0];
        told.extend(words(&[window, window, 0]));
        for side in place {
            told.extend((side as u16).to_le_bytes());
        }
        self.wire.post(window, 1 << 17, &told);
    }
}
