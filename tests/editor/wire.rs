//! A minimal client of the X protocol. Writing the few requests that the tests need is easier than installing a tool.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

/// Timeout longer than an X server takes to start or to answer on a busy machine.
const START: Duration = Duration::from_secs(30);

/// X id of a window.
pub(crate) type Window = u32;

/// Predefined atoms of the protocol.
pub(crate) mod atom {
    pub(crate) const ATOM: u32 = 4;
    pub(crate) const WINDOW: u32 = 33;
}

/// Event codes.
pub(crate) mod event {
    pub(crate) const MAP_REQUEST: u8 = 20;
    pub(crate) const CONFIGURE_NOTIFY: u8 = 22;
    pub(crate) const CONFIGURE_REQUEST: u8 = 23;
    pub(crate) const SELECTION_REQUEST: u8 = 30;
    pub(crate) const SELECTION_NOTIFY: u8 = 31;
    pub(crate) const CLIENT_MESSAGE: u8 = 33;
}

/// An event from the X server.
pub(crate) struct Event([u8; 32]);

impl Event {
    /// Returns the code of the event, one of [`event`], whether the server or another program sent it.
    pub(crate) fn kind(&self) -> u8 {
        self.0[0] & 0x7f
    }

    /// Returns the 32-bit number at a byte offset.
    pub(crate) fn word(&self, at: usize) -> u32 {
        word(&self.0, at)
    }

    /// Returns the 16-bit number at a byte offset.
    pub(crate) fn short(&self, at: usize) -> u32 {
        u32::from(u16::from_le_bytes([self.0[at], self.0[at + 1]]))
    }
}

/// Rectangle of a window on its screen: left, top, width, height.
pub(crate) type WindowRect = [i32; 4];

/// A connection to an X server.
pub(crate) struct Wire {
    stream: UnixStream,
    pub(crate) root: Window,
    /// Width and height of the screen.
    pub(crate) size: [u32; 2],
    next_id: u32,
    events: VecDeque<Event>,
}

impl Wire {
    /// Connects (little-endian, version 11) and reads the id of the root window.
    pub(crate) fn connect(number: u32) -> Self {
        let mut stream = connect(number);
        stream.write_all(&[0x6c, 0, 11, 0, 0, 0, 0, 0, 0, 0, 0, 0]).expect("the X server listens");
        let mut head = [0; 8];
        stream.read_exact(&mut head).expect("the X server answers");
        assert_eq!(head[0], 1, "the X server refused us");
        let mut body = vec![0; usize::from(u16::from_le_bytes([head[6], head[7]])) * 4];
        stream.read_exact(&mut body).expect("the X server answers");
        let vendor = usize::from(u16::from_le_bytes([body[16], body[17]])).next_multiple_of(4);
        let screen = 32 + vendor + usize::from(body[21]) * 8;
        let side = |at: usize| u32::from(u16::from_le_bytes([body[screen + at], body[screen + at + 1]]));
        Self {
            stream,
            root: word(&body, screen),
            size: [side(20), side(22)],
            next_id: word(&body, 4),
            events: VecDeque::new(),
        }
    }

    /// Returns the atom of a name.
    pub(crate) fn atom(&mut self, name: &str) -> u32 {
        word(&self.ask(16, 0, &named(name)).expect("an answer"), 8)
    }

    /// Returns the first request code of an extension, which must exist.
    pub(crate) fn extension(&mut self, name: &str) -> u8 {
        let reply = self.ask(98, 0, &named(name)).expect("an answer");
        assert_eq!(reply[8], 1, "the X server lacks {name}");
        reply[9]
    }

    /// Returns the children of the root window.
    pub(crate) fn children(&mut self) -> Vec<Window> {
        let Some(reply) = self.ask(15, 0, &words(&[self.root])) else { return Vec::new() };
        let count = usize::from(u16::from_le_bytes([reply[16], reply[17]]));
        (0..count).map(|index| word(&reply, 32 + 4 * index)).collect()
    }

    /// Returns the bytes of a property of a window.
    pub(crate) fn property(&mut self, window: Window, property: u32) -> Option<Vec<u8>> {
        let reply = self.ask(20, 0, &words(&[window, property, 0, 0, 64]))?;
        let length = word(&reply, 16) as usize * usize::from(reply[1]) / 8;
        reply.get(32..32 + length).map(<[u8]>::to_vec)
    }

    /// Sets a property of a window to bytes.
    pub(crate) fn say(&mut self, window: Window, property: u32, kind: u32, text: &[u8]) {
        self.change(window, property, kind, 8, text);
    }

    /// Sets a property of a window to 32-bit numbers.
    pub(crate) fn say_words(&mut self, window: Window, property: u32, kind: u32, numbers: &[u32]) {
        self.change(window, property, kind, 32, &words(numbers));
    }

    fn change(&mut self, window: Window, property: u32, kind: u32, bits: u32, data: &[u8]) {
        let mut body = words(&[window, property, kind, bits, data.len() as u32 * 8 / bits]);
        body.extend(data);
        body.resize(body.len().next_multiple_of(4), 0);
        self.tell(18, 0, &body);
    }

