//! Damaged journals: the longest valid part at the start is recovered. Reading never panics, never returns a record
//! that was not written, and does not change the journal.

use crate::journal::{autosave, begin, only};
use dragonfly_kit::mounted::quick_folder;
use dragonfly_kit::random::{Random, seed};
use dragonfly_store::{
    Attribute, Autosave, Claim, FileData, JournalEntry, JournalError, Readability, RealFiles, Recoverable,
    Vfs, VfsFile,
};
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// A journal of a little more than 4 KiB: its bytes, its entries, and where each record ends.
struct Sample {
    bytes: Vec<u8>,
    entries: Vec<JournalEntry>,
    /// End of the header with the first record, which is not an edit; then the end of each edit.
    ends: Vec<usize>,
}

fn sample() -> Sample {
    let folder = quick_folder("damage-sample");
    let autosave = autosave(&folder, RealFiles);
    let mut journal = begin(&autosave, Some(&folder.join("fox.glb")), None);
    let mut random = Random::new(4096);
    let mut ends = Vec::new();
    ends.push(journal.size() as usize);
    while journal.size() < 4096 {
        let edit: Vec<u8> = (0..random.below(200)).map(|_| random.bits() as u8).collect();
        journal.append(&edit, Instant::now()).unwrap();
        ends.push(journal.size() as usize);
    }
    drop(journal);
    let found = only(&autosave);
    let entries = autosave.entries(&found).unwrap();
    assert!(entries.len() > 30);
    Sample { bytes: fs::read(&found.journal).unwrap(), entries, ends }
}

impl Sample {
    /// Returns the number of entries whose records end at or before `end`.
    fn whole(&self, end: usize) -> usize {
        self.ends.iter().filter(|&&record| record <= end).count().saturating_sub(1)
    }
}

/// A read-only file system that consists of one file in memory, whatever its name.
#[derive(Clone, Debug)]
struct InMemory(Arc<Vec<u8>>);

impl Vfs for InMemory {
    fn create_new(&self, _: &Path, _: bool) -> io::Result<Box<dyn VfsFile>> {
        Err(io::ErrorKind::ReadOnlyFilesystem.into())
    }

    fn open(&self, _: &Path) -> io::Result<Box<dyn VfsFile>> {
        Ok(Box::new(self.clone()))
    }

    fn open_to_write(&self, _: &Path) -> io::Result<Box<dyn VfsFile>> {
        Err(io::ErrorKind::ReadOnlyFilesystem.into())
    }

    fn metadata(&self, _: &Path) -> io::Result<FileData> {
        VfsFile::metadata(self)
    }

    fn read_link(&self, _: &Path) -> io::Result<PathBuf> {
        Err(io::ErrorKind::NotFound.into())
    }

    fn resolve(&self, _: &Path) -> io::Result<PathBuf> {
        Err(io::ErrorKind::NotFound.into())
    }

    fn rename(&self, _: &Path, _: &Path) -> io::Result<()> {
        Err(io::ErrorKind::ReadOnlyFilesystem.into())
    }

    fn rename_to_new(&self, _: &Path, _: &Path) -> io::Result<()> {
        Err(io::ErrorKind::ReadOnlyFilesystem.into())
    }

    fn remove(&self, _: &Path) -> io::Result<()> {
        Err(io::ErrorKind::ReadOnlyFilesystem.into())
    }

    fn create_folder(&self, _: &Path) -> io::Result<()> {
        Ok(())
    }

    fn sync_folder(&self, _: &Path) -> io::Result<()> {
        Ok(())
    }

    fn list(&self, _: &Path) -> io::Result<Vec<OsString>> {
        Ok(vec!["fox.journal".into()])
    }
}

