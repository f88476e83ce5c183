//! Ways in which a user returns to unsaved work. In none of them is the file of the document written, or anything
//! deleted, before the user decides.

use crate::journal::{autosave, begin, edits, only};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::mounted::{Mounted, may_mount, quick_folder};
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_kit::store::forged::forged_with;
use dragonfly_store::{
    Autosave, Claim, DocumentFileState, FileStamp, FolderLimits, JournalEntry, JournalError, JournalOwner,
    Opening, OwnerStatus, Readability, RealFiles, SaveOptions, replace, save_document,
};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::PathBuf;
use std::time::Instant;

/// A document, and a journal with two of its edits, after their program was killed.
struct Killed {
    folder: Folder,
    autosave: Autosave,
    document: PathBuf,
}

fn killed(name: &str) -> Killed {
    let folder = quick_folder(name);
    let autosave = autosave(&folder, RealFiles);
    fs::create_dir(folder.join("documents")).unwrap();
    let document = folder.join("documents/fox.glb");
    fs::write(&document, "as it was read").unwrap();
    let stamp = FileStamp::take(&RealFiles, &document).unwrap();
    let mut journal = begin(&autosave, Some(&document), Some(&stamp));
    for text in ["one", "two"] {
        journal.append(text.as_bytes(), Instant::now()).unwrap();
    }
    drop(journal);
    let document = fs::canonicalize(document).unwrap();
    Killed { folder, autosave, document }
}

impl Killed {
    #[track_caller]
    fn untouched(&self) {
        assert_eq!(fs::read(&self.document).unwrap(), b"as it was read");
        assert_eq!(fs::read_dir(self.document.parent().unwrap()).unwrap().count(), 1);
    }
}

// A second implementation of the format, written from its description, to create journals of other machines and
// versions.

/// Returns a journal with the number 77 of the document `/nowhere/fox.glb`, in format `version`, with records of
/// these kinds and bytes.
fn forged(version: u32, records: &[(u8, &[u8])]) -> Vec<u8> {
    let text = r#"{"number":77,"document":"/nowhere/fox.glb","stamp":null,"later":"ignored"}"#;
    forged_with(text, version, records)
}

