//! One case of the bench: a task, and the variant of the code that does it.

use std::hint::black_box;
use std::time::Instant;

/// A case that is ready to run.
pub(crate) trait RunCase {
    /// Runs the case once.
    fn call(&mut self);

    /// Runs the case `calls` times. Returns the nanoseconds that all calls took.
    fn run(&mut self, calls: usize) -> f64;
}

/// Runs a closure of this program.
struct LocalCase<W>(W);

impl<W: FnMut()> RunCase for LocalCase<W> {
    fn call(&mut self) {
        (self.0)();
    }

    fn run(&mut self, calls: usize) -> f64 {
        let start = Instant::now();
        for _ in 0..calls {
            (self.0)();
        }
        start.elapsed().as_nanos() as f64
    }
}

/// A task done by one variant, and the number of units that one call handles.
pub(crate) struct BenchCase {
    /// The code that does the task: the open path, the fast path at a SIMD level, the sketch, a rival.
    pub(crate) variant: String,
    /// Task, model and case, separated by slashes; the same for all variants of the task.
    pub(crate) task: String,
    /// Cases of one group take turns while they are measured.
    pub(crate) group: String,
    pub(crate) units: usize,
    pub(crate) unit: &'static str,
    /// Number of calls when instructions are counted; large enough that entering and leaving the call does not matter.
    pub(crate) counted_calls: usize,
    setup: Box<dyn FnOnce() -> Box<dyn RunCase>>,
}

impl BenchCase {
    /// Creates a case. `setup` is called just before the case is measured. It returns the closure that handles `units`
    /// of `unit` in each call and wraps its results in [`black_box`].
    pub(crate) fn new<W: FnMut() + 'static>(
        variant: impl Into<String>,
        task: impl Into<String>,
        units: usize,
        unit: &'static str,
        setup: impl FnOnce() -> W + 'static,
    ) -> Self {
        Self::with(variant, task, units, unit, || Box::new(LocalCase(setup())))
    }

    /// As [`new`](Self::new), for a case that is not a closure of this program.
    pub(crate) fn with(
        variant: impl Into<String>,
        task: impl Into<String>,
        units: usize,
        unit: &'static str,
        setup: impl FnOnce() -> Box<dyn RunCase> + 'static,
    ) -> Self {
        let task = task.into();
        Self {
            variant: variant.into(),
            group: task.clone(),
            task,
            units,
            unit,
            counted_calls: 3,
            setup: Box::new(setup),
        }
    }

    /// Measures the case in turns with all other cases of `group`, whatever their task.
    pub(crate) fn among(self, group: impl Into<String>) -> Self {
        Self { group: group.into(), ..self }
    }

    /// Counts the instructions of one call only; for long calls, where entering and leaving does not matter.
    pub(crate) fn counted_once(self) -> Self {
        Self { counted_calls: 1, ..self }
    }

    /// Returns variant and task, separated by a slash.
    pub(crate) fn name(&self) -> String {
        format!("{}/{}", self.variant, self.task)
    }

    /// Sets the case up and runs it once.
    pub(crate) fn start(self) -> Box<dyn RunCase> {
        let mut case = (self.setup)();
        case.call();
        case
    }
}

/// Variants that others are compared with, the preferred one first: the open path only where the sketch lacks the task.
pub(crate) const BASELINES: [&str; 2] = ["sketch", "open"];

/// Returns the name of the baseline of `case` among `all`; `None` if the case is the baseline or has none.
pub(crate) fn baseline_of<'a>(
    case: &BenchCase,
    all: impl Iterator<Item = &'a BenchCase> + Clone,
) -> Option<String> {
    let has_task =
        |variant: &&str| all.clone().any(|other| other.variant == **variant && other.task == case.task);
    let variant = BASELINES.into_iter().find(has_task)?;
    (case.variant != variant).then(|| format!("{variant}/{}", case.task))
}

/// The function that the counter of instructions finds by its name: only instructions inside it are counted.
#[inline(never)]
fn counted_region(case: &mut dyn RunCase, calls: usize) {
    for _ in 0..calls {
        black_box(&mut *case).call();
    }
}

/// Runs each case inside the counted region, and prints a line for each with the number of its units.
pub(crate) fn count(cases: Vec<BenchCase>) {
    for case in cases {
        let (name, units, unit, calls) = (case.name(), case.units, case.unit, case.counted_calls);
        counted_region(&mut *case.start(), calls);
        println!("{name} {} {unit}", units * calls);
    }
}
