//! The id of a command.

use std::fmt;

/// The id of a command. Each row of the table declares one, as a constant with the name of the command: [`Id::Open`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(&'static str);

impl Id {
    /// Returns the id with this name; only rows of the table call it.
    pub(super) const fn new(name: &'static str) -> Self {
        Self(name)
    }

    /// Returns its name in settings; never changes.
    pub fn name(self) -> &'static str {
        self.0
    }
}

impl fmt::Debug for Id {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}
