//! An editor's threads over one document: with messages, and with locks.

pub mod cases;
pub mod cores;
pub mod document;
pub mod frame;
pub mod graphics;
pub mod hand;
pub mod ledger;
pub mod locks;
pub mod messages;
pub mod model;
pub mod scenario;
pub mod script;
pub mod sharing;
pub mod swap;
pub mod table;
pub mod triple;

pub use cases::all;
