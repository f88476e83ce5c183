//! Reports of a device: losses and unexpected errors, and how many losses are tolerated.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

/// Number of losses within [`PATIENCE`] that are too many.
pub const MAX_LOSSES: usize = 3;
/// Period in which losses are counted; see [`MAX_LOSSES`].
pub const PATIENCE: Duration = Duration::from_secs(60);

/// Whether the device is lost too often.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LossTolerance {
    /// Not too often: drawing continues.
    Left,
    /// Too often: what probably causes it is no longer drawn.
    Gone,
}

/// Channel from the callbacks of a device, which run in any thread, to the graphics thread.
#[derive(Clone, Debug)]
pub struct DeviceReports {
    sender: flume::Sender<String>,
    losses: flume::Receiver<String>,
    errors: Arc<AtomicU32>,
}

impl Default for DeviceReports {
    fn default() -> Self {
        let (sender, losses) = flume::unbounded();
        Self { sender, losses, errors: Arc::default() }
    }
}

impl DeviceReports {
    /// Returns a channel for the next device: the same error count, without reports of losses of the old device.
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

    /// Reports a loss that the driver did not report.
    pub fn report_loss(&self, reason: &str) {
        let _ = self.sender.send(reason.to_owned());
    }

    /// Returns the reason of the loss, if the device was lost.
    pub fn take_loss(&self) -> Option<String> {
        self.losses.drain().next()
    }

    /// Number of unexpected errors since the first device.
    pub fn errors(&self) -> u32 {
        self.errors.load(Ordering::Relaxed)
    }
}

/// The losses of the device.
#[derive(Debug, Default)]
pub struct LossRecord {
    total: u32,
    expected: u32,
    recent: VecDeque<Instant>,
}

impl LossRecord {
    /// Marks the next loss as deliberate.
    pub fn expect_one(&mut self) {
        self.expected = 1;
    }

    /// Counts a loss.
    pub fn note(&mut self, now: Instant) -> LossTolerance {
        self.total = self.total.saturating_add(1);
        if std::mem::take(&mut self.expected) > 0 {
            return LossTolerance::Left;
        }
        while self.recent.front().is_some_and(|&then| now.saturating_duration_since(then) > PATIENCE) {
            self.recent.pop_front();
        }
        self.recent.push_back(now);
        if self.recent.len() >= MAX_LOSSES { LossTolerance::Gone } else { LossTolerance::Left }
    }

    /// Restarts the count.
    pub fn forgive(&mut self) {
        self.recent.clear();
    }

    /// Number of losses since the start, deliberate ones included.
    pub fn total(&self) -> u32 {
        self.total
    }
}
