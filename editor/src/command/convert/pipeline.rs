//! Conversion of many files at once.
//!
//! ```text
//! converters, one a processor    read, convert ──► writers, several for each converter    write, flush
//! ```
//!
//! A new file is flushed to the disk before it counts as converted. A converter that waited for this would leave its processor
//! idle, so that files of usual sizes are handed to a writer. A converter waits until a writer is free: so many files are in memory
//! at most.

use super::super::Failure;
use super::plan::PlannedFile;
use super::progress::ConvertProgress;
use super::report::FileOutcome;
use dragonfly_document::{Cancel, ConversionOrder, PreparedConversion, make_folder, prepare_conversion};
use dragonfly_runtime::{Job, Thread};
use flume::{Receiver, Sender};
use std::io;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Writers for each converter: a disk flushes several files at once in little more than the time of one.
const WRITERS: usize = 4;

/// Largest size in bytes of files that a writer gets. The converter writes larger ones itself, so that few of them are in memory; it
/// works on them for so long that flushing them hardly counts.
const LARGE: usize = 16 << 20;

/// The files to convert, and how.
pub(super) struct Orders {
    pub(super) files: Vec<PlannedFile>,
    /// The choices for every file; its paths are empty.
    pub(super) choices: ConversionOrder,
    pub(super) resume: bool,
}

/// A file after the first half of its conversion.
enum Halfway {
    /// It still has to be written.
    ToWrite(PreparedConversion),
    Done(FileOutcome),
}

/// A file to write, and its position among all files.
type Handed = (usize, PreparedConversion);

/// The result of a file, and its position among all files.
type Finished = (usize, FileOutcome);

impl Orders {
    /// Reads and converts one file.
    fn prepare(&self, file: &PlannedFile, cancel: &Cancel) -> Halfway {
        let done = |result| Halfway::Done(FileOutcome { file: file.clone(), result });
        if self.resume && file.is_up_to_date() {
            return done(Ok(None));
        }
        if self.choices.is_written
            && file.is_in_folder
            && let Err(reason) = make_folder(&file.output)
        {
            return done(Err(reason));
        }
        match prepare_conversion(&file.order(&self.choices), cancel) {
            Ok(prepared) => Halfway::ToWrite(prepared),
            Err(error) => done(Err(error.to_string())),
        }
    }

    /// Writes a file that was converted.
    fn write(&self, (index, prepared): Handed) -> Finished {
        let result = prepared.write().map(Some).map_err(|error| error.to_string());
        (index, FileOutcome { file: self.files[index].clone(), result })
    }

    /// Converts files until none is left, and hands them to the writers.
    fn convert(
        &self,
        next: &AtomicUsize,
        cancel: &Cancel,
        writers: &Sender<Handed>,
        finished: &Sender<Finished>,
    ) {
        while !cancel.is_cancelled() {
            // The counter orders no other memory access.
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(file) = self.files.get(index) else { break };
            let outcome = match self.prepare(file, cancel) {
                Halfway::Done(outcome) => (index, outcome),
                Halfway::ToWrite(prepared) if prepared.bytes() > LARGE => self.write((index, prepared)),
                Halfway::ToWrite(prepared) => match writers.send((index, prepared)) {
                    Ok(()) => continue,
                    // Every writer ended: a bug, which must not lose the file.
                    Err(returned) => self.write(returned.into_inner()),
                },
            };
            // The receiver is there as long as the jobs are.
            let _ = finished.send(outcome);
        }
    }
}

/// Converts all files, `jobs` at a time or on all processors, and returns the outcomes in the order of the files.
pub(super) fn run(orders: Orders, jobs: Option<NonZeroUsize>) -> Result<Vec<FileOutcome>, Failure> {
    let count = orders.files.len();
    let processors = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let converters = jobs.map_or_else(processors, NonZeroUsize::get).min(count);
    let machine = |error: io::Error| Failure::Machine(format!("no thread could be started: {error}"));
    let thread = Thread::start("convert").map_err(machine)?;
    let (orders, next) = (Arc::new(orders), Arc::new(AtomicUsize::new(0)));
    let (finished, outcomes) = flume::unbounded();
    let (handed, to_write): (Sender<Handed>, Receiver<Handed>) = flume::bounded(0);
    let mut running = Vec::new();
    for _ in 0..converters {
        let (orders, next) = (Arc::clone(&orders), Arc::clone(&next));
        let (handed, finished) = (handed.clone(), finished.clone());
        let work = move |cancel: &Cancel| orders.convert(&next, cancel, &handed, &finished);
        running.push(Job::start_oneshot(thread.handle(), "convert file", work).map_err(machine)?);
    }
    for _ in 0..(converters * WRITERS).min(count) {
        let (orders, to_write, finished) = (Arc::clone(&orders), to_write.clone(), finished.clone());
        let work = move |_: &Cancel| {
            for file in to_write {
                let _ = finished.send(orders.write(file));
            }
        };
        running.push(Job::start_oneshot(thread.handle(), "write file", work).map_err(machine)?);
    }
    drop((handed, to_write, finished));
    let mut results: Vec<Option<FileOutcome>> = Vec::new();
    results.resize_with(count, || None);
    let mut progress = ConvertProgress::new(count);
    for (index, outcome) in outcomes {
        progress.tell(&outcome);
        results[index] = Some(outcome);
    }
    let missing = |(index, outcome): (usize, Option<FileOutcome>)| {
        // A job that ended early: a bug of an importer, which must not hide the other files.
        let reason = "internal error, a bug of the program".to_owned();
        outcome.unwrap_or_else(|| FileOutcome { file: orders.files[index].clone(), result: Err(reason) })
    };
    Ok(results.into_iter().enumerate().map(missing).collect())
}
