//! A save keeps links of both kinds, permissions, owner and attributes, and above all changes made by other programs.

use dragonfly_kit::folder::Folder;
use dragonfly_kit::mounted::{Mounted, may_mount, quick_folder, succeeds};
use dragonfly_kit::skip::{TestNeed, skip};
use dragonfly_store::{
    ExpectedFile, FileSaveError, FileStamp, FileState, RealFiles, SaveOptions, SaveOutcome, SaveStep,
    VersionLimits, Versions, Vfs, discard_old_content, interrupted_save, replace, save,
};
use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown, symlink};
use std::path::Path;
use std::process::Command;
use std::time::SystemTime;

fn count(folder: &Path) -> usize {
    fs::read_dir(folder).unwrap().count()
}

fn expecting(path: &Path, bytes: &[u8], stamp: &FileStamp) -> Result<SaveOutcome, FileSaveError> {
    let options = SaveOptions { expected: ExpectedFile::Stamp(stamp), ..SaveOptions::default() };
    save(&RealFiles, path, bytes, &options)
}

#[test]
fn saving_through_a_symbolic_link_keeps_the_link() {
    let folder = Folder::new("save-link");
    fs::create_dir(folder.join("far")).unwrap();
    fs::write(folder.join("far/real.glb"), "old").unwrap();
    symlink("real.glb", folder.join("far/second.glb")).unwrap();
    symlink("far/second.glb", folder.join("first.glb")).unwrap();
    let saved = replace(&folder.join("first.glb"), b"new").unwrap();
    assert_eq!(saved.path, fs::canonicalize(folder.join("far/real.glb")).unwrap());
    assert_eq!(fs::read(folder.join("far/real.glb")).unwrap(), b"new");
    assert!(folder.join("first.glb").is_symlink() && folder.join("far/second.glb").is_symlink());
    assert_eq!((count(folder.path()), count(&folder.join("far"))), (2, 2));
}

#[test]
fn saving_through_a_dangling_link_creates_its_target_and_a_link_loop_is_refused() {
    let folder = Folder::new("save-dangling");
    symlink("later.glb", folder.join("model.glb")).unwrap();
    replace(&folder.join("model.glb"), b"new").unwrap();
    assert_eq!(fs::read(folder.join("later.glb")).unwrap(), b"new");
    assert!(folder.join("model.glb").is_symlink());
    symlink("b", folder.join("a")).unwrap();
    symlink("a", folder.join("b")).unwrap();
    let error = replace(&folder.join("a"), b"new").unwrap_err();
    assert!(matches!(error, FileSaveError::NoName { .. }), "{error}");
    assert!(matches!(replace(Path::new("/"), b"").unwrap_err(), FileSaveError::NoName { .. }));
}

#[test]
fn all_hard_links_of_a_file_show_the_new_content() {
    let folder = Folder::new("save-hard-link");
    let (one, other) = (folder.join("one.glb"), folder.join("other.glb"));
    fs::write(&one, "a rather long old content").unwrap();
    fs::hard_link(&one, &other).unwrap();
    let versions = Versions::new(folder.join("versions"), VersionLimits::default());
    let options = SaveOptions { versions: Some(&versions), ..SaveOptions::default() };
    let saved = save(&RealFiles, &one, b"new", &options).unwrap();
    assert_eq!(saved.links, 2, "the outcome contains the number of names");
    assert_eq!(fs::read(&other).unwrap(), b"new");
    assert_eq!(fs::metadata(&one).unwrap().ino(), fs::metadata(&other).unwrap().ino());
    assert_eq!(saved.stamp.state(&RealFiles, &other).unwrap(), FileState::Same);
    assert_eq!(fs::read(saved.kept.unwrap()).unwrap(), b"a rather long old content");
    assert_eq!(count(folder.path()), 3);
}

