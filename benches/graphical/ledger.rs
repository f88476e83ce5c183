//! What the threads tell the measurement: when edits were meant to happen, how far each thread has come, and what a
//! frame may be held to. All of it by atomics that nobody waits for.

use crate::Distribution;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Edits that may be on their way at once; more would overwrite the times of older ones.
pub const MOST_WAITING: u64 = 1 << 16;

/// Shared by all threads of one run.
pub struct Ledger {
    begin: Instant,
    /// When edit `n` was meant to happen, at `n` modulo the length: nanoseconds since the begin.
    intended: Box<[AtomicU64]>,
    completed: AtomicU64,
    published: AtomicU64,
    applied: AtomicU64,
    seen: AtomicU64,
    frames: AtomicU64,
    recorded_from: AtomicU64,
    recording: AtomicBool,
}

impl Ledger {
    /// For edits that are to be remembered `waiting` at a time.
    pub fn new(waiting: u64) -> Self {
        let intended = (0..waiting.next_power_of_two() * 2).map(|_| AtomicU64::new(0)).collect();
        let [completed, published, applied, seen, frames, recorded_from] = [0; 6].map(AtomicU64::new);
        let recording = AtomicBool::new(false);
        let begin = Instant::now();
        Self { begin, intended, completed, published, applied, seen, frames, recorded_from, recording }
    }

    /// Edit `number` is to happen at `when`, whether it will or not; `None` for one that no frame shows.
    pub fn intend(&self, number: u64, when: Option<Instant>) {
        let since = when.map_or(0, |when| when.saturating_duration_since(self.begin).as_nanos() as u64);
        self.intended[number as usize & (self.intended.len() - 1)].store(since, Ordering::Relaxed);
    }

    /// The call that made edit `number` of the shown take has returned.
    pub fn complete(&self, number: u64) {
        self.completed.store(number, Ordering::SeqCst);
    }

    /// See [`complete`](Self::complete).
    pub fn completed(&self) -> u64 {
        self.completed.load(Ordering::SeqCst)
    }

    /// A view with edit `number` of the shown take was sent to those who draw it.
    pub fn publish(&self, number: u64) {
        self.published.store(number, Ordering::SeqCst);
    }

    /// See [`publish`](Self::publish).
    pub fn published(&self) -> u64 {
        self.published.load(Ordering::SeqCst)
    }

    /// The owner of the document has made edit `number`.
    pub fn apply(&self, number: u64) {
        self.applied.store(number, Ordering::Relaxed);
    }

    /// See [`apply`](Self::apply).
    pub fn applied(&self) -> u64 {
        self.applied.load(Ordering::Relaxed)
    }

    /// Edit `number` was the newest in a frame that is finished.
    pub fn see(&self, number: u64) {
        self.seen.store(number, Ordering::SeqCst);
        self.frames.fetch_add(1, Ordering::SeqCst);
    }

    /// How many frames are finished.
    pub fn frames(&self) -> u64 {
        self.frames.load(Ordering::SeqCst)
    }

    /// See [`see`](Self::see).
    pub fn seen(&self) -> u64 {
        self.seen.load(Ordering::SeqCst)
    }

    /// The warm-up is over: edits from `number` on count, and frames from now on.
    pub fn record_from(&self, number: u64) {
        self.recorded_from.store(number, Ordering::SeqCst);
        self.recording.store(true, Ordering::SeqCst);
    }

    /// What is measured is over; frames are still looked at, but not timed.
    pub fn end(&self) {
        self.recording.store(false, Ordering::SeqCst);
    }

    /// Do frames count now?
    pub fn is_recording(&self) -> bool {
        self.recording.load(Ordering::SeqCst)
    }

    /// How long ago the edits after `last` up to `newest` were meant to happen, as of `now`, which is when they are seen.
    pub fn record_visible(&self, last: u64, newest: u64, now: Instant, visible: &mut Distribution) {
        /// Of a flood only so many are looked at a frame, the oldest among them.
        const MOST: u64 = 256;
        let from = self.recorded_from.load(Ordering::SeqCst);
        let first = (last + 1).max(from);
        if from == 0 || first > newest {
            return;
        }
        let now = now.saturating_duration_since(self.begin).as_nanos() as u64;
        let step = (newest - first) / MOST + 1;
        for number in (first..=newest).step_by(step as usize) {
            let intended = self.intended[number as usize & (self.intended.len() - 1)].load(Ordering::Relaxed);
            if intended != 0 {
                visible.record(Duration::from_nanos(now.saturating_sub(intended)));
            }
        }
    }
}
