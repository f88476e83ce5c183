//! The main thread: replays the drag at its intended times, asks questions, and measures how long each call blocks it.

use super::document::SharedDocument;
use super::frame::PoseQuestion;
use super::ledger::{Ledger, MOST_WAITING};
use super::script::{SHOWN, Script};
use super::sharing::Sharing;
use crate::Distribution;
use dragonfly_runtime::{Captured, Next, ThreadHandle};
use std::time::{Duration, Instant};

/// Rate of the edits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rate {
    /// No edits.
    Still,
    /// At their times in the script, with this interval, however long the previous calls took.
    Every(Duration),
    /// Each edit as soon as the previous call has returned.
    FlatOut,
}

impl Rate {
    /// The rate of a fast mouse.
    pub const EVERY_MILLISECOND: Self = Self::Every(Duration::from_millis(1));
}

/// Measurements of the main thread.
#[derive(Default)]
pub struct EditMetrics {
    /// Times for which an edit blocked the main thread.
    pub blocked: Distribution,
    /// Times from a question to its answer.
    pub answer: Distribution,
    /// Times for which a question blocked the main thread.
    pub asking: Distribution,
    /// Edits posted per second.
    pub posted: f64,
    /// Edits per second from the first one posted to the last one shown.
    pub shown: f64,
    /// Largest number of edits that were queued.
    pub backlog: u64,
    /// Largest number of messages that were queued for the graphics thread.
    pub views: usize,
    /// CPU cores in use by all threads together.
    pub cores: f64,
}

/// Largest number of queued edits of whole takes, which are a thousand times as large.
const MOST_WAITING_TAKES: u64 = 128;

/// Number of edits between two readings of the clock, at full speed.
const CHUNK: u64 = 16;

/// The state of the main thread.
pub struct EditDriver<'a> {
    sharing: Box<dyn Sharing>,
    main: Captured,
    script: &'a Script,
    ledger: &'a Ledger,
    graphics: &'a ThreadHandle,
    question: PoseQuestion,
    /// Number of edits posted so far.
    number: u64,
    /// Newest edit of the take that is shown.
    newest_shown: u64,
    recorded_from: u64,
    began: Instant,
    most_waiting: u64,
    record: EditMetrics,
}

impl<'a> EditDriver<'a> {
    /// Returns a driver that has posted no edit.
    pub fn new(
        sharing: Box<dyn Sharing>,
        main: Captured,
        script: &'a Script,
        ledger: &'a Ledger,
        graphics: &'a ThreadHandle,
        question: PoseQuestion,
    ) -> Self {
        Self {
            sharing,
            main,
            script,
            ledger,
            graphics,
            question,
            number: 0,
            newest_shown: 0,
            recorded_from: 1,
            began: Instant::now(),
            most_waiting: if script.is_small() { MOST_WAITING } else { MOST_WAITING_TAKES },
            record: EditMetrics::default(),
        }
    }

    /// Waits until this number of frames is finished.
    pub fn wait_for_frames(&mut self, frames: u64) {
        while self.ledger.frames() < frames {
            self.rest_until(Instant::now() + Duration::from_millis(1));
        }
    }

    /// Starts the measurement; discards what was measured before.
    pub fn start_recording(&mut self) {
        self.recorded_from = self.number + 1;
        self.ledger.record_from(self.recorded_from);
        self.record = EditMetrics::default();
        self.began = Instant::now();
    }

    /// Posts edits for `length`, and asks questions at the interval `questions`. During `stall` the thread does other
    /// work.
    pub fn replay(
        &mut self,
        rate: Rate,
        length: Duration,
        questions: Option<Duration>,
        stall: Option<(Duration, Duration)>,
    ) {
        let begin = Instant::now();
        let first = self.number;
        match rate {
            Rate::FlatOut => self.flood(begin + length),
            Rate::Still => {
                let mut when = begin;
                while let Some(every) = questions
                    && when < begin + length
                {
                    self.rest_until(when);
                    self.ask();
                    when += every;
                }
            }
            Rate::Every(interval) => self.follow(begin, interval, length, questions, stall),
        }
        self.record.posted = (self.number - first) as f64 / begin.elapsed().as_secs_f64();
    }

