//! The parsers of bytes from outside, each as a function that must not panic, hang or use much memory for any input.
//!
//! `.ci/fuzz SECONDS` fuzzes each of them with libFuzzer, guided by coverage, from the files of `tests/data`. The tests here
//! run every target on its seeds, and on mutations of them, wherever `cargo test` runs.

mod seeds;
mod targets;

pub use seeds::{Seed, seeds};
pub use targets::{TARGETS, Target};

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::mutate::Mutator;
    use dragonfly_kit::random::seed;

    #[test]
    fn every_target_has_seeds_and_parses_them_without_a_panic() {
        for target in TARGETS {
            let seeds = seeds(target);
            assert!(!seeds.is_empty(), "{} has no seed in tests/data", target.name);
            for seed in &seeds {
                (target.run)(&seed.bytes);
            }
        }
    }

    #[test]
    fn no_target_panics_on_mutations_of_its_seeds() {
        let seed = seed(0x6675_7a7a);
        println!("DRAGONFLY_SEED={seed}");
        for target in TARGETS {
            let mut mutator = Mutator::new(seed, &[b"{}", b"\0\0\0\0", b"1e999"]);
            let files: Vec<Vec<u8>> = seeds(target).into_iter().take(4).map(|seed| seed.bytes).collect();
            for _ in 0..60 {
                (target.run)(&mutator.mutant(&files));
            }
        }
    }
}
