//! A separate process that edits and saves as fast as it can and prints each finished edit, to be killed or to have
//! its power cut. It runs the same test of this program again, which learns from [`is_writer`] that it is that
//! process.

use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::Random;
use dragonfly_kit::writer::{Found, LIMIT, Writer, WriterReport, nanoseconds};
use dragonfly_store::{
    Autosave, Claim, DocumentFileState, ExpectedFile, FileStamp, JournalEntry, Opening, RealFiles, Resumed,
    SaveOptions, save_document,
};
use std::ffi::OsStr;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::time::{Instant, SystemTime};

/// Environment variable with the folder in which the started process works.
const CHILD: &str = "DRAGONFLY_STORE_CHILD";

/// Environment variable that is set when the process only saves, without a journal: syncing a journal may also sync
/// other data.
const ONLY_SAVES: &str = "DRAGONFLY_STORE_CHILD_ONLY_SAVES";

/// Returns the document after this number of edits.
fn document(edits: u32) -> Vec<u8> {
    let mut bytes = format!("{edits}\n").into_bytes();
    let mut random = Random::new(u64::from(edits));
    bytes.extend((0..3000).flat_map(|_| random.bits().to_le_bytes()));
    bytes
}

/// Returns the number of edits in the document at `path`, which must be complete; `None` when there is no document.
#[track_caller]
pub(crate) fn document_at(path: &Path) -> Option<u32> {
    let bytes = fs::read(path).ok()?;
    let number = bytes.split(|byte| *byte == b'\n').next().and_then(|line| std::str::from_utf8(line).ok());
    let saved: u32 = number.and_then(|number| number.parse().ok()).expect("the document is whole");
    assert!(bytes == document(saved), "the document is torn");
    Some(saved)
}

/// Returns edit number `number`.
fn edit(number: u32) -> Vec<u8> {
    let mut bytes = number.to_le_bytes().to_vec();
    let mut random = Random::new(u64::from(number));
    bytes.extend((0..random.below(400)).map(|_| random.bits() as u8));
    bytes
}

/// Returns the number of edits in these entries, which must be consecutive from the first on.
fn count(entries: &[JournalEntry]) -> u32 {
    let mut edits = 0;
    for entry in entries {
        match entry {
            JournalEntry::Snapshot(bytes) => {
                edits = u32::from_le_bytes(bytes[..].try_into().expect("a number"))
            }
            JournalEntry::Edit(bytes) => {
                edits += 1;
                assert!(*bytes == edit(edits), "edit {edits} is another one");
            }
            JournalEntry::Saved => {}
        }
    }
    edits
}

/// Edits and saves if this process is the one to be killed. Returns whether it was; if so, the calling test must
/// return.
pub(crate) fn is_writer() -> bool {
    let Some(folder) = std::env::var_os(CHILD) else { return false };
    let mut out = std::io::stdout();
    // Printed with the time at which it was done, because the time of reading is later.
    let mut say = |what: &str| {
        let line = format!("{what} {}\n", nanoseconds(SystemTime::now()));
        out.write_all(line.as_bytes()).and_then(|()| out.flush()).is_ok()
    };
    say("\nstarted");
    let work = if std::env::var_os(ONLY_SAVES).is_some() { save_on } else { write_on };
    if let Err(error) = work(Path::new(&folder), &mut say) {
        say(&format!("x {error}"));
    }
    true
}

type Worked = Result<(), Box<dyn std::error::Error>>;

fn save_on(folder: &Path, say: &mut dyn FnMut(&str) -> bool) -> Worked {
    let path = folder.join("fox.glb");
    let mut saved = document_at(&path).unwrap_or_default();
    let began = Instant::now();
    while began.elapsed() < LIMIT {
        saved += 1;
        dragonfly_store::replace(&path, &document(saved))?;
        if !say(&format!("s {saved}")) {
            break;
        }
    }
    Ok(())
}

