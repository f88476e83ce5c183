//! Mutation of files for fuzz tests: valid files with random changes that no program would write.

use crate::folder::takes_long;
use crate::random::Random;

/// Numbers at which size arithmetic or float code often fails.
const SPECIALS: [u32; 18] = [
    0,
    1,
    2,
    3,
    4,
    7,
    8,
    0x7f,
    0xff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0xffff_fffe,
    // As floats: infinity, NaN, the largest, the smallest denormal, -1.
    0x7f80_0000,
    0x7fc0_0000,
    0x7f7f_ffff,
    0x0000_0001,
    0xbf80_0000,
];

/// Returns the number of mutants of one format that a test tries: 20,000, or two million in the long variant.
pub fn mutants() -> usize {
    if takes_long() { 2_000_000 } else { 20_000 }
}

/// Returns the number of the first mutant to try: 0, or that in the environment variable `DRAGONFLY_FIRST`, with which a long run that
/// was stopped is continued. The mutants before it are made, because each one depends on them, but not tried.
pub fn first_mutant() -> usize {
    std::env::var("DRAGONFLY_FIRST").ok().and_then(|number| number.parse().ok()).unwrap_or(0)
}

/// Prints how far a long run of mutants has come, every 10,000 mutants; shown with `--nocapture`.
pub fn print_progress(number: usize) {
    if takes_long() && number.is_multiple_of(10_000) {
        println!("{number} of {} tried", mutants());
    }
}

/// Returns mutants of files: a few random changes each, all derived from one seed.
pub struct Mutator<'a> {
    random: Random,
    words: &'a [&'a [u8]],
}

impl<'a> Mutator<'a> {
    /// Returns a mutator. `words` are inserted at random positions: byte sequences with a meaning in the format.
    pub fn new(seed: u64, words: &'a [&'a [u8]]) -> Self {
        Self { random: Random::new(seed), words }
    }

    /// Returns one of the `files` with one to four changes, sometimes with a part of another file.
    pub fn mutant(&mut self, files: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = files[self.random.below(files.len())].clone();
        let most = self.random.below(4);
        for _ in 0..=self.random.below(most + 1) {
            let other = &files[self.random.below(files.len())];
            self.change(&mut bytes, other);
        }
        bytes
    }

    fn change(&mut self, bytes: &mut Vec<u8>, other: &[u8]) {
        let at = self.random.below(bytes.len());
        match self.random.below(24) {
            0 => self.put(bytes, at, |random| vec![random.bits() as u8]),
            1 => self.put(bytes, at, |random| random.choice(&SPECIALS).to_le_bytes().to_vec()),
            2 => self.put(bytes, at & !3, |random| random.choice(&SPECIALS).to_le_bytes().to_vec()),
            3 => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte ^= 1 << self.random.below(8);
                }
            }
            4 => bytes.truncate(at),
            5 => {
                let end = (at + 1 + self.random.below(16)).min(bytes.len());
                bytes.drain(at.min(end)..end);
            }
            6 => {
                let from = self.random.below(other.len());
                let to = (from + self.random.below(64)).min(other.len());
                bytes.splice(at..at, other[from..to].iter().copied());
            }
            7 | 8 => {
                let word = self.words[self.random.below(self.words.len())];
                // Words for the start of an object are inserted there.
                let object = bytes[at.min(bytes.len())..].iter().position(|&byte| byte == b'{');
                let at = if word.ends_with(b",") { object.map_or(at, |object| at + object + 1) } else { at };
                bytes.splice(at..at, word.iter().copied());
            }
            9 => {
                // Near the end, where a binary file has its numbers.
                let at = bytes.len().saturating_sub(1 + self.random.below(600));
                self.put(bytes, at & !3, |random| random.choice(&SPECIALS).to_le_bytes().to_vec());
            }
            _ => self.change_number(bytes, at),
        }
    }

    /// Overwrites the bytes from `at` on, up to the end of the file.
    fn put(&mut self, bytes: &mut [u8], at: usize, make: impl Fn(&mut Random) -> Vec<u8>) {
        let made = make(&mut self.random);
        for (slot, byte) in bytes.iter_mut().skip(at).zip(made) {
            *slot = byte;
        }
    }

    /// Changes the next digit after `at`, or replaces it by a longer number.
    fn change_number(&mut self, bytes: &mut Vec<u8>, at: usize) {
        let Some(digit) = bytes[at.min(bytes.len())..].iter().position(u8::is_ascii_digit) else { return };
        let at = at + digit;
        match self.random.below(4) {
            0 => {
                let number = self.random.choice(&[
                    "-1",
                    "4294967296",
                    "18446744073709551615",
                    "1e39",
                    "1e-46",
                    "65536",
                    "0.5",
                    "null",
                ]);
                bytes.splice(at..=at, number.bytes());
            }
            1 => bytes.insert(at, b'0' + self.random.below(10) as u8),
            _ => bytes[at] = b'0' + self.random.below(10) as u8,
        }
    }
}
