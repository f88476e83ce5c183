//! Time of `dragonfly convert` for a thousand clips, and how much of the processor it uses: in files in memory, and on the
//! disk, where every file is flushed before it counts as converted, while others are converted.

use dragonfly_kit::figures::FigureBench;
use dragonfly_kit::folder::Folder;
use std::fmt::Write as _;
use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

const CLIPS: usize = 1_000;
/// Different clips; the others are further names of the same files.
const DIFFERENT: usize = 10;
const JOINTS: usize = 30;
const FRAMES: usize = 1_200;
/// Seconds of processor time in a unit of `/proc`: the kernel always uses 100 units there.
const TICK: f64 = 0.01;
/// Largest share of the processor's cores that may be idle while files are converted.
const IDLE: f64 = 0.1;

/// Returns a clip of 20 seconds of a chain of joints.
fn clip(number: usize) -> String {
    let mut text = "HIERARCHY\n".to_owned();
    for joint in 0..JOINTS {
        let (kind, channels) = match joint {
            0 => ("ROOT", "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"),
            _ => ("JOINT", "3 Zrotation Xrotation Yrotation"),
        };
        let _ = write!(text, "{kind} joint{joint}\n{{\nOFFSET 0.0 6.5 0.25\nCHANNELS {channels}\n");
    }
    text += "End Site\n{\nOFFSET 0.0 5.0 0.0\n}\n";
    text += &"}\n".repeat(JOINTS);
    let _ = write!(text, "MOTION\nFrames: {FRAMES}\nFrame Time: 0.0166667\n");
    for frame in 0..FRAMES {
        for value in 0..3 * (JOINTS + 1) {
            let angle = (frame as f64 * 0.02 + (value * 7 + number) as f64).sin() * 25.0;
            let _ = write!(text, "{angle:.4} ");
        }
        text.push('\n');
    }
    text
}

fn write_clips(folder: &Path) {
    fs::create_dir_all(folder).expect("a folder of this bench");
    for number in 0..CLIPS {
        let path = folder.join(format!("clip{number:04}.bvh"));
        if number < DIFFERENT {
            fs::write(path, clip(number)).expect("a folder of this bench");
        } else {
            let same = folder.join(format!("clip{:04}.bvh", number % DIFFERENT));
            fs::hard_link(same, path).expect("a folder of this bench");
        }
    }
}

/// Returns the processor time of child processes that have ended, seconds; `None` on systems other than Linux.
fn child_time() -> Option<f64> {
    let text = fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program is in parentheses and may contain anything.
    let fields = text.rsplit_once(')')?.1;
    let numbers: Vec<&str> = fields.split_whitespace().collect();
    let number = |at: usize| numbers.get(at)?.parse::<f64>().ok();
    Some((number(13)? + number(14)?) * TICK)
}

fn measure(bench: &mut FigureBench, variant: &str, folder: &Folder) {
    write_clips(&folder.join("in"));
    let (before, begin) = (child_time(), Instant::now());
    let done = Command::new(env!("CARGO_BIN_EXE_dragonfly"))
        .args(["convert", "in", "-o", "out", "--to", "glb"])
        .current_dir(folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    let seconds = begin.elapsed().as_secs_f64();
    assert!(done.is_ok_and(|status| status.success()), "the clips are converted");
    bench.value("clips", variant, "time", "ms", seconds * 1e3);
    if let (Some(before), Some(after)) = (before, child_time()) {
        let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        bench.value("clips", variant, "idle", "share", 1.0 - (after - before) / seconds / cores as f64);
        bench.goal("clips", variant, "idle", "share", IDLE);
    }
}

/// Measures all conversions.
pub(crate) fn all(bench: &mut FigureBench) {
    if Path::new("/dev/shm").is_dir() {
        measure(bench, "in memory", &Folder::new("/dev/shm/dragonfly-bench-convert"));
    }
    measure(bench, "on the disk", &Folder::new("bench-convert"));
}
