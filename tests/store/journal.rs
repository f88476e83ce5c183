//! Journal: appended records are read back, due records are synced to the disk, and only one program at a time owns
//! it.

use dragonfly_kit::counting;
use dragonfly_kit::folder::Folder;
use dragonfly_kit::mounted::quick_folder;
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_store::{
    Autosave, Claim, DocumentFileState, FileStamp, Journal, JournalEntry, JournalError, JournalOwner,
    LONGEST_UNSYNCED, Opening, OwnerStatus, Readability, RealFiles, Recoverable, SaveOptions, Vfs,
    save_document,
};
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Returns an autosave folder below `folder`.
pub(crate) fn autosave(folder: &Folder, files: impl Vfs + 'static) -> Autosave {
    Autosave::new(Arc::new(files), Some(folder.join("autosave"))).expect("the folder is given")
}

/// Starts the new journal of a document.
#[track_caller]
pub(crate) fn begin(autosave: &Autosave, document: Option<&Path>, stamp: Option<&FileStamp>) -> Journal {
    match autosave.begin(document, stamp).expect("a journal") {
        Opening::New(journal) => *journal,
        Opening::Found(found) => panic!("there is one already: {found:?}"),
    }
}

/// Returns the only journal there is.
#[track_caller]
pub(crate) fn only(autosave: &Autosave) -> Recoverable {
    let found = autosave.recoverable().expect("the folder can be read");
    assert_eq!(found.len(), 1, "{found:?}");
    found.into_iter().next().expect("one")
}

pub(crate) fn edits<'a>(texts: impl IntoIterator<Item = &'a str>) -> Vec<JournalEntry> {
    texts.into_iter().map(|text| JournalEntry::Edit(text.as_bytes().to_vec())).collect()
}

#[test]
fn appended_records_are_read_back_in_order() {
    let folder = quick_folder("journal-order");
    let autosave = autosave(&folder, RealFiles);
    let mut journal = begin(&autosave, None, None);
    let now = Instant::now();
    for text in ["one", "", "three"] {
        journal.append(text.as_bytes(), now).unwrap();
    }
    let long = vec![7; 3 << 20];
    journal.append(&long, now).unwrap();
    // Dropped without a sync, as by a killed program.
    drop(journal);
    let found = only(&autosave);
    assert_eq!((found.work, found.unsaved, found.owner_status), (4, 4, OwnerStatus::Exited));
    assert_eq!((&found.reading, &found.file), (&Readability::Whole, &DocumentFileState::Unsaved));
    assert_eq!(found.owner, Some(JournalOwner::this()));
    assert!(found.is_offered());
    let mut wanted = edits(["one", "", "three"]);
    wanted.push(JournalEntry::Edit(long));
    assert_eq!(autosave.entries(&found).unwrap(), wanted);
    let mut resumed = autosave.resume(&found, Claim::IfFree).unwrap();
    assert_eq!((resumed.entries, resumed.cut), (wanted.clone(), 0));
    resumed.journal.append(b"five", now).unwrap();
    resumed.journal.close().unwrap();
    wanted.extend(edits(["five"]));
    assert_eq!(autosave.entries(&only(&autosave)).unwrap(), wanted);
}

#[test]
fn a_record_is_due_after_a_fifth_of_a_second_or_at_the_end_of_the_gesture() {
    let folder = quick_folder("journal-due");
    let mut journal = begin(&autosave(&folder, RealFiles), None, None);
    let start = Instant::now();
    let after = |milliseconds| start + Duration::from_millis(milliseconds);
    assert_eq!(journal.next_due(), None);
    journal.end_of_gesture(start);
    assert_eq!(journal.next_due(), None, "nothing was appended");
    journal.append(b"one", start).unwrap();
    journal.append(b"two", after(150)).unwrap();
    assert_eq!(journal.next_due(), Some(start + LONGEST_UNSYNCED), "the first one counts");
    assert!(!journal.sync_if_due(after(199)).unwrap());
    assert!(journal.sync_if_due(after(200)).unwrap());
    assert_eq!(journal.next_due(), None);
    assert!(!journal.sync_if_due(after(900)).unwrap());
    journal.append(b"three", after(1000)).unwrap();
    journal.end_of_gesture(after(1001));
    assert_eq!(journal.next_due(), Some(after(1001)));
    assert!(journal.sync_if_due(after(1001)).unwrap());
    assert_eq!(LONGEST_UNSYNCED, Duration::from_millis(200));
}