impl VfsFile for InMemory {
    fn metadata(&self) -> io::Result<FileData> {
        let size = self.0.len() as u64;
        let kind = dragonfly_store::FileKind::File;
        Ok(FileData {
            kind,
            size,
            modified: 0,
            changed: 0,
            device: 0,
            inode: 0,
            links: 1,
            mode: 0,
            owner: 0,
            group: 0,
        })
    }

    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        let from = self.0.get(offset as usize..).unwrap_or_default();
        let got = from.len().min(bytes.len());
        bytes[..got].copy_from_slice(&from[..got]);
        Ok(got)
    }

    fn write_at(&self, _: &[u8], _: u64) -> io::Result<usize> {
        panic!("nothing is written to a journal that is only looked at")
    }

    fn set_size(&self, _: u64) -> io::Result<()> {
        panic!("nothing is cut off a journal that is only looked at")
    }

    fn sync_data(&self) -> io::Result<()> {
        Ok(())
    }

    fn sync_all(&self) -> io::Result<()> {
        Ok(())
    }

    fn try_lock(&self) -> io::Result<bool> {
        Ok(true)
    }

    fn unlock(&self) -> io::Result<()> {
        Ok(())
    }

    fn set_owner(&self, _: Option<u32>, _: u32) -> io::Result<()> {
        Ok(())
    }

    fn set_mode(&self, _: u32) -> io::Result<()> {
        Ok(())
    }

    fn attributes(&self) -> io::Result<Vec<Attribute>> {
        Ok(Vec::new())
    }

    fn set_attribute(&self, _: &[u8], _: &[u8]) -> io::Result<()> {
        Ok(())
    }
}

/// Returns the description and the entries of a journal with these bytes.
fn read(bytes: &[u8]) -> (Recoverable, Result<Vec<JournalEntry>, JournalError>) {
    let files = InMemory(Arc::new(bytes.to_vec()));
    let autosave = Autosave::new(Arc::new(files), Some("nowhere".into())).expect("a folder");
    let found = only(&autosave);
    let entries = autosave.entries(&found);
    (found, entries)
}

#[test]
fn a_truncated_journal_returns_all_complete_records() {
    let sample = sample();
    let mut header = sample.bytes.len();
    for length in 0..sample.bytes.len() {
        let (found, entries) = read(&sample.bytes[..length]);
        match entries {
            Ok(entries) => {
                header = header.min(length);
                let whole = sample.whole(length);
                assert_eq!(entries, sample.entries[..whole], "{length}");
                let rest = sample.ends.iter().rev().find(|&&end| end <= length);
                if let Some(end) = rest {
                    let cut = (length - end) as u64;
                    let wanted = if cut == 0 { Readability::Whole } else { Readability::Cut(cut) };
                    assert_eq!(found.reading, wanted, "{length}");
                }
            }
            Err(error) => {
                assert!(matches!(found.reading, Readability::Damaged(_)), "{length}: {found:?}");
                assert!(header == sample.bytes.len() && length < sample.ends[0], "{length}: {error}");
            }
        }
    }
    assert!(header < sample.ends[0]);
}

#[test]
fn every_flipped_bit_is_detected() {
    let sample = sample();
    let mut refused = 0;
    for bit in 0..sample.bytes.len() * 8 {
        let mut bytes = sample.bytes.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        let (found, entries) = read(&bytes);
        match entries {
            // Exactly the records before the one with the flipped bit.
            Ok(entries) => {
                assert_eq!(entries, sample.entries[..sample.whole(bit / 8)], "bit {bit}");
                assert!(matches!(found.reading, Readability::Cut(_)), "bit {bit}: {found:?}");
            }
            Err(_) => {
                refused += 1;
                assert!(matches!(found.reading, Readability::Damaged(_)), "bit {bit}: {found:?}");
            }
        }
    }
    assert!(refused > 0 && refused / 8 < sample.ends[0], "{refused}");
}