#[test]
fn after_an_interrupted_in_place_save_nothing_is_overwritten_before_the_user_decides() {
    let folder = Folder::new("save-cut-off");
    let path = folder.join("one.glb");
    fs::write(&path, "half of the n").unwrap();
    fs::write(folder.join(".one.glb.dragonfly-old"), "the old content").unwrap();
    let old = interrupted_save(&RealFiles, &path).unwrap().expect("it is found");
    let error = replace(&path, b"newer").unwrap_err();
    assert!(error.to_string().contains(&old.display().to_string()), "{error}");
    assert_eq!(fs::read(&path).unwrap(), b"half of the n");
    dragonfly_store::restore_old_content(&RealFiles, &path).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"the old content");
    assert_eq!(interrupted_save(&RealFiles, &path).unwrap(), None);
    fs::write(folder.join(".one.glb.dragonfly-old"), "the old content").unwrap();
    discard_old_content(&RealFiles, &path).unwrap();
    replace(&path, b"newer").unwrap();
    assert_eq!(count(folder.path()), 1);
}

#[test]
fn permissions_are_kept_and_a_new_file_has_the_default_ones() {
    let folder = Folder::new("save-mode");
    let path = folder.join("model.glb");
    fs::write(folder.join("usual"), "").unwrap();
    replace(&path, b"new").unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o7777;
    assert_eq!(mode(&path), mode(&folder.join("usual")));
    for wanted in [0o600, 0o640, 0o666, 0o755, 0o1644, 0o200] {
        fs::set_permissions(&path, fs::Permissions::from_mode(wanted)).unwrap();
        replace(&path, b"newer").unwrap();
        assert_eq!(mode(&path), wanted);
    }
}

#[test]
fn owner_and_group_are_kept_where_the_system_allows() {
    let folder = Folder::new("save-owner");
    let path = folder.join("model.glb");
    fs::write(&path, "old").unwrap();
    if chown(&path, Some(4242), Some(4343)).is_err() {
        return skip(TestNeed::Root, "only root may give files away");
    }
    fs::set_permissions(&path, fs::Permissions::from_mode(0o660)).unwrap();
    let saved = replace(&path, b"new").unwrap();
    let data = fs::metadata(&path).unwrap();
    assert_eq!((data.uid(), data.gid(), data.mode() & 0o777), (4242, 4343, 0o660));
    assert_eq!(saved.notices, Vec::<String>::new());
}

#[test]
fn extended_attributes_and_access_lists_are_kept() {
    use rustix::fs::{XattrFlags, fgetxattr, fsetxattr};
    let folder = Folder::new("save-attributes");
    let path = folder.join("model.glb");
    fs::write(&path, "old").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
    let file = fs::File::open(&path).unwrap();
    if let Err(error) = fsetxattr(&file, "user.origin", b"camera 3", XattrFlags::empty()) {
        return skip(TestNeed::FileSystem, format!("no extended attributes: {error}"));
    }
    fsetxattr(&file, "user.empty", b"", XattrFlags::empty()).unwrap();
    // Version 2: owner rw-, user 4242 r--, group r--, mask r--, others ---.
    let mut list = vec![2, 0, 0, 0];
    for (tag, allowed, id) in
        [(1_u16, 6_u16, u32::MAX), (2, 4, 4242), (4, 4, u32::MAX), (16, 4, u32::MAX), (32, 0, u32::MAX)]
    {
        list.extend(tag.to_le_bytes());
        list.extend(allowed.to_le_bytes());
        list.extend(id.to_le_bytes());
    }
    let lists = fsetxattr(&file, "system.posix_acl_access", &list, XattrFlags::empty());
    let saved = replace(&path, b"new").unwrap();
    assert_eq!(saved.notices, Vec::<String>::new());
    let file = fs::File::open(&path).unwrap();
    let mut value = [0; 64];
    let size = fgetxattr(&file, "user.origin", &mut value[..]).unwrap();
    assert_eq!(&value[..size], b"camera 3");
    assert_eq!(fgetxattr(&file, "user.empty", &mut value[..]).unwrap(), 0);
    match lists {
        Err(error) => println!("no access lists here: {error}"),
        Ok(()) => {
            let size = fgetxattr(&file, "system.posix_acl_access", &mut value[..]).unwrap();
            assert_eq!(&value[..size], list);
        }
    }
    assert_eq!(file.metadata().unwrap().mode() & 0o777, 0o640);
}

