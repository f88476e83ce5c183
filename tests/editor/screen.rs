//! A screen of our own, with a hand on its keyboard and mouse and an eye on its pixels.
//!
//! Xvfb is the screen; it writes what it shows into a file that we read. The hand speaks the X protocol itself: the few
//! requests it needs are easier to write than a tool for them is to install.

use crate::program::Folder;
use image::RgbaImage;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::net::UnixStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Longer than Xvfb takes to start on a busy machine.
const START: Duration = Duration::from_secs(30);

/// Between two movements of a finger.
const HAND: Duration = Duration::from_millis(60);

/// A window as the X server numbers it.
pub(crate) type Window = u32;

/// Keys by their position on a keyboard, as Xvfb numbers them.
pub(crate) mod key {
    pub(crate) const SPACE: u8 = 65;
    pub(crate) const HOME: u8 = 110;
}

/// See the module.
pub(crate) struct Screen {
    server: Child,
    number: u32,
    hand: UnixStream,
    root: Window,
    test_extension: u8,
    frames: Folder,
}

impl Screen {
    /// Starts a screen of this size on any free number.
    pub(crate) fn new(name: &str, width: u32, height: u32) -> Self {
        let frames = Folder::new(&format!("screen-{name}"));
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-nolisten", "tcp", "-noreset", "-ac", "-screen", "0"])
            .arg(format!("{width}x{height}x24"))
            .arg("-fbdir")
            .arg(frames.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb (Debian: xvfb) starts");
        let mut line = String::new();
        // Written once it is ready, so this is also the wait for it; it ends at once when the server does.
        let read = BufReader::new(server.stdout.take().expect("piped")).read_line(&mut line);
        read.expect("the number of the display");
        let number = line.trim().parse().expect("the number of the display");
        let mut hand = connect(number);
        let root = greet(&mut hand);
        let mut screen = Self { server, number, hand, root, test_extension: 0, frames };
        screen.test_extension = screen.extension("XTEST");
        screen
    }

    /// What `DISPLAY` must be for a program to open its window here.
    pub(crate) fn display(&self) -> String {
        format!(":{}", self.number)
    }

    /// Stops at once, as when a session ends under its programs.
    pub(crate) fn kill(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }

    /// The window with this title, as soon as there is one of some size.
    #[track_caller]
    pub(crate) fn window(&mut self, title: &str, limit: Duration) -> Window {
        let deadline = Instant::now() + limit;
        let name = self.atom("_NET_WM_NAME");
        loop {
            for window in self.children() {
                if self.property(window, name).is_some_and(|text| text.starts_with(title.as_bytes())) {
                    return window;
                }
            }
            assert!(Instant::now() < deadline, "no window called {title} within {limit:?}");
            std::thread::park_timeout(Duration::from_millis(20));
        }
    }

    /// Moves the pointer.
    pub(crate) fn point(&mut self, x: i16, y: i16) {
        self.fake(6, 0, x, y);
    }

    /// Presses and releases the left button at a place, as slowly as a quick hand.
    pub(crate) fn click(&mut self, x: i16, y: i16) {
        self.point(x, y);
        pass(HAND);
        self.fake(4, 1, 0, 0);
        pass(HAND);
        self.fake(5, 1, 0, 0);
        pass(HAND);
    }

    /// Presses and releases a key.
    pub(crate) fn press(&mut self, key: u8) {
        self.fake(2, key, 0, 0);
        pass(HAND);
        self.fake(3, key, 0, 0);
        pass(HAND);
    }

    /// Gives the window the keyboard; without a window manager nobody else does.
    pub(crate) fn focus(&mut self, window: Window) {
        let mut request = vec![42, 2, 3, 0];
        request.extend(words(&[window, 0]));
        self.send(&request);
    }

    /// Asks the window to close, as a click on its cross does.
    pub(crate) fn close(&mut self, window: Window) {
        let (protocols, delete) = (self.atom("WM_PROTOCOLS"), self.atom("WM_DELETE_WINDOW"));
        let mut event = vec![33, 32, 0, 0];
        event.extend(words(&[window, protocols, delete, 0, 0, 0, 0]));
        let mut request = vec![25, 0, 11, 0];
        request.extend(words(&[window, 0]));
        request.extend(event);
        self.send(&request);
    }

    /// Gives the window another size.
    pub(crate) fn resize(&mut self, window: Window, width: u32, height: u32) {
        let mut request = vec![12, 0, 5, 0];
        request.extend(words(&[window, 0b1100, width, height]));
        self.send(&request);
    }

    /// Takes the window off the screen, as minimising does, or puts it back.
    pub(crate) fn show(&mut self, window: Window, shown: bool) {
        let mut request = vec![if shown { 8 } else { 10 }, 0, 2, 0];
        request.extend(words(&[window]));
        self.send(&request);
    }

    /// Destroys the window behind the program's back.
    pub(crate) fn destroy(&mut self, window: Window) {
        let mut request = vec![4, 0, 2, 0];
        request.extend(words(&[window]));
        self.send(&request);
    }

    /// Everything on the screen.
    pub(crate) fn picture(&self) -> RgbaImage {
        let bytes = std::fs::read(self.frames.join("Xvfb_screen0")).expect("the screen's pixels");
        let field = |index: usize| {
            let bytes = bytes[index * 4..index * 4 + 4].try_into().expect("four bytes");
            u32::from_be_bytes(bytes)
        };
        let (width, height, pitch) = (field(4), field(5), field(12) as usize);
        let start = field(0) as usize + field(19) as usize * 12;
        RgbaImage::from_fn(width, height, |x, y| {
            let pixel = &bytes[start + y as usize * pitch + x as usize * 4..];
            image::Rgba([pixel[2], pixel[1], pixel[0], 255])
        })
    }

    /// A part of the screen: left, top, width, height.
    pub(crate) fn part(&self, [x, y, width, height]: [u32; 4]) -> RgbaImage {
        image::imageops::crop_imm(&self.picture(), x, y, width, height).to_image()
    }

    /// Keeps a picture for whoever looks into a failure, and says where it is.
    pub(crate) fn keep(&self, name: &str) {
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
        if self.picture().save(&path).is_ok() {
            eprintln!("the screen at this moment: {}", path.display());
        }
    }

    fn fake(&mut self, kind: u8, detail: u8, x: i16, y: i16) {
        let mut request = vec![self.test_extension, 2, 9, 0, kind, detail, 0, 0];
        request.extend(words(&[0, self.root, 0, 0]));
        request.extend(x.to_le_bytes());
        request.extend(y.to_le_bytes());
        request.extend([0; 8]);
        self.send(&request);
    }

    fn extension(&mut self, name: &str) -> u8 {
        let reply = self.ask(98, 0, &named(name)).expect("an answer");
        assert_eq!(reply[8], 1, "the X server lacks {name}");
        reply[9]
    }

    fn atom(&mut self, name: &str) -> u32 {
        word(&self.ask(16, 0, &named(name)).expect("an answer"), 8)
    }

    fn children(&mut self) -> Vec<Window> {
        let Some(reply) = self.ask(15, 0, &words(&[self.root])) else { return Vec::new() };
        let count = usize::from(u16::from_le_bytes([reply[16], reply[17]]));
        (0..count).map(|index| word(&reply, 32 + 4 * index)).collect()
    }

    fn property(&mut self, window: Window, property: u32) -> Option<Vec<u8>> {
        let reply = self.ask(20, 0, &words(&[window, property, 0, 0, 64]))?;
        let length = word(&reply, 16) as usize * usize::from(reply[1]) / 8;
        reply.get(32..32 + length).map(<[u8]>::to_vec)
    }

    /// A request with an answer; `None` when the answer is an error (the window is gone).
    fn ask(&mut self, request: u8, detail: u8, body: &[u8]) -> Option<Vec<u8>> {
        let length = (body.len() / 4 + 1) as u16;
        let mut bytes = vec![request, detail];
        bytes.extend(length.to_le_bytes());
        bytes.extend(body);
        self.send(&bytes);
        loop {
            let mut reply = vec![0; 32];
            self.hand.read_exact(&mut reply).expect("the X server answers");
            match reply[0] {
                0 => return None,
                1 => {
                    let mut more = vec![0; word(&reply, 4) as usize * 4];
                    self.hand.read_exact(&mut more).expect("the X server answers");
                    reply.extend(more);
                    return Some(reply);
                }
                // An event that nobody asked for.
                _ => {}
            }
        }
    }

    fn send(&mut self, request: &[u8]) {
        self.hand.write_all(request).expect("the X server listens");
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.keep("last-screen");
        }
        self.kill();
    }
}

