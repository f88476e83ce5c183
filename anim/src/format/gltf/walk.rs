//! A walk over a JSON text, value by value, that knows its position and needs neither recursion nor much memory.
//!
//! It does not validate the text, which the parser does afterwards, but it never panics or loops on an invalid one. On
//! a valid text it finds the same values as the parser.

/// Result of one step of the walk; [`Walk::pointer`] returns its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WalkStep {
    /// `[` or `{`
    Open,
    /// `]` or `}`; the frame that it closes is still the innermost one.
    Close,
    /// The name of a member; its value is next.
    Key,
    /// A string, a number, `true`, `false` or `null`; the range of its bytes.
    Scalar(usize, usize),
}

/// An enclosing array or object.
#[derive(Clone, Copy, Debug)]
pub(super) struct WalkFrame {
    pub(super) is_array: bool,
    /// Number of values started.
    pub(super) count: usize,
    /// Range of the name of the member, without the quotes.
    key: (usize, usize),
    expects_key: bool,
    /// For use by the caller.
    pub(super) note: usize,
}

/// A walk in progress.
pub(super) struct Walk<'a> {
    text: &'a [u8],
    at: usize,
    frames: Vec<WalkFrame>,
    /// The innermost frame is removed with the next step.
    closing: bool,
}

impl<'a> Walk<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { text, at: 0, frames: Vec::new(), closing: false }
    }

    /// Returns the number of bytes walked over.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Returns the enclosing arrays and objects, innermost last. After [`WalkStep::Open`] and [`WalkStep::Close`] the
    /// array or object that was just opened or closed is included.
    pub(super) fn frames(&mut self) -> &mut [WalkFrame] {
        &mut self.frames
    }

    /// Returns the name of the current member in the frame `depth`; empty in an array.
    pub(super) fn key(&self, depth: usize) -> &'a [u8] {
        match self.frames.get(depth) {
            Some(frame) if !frame.is_array => &self.text[frame.key.0..frame.key.1],
            _ => b"",
        }
    }

    /// Returns the next step; `None` at the end of the text, or where it is invalid.
    pub(super) fn step(&mut self) -> Option<WalkStep> {
        if std::mem::take(&mut self.closing) {
            self.frames.pop();
        }
        loop {
            let byte = *self.text.get(self.at)?;
            match byte {
                b' ' | b'\t' | b'\n' | b'\r' | b':' => self.at += 1,
                b',' => {
                    self.at += 1;
                    if let Some(frame) = self.frames.last_mut() {
                        frame.expects_key = !frame.is_array;
                    }
                }
                b'[' | b'{' => return Some(self.open(byte == b'[')),
                b']' | b'}' => {
                    self.at += 1;
                    self.frames.last()?;
                    self.closing = true;
                    return Some(WalkStep::Close);
                }
                b'"' => return self.string(),
                _ => return Some(self.word()),
            }
        }
    }

    fn open(&mut self, is_array: bool) -> WalkStep {
        self.value_begins();
        self.at += 1;
        self.frames.push(WalkFrame { is_array, count: 0, key: (0, 0), expects_key: !is_array, note: 0 });
        WalkStep::Open
    }

    fn string(&mut self) -> Option<WalkStep> {
        let from = self.at;
        let mut to = from + 1;
        loop {
            match *self.text.get(to)? {
                b'"' => break,
                b'\\' => to += 2,
                _ => to += 1,
            }
        }
        self.at = to + 1;
        if let Some(frame) = self.frames.last_mut()
            && frame.expects_key
        {
            frame.key = (from + 1, to);
            frame.expects_key = false;
            return Some(WalkStep::Key);
        }
        self.value_begins();
        Some(WalkStep::Scalar(from, self.at))
    }

    fn word(&mut self) -> WalkStep {
        let from = self.at;
        let ends = |byte: &u8| {
            matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | b',' | b':' | b'[' | b']' | b'{' | b'}' | b'"')
        };
        self.at = self.text[from..].iter().position(ends).map_or(self.text.len(), |length| from + length);
        self.value_begins();
        WalkStep::Scalar(from, self.at)
    }

    fn value_begins(&mut self) {
        if let Some(frame) = self.frames.last_mut() {
            frame.count += 1;
        }
    }

    /// Returns the place of the last step as a JSON pointer.
    ///
    /// `outside` removes that many innermost frames: 1 refers to the array or object that was just opened or closed.
    pub(super) fn pointer(&self, outside: usize) -> String {
        let mut pointer = String::new();
        for frame in &self.frames[..self.frames.len().saturating_sub(outside)] {
            pointer.push('/');
            if frame.is_array {
                pointer.push_str(&frame.count.saturating_sub(1).to_string());
            } else {
                let key = String::from_utf8_lossy(&self.text[frame.key.0..frame.key.1]);
                pointer.push_str(&key.replace('~', "~0").replace('/', "~1"));
            }
        }
        pointer
    }
}

/// Returns the pointer to the innermost value that the byte before `end` belongs to.
pub(super) fn pointer_before(text: &[u8], end: usize) -> String {
    let mut walk = Walk::new(text);
    let mut pointer = String::new();
    while let Some(step) = walk.step() {
        if walk.at() >= end {
            pointer = walk.pointer(usize::from(matches!(step, WalkStep::Open | WalkStep::Close)));
            break;
        }
    }
    pointer
}
