//! Full disks: at every level of free space each kind of write either succeeds, or reports an error and leaves the old
//! content unchanged.

use dragonfly::app::store::{SETTINGS, Store};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::mounted::{Mounted, may_mount};
use dragonfly_store::{
    Autosave, ExpectedFile, FileSaveError, JournalEntry, Opening, RealFiles, SaveOptions, Versions, replace,
    save,
};
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Number of levels of free space, one page apart.
const LEVELS: usize = 64;

const PAGE: usize = 4096;

fn pages(pages: usize, byte: u8) -> Vec<u8> {
    vec![byte; pages * PAGE]
}

/// Returns the number of names in a folder, 0 if the folder does not exist.
fn count(folder: &Path) -> usize {
    fs::read_dir(folder).map_or(0, Iterator::count)
}

/// Leaves `free` pages of the disk free.
fn fill(disk: &Path, free: usize) {
    let space = rustix::fs::statvfs(disk).unwrap();
    let there = usize::try_from(space.f_bavail).unwrap();
    fs::write(disk.join("filler"), pages(there - free, 0xaa)).unwrap();
    assert_eq!(rustix::fs::statvfs(disk).unwrap().f_bavail as usize, free);
}

/// Prepares the disk, and returns the write to try once the disk is filled.
type Prepare = fn(&Path) -> Box<dyn FnOnce(&Path) -> bool>;

/// Replaces a file. Returns whether that succeeded.
fn saves(disk: &Path) -> Box<dyn FnOnce(&Path) -> bool> {
    let path = disk.join("model.glb");
    replace(&path, &pages(3, 1)).unwrap();
    Box::new(move |disk| {
        let saved = replace(&path, &pages(30, 2));
        let wanted = if saved.is_ok() { pages(30, 2) } else { pages(3, 1) };
        assert!(fs::read(&path).unwrap() == wanted);
        assert_eq!(count(disk), 2, "no other file is left in the folder");
        is_full(saved.err())
    })
}

/// Returns `true` for no error, and `false` for an error that reports a full disk.
fn is_full(error: Option<FileSaveError>) -> bool {
    match error {
        None => true,
        Some(error) => {
            assert!(error.to_string().ends_with("the disk is full"), "{error}");
            false
        }
    }
}

/// Keeps an old version of a document that is stored elsewhere.
fn keeps_versions(disk: &Path) -> Box<dyn FnOnce(&Path) -> bool> {
    let elsewhere = disk.with_file_name("elsewhere.glb");
    let versions = Versions::new(disk.join("versions"), dragonfly_store::VersionLimits::default());
    Box::new(move |disk| {
        fs::write(&elsewhere, pages(30, 1)).unwrap();
        let options = SaveOptions { versions: Some(&versions), ..SaveOptions::default() };
        let saved = save(&RealFiles, &elsewhere, b"new", &options).expect("the document's own disk has room");
        assert_eq!(fs::read(&elsewhere).unwrap(), b"new");
        match saved.kept {
            Some(path) => assert!(fs::read(path).unwrap() == pages(30, 1)),
            None => {
                assert_eq!(saved.notices, ["the old version could not be kept: the disk is full"]);
                let folders = fs::read_dir(disk.join("versions")).into_iter().flatten().flatten();
                assert!(folders.into_iter().all(|folder| count(&folder.path()) == 0));
                return false;
            }
        }
        true
    })
}

/// Appends edits and a snapshot to a journal.
fn records(disk: &Path) -> Box<dyn FnOnce(&Path) -> bool> {
    let autosave = Autosave::new(Arc::new(RealFiles), Some(disk.join("autosave"))).unwrap();
    let Opening::New(mut journal) = autosave.begin(None, None).unwrap() else { panic!("a new one") };
    Box::new(move |_| {
        let mut wanted = Vec::new();
        let mut all = true;
        for number in 0..12_u8 {
            let edit = vec![number; 2500];
            match journal.append(&edit, Instant::now()) {
                Ok(()) => wanted.push(JournalEntry::Edit(edit)),
                Err(error) => {
                    assert!(error.to_string().ends_with("the disk is full"), "{error}");
                    all = false;
                }
            }
        }
        match journal.compact(&pages(20, 7)) {
            Ok(()) => wanted = vec![JournalEntry::Snapshot(pages(20, 7))],
            Err(error) => {
                assert!(error.to_string().ends_with("the disk is full"), "{error}");
                all = false;
            }
        }
        drop(journal);
        let found = autosave.recoverable().unwrap();
        assert_eq!(found.len(), 1);
        // The journal can be read and taken over however full the disk is: its last page has space, or an error is
        // reported.
        assert!(autosave.entries(&found[0]).unwrap() == wanted);
        assert_eq!(count(&autosave.journals()), 1);
        all
    })
}

/// Writes a new file.
fn exports(_: &Path) -> Box<dyn FnOnce(&Path) -> bool> {
    Box::new(|disk| {
        let options = SaveOptions { expected: ExpectedFile::Nothing, ..SaveOptions::default() };
        let saved = save(&RealFiles, &disk.join("export.glb"), &pages(30, 3), &options);
        assert_eq!(count(disk), 1 + usize::from(saved.is_ok()));
        is_full(saved.err())
    })
}

/// Writes the settings.
fn prefers(disk: &Path) -> Box<dyn FnOnce(&Path) -> bool> {
    let store = Store::new(Some(disk.join("settings")));
    store.write(SETTINGS, "the old ones").unwrap();
    Box::new(move |disk| {
        let new = "n".repeat(30 * PAGE);
        let written = store.write(SETTINGS, &new);
        assert_eq!(store.read(SETTINGS), if written.is_ok() { new.as_str() } else { "the old ones" });
        assert_eq!(count(&disk.join("settings")), 1);
        if let Err(error) = &written {
            assert!(error.to_string().ends_with("the disk is full"), "{error}");
        }
        written.is_ok()
    })
}

#[test]
fn at_every_level_of_free_space_a_write_is_complete_or_absent() {
    if !may_mount("full disk") {
        return;
    }
    let folder = Folder::new("full");
    let kinds: [(&str, Prepare); 5] = [
        ("save", saves),
        ("old version", keeps_versions),
        ("journal", records),
        ("export", exports),
        ("settings", prefers),
    ];
    for (name, prepare) in kinds {
        let mut written = 0;
        for free in 0..LEVELS {
            let Some(disk) = Mounted::in_memory(&folder.join("disk"), 256 * PAGE) else { return };
            let act = prepare(disk.path());
            fill(disk.path(), free);
            written += usize::from(act(disk.path()));
        }
        println!("{name}: {written} of {LEVELS} levels were enough");
        assert!(written > 8 && written < LEVELS - 8, "{name}: {written}");
    }
}
