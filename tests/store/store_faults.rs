//! Whichever system call fails while saving: the complete old or new file exists, no temporary file is left, the
//! error message is correct, and the next save succeeds.

use dragonfly_kit::folder::Folder;
use dragonfly_kit::mounted::quick_folder;
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_store::{
    ExpectedFile, FileSaveError, FileStamp, FileState, RealFiles, SaveOptions, VersionLimits, Versions, save,
};
use std::fs;
use std::os::unix::fs::{PermissionsExt, chown, symlink};
use std::path::{Path, PathBuf};

const OLD: &[u8] = b"the old file, which somebody worked on for a week";

/// Returns the new content: more bytes than one chunk of a copy.
fn new() -> Vec<u8> {
    (0..100_000_u32).map(|number| number as u8).collect()
}

/// A file that is overwritten by a save, and how it is created.
struct Case {
    name: &'static str,
    /// Creates the existing files and returns the path to save to.
    make: fn(&Path) -> PathBuf,
    /// Names of the files in the folder, before and after the save.
    names: &'static [&'static str],
    old: Option<&'static [u8]>,
}

const CASES: [Case; 4] = [
    Case { name: "nothing", make: |folder| folder.join("model.glb"), names: &["model.glb"], old: None },
    Case {
        name: "a file",
        make: |folder| {
            let path = folder.join("model.glb");
            fs::write(&path, OLD).unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
            // Owned by another user when the tests run as root, so that the owner must be restored too.
            let _ = chown(&path, Some(4242), Some(4242));
            let file = fs::File::open(&path).unwrap();
            let _ = rustix::fs::fsetxattr(&file, "user.note", b"mine", rustix::fs::XattrFlags::empty());
            path
        },
        names: &["model.glb"],
        old: Some(OLD),
    },
    Case {
        name: "a link",
        make: |folder| {
            fs::write(folder.join("real.glb"), OLD).unwrap();
            symlink("real.glb", folder.join("model.glb")).unwrap();
            folder.join("model.glb")
        },
        names: &["model.glb", "real.glb"],
        old: Some(OLD),
    },
    Case {
        name: "one of two names",
        make: |folder| {
            fs::write(folder.join("model.glb"), OLD).unwrap();
            fs::hard_link(folder.join("model.glb"), folder.join("other.glb")).unwrap();
            folder.join("model.glb")
        },
        names: &["model.glb", "other.glb"],
        old: Some(OLD),
    },
];

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Creates a folder inside `all` with the files of the case and a folder for versions.
fn prepared(all: &Folder, case: &Case) -> (PathBuf, PathBuf, Versions) {
    let folder = all.join("documents");
    let versions = all.join("versions");
    let _ = fs::remove_dir_all(&folder);
    let _ = fs::remove_dir_all(&versions);
    fs::create_dir_all(&folder).unwrap();
    let path = (case.make)(&folder);
    (folder, path, Versions::new(versions, VersionLimits::default()))
}

#[test]
fn a_failure_of_any_system_call_leaves_the_old_file_or_the_new_one() {
    let all = quick_folder("store-faults");
    let new = new();
    let mut runs = 0;
    for case in &CASES {
        for fault in Fault::ALL {
            for number in 1.. {
                let (folder, path, versions) = prepared(&all, case);
                let stamp = case.old.map(|_| FileStamp::take(&RealFiles, &path).unwrap());
                let expected = stamp.as_ref().map_or(ExpectedFile::Nothing, ExpectedFile::Stamp);
                let files = FaultyFiles::once(number, fault);
                let saved = save(&files, &path, &new, &SaveOptions { expected, versions: Some(&versions) });
                let place = format!("{}, call {number}, {fault:?}: {saved:?}", case.name);
                assert_eq!(names(&folder), names_after(case, &saved), "{place}");
                let content = fs::read(&path).ok();
                match &saved {
                    Ok(_) => assert!(content.as_ref() == Some(&new), "{place}"),
                    Err(FileSaveError::Unconfirmed { .. }) => {
                        assert!(content.as_ref() == Some(&new), "{place}")
                    }
                    Err(FileSaveError::Torn { .. }) => panic!("{place}"),
                    Err(error) => {
                        assert!(content.as_deref() == case.old, "{place}");
                        let text = error.to_string();
                        let is_named =
                            text.split([' ', ':']).next().is_some_and(|name| name.ends_with(".glb"));
                        assert!(is_named, "{place}: {error}");
                    }
                }
                assert!(saved.is_ok() || !fault.is_harmless(), "{place}");
                if files.calls() < number {
                    assert!(saved.is_ok(), "{place}");
                    break;
                }
                save(&RealFiles, &path, &new, &SaveOptions::default()).expect(&place);
                assert!(fs::read(&path).unwrap() == new, "{place}");
                runs += 1;
            }
        }
    }
    println!("{runs} failing calls");
    assert!(runs > 4 * 6 * 15, "only {runs} calls failed");
}

