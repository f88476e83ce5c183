//! One work that is measured, and the rules by which works stand beside each other.

use std::hint::black_box;

/// What is called to do a work once.
pub(crate) type Work = Box<dyn FnMut()>;

/// A work done in one way, and how many units of it one call does.
pub(crate) struct Case {
    /// Who does it: the open path, the fast path at a level, a rival.
    pub(crate) way: String,
    /// What is done: work, model, case, with slashes between. The same for everyone who does it.
    pub(crate) row: String,
    /// Cases of one group take turns while they are measured.
    pub(crate) group: String,
    pub(crate) units: usize,
    pub(crate) unit: &'static str,
    /// Calls that the counter of instructions needs, so that getting in and out of the work does not count.
    pub(crate) counted_calls: usize,
    setup: Box<dyn FnOnce() -> Work>,
}

impl Case {
    /// `setup` makes what does `units` of `unit` in each call; it wraps what it computes in [`black_box`]. Nothing is set up
    /// before it is needed.
    pub(crate) fn new<W: FnMut() + 'static>(
        way: impl Into<String>,
        row: impl Into<String>,
        units: usize,
        unit: &'static str,
        setup: impl FnOnce() -> W + 'static,
    ) -> Self {
        let row = row.into();
        Self {
            way: way.into(),
            group: row.clone(),
            row,
            units,
            unit,
            counted_calls: 3,
            setup: Box::new(|| Box::new(setup())),
        }
    }

    /// Measured together with all other cases of `group`, whatever they do.
    pub(crate) fn among(self, group: impl Into<String>) -> Self {
        Self { group: group.into(), ..self }
    }

    /// Counted in one call: there is so much in it that getting in and out does not matter.
    pub(crate) fn counted_once(self) -> Self {
        Self { counted_calls: 1, ..self }
    }

    /// Way and row, with a slash between.
    pub(crate) fn name(&self) -> String {
        format!("{}/{}", self.way, self.row)
    }

    /// Gets it ready, and does it once.
    pub(crate) fn start(self) -> Work {
        let mut work = (self.setup)();
        work();
        work
    }
}

/// Whom the others of a row stand beside: the sketch where it does the same, else the open path.
pub(crate) const RIVALS: [&str; 2] = ["sketch", "open"];

/// The name of the rival of the case `name` among `names`; none where it is the rival itself, or alone.
pub(crate) fn rival_of<'a>(case: &Case, all: impl Iterator<Item = &'a Case> + Clone) -> Option<String> {
    let beside = |way: &&str| all.clone().any(|other| other.way == **way && other.row == case.row);
    let way = RIVALS.into_iter().find(|way| beside(way))?;
    (case.way != way).then(|| format!("{way}/{}", case.row))
}

/// What the counter of instructions looks for by its name: nothing outside of it is counted.
#[inline(never)]
fn counted_region(work: &mut dyn FnMut(), calls: usize) {
    for _ in 0..calls {
        black_box(&mut *work)();
    }
}

/// Does each case under the counter's eyes, one after the other, and says how many units that were: a line a case.
pub(crate) fn count(cases: Vec<Case>) {
    for case in cases {
        let (name, units, unit, calls) = (case.name(), case.units, case.unit, case.counted_calls);
        counted_region(&mut case.start(), calls);
        println!("{name} {} {unit}", units * calls);
    }
}
