//! JSON as bytes with places: the range of every value, and patches that replace ranges.
//!
//! Nothing here converts a whole text to data and back. [`tree`] finds the range of every value and member, [`token`]
//! reads single tokens, [`patch`] replaces ranges, [`list`] adds and removes elements and members, [`style`] formats
//! new ones like their neighbors.

pub(super) mod list;
pub(super) mod patch;
pub(super) mod style;
pub(super) mod token;
pub(super) mod tree;
