//! Damaged files: no panic, no unsound model, no memory beyond the budget, no long work.

use super::import;
use crate::doors::{MemoryFs, TestFolder, data};
use crate::soundness::{faults, faults_of_poses};
use dragonfly_anim::format::{ByteBudget, ImportError, NoFiles, ReadOptions, obj::OBJ};
use dragonfly_kit::counting::peak;
use dragonfly_kit::mutate::{Mutator, mutants};
use dragonfly_kit::random::seed;
use std::time::{Duration, Instant};

fn small() -> Vec<Vec<u8>> {
    ["cube_usemtl", "cube_with_vertexcolors", "negative_indices", "testmixed", "regr_3429812"]
        .map(|name| std::fs::read(data().join(format!("obj/{name}.obj"))).unwrap())
        .into()
}

#[test]
fn every_truncation_of_a_file_is_an_error_or_a_sound_model() {
    for file in small() {
        for length in 0..=file.len() {
            let Ok(imported) = import(&file[..length]) else { continue };
            assert_eq!(faults(&imported.model), [""; 0], "{length} bytes");
        }
    }
}

#[test]
fn mutants_of_files_are_errors_or_sound_models() {
    let first = seed(55_013);
    println!("DRAGONFLY_SEED={first}");
    let words: &[&[u8]] = &[
        b"\nf 1 2 3 4 3 2 ",
        b"\ns 1\n",
        b"/",
        b"//",
        b"-",
        b"\nusemtl x\n",
        b"\\\n",
        b" 1e38 ",
        b"\nmtllib cube_usemtl.mtl\n",
    ];
    let mut mutator = Mutator::new(first, words);
    let (files, mut read) = (small(), 0);
    let mtl = std::fs::read(data().join("obj/cube_usemtl.mtl")).unwrap();
    let mut mtl_mutator = Mutator::new(first, &[b"\nnewmtl mtl\n", b"Kd ", b" -bm ", b"map_Kd ", b" nan "]);
    for number in 0..mutants() {
        let bytes = mutator.mutant(&files);
        let mutant = mtl_mutator.mutant(std::slice::from_ref(&mtl));
        let door = MemoryFs::with(&[("cube_usemtl.mtl", &mutant)]);
        let Ok(imported) = OBJ.import(&bytes, &door, &ReadOptions::default()) else { continue };
        read += 1;
        assert_eq!(faults(&imported.model), [""; 0], "mutant {number}");
        assert_eq!(faults_of_poses(imported.model), [""; 0], "mutant {number}");
    }
    println!("{read} of {} read", mutants());
    assert!(read > mutants() / 10);
}

#[test]
fn every_refused_charge_is_a_clear_error() {
    for name in ["cube_usemtl", "cube_with_vertexcolors", "box_UTF16BE"] {
        let bytes = std::fs::read(data().join(format!("obj/{name}.obj"))).unwrap();
        let mut request = 0;
        loop {
            let options = ReadOptions { budget: ByteBudget::failing_at(request), ..ReadOptions::default() };
            match OBJ.import(&bytes, &TestFolder(data().join("obj")), &options) {
                Err(ImportError::TooLarge { .. }) => request += 1,
                Err(other) => panic!("{name}, charge {request}: {other}"),
                Ok(_) => break,
            }
        }
        println!("{name}: {request} charges");
        assert!(request > 20);
    }
}

/// A grid with `side` vertices along each side.
fn grid(side: usize, smooth: &str) -> String {
    let mut text = String::from(smooth);
    for index in 0..side * side {
        text += &format!("v {} {} 0\nvt {} 0.5\n", index % side, index / side, index % side);
    }
    for index in 0..(side - 1) * (side - 1) {
        let corner = index / (side - 1) * side + index % (side - 1) + 1;
        let [a, b, c, d] = [corner, corner + 1, corner + side + 1, corner + side];
        text += &format!("f {a}/{a} {b}/{b} {c}/{c} {d}/{d}\n");
    }
    text
}

#[test]
fn memory_is_charged_before_it_is_used() {
    for smooth in ["s off\n", "s 1\n"] {
        let text = grid(200, smooth);
        let options = ReadOptions::default();
        let (memory, result) = peak(|| OBJ.import(text.as_bytes(), &NoFiles, &options));
        result.unwrap();
        println!("{} bytes: {memory} at most, {} charged", text.len(), options.budget.used());
        assert!(memory <= options.budget.used() + (64 << 10), "{memory} of {}", options.budget.used());
        for limit in [1 << 12, 1 << 16, 1 << 20, 1 << 22] {
            let options = ReadOptions { budget: ByteBudget::at_most(limit), ..ReadOptions::default() };
            let (memory, result) = peak(|| OBJ.import(text.as_bytes(), &NoFiles, &options));
            assert!(matches!(result, Err(ImportError::TooLarge { .. })), "{limit}");
            assert!(memory <= limit + (64 << 10), "{memory} bytes with a limit of {limit}");
        }
    }
}

#[test]
fn a_polygon_with_a_hundred_thousand_corners_takes_a_bounded_time() {
    let mut text = String::new();
    for corner in 0..100_000 {
        text += &format!("v {corner} {} 0\n", if corner % 2 == 0 { corner % 7 } else { 50 + corner % 11 });
    }
    text += "f";
    for corner in 1..=100_000 {
        text += &format!(" {corner}");
    }
    let start = Instant::now();
    let imported = import(&text).unwrap();
    println!("{:?}, {:?}", start.elapsed(), imported.warnings);
    assert!(start.elapsed() < Duration::from_secs(2));
    assert_eq!(faults(&imported.model), [""; 0]);
}
