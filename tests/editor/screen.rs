//! A private X screen for tests, with simulated keyboard and mouse input and access to its pixels.
//!
//! The X server is Xvfb; it writes its screen contents into a file that the tests read.

use crate::wire::{WindowRect, Wire, words};
use dragonfly_kit::folder::Folder;
use image::RgbaImage;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

pub(crate) use crate::wire::Window;

/// Time between two simulated input events.
const INPUT_INTERVAL: Duration = Duration::from_millis(60);

/// Key codes by position on a keyboard, as Xvfb numbers them.
pub(crate) mod key {
    pub(crate) const DIGIT_0: u8 = 19;
    pub(crate) const DIGIT_3: u8 = 12;
    pub(crate) const ENTER: u8 = 36;
    pub(crate) const ESCAPE: u8 = 9;
    pub(crate) const F3: u8 = 69;
    pub(crate) const X: u8 = 53;
    pub(crate) const Y: u8 = 29;
    pub(crate) const Z: u8 = 52;
    pub(crate) const CONTROL: u8 = 37;
    pub(crate) const O: u8 = 32;
    pub(crate) const SPACE: u8 = 65;
    pub(crate) const TAB: u8 = 23;
    pub(crate) const Q: u8 = 24;
    pub(crate) const S: u8 = 39;
    pub(crate) const SHIFT: u8 = 50;
    pub(crate) const F11: u8 = 95;
    pub(crate) const HOME: u8 = 110;
    pub(crate) const RIGHT: u8 = 114;
    pub(crate) const LEFT: u8 = 113;
    pub(crate) const DOWN: u8 = 116;
    pub(crate) const END: u8 = 115;
    pub(crate) const ALT: u8 = 64;
    pub(crate) const F: u8 = 41;
    pub(crate) const I: u8 = 31;
    pub(crate) const K: u8 = 45;
    pub(crate) const T: u8 = 28;

    /// Returns the key that types this character without a modifier.
    #[track_caller]
    pub(crate) fn of(sign: char) -> u8 {
        const ROWS: [(&str, u8); 4] =
            [("1234567890-=", 10), ("qwertyuiop", 24), ("asdfghjkl", 38), ("zxcvbnm,./", 52)];
        let place = |(row, first): (&str, u8)| row.find(sign).map(|at| first + at as u8);
        ROWS.into_iter().find_map(place).unwrap_or_else(|| panic!("no key says {sign:?}"))
    }
}

/// An Xvfb server and a connection that sends input to it.
pub(crate) struct Screen {
    server: Child,
    number: u32,
    connection: Wire,
    test_extension: u8,
    frames: Folder,
    /// Time between two simulated input events.
    pub(crate) pace: Duration,
    /// Process that owns the window under test.
    pub(crate) program: Option<u32>,
}