#[test]
fn a_snapshot_replaces_all_records_before_it() {
    let folder = quick_folder("journal-compact");
    let autosave = autosave(&folder, RealFiles);
    let mut journal = begin(&autosave, None, None);
    let now = Instant::now();
    for number in 0..500_u32 {
        journal.append(&number.to_le_bytes(), now).unwrap();
    }
    let long = journal.size();
    journal.compact(b"all of it").unwrap();
    assert!(journal.size() < long / 10, "{} of {long}", journal.size());
    assert_eq!((journal.unsaved(), journal.next_due()), (1, None));
    journal.append(b"more", now).unwrap();
    drop(journal);
    let wanted = [vec![JournalEntry::Snapshot(b"all of it".to_vec())], edits(["more"])].concat();
    assert_eq!(autosave.entries(&only(&autosave)).unwrap(), wanted);
    // A program that was killed during a compaction leaves a half-written file.
    let found = only(&autosave);
    fs::write(found.journal.with_extension("compact"), "half").unwrap();
    let mut journal = autosave.resume(&found, Claim::IfFree).unwrap().journal;
    journal.compact(b"again").unwrap();
    drop(journal);
    assert_eq!(autosave.entries(&only(&autosave)).unwrap(), [JournalEntry::Snapshot(b"again".to_vec())]);
    assert_eq!(fs::read_dir(autosave.journals()).unwrap().count(), 1);
}

#[test]
fn saved_edits_are_not_unsaved_work_and_their_history_is_kept() {
    let folder = quick_folder("journal-saved");
    let autosave = autosave(&folder, RealFiles);
    let path = folder.join("fox.glb");
    fs::write(&path, "as read").unwrap();
    let stamp = FileStamp::take(&RealFiles, &path).unwrap();
    let mut journal = begin(&autosave, Some(&path), Some(&stamp));
    assert_eq!(journal.document().as_deref(), Some(fs::canonicalize(&path).unwrap().as_path()));
    let now = Instant::now();
    journal.append(b"one", now).unwrap();
    let saved = save_document(&RealFiles, &mut journal, &path, b"saved", &SaveOptions::default()).unwrap();
    assert_eq!(saved.notices, Vec::<String>::new());
    assert_eq!((journal.unsaved(), journal.stamp()), (0, Some(&saved.stamp)));
    journal.append(b"two", now).unwrap();
    assert_eq!(journal.unsaved(), 1);
    // A copy at another path is not a save of the document.
    save_document(&RealFiles, &mut journal, &folder.join("copy.glb"), b"copy", &SaveOptions::default())
        .unwrap();
    assert_eq!(journal.unsaved(), 1);
    save_document(&RealFiles, &mut journal, &path, b"saved again", &SaveOptions::default()).unwrap();
    journal.compact(b"all").unwrap();
    assert_eq!(journal.unsaved(), 0, "a snapshot of what is saved is saved");
    journal.close().unwrap();
    let found = only(&autosave);
    assert_eq!((found.work, found.unsaved, &found.file), (1, 0, &DocumentFileState::Same));
    assert!(!found.is_offered());
    // After reopening, the history is still available.
    let Opening::Found(found) = autosave.begin(Some(&path), None).unwrap() else { panic!("its history") };
    let entries = autosave.resume(&found, Claim::IfFree).unwrap().entries;
    assert_eq!(entries, [JournalEntry::Snapshot(b"all".to_vec()), JournalEntry::Saved]);
}

#[test]
fn a_save_counts_even_if_the_program_is_killed_before_the_journal_records_it() {
    let folder = quick_folder("journal-between");
    let autosave = autosave(&folder, RealFiles);
    let path = folder.join("fox.glb");
    fs::write(&path, "as read").unwrap();
    let stamp = FileStamp::take(&RealFiles, &path).unwrap();
    let mut journal = begin(&autosave, Some(&path), Some(&stamp));
    journal.append(b"one", Instant::now()).unwrap();
    journal.saving(b"saved").unwrap();
    drop(journal);
    let found = only(&autosave);
    assert_eq!((found.unsaved, &found.file), (1, &DocumentFileState::Same), "killed before");
    dragonfly_store::replace(&path, b"saved").unwrap();
    let found = only(&autosave);
    assert_eq!((found.unsaved, &found.file), (0, &DocumentFileState::Same), "killed after");
    let mut journal = autosave.resume(&found, Claim::IfFree).unwrap().journal;
    assert_eq!(journal.unsaved(), 0);
    journal.append(b"two", Instant::now()).unwrap();
    drop(journal);
    let found = only(&autosave);
    assert_eq!((found.work, found.unsaved, &found.file), (2, 1, &DocumentFileState::Same));
    // The journal has recorded the save, so it counts even when the file no longer has the saved content.
    fs::write(&path, "somebody else's").unwrap();
    let found = only(&autosave);
    assert_eq!((found.work, found.unsaved, &found.file), (2, 1, &DocumentFileState::Changed));
}

#[test]
fn closing_an_empty_journal_deletes_its_file() {
    let folder = quick_folder("journal-nothing");
    let autosave = autosave(&folder, RealFiles);
    assert_eq!(autosave.recoverable().unwrap(), [], "there is no folder yet");
    begin(&autosave, None, None).close().unwrap();
    assert_eq!(fs::read_dir(autosave.journals()).unwrap().count(), 0);
}