#[test]
fn changes_by_another_program_are_detected_and_not_overwritten() {
    let folder = Folder::new("save-changed");
    let path = folder.join("model.glb");
    fs::write(&path, "as it was read").unwrap();
    let stamp = FileStamp::take(&RealFiles, &path).unwrap();
    assert!(stamp.is_of(b"as it was read") && !stamp.is_of(b"as it was Read"));
    let late = FileStamp { taken: i64::MAX, ..stamp };
    assert_eq!(late.state(&RealFiles, &path).unwrap(), FileState::Same);
    let time = fs::metadata(&path).unwrap().modified().unwrap();
    let modified = |time: SystemTime| fs::File::options().write(true).open(&path).unwrap().set_modified(time);
    // The hardest case: the same length, and the modification time restored.
    let others: [(&str, bool); 3] = [("someone else's", false), ("as it was Read", true), ("", true)];
    for (content, put_back) in others {
        fs::write(&path, content).unwrap();
        if put_back {
            modified(time).unwrap();
        }
        assert_eq!(stamp.state(&RealFiles, &path).unwrap(), FileState::Changed);
        // A stamp taken long after the last change: the times alone are enough.
        let late = FileStamp { taken: i64::MAX, ..stamp };
        assert_eq!(late.state(&RealFiles, &path).unwrap(), FileState::Changed);
        let error = expecting(&path, b"mine", &stamp).unwrap_err();
        assert!(matches!(error, FileSaveError::Changed { .. }), "{error}");
        assert_eq!(fs::read(&path).unwrap(), content.as_bytes());
        assert_eq!(count(folder.path()), 1);
    }
    // The path is replaced by another file, and by a folder.
    fs::write(folder.join("other"), "another file").unwrap();
    fs::rename(folder.join("other"), &path).unwrap();
    assert!(expecting(&path, b"mine", &stamp).is_err());
    fs::remove_file(&path).unwrap();
    fs::create_dir(&path).unwrap();
    assert!(matches!(expecting(&path, b"mine", &stamp).unwrap_err(), FileSaveError::NotRegular { .. }));
}

#[test]
fn a_file_with_a_new_time_but_the_same_content_is_not_changed() {
    let folder = Folder::new("save-touched");
    let path = folder.join("model.glb");
    fs::write(&path, "as it was read").unwrap();
    let stamp = FileStamp::take(&RealFiles, &path).unwrap();
    fs::File::options().write(true).open(&path).unwrap().set_modified(SystemTime::UNIX_EPOCH).unwrap();
    assert_eq!(stamp.state(&RealFiles, &path).unwrap(), FileState::Same);
    fs::remove_file(&path).unwrap();
    assert_eq!(stamp.state(&RealFiles, &path).unwrap(), FileState::Missing);
    fs::write(&path, "as it was read").unwrap();
    let saved = expecting(&path, b"mine", &stamp).unwrap();
    let again = expecting(&path, b"mine again", &saved.stamp).unwrap();
    // The file was deleted, so no other work is overwritten.
    fs::remove_file(&path).unwrap();
    expecting(&path, b"mine once more", &again.stamp).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"mine once more");
}

#[test]
fn a_change_within_a_tick_of_the_clock_is_detected() {
    let folder = Folder::new("save-tick");
    let path = folder.join("model.glb");
    fs::write(&path, "as it was read").unwrap();
    let stamp = FileStamp::take(&RealFiles, &path).unwrap();
    // The stamp of a file whose size and times are the same, but whose bytes differ.
    let newest = stamp.modified.max(stamp.changed);
    let other = |taken| FileStamp { hash: !stamp.hash, taken, ..stamp };
    for taken in [newest - 1, newest, newest + 1_900_000_000] {
        assert_eq!(other(taken).state(&RealFiles, &path).unwrap(), FileState::Changed);
    }
    // After more than two seconds the clock would show a change, so the file is not read again.
    assert_eq!(other(newest + 2_100_000_000).state(&RealFiles, &path).unwrap(), FileState::Same);
}

