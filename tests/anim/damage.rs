//! Damaged files: random damage, and damage at every byte. Nothing panics, hangs, overflows the stack or uses much
//! memory, and a model that is read nevertheless is sound.

use crate::doors::MemoryFs;
use crate::seeds::{Seed, seeds};
use crate::trial::{keep, on_small_stack, trial};
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::random::seed;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// Words that have a meaning in a glTF file.
const WORDS: &[&[u8]] = &[
    b"{}",
    b"[]",
    b"[[[[",
    b"}}",
    b"null",
    b"\"\"",
    b"-1",
    b"1e400",
    b"\\u0000",
    b"\"node\":0,",
    b"\"mesh\":0,",
    b"\"skin\":0,",
    b"\"children\":[0,1],",
    b"\"matrix\":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0],",
    b"\"scale\":[0,0,0],",
    b"\"count\":0,",
    b"\"byteOffset\":1,",
    b"\"byteStride\":4,",
    b"\"sparse\":{},",
    b"\"normalized\":true,",
    b"\"interpolation\":\"CUBICSPLINE\",",
    b"\"path\":\"weights\",",
    b"5120",
    b"5121",
    b"5122",
    b"5123",
    b"5125",
    b"5126",
    b"VEC3",
    b"VEC4",
    b"SCALAR",
    b"MAT4",
    b"JOINTS_1",
    b"WEIGHTS_1",
    b"\"targets\":[{}],",
    b"\"mode\":5,",
    b"\x00\x00\xc0\x7f",
    b"\x00\x00\x80\x7f",
    b"\x00\x00\x00\x80",
    b"BIN\0",
    b"JSON",
    b"glTF",
];

/// A file that broke a guarantee.
struct BrokenGuarantee {
    seed: String,
    what: String,
    bytes: Vec<u8>,
}

fn report(broken: Vec<BrokenGuarantee>) {
    let lines: Vec<String> = broken
        .iter()
        .take(20)
        .enumerate()
        .map(|(number, broken)| {
            let path = keep(&format!("{number}-{}", broken.seed), &broken.bytes);
            format!("{}: {} ({})", broken.seed, broken.what, path.display())
        })
        .collect();
    assert!(broken.is_empty(), "{} files broke a guarantee:\n{}", broken.len(), lines.join("\n"));
}

#[test]
fn two_hundred_thousand_mutants_do_no_harm() {
    const THREADS: usize = 2;
    const MUTANTS: usize = 200_000;
    let first_seed = seed(20_260);
    println!("DRAGONFLY_SEED={first_seed}");
    let files: Arc<Vec<Vec<u8>>> =
        Arc::new(seeds().into_iter().map(|seed| seed.bytes).filter(|bytes| bytes.len() <= 8 << 10).collect());
    let done = Arc::new(AtomicUsize::new(0));
    let read = Arc::new(AtomicUsize::new(0));
    let (working, workers) = channel::<()>();
    let work = (0..THREADS).map(|thread| {
        let (files, done, read, working) = (files.clone(), done.clone(), read.clone(), working.clone());
        on_small_stack(move || {
            let _working = working;
            let mut mutator = Mutator::new(first_seed + thread as u64, WORDS);
            let door = MemoryFs::default();
            let mut broken = Vec::new();
            for number in 0..MUTANTS / THREADS {
                let bytes = mutator.mutant(&files);
                match trial("mutant.gltf", &bytes, &door) {
                    Ok(was_read) => _ = read.fetch_add(usize::from(was_read), Ordering::Relaxed),
                    Err(what) => {
                        let seed = format!("mutant-{first_seed}-{thread}-{number}");
                        broken.push(BrokenGuarantee { seed, what, bytes });
                    }
                }
                done.fetch_add(1, Ordering::Relaxed);
            }
            broken
        })
    });
    let work: Vec<_> = work.collect();
    drop(working);
    watch(&done, &workers);
    let broken: Vec<BrokenGuarantee> = work.into_iter().flat_map(|thread| thread.join().unwrap()).collect();
    println!("{} mutants, {} of them read", done.load(Ordering::Relaxed), read.load(Ordering::Relaxed));
    report(broken);
    assert!(read.load(Ordering::Relaxed) > MUTANTS / 20, "too few mutants are read to test what comes after");
}

/// Waits until every sender is dropped; fails if no file is finished for a minute.
fn watch(done: &AtomicUsize, workers: &Receiver<()>) {
    let (mut last, mut idle) = (0, 0);
    while workers.recv_timeout(Duration::from_secs(1)) == Err(RecvTimeoutError::Timeout) {
        let now = done.load(Ordering::Relaxed);
        idle = if now == last { idle + 1 } else { 0 };
        last = now;
        assert!(idle < 60, "a file hangs: the one after {now}");
    }
}

/// Calls `each` with the file truncated at each byte, and with each byte set to 0 and 255 and changed by one; for files
/// over 4 KiB at 512 bytes.
fn damaged(file: &[u8], mut each: impl FnMut(&[u8], String)) {
    let places = if file.len() <= 4 << 10 { file.len() } else { 512 };
    let mut bytes = file.to_vec();
    for number in 0..places {
        let at = number * file.len() / places;
        each(&file[..at], format!("cut at {at}"));
        for damage in [0, 0xff, file[at].wrapping_add(1), file[at].wrapping_sub(1)] {
            bytes[at] = damage;
            each(&bytes, format!("byte {at} set to {damage}"));
        }
        bytes[at] = file[at];
    }
}

#[test]
fn damage_at_every_place_does_no_harm() {
    let seeds = Arc::new(seeds());
    assert!(seeds.len() >= 30);
    let next = Arc::new(AtomicUsize::new(0));
    let done = Arc::new(AtomicUsize::new(0));
    let (working, workers) = channel::<()>();
    let work = (0..2).map(|_| {
        let (seeds, next, done, working) = (seeds.clone(), next.clone(), done.clone(), working.clone());
        on_small_stack(move || {
            let _working = working;
            let mut broken = Vec::new();
            let door = MemoryFs::default();
            while let Some(Seed { name, bytes }) = seeds.get(next.fetch_add(1, Ordering::Relaxed)) {
                damaged(bytes, |bytes, damage| {
                    done.fetch_add(1, Ordering::Relaxed);
                    if let Err(what) = trial(name, bytes, &door) {
                        broken.push(BrokenGuarantee {
                            seed: name.clone(),
                            what: format!("{damage}: {what}"),
                            bytes: bytes.to_vec(),
                        });
                    }
                });
            }
            broken
        })
    });
    let work: Vec<_> = work.collect();
    drop(working);
    watch(&done, &workers);
    let broken: Vec<BrokenGuarantee> = work.into_iter().flat_map(|thread| thread.join().unwrap()).collect();
    println!("{} seeds, {} damaged files", seeds.len(), done.load(Ordering::Relaxed));
    report(broken);
}