#[test]
fn records_out_of_order_or_from_another_journal_are_rejected() {
    let sample = sample();
    let record = |number: usize| &sample.bytes[sample.ends[number]..sample.ends[number + 1]];
    let put = |parts: &[&[u8]]| read(&parts.concat()).1.expect("a header");
    let begin = &sample.bytes[..sample.ends[1]];
    assert_eq!(put(&[begin, record(1)]), sample.entries[..2]);
    assert_eq!(put(&[begin, record(2)]), sample.entries[..1], "one is left out");
    assert_eq!(put(&[begin, record(0)]), sample.entries[..1], "one is there twice");
    assert_eq!(put(&[begin, record(2), record(1)]), sample.entries[..1]);
    // Records of another journal of the same document, which starts in the same way.
    let other = self::sample();
    let of_other = &other.bytes[other.ends[1]..other.ends[2]];
    assert_eq!(put(&[begin, of_other]), sample.entries[..1]);
    // Zeros or ones at the end, as a file system may leave them after a power cut.
    assert_eq!(put(&[begin, &[0; 4096]]), sample.entries[..1]);
    assert_eq!(put(&[begin, &[0xff; 4096]]), sample.entries[..1]);
}

#[test]
fn random_damage_never_panics_and_never_invents_records() {
    let seed = seed(20);
    let sample = sample();
    let rest = &sample.bytes[sample.ends[0]..];
    let mut random = Random::new(seed);
    let words: [&[u8]; 4] = [b"\x89DFJ\r\n\x1a\n", b"\x00\x00\x00\x40", b"\xff\xff\xff\x7f", &[0; 13]];
    let mut mutator = dragonfly_kit::mutate::Mutator::new(random.bits(), &words);
    let files = [sample.bytes.clone(), rest.to_vec()];
    for turn in 0..20_000 {
        if let Ok(entries) = read(&mutator.mutant(&files)).1 {
            let valid = entries.len() <= sample.entries.len() && entries == sample.entries[..entries.len()];
            assert!(valid, "turn {turn} of DRAGONFLY_SEED={seed}");
        }
    }
}

#[test]
fn a_read_error_truncates_nothing() {
    use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
    let folder = quick_folder("damage-unreadable");
    let sound = autosave(&folder, RealFiles);
    let mut journal = begin(&sound, None, None);
    for number in 0..50_u8 {
        journal.append(&[number; 5000], Instant::now()).unwrap();
    }
    drop(journal);
    let found = only(&sound);
    let entries = sound.entries(&found).unwrap();
    let mut failed = 0;
    for number in 1.. {
        let files = FaultyFiles::once(number, Fault::Io);
        let kept = autosave(&folder, files.clone()).resume(&found, Claim::IfFree);
        failed += usize::from(kept.is_err());
        drop(kept);
        assert_eq!(sound.entries(&only(&sound)).unwrap(), entries, "call {number}");
        if files.calls() < number {
            break;
        }
    }
    assert!(failed > 8, "{failed}");
}

#[test]
fn a_damaged_tail_is_moved_to_the_bin() {
    let sample = sample();
    let folder = quick_folder("damage-tail");
    let autosave = autosave(&folder, RealFiles);
    fs::create_dir_all(autosave.journals()).unwrap();
    let path = autosave.journals().join("fox.journal");
    let mut bytes = sample.bytes.clone();
    let middle = sample.ends[10] + 4;
    bytes[middle] ^= 0x20;
    fs::write(&path, &bytes).unwrap();
    let found = only(&autosave);
    assert_eq!(autosave.entries(&found).unwrap(), sample.entries[..10]);
    assert_eq!(fs::read(&path).unwrap(), bytes, "looking changes nothing");
    let mut resumed = autosave.resume(&found, Claim::IfFree).unwrap();
    assert_eq!(resumed.cut as usize, bytes.len() - sample.ends[10]);
    resumed.journal.append(b"and on", Instant::now()).unwrap();
    drop(resumed);
    let tail = autosave.discarded().unwrap();
    assert_eq!(fs::read(&tail[0]).unwrap(), bytes[sample.ends[10]..]);
    let found = only(&autosave);
    assert_eq!((found.reading.clone(), found.work), (Readability::Whole, 11));
}
