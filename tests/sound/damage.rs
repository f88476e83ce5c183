//! A damaged file gives an error or some samples, quickly and with little memory.

use dragonfly_kit::counting::peak;
use dragonfly_kit::folder::{Folder, data};
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::process::thread_time;
use dragonfly_kit::random::seed;
use std::time::Duration;

/// Limits of time and memory for a file of half a second.
const MOST_TIME: Duration = Duration::from_secs(2);
const MOST_MEMORY: u64 = 64 << 20;

#[test]
fn two_thousand_damaged_files_are_errors_or_sounds() {
    let folder = Folder::new("sound-damage");
    let path = folder.join("it");
    let wav = folder.join("it.wav");
    crate::decode::wav(&wav, 2, 22_050, &[0.25; 4_000]);
    let mut files: Vec<Vec<u8>> = ["tones.flac", "tones.ogg", "tones.mp3"]
        .map(|name| std::fs::read(data("sound").join(name)).unwrap())
        .into();
    files.push(std::fs::read(&wav).unwrap());
    let seed = seed(72_305);
    let mut mutator = Mutator::new(
        seed,
        &[b"OggS", b"fmt ", b"data", b"\xff\xfb", b"ID3", b"\xff\xf8", b"\xff\xff\xff\xff"],
    );
    let mut sounds = 0;
    for number in 0..2_000 {
        let bytes = mutator.mutant(&files);
        std::fs::write(&path, &bytes).unwrap();
        let start = thread_time();
        let (memory, read) = peak(|| crate::decode::samples(&path));
        let time = thread_time().saturating_sub(start);
        assert!(
            time < MOST_TIME && memory < MOST_MEMORY,
            "seed {seed}, file {number}: {time:?}, {memory} bytes"
        );
        match read {
            Ok(_) => sounds += 1,
            Err(reason) => assert!(!reason.is_empty()),
        }
    }
    assert!(sounds > 200, "{sounds} sounds, seed {seed}");
}
