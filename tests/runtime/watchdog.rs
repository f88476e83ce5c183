//! R8: a call that does not come back is reported, with the type of its message.

use crate::cast::{LIMIT, hear, work};
use dragonfly_runtime::{Context, STALL_LIMIT, Stage, Stall, Thread, Watchdog};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::mpsc;
use std::time::Duration;

/// Something to load.
struct Load;

#[test]
fn a_stalled_receiver_is_reported_once_with_its_message_type() {
    let (report, reports) = mpsc::channel::<Stall>();
    let limit = Duration::from_millis(40);
    let watchdog = Watchdog::start(limit, move |stall| report.send(stall.clone()).unwrap()).unwrap();
    let thread = Thread::start("loader").unwrap();
    watchdog.watch(thread.handle());
    let (let_go, held) = mpsc::channel::<()>();
    let address = thread.handle().register_receiver(move |_| hear(move |_: Load, _| _ = held.recv()));
    address.send(Load).unwrap();
    let stall = reports.recv_timeout(LIMIT).unwrap();
    assert_eq!((&*stall.thread, stall.call), ("loader", "Load"));
    assert!(stall.running >= limit);
    let_go.send(()).unwrap();
    address.send(Load).unwrap();
    assert_eq!(reports.recv_timeout(LIMIT).unwrap().call, "Load", "the second is another stall");
    assert!(reports.try_recv().is_err(), "each is reported once");
}

#[test]
fn workers_and_closures_stall_too() {
    let (report, reports) = mpsc::channel::<Stall>();
    let limit = Duration::from_millis(20);
    let watchdog = Watchdog::start(limit, move |stall| report.send(stall.clone()).unwrap()).unwrap();
    let thread = Thread::start("loader").unwrap();
    watchdog.watch(thread.handle());
    let (let_go, held) = mpsc::channel::<()>();
    thread.handle().register_worker(move |_| work(move |_| held.recv().is_ok()));
    assert_eq!(reports.recv_timeout(LIMIT).unwrap().call, "update");
    drop(let_go);
    let (let_go, held) = mpsc::channel::<()>();
    thread.handle().run(move |_| _ = held.recv()).unwrap();
    assert_eq!(reports.recv_timeout(LIMIT).unwrap().call, "run");
    drop(let_go);
}

#[test]
fn the_limit_is_five_seconds_and_short_calls_are_none_of_its_business() {
    // The watched thread is real and stuck; the watchdog stands on a stage, where time is cheap.
    let thread = Thread::start("stuck").unwrap();
    let mut stage = Stage::new();
    let tower = stage.start("tower");
    let (report, reports) = mpsc::channel::<Duration>();
    let watchdog = Watchdog::start_in(&tower, STALL_LIMIT, move |stall| report.send(stall.running).unwrap());
    watchdog.watch(thread.handle());
    let (let_go, held) = mpsc::channel::<()>();
    let (begun, begins) = mpsc::channel();
    let wait = move |_: &mut Context| {
        begun.send(()).unwrap();
        let _ = held.recv();
    };
    thread.handle().run(wait).unwrap();
    begins.recv_timeout(LIMIT).unwrap();
    stage.iterate(&tower);
    stage.advance(Duration::from_millis(4999));
    stage.iterate(&tower);
    assert!(reports.try_recv().is_err());
    stage.advance(Duration::from_millis(1));
    stage.iterate(&tower);
    assert_eq!(reports.try_recv(), Ok(Duration::from_secs(5)));
    stage.advance(STALL_LIMIT * 2);
    stage.iterate(&tower);
    assert!(reports.try_recv().is_err(), "once is enough");
    drop(let_go);
}

#[test]
fn a_thread_that_has_stopped_is_forgotten() {
    let mut stage = Stage::new();
    let (tower, short) = (stage.start("tower"), stage.start("short"));
    let seen = Rc::new(RefCell::new(0));
    let watchdog = Watchdog::start_in(&tower, STALL_LIMIT, |_| ());
    watchdog.watch(&short);
    assert!(stage.settle(10));
    let next = stage.iterate(&tower);
    assert!(matches!(next, dragonfly_runtime::Next::At(_)), "it looks from time to time: {next:?}");
    short.remote_stop();
    stage.settle(10);
    stage.advance(STALL_LIMIT);
    assert_eq!(stage.iterate(&tower), dragonfly_runtime::Next::OnMessage, "nobody left to watch");
    drop(seen);
}
