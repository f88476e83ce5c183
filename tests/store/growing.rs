//! A file that grows under a temporary name: its bytes are those that were written, and the old file stays until it is complete.

use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::{Random, seed};
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_store::{FileSaveError, GrowingFile, RealFiles, Vfs};
use std::path::Path;
use std::sync::Arc;

fn real() -> Arc<dyn Vfs> {
    Arc::new(RealFiles)
}

fn names(folder: &Folder) -> Vec<String> {
    let names = std::fs::read_dir(folder.path()).unwrap();
    let mut names: Vec<String> = names.map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn random_changes_of_a_growing_file_are_those_of_bytes_in_memory() {
    let folder = Folder::new("growing");
    let seed = seed(6_021);
    let mut random = Random::new(seed);
    for round in 0..60 {
        let path = folder.join("it");
        let mut file = GrowingFile::create(real(), &path).unwrap();
        let mut wanted: Vec<u8> = Vec::new();
        for _ in 0..random.below(12) {
            let length = [random.below(10), random.below(3000), random.below(700_000)][random.below(3)];
            let bytes: Vec<u8> = (0..length).map(|_| random.bits() as u8).collect();
            let at = random.below(wanted.len() + 1);
            match random.below(5) {
                0 | 1 => {
                    file.append(&bytes).unwrap();
                    wanted.extend(bytes);
                }
                2 => {
                    file.insert(&bytes, at as u64).unwrap();
                    wanted.splice(at..at, bytes);
                }
                3 => {
                    let bytes = &bytes[..bytes.len().min(wanted.len() - at)];
                    file.overwrite(bytes, at as u64).unwrap();
                    wanted[at..at + bytes.len()].copy_from_slice(bytes);
                }
                _ => {
                    file.truncate(at as u64).unwrap();
                    wanted.truncate(at);
                }
            }
            assert_eq!(file.size(), wanted.len() as u64, "seed {seed}, round {round}");
            // Reading writes the buffer, which must work with what is not written, too.
            if random.below(2) == 0 {
                continue;
            }
            let mut found = vec![0; wanted.len() - at.min(wanted.len())];
            file.read(&mut found, at.min(wanted.len()) as u64).unwrap();
            assert!(found == wanted[at.min(wanted.len())..], "seed {seed}, round {round}");
        }
        let (written, size) = file.commit().unwrap();
        assert_eq!(size, wanted.len() as u64);
        assert_eq!(written.file_name(), path.file_name());
        assert!(std::fs::read(&path).unwrap() == wanted, "seed {seed}, round {round}");
        assert_eq!(names(&folder), ["it"]);
    }
}

#[test]
fn a_file_that_is_not_committed_leaves_the_old_one() {
    let folder = Folder::new("growing-dropped");
    let path = folder.join("it");
    std::fs::write(&path, "old").unwrap();
    let mut file = GrowingFile::create(real(), &path).unwrap();
    file.append(&vec![7; 1 << 20]).unwrap();
    assert_eq!(names(&folder).len(), 2);
    drop(file);
    assert_eq!(names(&folder), ["it"]);
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
}

#[cfg(unix)]
#[test]
fn a_committed_file_keeps_the_permissions_of_the_old_one_and_a_protected_one_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new("growing-mode");
    let path = folder.join("it");
    std::fs::write(&path, "old").unwrap();
    let set = |mode| std::fs::set_permissions(&path, std::fs::Permissions::from_mode(mode)).unwrap();
    set(0o640);
    GrowingFile::create(real(), &path).unwrap().commit().unwrap();
    assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
    set(0o440);
    let refused = GrowingFile::create(real(), &path);
    assert!(matches!(refused, Err(FileSaveError::Protected { .. })), "{refused:?}");
    let folder_in_its_place = GrowingFile::create(real(), folder.path());
    assert!(matches!(folder_in_its_place, Err(FileSaveError::NotRegular { .. })), "{folder_in_its_place:?}");
}

/// Writes a file in several ways. Returns its bytes.
fn work(files: Arc<dyn Vfs>, path: &Path) -> Result<(), FileSaveError> {
    let mut file = GrowingFile::create(files, path)?;
    file.append(&vec![1; 300_000])?;
    file.append(&[2; 100])?;
    file.insert(&[3; 50], 10)?;
    file.overwrite(&[4; 5], 0)?;
    file.truncate(300_100)?;
    file.commit()?;
    Ok(())
}

#[test]
fn every_call_that_fails_leaves_the_old_file_or_the_complete_new_one() {
    let folder = Folder::new("growing-faults");
    let path = folder.join("it");
    std::fs::write(&path, "old").unwrap();
    let counted = FaultyFiles::once(u64::MAX, Fault::Io);
    work(Arc::new(counted.clone()), &path).unwrap();
    let new = std::fs::read(&path).unwrap();
    for call in 1..=counted.calls() {
        for fault in Fault::ALL {
            std::fs::write(&path, "old").unwrap();
            let files = FaultyFiles::once(call, fault);
            let done = work(Arc::new(files.clone()), &path);
            let found = std::fs::read(&path).unwrap();
            let about = format!("call {call}, {fault:?}: {done:?}");
            match &done {
                Ok(()) | Err(FileSaveError::Unconfirmed { .. }) => assert!(found == new, "{about}"),
                Err(_) => assert!(found == b"old" && !fault.is_harmless(), "{about}"),
            }
            assert_eq!(names(&folder), ["it"], "{about}");
        }
    }
}

#[test]
fn bytes_before_an_insertion_stay_in_place_when_the_disk_is_full() {
    let folder = Folder::new("growing-full");
    let path = folder.join("it");
    let bytes: Vec<u8> = (0..200_000_u32).map(|at| at as u8).collect();
    let mut refused = 0;
    for call in 1..30 {
        let files = FaultyFiles::between(call, call, Fault::Full);
        let Ok(mut file) = GrowingFile::create(Arc::new(files), &path) else { continue };
        if file.append(&bytes).is_err() || file.read(&mut [0; 1], 0).is_err() {
            continue;
        }
        if file.insert(&[9; 1000], 100).is_err() {
            refused += 1;
            // Without room, nothing has moved; later, what is before the insertion is in place.
            let same = if refused == 1 { bytes.len() } else { 100 };
            let mut found = vec![0; same];
            file.read(&mut found, 0).unwrap();
            assert!(found == bytes[..same], "call {call}");
        }
    }
    assert!(refused > 1, "{refused}");
}
