//! FLAC, by the crate `claxon`.

use super::{Decoder, SoundFormat};
use claxon::FlacReader;
use std::fs::File;
use std::io::BufReader;

pub(super) const FLAC: SoundFormat = SoundFormat {
    title: "FLAC",
    extensions: &["flac"],
    sniff: |start| start.starts_with(b"fLaC"),
    open: |reader| {
        let reader = FlacReader::new(reader).map_err(|error| error.to_string())?;
        let left = reader.streaminfo().samples;
        Ok(Box::new(Flac { reader, buffer: Vec::new(), left }))
    },
};

struct Flac {
    reader: FlacReader<BufReader<File>>,
    buffer: Vec<i32>,
    /// Samples of a channel that are still to come; `None` where the file does not contain it. Some encoders write more bytes after the last one.
    left: Option<u64>,
}

impl Decoder for Flac {
    fn rate(&self) -> u32 {
        self.reader.streaminfo().sample_rate
    }

    fn channels(&self) -> usize {
        self.reader.streaminfo().channels as usize
    }

    fn read(&mut self, out: &mut Vec<f32>) -> Result<bool, String> {
        let (bits, channels) = (self.reader.streaminfo().bits_per_sample, self.channels());
        let full = 2_f32.powi(bits.clamp(1, 32) as i32 - 1);
        if self.left == Some(0) {
            return Ok(false);
        }
        let buffer = std::mem::take(&mut self.buffer);
        let block = self.reader.blocks().read_next_or_eof(buffer).map_err(|error| error.to_string())?;
        let Some(block) = block else { return Ok(false) };
        if block.channels() as usize != channels {
            return Err("the number of channels changes".to_owned());
        }
        for at in 0..block.duration() {
            out.extend((0..block.channels()).map(|channel| block.sample(channel, at) as f32 / full));
        }
        self.left = self.left.map(|left| left.saturating_sub(u64::from(block.duration())));
        self.buffer = block.into_buffer();
        Ok(true)
    }
}
