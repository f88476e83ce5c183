//! Compressed takes: a take in few bytes, from which any time can be sampled directly.
//!
//! [`compress`] makes one from a take, with a [`CompressionReport`]; [`CompressedTake`] plays it, reads and writes its
//! bytes, and decompresses it to an ordinary take.
//!
//! ```
//! use dragonfly_anim::compressed::{CompressedTake, Exactness, CompressionSettings, compress};
//! use dragonfly_anim::fast::Pose;
//! # use dragonfly_anim::data::{Skeleton, Take};
//! # let (take, skeleton) = (Take::default(), Skeleton::default());
//!
//! // No point 10 cm from a bone may move by more than 1 mm.
//! let settings = CompressionSettings { everywhere: Exactness::COARSE, ..CompressionSettings::default() };
//! let (compressed, report) = compress(&take, &skeleton, &settings)?;
//! assert!(report.share_of_tolerance <= 1.0);
//!
//! let copy = CompressedTake::from_bytes(compressed.as_bytes())?;
//! let mut pose = Pose::new(copy.bones());
//! copy.sample(0.7, &mut pose);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The error bound
//!
//! Three points are at the shell distance `d` from each bone along its axes. At every key time:
//!
//! ```text
//! | to_root_raw * (d a)  -  to_root_decoded * (d a) |  <=  tolerance        a = x, y, z;  every bone
//! ```
//!
//! Measured in scene space on the decoded bytes before they are returned. ACL (Animation Compression Library) measures
//! the same three points. Between keys both takes are sampled in the same way: rotations by slerp, the rest linearly.
//!
//! A rotation is encoded relative to the parents as they will be *decoded*: it moves the points of its bone towards
//! their positions in the raw take, so the next joint corrects the error of its parent and errors do not add up down
//! the chain. The poses of single bones relative to their parents therefore differ a little more than to-root poses do.
//!
//! # How the size is reduced
//!
//! * A channel that is constant within a tenth of the tolerance is stored once; a channel that is constant at the
//!   default is not stored at all.
//! * A rotation is stored relative to the middle one of its bone, without w, which then is never near zero. So none of
//!   the other three is special, and the one about the bone's own axis can have fewer bits.
//! * The range of each component is reduced for the take and again for each segment of 16 to 256 keys.
//! * Each component has its own number of bits in each segment: the smallest with which all points of the bone are
//!   within the tolerance. Where rounding to the nearest number exceeds the tolerance, the neighboring numbers are
//!   tried.
//! * Several segment sizes and shares of the tolerance for joints are tried. The result with the fewest bytes is
//!   kept, where a byte of tables counts a quarter.
//!
//! Channels that cannot be packed like this (a bone that turns all the way round, a range too large for 22 bits) are
//! stored whole: 8 bytes per key for a rotation, 12 for a vector.
//!
//! # How a pose is decoded
//!
//! Every key is independent of the others, so any time needs only two keys. Eight tracks are decoded at once. Each of
//! their numbers is in one of two words of four bytes; a shuffle moves the words of eight lanes into place, a mask
//! extracts a number, a conversion and a fused multiply-add make the component from it. Each lane has its own widths;
//! the positions of its numbers are in tables that are built when the bytes are read: start, step and masks for each
//! segment. A whole character needs one lookup of the keys and no search.
//!
//! Numbers so wide that the numbers of eight lanes occupy more than sixteen bytes per half, or that two of them occupy
//! more than 31 bits, are gathered one by one: about 45 additional instructions for eight bones.
//!
//! # Layout, version 2
//!
//! Little-endian; bits from the lowest on.
//!
//! | content | size |
//! |---|---|
//! | `DfCt`, version, zero | 4 + 2 + 2 bytes |
//! | total length, CRC-32 of everything from byte 16 on | 4 + 4 bytes |
//! | byte after the last key, where the description starts | 4 bytes |
//! | whole tracks, key after key | 8 or 12 bytes a key |
//! | of each segment, of each key: all packed tracks, x, y, z | their widths, then padded to a whole byte |
//! | *description:* start, length (s), keys, bones | 4 × 32 bits |
//! | segment size as a power of two, widths of constants | 3 × 8 bits |
//! | step of constant translations | 32 bits |
//! | name: length, bytes | 8 + 8 n bits |
//! | storage: default 0, constant 1, packed 2, whole 3; rotation, translation, scale | 6 bits a bone |
//! | constants, bone after bone | their widths |
//! | of each packed track: middle rotation (32 bits) and range (96 bits), or range (192 bits) | |
//! | of each segment and packed track, for x, y, z: place, extent, bits; of the only segment: bits | 8 + 8 + 5 bits |
//! | *next whole byte* zeros, until 32 bytes follow the last key | |
//!
//! Whole tracks: all rotations in bone order, then translations, then scales. Packed tracks have the same order, but
//! the tracks of some blocks (bones 8 i to 8 i + 7) come last among those of their property, again in bone order: those
//! of the `k` blocks with fewest packed tracks (of equals the first), where `k` is the smallest number that minimizes
//!
//! ```text
//! g (other blocks with packed tracks + tracks of the k blocks / 8, rounded up) + l (tracks of the k blocks)
//! g = 138, l = 15 for rotations;  g = 85, l = 12 for vectors
//! ```
//!
//! With the number `n` of a key:
//!
//! ```text
//! value = start + step n        start = low + extent (256 place + ext) / 65535
//!                               step = extent ext / 255 / (2^bits - 1), rounded up to the 16 highest bits of a float
//! ```
//!
//! If a take has only one segment, place is 0 and ext is 255; for a component without bits, they are 127 and 255.
//!
//! # Figures
//!
//! `README.md` of this crate has bytes and errors next to those of ACL and ozz-animation, and the time and instructions
//! per bone; its tables are made from what `cargo bench -p dragonfly-anim -- --record` measured.
//! [`CompressedTake::bytes_in_memory`] includes the tables that decoding needs. Sampling costs the same at every time.
//!
//! A version that stored every second key as its difference to the middle of its neighbors needed slightly fewer bytes,
//! but three keys per pose, and about twice the instructions per bone.
//!
//! Morph weights are not compressed and not kept ([`CompressionReport::morphs_left_out`] counts their tracks).

mod bits;
mod clock;
mod compress;
mod encode;
mod error;
mod extents;
mod frames;
mod grid;
mod head;
mod kernel;
mod lane_groups;
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

pub use compress::{CompressionReport, compress};
pub use error::{CompressError, FormatError};
pub use extents::ByteSizes;
pub use metric::LargestError;
pub use settings::{CompressionSettings, Exactness};
pub use take::CompressedTake;

/// Magic number: the first bytes of a compressed take.
pub const MAGIC: [u8; 4] = *b"DfCt";
/// Version that is written, and the only one that is read.
pub const VERSION: u16 = 2;
/// Largest number of bones of a compressed take.
pub const MAX_BONES: usize = 1 << 16;
/// Largest number of keys of a compressed take: nine hours at thirty per second.
pub const MAX_FRAMES: usize = 1 << 20;
/// Largest number of values of a compressed take: keys times channels that move; and, during compression, keys times
/// all channels.
pub const MAX_VALUES: usize = 1 << 26;
/// Largest size of a compressed take in bytes.
pub const MAX_BYTES: usize = 1 << 28;
