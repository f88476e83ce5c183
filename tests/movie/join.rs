//! Parts of an MP4 that are encoded apart are joined to the movie that one pass writes.

use crate::frames::{disc, noise, rate, write, write_disc};
use crate::judge::{ffmpeg, probe};
use dragonfly_kit::counting::peak;
use dragonfly_kit::folder::Folder;
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::random::{Random, seed};
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_movie::{GROUP, MovieSettings, MovieTarget, has_movie, join_movies, movie_parts, part_frames};
use dragonfly_store::RealFiles;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const SIZE: [u32; 2] = [48, 32];

fn settings() -> MovieSettings {
    MovieSettings { tag: "duel 3".to_owned(), ..MovieSettings::new(SIZE, rate("24000/1001")) }
}

/// Writes the parts of a movie of `count` frames. Returns their paths.
fn parts(folder: &Folder, count: u64, length: u64, settings: &MovieSettings) -> Vec<PathBuf> {
    let write = |(first, count): (u64, u64)| {
        let path = folder.join(&format!("part {first}.mp4"));
        write_disc("mp4", &MovieSettings { first, ..settings.clone() }, &path, count, false);
        path
    };
    movie_parts(0..count, length).into_iter().map(write).collect()
}

fn join(parts: &[PathBuf], count: u64, folder: &Folder) -> Result<Vec<u8>, String> {
    let path = folder.join("joined.mp4");
    join_movies(parts, 0..count, MovieTarget::path(&path), None).map_err(|error| error.to_string())?;
    Ok(std::fs::read(path).unwrap())
}

#[test]
fn parts_cover_every_frame_once_and_begin_at_groups() {
    for (frames, length) in [(0, 1), (1, 0), (193, 48), (200, 50), (96, 96), (1000, u64::MAX)] {
        for start in [0, 31, 48, 500] {
            let end = start.max(frames);
            let parts = movie_parts(start..end, length);
            let mut next = start;
            for (first, count) in parts {
                assert!(first == next && count > 0 && (first == start || first % GROUP == 0));
                next += count;
            }
            assert_eq!(next, end);
        }
    }
    assert_eq!(movie_parts(30..200, 96), [(30, 66), (96, 96), (192, 8)]);
}

#[test]
fn parts_of_a_movie_that_begins_in_the_middle_of_a_group_are_joined_to_the_bytes_of_one_pass() {
    let folder = Folder::new("join-range");
    let frames: Range<u64> = 29..29 + 2 * GROUP;
    let file = |name: &str, first: u64, count| {
        let path = folder.join(name);
        write_disc("mp4", &MovieSettings { first, ..settings() }, &path, count, false);
        path
    };
    let one = file("one.mp4", frames.start, frames.end - frames.start);
    let parts: Vec<PathBuf> = movie_parts(frames.clone(), GROUP)
        .into_iter()
        .map(|(first, count)| file(&format!("{first}.mp4"), first, count))
        .collect();
    assert_eq!(parts.len(), 3);
    let joined = folder.join("joined.mp4");
    join_movies(&parts, frames.clone(), MovieTarget::path(&joined), None).unwrap();
    assert!(std::fs::read(&one).unwrap() == std::fs::read(&joined).unwrap());
    if ffmpeg() {
        assert_eq!(probe(&joined, "v:0")["nb_read_frames"], (2 * GROUP).to_string());
    }
    // A part that begins in the middle of a group is no later part.
    let short = file("short.mp4", 0, 29);
    let error = join_movies(&[short, one], 0..frames.end, MovieTarget::path(&joined), None);
    let error = error.unwrap_err().to_string();
    assert!(error.contains("one.mp4: it begins at frame 29, in the middle of a group"), "{error}");
}

#[test]
fn a_complete_movie_is_recognized_by_its_frames_and_settings() {
    let folder = Folder::new("join-there");
    let path = folder.join("it.mp4");
    let own = MovieSettings { first: GROUP, ..settings() };
    write_disc("mp4", &own, &path, 5, false);
    let there = |settings: &MovieSettings, frames| has_movie(&RealFiles, &path, settings, frames);
    assert!(there(&own, 5));
    assert_eq!(part_frames(&RealFiles, &path).unwrap(), GROUP..GROUP + 5);
    assert!(!there(&own, 4) && !there(&own, 6));
    assert!(!there(&settings(), 5));
    assert!(!there(&MovieSettings { tag: "duel 4".to_owned(), ..own.clone() }, 5));
    assert!(!there(&MovieSettings { coarseness: 25, ..own.clone() }, 5));
    assert!(!has_movie(&RealFiles, &folder.join("none.mp4"), &own, 5));
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 1]).unwrap();
    assert!(!there(&own, 5));
}

