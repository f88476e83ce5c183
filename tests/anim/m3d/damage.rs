//! Damaged files: no panic, no unsound model, no memory beyond the budget.

use super::made::{ODD, import, small};
use crate::doors::MemoryFs;
use crate::soundness::{faults, faults_of_poses};
use crate::takes::{opened_takes, plan};
use dragonfly_anim::format::{ByteBudget, ImportError, NoFiles, ReadOptions, m3d::M3D};
use dragonfly_kit::counting::peak;
use dragonfly_kit::mutate::{Mutator, mutants};
use dragonfly_kit::random::seed;

#[test]
fn every_truncation_of_a_file_of_each_dialect_is_an_error_or_a_sound_model() {
    for (name, bytes) in small() {
        let (mut read, mut refused) = (0, 0);
        // Every length of the small file, some of the others.
        let step = if bytes.len() < 4000 { 1 } else { 7 };
        for length in (0..=bytes.len()).step_by(step) {
            match import(&bytes[..length]) {
                Ok(imported) => {
                    assert_eq!(faults(&imported.model), [""; 0], "{name}: {length} bytes");
                    read += 1;
                }
                Err(error) => {
                    assert!(error.to_string().starts_with("line "), "{name}: {length} bytes: {error}");
                    refused += 1;
                }
            }
        }
        println!("{name}: {read} read, {refused} refused");
        assert!(refused > read, "{name}");
    }
}

#[test]
fn mutants_of_files_are_errors_or_sound_models_and_can_be_saved() {
    let first = seed(61_803);
    println!("DRAGONFLY_SEED={first}");
    let files: Vec<Vec<u8>> =
        small().into_iter().map(|(_, bytes)| bytes).filter(|bytes| bytes.len() < 20_000).collect();
    let words: &[&[u8]] =
        &[b"{", b"}", b" 0 ", b" -1 ", b" nan ", b" 1e39 ", b"#Bones 3", b" 65536 ", b"Time:", b"\r"];
    let mut mutator = Mutator::new(first, words);
    let mut read = 0;
    for number in 0..mutants() {
        let bytes = mutator.mutant(&files);
        let Ok(imported) = import(&bytes) else { continue };
        read += 1;
        assert_eq!(faults(&imported.model), [""; 0], "mutant {number}");
        let saved = plan(&M3D, &bytes, &imported.model, &opened_takes(&imported.model));
        assert!(saved.files[0].bytes == bytes, "mutant {number}");
        assert_eq!(faults_of_poses(imported.model), [""; 0], "mutant {number}");
    }
    println!("{read} of {} read", mutants());
    assert!(read > mutants() / 10);
}

#[test]
fn every_refused_charge_is_a_clear_error() {
    let mut request = 0;
    loop {
        let options = ReadOptions { budget: ByteBudget::failing_at(request), ..ReadOptions::default() };
        match M3D.import(ODD.as_bytes(), &MemoryFs::default(), &options) {
            Err(ImportError::TooLarge { .. }) => request += 1,
            Err(other) => panic!("charge {request}: {other}"),
            Ok(_) => break,
        }
    }
    println!("{request} charges");
    assert!(request > 30);
}

#[test]
fn memory_is_charged_before_it_is_used() {
    let row = "T: 1 P: 0 1.5 0.25 S: 1 1 1 Q: 0 0 0 1\n    ";
    let text = ODD
        .replace("#Keyframes: 4", "#Keyframes: 40004")
        .replace("T: 1 P: 0 1.5", &format!("{}T: 1 P: 0 1.5", row.repeat(40_000)));
    let options = ReadOptions::default();
    let (memory, result) = peak(|| M3D.import(text.as_bytes(), &NoFiles, &options));
    assert_eq!(result.unwrap().model.animation.takes[1].tracks[1].rotation.len(), 3);
    println!("{} bytes: {memory} at most, {} charged", text.len(), options.budget.used());
    assert!(memory <= options.budget.used() + (64 << 10), "{memory} of {}", options.budget.used());
    for limit in [1 << 12, 1 << 16, 1 << 20] {
        let options = ReadOptions { budget: ByteBudget::at_most(limit), ..ReadOptions::default() };
        let (memory, result) = peak(|| M3D.import(text.as_bytes(), &NoFiles, &options));
        assert!(matches!(result, Err(ImportError::TooLarge { .. })), "{limit}");
        assert!(memory <= limit + (64 << 10), "{memory} bytes with a limit of {limit}");
    }
}
