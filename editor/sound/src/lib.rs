//! Sound along with an animation: files are decoded into samples, the sounds of a scene are mixed for any moment, and an audio device plays
//! the mix.
//!
//! ```text
//! file ── SoundFormat ──▶ SoundReader ──▶ SoundSamples ─┐
//!                                                       ├─ SoundMix ──▶ SoundOutput (the device, feature `audio`)
//! StagePlan (which sounds are heard, and how loud) ─────┘
//! ```
//!
//! A mix is a function of time: the same moments give the same samples, in any order and direction. The device calls it from its own thread,
//! which owns the mix; commands reach it by messages, and nothing is locked or allocated there.

mod decode;
mod mix;
mod output;
mod samples;

pub use decode::{SOUND_FORMATS, SoundFormat, SoundReader, is_sound_file};
pub use mix::{MixedSounds, SoundMix};
pub use output::{OutputCommand, OutputError, OutputVoice, SoundClock, SoundOutput};
pub use samples::{MOST_FRAMES, MOST_SOUND_BYTES, SoundSamples};