/// A moment, where time itself is what is meant.
pub(crate) fn pass(time: Duration) {
    let end = Instant::now() + time;
    while let Some(left) = end.checked_duration_since(Instant::now()) {
        std::thread::park_timeout(left);
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

/// Says hello (little-endian, version 11) and learns the root window.
fn greet(hand: &mut UnixStream) -> Window {
    hand.write_all(&[0x6c, 0, 11, 0, 0, 0, 0, 0, 0, 0, 0, 0]).expect("the X server listens");
    let mut head = [0; 8];
    hand.read_exact(&mut head).expect("the X server answers");
    assert_eq!(head[0], 1, "the X server refused us");
    let mut body = vec![0; usize::from(u16::from_le_bytes([head[6], head[7]])) * 4];
    hand.read_exact(&mut body).expect("the X server answers");
    let vendor = usize::from(u16::from_le_bytes([body[16], body[17]])).next_multiple_of(4);
    let formats = usize::from(body[21]) * 8;
    word(&body, 32 + vendor + formats)
}

/// A text as requests want it: length, padding, letters, padding.
fn named(name: &str) -> Vec<u8> {
    let mut body = (name.len() as u16).to_le_bytes().to_vec();
    body.extend([0, 0]);
    body.extend(name.as_bytes());
    body.resize(body.len().next_multiple_of(4), 0);
    body
}

fn words(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}
