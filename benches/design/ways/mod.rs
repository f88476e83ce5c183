//! Other ways to send the same: messages named at every call, and closures. Only what differs from [`messages`] is here.
//!
//! [`messages`]: super::messages

mod closures;
mod raw;

pub use closures::{Change, ClosureDocument, ClosureHandle, ClosurePanel};
pub use raw::RawPanel;
