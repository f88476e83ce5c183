//! For a text that someone is writing: its parts for colors, and what may be written at the cursor. Both read broken texts as well.

mod completion;
mod cursor;
mod names;
mod tokens;

pub use completion::{CompletionItem, CompletionKind, CompletionNames, Completions, completions};
pub use tokens::{ScriptToken, TokenKind, tokens};
