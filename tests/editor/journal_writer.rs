//! A process of its own that edits and saves as fast as it can and prints what is done: to be killed, or to have its power
//! cut. It runs the same test of this program again, which finds out by [`is_writer`] that it is to write.

use crate::program::Folder;
use dragonfly::store::{
    Autosave, Claim, Entry, Expected, Fate, FileStamp, Opening, RealFiles, Resumed, SaveOptions,
    save_document,
};
use dragonfly_kit::random::Random;
use std::ffi::OsStr;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// The folder to work in, for the program that is started.
const CHILD: &str = "DRAGONFLY_STORE_CHILD";

/// Set when it is only to save, without a journal: what a journal brings to the disk takes other things along.
const ONLY_SAVES: &str = "DRAGONFLY_STORE_CHILD_ONLY_SAVES";

/// Longer than it ever takes to start on a busy machine; and the writer ends by itself after it.
const LIMIT: Duration = Duration::from_secs(30);

/// The document after so many edits.
fn document(edits: u32) -> Vec<u8> {
    let mut bytes = format!("{edits}\n").into_bytes();
    let mut random = Random::new(u64::from(edits));
    bytes.extend((0..3000).flat_map(|_| random.bits().to_le_bytes()));
    bytes
}

/// After how many edits the document at `path` was saved, which must be whole; `None` when there is none.
#[track_caller]
pub(crate) fn document_at(path: &Path) -> Option<u32> {
    let bytes = fs::read(path).ok()?;
    let number = bytes.split(|byte| *byte == b'\n').next().and_then(|line| std::str::from_utf8(line).ok());
    let saved: u32 = number.and_then(|number| number.parse().ok()).expect("the document is whole");
    assert!(bytes == document(saved), "the document is torn");
    Some(saved)
}

/// Edit number `number`.
fn edit(number: u32) -> Vec<u8> {
    let mut bytes = number.to_le_bytes().to_vec();
    let mut random = Random::new(u64::from(number));
    bytes.extend((0..random.below(400)).map(|_| random.bits() as u8));
    bytes
}

/// How many edits these entries are, which must be all from the first on.
fn count(entries: &[Entry]) -> u32 {
    let mut edits = 0;
    for entry in entries {
        match entry {
            Entry::Snapshot(bytes) => edits = u32::from_le_bytes(bytes[..].try_into().expect("a number")),
            Entry::Edit(bytes) => {
                edits += 1;
                assert!(*bytes == edit(edits), "edit {edits} is another one");
            }
            Entry::Saved => {}
        }
    }
    edits
}

