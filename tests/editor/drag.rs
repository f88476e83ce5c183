//! The other side of drag and drop (XDND, version 5): a program from which files are dragged onto a window.

use crate::screen::Screen;
use crate::wire::{Event, Window, Wire, event, words};
use std::time::{Duration, Instant};

/// Longer than a program takes to answer on a busy machine.
const PATIENCE: Duration = Duration::from_secs(30);

/// The part of a file manager that drags files.
pub(crate) struct Drag {
    wire: Wire,
    own: Window,
    selection: u32,
    list: u32,
}

impl Drag {
    pub(crate) fn new(screen: &Screen) -> Self {
        let mut wire = screen.wire();
        let own = wire.create_window();
        let [selection, list] = ["XdndSelection", "text/uri-list"].map(|name| wire.atom(name));
        wire.own(selection, own);
        Self { wire, own, selection, list }
    }

    /// Grabs the pointer, as a program does from which something is dragged: no other program gets its movements.
    pub(crate) fn take_pointer(&mut self) {
        let (root, to_root_alone) = (self.wire.root, 0);
        // No events; neither pointer nor keyboard is frozen.
        let body = [words(&[root]), vec![0, 0, 1, 1], words(&[0, 0, 0])].concat();
        let reply = self.wire.ask(26, to_root_alone, &body).expect("an answer");
        assert_eq!(reply[1], 0, "another program has the pointer");
    }

    /// Gives the pointer back.
    pub(crate) fn give_pointer_back(&mut self) {
        self.wire.tell(27, 0, &words(&[0]));
    }

    /// Drags the files with these addresses over the middle of `window`, and holds them there until they are dropped.
    ///
    /// Returns whether the window accepts them.
    pub(crate) fn hold(&mut self, window: Window, addresses: &[String]) -> bool {
        let list = self.list;
        self.send(window, "XdndEnter", [5 << 24, list, 0, 0]);
        let [x, y, width, height] = self.wire.place(window).expect("a window");
        let place = ((x + width / 2) as u32) << 16 | (y + height / 2) as u32;
        let copy = self.wire.atom("XdndActionCopy");
        self.send(window, "XdndPosition", [0, place, 0, copy]);
        // The window replies at once that it accepts the drop, and requests the data.
        let status = self.wire.atom("XdndStatus");
        let (mut takes, mut asked) = (None, false);
        while takes.is_none() || (takes == Some(true) && !asked) {
            let event = self.hear();
            match event.kind() {
                event::SELECTION_REQUEST => {
                    self.tell(&event, addresses);
                    asked = true;
                }
                event::CLIENT_MESSAGE if event.word(8) == status => takes = Some(event.word(16) & 1 == 1),
                _ => {}
            }
        }
        takes == Some(true)
    }

    /// Drops the files, and waits until the window has received them.
    pub(crate) fn drop(&mut self, window: Window) {
        self.send(window, "XdndDrop", [0, 0, 0, 0]);
        let finished = self.wire.atom("XdndFinished");
        let deadline = Instant::now() + PATIENCE;
        loop {
            let event = self.hear();
            if event.kind() == event::CLIENT_MESSAGE && event.word(8) == finished {
                return;
            }
            assert!(Instant::now() < deadline, "the window does not report that it received the files");
        }
    }

    /// Drags the files away from the window again.
    pub(crate) fn leave(&mut self, window: Window) {
        self.send(window, "XdndLeave", [0, 0, 0, 0]);
    }

    fn hear(&mut self) -> Event {
        self.wire.event(PATIENCE).expect("the window answers whoever drags something over it")
    }

    fn send(&mut self, window: Window, name: &str, [a, b, c, d]: [u32; 4]) {
        let name = self.wire.atom(name);
        self.wire.message(window, 0, window, name, [self.own, a, b, c, d]);
    }

    /// Answers a request for the addresses of the dragged files.
    fn tell(&mut self, asked: &Event, addresses: &[String]) {
        let [time, asker, selection, target, property] = [4, 12, 16, 20, 24].map(|at| asked.word(at));
        assert_eq!((selection, target), (self.selection, self.list), "asked for something else");
        let text: String = addresses.iter().map(|address| format!("{address}\r\n")).collect();
        self.wire.say(asker, property, target, text.as_bytes());
        let mut told = vec![event::SELECTION_NOTIFY, 0, 0, 0];
        told.extend(words(&[time, asker, selection, target, property]));
        self.wire.post(asker, 0, &told);
    }
}

/// Returns the address of a file as file managers write it: percent-encoded except for letters, digits and `/-_.~`.
pub(crate) fn address(path: &std::path::Path) -> String {
    let plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"/-_.~".contains(byte);
    let written = |byte: u8| if plain(&byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    let path = path.to_str().expect("UTF-8 in the paths of tests");
    format!("file://{}", path.bytes().map(written).collect::<String>())
}
