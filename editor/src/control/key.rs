//! Keys of the keyboard, identified by their labels, not by their positions.

use super::area::ControlId;
use dragonfly_document::bones::Choice;

/// A key of the keyboard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Key {
    /// A key that types a character; letters in lower case, see [`Key::letter`].
    Letter(char),
    /// Either Enter key.
    Enter,
    /// Escape.
    Escape,
    /// Tab.
    Tab,
    /// Backspace.
    Backspace,
    /// Delete.
    Delete,
    /// Arrow left.
    Left,
    /// Arrow right.
    Right,
    /// Arrow up.
    Up,
    /// Arrow down.
    Down,
    /// Any other key, by a number that the window assigned to it.
    Other(u32),
}

impl Key {
    /// Returns the key that types `letter`, with or without Shift.
    pub fn letter(letter: char) -> Self {
        Self::Letter(letter.to_lowercase().next().unwrap_or(letter))
    }
}

/// Modifier keys that are held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modifiers {
    /// Whether Shift is held.
    pub shift: bool,
    /// Whether Ctrl, or Command on a Mac, is held.
    pub ctrl: bool,
    /// Whether Alt is held.
    pub alt: bool,
}

/// Shift adds to a selection, Ctrl toggles.
impl From<Modifiers> for Choice {
    fn from(modifiers: Modifiers) -> Self {
        match modifiers {
            Modifiers { ctrl: true, .. } => Self::Toggle,
            Modifiers { shift: true, .. } => Self::Add,
            Modifiers { .. } => Self::Replace,
        }
    }
}

/// Largest number of held keys that are remembered, with the controls that got them; a user has ten fingers.
pub(super) const HELD_KEYS: usize = 16;

/// The held keys, each with the control that got the press and will get the release.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HeldKeys {
    keys: [Option<(Key, ControlId)>; HELD_KEYS],
}

impl HeldKeys {
    /// Returns the control that got a held key.
    pub(super) fn find(&self, key: Key) -> Option<ControlId> {
        self.keys.iter().flatten().find(|held| held.0 == key).map(|held| held.1)
    }

    /// Removes a key that was released, and returns its control.
    pub(super) fn take(&mut self, key: Key) -> Option<ControlId> {
        let held = self.keys.iter_mut().find(|held| held.is_some_and(|held| held.0 == key))?;
        held.take().map(|held| held.1)
    }

    /// Returns any held key.
    pub(super) fn first(&self) -> Option<Key> {
        self.keys.iter().flatten().next().map(|held| held.0)
    }

    /// Returns the key to release if there is no space for another.
    pub(super) fn full(&self) -> Option<Key> {
        self.first().filter(|_| !self.keys.contains(&None))
    }

    /// Adds a held key; without space it is not remembered.
    pub(super) fn put(&mut self, key: Key, control: ControlId) {
        if let Some(free) = self.keys.iter_mut().find(|held| held.is_none()) {
            *free = Some((key, control));
        }
    }

    /// A control was unregistered: its parent gets the releases.
    pub(super) fn pass_on(&mut self, from: ControlId, to: Option<ControlId>) {
        for held in self.keys.iter_mut().filter(|held| held.is_some_and(|held| held.1 == from)) {
            *held = held.zip(to).map(|((key, _), to)| (key, to));
        }
    }
}
