//! Damaged files that can be opened are saved or refused; nothing panics.

use crate::doors::MemoryFs;
use crate::save_support::Over;
use crate::seeds::seeds;
use crate::trial::{memory_for, on_small_stack, time_for};
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::format::gltf::save::{SourceFile, compact, plan};
use dragonfly_anim::format::{ReadOptions, read};
use dragonfly_kit::counting::peak;
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::random::{Random, seed};
use glam::Vec3;
use std::sync::Arc;
use std::time::Instant;

/// Words that have a meaning for a save.
const WORDS: &[&[u8]] = &[
    b"{}",
    b"[]",
    b"[[[[",
    b"}}",
    b"null",
    b"-1",
    b"1e400",
    b"\\u0061",
    b"\"node\":0,",
    b"\"sampler\":0,",
    b"\"name\":\"dragonfly.keys\",",
    b"\"byteOffset\":0,",
    b"\"byteStride\":4,",
    b"\"interpolation\":\"STEP\",",
    b"\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],",
    b"\"extras\":{},",
    b"\"extensions\":{},",
    b"BIN\0",
    b"JSON",
    b"\"uri\":\"data:,abc\",",
    b"\"byteLength\":4,",
    b"\"animations\":[],",
];

/// Opens, edits at random, saves, opens again; returns whether it got that far.
fn attempt(bytes: &[u8], random: &mut Random) -> Result<bool, String> {
    let (door, options) = (MemoryFs::default(), ReadOptions::default());
    let source = SourceFile::open("mutant.gltf", bytes, &door, &options);
    let imported = read("mutant.gltf", bytes, &door, &options);
    let (Ok(source), Ok(imported)) = (source, imported) else { return Ok(false) };
    let model = imported.model;
    let mut takes: Vec<_> = model
        .animation
        .takes
        .iter()
        .enumerate()
        .map(|(index, take)| dragonfly_anim::format::EditedTake { origin: Some(index), take: take.clone() })
        .collect();
    let same = plan(&source, &model, &takes).map_err(|error| format!("unedited: {error}"))?;
    if same.write()[0].bytes != bytes {
        return Err("it changes without an edit".to_owned());
    }
    if takes.is_empty() {
        let take = dragonfly_anim::data::Take { tracks: tracks(&model), ..Default::default() };
        takes.push(dragonfly_anim::format::EditedTake { origin: None, take: Arc::new(take) });
    }
    let bones = model.animation.skeleton.len();
    let index = random.below(takes.len());
    if random.below(4) == 0 {
        takes.push(takes[index].clone());
    }
    if bones > 0 {
        let track = &mut Arc::make_mut(&mut takes[index].take).tracks[random.below(bones)];
        let channel = Channel::new([0.0, 1.0], [Vec3::ONE, Vec3::X], Interpolation::Linear);
        match random.below(3) {
            0 => track.translation = channel,
            1 => track.scale = channel,
            _ => *track = dragonfly_anim::data::Track { bone: track.bone, ..Default::default() },
        }
    }
    let Ok(plan) = plan(&source, &model, &takes) else { return Ok(false) };
    let files = plan.write();
    let over = Over::new(&files, &door);
    let written = &files.last().unwrap().bytes;
    let again = read("mutant.gltf", written, &over, &options)
        .map_err(|error| format!("cannot be opened again: {error}"))?
        .model;
    if again.animation.takes.len() != takes.len() {
        return Err("takes are missing".to_owned());
    }
    let source =
        SourceFile::open("mutant.gltf", written.clone(), &over, &options).map_err(|e| e.to_string())?;
    let small = compact(&source).map_err(|error| format!("compacting: {error}"))?.write();
    let over = Over::new(&small, &over);
    read("mutant.gltf", &small.last().unwrap().bytes, &over, &options)
        .map_err(|e| format!("compacted: {e}"))?;
    Ok(true)
}

fn tracks(model: &dragonfly_anim::data::ModelData) -> Vec<dragonfly_anim::data::Track> {
    let bones = 0..model.animation.skeleton.len() as u32;
    bones.map(|bone| dragonfly_anim::data::Track { bone, ..Default::default() }).collect()
}

/// Returns the seeds that can be saved, and their files after one save.
fn files() -> Vec<Vec<u8>> {
    let mut files: Vec<Vec<u8>> =
        seeds().into_iter().map(|seed| seed.bytes).filter(|bytes| bytes.len() <= 8 << 10).collect();
    let fixture = crate::fixture::Fixture::new();
    for (name, bytes) in [("a.glb", fixture.glb()), ("a.gltf", fixture.gltf())] {
        let opened = crate::save_support::OpenedFile::alone(name, &bytes);
        let mut takes = opened.takes();
        crate::save_edits::shift(&mut takes, 0);
        let saved = opened.saved(&takes, &dragonfly_anim::format::NoFiles);
        files.push(saved.bytes().to_vec());
    }
    files
}

#[test]
fn damaged_files_are_saved_or_refused() {
    const MUTANTS: usize = 30_000;
    let first = seed(4_711);
    println!("DRAGONFLY_SEED={first}");
    let files = files();
    let run = on_small_stack(move || {
        let mut mutator = Mutator::new(first, WORDS);
        let mut random = Random::new(first);
        let (mut came, mut broken) = (0, Vec::new());
        for number in 0..MUTANTS {
            let bytes = mutator.mutant(&files);
            let start = Instant::now();
            let run = || peak(|| attempt(&bytes, &mut random));
            let run = std::panic::catch_unwind(std::panic::AssertUnwindSafe(run));
            // The file is read four times, in addition to being saved.
            if start.elapsed() > 8 * time_for(bytes.len()) {
                broken.push((number, format!("took {:?}", start.elapsed()), bytes.clone()));
            }
            match run.map(|(memory, result)| {
                if memory > memory_for(bytes.len()) { Err(format!("took {memory} bytes")) } else { result }
            }) {
                Ok(Ok(saved)) => came += usize::from(saved),
                Ok(Err(what)) => broken.push((number, what, bytes)),
                Err(_) => broken.push((number, "panics".to_owned(), bytes)),
            }
        }
        (came, broken)
    });
    let (came, broken) = run.join().unwrap();
    println!("{came} of {MUTANTS} saved");
    let lines: Vec<String> = broken
        .iter()
        .take(20)
        .map(|(number, what, bytes)| {
            format!("{number}: {what} ({})", crate::trial::keep(&format!("save-{number}"), bytes).display())
        })
        .collect();
    assert!(broken.is_empty(), "{} files broke a guarantee:\n{}", broken.len(), lines.join("\n"));
    assert!(came > MUTANTS / 20, "too few are saved");
}

#[test]
fn the_memory_for_a_json_text_is_proportional_to_its_values() {
    let many = |count: usize| {
        let mut text = b"{\"asset\":{\"version\":\"2.0\"},\"extras\":[0".to_vec();
        text.extend(b",0".repeat(count));
        text.extend(b"]}");
        text
    };
    let text = many(4_000_000);
    let (memory, opened) = peak(|| {
        SourceFile::open("many.gltf", text.clone(), &MemoryFs::default(), &ReadOptions::default()).unwrap()
    });
    println!("{memory} bytes for {}", text.len());
    assert!(memory < 32 * text.len() as u64, "{memory}");
    let (memory, plan) = peak(|| plan(&opened, &Default::default(), &[]).unwrap());
    assert!(plan.changes().is_empty() && memory < 1 << 20, "{memory}");
}
