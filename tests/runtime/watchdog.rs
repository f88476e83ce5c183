//! R8: a call that does not return is reported, with the type of its message.

use crate::helpers::{LIMIT, fn_receiver, fn_worker};
use dragonfly_runtime::{Context, STALL_LIMIT, Stage, Stall, Thread, Watchdog};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::mpsc;
use std::time::Duration;

/// A message whose receiver blocks.
struct BlockingLoad;

#[test]
fn a_stalled_receiver_is_reported_once_with_its_message_type() {
    let (report, reports) = mpsc::channel::<Stall>();
    let limit = Duration::from_millis(40);
    let watchdog = Watchdog::start(limit, move |stall| report.send(stall.clone()).unwrap()).unwrap();
    let thread = Thread::start("loader").unwrap();
    watchdog.watch(thread.handle());
    let (release, held) = mpsc::channel::<()>();
    let address =
        thread.handle().register_receiver(move |_| fn_receiver(move |_: BlockingLoad, _| _ = held.recv()));
    address.send(BlockingLoad).unwrap();
    let stall = reports.recv_timeout(LIMIT).unwrap();
    assert_eq!((&*stall.thread, stall.call), ("loader", "BlockingLoad"));
    assert!(stall.running >= limit);
    release.send(()).unwrap();
    address.send(BlockingLoad).unwrap();
    assert_eq!(reports.recv_timeout(LIMIT).unwrap().call, "BlockingLoad", "the second call is another stall");
    assert!(reports.try_recv().is_err(), "each is reported once");
}

#[test]
fn stalled_workers_and_closures_are_reported() {
    let (report, reports) = mpsc::channel::<Stall>();
    let limit = Duration::from_millis(20);
    let watchdog = Watchdog::start(limit, move |stall| report.send(stall.clone()).unwrap()).unwrap();
    let thread = Thread::start("loader").unwrap();
    watchdog.watch(thread.handle());
    let (release, held) = mpsc::channel::<()>();
    thread.handle().register_worker(move |_| fn_worker(move |_| held.recv().is_ok()));
    assert_eq!(reports.recv_timeout(LIMIT).unwrap().call, "update");
    drop(release);
    let (release, held) = mpsc::channel::<()>();
    thread.handle().run(move |_| _ = held.recv()).unwrap();
    assert_eq!(reports.recv_timeout(LIMIT).unwrap().call, "run");
    drop(release);
}

#[test]
fn a_stall_is_reported_after_five_seconds_and_not_earlier() {
    // The watched thread is an OS thread that blocks; the watchdog runs on a stage, whose clock the test advances.
    let thread = Thread::start("stuck").unwrap();
    let mut stage = Stage::new();
    let tower = stage.start("tower");
    let (report, reports) = mpsc::channel::<Duration>();
    let watchdog = Watchdog::start_in(&tower, STALL_LIMIT, move |stall| report.send(stall.running).unwrap());
    watchdog.watch(thread.handle());
    let (release, held) = mpsc::channel::<()>();
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
    assert!(reports.try_recv().is_err(), "reported twice");
    drop(release);
}

#[test]
fn a_stopped_thread_is_no_longer_watched() {
    let mut stage = Stage::new();
    let (tower, short) = (stage.start("tower"), stage.start("short"));
    let seen = Rc::new(RefCell::new(0));
    let watchdog = Watchdog::start_in(&tower, STALL_LIMIT, |_| ());
    watchdog.watch(&short);
    assert!(stage.settle(10));
    let next = stage.iterate(&tower);
    assert!(matches!(next, dragonfly_runtime::Next::At(_)), "it checks at intervals: {next:?}");
    short.remote_stop();
    stage.settle(10);
    stage.advance(STALL_LIMIT);
    assert_eq!(stage.iterate(&tower), dragonfly_runtime::Next::OnMessage, "no thread is left to watch");
    drop(seen);
}
