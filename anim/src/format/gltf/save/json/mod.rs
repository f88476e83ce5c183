//! JSON as bytes with places: which bytes are which value, and how to exchange some of them for others.
//!
//! Nothing here turns a text into data and back. [`tree`] says where every value and member lies, [`token`] reads
//! single tokens, [`patch`] exchanges spans, [`list`] adds and removes elements and members, [`style`] writes new
//! ones the way their neighbours are written.

pub(super) mod list;
pub(super) mod patch;
pub(super) mod style;
pub(super) mod token;
pub(super) mod tree;
