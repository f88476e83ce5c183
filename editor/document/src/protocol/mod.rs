//! The editor as a service: one JSON object per line in, one per line out.
//!
//! | request | effect |
//! |---|---|
//! | `{"edit": …}` | applies an edit ([`crate::edit`]) as a step |
//! | `{"do": "edit", "edit": {…}, "gesture": 7}` | applies an edit that replaces the one before of its gesture |
//! | `{"do": "cancel", "gesture": 7}` | cancels a gesture |
//! | `{"do": "undo"}`, `{"do": "redo"}`, `{"do": "go_to", "steps": 3}` | undoes or redoes steps |
//! | `{"do": "settle_edits", "choice": "apply"}`, or `"remove"` | applies edits that a project keeps and that were made for other files, or removes them |
//! | `{"do": "plan"}` | returns what a save would change |
//! | `{"do": "save"}`, `{"do": "save", "to": "Fox2.glb"}` | saves |
//! | `{"query": "takes"}`, `{"query": "schedule"}` … | reads; see [`Query`] |
//!
//! The answer is `{"ok": …}` or `{"error": "…"}`; an error changes nothing. The value of `"id"` is returned with the
//! answer. A session ends with the input.

mod query;
mod request;
mod scene_answers;
mod session;

pub use query::Query;
pub use request::{ProtocolCommand, ProtocolRequest};
pub use session::Session;
