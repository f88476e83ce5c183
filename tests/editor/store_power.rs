//! Power cuts: a real file system of its own is stopped as if the machine had lost power, mounted again, and looked at.

use crate::journal_writer::{Writer, check_at, nanoseconds};
use crate::mounted::{Mounted, may_mount, said};
use crate::program::Folder;
use dragonfly_kit::random::{Random, seed};
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, SystemTime};

/// Cuts the power of file systems: `EXT4_IOC_SHUTDOWN` on a folder in one, with flag 1 (what its own journal holds is
/// still written) or 2 (nothing is written any more). It waits beside the test, so that a cut takes no time to begin.
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
        cutter.hears("ready").then_some(cutter)
    }

    fn hears(&mut self, word: &str) -> bool {
        let mut line = String::new();
        self.answers.read_line(&mut line).is_ok() && line.trim() == word
    }

    fn cut(&mut self, disk: &Mounted, flag: u32) -> bool {
        writeln!(self.orders, "{flag} {}", disk.path().display()).is_ok() && self.hears("cut")
    }
}

impl Drop for Cutter {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn a_power_cut_tears_nothing_and_costs_no_save_and_at_most_a_second_of_edits() {
    if !may_mount("power cuts") {
        return;
    }
    let long = std::env::var_os("DRAGONFLY_LONG").is_some();
    let cuts = if long { 500 } else { 40 };
    let seed = seed(0x6375_7473);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let folder = Folder::new("power");
    let image = folder.join("disk.img");
    fs::File::create(&image).unwrap().set_len(64 << 20).unwrap();
    if !said(Command::new("mkfs.ext4").args(["-q", "-F"]).arg(&image)) {
        return println!("skipped: no ext4 can be made");
    }
    let Some(mut cutter) = Cutter::start() else { return println!("skipped: no python3") };
    let (mut recovered, mut lost, mut saves) = (0, 0, 0);
    let (mut longest, mut late) = (0, 0);
    for cut in 0..cuts {
        let Some(disk) = Mounted::image(&folder.join("disk"), &image) else {
            assert_eq!(cut, 0, "the file system cannot be mounted any more");
            return println!("skipped: no image can be mounted");
        };
        let mut writer = Writer::start(disk.path());
        writer.working();
        std::thread::park_timeout(Duration::from_micros(random.below(400_000) as u64));
        // What is said to be done later is said without power.
        let began = nanoseconds(SystemTime::now());
        let flag = 1 + random.below(2) as u32;
        let is_cut = cutter.cut(&disk, flag);
        let said = writer.kill_and_believe(began);
        drop(disk);
        if !is_cut {
            return println!("skipped: the power of this file system cannot be cut");
        }
        let disk = Mounted::image(&folder.join("disk"), &image).expect("it can be mounted after a cut");
        let found = check_at(disk.path(), &said, cut);
        drop(disk);
        let place = format!(
            "cut {cut} with flag {flag}: {found:?}, said {} edits, {} on the disk, {} saved; {:?}",
            said.edits, said.synced, said.saved, said.complaint
        );
        assert!(found.edits >= said.synced, "{place}");
        assert!(found.saved >= said.saved, "{place}");
        assert!(found.edits.max(said.synced) >= recovered, "{place}: what was had back once is still there");
        if let Some((_, at)) = said.times.iter().find(|(edit, _)| *edit > found.edits) {
            longest = longest.max(began - at);
        }
        lost += said.edits.saturating_sub(found.edits);
        saves += usize::from(said.saved > 0);
        late += usize::from(found.edits < said.late);
        recovered = found.edits;
    }
    let longest = Duration::from_nanos(u64::try_from(longest).expect("less than centuries"));
    println!(
        "{late} cuts in which something was said to be on the disk after the cut had begun, and was lost"
    );
    println!(
        "{cuts} cuts, {saves} with saves, {recovered} edits had back, {lost} lost, the oldest {longest:?} old"
    );
    assert!(longest <= Duration::from_secs(1), "edits of more than a second were lost: {longest:?}");
    assert!(saves * 4 > cuts && recovered > cuts as u32, "it hardly came to save anything");
}
