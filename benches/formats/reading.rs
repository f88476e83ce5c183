//! Times of works that take turns, so that their ratios hold on a busy machine as well.

use dragonfly_anim::format::{Conventions, NoFiles, ReadOptions};
use std::hint::black_box;
use std::time::Instant;

/// A work that is measured; returns milliseconds, or `None` if it failed.
pub(crate) type TimedWork<'a> = (&'a str, Box<dyn FnMut() -> Option<f64> + 'a>);

/// Returns the milliseconds of one call.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64() * 1e3
}

/// Runs all works in turns after one turn that is not counted. Returns the times of each that never failed.
pub(crate) fn in_turns<'a>(rounds: usize, works: Vec<TimedWork<'a>>) -> Vec<(&'a str, Vec<f64>)> {
    let mut measured: Vec<(TimedWork<'a>, Vec<f64>)> =
        works.into_iter().map(|work| (work, Vec::new())).collect();
    for round in 0..=rounds {
        measured.retain_mut(|((_, work), times)| {
            let time = work();
            times.extend(time.filter(|_| round > 0));
            time.is_some()
        });
    }
    measured.into_iter().map(|((name, _), times)| (name, times)).collect()
}

/// Reads bytes with the program's reader of the format.
///
/// # Panics
/// If the file, which was made in code, cannot be read.
pub(crate) fn read_ours(format: dragonfly_anim::format::Format, bytes: &[u8]) -> Option<f64> {
    let options = ReadOptions { conventions: Conventions::default(), ..ReadOptions::default() };
    Some(timed(|| format.import(bytes, &NoFiles, &options).expect("a file made in code")))
}