#[test]
fn parts_of_random_lengths_are_joined_in_any_order_to_the_bytes_of_one_pass() {
    let folder = Folder::new("join");
    let seed = seed(31_007);
    let mut random = Random::new(seed);
    let count = 2 * GROUP + 1 + random.below(3 * GROUP as usize) as u64;
    let one = folder.join("one.mp4");
    // Pictures that have nothing in common at some of the borders.
    let frames: Vec<Vec<u8>> = (0..count)
        .map(|number| if random.below(9) == 0 { noise(SIZE, &mut random) } else { disc(SIZE, number, false) })
        .collect();
    write("mp4", &settings(), MovieTarget::path(&one), frames.clone()).unwrap();
    let wanted = std::fs::read(&one).unwrap();
    for round in 0..6 {
        // Parts of several groups each, of different lengths.
        let mut paths = Vec::new();
        let mut first = 0;
        while first < count {
            let length = (GROUP * (1 + random.below(3) as u64)).min(count - first);
            let path = folder.join(&format!("{first:06}.mp4"));
            let part = frames[first as usize..(first + length) as usize].to_vec();
            write("mp4", &MovieSettings { first, ..settings() }, MovieTarget::path(&path), part).unwrap();
            paths.insert(random.below(paths.len() + 1), path);
            first += length;
        }
        let joined = join(&paths, count, &folder).unwrap();
        assert!(
            joined == wanted,
            "seed {seed}, round {round}: {} parts of {count} frames differ",
            paths.len()
        );
    }
    if ffmpeg() {
        assert_eq!(probe(&folder.join("joined.mp4"), "v:0")["nb_read_frames"], count.to_string());
    }
}

#[test]
fn a_joined_part_is_joined_again() {
    let folder = Folder::new("join-again");
    let all = parts(&folder, 5 * GROUP, GROUP, &settings());
    let wanted = join(&all, 5 * GROUP, &folder).unwrap();
    let middle = folder.join("middle.mp4");
    join_movies(&all[1..4], GROUP..4 * GROUP, MovieTarget::path(&middle), None).unwrap();
    let joined = join(&[all[4].clone(), middle, all[0].clone()], 5 * GROUP, &folder).unwrap();
    assert!(joined == wanted);
}

#[test]
fn parts_that_do_not_belong_together_are_refused_by_name() {
    let folder = Folder::new("join-refused");
    let all = parts(&folder, 3 * GROUP - 5, GROUP, &settings());
    let other = |name: &str, settings: MovieSettings, count| {
        let path = folder.join(name);
        write_disc("mp4", &settings, &path, count, false);
        path
    };
    let second = MovieSettings { first: GROUP, ..settings() };
    let short = other("short.mp4", settings(), 5);
    let cases = [
        (
            vec![all[0].clone(), all[2].clone()],
            "part 96.mp4: it begins at frame 96, and the frames from 48 on are missing",
        ),
        (
            vec![all[0].clone(), all[1].clone(), all[1].clone()],
            "part 48.mp4: it begins at frame 48, which is in another part",
        ),
        (vec![all[1].clone(), short], "part 48.mp4: it begins at frame 48, and the frames from 5 on"),
        (
            vec![all[1].clone(), all[2].clone()],
            "part 48.mp4: it begins at frame 48, and the frames from 0 on are missing",
        ),
        (
            vec![all[0].clone(), all[1].clone()],
            "part 48.mp4: it ends before frame 96, and the frames from there",
        ),
        (
            vec![
                all[0].clone(),
                all[1].clone(),
                other("long.mp4", MovieSettings { first: 2 * GROUP, ..settings() }, GROUP),
            ],
            "long.mp4: it goes on after the end of the movie, which has 139 frames",
        ),
        (
            vec![all[0].clone(), other("tag.mp4", MovieSettings { tag: String::new(), ..second.clone() }, 5)],
            "tag.mp4: it is a part of another movie",
        ),
        (
            vec![all[0].clone(), other("qp.mp4", MovieSettings { coarseness: 30, ..second.clone() }, 5)],
            "qp.mp4: it is a part of another movie",
        ),
        (
            vec![all[0].clone(), other("size.mp4", MovieSettings { size: [64, 32], ..second.clone() }, 5)],
            "size.mp4: its pictures have another size",
        ),
        (
            vec![all[0].clone(), other("rate.mp4", MovieSettings { rate: rate("24"), ..second.clone() }, 5)],
            "rate.mp4: it has another number of frames",
        ),
        (vec![all[0].clone(), folder.join("none.mp4")], "none.mp4: "),
        (vec![], "no frames"),
    ];
    for (parts, words) in cases {
        let error = join(&parts, 3 * GROUP - 5, &folder).unwrap_err();
        assert!(error.contains(words), "{error}");
        assert!(!folder.join("joined.mp4").exists(), "{words}");
    }
}