    /// Creates a window that is never shown.
    pub(crate) fn create_window(&mut self) -> Window {
        let window = self.next_id;
        self.next_id += 1;
        // At the corner, one pixel, without a border, only for input and messages.
        let mut body = words(&[window, self.root, 0]);
        for small in [1u16, 1, 0, 2] {
            body.extend(small.to_le_bytes());
        }
        body.extend(words(&[0, 0]));
        self.tell(1, 0, &body);
        window
    }

    /// Makes a window the owner of `selection`.
    pub(crate) fn own(&mut self, selection: u32, window: Window) {
        self.tell(22, 0, &words(&[window, selection, 0]));
    }

    /// Subscribes to the events in `mask` of a window.
    pub(crate) fn select(&mut self, window: Window, mask: u32) {
        self.tell(2, 0, &words(&[window, 1 << 11, mask]));
    }

    /// Sends a program a message of five numbers that concerns `window`.
    pub(crate) fn message(&mut self, to: Window, mask: u32, window: Window, kind: u32, data: [u32; 5]) {
        let mut event = vec![event::CLIENT_MESSAGE, 32, 0, 0];
        event.extend(words(&[window, kind]));
        event.extend(words(&data));
        self.post(to, mask, &event);
    }

    /// Sends an event to the program of a window, as if the server had sent it.
    pub(crate) fn post(&mut self, to: Window, mask: u32, event: &[u8]) {
        let mut body = words(&[to, mask]);
        body.extend(event);
        body.resize(40, 0);
        self.tell(25, 0, &body);
    }

    /// Returns the rectangle of a window, without its border.
    pub(crate) fn place(&mut self, window: Window) -> Option<WindowRect> {
        let reply = self.ask(14, 0, &words(&[window]))?;
        let small = |at: usize| [reply[at], reply[at + 1]];
        let [x, y] = [12, 14].map(|at| i32::from(i16::from_le_bytes(small(at))));
        let [width, height] = [16, 18].map(|at| i32::from(u16::from_le_bytes(small(at))));
        Some([x, y, width, height])
    }

    /// Returns the next event, which must arrive within `limit`.
    pub(crate) fn event(&mut self, limit: Duration) -> io::Result<Event> {
        let deadline = Instant::now() + limit;
        loop {
            if let Some(event) = self.events.pop_front() {
                return Ok(event);
            }
            let left = deadline.saturating_duration_since(Instant::now());
            self.stream.set_read_timeout(Some(left.max(Duration::from_millis(1))))?;
            let mut bytes = [0; 32];
            let begun = self.stream.read(&mut bytes);
            self.stream.set_read_timeout(Some(START))?;
            let begun = match begun {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(begun) => begun,
                Err(error) => return Err(error),
            };
            self.stream.read_exact(&mut bytes[begun..])?;
            // An error about a window that no longer exists is not an event, and no request waits for it.
            if bytes[0] > 1 {
                self.events.push_back(Event(bytes));
            }
        }
    }

    /// Sends a request, and returns its reply; `None` if the reply is an error (the window no longer exists).
    pub(crate) fn ask(&mut self, request: u8, detail: u8, body: &[u8]) -> Option<Vec<u8>> {
        self.tell(request, detail, body);
        loop {
            let mut reply = [0; 32];
            self.stream.read_exact(&mut reply).expect("the X server answers");
            match reply[0] {
                0 => return None,
                1 => {
                    let mut more = vec![0; word(&reply, 4) as usize * 4];
                    self.stream.read_exact(&mut more).expect("the X server answers");
                    return Some([&reply[..], &more].concat());
                }
                _ => self.events.push_back(Event(reply)),
            }
        }
    }

    /// Sends a request without a reply; `body` is a whole number of words.
    pub(crate) fn tell(&mut self, request: u8, detail: u8, body: &[u8]) {
        let length = (body.len() / 4 + 1) as u16;
        let mut bytes = vec![request, detail];
        bytes.extend(length.to_le_bytes());
        bytes.extend(body);
        self.stream.write_all(&bytes).expect("the X server listens");
    }
}

fn connect(number: u32) -> UnixStream {
    let deadline = Instant::now() + START;
    loop {
        match UnixStream::connect(format!("/tmp/.X11-unix/X{number}")) {
            Ok(stream) => {
                stream.set_read_timeout(Some(START)).expect("a socket");
                return stream;
            }
            Err(error) => assert!(Instant::now() < deadline, "{error}"),
        }
        std::thread::park_timeout(Duration::from_millis(10));
    }
}

/// Encodes a text as requests contain it: length, padding, characters, padding.
fn named(name: &str) -> Vec<u8> {
    let mut body = (name.len() as u16).to_le_bytes().to_vec();
    body.extend([0, 0]);
    body.extend(name.as_bytes());
    body.resize(body.len().next_multiple_of(4), 0);
    body
}

/// Encodes numbers as the protocol does.
pub(crate) fn words(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}
