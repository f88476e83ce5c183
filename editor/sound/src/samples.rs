//! The samples of a whole sound, for playing it at any moment.

use super::SoundReader;

/// Largest number of frames of a sound that is played: 23 minutes at 48 kHz, 256 MiB.
pub const MOST_FRAMES: usize = 64 << 20;

/// Memory for the samples of all sounds of a scene or take, bytes.
pub const MOST_SOUND_BYTES: usize = 512 << 20;

/// Factor for channels beyond left and right, which have no side: half of their power on each.
const OTHERS: f32 = std::f32::consts::FRAC_1_SQRT_2;

/// A sound in two channels.
#[derive(Clone, Debug, PartialEq)]
pub struct SoundSamples {
    /// Frames per second.
    rate: u32,
    /// Left and right, full scale at 32,767.
    frames: Vec<[i16; 2]>,
}

impl SoundSamples {
    /// Reads the rest of a file. A single channel is on both sides, and all channels beyond the second are too.
    ///
    /// # Errors
    ///
    /// The file is damaged, longer than [`MOST_FRAMES`], or `is_cancelled` returned true.
    pub fn read(reader: &mut SoundReader, is_cancelled: &dyn Fn() -> bool) -> Result<Self, String> {
        let (rate, channels) = (reader.rate(), reader.channels());
        let mut frames: Vec<[i16; 2]> = Vec::new();
        // The samples of a frame whose others are in the next block.
        let mut open: Vec<f32> = Vec::with_capacity(channels);
        while let Some(block) = reader.next_block()? {
            if is_cancelled() {
                return Err("cancelled".to_owned());
            }
            let more = block.len() / channels + 1;
            if frames.len() + more > MOST_FRAMES {
                let minutes = MOST_FRAMES / rate as usize / 60;
                return Err(format!("it is longer than {minutes} minutes, too long to be played"));
            }
            frames.try_reserve(more).map_err(|_| "there is not enough memory".to_owned())?;
            for &sample in block {
                open.push(sample);
                if open.len() == channels {
                    frames.push(sides(&open));
                    open.clear();
                }
            }
        }
        Ok(Self { rate, frames })
    }

    /// Returns its length in seconds.
    pub fn seconds(&self) -> f64 {
        self.frames.len() as f64 / f64::from(self.rate)
    }

    /// Returns the size of the samples in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.frames.as_slice())
    }

    /// Returns left and right at a time in seconds, from -1 to 1: on the line between two frames, and 0 outside of the sound.
    pub fn at(&self, seconds: f64) -> [f32; 2] {
        let at = seconds * f64::from(self.rate);
        if !(at >= 0.0 && at < self.frames.len() as f64) {
            return [0.0; 2];
        }
        let (first, share) = (at as usize, at.fract() as f32);
        let Some(&here) = self.frames.get(first) else { return [0.0; 2] };
        let next = self.frames.get(first + 1).copied().unwrap_or_default();
        let side = |side: usize| {
            let [from, to] = [here[side], next[side]].map(|sample| f32::from(sample) / 32_767.0);
            from + (to - from) * share
        };
        [side(0), side(1)]
    }
}

/// Returns left and right of a frame of any number of channels.
fn sides(channels: &[f32]) -> [i16; 2] {
    let first = channels.first().copied().unwrap_or_default();
    let second = channels.get(1).copied().unwrap_or(first);
    let others: f32 = channels.iter().skip(2).sum::<f32>() * OTHERS;
    [first, second].map(|side| {
        let sum = side + others;
        if sum.is_finite() { (sum.clamp(-1.0, 1.0) * 32_767.0).round() as i16 } else { 0 }
    })
}
