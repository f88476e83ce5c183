//! Fault injection: named points of the program at which a test can make it fail. The program itself runs without a plan.

use std::fmt::Debug;
use std::sync::Arc;

/// A point of the program at which a test can inject a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultPoint {
    /// The document thread, before it makes a change.
    Change,
    /// The job that prepares a save, before it computes anything.
    PrepareSave,
    /// The job that writes a save, before it writes anything.
    WriteSave,
    /// The job that writes a save, after it has copied a file into another folder; the number of files copied so far.
    CopiedFile(usize),
    /// The graphics thread, after it has handled a message.
    GraphicsMessage,
    /// The graphics thread, before it draws a frame.
    Frame,
    /// The main thread, while it draws the panels; the number of steps done in the document.
    Panels(usize),
    /// The main thread, before it handles an input; the number of steps done in the document.
    Input(usize),
}

/// The faults to inject, written by a test. Every method has a default that injects nothing.
pub trait FaultPlan: Debug + Send + Sync {
    /// Called each time a point is reached, in the thread that reaches it. A plan injects a fault by panicking,
    /// or by not returning for a while.
    fn reach(&self, _point: FaultPoint) {}

    /// Returns whether to lose the graphics device now. Called in the graphics thread with the number of frames shown
    /// so far and whether the scene is moving by itself.
    fn loses_device(&self, _frames: u64, _moves: bool) -> bool {
        false
    }

    /// Returns whether to lose the graphics device before this sub-frame of a frame that is the mean of several.
    fn loses_device_in_frame(&self, _sub_frame: u32) -> bool {
        false
    }

    /// Returns whether drawing pauses when the graphics device is lost too often.
    fn pauses(&self) -> bool {
        true
    }

    /// Returns whether the job that reads a file cannot be started, as if the system had no threads left. Called in the document thread.
    fn refuses_read(&self) -> bool {
        false
    }
}

/// The faults to inject into one run of the program; none by default.
#[derive(Clone, Debug, Default)]
pub struct FaultInjection(Option<Arc<dyn FaultPlan>>);

impl FaultInjection {
    /// Injects the faults of `plan`.
    pub fn new(plan: Arc<dyn FaultPlan>) -> Self {
        Self(Some(plan))
    }

    /// Calls [`FaultPlan::reach`].
    pub fn reach(&self, point: FaultPoint) {
        if let Some(plan) = &self.0 {
            plan.reach(point);
        }
    }

    /// Calls [`FaultPlan::loses_device`].
    pub fn loses_device(&self, frames: u64, moves: bool) -> bool {
        self.0.as_ref().is_some_and(|plan| plan.loses_device(frames, moves))
    }

    /// Calls [`FaultPlan::loses_device_in_frame`].
    pub fn loses_device_in_frame(&self, sub_frame: u32) -> bool {
        self.0.as_ref().is_some_and(|plan| plan.loses_device_in_frame(sub_frame))
    }

    /// Calls [`FaultPlan::pauses`].
    pub fn pauses(&self) -> bool {
        self.0.as_ref().is_none_or(|plan| plan.pauses())
    }

    /// Calls [`FaultPlan::refuses_read`].
    pub fn refuses_read(&self) -> bool {
        self.0.as_ref().is_some_and(|plan| plan.refuses_read())
    }
}
