//! The kinds of encoded images that a model can contain, a row each.

/// A kind of encoded image.
#[derive(Debug)]
pub struct ImageKind {
    /// Media type.
    pub mime: &'static str,
    /// Extensions of the names of its files, the usual one first.
    pub extensions: &'static [&'static str],
    /// The extension of glTF that textures with such an image need; `None` for the kinds that glTF itself allows.
    pub gltf_extension: Option<&'static str>,
    /// Returns width and height in pixels, from the header; `None` for bytes of another kind.
    measure: fn(&[u8]) -> Option<(u32, u32)>,
}

/// All kinds.
pub const IMAGE_KINDS: &[ImageKind] = &[
    ImageKind { mime: "image/png", extensions: &["png"], gltf_extension: None, measure: png },
    ImageKind { mime: "image/jpeg", extensions: &["jpg", "jpeg"], gltf_extension: None, measure: jpeg },
    ImageKind {
        mime: "image/webp",
        extensions: &["webp"],
        gltf_extension: Some("EXT_texture_webp"),
        measure: webp,
    },
    ImageKind {
        mime: "image/ktx2",
        extensions: &["ktx2"],
        gltf_extension: Some("KHR_texture_basisu"),
        measure: ktx2,
    },
];

impl ImageKind {
    /// Returns the kind with a media type.
    pub fn of(mime: &str) -> Option<&'static Self> {
        IMAGE_KINDS.iter().find(|kind| kind.mime == mime)
    }
}

/// Returns media type, width and height in pixels from the header of an image, or `None` for an unknown kind.
pub fn measure_image(bytes: &[u8]) -> Option<(&'static str, u32, u32)> {
    IMAGE_KINDS.iter().find_map(|kind| {
        let (width, height) = (kind.measure)(bytes)?;
        Some((kind.mime, width, height))
    })
}

fn png(bytes: &[u8]) -> Option<(u32, u32)> {
    let header = bytes.strip_prefix(b"\x89PNG\r\n\x1a\n")?.get(4..16)?.strip_prefix(b"IHDR")?;
    let word = |at: usize| Some(u32::from_be_bytes(*header.get(at..)?.first_chunk()?));
    Some((word(0)?, word(4)?))
}

fn jpeg(bytes: &[u8]) -> Option<(u32, u32)> {
    let mut rest = bytes.strip_prefix(b"\xff\xd8")?;
    loop {
        let marker = *rest.strip_prefix(b"\xff")?.first()?;
        rest = rest.get(1..)?;
        if marker == 0xff {
            continue;
        }
        let body = rest.get(1..)?;
        let length = usize::from(u16::from_be_bytes(*body.first_chunk()?));
        // Start of frame, except DHT, JPG and DAC, which are in the same range.
        if (0xc0..=0xcf).contains(&marker) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
            let height = u16::from_be_bytes(*body.get(3..)?.first_chunk()?);
            let width = u16::from_be_bytes(*body.get(5..)?.first_chunk()?);
            return Some((u32::from(width), u32::from(height)));
        }
        rest = body.get(length.max(2)..)?;
    }
}

/// Returns the size in the header of a KTX 2 image (KTX File Format Specification 2.0, section 3) that Basis Universal
/// compressed: those have no format of a graphics API.
fn ktx2(bytes: &[u8]) -> Option<(u32, u32)> {
    let header = bytes.strip_prefix(b"\xabKTX 20\xbb\r\n\x1a\n")?;
    let word = |at: usize| Some(u32::from_le_bytes(*header.get(at..)?.first_chunk()?));
    let (format, width, height) = (word(0)?, word(8)?, word(12)?);
    (format == 0).then_some((width, height))
}

/// Returns the size in the first chunk of a WebP: lossy, lossless or extended.
fn webp(bytes: &[u8]) -> Option<(u32, u32)> {
    let chunk = bytes.strip_prefix(b"RIFF")?.get(4..)?.strip_prefix(b"WEBP")?;
    let (kind, data) = (chunk.get(..4)?, chunk.get(8..)?);
    Some(match kind {
        b"VP8 " => {
            let frame = data.get(3..)?.strip_prefix(b"\x9d\x01\x2a")?;
            let side =
                |at: usize| Some(u32::from(u16::from_le_bytes(*frame.get(at..)?.first_chunk()?) & 0x3fff));
            (side(0)?, side(2)?)
        }
        b"VP8L" => {
            let bits = u32::from_le_bytes(*data.strip_prefix(b"\x2f")?.first_chunk()?);
            ((bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1)
        }
        b"VP8X" => {
            let side = |at: usize| {
                let [low, middle, high]: [u8; 3] = *data.get(at..)?.first_chunk()?;
                Some(u32::from_le_bytes([low, middle, high, 0]) + 1)
            };
            (side(4)?, side(7)?)
        }
        _ => return None,
    })
}