fn put(autosave: &Autosave, bytes: &[u8]) -> PathBuf {
    fs::create_dir_all(autosave.journals()).unwrap();
    let path = autosave.journals().join("forged.journal");
    fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn work_from_a_crash_can_be_kept_or_opened_as_a_new_document_or_discarded() {
    let it = killed("scenario-crash");
    let found = only(&it.autosave);
    assert!(found.is_offered());
    assert_eq!((found.document.as_ref(), &found.file), (Some(&it.document), &DocumentFileState::Same));
    assert_eq!((found.work, found.unsaved, found.owner_status), (2, 2, OwnerStatus::Exited));
    let Opening::Found(again) = it.autosave.begin(Some(&it.document), None).unwrap() else {
        panic!("opening the document does not pass it over")
    };
    assert_eq!(*again, found);
    // Opened separately: the work becomes a new document, and the old journal stays.
    let beside = it.autosave.copy(&found, None).unwrap();
    assert_eq!((beside.entries, beside.journal.document()), (edits(["one", "two"]), None));
    drop(beside.journal);
    let all = it.autosave.recoverable().unwrap();
    assert_eq!(all.len(), 2);
    let beside = all.iter().find(|other| other.journal != found.journal).unwrap();
    assert_eq!((beside.work, beside.unsaved), (2, 2));
    assert_eq!(it.autosave.entries(beside).unwrap(), edits(["one", "two"]));
    // Discarded: the journal is moved to the bin, and restored from there.
    let bin = it.autosave.discard(beside).unwrap();
    assert_eq!(it.autosave.discarded().unwrap(), std::slice::from_ref(&bin));
    assert_eq!(only(&it.autosave), found);
    let back = it.autosave.restore(&bin).unwrap();
    assert_eq!(back, beside.journal);
    // Kept: the journal is resumed.
    assert_eq!(it.autosave.resume(&found, Claim::IfFree).unwrap().entries, edits(["one", "two"]));
    it.untouched();
}

#[test]
fn a_second_program_learns_which_process_has_the_document_open() {
    let it = killed("scenario-two");
    let found = only(&it.autosave);
    let kept = it.autosave.resume(&found, Claim::IfFree).unwrap().journal;
    symlink("fox.glb", it.document.with_file_name("link.glb")).unwrap();
    for path in [it.document.clone(), it.document.with_file_name("link.glb")] {
        let error = it.autosave.begin(Some(&path), None).unwrap_err();
        let JournalError::Held { owner, .. } = &error else { panic!("{error}") };
        assert_eq!(*owner, Some(JournalOwner::this()));
        assert!(error.to_string().contains(&format!("process {}", std::process::id())), "{error}");
    }
    fs::remove_file(it.document.with_file_name("link.glb")).unwrap();
    let found = only(&it.autosave);
    assert_eq!(found.owner_status, OwnerStatus::Running);
    assert!(!found.is_offered());
    for claim in [Claim::IfFree, Claim::Anyway] {
        assert!(matches!(it.autosave.resume(&found, claim), Err(JournalError::Held { .. })));
    }
    assert!(matches!(it.autosave.discard(&found), Err(JournalError::Held { .. })));
    // The edits recorded so far can be read, and opened as a new document.
    assert_eq!(it.autosave.copy(&found, None).unwrap().entries, edits(["one", "two"]));
    kept.close().unwrap();
    it.autosave.resume(&found, Claim::IfFree).unwrap();
    it.untouched();
}

#[test]
fn work_on_a_moved_document_continues_at_its_new_path() {
    let it = killed("scenario-moved");
    let moved = it.folder.join("moved.glb");
    fs::rename(&it.document, &moved).unwrap();
    let found = only(&it.autosave);
    assert_eq!(found.file, DocumentFileState::Missing);
    let resumed = it.autosave.copy(&found, Some(&moved)).unwrap();
    assert_eq!(resumed.entries, edits(["one", "two"]));
    // The stamp is that of the file on which the edits were made, so that the two can be compared.
    let stamp = *resumed.journal.stamp().expect("a stamp");
    assert!(stamp.is_of(&fs::read(&moved).unwrap()));
    drop(resumed);
    it.autosave.discard(&found).unwrap();
    assert_eq!(only(&it.autosave).document, Some(fs::canonicalize(&moved).unwrap()));
    assert!(!it.document.exists());
}

#[test]
fn edits_saved_before_a_document_moved_still_count_as_saved() {
    let it = killed("scenario-moved-saved");
    let mut journal = it.autosave.resume(&only(&it.autosave), Claim::IfFree).unwrap().journal;
    save_document(&RealFiles, &mut journal, &it.document, b"saved", &SaveOptions::default()).unwrap();
    journal.append(b"three", Instant::now()).unwrap();
    let edits_after_save = |entries: &[JournalEntry]| {
        let last = entries.iter().rposition(|entry| *entry == JournalEntry::Saved);
        (entries.len() - 1 - last.expect("a save")) as u64
    };
    for (word, after) in [("said", 1), ("unsaid", 0)] {
        // Killed after the file was replaced and before the journal recorded it.
        if word == "unsaid" {
            journal.saving(b"saved again").unwrap();
            replace(&it.document, b"saved again").unwrap();
        }
        let moved = it.folder.join(&format!("{word}.glb"));
        fs::copy(&it.document, &moved).unwrap();
        let away = it.folder.join("away.glb");
        fs::rename(&it.document, &away).unwrap();
        let path = journal.path().to_owned();
        let found = |path: &std::path::Path| {
            let all = it.autosave.recoverable().unwrap();
            all.into_iter().find(|found| found.journal == path).expect("the journal")
        };
        assert!(found(&path).held(&FileStamp::take(&RealFiles, &moved).unwrap()), "{word}");
        let resumed = it.autosave.copy(&found(&path), Some(&moved)).unwrap();
        assert_eq!(edits_after_save(&resumed.entries), after, "{word}: {:?}", resumed.entries);
        let place = resumed.journal.path().to_owned();
        drop(resumed);
        // Reading the new journal again gives the same result.
        let again = found(&place);
        assert_eq!((again.unsaved, again.file.clone()), (after, DocumentFileState::Same), "{word}");
        assert_eq!(edits_after_save(&it.autosave.entries(&again).unwrap()), after, "{word}");
        it.autosave.discard(&again).unwrap();
        fs::rename(&away, &it.document).unwrap();
    }
}

#[test]
fn a_failed_save_is_not_mistaken_for_a_later_one() {
    let it = killed("scenario-failed-save");
    let mut journal = it.autosave.resume(&only(&it.autosave), Claim::IfFree).unwrap().journal;
    let stamp = FileStamp::take(&RealFiles, &it.document).unwrap();
    // This save fails before the file is written.
    journal.saving(b"what was never written").unwrap();
    journal.append(b"undone, back at what the file holds", Instant::now()).unwrap();
    journal.saved(&stamp).unwrap();
    assert_eq!(journal.unsaved(), 0);
    drop(journal);
    let found = only(&it.autosave);
    assert_eq!(found.unsaved, 0, "nothing is offered");
    let entries = it.autosave.entries(&found).unwrap();
    assert_eq!((entries.len(), entries.last()), (4, Some(&JournalEntry::Saved)));
}

#[test]
fn a_document_changed_by_another_program_is_reported() {
    let it = killed("scenario-changed");
    fs::write(&it.document, "somebody else's work").unwrap();
    let found = only(&it.autosave);
    assert_eq!(found.file, DocumentFileState::Changed);
    let mut journal = it.autosave.resume(&found, Claim::IfFree).unwrap().journal;
    let stamp = *journal.stamp().expect("that of the file as it was read");
    let options =
        SaveOptions { expected: dragonfly_store::ExpectedFile::Stamp(&stamp), ..SaveOptions::default() };
    let error = save_document(&RealFiles, &mut journal, &it.document, b"mine", &options).unwrap_err();
    assert!(error.to_string().contains("was changed on the disk by another program"), "{error}");
    assert_eq!(journal.unsaved(), 2);
    assert_eq!(fs::read(&it.document).unwrap(), b"somebody else's work");
}

#[test]
fn a_deleted_document_can_be_saved_again() {
    let it = killed("scenario-deleted");
    fs::remove_file(&it.document).unwrap();
    let found = only(&it.autosave);
    assert_eq!(found.file, DocumentFileState::Missing);
    let mut journal = it.autosave.resume(&found, Claim::IfFree).unwrap().journal;
    assert!(!it.document.exists(), "not before it is asked for");
    let stamp = *journal.stamp().expect("a stamp");
    let options =
        SaveOptions { expected: dragonfly_store::ExpectedFile::Stamp(&stamp), ..SaveOptions::default() };
    save_document(&RealFiles, &mut journal, &it.document, b"mine", &options).unwrap();
    assert_eq!((fs::read(&it.document).unwrap(), journal.unsaved()), (b"mine".to_vec(), 0));
}

#[test]
fn a_journal_owned_by_another_machine_is_claimed_only_on_request() {
    let folder = quick_folder("scenario-elsewhere");
    let autosave = autosave(&folder, RealFiles);
    let opened: (u8, &[u8]) = (3, br#"{"process":4711,"host":"the other machine"}"#);
    let path = put(&autosave, &forged(1, &[opened, (2, b"one")]));
    let found = only(&autosave);
    assert_eq!(
        (found.owner_status, found.unsaved, &found.file),
        (OwnerStatus::OnOtherHost, 1, &DocumentFileState::Missing)
    );
    assert!(found.is_offered());
    let error = autosave.resume(&found, Claim::IfFree).unwrap_err();
    assert!(error.to_string().contains("process 4711 on the other machine"), "{error}");
    let resumed = autosave.resume(&found, Claim::Anyway).unwrap();
    assert_eq!(resumed.entries, edits(["one"]));
    drop(resumed);
    assert_eq!(only(&autosave).owner, Some(JournalOwner::this()));
    // The journal records that its program ended.
    fs::write(&path, forged(1, &[opened, (2, b"one"), (6, b"")])).unwrap();
    assert_eq!(only(&autosave).owner_status, OwnerStatus::Exited);
    autosave.resume(&only(&autosave), Claim::IfFree).unwrap();
}

#[test]
fn work_in_read_only_folders_is_not_lost() {
    if !may_mount("read-only folder") {
        return;
    }
    let folder = Folder::new("scenario-read-only");
    let Some(disk) = Mounted::in_memory(&folder.join("disk"), 1 << 20) else { return };
    let document = disk.path().join("fox.glb");
    replace(&document, b"as it was read").unwrap();
    // The document cannot be written, but its journal can.
    disk.read_only(true);
    let sound = autosave(&folder, RealFiles);
    let mut journal = begin(&sound, Some(&document), None);
    journal.append(b"one", Instant::now()).unwrap();
    let error = save_document(&RealFiles, &mut journal, &document, b"new", &SaveOptions::default());
    assert!(error.unwrap_err().to_string().ends_with("the disk is read-only"));
    assert_eq!(journal.unsaved(), 1);
    drop(journal);
    assert!(only(&sound).is_offered());
    // The journals cannot be written, but the work in them can be read.
    disk.read_only(false);
    let elsewhere =
        Autosave::new(std::sync::Arc::new(RealFiles), Some(disk.path().join("autosave"))).unwrap();
    let mut journal = begin(&elsewhere, None, None);
    journal.append(b"one", Instant::now()).unwrap();
    drop(journal);
    disk.read_only(true);
    let found = only(&elsewhere);
    assert_eq!(elsewhere.entries(&found).unwrap(), edits(["one"]));
    for error in [
        elsewhere.begin(None, None).unwrap_err(),
        elsewhere.resume(&found, Claim::IfFree).unwrap_err(),
        elsewhere.copy(&found, None).unwrap_err(),
        elsewhere.discard(&found).unwrap_err(),
    ] {
        assert!(error.to_string().ends_with("the disk is read-only"), "{error}");
    }
    // The journal is read here, and the work continues in another folder.
    disk.read_only(false);
    assert_eq!(only(&elsewhere).work, 1);
}

#[test]
fn a_full_disk_is_reported_and_no_edit_counts_as_done() {
    let folder = quick_folder("scenario-full");
    let error = autosave(&folder, FaultyFiles::from(1, Fault::Full)).begin(None, None).unwrap_err();
    assert!(error.to_string().ends_with("the disk is full"), "{error}");
    let sound = autosave(&folder, RealFiles);
    begin(&sound, None, None).close().unwrap();
}

#[test]
fn a_journal_of_a_newer_program_is_neither_read_nor_changed() {
    let it = killed("scenario-newer");
    let path = only(&it.autosave).journal;
    let newer = forged(2, &[(9, b"what nobody here understands")]);
    fs::write(&path, &newer).unwrap();
    let found = only(&it.autosave);
    assert_eq!((&found.reading, found.is_offered()), (&Readability::Newer(2), false));
    let error = it.autosave.resume(&found, Claim::Anyway).unwrap_err();
    assert!(error.to_string().contains("a newer version of this program"), "{error}");
    assert!(matches!(it.autosave.entries(&found), Err(JournalError::Newer { version: 2, .. })));
    // The document can still be edited, with a second journal.
    let mut journal = begin(&it.autosave, Some(&it.document), None);
    journal.append(b"three", Instant::now()).unwrap();
    assert!(matches!(it.autosave.begin(Some(&it.document), None), Err(JournalError::Held { .. })));
    drop(journal);
    assert!(matches!(it.autosave.begin(Some(&it.document), None), Ok(Opening::Found(_))));
    assert_eq!(fs::read(&path).unwrap(), newer);
    it.untouched();
}

#[test]
fn empty_or_invalid_journals_do_not_block_the_document() {
    let it = killed("scenario-empty");
    let path = only(&it.autosave).journal;
    fs::write(&path, "").unwrap();
    let found = only(&it.autosave);
    assert_eq!(found.reading, Readability::Damaged("it is empty".to_owned()));
    assert!(!found.is_offered());
    // The file is empty, so nothing is lost by filling it.
    let mut journal = begin(&it.autosave, Some(&it.document), None);
    assert_eq!(journal.path(), path);
    journal.append(b"three", Instant::now()).unwrap();
    drop(journal);
    assert_eq!(it.autosave.entries(&only(&it.autosave)).unwrap(), edits(["three"]));
    // The file is not empty, so it is kept; it can be moved to the bin.
    fs::write(&path, "a letter").unwrap();
    let error = it.autosave.resume(&only(&it.autosave), Claim::IfFree).unwrap_err();
    assert!(error.to_string().contains("is no journal that can be read"), "{error}");
    assert_ne!(begin(&it.autosave, Some(&it.document), None).path(), path);
    assert_eq!(fs::read(&path).unwrap(), b"a letter");
    let found = it.autosave.recoverable().unwrap();
    let letter = found.iter().find(|found| found.journal == path).unwrap();
    let bin = it.autosave.discard(letter).unwrap();
    assert_eq!(fs::read(bin).unwrap(), b"a letter");
    it.untouched();
}

#[test]
fn a_journal_cut_inside_a_record_returns_the_complete_records() {
    let it = killed("scenario-cut");
    let found = only(&it.autosave);
    let bytes = fs::read(&found.journal).unwrap();
    fs::write(&found.journal, &bytes[..bytes.len() - 1]).unwrap();
    let found = only(&it.autosave);
    assert_eq!((&found.reading, found.unsaved), (&Readability::Cut(11), 1));
    let resumed = it.autosave.resume(&found, Claim::IfFree).unwrap();
    assert_eq!((resumed.entries, resumed.cut), (edits(["one"]), 11));
    it.untouched();
}

#[test]
fn recovering_twice_returns_each_edit_once() {
    let it = killed("scenario-twice");
    for text in ["three", "four"] {
        let mut journal = it.autosave.resume(&only(&it.autosave), Claim::IfFree).unwrap().journal;
        journal.append(text.as_bytes(), Instant::now()).unwrap();
    }
    let found = only(&it.autosave);
    let kept = it.autosave.resume(&found, Claim::IfFree).unwrap();
    assert_eq!(kept.entries, edits(["one", "two", "three", "four"]));
    // An outdated list of recoverable journals does not allow claiming one.
    assert!(matches!(it.autosave.resume(&found, Claim::IfFree), Err(JournalError::Held { .. })));
    drop(kept);
    it.autosave.discard(&found).unwrap();
    assert!(it.autosave.resume(&found, Claim::IfFree).is_err());
    it.untouched();
}

#[test]
fn the_journal_format_matches_its_description() {
    let folder = quick_folder("scenario-format");
    let autosave = autosave(&folder, RealFiles);
    put(&autosave, &forged(1, &[(1, b"all"), (2, b"one"), (2, b"")]));
    let found = only(&autosave);
    assert_eq!(found.document, Some("/nowhere/fox.glb".into()));
    assert_eq!((found.work, &found.reading), (3, &Readability::Whole));
    // A record of an unknown kind ends the readable part.
    put(&autosave, &forged(1, &[(2, b"one"), (7, b"unknown"), (2, b"two")]));
    assert_eq!(autosave.entries(&only(&autosave)).unwrap(), edits(["one"]));
    // So does a record whose text cannot be parsed.
    put(&autosave, &forged(1, &[(2, b"one"), (3, b"no JSON"), (2, b"two")]));
    assert_eq!(autosave.entries(&only(&autosave)).unwrap(), edits(["one"]));
}

#[test]
fn the_bin_and_journals_without_work_are_limited_in_size() {
    let folder = quick_folder("scenario-bounds");
    let autosave = autosave(&folder, RealFiles);
    let stamp = replace(&folder.join("fox.glb"), b"saved").unwrap().stamp;
    for number in 0..110_u32 {
        let document = folder.join(&format!("{number}.glb"));
        let mut journal = begin(&autosave, Some(&document), Some(&stamp));
        journal.append(b"one", Instant::now()).unwrap();
        if number >= 5 {
            journal.saved(&stamp).unwrap();
        }
        journal.close().unwrap();
    }
    let gone = autosave.tidy(FolderLimits { least: 2, most: 3, bytes: 1 << 20 }).unwrap();
    assert_eq!(gone, 102, "the five with unsaved work stay, and three with history");
    let found = autosave.recoverable().unwrap();
    assert_eq!(found.iter().filter(|found| found.is_offered()).count(), 5);
    assert_eq!((found.len(), autosave.discarded().unwrap().len()), (8, 100));
}
