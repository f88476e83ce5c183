//! stub
pub(super) fn names() -> Vec<String> { Vec::new() }
