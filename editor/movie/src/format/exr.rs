//! OpenEXR: a file for each frame in linear light, with half floats and alpha.

use super::sequence::FrameFiles;
use crate::error::MovieError;
use crate::frame::{LARGEST_SIDE, MovieFrame};
use crate::settings::MovieSettings;
use crate::srgb::SrgbTable;
use crate::target::MovieTarget;
use crate::writer::MovieFormat;
use dragonfly_anim::stage::time::StageRate;
use exr::prelude::{Compression, Encoding, Image, SpecificChannels, Text, Vec2, WritableImage, f16};
use std::io::Cursor;

/// Largest finite half float.
const LARGEST: f32 = 65_504.0;

pub(super) const EXR: MovieFormat = MovieFormat {
    name: "exr",
    title: "OpenEXR files",
    extensions: &["exr"],
    has_alpha: true,
    is_linear: true,
    has_sound: false,
    is_sequence: true,
    can_stream: false,
    side: LARGEST_SIDE,
    begin: |settings, target, _| Ok(Box::new(begin(settings, target)?)),
};

fn begin(settings: &MovieSettings, target: MovieTarget) -> Result<FrameFiles, MovieError> {
    let (table, mut pixels, rate) = (SrgbTable::new(), Vec::new(), settings.rate);
    let encode = move |frame: MovieFrame<'_>, label: Option<&str>, out: &mut Vec<u8>| {
        frame.to_linear(&table, &mut pixels);
        encode(&pixels, frame.size(), (rate, label), out)
    };
    FrameFiles::begin(EXR.title, settings, target, Box::new(encode))
}

/// Encodes pixels of red, green, blue and alpha, with the rate and a comment, if there is one.
fn encode(
    rgba: &[f32],
    size: [u32; 2],
    (rate, comment): (StageRate, Option<&str>),
    out: &mut Vec<u8>,
) -> Result<(), String> {
    out.clear();
    let [width, height] = size.map(|side| side as usize);
    let pixels = rgba.as_chunks::<4>().0;
    let half = |value: f32| f16::from_f32(value.clamp(-LARGEST, LARGEST));
    let channels = SpecificChannels::rgba(|at: Vec2<usize>| {
        let [red, green, blue, alpha] = pixels[at.y() * width + at.x()].map(half);
        (red, green, blue, alpha)
    });
    let encoding = Encoding { compression: Compression::ZIP16, ..Encoding::FAST_LOSSLESS };
    let mut image = Image::from_encoded_channels((width, height), encoding, channels);
    image.layer_data.attributes.comments = comment.and_then(Text::new_or_none);
    let (frames, seconds) = rate.fraction();
    image.layer_data.attributes.frames_per_second =
        i32::try_from(frames).ok().map(|frames| (frames, seconds));
    image.write().non_parallel().to_buffered(Cursor::new(out)).map_err(|error| error.to_string())
}
