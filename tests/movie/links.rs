//! Names of the movie's file: links are followed, a file with several names keeps them, and a movie that cannot get its name is kept under another.

use crate::frames::{disc, rate, write};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_movie::{
    MOVIE_FORMATS, Movie, MovieError, MovieFormat, MovieReport, MovieSettings, MovieTarget,
};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

const SIZE: [u32; 2] = [16, 16];

fn movie(format: &MovieFormat, target: MovieTarget) -> Result<MovieReport, MovieError> {
    let frames = (0..3).map(|number| disc(SIZE, number, true));
    write(format.name, &MovieSettings::new(SIZE, rate("24")), target, frames)
}

fn faulty(files: &FaultyFiles, path: &Path) -> MovieTarget {
    MovieTarget::Path { files: Arc::new(files.clone()), path: path.to_path_buf() }
}

/// Returns the bytes of the movie.
fn wanted(format: &MovieFormat) -> Vec<u8> {
    let folder = Folder::new("movie-wanted");
    fs::read(movie(format, MovieTarget::path(folder.join("it"))).unwrap().path.unwrap()).unwrap()
}

/// Returns the content of a folder by the names of its files.
fn content(folder: &Folder) -> BTreeMap<String, Vec<u8>> {
    let files = fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().path());
    files
        .map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(&path).unwrap()))
        .collect()
}

/// Returns the formats whose movie is one file.
fn single_files() -> impl Iterator<Item = &'static MovieFormat> {
    MOVIE_FORMATS.iter().filter(|format| !format.is_sequence)
}

#[cfg(unix)]
#[test]
fn a_movie_replaces_the_file_to_which_a_link_leads_and_not_the_link() {
    for format in MOVIE_FORMATS {
        let folder = Folder::new("movie-link");
        fs::create_dir(folder.join("other")).unwrap();
        let file = folder.join("other/movie");
        fs::write(&file, "old").unwrap();
        let name = if format.is_sequence { "it.0002" } else { "it" };
        std::os::unix::fs::symlink("other/movie", folder.join(name)).unwrap();
        let target = folder.join(if format.is_sequence { "it.####" } else { "it" });
        let report = movie(format, MovieTarget::path(target)).unwrap();
        assert!(fs::symlink_metadata(folder.join(name)).unwrap().is_symlink(), "{}", format.name);
        assert_eq!(report.path.unwrap(), fs::canonicalize(&file).unwrap());
        assert!(fs::read(&file).unwrap().len() > 3, "{}", format.name);
        assert_eq!(fs::read_dir(folder.join("other")).unwrap().count(), 1);
    }
}

#[cfg(unix)]
#[test]
fn all_names_of_a_file_show_the_movie() {
    for format in single_files() {
        let folder = Folder::new("movie-names");
        fs::write(folder.join("it"), vec![7; 2 << 20]).unwrap();
        fs::hard_link(folder.join("it"), folder.join("other")).unwrap();
        let report = movie(format, MovieTarget::path(folder.join("it"))).unwrap();
        let wanted = wanted(format);
        assert_eq!(report.bytes, wanted.len() as u64);
        let names = ["it", "other"].map(str::to_owned);
        assert!(content(&folder) == names.map(|name| (name, wanted.clone())).into(), "{}", format.name);
        // A later one does so, too.
        movie(format, MovieTarget::path(folder.join("other"))).unwrap();
        assert_eq!(fs::read(folder.join("it")).unwrap(), wanted);
    }
}

#[cfg(unix)]
#[test]
fn a_frame_with_several_names_keeps_them() {
    for format in MOVIE_FORMATS.iter().filter(|format| format.is_sequence) {
        let folder = Folder::new("movie-names-frame");
        fs::write(folder.join("it.0001"), "old").unwrap();
        fs::hard_link(folder.join("it.0001"), folder.join("other")).unwrap();
        movie(format, MovieTarget::path(folder.join("it.####"))).unwrap();
        let content = content(&folder);
        assert!(content["other"].len() > 3 && content["other"] == content["it.0001"], "{}", format.name);
        assert_eq!(content.len(), 4, "{}", format.name);
    }
}

