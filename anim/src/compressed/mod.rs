//! Compressed takes: a take in few bytes, from which any time can be sampled directly.
//!
//! [`compress`] makes one from a take, with a [`Report`]; [`CompressedTake`] plays it, reads and writes its bytes, and
//! gives an ordinary take back.
//!
//! ```
//! use dragonfly_anim::compressed::{CompressedTake, Exactness, Settings, compress};
//! use dragonfly_anim::fast::Pose;
//! # use dragonfly_anim::data::{Skeleton, Take};
//! # let (take, skeleton) = (Take::default(), Skeleton::default());
//!
//! // No point 10 cm off a bone may be farther than 1 mm from where it was.
//! let settings = Settings { everywhere: Exactness::COARSE, ..Settings::default() };
//! let (compressed, report) = compress(&take, &skeleton, &settings)?;
//! assert!(report.share_of_tolerance <= 1.0);
//!
//! let back = CompressedTake::from_bytes(compressed.as_bytes())?;
//! let mut pose = Pose::new(back.bones());
//! back.sample(0.7, &mut pose);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The error that is kept
//!
//! Three points stand off each bone, at the shell distance `d` along its axes. At every key time:
//!
//! ```text
//! | to_root_raw * (d a)  -  to_root_decoded * (d a) |  <=  tolerance        a = x, y, z;  every bone
//! ```
//!
//! Measured in scene space on the decoded bytes before they are returned. ACL (Animation Compression Library) measures
//! the same three points. Between keys both takes are sampled alike: rotations slerped, the rest mixed.
//!
//! A rotation is coded against the parents as they will be *decoded*: it aims the points of its bone to where the raw
//! take has them, so what a parent did wrong is taken back at the next joint and errors do not add up down the chain.
//! The poses of single bones relative to their parents therefore differ a little more than to-root poses do.
//!
//! # How the bytes become few
//!
//! * What stands still within a tenth of the tolerance is stored once; what stands still in the default, not at all.
//! * A rotation is stored relative to the middle one of its bone, without w, which then is never near zero. So none of
//!   the other three is singled out, and the one about the bone's own axis can have fewer bits.
//! * The range of each component is reduced for the take and again for each segment of 16 to 256 keys.
//! * Each component has its own number of bits in each segment: the fewest with which all points of the bone are near
//!   enough. Where the nearest number is not, its neighbours are tried.
//! * Segment size and the shares of the tolerance that joints may use up are tried. The result with the fewest bytes is
//!   kept, where a byte of tables counts a quarter.
//!
//! What cannot be had this way (a bone that turns all the way round, a range too large for 22 bits) is stored whole: 8
//! bytes a key for a rotation, 12 for a vector.
//!
//! # How a pose is made
//!
//! Every key stands for itself, so any time needs two keys and no other. Eight tracks are decoded at once. Each of their
//! numbers lies in one of two words of four bytes; a shuffle brings the words of eight lanes into place, a mask takes a
//! number out, a conversion and a fused multiplication make the component of it. Each lane has its own widths; where its
//! numbers lie is looked up in tables, which are made when the bytes are read: start, step and masks for each segment. A
//! whole character costs one lookup of the keys and no search.
//!
//! Numbers so wide that eight lanes see more than sixteen bytes in a half, or two of them more than 31 bits, are gathered
//! one by one: about 45 instructions more for eight bones.
//!
//! # Layout, version 2
//!
//! Little-endian; bits from the lowest on.
//!
//! | what | size |
//! |---|---|
//! | `DfCt`, version, zero | 4 + 2 + 2 bytes |
//! | length of all, CRC-32 of all from byte 16 on | 4 + 4 bytes |
//! | byte after the last key, where the description begins | 4 bytes |
//! | whole tracks, key after key | 8 or 12 bytes a key |
//! | of each segment, of each key: all packed tracks, x, y, z | as wide as they must be, then to a whole byte |
//! | *description:* start, length (s), keys, bones | 4 × 32 bits |
//! | segment size as a power of two, widths of constants | 3 × 8 bits |
//! | step of constant translations | 32 bits |
//! | name: length, bytes | 8 + 8 n bits |
//! | kinds: default 0, constant 1, packed 2, whole 3; rotation, translation, scale | 6 bits a bone |
//! | constants, bone after bone | as wide as they must be |
//! | of each packed track: middle rotation (32 bits) and range (96 bits), or range (192 bits) | |
//! | of each segment and packed track, for x, y, z: place, extent, bits; of the only segment: bits | 8 + 8 + 5 bits |
//! | *next whole byte* zeros, until 32 bytes follow the last key | |
//!
//! Whole tracks: all rotations in bone order, then translations, then scales. Packed tracks likewise, but the tracks of
//! some blocks (bones 8 i to 8 i + 7) come last of their part, again in bone order: those of the `k` blocks with fewest
//! packed tracks (of equals the first), where `k` is the smallest number that makes this smallest:
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
//! In the only segment of a take place is 0 and ext 255; with no bits, 127 and 255.
//!
//! # Figures
//!
//! `README.md` of this crate has bytes and errors next to those of ACL and ozz-animation, and the time and instructions
//! per bone; its tables are made from what `cargo bench -p dragonfly-anim -- --record` measured.
//! [`CompressedTake::bytes_in_memory`] includes the tables that decoding needs. Any time costs the same.
//!
//! A version that stored every second key as its difference to the middle of its neighbors needed slightly fewer bytes,
//! but three keys per pose, and about twice the instructions per bone.
//!
//! Not kept: morph weights ([`Report::morphs_left_out`]).

mod arrange;
mod bits;
mod compress;
mod encode;
mod error;
mod frames;
mod grid;
mod head;
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
pub const VERSION: u16 = 2;
/// Most bones of a compressed take.
pub const MAX_BONES: usize = 1 << 16;
/// Most keys of a compressed take: nine hours at thirty a second.
pub const MAX_FRAMES: usize = 1 << 20;
/// Most values of a compressed take: keys times channels that move; and, when one is made, keys times all channels.
pub const MAX_VALUES: usize = 1 << 26;
/// Most bytes of a compressed take.
pub const MAX_BYTES: usize = 1 << 28;