#[test]
fn a_failed_append_leaves_no_record_and_the_next_append_works() {
    let folder = quick_folder("journal-failed");
    for number in 1.. {
        let _ = fs::remove_dir_all(folder.join("autosave"));
        let files = FaultyFiles::from(number, Fault::Full);
        let autosave = autosave(&folder, files.clone());
        let Ok(Opening::New(mut journal)) = autosave.begin(None, None) else { continue };
        let now = Instant::now();
        let first = journal.append(b"first", now).is_ok();
        let error = journal.append(&[9; 100_000], now);
        drop(journal);
        // Even if the disk stays full: the rest of the failed record, which could not be cut off, does not count as
        // work.
        let sound = crate::journal::autosave(&folder, RealFiles);
        let found = only(&sound);
        assert_eq!(sound.entries(&found).unwrap().len(), usize::from(first) + usize::from(error.is_ok()));
        let mut journal = sound.resume(&found, Claim::IfFree).unwrap().journal;
        journal.append(b"next", now).unwrap();
        drop(journal);
        assert_eq!(sound.entries(&only(&sound)).unwrap().last(), edits(["next"]).last());
        if files.calls() < number {
            break;
        }
    }
}

#[test]
fn after_a_disk_error_a_journal_refuses_records_until_a_snapshot() {
    let folder = quick_folder("journal-broken");
    let now = Instant::now();
    let mut met = 0;
    for number in 1..40 {
        let _ = fs::remove_dir_all(folder.join("autosave"));
        let autosave = autosave(&folder, FaultyFiles::once(number, Fault::Io));
        let Ok(Opening::New(mut journal)) = autosave.begin(None, None) else { continue };
        if journal.append(b"one", now).is_err() || journal.sync().is_ok() {
            continue;
        }
        met += 1;
        let error = journal.append(b"two", now).unwrap_err();
        assert!(matches!(error, JournalError::Broken { .. }), "{error}");
        // The disk would report success now, but the journal does not try again.
        assert!(matches!(journal.sync().unwrap_err(), JournalError::Broken { .. }));
        assert!(journal.broken().is_some());
        journal.compact(b"one, two").unwrap();
        journal.append(b"three", now).unwrap();
        journal.sync().unwrap();
        drop(journal);
        let wanted = [vec![JournalEntry::Snapshot(b"one, two".to_vec())], edits(["three"])].concat();
        assert_eq!(autosave.entries(&only(&autosave)).unwrap(), wanted);
    }
    assert_eq!(met, 1, "the call that brings it to the disk failed in one of the runs");
}

#[test]
fn appending_allocates_nothing() {
    let folder = quick_folder("journal-allocations");
    let mut journal = begin(&autosave(&folder, RealFiles), None, None);
    let now = Instant::now();
    journal.append(&[1; 500], now).unwrap();
    let (count, ()) = counting::count(|| {
        for _ in 0..1000 {
            journal.append(&[2; 500], now).unwrap();
        }
    });
    assert_eq!(count.allocations, 0);
}

#[test]
fn documents_may_have_names_that_are_not_utf8_or_very_long() {
    use std::os::unix::ffi::OsStrExt;
    let folder = quick_folder("journal-names");
    let autosave = autosave(&folder, RealFiles);
    let long = "x".repeat(251) + ".glb";
    for name in [&b"fox \xff\xfe.glb"[..], long.as_bytes(), "日本 🦊\n.glb".as_bytes(), b".hidden", b"-"]
    {
        let path = folder.path().join(std::ffi::OsStr::from_bytes(name));
        dragonfly_store::replace(&path, b"model").unwrap();
        let mut journal = begin(&autosave, Some(&path), None);
        journal.append(b"one", Instant::now()).unwrap();
        drop(journal);
        let found = only(&autosave);
        assert_eq!(found.document, Some(fs::canonicalize(&path).unwrap()));
        autosave.discard(&found).unwrap();
        assert_eq!(autosave.versions().of(&RealFiles, &path).unwrap(), []);
    }
}

/// A process that is being started has copies of all open files until it runs its program, and a copy keeps a lock.
#[test]
fn inspecting_a_journal_leaves_it_free_while_other_processes_are_started() {
    let folder = quick_folder("journal-inspected");
    let autosave = autosave(&folder, RealFiles);
    let mut journal = begin(&autosave, None, None);
    journal.append(b"one", Instant::now()).unwrap();
    drop(journal);
    let done = std::sync::atomic::AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !done.load(std::sync::atomic::Ordering::Relaxed) {
                std::process::Command::new("true").status().unwrap();
            }
        });
        let running = (0..2000).filter(|_| only(&autosave).owner_status != OwnerStatus::Exited).count();
        done.store(true, std::sync::atomic::Ordering::Relaxed);
        assert_eq!(running, 0, "inspections that took the lock of an earlier one for that of an owner");
    });
}
