//! Compressed takes.

mod bits;
mod compress;
mod encode;
mod error;
mod frames;
mod grid;
mod kernel;
mod metric;
mod plan;
mod points;
mod read;
mod settings;
mod slerp;
mod stored;
mod table;
mod take;
mod track;
mod whole;
mod write;

pub use compress::{Bytes, Report, compress};
pub use error::{CompressError, FormatError};
pub use metric::LargestError;
pub use settings::{Exactness, Settings};
pub use take::CompressedTake;

/// The first bytes of a compressed take.
pub const MAGIC: [u8; 4] = *b"DfCt";
/// The version that is written, and the only one that is read.
pub const VERSION: u16 = 1;
/// Most bones of a compressed take.
pub const MAX_BONES: usize = 1 << 16;
/// Most keys of a compressed take: nine hours at thirty a second.
pub const MAX_FRAMES: usize = 1 << 20;
/// Most values of a compressed take: keys times channels that move; and, when one is made, keys times all channels.
pub const MAX_VALUES: usize = 1 << 26;
/// Most bytes of a compressed take.
pub const MAX_BYTES: usize = 1 << 28;
