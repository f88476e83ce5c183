//! Reading stops when it is cancelled and when the memory budget is used up, and takes a bounded time.

use crate::doors::MemoryFs;
use crate::fixture::Fixture;
use crate::seeds::seeds;
use crate::trial::{memory_for, time_for};
use dragonfly_anim::format::{ByteBudget, ImportError, ReadOptions, read};
use dragonfly_anim::limits::CANCEL_EVERY;
use dragonfly_kit::counting::peak;
use serde_json::json;
use std::cell::Cell;
use std::time::Instant;

/// A file of about `megabytes`: many vertices and many nodes.
fn large(megabytes: usize) -> Vec<u8> {
    let mut fixture = Fixture::new();
    let vertices = megabytes * 500_000 / 12;
    let positions: Vec<u8> = (0..vertices * 3).flat_map(|number| (number as f32).to_le_bytes()).collect();
    let accessor = fixture.accessor("VEC3", 5126, vertices, &positions);
    fixture.set("/meshes/1", json!({"primitives": [{"attributes": {"POSITION": accessor}}]}));
    let first = fixture.json["nodes"].as_array().unwrap().len();
    let nodes = (0..megabytes * 9_000)
        .map(|node| json!({"name": format!("node {node}"), "translation": [node, 0, 0.5]}));
    fixture.json["nodes"].as_array_mut().unwrap().extend(nodes);
    fixture.set(&format!("/nodes/{first}/mesh"), json!(1)).set("/scenes/0/nodes/2", json!(first));
    fixture.glb()
}

#[test]
fn every_refused_charge_is_a_clear_error() {
    let fixture = Fixture::new();
    let door = MemoryFs::with(&[("all.bin", &fixture.bin)]);
    for (name, bytes) in
        [("a.glb", fixture.glb()), ("a.gltf", fixture.gltf()), ("a.gltf", fixture.gltf_with_file())]
    {
        let mut request = 0;
        loop {
            let options = ReadOptions { budget: ByteBudget::failing_at(request), ..ReadOptions::default() };
            match read(name, &bytes, &door, &options) {
                Err(ImportError::TooLarge { .. } | ImportError::External { .. }) => request += 1,
                Err(other) => panic!("charge {request}: {other}"),
                Ok(imported) => {
                    // An image without memory is left out; every other failure is an error.
                    if request >= options.budget.requests() {
                        assert_eq!(imported.warnings, []);
                        break;
                    }
                    request += 1;
                }
            }
        }
        println!("{name}: {request} charges, each refused once");
        assert!(request > 40);
    }
}

#[test]
fn a_small_budget_is_not_exceeded() {
    let bytes = large(4);
    for limit in [1 << 10, 1 << 16, 1 << 20, 1 << 22, 1 << 24] {
        let options = ReadOptions { budget: ByteBudget::at_most(limit), ..ReadOptions::default() };
        let (memory, result) = peak(|| read("large.glb", &bytes, &MemoryFs::default(), &options));
        assert!(matches!(result, Err(ImportError::TooLarge { .. })), "{limit}");
        // Not charged: messages and small constants.
        assert!(memory <= limit + (64 << 10), "{memory} bytes with a limit of {limit}");
    }
}

#[test]
fn memory_and_time_stay_within_the_documented_limits() {
    for seed in seeds() {
        let (memory, _) =
            peak(|| read(&seed.name, &seed.bytes, &MemoryFs::default(), &ReadOptions::default()));
        // Far less than the guaranteed limit, most of which is for files larger than this.
        assert!(memory < (1 << 20) + 32 * seed.bytes.len() as u64, "{}: {memory}", seed.name);
    }
    for megabytes in [1, 8, 32] {
        let bytes = large(megabytes);
        let start = Instant::now();
        let options = ReadOptions::default();
        let (memory, result) = peak(|| read("large.glb", &bytes, &MemoryFs::default(), &options));
        let elapsed = start.elapsed();
        result.unwrap();
        println!(
            "{} bytes: {elapsed:?}, {memory} bytes at most, {} charged",
            bytes.len(),
            options.budget.used()
        );
        assert!(memory <= memory_for(bytes.len()) && memory <= 2 << 30);
        assert!(elapsed <= time_for(bytes.len()), "{elapsed:?}");
        assert!(options.budget.used() >= memory / 2, "charges cover the allocations");
    }
}

/// Number of megabytes of a file, and of the elements in it: vertices and nodes.
const CANCELLED: (usize, usize) = (8, 8 * 500_000 / 12 + 8 * 9_000);

#[test]
fn a_cancel_takes_effect_at_the_next_look_and_the_reader_looks_often() {
    let bytes = large(CANCELLED.0);
    let looks = Cell::new(0);
    let cancelled_at = |at: usize| {
        looks.set(0);
        let is_cancelled = || {
            looks.set(looks.get() + 1);
            looks.get() >= at
        };
        let options = ReadOptions { is_cancelled: &is_cancelled, ..ReadOptions::default() };
        read("large.glb", &bytes, &MemoryFs::default(), &options).err()
    };
    assert_eq!(cancelled_at(usize::MAX), None);
    let all = looks.get();
    // Counted instead of timed, because a busy machine is slower. A quarter of a second is time for millions of elements.
    assert!(all >= CANCELLED.1 / CANCEL_EVERY, "{all} looks for {} elements", CANCELLED.1);
    for at in 1..=all {
        assert_eq!(cancelled_at(at), Some(ImportError::Cancelled));
        assert_eq!(looks.get(), at, "the reader went on after the cancel");
    }
    println!("{all} looks for {} elements", CANCELLED.1);
}

#[test]
fn progress_increases_from_zero_to_one() {
    let reported = Cell::new((0.0, 0));
    let first = Cell::new(None);
    let progress = |part: f32| {
        assert!(part >= reported.get().0, "{part} after {}", reported.get().0);
        first.set(first.get().or(Some(part)));
        reported.set((part, reported.get().1 + 1));
    };
    let options = ReadOptions { progress: &progress, ..ReadOptions::default() };
    read("a.glb", &Fixture::new().glb(), &MemoryFs::default(), &options).unwrap();
    assert_eq!(first.get(), Some(0.0));
    assert_eq!(reported.get().0, 1.0);
    assert!(reported.get().1 >= 4);
}
