//! No test may cause a validation error: an error of the program that the graphics library finds on any device in any
//! thread fails the tests that draw, and so does a line about it in the log of the real program.
//!
//! The tests of `faults` are exempt, because their layer provokes such errors on purpose.

use std::ffi::OsStr;
use std::fmt::{Debug, Write};
use std::sync::Once;
use std::sync::atomic::{AtomicUsize, Ordering};
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

/// Start of the log message about such an error.
const WORDS: &str = "unexpected graphics error";

/// Number of validation errors in this process since it started.
static COMPLAINTS: AtomicUsize = AtomicUsize::new(0);

/// A guard for code that draws. Dropping it fails the test if a validation error has occurred.
#[derive(Debug)]
pub struct NoComplaints(());

impl NoComplaints {
    /// Counts validation errors from now on.
    pub fn expect() -> Self {
        static LISTEN: Once = Once::new();
        LISTEN.call_once(|| tracing::subscriber::set_global_default(Listener).expect("nobody else listens"));
        Self(())
    }
}

impl Drop for NoComplaints {
    fn drop(&mut self) {
        // An error of another test fails this one too; its text is in the output of the test that caused it.
        let complaints = COMPLAINTS.load(Ordering::Relaxed);
        if !std::thread::panicking() {
            assert_eq!(complaints, 0, "{WORDS}s in this process");
        }
    }
}

/// Fails if the log of a program that drew without the fault layer contains such an error.
#[track_caller]
pub fn none_in<'a>(said: &str, environment: impl IntoIterator<Item = &'a OsStr>) {
    let provoked = environment.into_iter().any(|name| name.as_encoded_bytes().starts_with(b"FAULT_"));
    assert!(provoked || !said.contains(WORDS), "{said}");
}

/// Receives error events and no others, so that it adds nothing to tests that count allocations.
struct Listener;

impl Subscriber for Listener {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        *metadata.level() == tracing::Level::ERROR && metadata.target().starts_with("dragonfly")
    }

    fn event(&self, event: &Event<'_>) {
        let mut said = EventText(String::new());
        event.record(&mut said);
        if said.0.contains(WORDS) {
            COMPLAINTS.fetch_add(1, Ordering::Relaxed);
            // Printed in the thread that caused the error, so it appears in the output of its test.
            eprintln!("{}", said.0);
        }
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

/// The text of all fields of an event, in one line.
struct EventText(String);

impl Visit for EventText {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        let _ = write!(self.0, "{field}={value:?} ");
    }
}
