//! A stopwatch for benches: many short batches, the median and the 99th percentile of them.

use std::hint::black_box;
use std::time::Instant;

/// Number of measured batches. Large enough that a single slow batch does not determine the 99th percentile.
const BATCHES: usize = 400;

/// Runs `work` in batches of `per_batch` calls and prints the median and the 99th percentile over the batches, in
/// nanoseconds per call.
///
/// `name` is crate/thing/case. Does nothing when the first argument of the program, as in `cargo bench -- part`, is not
/// a part of the name.
pub fn measure<T>(name: &str, per_batch: u32, mut work: impl FnMut() -> T) {
    let wanted = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    if wanted.is_some_and(|part| !name.contains(&part)) {
        return;
    }
    for _ in 0..per_batch {
        black_box(work());
    }
    let mut nanoseconds: Vec<f64> = (0..BATCHES)
        .map(|_| {
            let begin = Instant::now();
            for _ in 0..per_batch {
                black_box(work());
            }
            begin.elapsed().as_nanos() as f64 / f64::from(per_batch)
        })
        .collect();
    nanoseconds.sort_by(f64::total_cmp);
    let (median, late) = (nanoseconds[BATCHES / 2], nanoseconds[BATCHES * 99 / 100]);
    println!("{name:<48} median {median:>12.1} ns   p99 {late:>12.1} ns");
}
