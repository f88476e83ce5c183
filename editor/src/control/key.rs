//! Keys as controls know them: what is written on them, not where they are.

/// A key of the keyboard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Key {
    /// A key that writes something; letters in lower case, see [`Key::letter`].
    Letter(char),
    /// The large one, or the one of the number pad.
    Enter,
    /// Takes back.
    Escape,
    /// Goes on to the next.
    Tab,
    /// Takes the last letter away.
    Backspace,
    /// Takes away.
    Delete,
    /// Arrow.
    Left,
    /// Arrow.
    Right,
    /// Arrow.
    Up,
    /// Arrow.
    Down,
    /// Any other, by a number that whoever hears of it gave it.
    Other(u32),
}

impl Key {
    /// The key that writes `letter`, which Shift does not change.
    pub fn letter(letter: char) -> Self {
        Self::Letter(letter.to_lowercase().next().unwrap_or(letter))
    }
}

/// Keys that change what others mean, as they are held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modifiers {
    /// Is Shift held?
    pub shift: bool,
    /// Is Ctrl held? On a Mac: Command.
    pub ctrl: bool,
    /// Is Alt held?
    pub alt: bool,
}
