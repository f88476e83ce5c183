//! The other cost: what it takes to write the same thing with messages and with locks.
//!
//! A tiny editor (a panel in the main thread, a viewport in the graphics thread, a skeleton between them) is written
//! [`messages`] first and [`locks`] second. Then both get the same feature: bones have a color and can be hidden. Its
//! lines are marked `// feature`, so that [`count`] can tell what it cost, and so that the editors can be built without
//! it: the build script does that, and the tests run both.

pub mod count;
pub mod locks;
pub mod messages;
pub mod skeleton;
pub mod tables;
pub mod ways;

use count::{Cost, Source};

/// The data and the drawing of both, which know no thread.
pub const SAME: &[Source] = &[("skeleton.rs", include_str!("skeleton.rs"))];

/// The editor with messages.
pub const MESSAGES: &[Source] = &[
    ("messages/mod.rs", include_str!("messages/mod.rs")),
    EDITS,
    ("messages/viewport.rs", include_str!("messages/viewport.rs")),
    ("messages/panel.rs", include_str!("messages/panel.rs")),
    ("messages/handles.rs", include_str!("messages/handles.rs")),
];

/// The part of it that makes values of edits, and takes them in.
pub const EDITS: Source = ("messages/document.rs", include_str!("messages/document.rs"));

/// The panel that names messages at every call, in place of handles.
pub const RAW: Source = ("ways/raw.rs", include_str!("ways/raw.rs"));

/// The document and the panel that have closures for messages.
pub const CLOSURES: Source = ("ways/closures.rs", include_str!("ways/closures.rs"));

/// The editor with locks.
pub const LOCKS: &[Source] = &[
    ("locks/mod.rs", include_str!("locks/mod.rs")),
    ("locks/viewport.rs", include_str!("locks/viewport.rs")),
    ("locks/panel.rs", include_str!("locks/panel.rs")),
];

/// What the feature cost in each way of writing it.
pub struct Costs {
    /// The data and its drawing, the same in all ways and counted in none of the others.
    pub same: Cost,
    /// Messages behind typed handles: the whole editor.
    pub messages: Cost,
    /// The part of it that makes values of edits.
    pub edits: Cost,
    /// Messages named at every call: what the feature cost, not the whole editor.
    pub raw: Cost,
    /// Closures for messages: what the feature cost, not the whole editor.
    pub closures: Cost,
    /// One lock: the whole editor.
    pub locks: Cost,
}

/// Counts them all.
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

/// Mistakes of each way that do not compile, and those that do; each is an example or a test in the named file.
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
