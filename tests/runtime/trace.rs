//! The trace: sender, receiver, time in the queue and duration of each message.

use crate::helpers::{LIMIT, Log, fn_receiver, fn_worker, forwarder, log_calls, panic_quietly};
use dragonfly_runtime::{
    CallEnd, Context, Receiver, Stage, Thread, TraceEvent, TraceRecord, TraceSnapshot, Worker,
};
use std::sync::{Arc, Mutex};
use std::time::Duration;

const MS: Duration = Duration::from_millis(1);

/// The message of these tests.
struct Order;

struct Waiter(dragonfly_runtime::Address<Order>);
impl Worker for Waiter {
    fn update(&mut self, _: &mut Context) -> bool {
        self.0.send(Order).is_ok()
    }
}

struct Cook;
impl Receiver for Cook {
    type Message = Order;
    fn receive(&mut self, Order: Order, _: &mut Context) {}
    fn name(&self) -> &str {
        "chef"
    }
}

fn line(record: &TraceRecord) -> String {
    let turn = record.iteration;
    match &record.event {
        TraceEvent::Message { from, to, message, waited, end } => {
            format!("{turn}: {from} -{message}-> {to} waited {waited:?} {end:?}")
        }
        TraceEvent::Worker { name, end } => format!("{turn}: {name} {end:?}"),
    }
}

#[test]
fn the_trace_records_sender_receiver_and_time_in_the_queue() {
    let mut stage = Stage::new();
    let (hall, kitchen) = (stage.start("hall"), stage.start("kitchen"));
    stage.context(&kitchen).set_trace(100);
    let address = stage.context(&kitchen).register_receiver(Cook);
    stage.context(&kitchen).register_worker(fn_worker(|_| false));
    stage.context(&hall).register_worker(Waiter(address.clone()));
    stage.iterate(&hall);
    stage.advance(MS * 7);
    address.send(Order).unwrap();
    stage.iterate(&kitchen);
    let lines: Vec<_> = stage.context(&kitchen).trace().records.iter().map(line).collect();
    assert_eq!(lines[0], "1: hall/Waiter -Order-> chef waited Some(7ms) Done(true)");
    assert_eq!(
        lines[1], "1:  -Order-> chef waited Some(0ns) Done(true)",
        "sent by a thread outside of the runtime"
    );
    assert!(lines[2].ends_with("Done(false)"), "{}", lines[2]);
}

#[test]
fn the_trace_records_the_duration_of_each_call() {
    let timer = Thread::start("timed").unwrap();
    timer.handle().set_trace(10);
    let (release, held) = std::sync::mpsc::channel::<()>();
    let slow = fn_receiver(move |_: u32, _: &mut Context| _ = held.recv());
    let address = timer.handle().register_receiver(|_| slow);
    address.send(1).unwrap();
    let begin = std::time::Instant::now();
    while begin.elapsed() < MS * 5 {
        std::hint::spin_loop();
    }
    drop(release);
    let (receiver, received) = forwarder::<TraceSnapshot>();
    let answers = timer.handle().register_receiver(|_| receiver);
    timer.handle().request_trace(&answers);
    let snapshot = received.recv_timeout(LIMIT).unwrap();
    assert_eq!(&*snapshot.thread, "timed");
    assert!(snapshot.records[0].took > Duration::ZERO, "{:?}", snapshot.records);
}

#[test]
fn the_trace_records_panics_and_undeliverable_messages() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    stage.context(&thread).set_trace(100);
    let gone = thread.reserve_address::<u32>();
    let bad = fn_receiver(|_: u32, _: &mut Context| panic_quietly("no"));
    let bad = stage.context(&thread).register_receiver(bad);
    gone.send(1).unwrap();
    bad.send(2).unwrap();
    stage.iterate(&thread);
    let end = |record: &TraceRecord| match record.event {
        TraceEvent::Message { end, .. } | TraceEvent::Worker { end, .. } => end,
    };
    let ends: Vec<_> = stage.context(&thread).trace().records.iter().map(end).collect();
    assert_eq!(ends, [CallEnd::Undeliverable, CallEnd::Panicked]);
}

