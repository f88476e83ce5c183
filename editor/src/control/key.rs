//! Keys as controls know them: what is written on them, not where they are.

use super::base::ControlId;
use dragonfly_document::bones::Choice;

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

/// Keys held at once that are remembered with who heard of them; hands have ten fingers.
pub(super) const HELD_KEYS: usize = 16;

/// Which keys are held, and which control was told: it is told of the end too.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HeldKeys {
    keys: [Option<(Key, ControlId)>; HELD_KEYS],
}

impl HeldKeys {
    /// Who was told of a key that is held.
    pub(super) fn find(&self, key: Key) -> Option<ControlId> {
        self.keys.iter().flatten().find(|held| held.0 == key).map(|held| held.1)
    }

    /// The key is let go.
    pub(super) fn take(&mut self, key: Key) -> Option<ControlId> {
        let held = self.keys.iter_mut().find(|held| held.is_some_and(|held| held.0 == key))?;
        held.take().map(|held| held.1)
    }

    /// Any that is held.
    pub(super) fn first(&self) -> Option<Key> {
        self.keys.iter().flatten().next().map(|held| held.0)
    }

    /// With no room for another: the one that has to be let go.
    pub(super) fn full(&self) -> Option<Key> {
        self.first().filter(|_| !self.keys.contains(&None))
    }

    /// The key is held; without room it is not remembered.
    pub(super) fn put(&mut self, key: Key, control: ControlId) {
        if let Some(free) = self.keys.iter_mut().find(|held| held.is_none()) {
            *free = Some((key, control));
        }
    }

    /// A control is gone: its parent hears the end of what was passed on to it.
    pub(super) fn hand_on(&mut self, from: ControlId, to: Option<ControlId>) {
        for held in self.keys.iter_mut().filter(|held| held.is_some_and(|held| held.1 == from)) {
            *held = held.zip(to).map(|((key, _), to)| (key, to));
        }
    }
}