#[test]
fn a_new_file_never_replaces_an_existing_one() {
    let folder = Folder::new("save-new");
    let path = folder.join("model.glb");
    let options = SaveOptions { expected: ExpectedFile::Nothing, ..SaveOptions::default() };
    save(&RealFiles, &path, b"first", &options).unwrap();
    let error = save(&RealFiles, &path, b"second", &options).unwrap_err();
    assert!(matches!(error, FileSaveError::Exists { .. }), "{error}");
    assert_eq!(fs::read(&path).unwrap(), b"first");
    // A file that another program created between the check and the rename is not replaced either.
    let error = RealFiles.rename_to_new(&path, &folder.join("model.glb")).unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::AlreadyExists);
    fs::write(folder.join("second.glb"), "second").unwrap();
    let error = RealFiles.rename_to_new(&folder.join("second.glb"), &path).unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::AlreadyExists);
    assert_eq!(fs::read(&path).unwrap(), b"first");
    assert_eq!(count(folder.path()), 2);
}

#[test]
fn a_file_that_is_write_protected_is_not_replaced() {
    let folder = Folder::new("save-protected");
    let path = folder.join("model.glb");
    replace(&path, b"old").unwrap();
    for mode in [0o444, 0o400, 0o555] {
        fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
        let error = replace(&path, b"new").unwrap_err();
        assert!(matches!(error, FileSaveError::Protected { .. }), "{error:?}");
        assert!(error.to_string().ends_with("is write-protected; it was not overwritten"), "{error}");
        assert_eq!((fs::read(&path).unwrap(), count(folder.path())), (b"old".to_vec(), 1));
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, mode);
    }
}

#[test]
fn only_regular_files_are_replaced() {
    let folder = Folder::new("save-no-file");
    fs::create_dir(folder.join("folder")).unwrap();
    let pipe = folder.join("pipe");
    assert!(succeeds(Command::new("mkfifo").arg(&pipe)));
    for path in [folder.join("folder"), pipe] {
        let error = replace(&path, b"new").unwrap_err();
        assert!(matches!(error, FileSaveError::NotRegular { .. }), "{error}");
    }
    assert_eq!(count(folder.path()), 2);
}

#[test]
fn a_deleted_folder_is_reported() {
    let folder = Folder::new("save-vanished");
    let path = folder.join("gone/model.glb");
    fs::create_dir(folder.join("gone")).unwrap();
    let stamp = replace(&path, b"first").unwrap().stamp;
    fs::remove_dir_all(folder.join("gone")).unwrap();
    let error = expecting(&path, b"second", &stamp).unwrap_err();
    assert!(error.to_string().ends_with("cannot be written: it or its folder does not exist"), "{error}");
    assert!(!folder.join("gone").exists());
}

#[test]
fn read_only_disks_and_immutable_files_are_not_changed() {
    if !may_mount("read-only disk") {
        return;
    }
    let folder = Folder::new("save-read-only");
    let Some(disk) = Mounted::in_memory(&folder.join("disk"), 1 << 20) else { return };
    let path = disk.path().join("model.glb");
    replace(&path, b"first").unwrap();
    fs::hard_link(&path, disk.path().join("other.glb")).unwrap();
    replace(&disk.path().join("third.glb"), b"first").unwrap();
    disk.read_only(true);
    for name in ["model.glb", "third.glb", "fourth.glb"] {
        let error = replace(&disk.path().join(name), b"second").unwrap_err();
        assert!(matches!(error, FileSaveError::Io { step: SaveStep::Create, .. }), "{error:?}");
        assert!(error.to_string().ends_with("the disk is read-only"), "{error}");
    }
    assert_eq!(fs::read(&path).unwrap(), b"first");
    assert_eq!(count(disk.path()), 3);
    drop(disk);
    let path = folder.join("model.glb");
    replace(&path, b"first").unwrap();
    if !succeeds(Command::new("chattr").arg("+i").arg(&path)) {
        return skip(TestNeed::FileSystem, "files cannot be made immutable");
    }
    let error = replace(&path, b"second");
    assert!(succeeds(Command::new("chattr").arg("-i").arg(&path)));
    let error = error.unwrap_err().to_string();
    assert!(error.ends_with("is write-protected; it was not overwritten"), "{error}");
    assert_eq!(fs::read(&path).unwrap(), b"first");
    assert_eq!(count(folder.path()), 2, "a temporary file is left");
}

