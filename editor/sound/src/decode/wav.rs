//! WAV, by the crate `hound`.

use super::{Decoder, SoundFormat};
use hound::{SampleFormat, WavReader};
use std::fs::File;
use std::io::BufReader;

/// Samples of a block.
const BLOCK: usize = 4096;

pub(super) const WAV: SoundFormat = SoundFormat {
    title: "WAV",
    extensions: &["wav", "wave"],
    sniff: |start| start.starts_with(b"RIFF"),
    open: |reader| Ok(Box::new(Wav(WavReader::new(reader).map_err(|error| error.to_string())?))),
};

struct Wav(WavReader<BufReader<File>>);

impl Decoder for Wav {
    fn rate(&self) -> u32 {
        self.0.spec().sample_rate
    }

    fn channels(&self) -> usize {
        usize::from(self.0.spec().channels)
    }

    fn read(&mut self, out: &mut Vec<f32>) -> Result<bool, String> {
        let spec = self.0.spec();
        let before = out.len();
        match spec.sample_format {
            SampleFormat::Float => {
                for sample in self.0.samples::<f32>().take(BLOCK) {
                    out.push(sample.map_err(|error| error.to_string())?);
                }
            }
            SampleFormat::Int => {
                let full = 2_f32.powi(i32::from(spec.bits_per_sample.clamp(1, 32)) - 1);
                for sample in self.0.samples::<i32>().take(BLOCK) {
                    out.push(sample.map_err(|error| error.to_string())? as f32 / full);
                }
            }
        }
        Ok(out.len() > before)
    }
}