#[cfg(unix)]
#[test]
fn every_call_that_fails_leaves_the_old_content_of_a_file_with_several_names_or_the_movie() {
    let format = single_files().last().unwrap();
    let wanted = wanted(format);
    let old = vec![7; 9_000];
    let run = |files: &FaultyFiles| {
        let folder = Folder::new("movie-names-faults");
        fs::write(folder.join("it"), &old).unwrap();
        fs::hard_link(folder.join("it"), folder.join("other")).unwrap();
        let written = movie(format, faulty(files, &folder.join("it")));
        (written, content(&folder))
    };
    let counting = FaultyFiles::once(u64::MAX, Fault::Io);
    run(&counting).0.unwrap();
    for call in 1..=counting.calls() {
        for fault in [Fault::Io, Fault::Full, Fault::Interrupted] {
            let (written, content) = run(&FaultyFiles::once(call, fault));
            let about = format!("call {call}, {fault:?}, {written:?}, {:?}", content.keys());
            let [it, other] = ["it", "other"].map(|name| &content[name]);
            assert_eq!(it, other, "{about}");
            let copy = content.get(".it.dragonfly-old");
            match written {
                Ok(report) if report.left_out == 0 => {
                    assert!(*it == wanted && copy.is_none(), "{about}")
                }
                // The frames for which there was room.
                Ok(_) => {
                    assert!(fault == Fault::Full && *it != old && it.len() < wanted.len(), "{about}");
                    assert!(copy.is_none(), "{about}");
                }
                Err(_) => {
                    assert!(!fault.is_harmless(), "{about}");
                    assert!(*it == old || *it == wanted, "{about}");
                    assert!(copy.is_none_or(|copy| *copy == old), "{about}");
                }
            }
            // Other files are the complete movie, or begin with a dot.
            let rest = content
                .iter()
                .filter(|(name, _)| !name.starts_with('.') && *name != "it" && *name != "other");
            assert!(rest.clone().all(|(name, bytes)| name == "it (1)" && *bytes == wanted), "{about}");
        }
    }
}

#[cfg(unix)]
#[test]
fn a_file_whose_last_save_was_interrupted_is_not_overwritten() {
    for format in single_files() {
        let folder = Folder::new("movie-interrupted");
        fs::write(folder.join("it"), "torn").unwrap();
        fs::write(folder.join(".it.dragonfly-old"), "old").unwrap();
        let settings = MovieSettings::new(SIZE, rate("24"));
        let begun = Movie::begin(format, &settings, MovieTarget::path(folder.join("it")));
        let error = begun.unwrap_err().to_string();
        assert!(error.contains("an earlier save was interrupted"), "{error}");
        assert_eq!(content(&folder)["it"], b"torn");
    }
}

#[test]
fn a_complete_movie_that_cannot_replace_the_old_file_is_kept_under_another_name() {
    for format in single_files() {
        let folder = Folder::new("movie-kept");
        let path = folder.join("it.mov");
        let counting = FaultyFiles::once(u64::MAX, Fault::Io);
        movie(format, faulty(&counting, &path)).unwrap();
        let wanted = fs::read(&path).unwrap();
        fs::write(&path, "old").unwrap();
        // The renaming is the same call with an old file: each is counted from the last.
        let counting = FaultyFiles::once(u64::MAX, Fault::Io);
        movie(format, faulty(&counting, &path)).unwrap();
        let rename = counting.names().iter().rposition(|name| *name == "rename").unwrap() as u64 + 1;
        fs::write(&path, "old").unwrap();
        for number in 1..=2 {
            let error = movie(format, faulty(&FaultyFiles::once(rename, Fault::Full), &path)).unwrap_err();
            let text = error.to_string();
            assert!(
                text.contains("the disk is full") && text.contains("the movie is complete in "),
                "{text}"
            );
            let MovieError::Kept { kept, .. } = error else { panic!("{text}") };
            assert!(kept.ends_with(format!("it ({number}).mov")), "{text}");
            assert_eq!(fs::read(&path).unwrap(), b"old");
            assert!(fs::read(&kept).unwrap() == wanted, "{}", format.name);
            assert_eq!(content(&folder).len() as u64, 1 + number, "{}", format.name);
        }
    }
}
