//! Files made by an enemy: every checksum right, anything else wrong. A model or an error, within the memory promised.

use super::frame::{mend, number, parts};
use super::golden::{file, model};
use super::made::Maker;
use crate::doors::MemoryFs;
use crate::soundness::faults_of_poses;
use crate::trial::{STACK, memory_for, on_small_stack};
use dragonfly_anim::format::{ReadOptions, dfm, read};
use dragonfly_kit::counting::peak;
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::random::{Random, seed};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What means something in such a file.
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

/// Reads `bytes` both ways; an error says which promise was broken. `true`: it was read.
fn tried(bytes: &[u8]) -> Result<bool, String> {
    let run = || {
        let (memory, exact) = peak(|| dfm::read(bytes));
        // Most of the promise is for files that are larger than this.
        if memory > (1 << 20) + 32 * bytes.len() as u64 {
            return Err(format!("took {memory} bytes for {}", bytes.len()));
        }
        if let Ok(exact) = &exact {
            // Whatever is read is sound enough to be written, and comes back.
            let again = dfm::write(exact).map_err(|error| format!("cannot be written: {error}"))?;
            let back = dfm::read(&again).map_err(|error| format!("cannot be read again: {error}"))?;
            if format!("{back:?}") != format!("{exact:?}") {
                return Err("does not come back".to_owned());
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
fn mutants_with_right_checksums_do_no_harm() {
    let first = seed(0x00DF_0001);
    println!("DRAGONFLY_SEED={first}");
    let work = on_small_stack(move || {
        let mut files = vec![file()];
        for number in 0..12 {
            let odd = if number % 2 == 0 { 0.0 } else { 0.05 };
            files.push(dfm::write(&Maker { random: Random::new(first + number), odd }.model()).unwrap());
        }
        let mutants: u64 = if std::env::var_os("DRAGONFLY_LONG").is_some() { 2_000_000 } else { 60_000 };
        let mut read = 0;
        for number in 0..mutants {
            let seed = first.wrapping_add(number);
            let mut bytes = Mutator::new(seed, WORDS).mutant(&files);
            mend(&mut bytes);
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
            mend(&mut bytes);
            match tried(&bytes) {
                Ok(done) => read += usize::from(done),
                Err(what) => panic!("{number:#x} at byte {at}: {what}"),
            }
        }
    }
    println!("{read} read of {}", (file.len() - 4) * numbers.len());
}

/// A file in which elements are as small in the file and as large in memory as can be.
#[test]
fn small_elements_take_no_more_memory_than_promised() {
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
fn a_count_beyond_the_bytes_is_refused_before_anything_is_taken() {
    for (index, (tag, at, _)) in parts(&file()).unwrap().into_iter().enumerate() {
        let mut bytes = file();
        let count = at + if index < 6 { 0 } else { 4 };
        assert!(number(&bytes, count).unwrap() < 100);
        bytes[count..count + 4].copy_from_slice(&0x7fff_ffffu32.to_le_bytes());
        mend(&mut bytes);
        let (memory, result) = peak(|| dfm::read(&bytes));
        let error = result.unwrap_err();
        assert!(memory < 64 << 10, "{}: {memory} bytes, {error}", tag.escape_ascii());
    }
}
