//! The editor as a conversation: one JSON object a line in, one a line out.
//!
//! | a line in | does |
//! |---|---|
//! | `{"edit": …}` | an edit ([`crate::edit`]), as a step of its own |
//! | `{"do": "edit", "edit": {…}, "gesture": 7}` | the newest form of a gesture |
//! | `{"do": "cancel", "gesture": 7}` | the gesture as if it had never begun |
//! | `{"do": "undo"}`, `{"do": "redo"}`, `{"do": "go_to", "steps": 3}` | goes through the history |
//! | `{"do": "plan"}` | what a save would change |
//! | `{"do": "save"}`, `{"do": "save", "to": "Fox2.glb"}` | saves |
//! | `{"query": "takes"}` … | reads; see [`Query`] |
//!
//! The answer is `{"ok": …}` or `{"error": "…"}`, and an error changes nothing. Whatever stands in `"id"` comes back
//! with the answer. A conversation ends with the input.

mod query;
mod request;
mod session;

pub use query::Query;
pub use request::{ProtocolCommand, ProtocolRequest};
pub use session::Session;