/// The calls that may fail although the save succeeds, with the faults that they may have and the reason.
const MAY_FAIL: [(&str, &[Fault], &str); 4] = [
    (
        "open_to_write",
        &[Fault::Io, Fault::Full, Fault::ReadOnly],
        "only asks whether the file is write-protected",
    ),
    ("set_owner", &[Fault::Denied], "only the administrator may give files away; a notice says so"),
    ("set_attribute", &[Fault::Denied], "some attributes belong to the system; a notice says so"),
    ("open", &[Fault::Denied], "the old file became unreadable, so its attributes are unknown"),
];

#[test]
fn a_save_succeeds_only_if_every_call_up_to_the_last_sync_succeeds() {
    let all = quick_folder("store-syncs");
    let new = new();
    let mut synced = 0;
    for case in &CASES {
        let (_, path, _) = prepared(&all, case);
        let files = FaultyFiles::once(u64::MAX, Fault::Io);
        save(&files, &path, &new, &SaveOptions::default()).expect(case.name);
        let names = files.names();
        let last_sync = names.iter().rposition(|name| name.starts_with("sync_")).expect("it syncs");
        assert_eq!(names[last_sync], "sync_folder", "{}", case.name);
        synced += names.iter().filter(|name| name.starts_with("sync_")).count();
        // The rest is cleaning up, and the stamp of the file.
        let after = &names[last_sync + 1..];
        assert!(after.iter().all(|name| ["metadata", "list", "remove"].contains(name)), "{after:?}");
        for (at, name) in names[..=last_sync].iter().enumerate() {
            for fault in Fault::ALL.into_iter().filter(|fault| !fault.is_harmless()) {
                let (_, path, _) = prepared(&all, case);
                let files = FaultyFiles::once(at as u64 + 1, fault);
                let saved = save(&files, &path, &new, &SaveOptions::default());
                let place = format!("{}, call {}, {name}, {fault:?}: {saved:?}", case.name, at + 1);
                assert_eq!(files.names()[at], *name, "{place}");
                let may = |(may, faults, _): &(&str, &[Fault], &str)| may == name && faults.contains(&fault);
                match (&saved, MAY_FAIL.iter().any(may)) {
                    (Err(_), _) => {}
                    (Ok(_), false) => panic!("reported as saved: {place}"),
                    (Ok(saved), true) => {
                        assert!(name.starts_with("open") || !saved.notices.is_empty(), "{place}");
                    }
                }
            }
        }
    }
    // The bytes and the folder; for a file of two names also its old content, with the folder before and after.
    assert_eq!(synced, 2 + 2 + 2 + 4);
}

fn names_after(case: &Case, saved: &Result<dragonfly_store::SaveOutcome, FileSaveError>) -> Vec<String> {
    let there = case.old.is_some() || matches!(saved, Ok(_) | Err(FileSaveError::Unconfirmed { .. }));
    case.names.iter().filter(|_| there).map(|name| (*name).to_owned()).collect()
}

