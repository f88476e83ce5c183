//! One run: a main thread that replays the drag, a graphics thread that renders frames, one method of sharing between
//! them, and disturbances.

use super::document::SharedDocument;
use super::driver::{EditDriver, EditMetrics, Rate};
use super::frame::{FrameWork, PoseQuestion};
use super::graphics::{self, FrameMetrics, Pace};
use super::ledger::{Ledger, MOST_WAITING};
use super::model::ModelSize;
use super::script::{Edits, Script};
use super::sharing::{SharingMethod, SharingStart};
use crate::{Distribution, RunValues};
use dragonfly_kit::counting;
use dragonfly_kit::load::CpuLoad;
use dragonfly_runtime::Thread;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The initial document, and the number of draws in a frame on this machine.
pub struct ScenarioSetup {
    /// Size of the document.
    pub size: ModelSize,
    /// The initial document. Never changed: every run starts with a shallow copy.
    pub document: SharedDocument,
    /// Number of times that the mesh is drawn in a frame.
    pub draws: u32,
}

impl ScenarioSetup {
    /// Returns a setup with a document of `size`.
    pub fn new(size: ModelSize, draws: u32) -> Self {
        Self { size, document: size.document(), draws }
    }
}

/// Description of a run.
#[derive(Clone, Copy, Debug)]
pub struct Scenario {
    /// The edits of the main thread.
    pub edits: Edits,
    /// The rate of the edits.
    pub rate: Rate,
    /// Time from one frame to the next; `None` for as fast as possible.
    pub period: Option<Duration>,
    /// Duration of the measurement.
    pub length: Duration,
    /// Duration of the warm-up before it.
    pub warm_up: Duration,
    /// Delay of the graphics thread by the simulated GPU driver: time and duration.
    pub graphics_stall: Option<(Duration, Duration)>,
    /// Other work of the main thread: time and duration.
    pub main_stall: Option<(Duration, Duration)>,
    /// Number of threads that compute all the time.
    pub busy: usize,
    /// Interval of the main thread's questions.
    pub questions: Option<Duration>,
    /// For tests: checks every bone in every frame, and compares the document with that of a single thread.
    pub thorough: bool,
}

/// Errors found in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunDefects {
    /// Number of checks that found half an edit.
    pub torn: u64,
    /// Number of frames that showed an older document than guaranteed.
    pub stale: u64,
    /// Whether the last edit was never shown.
    pub lost: bool,
    /// Whether the document differs from the result of the same edits in sequence.
    pub wrong: bool,
}

/// Runs `scenario` with `method` and records the measurements. Returns the errors found.
pub fn run(
    bed: &ScenarioSetup,
    method: &SharingMethod,
    scenario: &Scenario,
    measured: &mut RunValues,
) -> RunDefects {
    let flood = scenario.rate == Rate::FlatOut;
    let ledger = Arc::new(Ledger::new(if flood { MOST_WAITING } else { 1 << 13 }));
    let (memory, (record, frames, verdict)) =
        counting::process_peak(|| run_counted(bed, method, scenario, &ledger));
    write(scenario, &record, &frames, memory, measured);
    verdict
}

fn run_counted(
    bed: &ScenarioSetup,
    method: &SharingMethod,
    scenario: &Scenario,
    ledger: &Arc<Ledger>,
) -> (EditMetrics, FrameMetrics, RunDefects) {
    let script = Script::new(bed.size, scenario.edits, &bed.document);
    let me = std::thread::current();
    let mut main = Thread::capture("main", move || me.unpark());
    let graphics = Thread::start("graphics").expect("the system has a thread left");
    let document = bed.document.clone();
    let start = SharingStart { document, graphics: graphics.handle(), main: &mut main, ledger };
    let started = (method.start)(start);
    let pace = Pace {
        period: scenario.period,
        draws: bed.draws,
        thorough: scenario.thorough,
        stall: scenario.graphics_stall,
    };
    let skeleton = Arc::clone(&bed.document.skeleton);
    let frame = move || FrameWork::new(skeleton, pace.draws, pace.thorough);
    let done = graphics::register(&graphics, started.viewing, frame, pace, ledger);
    let busy: Vec<Thread> = (0..scenario.busy).map(|_| graphics::busy()).collect();

    let question = PoseQuestion { bone: bed.size.bones / 2, time: 0.5 };
    let mut hand = EditDriver::new(started.sharing, main, &script, ledger, graphics.handle(), question);
    hand.wait_for_frames(2);
    let slow = if scenario.rate == Rate::FlatOut { Rate::EVERY_MILLISECOND } else { scenario.rate };
    hand.replay(slow, scenario.warm_up, None, None);
    hand.start_recording();
    let (load, begin) = (CpuLoad::now(), Instant::now());
    hand.replay(scenario.rate, scenario.length, scenario.questions, scenario.main_stall);
    let lost = !hand.wait_until_seen();
    ledger.end();
    let cores = load.own_since().as_secs_f64() / begin.elapsed().as_secs_f64();

    let (mut record, last, document) = hand.end();
    record.cores = cores;
    drop(busy);
    drop(graphics);
    let frames = done.recv().expect("the graphics thread has ended");
    let expected = || {
        let (mut document, originals) = (bed.document.clone(), bed.document.originals());
        (1..=last).for_each(|number| drop(document.apply(script.edit(number).prepare(&originals))));
        document
    };
    let wrong = scenario.thorough && document != expected();
    let verdict = RunDefects { torn: frames.torn, stale: frames.stale, lost, wrong };
    (record, frames, verdict)
}

fn write(
    scenario: &Scenario,
    record: &EditMetrics,
    frames: &FrameMetrics,
    memory: u64,
    measured: &mut RunValues,
) {
    let mut distribution = |name: &str, durations: &Distribution| {
        if durations.count() > 0 {
            measured.distribution(name, durations);
        }
    };
    distribution("blocked", &record.blocked);
    distribution("frame", &frames.time);
    distribution("jitter", &frames.jitter);
    distribution("visible", &frames.visible);
    distribution("answer", &record.answer);
    distribution("asking", &record.asking);
    if scenario.period.is_some() {
        measured.value("missed", "count", frames.missed as f64);
    }
    measured.value("posted", "1/s", record.posted);
    measured.value("shown", "1/s", record.shown);
    measured.value("backlog", "count", record.backlog as f64);
    measured.value("waiting_views", "count", record.views as f64);
    measured.value("memory", "bytes", memory as f64);
    measured.value("cores", "cores", record.cores);
}