impl Screen {
    /// Starts a screen of this size on any free display number.
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
        // The server writes it once it is ready, so reading waits for that; reading ends at once when the server exits.
        let read = BufReader::new(server.stdout.take().expect("piped")).read_line(&mut line);
        read.expect("the number of the display");
        let number = line.trim().parse().expect("the number of the display");
        let mut connection = Wire::connect(number);
        let test_extension = connection.extension("XTEST");
        Self { server, number, connection, test_extension, frames, pace: INPUT_INTERVAL, program: None }
    }

    /// Returns the value of `DISPLAY` with which a program opens its window on this screen.
    pub(crate) fn display(&self) -> String {
        format!(":{}", self.number)
    }

    /// Opens another connection, for a test that also acts as another program.
    pub(crate) fn wire(&self) -> Wire {
        Wire::connect(self.number)
    }

    /// Kills the server immediately, as when a session ends while its programs still run.
    pub(crate) fn kill(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }

    /// Waits for a window with this title and a nonzero size, and returns it.
    #[track_caller]
    pub(crate) fn window(&mut self, title: &str, limit: Duration) -> Window {
        self.any_window(&[title], limit)
    }

    /// Waits for a window with one of these titles, and returns it.
    #[track_caller]
    pub(crate) fn any_window(&mut self, titles: &[&str], limit: Duration) -> Window {
        let deadline = Instant::now() + limit;
        let name = self.connection.atom("_NET_WM_NAME");
        loop {
            for window in self.connection.children() {
                let title = self.connection.property(window, name).unwrap_or_default();
                if titles.iter().any(|wanted| title.starts_with(wanted.as_bytes())) {
                    return window;
                }
            }
            assert!(Instant::now() < deadline, "no window called {titles:?} within {limit:?}");
            std::thread::park_timeout(Duration::from_millis(20));
        }
    }

    /// Moves the pointer.
    pub(crate) fn point(&mut self, x: i16, y: i16) {
        self.fake(6, 0, x, y);
    }

    /// Presses and releases the left button at a position, at the speed of a fast user.
    pub(crate) fn click(&mut self, x: i16, y: i16) {
        self.point(x, y);
        pass(self.pace);
        self.fake(4, 1, 0, 0);
        pass(self.pace);
        self.fake(5, 1, 0, 0);
        pass(self.pace);
    }

    /// Presses the left button and holds it.
    pub(crate) fn hold(&mut self) {
        self.fake(4, 1, 0, 0);
        pass(self.pace);
    }

    /// Releases the left button.
    pub(crate) fn release_button(&mut self) {
        self.fake(5, 1, 0, 0);
        pass(self.pace);
    }

    /// Presses and releases a key.
    pub(crate) fn press(&mut self, key: u8) {
        self.fake(2, key, 0, 0);
        pass(self.pace);
        self.fake(3, key, 0, 0);
        pass(self.pace);
    }

    /// Presses these keys one after another.
    pub(crate) fn type_text(&mut self, text: &str) {
        text.chars().for_each(|sign| self.press(key::of(sign)));
    }

    /// Types a path, with Shift for capital letters and underscores.
    pub(crate) fn type_path(&mut self, text: &str) {
        for sign in text.chars() {
            match sign {
                '_' => self.press_with(key::SHIFT, key::of('-')),
                'A'..='Z' => self.press_with(key::SHIFT, key::of(sign.to_ascii_lowercase())),
                sign => self.press(key::of(sign)),
            }
        }
    }

    /// Presses or releases a key.
    pub(crate) fn key(&mut self, key: u8, down: bool) {
        self.fake(if down { 2 } else { 3 }, key, 0, 0);
    }

    /// Presses or releases a mouse button (1 left, 2 middle, 3 right, 4 and 5 the wheel).
    pub(crate) fn button(&mut self, button: u8, down: bool) {
        self.fake(if down { 4 } else { 5 }, button, 0, 0);
    }

    /// Presses a key while another one is held down.
    pub(crate) fn press_with(&mut self, held: u8, key: u8) {
        self.fake(2, held, 0, 0);
        pass(self.pace);
        self.press(key);
        self.fake(3, held, 0, 0);
        pass(self.pace);
    }

    /// Gives the window the keyboard focus; there is no window manager that would do it.
    pub(crate) fn focus(&mut self, window: Window) {
        self.connection.tell(42, 2, &words(&[window, 0]));
    }

    /// Takes the keyboard focus away from every window.
    pub(crate) fn leave(&mut self) {
        self.connection.tell(42, 2, &words(&[0, 0]));
    }

    /// Returns the rectangle of the window: left, top, width, height.
    #[track_caller]
    pub(crate) fn place(&mut self, window: Window) -> WindowRect {
        self.connection.place(window).expect("a window")
    }

    /// Asks the window to close, as a click on its close button does.
    pub(crate) fn close(&mut self, window: Window) {
        let (protocols, delete) =
            (self.connection.atom("WM_PROTOCOLS"), self.connection.atom("WM_DELETE_WINDOW"));
        self.connection.message(window, 0, window, protocols, [delete, 0, 0, 0, 0]);
    }

    /// Resizes the window.
    pub(crate) fn resize(&mut self, window: Window, width: u32, height: u32) {
        self.connection.tell(12, 0, &words(&[window, 0b1100, width, height]));
    }

    /// Unmaps the window, as minimizing does, or maps it again.
    pub(crate) fn show(&mut self, window: Window, shown: bool) {
        self.connection.tell(if shown { 8 } else { 10 }, 0, &words(&[window]));
    }

    /// Destroys the window without notifying the program first.
    pub(crate) fn destroy(&mut self, window: Window) {
        self.connection.tell(4, 0, &words(&[window]));
    }

    /// Returns an image of the whole screen.
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

    /// Returns an image of a part of the screen: left, top, width, height.
    pub(crate) fn part(&self, [x, y, width, height]: [u32; 4]) -> RgbaImage {
        image::imageops::crop_imm(&self.picture(), x, y, width, height).to_image()
    }

    /// Saves an image for whoever investigates a failure, and prints its path.
    pub(crate) fn keep(&self, name: &str) {
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
        if self.picture().save(&path).is_ok() {
            eprintln!("the screen at this moment: {}", path.display());
        }
    }

    fn fake(&mut self, kind: u8, detail: u8, x: i16, y: i16) {
        let mut body = vec![kind, detail, 0, 0];
        body.extend(words(&[0, self.connection.root, 0, 0]));
        body.extend(x.to_le_bytes());
        body.extend(y.to_le_bytes());
        body.extend([0; 8]);
        self.connection.tell(self.test_extension, 2, &body);
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

/// Sleeps, for tests in which elapsed time itself matters.
pub(crate) fn pass(time: Duration) {
    let end = Instant::now() + time;
    while let Some(left) = end.checked_duration_since(Instant::now()) {
        std::thread::park_timeout(left);
    }
}