#[test]
fn a_disk_that_keeps_failing_leaves_the_complete_old_or_new_content() {
    let all = quick_folder("store-faults-for-good");
    let new = new();
    for case in &CASES {
        for fault in [Fault::Io, Fault::Full, Fault::ReadOnly, Fault::Denied] {
            for number in 1.. {
                let (folder, path, versions) = prepared(&all, case);
                let files = FaultyFiles::from(number, fault);
                let options = SaveOptions { versions: Some(&versions), ..SaveOptions::default() };
                let saved = save(&files, &path, &new, &options);
                let place = format!("{}, from call {number}, {fault:?}: {saved:?}", case.name);
                let content = fs::read(&path).ok();
                match &saved {
                    Ok(_) | Err(FileSaveError::Unconfirmed { .. }) => {
                        assert!(content.as_ref() == Some(&new), "{place}");
                    }
                    // A file with two hard links whose disk failed during the in-place write: its old content is in
                    // the copy next to it.
                    Err(FileSaveError::Torn { old, .. }) => {
                        assert_eq!(case.name, "one of two names", "{place}");
                        assert!(fs::read(old).unwrap() == OLD, "{place}");
                        let error = save(&RealFiles, &path, &new, &options).unwrap_err();
                        assert!(matches!(error, FileSaveError::Interrupted { .. }), "{error}");
                        dragonfly_store::restore_old_content(&RealFiles, &path).unwrap();
                        assert!(fs::read(&path).unwrap() == OLD, "{place}");
                        assert_eq!(names(&folder), case.names, "{place}");
                    }
                    Err(_) => assert!(content.as_deref() == case.old, "{place}"),
                }
                if files.calls() < number {
                    break;
                }
            }
        }
    }
}

#[test]
fn writes_by_another_program_during_a_save_are_detected_until_the_last_call() {
    let all = quick_folder("store-meddling");
    let new = new();
    let theirs = b"what another program wrote meanwhile";
    for case in &CASES[1..] {
        let mut overwritten = 0;
        for number in 1.. {
            let (_, path, _) = prepared(&all, case);
            let stamp = FileStamp::take(&RealFiles, &path).unwrap();
            let other = path.clone();
            let files = FaultyFiles::meddling(number, move || fs::write(&other, theirs).unwrap());
            let options = SaveOptions { expected: ExpectedFile::Stamp(&stamp), ..SaveOptions::default() };
            let saved = save(&files, &path, &new, &options);
            let content = fs::read(&path).unwrap();
            let place = format!("{}, call {number}: {saved:?}", case.name);
            if files.calls() < number {
                break;
            }
            match saved {
                Err(error) => {
                    assert!(matches!(error, FileSaveError::Changed { .. }), "{place}");
                    assert!(content == theirs, "{place}");
                }
                Ok(saved) if content == new => {
                    overwritten += 1;
                    assert_eq!(saved.stamp.state(&RealFiles, &path).unwrap(), FileState::Same, "{place}");
                }
                // The other program wrote after this save; the next save detects it.
                Ok(saved) => {
                    assert_eq!(saved.stamp.state(&RealFiles, &path).unwrap(), FileState::Changed, "{place}");
                }
            }
        }
        // A write between the last check and the rename is overwritten, because no system call does both. An
        // in-place save makes several calls after its last check.
        let most = if case.name == "one of two names" { 5 } else { 1 };
        assert!((1..=most).contains(&overwritten), "{}: {overwritten}", case.name);
    }
}

#[test]
fn a_file_that_another_program_creates_during_a_save_is_never_overwritten() {
    let all = quick_folder("store-meddling-new");
    let theirs = b"what another program made meanwhile";
    let mut met = 0;
    for number in 1.. {
        let (folder, path, _) = prepared(&all, &CASES[0]);
        let other = path.clone();
        let files = FaultyFiles::meddling(number, move || fs::write(&other, theirs).unwrap());
        let options = SaveOptions { expected: ExpectedFile::Nothing, ..SaveOptions::default() };
        let saved = save(&files, &path, &new(), &options);
        if files.calls() < number {
            break;
        }
        assert!(fs::read(&path).unwrap() == theirs, "call {number}: {saved:?}");
        assert_eq!(names(&folder), ["model.glb"], "call {number}: {saved:?}");
        met += usize::from(matches!(saved, Err(FileSaveError::Exists { .. })));
    }
    assert!(met > 5, "{met}");
}
