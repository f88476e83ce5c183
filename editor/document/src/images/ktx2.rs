//! KTX 2 images that Basis Universal compressed, as `KHR_texture_basisu` of glTF has them.

use super::ImageSize;
use basisu::{DecodeFlags, SourceFormat, TargetFormat, Transcoder};
use dragonfly_anim::format::measure_image;
use image::RgbaImage;

/// First bytes of a KTX 2 file.
const IDENTIFIER: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

// Positions in the header (KTX File Format Specification 2.0, section 3), bytes.
const SUPERCOMPRESSION: usize = 44;
/// The length of the first level before its supercompression.
const FIRST_LENGTH: usize = 80 + 16;

const DAMAGED: &str = "the KTX 2 image is damaged";

/// Bytes of a block of 4 x 4 pixels in UASTC.
const BLOCK: u64 = 16;

/// The only supercompression with a length of its own: Zstandard.
const ZSTANDARD: u32 = 2;

/// Returns whether the bytes are a KTX 2 file.
pub(super) fn is_ktx2(bytes: &[u8]) -> bool {
    bytes.starts_with(IDENTIFIER)
}

/// Returns the size of the image in the header.
pub(super) fn size_of(bytes: &[u8]) -> Result<[u32; 2], String> {
    match measure_image(bytes) {
        Some((_, width, height)) => Ok([width, height]),
        None => Err("a KTX 2 image without Basis Universal".to_owned()),
    }
}

/// Returns the bytes that decoding needs: the pixels, and the blocks of a compressed file.
pub(super) fn raw_bytes(pixels: u64) -> u64 {
    5 * pixels
}

/// Decodes the largest level of a plain picture, whose size was checked. Levels below it are not used: what draws the image makes its own.
///
/// # Errors
/// The reason: broken, or what glTF does not allow.
pub(super) fn decode(bytes: &[u8], size: ImageSize) -> Result<RgbaImage, String> {
    // The transcoder subtracts lengths of a damaged file without a check.
    std::panic::catch_unwind(|| transcode(bytes, size)).unwrap_or_else(|_| Err(DAMAGED.to_owned()))
}

fn transcode(bytes: &[u8], size: ImageSize) -> Result<RgbaImage, String> {
    let damaged = |_| DAMAGED.to_owned();
    let blocks = u64::from(size.width.div_ceil(4)) * u64::from(size.height.div_ceil(4));
    // The transcoder allocates the length that is written in the file.
    let compression =
        bytes.get(SUPERCOMPRESSION..).and_then(<[u8]>::first_chunk).map(|at| u32::from_le_bytes(*at));
    let length = bytes.get(FIRST_LENGTH..).and_then(<[u8]>::first_chunk).map(|at| u64::from_le_bytes(*at));
    if compression == Some(ZSTANDARD) && length != Some(blocks * BLOCK) {
        return Err(DAMAGED.to_owned());
    }
    let transcoder = Transcoder::new(bytes).map_err(damaged)?;
    let is_allowed = matches!(transcoder.source_format(), SourceFormat::Etc1s | SourceFormat::UastcLdr);
    if !is_allowed || transcoder.layer_count() > 1 || transcoder.face_count() > 1 || transcoder.is_video() {
        return Err("glTF allows one picture in ETC1S or UASTC, and this KTX 2 image is another".to_owned());
    }
    if transcoder.base_dimensions() != (size.width, size.height) {
        return Err(DAMAGED.to_owned());
    }
    let mut pixels = Vec::new();
    let length = usize::try_from(4 * size.pixels()).map_err(|error| error.to_string())?;
    pixels.try_reserve_exact(length).map_err(|error| error.to_string())?;
    pixels.resize(length, 0);
    let target = TargetFormat::Rgba32;
    transcoder.transcode_into(0, target, DecodeFlags::NONE, &mut pixels).map_err(damaged)?;
    RgbaImage::from_raw(size.width, size.height, pixels).ok_or_else(|| DAMAGED.to_owned())
}
