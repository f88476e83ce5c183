//! Cost in source code: the same program written with messages and with locks.
//!
//! A tiny editor (a panel in the main thread, a viewport in the graphics thread, a skeleton between them) is written
//! with [`messages`] and with [`locks`]. Then both get the same feature: bones have a color and can be hidden. Its
//! lines are marked `// feature`, so that [`count`] can count its cost, and so that the build script can build the
//! editors without it; the tests run both versions.
//!
//! The types have the names of the editor's types that they stand for (`Document`, `Panel`, `Edit`, `Bone`), and the
//! two designs use the same names, so that they can be compared.

pub mod count;
pub mod locks;
pub mod messages;
pub mod skeleton;
pub mod tables;
pub mod ways;

use count::{Cost, SourceFile};

/// The data and the drawing of both editors, without threads.
pub const SAME: &[SourceFile] = &[("skeleton.rs", include_str!("skeleton.rs"))];

/// The editor with messages.
pub const MESSAGES: &[SourceFile] = &[
    ("messages/mod.rs", include_str!("messages/mod.rs")),
    EDITS,
    ("messages/viewport.rs", include_str!("messages/viewport.rs")),
    ("messages/panel.rs", include_str!("messages/panel.rs")),
    ("messages/handles.rs", include_str!("messages/handles.rs")),
];

/// The part of [`MESSAGES`] that defines edits as values and applies them.
pub const EDITS: SourceFile = ("messages/document.rs", include_str!("messages/document.rs"));

/// The panel that sends messages itself, without handles.
pub const RAW: SourceFile = ("ways/raw.rs", include_str!("ways/raw.rs"));

/// The document and the panel with closures as messages.
pub const CLOSURES: SourceFile = ("ways/closures.rs", include_str!("ways/closures.rs"));

/// The editor with locks.
pub const LOCKS: &[SourceFile] = &[
    ("locks/mod.rs", include_str!("locks/mod.rs")),
    ("locks/viewport.rs", include_str!("locks/viewport.rs")),
    ("locks/panel.rs", include_str!("locks/panel.rs")),
];

/// Cost of the feature in each design.
pub struct Costs {
    /// The data and its drawing, which all designs share; not included in the others.
    pub same: Cost,
    /// Messages sent through typed handles; covers the whole editor.
    pub messages: Cost,
    /// The part of `messages` that defines edits as values.
    pub edits: Cost,
    /// Messages without handles; covers the feature, not the whole editor.
    pub raw: Cost,
    /// Closures as messages; covers the feature, not the whole editor.
    pub closures: Cost,
    /// One lock; covers the whole editor.
    pub locks: Cost,
}

/// Counts the cost in all designs.
pub fn costs() -> Costs {
    Costs {
        same: count::cost(SAME),
        messages: count::cost(MESSAGES),
        edits: count::cost(&[EDITS]),
        raw: count::cost(&[EDITS, RAW]),
        closures: count::cost(&[CLOSURES]),
        locks: count::cost(LOCKS),
    }
}

/// Returns the name, the mistakes that do not compile, and those that compile, for each design. Each mistake is an
/// example or a test in a file of the design.
pub fn mistakes() -> [(&'static str, Vec<&'static str>, Vec<String>); 2] {
    [
        (
            "messages",
            count::refused(include_str!("messages/refused.rs")),
            count::traps(include_str!("messages/traps.rs")),
        ),
        (
            "locks",
            count::refused(include_str!("locks/refused.rs")),
            count::traps(include_str!("locks/traps.rs")),
        ),
    ]
}

#[cfg(test)]
mod measured;

/// Both editors as they were before the feature.
#[cfg(test)]
#[allow(dead_code, missing_docs, unused_imports, unused_mut, unreachable_pub)]
mod before {
    include!(concat!(env!("OUT_DIR"), "/before.rs"));
}
