//! State of one import: memory budget, cancel flag, progress, warnings, referenced files.

use super::uri::relative_path;
use super::{
    AssetError, AssetFs, Conventions, Conversion, ImportError, OverBudget, Place, ReadOptions, Warning,
};
use crate::limits::{CANCEL_EVERY, EXTERNAL_FILES, WARNINGS};
use std::cell::{Cell, RefCell};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// One import in progress. The reader of a [`Format`](super::Format) gets it and uses it for everything that has a
/// limit: it charges memory before allocating, counts work, collects warnings, and reads referenced files.
pub struct ImportContext<'a> {
    options: &'a ReadOptions<'a>,
    files: &'a dyn AssetFs,
    neighbors: RefCell<HashMap<String, Arc<[u8]>>>,
    warnings: RefCell<Vec<Warning>>,
    warned: RefCell<HashSet<(Place, &'static str)>>,
    dropped_warnings: Cell<usize>,
    work: Cell<usize>,
    progress: Cell<f32>,
    conversion: Cell<Conversion>,
}

impl<'a> ImportContext<'a> {
    /// Returns the context of an import that reads referenced files through `files`.
    pub fn new(files: &'a dyn AssetFs, options: &'a ReadOptions<'a>) -> Self {
        Self {
            options,
            files,
            neighbors: RefCell::default(),
            warnings: RefCell::default(),
            warned: RefCell::default(),
            dropped_warnings: Cell::new(0),
            work: Cell::new(0),
            progress: Cell::new(0.0),
            conversion: Cell::default(),
        }
    }

    /// Returns the units, axes and frame rate that the user chose.
    pub fn conventions(&self) -> &Conventions {
        &self.options.conventions
    }

    /// Records how the coordinates and times of the file were converted. Without it they are those of the library.
    pub fn converted(&self, conversion: Conversion) {
        self.conversion.set(conversion);
    }

    /// Returns the recorded conversion.
    pub fn conversion(&self) -> Conversion {
        self.conversion.get()
    }

    /// Returns an empty vector with capacity for `count` values, charged to the budget.
    pub fn vec<T>(&self, place: &Place, count: usize) -> Result<Vec<T>, ImportError> {
        self.vec_at(|| place.clone(), count)
    }

    /// As [`Self::vec`], with a place that is computed only for an error: lines are slow to count.
    pub(super) fn vec_at<T>(&self, place: impl Fn() -> Place, count: usize) -> Result<Vec<T>, ImportError> {
        let bytes = (count as u64).saturating_mul(size_of::<T>() as u64);
        self.charge_at(&place, bytes)?;
        let mut vec = Vec::new();
        match vec.try_reserve_exact(count) {
            Ok(()) => Ok(vec),
            Err(_) => {
                Err(too_large(&place(), OverBudget { needed: bytes, limit: self.options.budget.remaining() }))
            }
        }
    }

    /// Returns a vector of `count` copies of `value`, charged to the budget.
    pub fn filled<T: Clone>(&self, place: &Place, count: usize, value: T) -> Result<Vec<T>, ImportError> {
        let mut vec = self.vec(place, count)?;
        self.work(count)?;
        vec.resize(count, value);
        Ok(vec)
    }

    /// Charges memory that the caller is about to allocate.
    pub fn charge(&self, place: &Place, bytes: u64) -> Result<(), ImportError> {
        self.options.budget.charge(bytes).map_err(|over| too_large(place, over))
    }

    /// As [`Self::charge`], with a place that is computed only for an error.
    #[inline]
    pub(super) fn charge_at(&self, place: impl FnOnce() -> Place, bytes: u64) -> Result<(), ImportError> {
        self.options.budget.charge(bytes).map_err(|over| too_large(&place(), over))
    }

    /// Returns the number of bytes that can still be charged.
    pub fn remaining_memory(&self) -> u64 {
        self.options.budget.remaining()
    }

    /// Counts `steps` of work and polls the cancel flag from time to time. Call it before a loop of that many steps.
    pub fn work(&self, steps: usize) -> Result<(), ImportError> {
        let work = self.work.get().saturating_add(steps).saturating_add(1);
        if work < CANCEL_EVERY {
            self.work.set(work);
            return Ok(());
        }
        self.work.set(0);
        if (self.options.is_cancelled)() { Err(ImportError::Cancelled) } else { Ok(()) }
    }

