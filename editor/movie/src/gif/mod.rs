//! Parts of animated GIF: one palette for the whole movie, and pixels of it in an order that does not change with time.

pub(crate) mod dither;
pub(crate) mod histogram;
pub(crate) mod palette;
pub(crate) mod pictures;
