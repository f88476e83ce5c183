//! Other ways to send the same edits: messages without handles, and closures. Contains only the differences from
//! [`messages`].
//!
//! [`messages`]: super::messages

mod closures;
mod raw;

pub use closures::{BoneChange, ClosureDocument, ClosureHandle, ClosurePanel};
pub use raw::RawPanel;
