//! No test may make the graphics library complain: whatever it calls an error of ours ("validation"), on any device and in
//! any thread, fails the tests that draw, and so does a line about it in the log of the real program.
//!
//! Excepted are the tests of `faults`, whose layer provokes errors that are not ours.

use std::ffi::OsStr;
use std::fmt::{Debug, Write};
use std::sync::Once;
use std::sync::atomic::{AtomicUsize, Ordering};
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

/// How the program begins to tell of such an error.
const WORDS: &str = "unexpected graphics error";

/// In this process, since it began.
static COMPLAINTS: AtomicUsize = AtomicUsize::new(0);

/// While there is one, somebody draws; at its end nothing may have been complained about.
#[derive(Debug)]
pub struct NoComplaints(());

impl NoComplaints {
    /// Listens from now on.
    pub fn expect() -> Self {
        static LISTEN: Once = Once::new();
        LISTEN.call_once(|| tracing::subscriber::set_global_default(Listener).expect("nobody else listens"));
        Self(())
    }
}

impl Drop for NoComplaints {
    fn drop(&mut self) {
        // One that comes from another test fails this one too; the text stands where it happened.
        let complaints = COMPLAINTS.load(Ordering::Relaxed);
        if !std::thread::panicking() {
            assert_eq!(complaints, 0, "{WORDS}s in this process");
        }
    }
}

/// Fails when a program that drew without the layer of faults tells of such an error.
#[track_caller]
pub fn none_in<'a>(said: &str, environment: impl IntoIterator<Item = &'a OsStr>) {
    let provoked = environment.into_iter().any(|name| name.as_encoded_bytes().starts_with(b"FAULT_"));
    assert!(provoked || !said.contains(WORDS), "{said}");
}

/// Hears of errors and of nothing else, so that tests which count allocations count none of its.
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
            // In the thread that made the error, so in the output of its test.
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

/// Everything an event says, in a row.
struct EventText(String);

impl Visit for EventText {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        let _ = write!(self.0, "{field}={value:?} ");
    }
}
