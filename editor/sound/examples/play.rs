//! Plays a sound file: `cargo run -p dragonfly-sound --features audio --example play -- FILE`.

use dragonfly_sound::{
    MixedSounds, OutputCommand, SoundClock, SoundMix, SoundOutput, SoundReader, SoundSamples,
};
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("the path of a sound file is missing")?;
    let mut reader = SoundReader::new(std::fs::File::open(&path)?, &path)?;
    let samples = Arc::new(SoundSamples::read(&mut reader, &|| false)?);
    println!("{path}: {:.2} s, {} Hz, {} channels", samples.seconds(), reader.rate(), reader.channels());
    let output = SoundOutput::open()?;
    let mix = SoundMix::new(MixedSounds::Take { begin: 0.0, samples });
    let clock =
        SoundClock { begun: Instant::now(), time_at: Box::new(|passed| passed.as_secs_f64()), speed: 1.0 };
    output.send(OutputCommand::Play(Box::new(mix), clock))?;
    println!("Enter ends it.");
    std::io::stdin().read_line(&mut String::new())?;
    Ok(())
}
