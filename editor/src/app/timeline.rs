//! The order in which the parts of the program start and end (thesis §3.2.4.6), defined once, traced and checked.

/// A step of the program's life, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// The main function has started.
    MainFunction,
    /// The main window exists, the main thread is captured, the custom run-time is prepared.
    MainRuntime,
    /// The graphics thread runs.
    Graphics,
    /// The graphics thread has created its device.
    GraphicsInitialisation,
    /// The custom run-time has been created, because the device exists.
    EditorRuntime,
    /// The custom run-time has received its parts and opens the model.
    EditorRuntimeInitialisation,
    /// All parts run.
    RunTime,
    /// Input is off; the custom run-time has released everything.
    EditorRuntimeDestruction,
    /// Scene, device and graphics thread are gone.
    GraphicsDestruction,
    /// The window is gone.
    MainRuntimeDestruction,
    /// The main function ends.
    MainFunctionEnd,
}

impl Step {
    /// All steps in order.
    pub const ALL: &[Self] = &[
        Self::MainFunction,
        Self::MainRuntime,
        Self::Graphics,
        Self::GraphicsInitialisation,
        Self::EditorRuntime,
        Self::EditorRuntimeInitialisation,
        Self::RunTime,
        Self::EditorRuntimeDestruction,
        Self::GraphicsDestruction,
        Self::MainRuntimeDestruction,
        Self::MainFunctionEnd,
    ];

    /// Returns the thesis's number, 1 … 11.
    pub fn number(self) -> usize {
        self as usize + 1
    }

    /// Returns the name for the trace.
    pub fn name(self) -> &'static str {
        match self {
            Self::MainFunction => "main function",
            Self::MainRuntime => "main runtime",
            Self::Graphics => "graphics",
            Self::GraphicsInitialisation => "graphics initialisation",
            Self::EditorRuntime => "editor runtime",
            Self::EditorRuntimeInitialisation => "editor runtime initialisation",
            Self::RunTime => "run-time",
            Self::EditorRuntimeDestruction => "editor runtime destruction",
            Self::GraphicsDestruction => "graphics destruction",
            Self::MainRuntimeDestruction => "main runtime destruction",
            Self::MainFunctionEnd => "main function end",
        }
    }
}

/// The steps in the order in which they were reached. A start that fails skips steps, but never changes their
/// order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StepTrace {
    reached: Vec<Step>,
}

impl StepTrace {
    /// Records that `step` is reached.
    ///
    /// # Panics
    /// In debug builds, when a later step was reached before.
    pub fn reach(&mut self, step: Step) {
        tracing::info!(target: "dragonfly::timeline", step = step.number(), name = step.name());
        debug_assert!(
            self.reached.last().is_none_or(|last| *last < step),
            "{step:?} after {:?}",
            self.reached
        );
        self.reached.push(step);
    }

    /// Returns the steps that were reached, in order.
    pub fn reached(&self) -> &[Step] {
        &self.reached
    }
}
