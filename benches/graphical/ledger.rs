//! Shared measurement data of the threads: intended times of edits, the progress of each thread, and which edit a frame
//! must show. Atomics only, so no thread waits.

use crate::Distribution;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Largest number of edits in progress; more would overwrite the times of older ones.
pub const MOST_WAITING: u64 = 1 << 16;

/// Shared by all threads of one run.
pub struct Ledger {
    begin: Instant,
    /// Intended time of edit `n`, at index `n` modulo the length: nanoseconds since the start.
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
    /// Returns a ledger for at most `waiting` edits in progress.
    pub fn new(waiting: u64) -> Self {
        let intended = (0..waiting.next_power_of_two() * 2).map(|_| AtomicU64::new(0)).collect();
        let [completed, published, applied, seen, frames, recorded_from] = [0; 6].map(AtomicU64::new);
        let recording = AtomicBool::new(false);
        let begin = Instant::now();
        Self { begin, intended, completed, published, applied, seen, frames, recorded_from, recording }
    }

    /// Records the intended time of edit `number`, before the edit is made; `None` for an edit that no frame shows.
    pub fn intend(&self, number: u64, when: Option<Instant>) {
        let since = when.map_or(0, |when| when.saturating_duration_since(self.begin).as_nanos() as u64);
        self.intended[number as usize & (self.intended.len() - 1)].store(since, Ordering::Relaxed);
    }

    /// Records that the call that made edit `number` of the shown take has returned.
    pub fn complete(&self, number: u64) {
        self.completed.store(number, Ordering::SeqCst);
    }

    /// Returns the last edit passed to [`complete`](Self::complete).
    pub fn completed(&self) -> u64 {
        self.completed.load(Ordering::SeqCst)
    }

    /// Records that a view with edit `number` of the shown take was sent to the graphics thread.
    pub fn publish(&self, number: u64) {
        self.published.store(number, Ordering::SeqCst);
    }

    /// Returns the last edit passed to [`publish`](Self::publish).
    pub fn published(&self) -> u64 {
        self.published.load(Ordering::SeqCst)
    }

    /// Records that the owner of the document has applied edit `number`.
    pub fn apply(&self, number: u64) {
        self.applied.store(number, Ordering::Relaxed);
    }

    /// Returns the last edit passed to [`apply`](Self::apply).
    pub fn applied(&self) -> u64 {
        self.applied.load(Ordering::Relaxed)
    }

    /// Records that a frame is finished whose newest edit is `number`.
    pub fn see(&self, number: u64) {
        self.seen.store(number, Ordering::SeqCst);
        self.frames.fetch_add(1, Ordering::SeqCst);
    }

    /// Returns the number of finished frames.
    pub fn frames(&self) -> u64 {
        self.frames.load(Ordering::SeqCst)
    }

    /// Returns the last edit passed to [`see`](Self::see).
    pub fn seen(&self) -> u64 {
        self.seen.load(Ordering::SeqCst)
    }

    /// Ends the warm-up: edits from `number` on are measured, and frames from now on.
    pub fn record_from(&self, number: u64) {
        self.recorded_from.store(number, Ordering::SeqCst);
        self.recording.store(true, Ordering::SeqCst);
    }

    /// Ends the measurement; frames are still checked, but not timed.
    pub fn end(&self) {
        self.recording.store(false, Ordering::SeqCst);
    }

    /// Returns whether frames are measured.
    pub fn is_recording(&self) -> bool {
        self.recording.load(Ordering::SeqCst)
    }

    /// Records the times from the intended times of the edits after `last` up to `newest` to `now`, when they became
    /// visible.
    pub fn record_visible(&self, last: u64, newest: u64, now: Instant, visible: &mut Distribution) {
        /// At full speed, at most this number of edits is recorded for a frame, including the oldest.
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