    /// Reports the progress, a fraction 0..1, and polls the cancel flag. A smaller fraction than before is not reported.
    pub fn progress(&self, part: f32) -> Result<(), ImportError> {
        if (self.options.is_cancelled)() {
            return Err(ImportError::Cancelled);
        }
        if part >= self.progress.get() {
            self.progress.set(part);
            (self.options.progress)(part);
        }
        Ok(())
    }

    /// Adds a warning, at most one for each place and rule. After [`WARNINGS`] of them the rest is only counted.
    pub fn warn(&self, place: Place, code: &'static str, text: impl Into<String>) {
        let mut warnings = self.warnings.borrow_mut();
        if warnings.len() < WARNINGS {
            if !self.warned.borrow_mut().insert((place.clone(), code)) {
                return;
            }
            warnings.push(Warning { place, code, text: text.into() });
        } else {
            self.dropped_warnings.set(self.dropped_warnings.get() + 1);
        }
    }

    /// Returns the warnings in the order in which they were added, with the number of dropped ones at the end.
    pub fn into_warnings(self) -> Vec<Warning> {
        let mut warnings = self.warnings.into_inner();
        if self.dropped_warnings.get() > 0 {
            let text = format!("and {} more warnings", self.dropped_warnings.get());
            warnings.push(Warning { place: Place::File, code: "MORE", text });
        }
        warnings
    }

    /// Reads the file that the relative reference `uri` names; `place` is where the imported file contains it.
    ///
    /// The reference is decoded and checked by [`relative_path`]. Each file is read once, charged twice (as read and as
    /// shared), and at most [`EXTERNAL_FILES`] of them are read. Errors that leave the rest of the file readable are
    /// [`ImportError::External`].
    pub fn read_neighbor(&self, uri: &str, place: &Place) -> Result<Arc<[u8]>, ImportError> {
        let path =
            relative_path(uri).map_err(|error| external(uri, place, INVALID_URI, error.to_string()))?;
        if let Some(bytes) = self.neighbors.borrow().get(&path) {
            return Ok(Arc::clone(bytes));
        }
        let known = self.neighbors.borrow().len();
        if known >= EXTERNAL_FILES {
            let (size, limit) = (known as u64 + 1, EXTERNAL_FILES as u64);
            return Err(ImportError::TooLarge { place: place.clone(), what: "external files", size, limit });
        }
        if (self.options.is_cancelled)() {
            return Err(ImportError::Cancelled);
        }
        let limit = self.options.budget.remaining() / 2;
        let read = self.files.read(&path, limit).and_then(|bytes| match bytes.len() as u64 {
            size if size > limit => Err(AssetError::TooLarge { size, limit }),
            _ => Ok(bytes),
        });
        let bytes = read.map_err(|error| external(uri, place, IO_ERROR, error.to_string()))?;
        self.charge(place, bytes.len() as u64 * 2)?;
        self.options.budget.input(bytes.len());
        let bytes: Arc<[u8]> = bytes.into();
        self.neighbors.borrow_mut().insert(path, Arc::clone(&bytes));
        Ok(bytes)
    }
}

/// Code of an [`ImportError::External`] whose file could not be read.
pub(super) const IO_ERROR: &str = "IO_ERROR";

/// Code of an [`ImportError::External`] whose reference is refused.
pub(super) const INVALID_URI: &str = "INVALID_URI";

/// Returns the error of a reference, which is shortened when it is very long.
pub(super) fn external(uri: &str, place: &Place, code: &'static str, reason: String) -> ImportError {
    let uri = match uri.char_indices().nth(120) {
        Some((end, _)) => format!("{}…", &uri[..end]),
        None => uri.to_owned(),
    };
    ImportError::External { place: place.clone(), code, uri, reason }
}

fn too_large(place: &Place, over: OverBudget) -> ImportError {
    ImportError::TooLarge {
        place: place.clone(),
        what: "bytes of memory needed",
        size: over.needed,
        limit: over.limit,
    }
}