    fn follow(
        &mut self,
        begin: Instant,
        interval: Duration,
        length: Duration,
        questions: Option<Duration>,
        stall: Option<(Duration, Duration)>,
    ) {
        let mut stall = stall;
        let mut ask_at = questions.map(|_| begin);
        let base = self.script.time(self.number + 1);
        loop {
            let number = self.number + 1;
            let intended = begin + interval.mul_f64(self.script.time(number) - base);
            if intended >= begin + length {
                return;
            }
            let edit = self.script.edit(number);
            if let Some((_, length)) = stall.take_if(|(at, _)| intended >= begin + *at) {
                // During the stall, no messages are taken from the queue either.
                let until = Instant::now() + length;
                while Instant::now() < until {
                    std::thread::park_timeout(until - Instant::now());
                }
            }
            self.rest_until(intended);
            self.ledger.intend(number, (edit.take == SHOWN).then_some(intended));
            let begins = self.script.begins(number);
            let shown = edit.take == SHOWN;
            let called = Instant::now();
            self.sharing.edit(edit, begins);
            self.record.blocked.record(called.elapsed());
            self.posted(number, shown);
            self.look_around();
            if let (Some(when), Some(every)) = (ask_at, questions)
                && Instant::now() >= when
            {
                self.ask();
                ask_at = Some(when + every);
            }
        }
    }

    fn flood(&mut self, end: Instant) {
        loop {
            let now = Instant::now();
            if now >= end {
                return;
            }
            self.look_around();
            if self.sharing.backlog(self.number, self.ledger) + CHUNK > self.most_waiting {
                // The driver waits here; without a limit the queue would fill the memory.
                self.rest_until(now + Duration::from_micros(100));
                continue;
            }
            for step in 0..CHUNK {
                let number = self.number + 1;
                let edit = self.script.edit(number);
                let (shown, begins) = (edit.take == SHOWN, self.script.begins(number));
                self.ledger.intend(number, shown.then_some(now));
                if step == 0 {
                    let called = Instant::now();
                    self.sharing.edit(edit, begins);
                    self.record.blocked.record(called.elapsed());
                } else {
                    self.sharing.edit(edit, begins);
                }
                self.posted(number, shown);
            }
            self.main.iterate();
        }
    }

    fn posted(&mut self, number: u64, shown: bool) {
        self.number = number;
        if shown {
            self.newest_shown = number;
            self.ledger.complete(number);
        }
    }

    fn look_around(&mut self) {
        self.record.backlog = self.record.backlog.max(self.sharing.backlog(self.number, self.ledger));
        self.record.views = self.record.views.max(self.graphics.queue_len());
    }

    fn ask(&mut self) {
        let begin = Instant::now();
        let asked = self.sharing.ask(self.question, &mut self.main);
        self.record.answer.record(begin.elapsed());
        self.record.asking.record(asked.blocked);
        assert!(asked.answer.pose.is_finite() && asked.answer.number <= self.number);
    }

    /// Does what an idle main thread does: delivers messages, and sleeps.
    fn rest_until(&mut self, until: Instant) {
        loop {
            let next = self.main.iterate();
            let now = Instant::now();
            if now >= until {
                return;
            }
            if next != Next::Now {
                std::thread::park_timeout(until - now);
            }
        }
    }

    /// Waits until the last edit is shown. Returns `false` if that takes too long.
    pub fn wait_until_seen(&mut self) -> bool {
        const PATIENCE: Duration = Duration::from_secs(20);
        let begin = Instant::now();
        while self.ledger.seen() < self.newest_shown {
            if begin.elapsed() > PATIENCE {
                return false;
            }
            self.rest_until(Instant::now() + Duration::from_micros(200));
        }
        let edits = self.number + 1 - self.recorded_from;
        self.record.shown = edits as f64 / self.began.elapsed().as_secs_f64();
        true
    }

    /// Returns the measurements, the number of posted edits, and the final document.
    pub fn end(mut self) -> (EditMetrics, u64, SharedDocument) {
        let document = self.sharing.document(&mut self.main);
        (self.record, self.number, document)
    }
}