#[test]
fn old_versions_are_limited_but_at_least_three_are_kept() {
    let folder = quick_folder("save-versions");
    let path = folder.join("model.glb");
    let limits = VersionLimits {
        each: dragonfly_store::FolderLimits { least: 3, most: 5, bytes: 10 },
        largest: 1000,
        all: 2000,
    };
    let versions = Versions::new(folder.join("versions"), limits);
    let save = |path: &Path, bytes: &[u8]| {
        save(&RealFiles, path, bytes, &SaveOptions { versions: Some(&versions), ..SaveOptions::default() })
            .unwrap()
    };
    let contents = |path: &Path| -> Vec<Vec<u8>> {
        let found = versions.of(&RealFiles, path).unwrap();
        found.iter().map(|version| fs::read(&version.path).unwrap()).collect()
    };
    assert!(save(&path, b"1").kept.is_none(), "there was none before");
    for number in 2..=9 {
        save(&path, number.to_string().as_bytes());
    }
    assert_eq!(contents(&path), [b"8", b"7", b"6", b"5", b"4"], "newest first");
    // Saving the same content again adds no version.
    save(&path, b"9");
    save(&path, b"9");
    assert_eq!(contents(&path), [b"9", b"8", b"7", b"6", b"5"]);
    // Large versions are deleted first, but three are kept.
    for number in 0..6_u8 {
        save(&path, &[number; 600]);
    }
    assert_eq!(contents(&path), [vec![4; 600], vec![3; 600], vec![2; 600]]);
    assert!(versions.of(&RealFiles, &path).unwrap()[0].path.to_string_lossy().ends_with(".glb"));
    // Limit for all documents together: the oldest versions are deleted first, but never those of the document just
    // saved.
    let other = folder.join("other.glb");
    for number in 0..3_u8 {
        save(&other, &[number; 700]);
    }
    assert_eq!(contents(&other).len(), 2);
    assert_eq!(contents(&path), [vec![4; 600]]);
    // Too large to keep a version: the save succeeds, with a notice.
    save(&path, &[1; 1001]);
    let saved = save(&path, b"small");
    assert_eq!(saved.notices, ["the old version could not be kept: it is larger than 0 MiB"]);
    assert_eq!(fs::read(&path).unwrap(), b"small");
}

#[test]
fn temporary_files_of_a_killed_program_are_deleted_by_the_next_save() {
    let folder = quick_folder("save-leftovers");
    let path = folder.join("model.glb");
    let mut child = Command::new("true").spawn().unwrap();
    let dead = child.id();
    child.wait().unwrap();
    // The name of a temporary file as this process writes it, with the id of a process that has ended.
    let host = {
        let watched = dragonfly_kit::store::faulty_files::FaultyFiles::from(
            9,
            dragonfly_kit::store::faulty_files::Fault::Io,
        );
        let _ = save(&watched, &path, b"x", &SaveOptions::default());
        let left = fs::read_dir(folder.path()).unwrap().next().expect("it could not be removed").unwrap();
        let name = left.file_name().into_string().unwrap();
        fs::remove_file(left.path()).unwrap();
        name.strip_prefix(".model.glb.").unwrap().split('-').next().unwrap().to_owned()
    };
    let leftover = folder.join(&format!(".model.glb.{host}-{dead}-0.part"));
    let living = folder.join(&format!(".model.glb.{host}-1-0.part"));
    let another = folder.join(&format!(".other.glb.{host}-{dead}-0.part"));
    for path in [&leftover, &living, &another] {
        fs::write(path, "half").unwrap();
    }
    replace(&path, b"new").unwrap();
    assert!(!leftover.exists() && living.exists() && another.exists());
}