fn write_on(folder: &Path, say: &mut dyn FnMut(&str) -> bool) -> Worked {
    let autosave = Autosave::new(Arc::new(RealFiles), Some(folder.join("autosave"))).expect("a folder");
    let path = folder.join("fox.glb");
    if !path.exists() {
        dragonfly_store::replace(&path, &document(0))?;
    }
    let mut stamp = FileStamp::take(&RealFiles, &path)?;
    let Resumed { mut journal, entries, .. } = match autosave.begin(Some(&path), Some(&stamp))? {
        Opening::New(journal) => Resumed { journal: *journal, entries: Vec::new(), cut: 0 },
        Opening::Found(found) => autosave.resume(&found, Claim::IfFree)?,
    };
    let mut edits = count(&entries);
    let began = Instant::now();
    while began.elapsed() < LIMIT {
        edits += 1;
        journal.append(&edit(edits), Instant::now())?;
        let mut listens = say(&format!("e {edits}"));
        if edits.is_multiple_of(7) {
            journal.end_of_gesture(Instant::now());
        }
        if journal.sync_if_due(Instant::now())? {
            listens &= say(&format!("y {edits}"));
        }
        if edits.is_multiple_of(60) {
            journal.compact(&edits.to_le_bytes())?;
            listens &= say(&format!("y {edits}"));
        }
        if edits.is_multiple_of(10) {
            let options =
                SaveOptions { expected: ExpectedFile::Stamp(&stamp), versions: Some(autosave.versions()) };
            let saved = save_document(&RealFiles, &mut journal, &path, &document(edits), &options)?;
            stamp = saved.stamp;
            match saved.notices.first() {
                None => listens &= say(&format!("s {edits}")),
                Some(notice) => return Err(notice.as_str().into()),
            }
        }
        if !listens {
            break;
        }
    }
    Ok(())
}

/// Checks the files after stop number `stop`: they must be complete and consistent.
#[track_caller]
pub(crate) fn check(folder: &Folder, said: &WriterReport, stop: usize) -> Found {
    check_at(folder.path(), said, stop)
}

/// Same as [`check`], for a path.
#[track_caller]
pub(crate) fn check_at(folder: &Path, said: &WriterReport, stop: usize) -> Found {
    let path = folder.join("fox.glb");
    let Some(saved) = document_at(&path) else {
        assert_eq!((said.edits, said.saved), (0, 0), "stop {stop}: the document is gone");
        return Found { edits: 0, saved: 0 };
    };
    let autosave = Autosave::new(Arc::new(RealFiles), Some(folder.join("autosave"))).expect("a folder");
    let found = autosave.recoverable().expect("the folder can be read");
    // A process stopped while it created its first journal left none, or an empty one.
    let Some(found) = found.into_iter().find(|found| found.work > 0) else {
        assert_eq!((said.edits, saved), (0, 0), "stop {stop}: the journal is gone");
        return Found { edits: 0, saved };
    };
    let edits = count(&autosave.entries(&found).expect("the journal can be read"));
    assert!(saved <= edits, "stop {stop}: {saved} edits are in the document, {edits} in the journal");
    // No other program wrote the file, so the journal recognizes it, however the process was stopped.
    assert_eq!(found.file, DocumentFileState::Same, "stop {stop}: {found:?}");
    assert_eq!(found.unsaved == 0, saved == edits, "stop {stop}: {found:?}, {saved} of {edits} saved");
    Found { edits, saved }
}

/// Starts `test`, which calls [`is_writer`] first, to edit and save in `folder`.
pub(crate) fn start(test: &str, folder: &Path) -> Writer {
    Writer::of(test, &[(CHILD, folder.as_os_str())])
}

/// Starts `test`, which calls [`is_writer`] first, to do nothing but save in `folder`.
pub(crate) fn start_saving(test: &str, folder: &Path) -> Writer {
    Writer::of(test, &[(CHILD, folder.as_os_str()), (ONLY_SAVES, OsStr::new("1"))])
}
