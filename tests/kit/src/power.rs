//! Power cuts: a real file system is stopped as if the machine had lost power, mounted again, and checked.

use crate::folder::{Folder, takes_long};
use crate::mounted::{Mounted, may_mount, succeeds};
use crate::random::{Random, seed};
use crate::skip::{TestNeed, skip};
use crate::writer::{Found, Writer, WriterReport, nanoseconds};
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, SystemTime};

/// Script that cuts the power of file systems: `EXT4_IOC_SHUTDOWN` on a folder in one, with flag 1 (the file system's
/// own journal is still written) or 2 (nothing is written any more). It runs while the test works, so that a cut
/// starts without delay.
const CUTTER: &str = r"
import fcntl, os, struct, sys
print('ready', flush=True)
for line in sys.stdin:
    flag, path = line.rstrip('\n').split(' ', 1)
    folder = os.open(path, os.O_RDONLY)
    fcntl.ioctl(folder, 0x8004587d, struct.pack('I', int(flag)))
    os.close(folder)
    print('cut', flush=True)
";

struct Cutter {
    child: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Cutter {
    fn start() -> Option<Self> {
        let mut command = Command::new("python3");
        command.args(["-c", CUTTER]).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().inspect_err(|error| println!("python3: {error}")).ok()?;
        let orders = child.stdin.take()?;
        let answers = BufReader::new(child.stdout.take()?);
        let mut cutter = Self { child, orders, answers };
        cutter.reads_answer("ready").then_some(cutter)
    }

    fn reads_answer(&mut self, word: &str) -> bool {
        let mut line = String::new();
        self.answers.read_line(&mut line).is_ok() && line.trim() == word
    }

    fn cut(&mut self, disk: &Mounted, flag: u32) -> bool {
        writeln!(self.orders, "{flag} {}", disk.path().display()).is_ok() && self.reads_answer("cut")
    }
}

impl Drop for Cutter {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The outcome of a number of power cuts.
#[derive(Debug, Default)]
pub struct Cuts {
    /// Number of cuts made.
    pub cuts: usize,
    /// Number of cuts before which at least one save was reported.
    pub with_saves: usize,
    /// Number of edits in the journal after the last cut.
    pub edits: u32,
    /// Number of edits in the saved file after the last cut.
    pub saves: u32,
    /// Number of edits reported as done that were lost.
    pub lost: u32,
    /// Age of the oldest edit that was lost, in nanoseconds.
    pub oldest: u128,
    /// Number of cuts in which an edit was reported as synced after the cut had begun, and was lost.
    pub late: usize,
}

/// Cuts the power `cuts` times while a program works on the disk; skips the test where that is not possible.
pub fn cut(
    name: &str,
    cuts: usize,
    work: fn(&Path) -> Writer,
    look: fn(&Path, &WriterReport, usize) -> Found,
) -> Option<Cuts> {
    if !may_mount(name) {
        return None;
    }
    let seed = seed(0x6375_7473);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let folder = Folder::new(name);
    let image = folder.join("disk.img");
    fs::File::create(&image).unwrap().set_len(64 << 20).unwrap();
    if !succeeds(Command::new("mkfs.ext4").args(["-q", "-F"]).arg(&image)) {
        skip(TestNeed::FileSystem, "no ext4 can be made");
        return None;
    }
    let Some(mut cutter) = Cutter::start() else {
        skip(TestNeed::Program, "there is no python3");
        return None;
    };
    let mut all = Cuts { cuts, ..Cuts::default() };
    for cut in 0..cuts {
        let Some(disk) = Mounted::image(&folder.join("disk"), &image) else {
            assert_eq!(cut, 0, "the file system cannot be mounted any more");
            return None;
        };
        let mut writer = work(disk.path());
        writer.working();
        std::thread::park_timeout(Duration::from_micros(random.below(400_000) as u64));
        // Reports from here on may be made without power: a call in progress may still succeed.
        let began = nanoseconds(SystemTime::now());
        let flag = 1 + random.below(2) as u32;
        let is_cut = cutter.cut(&disk, flag);
        let said = writer.kill_and_read_until(began);
        drop(disk);
        if !is_cut {
            skip(TestNeed::FileSystem, "the power of this file system cannot be cut");
            return None;
        }
        let disk = Mounted::image(&folder.join("disk"), &image).expect("it can be mounted after a cut");
        let found = look(disk.path(), &said, cut);
        drop(disk);
        let place = format!(
            "cut {cut} with flag {flag}: {found:?}, said {} edits, {} on the disk, {} saved; {:?}",
            said.edits, said.synced, said.saved, said.complaint
        );
        assert!(found.edits >= said.synced, "{place}");
        assert!(found.saved >= said.saved, "{place}");
        let more = found.edits >= all.edits && found.saved >= all.saves;
        assert!(more, "{place}: an edit that was recovered before is gone");
        if let Some((_, at)) = said.times.iter().find(|(edit, _)| *edit > found.edits) {
            all.oldest = all.oldest.max(began - at);
        }
        all.lost += said.edits.saturating_sub(found.edits);
        all.with_saves += usize::from(said.saved > 0);
        all.late += usize::from(found.edits.max(found.saved) < said.late);
        (all.edits, all.saves) = (found.edits, found.saved);
    }
    println!("{name}: {all:?}");
    Some(all)
}

/// Repeats timing-dependent cuts up to three times until `holds`, because a busy machine may delay the program. What
/// must always hold was asserted at each cut.
pub fn once_in_three(cuts: impl Fn() -> Option<Cuts>, otherwise: &str, holds: impl Fn(&Cuts) -> bool) {
    let mut seen = Vec::new();
    for _ in 0..3 {
        let Some(all) = cuts() else { return };
        if holds(&all) {
            return;
        }
        seen.push(all);
    }
    panic!("{otherwise}: {seen:?}");
}

/// Returns the number of cuts: `few`, or 500 for long runs.
pub fn times(few: usize) -> usize {
    if takes_long() { 500 } else { few }
}
