//! The encoder, as the crate `rusty_h264-encoder` has it: baseline profile, which every decoder reads, at a constant coarseness.

use super::level::level;
use super::sps::with_usability;
use crate::settings::{GROUP, MovieSettings};
use crate::yuv::YuvPicture;
use dragonfly_anim::stage::time::StageRate;
use rusty_h264_common::types::YuvPlanes;
use rusty_h264_encoder::{Encoder, EncoderConfig, Preset};

/// Number of pictures that a picture may refer to.
const REFERENCES: u32 = 3;

/// Types of NAL units.
const PICTURE: u8 = 1;
const WHOLE_PICTURE: u8 = 5;
const SEQUENCE: u8 = 7;
const PICTURES: u8 = 8;

/// The parameters of a stream, without start codes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ParameterSets {
    /// Parameters of the sequence, with color and rate.
    pub(crate) sequence: Vec<u8>,
    /// Parameters of the pictures.
    pub(crate) pictures: Vec<u8>,
}

/// One picture as it is in an MP4: each unit after its length in four bytes.
#[derive(Clone, Debug, Default)]
pub(crate) struct EncodedPicture {
    pub(crate) bytes: Vec<u8>,
    /// Whether it needs no other picture.
    pub(crate) is_whole: bool,
}

/// Encodes pictures one by one.
pub(crate) struct H264Encoder {
    config: EncoderConfig,
    rate: StageRate,
    level: u8,
    encoder: Option<Encoder>,
    parameters: Option<ParameterSets>,
}

impl H264Encoder {
    /// Creates an encoder for pictures of `size`, which is even; an error is a clause.
    pub(crate) fn new(size: [u32; 2], settings: &MovieSettings) -> Result<Self, String> {
        let [width, height] = size;
        let level = level(size, settings.rate, REFERENCES).ok_or_else(|| {
            format!(
                "{width} × {height} pixels at {} frames per second are more than H.264 has; 8192 × 4352 at 120 are the most",
                settings.rate
            )
        })?;
        let mut config = EncoderConfig::baseline(width as usize, height as usize);
        config.preset = Preset::Balanced;
        config.num_ref_frames = REFERENCES;
        config.gop_size = GROUP as u32;
        config.qp = settings.coarseness;
        config.bitrate = 0;
        config.framerate = settings.rate.per_second() as f32;
        Ok(Self { config, rate: settings.rate, level, encoder: None, parameters: None })
    }

    /// Returns the parameters, once a picture was encoded.
    pub(crate) fn parameters(&self) -> Option<&ParameterSets> {
        self.parameters.as_ref()
    }

    /// Encodes the next picture, which has a number in the whole movie; an error is a clause.
    pub(crate) fn picture(&mut self, picture: &YuvPicture, number: u64) -> Result<EncodedPicture, String> {
        let is_first = number.is_multiple_of(GROUP);
        let mut encoder = match self.encoder.take().filter(|_| !is_first) {
            Some(encoder) => encoder,
            None => Encoder::new(self.config.clone()).map_err(|error| error.to_string())?,
        };
        let [luma, blue, red] = picture.planes();
        let (width, height) = (self.config.width, self.config.height);
        let planes = YuvPlanes::new(width, height, luma, blue, red, width, width / 2);
        let planes = planes.ok_or("its planes have another size")?;
        let bytes = encoder.encode_planes(&planes).map_err(|error| error.to_string())?;
        self.encoder = Some(encoder);
        self.packed(&bytes)
    }

    /// Returns the units of a picture after their lengths, without the parameters, which are kept.
    fn packed(&mut self, bytes: &[u8]) -> Result<EncodedPicture, String> {
        let mut encoded = EncodedPicture::default();
        let mut sets = [None, None];
        for unit in units(bytes) {
            let kind = unit.first().map_or(0, |header| header & 31);
            match kind {
                SEQUENCE => sets[0] = Some(unit),
                PICTURES => sets[1] = Some(unit),
                PICTURE | WHOLE_PICTURE => {
                    encoded.is_whole |= kind == WHOLE_PICTURE;
                    encoded.bytes.extend((unit.len() as u32).to_be_bytes());
                    encoded.bytes.extend_from_slice(unit);
                }
                _ => return Err(format!("the encoder wrote a unit of type {kind}")),
            }
        }
        if encoded.bytes.is_empty() {
            return Err("the encoder wrote no picture".to_owned());
        }
        if let [Some(sequence), Some(pictures)] = sets {
            let mut sequence = sequence.to_vec();
            if let Some(level) = sequence.get_mut(3) {
                *level = self.level;
            }
            let sequence = with_usability(&sequence, self.rate, REFERENCES)
                .ok_or("the encoder wrote other parameters than expected")?;
            let found = ParameterSets { sequence, pictures: pictures.to_vec() };
            if self.parameters.get_or_insert_with(|| found.clone()) != &found {
                return Err("the encoder changed its parameters".to_owned());
            }
        }
        Ok(encoded)
    }
}

/// Returns the units between start codes.
fn units(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = bytes;
    std::iter::from_fn(move || {
        let start = rest.windows(3).position(|code| code == [0, 0, 1])? + 3;
        let unit = &rest[start..];
        let end = unit.windows(3).position(|code| code == [0, 0, 1]).unwrap_or(unit.len());
        rest = &unit[end..];
        // A start code of four bytes begins with a zero that is no part of the unit, which never ends in one.
        let length = unit[..end].iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1);
        Some(&unit[..length])
    })
}