#[test]
fn the_trace_keeps_the_newest_records() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(log_calls(&log, "work"));
    assert!(stage.context(&thread).trace().records.is_empty(), "off by default");
    thread.set_trace(3);
    for _ in 0..10 {
        stage.iterate(&thread);
    }
    let turns: Vec<_> =
        stage.context(&thread).trace().records.iter().map(|record| record.iteration).collect();
    assert_eq!(turns.len(), 3);
    assert_eq!(turns[2] - turns[0], 2);
    thread.set_trace(0);
    stage.iterate(&thread);
    assert!(stage.context(&thread).trace().records.is_empty());
}

#[test]
fn a_trace_that_is_off_adds_no_allocation_to_a_send() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let address = stage.context(&thread).register_receiver(fn_receiver(|_: u64, _: &mut Context| ()));
    let turn = |stage: &mut Stage| {
        address.send(1).unwrap();
        stage.iterate(&thread);
    };
    // Two batches are swapped in turn: each must grow once.
    turn(&mut stage);
    turn(&mut stage);
    let (count, ()) = dragonfly_kit::counting::count(|| (0..100).for_each(|_| turn(&mut stage)));
    assert_eq!(count.allocations, 0, "{count:?}");
}

/// A `tracing` subscriber that stores the fields of each event as one line.
#[derive(Clone, Default)]
struct EventLog(Arc<Mutex<Vec<String>>>);

impl tracing::Subscriber for EventLog {
    fn enabled(&self, metadata: &tracing::Metadata<'_>) -> bool {
        metadata.target().starts_with("dragonfly_runtime")
    }
    fn new_span(&self, _: &tracing::span::Attributes<'_>) -> tracing::span::Id {
        tracing::span::Id::from_u64(1)
    }
    fn record(&self, _: &tracing::span::Id, _: &tracing::span::Record<'_>) {}
    fn record_follows_from(&self, _: &tracing::span::Id, _: &tracing::span::Id) {}
    fn event(&self, event: &tracing::Event<'_>) {
        struct FieldLine(String);
        impl tracing::field::Visit for FieldLine {
            fn record_debug(&mut self, field: &tracing::field::Field, value: &dyn std::fmt::Debug) {
                self.0 += &format!(" {field}={value:?}");
            }
        }
        let mut line = FieldLine(event.metadata().level().to_string());
        event.record(&mut line);
        self.0.lock().unwrap().push(line.0);
    }
    fn enter(&self, _: &tracing::span::Id) {}
    fn exit(&self, _: &tracing::span::Id) {}
}

#[test]
fn records_are_logged_with_tracing_and_errors_even_without_a_trace() {
    let listener = EventLog::default();
    tracing::subscriber::with_default(listener.clone(), || {
        let mut stage = Stage::new();
        let kitchen = stage.start("kitchen");
        let address = stage.context(&kitchen).register_receiver(Cook);
        let gone = kitchen.reserve_address::<u32>();
        address.send(Order).unwrap();
        gone.send(1).unwrap();
        kitchen.run(|_| panic_quietly("on fire")).unwrap();
        stage.iterate(&kitchen);
        stage.context(&kitchen).set_trace(1);
        address.send(Order).unwrap();
        stage.iterate(&kitchen);
    });
    let lines = listener.0.lock().unwrap();
    assert_eq!(lines.len(), 4, "{lines:#?}");
    assert!(lines[3].starts_with("DEBUG message=stopped"), "{lines:#?}");
    assert!(
        lines[0].starts_with("DEBUG message=undeliverable") && lines[0].contains("kitchen"),
        "{lines:#?}"
    );
    assert!(lines[1].starts_with("ERROR message=panic") && lines[1].contains("on fire"), "{lines:#?}");
    assert!(lines[2].starts_with("TRACE") && lines[2].contains("to=chef"), "{lines:#?}");
}
