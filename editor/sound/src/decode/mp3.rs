//! MP3, by the crate `nanomp3`: without the silence that encoders add at both ends.

use super::{Decoder, SoundFormat};
use nanomp3::{Channels, Reader};
use std::fs::File;
use std::io::BufReader;

/// Samples of a block.
const BLOCK: usize = 4096;

pub(super) const MP3: SoundFormat = SoundFormat {
    title: "MP3",
    extensions: &["mp3"],
    sniff: is_mp3,
    open: |reader| {
        let reader = Reader::new(reader).map_err(|error| error.to_string())?;
        let channels = match reader.channels() {
            Some(Channels::Mono) => 1,
            Some(Channels::Stereo) => 2,
            None => return Err("it has no sound".to_owned()),
        };
        Ok(Box::new(Mp3 { reader, channels }))
    },
};

/// Returns whether a file begins with a tag, or with a frame of layer III: eleven bits that are set, and a version and layer.
fn is_mp3(start: &[u8]) -> bool {
    let frame = matches!(start, [0xff, second, ..] if second & 0xe6 == 0xe2 && second & 0x18 != 0x08);
    start.starts_with(b"ID3") || frame
}

struct Mp3 {
    reader: Reader<BufReader<File>, f32>,
    channels: usize,
}

impl Decoder for Mp3 {
    fn rate(&self) -> u32 {
        self.reader.sample_rate()
    }

    fn channels(&self) -> usize {
        self.channels
    }

    fn read(&mut self, out: &mut Vec<f32>) -> Result<bool, String> {
        let before = out.len();
        out.resize(before + BLOCK, 0.0);
        let read = self.reader.read(&mut out[before..]).map_err(|error| error.to_string())?;
        out.truncate(before + read);
        Ok(read > 0)
    }
}
