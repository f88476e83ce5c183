//! What every importer carries along: budget, cancel flag, progress, warnings.

use super::{ImportError, OverBudget, Place, ReadOptions, Warning};
use crate::limits::{CANCEL_EVERY, WARNINGS};
use std::cell::{Cell, RefCell};
use std::collections::HashSet;

/// One import under way.
pub(crate) struct Guard<'a> {
    options: &'a ReadOptions<'a>,
    warnings: RefCell<Vec<Warning>>,
    said: RefCell<HashSet<(Place, &'static str)>>,
    unsaid: Cell<usize>,
    work: Cell<usize>,
    progress: Cell<f32>,
}

impl<'a> Guard<'a> {
    pub(crate) fn new(options: &'a ReadOptions<'a>) -> Self {
        Self {
            options,
            warnings: RefCell::default(),
            said: RefCell::default(),
            unsaid: Cell::new(0),
            work: Cell::new(0),
            progress: Cell::new(0.0),
        }
    }

    /// An empty vector with room for `count` values, charged to the budget.
    pub(crate) fn vec<T>(&self, place: &Place, count: usize) -> Result<Vec<T>, ImportError> {
        let bytes = (count as u64).saturating_mul(size_of::<T>() as u64);
        self.charge(place, bytes)?;
        let mut vec = Vec::new();
        match vec.try_reserve_exact(count) {
            Ok(()) => Ok(vec),
            Err(_) => {
                Err(too_large(place, OverBudget { needed: bytes, limit: self.options.budget.remaining() }))
            }
        }
    }

    /// A vector of `count` times `value`, charged to the budget.
    pub(crate) fn filled<T: Clone>(
        &self,
        place: &Place,
        count: usize,
        value: T,
    ) -> Result<Vec<T>, ImportError> {
        let mut vec = self.vec(place, count)?;
        self.work(count)?;
        vec.resize(count, value);
        Ok(vec)
    }

    /// Charges memory that is about to be taken elsewhere.
    pub(crate) fn charge(&self, place: &Place, bytes: u64) -> Result<(), ImportError> {
        self.options.budget.charge(bytes).map_err(|over| too_large(place, over))
    }

    /// Bytes that a file about to be read may have.
    pub(crate) fn remaining(&self) -> u64 {
        self.options.budget.remaining()
    }

    /// Grants more memory because more input was read.
    pub(crate) fn input(&self, bytes: usize) {
        self.options.budget.input(bytes);
    }

    /// Counts `steps` of work and looks at the cancel flag now and then. Call it before a loop of so many steps.
    pub(crate) fn work(&self, steps: usize) -> Result<(), ImportError> {
        let work = self.work.get().saturating_add(steps).saturating_add(1);
        if work < CANCEL_EVERY {
            self.work.set(work);
            return Ok(());
        }
        self.work.set(0);
        if (self.options.is_cancelled)() { Err(ImportError::Cancelled) } else { Ok(()) }
    }

    /// Tells how far reading is and looks at the cancel flag.
    pub(crate) fn progress(&self, part: f32) -> Result<(), ImportError> {
        if (self.options.is_cancelled)() {
            return Err(ImportError::Cancelled);
        }
        if part >= self.progress.get() {
            self.progress.set(part);
            (self.options.progress)(part);
        }
        Ok(())
    }

    /// Notes something odd, once a place and rule. Past [`WARNINGS`] it is only counted.
    pub(crate) fn warn(&self, place: Place, code: &'static str, text: impl Into<String>) {
        let mut warnings = self.warnings.borrow_mut();
        if warnings.len() < WARNINGS {
            if !self.said.borrow_mut().insert((place.clone(), code)) {
                return;
            }
            warnings.push(Warning { place, code, text: text.into() });
        } else {
            self.unsaid.set(self.unsaid.get() + 1);
        }
    }

    /// What was noted.
    pub(crate) fn into_warnings(self) -> Vec<Warning> {
        let mut warnings = self.warnings.into_inner();
        if self.unsaid.get() > 0 {
            let text = format!("and {} more warnings", self.unsaid.get());
            warnings.push(Warning { place: Place::File, code: "MORE", text });
        }
        warnings
    }
}

fn too_large(place: &Place, over: OverBudget) -> ImportError {
    ImportError::TooLarge {
        place: place.clone(),
        what: "bytes of memory needed",
        size: over.needed,
        limit: over.limit,
    }
}