#[test]
fn a_damaged_part_is_an_error_or_a_movie() {
    let folder = Folder::new("join-damage");
    let all = parts(&folder, GROUP + 3, GROUP, &settings());
    let first = vec![std::fs::read(&all[0]).unwrap()];
    let seed = seed(5_551);
    let mut mutator =
        Mutator::new(seed, &[b"moov", b"stsz", b"stco", b"stsc", b"udta", b"\xff\xff\xff\xff", b"\0\0\0\0"]);
    let mut joined = 0;
    for number in 0..1_500 {
        std::fs::write(&all[0], mutator.mutant(&first)).unwrap();
        match join(&all, GROUP + 3, &folder) {
            Ok(_) => joined += 1,
            Err(error) => assert!(
                error.contains("part 0.mp4") || error.contains("part 48.mp4"),
                "seed {seed}, {number}: {error}"
            ),
        }
    }
    assert!(joined > 0, "seed {seed}");
}

#[test]
fn a_part_whose_tables_claim_large_frames_is_refused_without_the_memory_for_them() {
    let folder = Folder::new("join-large");
    let all = parts(&folder, 2 * GROUP, GROUP, &settings());
    let bytes = std::fs::read(&all[0]).unwrap();
    let table = bytes.windows(4).position(|kind| kind == b"stsz").unwrap();
    // The claimed size of the first frame, and of the file.
    for (size, length, words) in [
        (200 << 20, bytes.len() as u64, "the file ends before frame 0"),
        (u32::MAX, bytes.len() as u64, "frame 0 has 4294967295 bytes"),
        (300 << 20, 1 << 30, "frame 0 has 314572800 bytes"),
    ] {
        let mut damaged = bytes.clone();
        damaged[table + 16..table + 20].copy_from_slice(&size.to_be_bytes());
        std::fs::write(&all[0], damaged).unwrap();
        std::fs::OpenOptions::new().write(true).open(&all[0]).unwrap().set_len(length).unwrap();
        let (memory, joined) = peak(|| join(&all, 2 * GROUP, &folder));
        let error = joined.unwrap_err();
        assert!(error.contains(words), "{error}");
        assert!(memory < 8 << 20, "{memory} bytes for a frame of {size}");
    }
}

/// Returns how many files of a folder this process has open.
#[cfg(target_os = "linux")]
fn open_files(folder: &std::path::Path) -> usize {
    let links = std::fs::read_dir("/proc/self/fd").unwrap().flatten();
    links
        .filter_map(|link| std::fs::read_link(link.path()).ok())
        .filter(|path| path.starts_with(folder))
        .count()
}

#[cfg(target_os = "linux")]
#[test]
fn many_parts_are_joined_with_one_of_them_open_at_a_time() {
    let folder = Folder::new("join-many");
    let all = parts(&folder, 12 * GROUP, GROUP, &settings());
    let join = |files: FaultyFiles| {
        let target = MovieTarget::Path { files: Arc::new(files), path: folder.join("joined.mp4") };
        join_movies(&all, 0..12 * GROUP, target, None).unwrap();
    };
    let files = FaultyFiles::once(u64::MAX, Fault::Io);
    join(files.clone());
    let most = Arc::new(AtomicUsize::new(0));
    for call in (1..=files.calls()).step_by(7) {
        let (most, place) = (Arc::clone(&most), folder.path().canonicalize().unwrap());
        join(FaultyFiles::meddling(call, move || {
            most.fetch_max(open_files(&place), Ordering::Relaxed);
        }));
    }
    // A part, and the movie that grows.
    assert_eq!(most.load(Ordering::Relaxed), 2);
}

#[test]
fn a_part_that_claims_more_frames_than_it_has_bytes_is_refused() {
    let folder = Folder::new("join-claims");
    let all = parts(&folder, 2 * GROUP, GROUP, &settings());
    let mut bytes = std::fs::read(&all[0]).unwrap();
    let at = |kind: &[u8]| bytes.windows(4).position(|found| found == kind).unwrap();
    let (sizes, durations, chunks) = (at(b"stsz"), at(b"stts"), at(b"stsc"));
    let many = 4_000_000_000_u32.to_be_bytes();
    // All of the same size, so that there is no table of sizes; and all in one chunk.
    bytes[sizes + 8..sizes + 12].copy_from_slice(&1_u32.to_be_bytes());
    bytes[sizes + 12..sizes + 16].copy_from_slice(&many);
    bytes[durations + 12..durations + 16].copy_from_slice(&many);
    bytes[chunks + 16..chunks + 20].copy_from_slice(&many);
    std::fs::write(&all[0], bytes).unwrap();
    let (memory, joined) = peak(|| join(&all, 2 * GROUP, &folder));
    let error = joined.unwrap_err();
    assert!(error.contains("part 0.mp4"), "{error}");
    assert!(memory < 8 << 20, "{memory} bytes: {error}");
}
