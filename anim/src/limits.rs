//! How much an imported file may ask for. Every figure is shown in the error that names it.
//!
//! The figures are far above what real models need and far below what harms the machine.

/// Bytes of one file, main or external.
pub const FILE_BYTES: u64 = 2 << 30;

/// Working memory that any file may use, however small it is.
pub const MEMORY_BASE: u64 = 256 << 20;

/// Working memory granted on top for each byte read.
pub const MEMORY_PER_BYTE: u64 = 32;

/// Working memory that no file exceeds, however large it is.
pub const MEMORY_MAX: u64 = 2 << 30;

/// Arrays and objects inside each other in a JSON text.
pub const JSON_DEPTH: usize = 64;

/// Nodes of a scene.
pub const NODES: usize = 1_000_000;

/// Nodes above each other in a scene, the root counted.
pub const NODE_DEPTH: usize = 512;

/// Joints of one skin; a vertex names them with 16 bits.
pub const JOINTS_PER_SKIN: usize = 65_535;

/// Vertices of one primitive, and of all.
pub const VERTICES: usize = 50_000_000;

/// Elements of an accessor that names no bytes (all zero), unless the file is larger than this.
pub const ZERO_ELEMENTS: usize = 65_536;

/// Keys of one channel.
pub const KEYS_PER_CHANNEL: usize = 16_000_000;

/// Keys of all channels of a file.
pub const KEYS: usize = 100_000_000;

/// Seconds between zero and any key, either way: 24 hours.
pub const CLIP_SECONDS: f32 = 86_400.0;

/// Pixels along one side of an image.
pub const IMAGE_SIDE: u32 = 16_384;

/// Pixels of one image.
pub const IMAGE_PIXELS: u64 = 64_000_000;

/// Pixels of all images of a model.
pub const IMAGES_PIXELS: u64 = 256_000_000;

/// Files that a model may be spread over.
pub const EXTERNAL_FILES: usize = 1_024;

/// Bytes of a path to an external file, decoded.
pub const PATH_BYTES: usize = 1_024;

/// Warnings kept; the rest is counted.
pub const WARNINGS: usize = 1_000;

/// Elements worked through between two looks at the cancel flag.
pub const CANCEL_EVERY: usize = 1 << 16;

/// Lengths above this many units are worth a warning: single precision has no detail left there.
pub const HUGE: f32 = 1e12;
