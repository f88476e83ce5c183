//! Malicious files: every checksum correct, anything else wrong. The result is a model or an error, within the
//! guaranteed memory.

use super::frame::{fix_checksums, number, parts};
use super::golden::{file, model};
use super::made::RandomModels;
use crate::doors::MemoryFs;
use crate::soundness::faults_of_poses;
use crate::trial::{STACK, memory_for, on_small_stack};
use dragonfly_anim::format::{ReadOptions, dfm, read};
use dragonfly_kit::counting::peak;
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::random::{Random, seed};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Words that have a meaning in such a file.
const WORDS: &[&[u8]] = &[
    b"\0\0\0\0",
    b"\x01\0\0\0",
    b"\x02\0\0\0",
    b"\xff\xff\xff\xff",
    b"\xff\xff\xff\x7f",
    b"\0\0\xc0\x7f",
    b"\0\0\x80\x7f",
    b"VERT",
    b"BONE",
    b"TAKE",
    b"SUMS",
    b"dfm\x1a",
];

/// Reads `bytes` with both readers. The error describes the broken guarantee; `true` means that the file was read.
fn tried(bytes: &[u8]) -> Result<bool, String> {
    let run = || {
        let (memory, exact) = peak(|| dfm::read(bytes));
        // Most of the guaranteed limit is for files larger than this.
        if memory > (1 << 20) + 32 * bytes.len() as u64 {
            return Err(format!("took {memory} bytes for {}", bytes.len()));
        }
        if let Ok(exact) = &exact {
            // Every model that is read can be written, and is read back the same.
            let again = dfm::write(exact).map_err(|error| format!("cannot be written: {error}"))?;
            let back = dfm::read(&again).map_err(|error| format!("cannot be read again: {error}"))?;
            if format!("{back:?}") != format!("{exact:?}") {
                return Err("it is not read back the same".to_owned());
            }
        }
        let imported = read("a.dfm", bytes, &MemoryFs::default(), &ReadOptions::default());
        match (imported, &exact) {
            (Ok(_), Err(error)) => Err(format!("imported, though {error}")),
            (Ok(imported), Ok(_)) => {
                let faults = faults_of_poses(imported.model);
                if faults.is_empty() { Ok(true) } else { Err(faults.join(", ")) }
            }
            (Err(_), exact) => Ok(exact.is_ok()),
        }
    };
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|_| Err("panicked".to_owned()))
}

#[test]
fn mutants_with_correct_checksums_do_no_harm() {
    let first = seed(0x00DF_0001);
    println!("DRAGONFLY_SEED={first}");
    let work = on_small_stack(move || {
        let mut files = vec![file()];
        for number in 0..12 {
            let odd = if number % 2 == 0 { 0.0 } else { 0.05 };
            files.push(
                dfm::write(&RandomModels { random: Random::new(first + number), odd }.model()).unwrap(),
            );
        }
        let mutants: u64 = if std::env::var_os("DRAGONFLY_LONG").is_some() { 2_000_000 } else { 60_000 };
        let mut read = 0;
        for number in 0..mutants {
            let seed = first.wrapping_add(number);
            let mut bytes = Mutator::new(seed, WORDS).mutant(&files);
            fix_checksums(&mut bytes);
            match tried(&bytes) {
                Ok(done) => read += u64::from(done),
                Err(what) => panic!("DRAGONFLY_SEED={seed}: {what}"),
            }
        }
        println!("{mutants} mutants, {read} of them read");
        assert!(read > mutants / 20, "too few mutants are read to test what comes after");
    });
    work.join().unwrap();
}

#[test]
fn a_wrong_number_at_any_place_does_no_harm() {
    let file = file();
    let numbers = [0u32, 1, 2, 3, 255, 0xffff, 0x7fff_ffff, 0x8000_0000, u32::MAX - 1, u32::MAX, 0x7fc0_0000];
    let mut read = 0;
    for at in 0..file.len() - 4 {
        for number in numbers {
            let mut bytes = file.clone();
            bytes[at..at + 4].copy_from_slice(&number.to_le_bytes());
            fix_checksums(&mut bytes);
            match tried(&bytes) {
                Ok(done) => read += usize::from(done),
                Err(what) => panic!("{number:#x} at byte {at}: {what}"),
            }
        }
    }
    println!("{read} read of {}", (file.len() - 4) * numbers.len());
}

/// A file whose elements are as small in the file and as large in memory as possible.
#[test]
fn small_elements_stay_within_the_memory_limit() {
    let mut many = model();
    let bone = many.animation.skeleton.bones[0].clone();
    many.animation.skeleton = dragonfly_anim::data::Skeleton { bones: vec![bone; 2_000] }.into();
    let take = dragonfly_anim::data::Take {
        tracks: (0..2_000).map(|bone| dragonfly_anim::data::Track { bone, ..Default::default() }).collect(),
        ..Default::default()
    };
    many.animation.takes = vec![take.into(); 50];
    many.meshes.extend(vec![Default::default(); 100_000]);
    many.skins.extend(vec![Default::default(); 100_000]);
    let bytes = dfm::write(&many).unwrap();
    let (memory, result) = peak(|| dfm::read(&bytes));
    assert!(result.unwrap() == many);
    println!("{} bytes in the file, {memory} in memory", bytes.len());
    assert!(memory < 16 * bytes.len() as u64 && memory < memory_for(bytes.len()));
    assert!(STACK < bytes.len());
}

#[test]
fn a_count_that_exceeds_the_bytes_is_refused_before_any_allocation() {
    for (index, (tag, at, _)) in parts(&file()).unwrap().into_iter().enumerate() {
        let mut bytes = file();
        let count = at + if index < 6 { 0 } else { 4 };
        assert!(number(&bytes, count).unwrap() < 100);
        bytes[count..count + 4].copy_from_slice(&0x7fff_ffffu32.to_le_bytes());
        fix_checksums(&mut bytes);
        let (memory, result) = peak(|| dfm::read(&bytes));
        let error = result.unwrap_err();
        assert!(memory < 64 << 10, "{}: {memory} bytes, {error}", tag.escape_ascii());
    }
}
