//! Reading stops when it is cancelled and when the memory budget is used up, and takes a bounded time.

use crate::doors::MemoryFs;
use crate::fixture::Fixture;
use crate::seeds::seeds;
use crate::trial::{memory_for, time_for};
use dragonfly_anim::format::{ByteBudget, ImportError, ReadOptions, read};
use dragonfly_kit::counting::peak;
use serde_json::json;
use std::cell::Cell;
use std::time::{Duration, Instant};

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

#[test]
fn a_cancel_takes_effect_within_a_quarter_of_a_second() {
    let bytes = large(48);
    let start = Instant::now();
    read("large.glb", &bytes, &MemoryFs::default(), &ReadOptions::default()).unwrap();
    let whole = start.elapsed();
    let (mut worst, mut cancelled) = (Duration::ZERO, 0);
    for step in 0..10 {
        let (start, asked) = (Instant::now(), Cell::new(None::<Instant>));
        // In the first half, since a second run may be faster than the first.
        let at = whole * step / 20;
        let is_cancelled = || {
            let now = Instant::now();
            let due = now - start >= at;
            if due && asked.get().is_none() {
                // The cancel flag was set at `at`; measures the time until it was polled.
                asked.set(Some(start + at));
            }
            due
        };
        let options = ReadOptions { is_cancelled: &is_cancelled, ..ReadOptions::default() };
        if let Err(error) = read("large.glb", &bytes, &MemoryFs::default(), &options) {
            assert_eq!(error, ImportError::Cancelled);
            worst = worst.max(asked.get().unwrap().elapsed());
            cancelled += 1;
        }
    }
    println!("{whole:?} for the whole file; {cancelled} cancels, answered in {worst:?} at most");
    assert!(cancelled >= 5 && worst <= Duration::from_millis(250), "{worst:?}");
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