/// Returns whether this process is the one that is to be killed; if so, it has edited and saved until now, and the test
/// that calls this has nothing else to do.
pub(crate) fn is_writer() -> bool {
    let Some(folder) = std::env::var_os(CHILD) else { return false };
    let mut out = std::io::stdout();
    // With the time when it was done: when it is read says less.
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
        dragonfly::store::replace(&path, &document(saved))?;
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
        dragonfly::store::replace(&path, &document(0))?;
    }
    let mut stamp = FileStamp::take(&RealFiles, &path)?;
    let Resumed { mut journal, entries, .. } = match autosave.begin(Some(&path), Some(&stamp))? {
        Opening::New(journal) => Resumed { journal: *journal, entries: Vec::new(), cut: 0 },
        Opening::Found(found) => autosave.keep(&found, Claim::IfFree)?,
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
                SaveOptions { expected: Expected::Stamp(&stamp), versions: Some(autosave.versions()) };
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

/// The program, while it runs.
pub(crate) struct Writer {
    child: Child,
    lines: Receiver<String>,
    early: Vec<String>,
}

/// The clock on the wall, which two programs share.
pub(crate) fn nanoseconds(time: SystemTime) -> u128 {
    time.duration_since(UNIX_EPOCH).expect("after 1970").as_nanos()
}

/// What the program said was done.
#[derive(Debug, Default)]
pub(crate) struct Said {
    /// Edits that counted as done.
    pub(crate) edits: u32,
    /// Of them, those said to be on the disk.
    pub(crate) synced: u32,
    /// Edits in the file that was saved last.
    pub(crate) saved: u32,
    /// Edits said to be on the disk, by one that was not to be believed any more.
    pub(crate) late: u32,
    /// When each of the edits was done: number and [`nanoseconds`].
    pub(crate) times: Vec<(u32, u128)>,
    /// What went wrong.
    pub(crate) complaint: Option<String>,
}

/// What there is after it was stopped.
#[derive(Debug)]
pub(crate) struct Found {
    pub(crate) edits: u32,
    pub(crate) saved: u32,
}

fn program() -> std::path::PathBuf {
    std::env::current_exe().expect("a running test has a file")
}

impl Writer {
    /// Starts `test`, which calls [`is_writer`] first, to work in `folder`.
    pub(crate) fn start(test: &str, folder: &Path) -> Self {
        Self::of(test, &[(CHILD, folder.as_os_str())])
    }

    /// Starts `test`, which calls [`is_writer`] first, to do nothing but save.
    pub(crate) fn start_saving(test: &str, folder: &Path) -> Self {
        Self::of(test, &[(CHILD, folder.as_os_str()), (ONLY_SAVES, OsStr::new("1"))])
    }

    /// Starts a test of this program in another process, with variables that tell it what to do. `test` is its name with
    /// the module.
    pub(crate) fn of(test: &str, environment: &[(&str, &OsStr)]) -> Self {
        Self::run_test(Command::new(program()).envs(environment.iter().copied()), test)
    }

    fn run_test(command: &mut Command, test: &str) -> Self {
        let mut child = command
            .args([test, "--exact", "--nocapture", "--test-threads=1"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the test's own file can be started");
        let out = BufReader::new(child.stdout.take().expect("piped"));
        let (sender, lines) = channel();
        let read = move || {
            for line in out.lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        };
        std::thread::Builder::new().name("reader".to_owned()).spawn(read).expect("a thread");
        Self { child, lines, early: Vec::new() }
    }

    /// Returns when the first edit is done.
    #[track_caller]
    pub(crate) fn working(&mut self) {
        let done = |line: &str| ["e ", "s ", "x "].iter().any(|kind| line.starts_with(kind));
        while !self.early.last().is_some_and(|line| done(line)) {
            self.early.push(self.lines.recv_timeout(LIMIT).expect("it works"));
        }
    }

    pub(crate) fn process(&self) -> u32 {
        self.child.id()
    }

    /// Kills it; all that it said.
    pub(crate) fn kill(self) -> Said {
        self.kill_and_believe(u128::MAX)
    }

    /// All that it said, once it ended because somebody else killed it.
    pub(crate) fn ended(self) -> Said {
        self.end_and_believe(u128::MAX)
    }

    /// Kills it; what it said was done before `end`, in [`nanoseconds`].
    pub(crate) fn kill_and_believe(mut self, end: u128) -> Said {
        self.child.kill().expect("it runs");
        self.end_and_believe(end)
    }

    fn end_and_believe(mut self, end: u128) -> Said {
        self.child.wait().expect("it ends");
        let mut said = Said::default();
        // What was in the pipe was said before it was killed.
        for line in self.early.drain(..).chain(self.lines.iter()) {
            let Some((rest, time)) = line.rsplit_once(' ') else { continue };
            let Some((kind, rest)) = rest.split_once(' ') else { continue };
            if kind == "x" {
                said.complaint = Some(rest.to_owned());
            }
            let (Ok(number), Ok(time)) = (rest.parse(), time.parse()) else { continue };
            if time >= end {
                if kind == "y" || kind == "s" {
                    said.late = number;
                }
                continue;
            }
            match kind {
                "e" => {
                    said.edits = number;
                    said.times.push((number, time));
                }
                "y" => said.synced = number,
                "s" => said.saved = number,
                _ => {}
            }
        }
        said
    }
}

/// Looks at what there is after stop number `stop`, which must be whole and fit together.
#[track_caller]
pub(crate) fn check(folder: &Folder, said: &Said, stop: usize) -> Found {
    check_at(folder.path(), said, stop)
}

/// As [`check`].
#[track_caller]
pub(crate) fn check_at(folder: &Path, said: &Said, stop: usize) -> Found {
    let path = folder.join("fox.glb");
    let Some(saved) = document_at(&path) else {
        assert_eq!((said.edits, said.saved), (0, 0), "stop {stop}: the document is gone");
        return Found { edits: 0, saved: 0 };
    };
    let autosave = Autosave::new(Arc::new(RealFiles), Some(folder.join("autosave"))).expect("a folder");
    let found = autosave.recoverable().expect("the folder can be read");
    // Stopped while it made its first journal, it left none, or one without anything in it.
    let Some(found) = found.into_iter().find(|found| found.work > 0) else {
        assert_eq!((said.edits, saved), (0, 0), "stop {stop}: the journal is gone");
        return Found { edits: 0, saved };
    };
    let edits = count(&autosave.entries(&found).expect("the journal can be read"));
    assert!(saved <= edits, "stop {stop}: {saved} edits are in the document, {edits} in the journal");
    // Nobody else wrote it, so the journal knows it, however the program was stopped.
    assert_eq!(found.file, Fate::Same, "stop {stop}: {found:?}");
    assert_eq!(found.unsaved == 0, saved == edits, "stop {stop}: {found:?}, {saved} of {edits} saved");
    Found { edits, saved }
}
