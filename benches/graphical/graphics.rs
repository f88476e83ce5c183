//! The graphics thread: workers of the runtime, in order, as in the editor. The scene starts the frame when it is due,
//! the model is sampled and drawn, and the frame is presented; then the edit that it shows is recorded.

use super::frame::FrameWork;
use super::ledger::Ledger;
use super::sharing::{MakeViewing, Viewing};
use crate::Distribution;
use dragonfly_runtime::{Context, Thread, Worker};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

/// Measurements of the frames of one run.
#[derive(Default)]
pub struct FrameMetrics {
    /// Durations of frames, from their actual start.
    pub time: Distribution,
    /// Lateness of the start of frames. Empty where frames have no intended times.
    pub jitter: Distribution,
    /// Times from the intended time of an edit to the end of the first frame that shows it.
    pub visible: Distribution,
    /// Number of intended times at which no new frame was finished.
    pub missed: u64,
    /// Number of checks that found half an edit.
    pub torn: u64,
    /// Number of frames that showed an older document than the method guarantees.
    pub stale: u64,
}

/// Configuration of the graphics thread.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Time from one frame to the next; `None` for as fast as possible.
    pub period: Option<Duration>,
    /// Number of times that the mesh is drawn in a frame.
    pub draws: u32,
    /// Whether every bone of every frame is checked.
    pub thorough: bool,
    /// Delay of one frame by the simulated GPU driver: time after the start of the recording, and duration.
    pub stall: Option<(Duration, Duration)>,
}

/// State shared by the workers.
struct GraphicsState {
    viewing: Box<dyn Viewing>,
    frame: FrameWork,
    pace: Pace,
    ledger: Arc<Ledger>,
    begin: Instant,
    /// Start time of the next frame.
    due: Instant,
    /// Intended and actual start of the current frame.
    opened: Option<(Instant, Instant)>,
    /// Time of the first recorded frame.
    recorded: Option<Instant>,
    promised: u64,
    last: u64,
    frames: FrameMetrics,
    done: mpsc::Sender<FrameMetrics>,
}

/// Starts the frame.
struct SceneWorker(Rc<RefCell<GraphicsState>>);

impl Worker for SceneWorker {
    fn update(&mut self, thread: &mut Context) -> bool {
        let stage = &mut *self.0.borrow_mut();
        stage.promised = stage.viewing.promise(&stage.ledger);
        let now = Instant::now();
        if stage.pace.period.is_some() && now < stage.due {
            thread.wake_at(stage.due);
            return false;
        }
        if !stage.viewing.is_ready(thread) {
            return false;
        }
        let now = Instant::now();
        stage.opened = Some((stage.due, now));
        let recording = stage.ledger.is_recording();
        if recording && stage.recorded.is_none() {
            stage.recorded = Some(now);
        }
        let stall = match (stage.pace.stall, stage.recorded) {
            (Some((at, length)), Some(begin)) if now >= begin + at => {
                stage.pace.stall = None;
                length
            }
            _ => Duration::ZERO,
        };
        stage.frame.begin((now - stage.begin).as_secs_f32(), stall);
        true
    }
}

/// Samples and draws the model.
struct ModelWorker(Rc<RefCell<GraphicsState>>);

impl Worker for ModelWorker {
    fn update(&mut self, _thread: &mut Context) -> bool {
        let stage = &mut *self.0.borrow_mut();
        stage.viewing.frame(&mut stage.frame);
        true
    }
}

/// Ends the frame.
struct PresentWorker(Rc<RefCell<GraphicsState>>);

impl Worker for PresentWorker {
    fn update(&mut self, thread: &mut Context) -> bool {
        let stage = &mut *self.0.borrow_mut();
        let Some((due, began)) = stage.opened.take() else { return false };
        let now = Instant::now();
        let newest = stage.frame.seen().expect("every frame reads the document");
        stage.frames.stale += u64::from(newest < stage.promised || newest < stage.last);
        stage.frames.torn = stage.frame.torn();
        stage.ledger.record_visible(stage.last, newest, now, &mut stage.frames.visible);
        stage.last = newest;
        stage.ledger.see(newest);
        let recording = stage.ledger.is_recording();
        if recording {
            stage.frames.time.record(now - began);
        }
        if let Some(period) = stage.pace.period {
            let late = (now.saturating_duration_since(due).as_nanos() / period.as_nanos()) as u32;
            if recording {
                stage.frames.jitter.record(began.saturating_duration_since(due));
                stage.frames.missed += u64::from(late);
            }
            stage.due = due + period * (late + 1);
            thread.wake_at(stage.due);
        } else {
            stage.due = now;
            thread.iterate_again();
        }
        true
    }
}

impl Drop for GraphicsState {
    fn drop(&mut self) {
        // Fails only when the run was given up.
        let _ = self.done.send(std::mem::take(&mut self.frames));
    }
}

/// Makes `thread` render frames until it is stopped. Returns the channel on which the measurements arrive at the end.
pub fn register(
    thread: &Thread,
    viewing: MakeViewing,
    frame: impl FnOnce() -> FrameWork + Send + 'static,
    pace: Pace,
    ledger: &Arc<Ledger>,
) -> mpsc::Receiver<FrameMetrics> {
    let (done, frames) = mpsc::channel();
    let ledger = Arc::clone(ledger);
    let job = move |context: &mut Context| {
        let now = Instant::now();
        let stage = GraphicsState {
            viewing: viewing(context),
            frame: frame(),
            pace,
            ledger,
            begin: now,
            due: now,
            opened: None,
            recorded: None,
            promised: 0,
            last: 0,
            frames: FrameMetrics::default(),
            done,
        };
        let stage = Rc::new(RefCell::new(stage));
        context.register_worker(SceneWorker(Rc::clone(&stage)));
        context.register_worker(ModelWorker(Rc::clone(&stage)));
        context.register_last_worker(PresentWorker(stage));
    };
    thread.handle().run(job).expect("it was just started");
    frames
}

/// Starts a thread that computes all the time: an import, or another program.
pub fn busy() -> Thread {
    struct Computing(u64);
    impl Worker for Computing {
        fn update(&mut self, thread: &mut Context) -> bool {
            for _ in 0..100_000 {
                self.0 = std::hint::black_box(self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1));
            }
            thread.iterate_again();
            true
        }
    }
    let thread = Thread::start("import").expect("the system has a thread left");
    thread.handle().register_worker(|_| Computing(1));
    thread
}
