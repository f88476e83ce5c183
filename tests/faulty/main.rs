//! The program with injected faults, for tests that run it in a process of its own. It takes the command line of
//! `dragonfly` and these switches before it:
//!
//! ```text
//! --edits FILE                apply these edits once the model is open, one JSON object per line
//! --fail-at CHANGES           panic in the document thread at this change
//! --fail PLACE:STEPS:TIMES    panic in panels, input, message or frame, after STEPS steps, TIMES times
//! --lose-device FRAMES        lose the graphics device again and again, at least this number of frames apart
//! --never-pause               keep drawing however often the device is lost
//! ```

#![forbid(unsafe_code)]

use dragonfly::app::Options;
use dragonfly_document::{FaultInjection, FaultPlan, FaultPoint};
use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Shortest time between two losses of the device.
const BETWEEN_LOSSES: Duration = Duration::from_millis(250);

/// Part of the program in which `--fail` panics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FailTarget {
    Panels,
    Input,
    Message,
    Frame,
}

/// The faults requested on the command line.
#[derive(Debug, Default)]
struct Switches {
    /// Number of changes until the document fails; 0 for never.
    changes: AtomicU32,
    target: Option<FailTarget>,
    steps: usize,
    times: AtomicU32,
    /// Number of steps done in the document, as the main thread reported it last.
    done: AtomicUsize,
    /// Number of frames between two losses of the device.
    frames: Option<u64>,
    lost_at: AtomicU64,
    lost: Mutex<Option<Instant>>,
    never_pauses: AtomicBool,
}

/// Subtracts 1 from `counter` and returns its value before; `None` when it is already 0.
fn count_down(counter: &AtomicU32) -> Option<u32> {
    counter.fetch_update(Relaxed, Relaxed, |left| left.checked_sub(1)).ok()
}

impl FaultPlan for Switches {
    fn reach(&self, point: FaultPoint) {
        let place = match point {
            FaultPoint::Change => {
                assert!(count_down(&self.changes) != Some(1), "injected fault");
                return;
            }
            FaultPoint::PrepareSave | FaultPoint::WriteSave | FaultPoint::CopiedFile(_) => return,
            FaultPoint::GraphicsMessage => FailTarget::Message,
            FaultPoint::Frame => FailTarget::Frame,
            FaultPoint::Panels(done) => {
                self.done.store(done, Relaxed);
                FailTarget::Panels
            }
            FaultPoint::Input(done) => {
                self.done.store(done, Relaxed);
                FailTarget::Input
            }
        };
        let fails = self.target == Some(place)
            && self.done.load(Relaxed) >= self.steps
            && count_down(&self.times).is_some();
        assert!(!fails, "injected fault");
    }

    fn loses_device(&self, frames: u64, moves: bool) -> bool {
        // Only while something moves: otherwise each loss would draw the frame that causes the next one.
        let Some(every) = self.frames.filter(|_| moves) else { return false };
        let mut lost = self.lost.lock().expect("no holder panics");
        let loses = frames.saturating_sub(self.lost_at.load(Relaxed)) >= every
            && lost.is_none_or(|then| then.elapsed() >= BETWEEN_LOSSES);
        if loses {
            *lost = Some(Instant::now());
            self.lost_at.store(frames, Relaxed);
        }
        loses
    }

    fn pauses(&self) -> bool {
        !self.never_pauses.load(Relaxed)
    }
}

impl Switches {
    fn set_fail(&mut self, text: &str) {
        let parts: Vec<&str> = text.split(':').collect();
        let [place, steps, times] = parts[..] else { panic!("{text}: PLACE:STEPS:TIMES is expected") };
        self.target = Some(match place {
            "panels" => FailTarget::Panels,
            "input" => FailTarget::Input,
            "message" => FailTarget::Message,
            "frame" => FailTarget::Frame,
            other => panic!("{other}: unknown place"),
        });
        self.steps = number(steps);
        *self.times.get_mut() = number(times);
    }
}

#[track_caller]
fn number<T: std::str::FromStr>(text: &str) -> T {
    text.parse().unwrap_or_else(|_| panic!("{text}: a number is expected"))
}

fn main() -> ExitCode {
    let mut arguments = std::env::args_os();
    let mut rest: Vec<OsString> = arguments.by_ref().take(1).collect();
    let mut switches = Switches::default();
    let mut options = Options::default();
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().and_then(|value| value.into_string().ok()).expect("a value");
        match argument.to_str() {
            Some("--edits") => {
                let text = std::fs::read_to_string(value()).expect("a file with edits");
                let edits = text.lines().map(|line| serde_json::from_str(line).expect("an edit"));
                options.edits = edits.collect();
            }
            Some("--fail-at") => *switches.changes.get_mut() = number(&value()),
            Some("--fail") => switches.set_fail(&value()),
            Some("--lose-device") => switches.frames = Some(number(&value())),
            Some("--never-pause") => *switches.never_pauses.get_mut() = true,
            _ => rest.push(argument),
        }
    }
    options.faults = FaultInjection::new(Arc::new(switches));
    dragonfly::command::main_with(rest, options)
}
