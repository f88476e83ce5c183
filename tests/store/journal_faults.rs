//! Whichever system call fails, the journal returns every edit that counted as done, and no other edit.

use crate::journal::{autosave, begin, edits, only};
use dragonfly_kit::mounted::quick_folder;
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_store::{
    Autosave, Claim, FileStamp, FolderLimits, Journal, JournalEntry, JournalError, Opening, OwnerStatus,
    RealFiles, Recoverable,
};
use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// Returns the document that results from the entries of a journal.
pub(crate) fn document(entries: &[JournalEntry]) -> Vec<String> {
    let mut document = Vec::new();
    for entry in entries {
        match entry {
            JournalEntry::Snapshot(bytes) => {
                let text = String::from_utf8(bytes.clone()).unwrap();
                document = text.lines().map(str::to_owned).collect();
            }
            JournalEntry::Edit(bytes) => document.push(String::from_utf8(bytes.clone()).unwrap()),
            JournalEntry::Saved => {}
        }
    }
    document
}

/// Performs a fixed sequence of operations. Returns the edits that were reported as recorded, and the errors.
fn work(journal: &mut Journal, stamp: &FileStamp) -> (Vec<String>, Vec<JournalError>) {
    let now = Instant::now();
    let mut done: Vec<String> = Vec::new();
    let mut errors = Vec::new();
    for step in "aasadSDacaascaadSDasaa".chars() {
        let edit = format!("edit {}{step}", done.len());
        let outcome = match step {
            'a' => journal.append(edit.as_bytes(), now).map(|()| done.push(edit)),
            'd' => journal.append(&[b'd'; 70_000], now).map(|()| done.push("d".repeat(70_000))),
            's' => journal.sync(),
            'S' => journal.saving(b"saved"),
            'D' => journal.saved(stamp),
            _ => journal.compact(done.join("\n").as_bytes()),
        };
        if let Err(error) = outcome {
            errors.push(error);
            if journal.broken().is_some() {
                journal.compact(done.join("\n").as_bytes()).expect("only one call fails");
            }
        }
    }
    (done, errors)
}

fn count(folder: &Path) -> usize {
    fs::read_dir(folder).map_or(0, Iterator::count)
}

#[test]
fn a_failure_of_any_system_call_loses_no_recorded_edit() {
    let folder = quick_folder("journal-faults");
    let path = folder.join("fox.glb");
    let stamp = dragonfly_store::replace(&path, b"saved").unwrap().stamp;
    let (mut runs, mut noticed) = (0, 0);
    for fault in Fault::ALL {
        for number in 1.. {
            let _ = fs::remove_dir_all(folder.join("autosave"));
            let files = FaultyFiles::once(number, fault);
            let faulty = autosave(&folder, files.clone());
            let sound = autosave(&folder, RealFiles);
            let place = format!("call {number}, {fault:?}");
            let mut journal = match faulty.begin(Some(&path), Some(&stamp)) {
                Ok(Opening::New(journal)) => *journal,
                Ok(Opening::Found(found)) => panic!("{place}: {found:?}"),
                Err(error) => {
                    assert!(!fault.is_harmless(), "{place}: {error}");
                    assert_eq!(count(&sound.journals()), 0, "{place}: {error}");
                    begin(&sound, Some(&path), None);
                    continue;
                }
            };
            let (done, errors) = work(&mut journal, &stamp);
            assert!(errors.is_empty() || !fault.is_harmless(), "{place}: {errors:?}");
            noticed += errors.len();
            // All edits are found, whether the program is killed or closes the journal in order.
            let closed = match number % 2 {
                0 => journal.close().is_ok(),
                _ => {
                    drop(journal);
                    false
                }
            };
            let found = only(&sound);
            assert_eq!(
                document(&sound.entries(&found).unwrap()),
                done,
                "{place}, closed {closed}: {errors:?}"
            );
            assert_eq!(count(&sound.journals()), 1, "{place}: {errors:?}");
            if files.calls() < number {
                assert!(errors.is_empty());
                break;
            }
            runs += 1;
        }
    }
    println!("{runs} failing calls, {noticed} errors");
    assert!(runs > 6 * 40 && noticed > 3 * 20, "{runs} calls, {noticed} errors");
}

/// Records three edits, and half of a fourth one.
fn unfinished(sound: &Autosave) -> Recoverable {
    let mut journal = begin(sound, None, None);
    for text in ["one", "two", "three"] {
        journal.append(text.as_bytes(), Instant::now()).unwrap();
    }
    let path = journal.path().to_path_buf();
    drop(journal);
    fs::OpenOptions::new().append(true).open(path).unwrap().write_all(b"\x09\0\0\0\x02half").unwrap();
    only(sound)
}

type Operation = fn(&Autosave, &Recoverable) -> Result<(), JournalError>;

const OPERATIONS: [(&str, Operation); 7] = [
    ("list", |autosave, _| autosave.recoverable().map(drop)),
    ("read", |autosave, found| autosave.entries(found).map(drop)),
    ("keep", |autosave, found| autosave.resume(found, Claim::IfFree).map(drop)),
    ("beside", |autosave, found| autosave.copy(found, None).map(drop)),
    ("discard", |autosave, found| autosave.discard(found).map(drop)),
    ("discard and bring back", |autosave, found| autosave.restore(&autosave.discard(found)?).map(drop)),
    ("tidy", |autosave, _| autosave.tidy(FolderLimits { least: 0, most: 0, bytes: 0 }).map(drop)),
];

#[test]
fn a_failure_of_any_system_call_while_recovering_loses_nothing() {
    let folder = quick_folder("recovery-faults");
    let wanted = edits(["one", "two", "three"]);
    for (name, operation) in OPERATIONS {
        for fault in Fault::ALL {
            for number in 1.. {
                let _ = fs::remove_dir_all(folder.join("autosave"));
                let sound = autosave(&folder, RealFiles);
                let found = unfinished(&sound);
                let files = FaultyFiles::once(number, fault);
                let outcome = operation(&autosave(&folder, files.clone()), &found);
                let place = format!("{name}, call {number}, {fault:?}: {outcome:?}");
                assert!(outcome.is_ok() || !fault.is_harmless(), "{place}");
                let bin = sound.discarded().unwrap();
                for file in bin.iter().filter(|file| !file.to_string_lossy().ends_with(".tail")) {
                    sound.restore(file).expect(&place);
                }
                let left = sound.recoverable().unwrap();
                let copies = usize::from(name == "beside" && outcome.is_ok());
                assert_eq!(left.len(), 1 + copies, "{place}: {left:?}");
                assert_eq!(count(&sound.journals()), left.len(), "{place}");
                for found in &left {
                    assert_eq!(sound.entries(found).unwrap(), wanted, "{place}");
                    sound.resume(found, Claim::IfFree).expect(&place);
                }
                if files.calls() < number {
                    break;
                }
            }
        }
    }
}

#[test]
fn a_journal_restarted_while_another_program_reads_it_is_still_in_use() {
    let folder = quick_folder("journal-meddling");
    let sound = autosave(&folder, RealFiles);
    let mut journal = begin(&sound, None, None);
    journal.append(b"one", Instant::now()).unwrap();
    let journal = Arc::new(Mutex::new(journal));
    for number in 1.. {
        let owner = Arc::clone(&journal);
        let files = FaultyFiles::meddling(number, move || {
            owner.lock().unwrap().compact(b"one").unwrap();
        });
        let found = only(&autosave(&folder, files.clone()));
        assert_eq!(found.owner_status, OwnerStatus::Running, "call {number}: {found:?}");
        if files.calls() < number {
            break;
        }
    }
}
