//! PNG: a file for each frame, without loss and with alpha.

use super::sequence::FrameFiles;
use crate::error::MovieError;
use crate::frame::{LARGEST_SIDE, MovieFrame};
use crate::settings::MovieSettings;
use crate::srgb::SrgbTable;
use crate::target::MovieTarget;
use crate::writer::MovieFormat;

pub(super) const PNG: MovieFormat = MovieFormat {
    name: "png",
    title: "PNG files",
    extensions: &["png"],
    has_alpha: true,
    is_linear: false,
    has_sound: false,
    is_sequence: true,
    can_stream: false,
    side: LARGEST_SIDE,
    begin: |settings, target, _| Ok(Box::new(begin(settings, target)?)),
};

fn begin(settings: &MovieSettings, target: MovieTarget) -> Result<FrameFiles, MovieError> {
    let (table, mut pixels) = (SrgbTable::new(), Vec::new());
    let encode = move |frame: MovieFrame<'_>, label: Option<&str>, out: &mut Vec<u8>| {
        frame.to_srgb(&table, &mut pixels);
        encode(&pixels, frame.size(), label, out)
    };
    FrameFiles::begin(PNG.title, settings, target, Box::new(encode))
}

/// Encodes pixels of red, green, blue and alpha, with a comment, if there is one.
pub(super) fn encode(
    rgba: &[u8],
    [width, height]: [u32; 2],
    comment: Option<&str>,
    out: &mut Vec<u8>,
) -> Result<(), String> {
    out.clear();
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    if let Some(comment) = comment {
        let added = encoder.add_text_chunk("Comment".to_owned(), comment.to_owned());
        added.map_err(|error| error.to_string())?;
    }
    let mut writer = encoder.write_header().map_err(|error| error.to_string())?;
    writer.write_image_data(rgba).map_err(|error| error.to_string())?;
    writer.finish().map_err(|error| error.to_string())
}
