//! Limits for imported files. An error that reports an exceeded limit contains its value.
//!
//! The values are far above the needs of real models and far below what endangers the machine.

/// Largest size of one file in bytes, main or external.
pub const FILE_BYTES: u64 = 2 << 30;

/// Working memory in bytes that any file may use, however small it is.
pub const MEMORY_BASE: u64 = 256 << 20;

/// Additional working memory in bytes for each byte read.
pub const MEMORY_PER_BYTE: u64 = 32;

/// Working memory in bytes that no file exceeds, however large it is.
pub const MEMORY_MAX: u64 = 2 << 30;

/// Depth of nested arrays and objects in a JSON text.
pub const JSON_DEPTH: usize = 64;

/// Largest number of nodes in a scene.
pub const NODES: usize = 1_000_000;

/// Largest depth of a scene in nodes, the root included.
pub const NODE_DEPTH: usize = 512;

/// Largest number of joints in one skin; a vertex refers to them with 16 bits.
pub const JOINTS_PER_SKIN: usize = 65_535;

/// Largest number of vertices in one primitive, and in all.
pub const VERTICES: usize = 50_000_000;

/// Largest number of elements in an accessor without bytes (all zero), unless the file is larger than this.
pub const ZERO_ELEMENTS: usize = 65_536;

/// Largest number of keys in one channel.
pub const KEYS_PER_CHANNEL: usize = 16_000_000;

/// Largest number of keys in all channels of a file.
pub const KEYS: usize = 100_000_000;

/// Largest time of a key in seconds, positive or negative: 24 hours.
pub const CLIP_SECONDS: f32 = 86_400.0;

/// Largest width and height of an image in pixels.
pub const IMAGE_SIDE: u32 = 16_384;

/// Largest number of pixels in one image.
pub const IMAGE_PIXELS: u64 = 64_000_000;

/// Largest number of pixels in all images of a model.
pub const IMAGES_PIXELS: u64 = 256_000_000;

/// Largest number of files of a model.
pub const EXTERNAL_FILES: usize = 1_024;

/// Largest length of a decoded path to an external file, in bytes.
pub const PATH_BYTES: usize = 1_024;

/// Largest number of stored warnings; the rest is counted.
pub const WARNINGS: usize = 1_000;

/// Number of elements processed between two checks of the cancel flag.
pub const CANCEL_EVERY: usize = 1 << 16;

/// Length in units above which a warning is given: single precision has no detail left there.
pub const HUGE: f32 = 1e12;
