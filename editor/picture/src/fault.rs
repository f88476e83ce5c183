//! What goes wrong on a device: losses and unexpected errors, and how long to be patient.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

/// So many losses within [`PATIENCE`] are too many.
pub const MAX_LOSSES: usize = 3;
/// See [`MAX_LOSSES`].
pub const PATIENCE: Duration = Duration::from_secs(60);

/// Does the device get lost too often?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Patience {
    /// No: go on.
    Left,
    /// Yes: stop drawing what probably makes it so.
    Gone,
}

/// Where a device's callbacks, which come in any thread, leave their news for the graphics thread.
#[derive(Clone, Debug)]
pub struct Faults {
    sender: flume::Sender<String>,
    losses: flume::Receiver<String>,
    errors: Arc<AtomicU32>,
}

impl Default for Faults {
    fn default() -> Self {
        let (sender, losses) = flume::unbounded();
        Self { sender, losses, errors: Arc::default() }
    }
}

impl Faults {
    /// The same count of errors, but deaf to losses of the device before.
    pub fn successor(&self) -> Self {
        Self { errors: Arc::clone(&self.errors), ..Self::default() }
    }

    /// Sets the callbacks of a new device. Without them any error would be a panic.
    pub fn watch(&self, device: &wgpu::Device) {
        let sender = self.sender.clone();
        device.set_device_lost_callback(move |reason, message| {
            let _ = sender.send(format!("{reason:?}: {message}"));
        });
        let errors = Arc::clone(&self.errors);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            errors.fetch_add(1, Ordering::Relaxed);
            tracing::error!(%error, "unexpected graphics error");
        }));
    }

    /// Notes a loss that the driver did not report.
    pub fn report_loss(&self, reason: &str) {
        let _ = self.sender.send(reason.to_owned());
    }

    /// Why the device was lost, if it was.
    pub fn take_loss(&self) -> Option<String> {
        self.losses.drain().next()
    }

    /// Unexpected errors since the first device.
    pub fn errors(&self) -> u32 {
        self.errors.load(Ordering::Relaxed)
    }
}

/// When devices were lost.
#[derive(Debug, Default)]
pub struct LossRecord {
    total: u32,
    expected: u32,
    recent: VecDeque<Instant>,
}

impl LossRecord {
    /// The next loss is on purpose.
    pub fn expect_one(&mut self) {
        self.expected = 1;
    }

    /// Notes a loss.
    pub fn note(&mut self, now: Instant) -> Patience {
        self.total = self.total.saturating_add(1);
        if std::mem::take(&mut self.expected) > 0 {
            return Patience::Left;
        }
        while self.recent.front().is_some_and(|&then| now.saturating_duration_since(then) > PATIENCE) {
            self.recent.pop_front();
        }
        self.recent.push_back(now);
        if self.recent.len() >= MAX_LOSSES { Patience::Gone } else { Patience::Left }
    }

    /// Begins to count anew.
    pub fn forgive(&mut self) {
        self.recent.clear();
    }

    /// Since the start, on purpose or not.
    pub fn total(&self) -> u32 {
        self.total
    }
}
