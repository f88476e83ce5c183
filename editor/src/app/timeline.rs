//! The order in which the program comes and goes (thesis §3.2.4.6), written down once, traced and checked.

/// A step of the program's life, in its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// The main function has begun.
    MainFunction,
    /// The main window is there, the main thread is captured, the custom run-time is prepared.
    MainRuntime,
    /// The second thread is there.
    Graphics,
    /// In the second thread, the device is there.
    GraphicsInitialisation,
    /// The custom run-time hears of it.
    EditorRuntime,
    /// It has what it needs and opens the model.
    EditorRuntimeInitialisation,
    /// Everything works.
    RunTime,
    /// Input is off; the custom run-time has given back what it took.
    EditorRuntimeDestruction,
    /// Scene, device and second thread are gone.
    GraphicsDestruction,
    /// The window is gone.
    MainRuntimeDestruction,
    /// The main function ends.
    MainFunctionEnd,
}

impl Step {
    /// All of them, in their order.
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

    /// The thesis's number, 1 … 11.
    pub fn number(self) -> usize {
        self as usize + 1
    }

    /// In words, for the trace.
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

/// Keeps the order. A start that fails leaves steps out, but never changes their order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Timeline {
    reached: Vec<Step>,
}

impl Timeline {
    /// Says that `step` is reached.
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

    /// What was reached, in order.
    pub fn reached(&self) -> &[Step] {
        &self.reached
    }
}
