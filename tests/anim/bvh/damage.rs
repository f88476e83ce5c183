//! Damaged files: no panic, no unsound model, no memory beyond the budget.

use super::made::{ODD, import};
use crate::doors::{MemoryFs, data};
use crate::soundness::{faults, faults_of_poses};
use dragonfly_anim::format::{ByteBudget, ImportError, NoFiles, ReadOptions, bvh::BVH};
use dragonfly_kit::counting::peak;
use dragonfly_kit::mutate::{Mutator, mutants};
use dragonfly_kit::random::seed;

#[test]
fn every_truncation_of_a_file_is_an_error_or_a_sound_model() {
    let (mut read, mut refused) = (0, 0);
    for length in 0..=ODD.len() {
        match import(&ODD.as_bytes()[..length]) {
            Ok(imported) => {
                assert_eq!(faults(&imported.model), [""; 0], "{length} bytes");
                assert_eq!(faults_of_poses(imported.model), [""; 0], "{length} bytes");
                read += 1;
            }
            Err(error) => {
                assert_ne!(error.to_string(), "");
                refused += 1;
            }
        }
    }
    println!("{read} read, {refused} refused");
    assert!(read > 100 && refused > 300);
}

#[test]
fn mutants_of_files_are_errors_or_sound_models_and_can_be_saved() {
    let first = seed(90_210);
    println!("DRAGONFLY_SEED={first}");
    let small = ["rotation_first_root", "full_precision_frame_time"]
        .map(|name| std::fs::read(data().join(format!("bvh/{name}.bvh"))).unwrap());
    let files: Vec<Vec<u8>> = [ODD.as_bytes().to_vec()].into_iter().chain(small).collect();
    let words: &[&[u8]] =
        &[b"{", b"}", b"CHANNELS 6 ", b"End Site {", b"JOINT", b" 1e39 ", b" nan ", b"MOTION", b"-", b"\r"];
    let mut mutator = Mutator::new(first, words);
    let mut read = 0;
    for number in 0..mutants() {
        let bytes = mutator.mutant(&files);
        let Ok(imported) = import(&bytes) else { continue };
        read += 1;
        assert_eq!(faults(&imported.model), [""; 0], "mutant {number}");
        let file = BVH.edit("a.bvh", bytes.clone(), &NoFiles, &ReadOptions::default()).unwrap();
        let takes: Vec<_> = imported
            .model
            .animation
            .takes
            .iter()
            .map(|take| dragonfly_anim::format::EditedTake { origin: Some(0), take: take.clone() })
            .collect();
        assert!(file.plan(&imported.model, &takes).unwrap().files[0].bytes == bytes, "mutant {number}");
        assert_eq!(faults_of_poses(imported.model), [""; 0], "mutant {number}");
    }
    println!("{read} of {} read", mutants());
    assert!(read > mutants() / 10);
}

#[test]
fn every_refused_charge_is_a_clear_error() {
    let bytes = std::fs::read(data().join("bvh/rotation_first_root.bvh")).unwrap();
    let mut request = 0;
    loop {
        let options = ReadOptions { budget: ByteBudget::failing_at(request), ..ReadOptions::default() };
        match BVH.import(&bytes, &MemoryFs::default(), &options) {
            Err(ImportError::TooLarge { .. }) => request += 1,
            Err(other) => panic!("charge {request}: {other}"),
            Ok(_) => break,
        }
    }
    println!("{request} charges");
    assert!(request > 15);
}

#[test]
fn memory_is_charged_before_it_is_used() {
    let row = ["1.5"; 15].join(" ");
    let rows = [row.as_str(); 20_000].join("\n");
    let text = ODD.replace("Frames : 3", "Frames: 20003") + &rows;
    let options = ReadOptions::default();
    let (memory, result) = peak(|| BVH.import(text.as_bytes(), &NoFiles, &options));
    assert_eq!(result.unwrap().model.animation.takes[0].tracks[0].rotation.len(), 20_003);
    println!("{} bytes: {memory} at most, {} charged", text.len(), options.budget.used());
    assert!(memory <= options.budget.used() + (64 << 10), "{memory} of {}", options.budget.used());
    for limit in [1 << 12, 1 << 16, 1 << 20] {
        let options = ReadOptions { budget: ByteBudget::at_most(limit), ..ReadOptions::default() };
        let (memory, result) = peak(|| BVH.import(text.as_bytes(), &NoFiles, &options));
        assert!(matches!(result, Err(ImportError::TooLarge { .. })), "{limit}");
        assert!(memory <= limit + (64 << 10), "{memory} bytes with a limit of {limit}");
    }
}

#[test]
fn joints_inside_each_other_have_a_limit_and_need_no_stack() {
    let deep = |count: usize| {
        format!("HIERARCHY\nROOT a{}{}", "{JOINT b".repeat(count), "{}".to_owned() + &"}".repeat(count))
    };
    assert_eq!(import(deep(500).as_bytes()).unwrap().model.animation.skeleton.len(), 501);
    let error = import(deep(100_000).as_bytes()).unwrap_err();
    assert_eq!(error.to_string(), "line 2 column 4096: joints inside each other: 513, at most 512");
}
