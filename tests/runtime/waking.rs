//! A thread sleeps when it has nothing to do, and wakes when it has.

use crate::cast::{LIMIT, deadline, hear, outlet, work};
use dragonfly_kit::eventually;
use dragonfly_kit::process::{OsThread, os_threads};
use dragonfly_runtime::{Context, Next, Thread};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

fn os_thread(name: &str) -> Option<OsThread> {
    os_threads().into_iter().find(|thread| thread.name == name)
}

fn is_asleep(name: &str) -> bool {
    os_thread(name).is_some_and(|thread| thread.state == 'S')
}

#[test]
fn the_os_thread_has_the_threads_name() {
    let thread = Thread::start("named").unwrap();
    eventually(LIMIT, || os_thread("named").is_some());
    let (inside, outside) = std::sync::mpsc::channel();
    let name = move |_: &mut Context| {
        let name = std::thread::current().name().map(str::to_owned);
        inside.send(name).unwrap();
    };
    thread.handle().run(name).unwrap();
    assert_eq!(outside.recv_timeout(LIMIT).unwrap().as_deref(), Some("named"));
    assert_eq!(thread.handle().name(), "named");
}

#[test]
fn a_thread_without_work_sleeps_and_does_not_turn() {
    let idle = Thread::start("idle").unwrap();
    idle.handle().register_worker(|_| work(|_| true));
    let settled = || {
        let os = os_thread("idle")?;
        (os.state == 'S' && idle.handle().counters().iterations > 0).then_some(os.waits)
    };
    eventually(LIMIT, || settled().is_some());
    let before = (settled(), idle.handle().counters());
    // Another thread lets 200 ms pass.
    let clock = Thread::start("clock").unwrap();
    let (rings, rang) = outlet();
    let bell = clock.handle().register_receiver(|_| rings);
    clock.handle().remote_sleep(Duration::from_millis(200));
    bell.send(()).unwrap();
    rang.recv_timeout(LIMIT).unwrap();
    assert_eq!((settled(), idle.handle().counters()), before, "it woke for nothing");
}

#[test]
fn a_sleeping_thread_wakes_for_every_message() {
    let thread = Thread::start("doze").unwrap();
    let (receiver, hears) = outlet();
    let address = thread.handle().register_receiver(|_| receiver);
    for message in 0..1000_u32 {
        address.send(message).unwrap();
        assert_eq!(hears.recv_timeout(LIMIT), Ok(message));
    }
}

#[test]
fn a_thread_wakes_at_its_alarm_and_not_before() {
    let thread = Thread::start("alarm").unwrap();
    let (inside, outside) = std::sync::mpsc::channel();
    let when = Instant::now() + Duration::from_millis(50);
    thread.handle().register_worker(move |_| {
        work(move |thread| {
            if thread.now() < when {
                thread.wake_at(when);
            } else {
                inside.send(thread.now()).unwrap();
            }
            true
        })
    });
    assert!(outside.recv_timeout(LIMIT).unwrap() >= when);
    let turns = thread.handle().counters().iterations;
    assert!(turns <= 4, "it was called {turns} times for one alarm");
}

#[test]
fn a_thread_runs_on_only_while_a_worker_asks() {
    let thread = Thread::start("runner").unwrap();
    let handle = thread.handle().clone();
    let (inside, outside) = std::sync::mpsc::channel();
    handle.register_worker(move |_| {
        let mut left = 500;
        work(move |thread| {
            if left > 0 {
                left -= 1;
                thread.iterate_again();
            } else {
                inside.send(()).unwrap();
            }
            true
        })
    });
    outside.recv_timeout(LIMIT).unwrap();
    eventually(LIMIT, || is_asleep("runner"));
    assert!(outside.try_recv().is_err(), "it was called after it had stopped asking");
    assert!(handle.counters().iterations >= 501);
}

#[test]
fn a_captured_thread_is_woken_once_when_a_message_comes_while_it_waits() {
    let woken = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&woken);
    let mut captured = Thread::capture("main", move || {
        count.fetch_add(1, Ordering::SeqCst);
    });
    let address = captured.context().register_receiver(hear(|_: u32, _| ()));
    address.send(1).unwrap();
    assert_eq!(woken.load(Ordering::SeqCst), 0, "it has not said that it waits");
    assert_eq!(captured.iterate(), Next::OnMessage);
    address.send(2).unwrap();
    address.send(3).unwrap();
    assert_eq!(woken.load(Ordering::SeqCst), 1, "the first message wakes, the rest need not");
    assert_eq!(captured.iterate(), Next::OnMessage);
    captured.handle().pause();
    captured.iterate();
    address.send(4).unwrap();
    assert_eq!(woken.load(Ordering::SeqCst), 1, "a message does not end a pause");
    captured.handle().resume();
    assert_eq!(woken.load(Ordering::SeqCst), 2);
    captured.handle().remote_stop();
    assert_eq!(captured.iterate(), Next::Stopped);
    assert_eq!(captured.handle().counters().delivered, 4);
}

#[test]
fn a_captured_and_an_own_thread_talk() {
    let main = std::thread::current();
    let mut captured = Thread::capture("main", move || main.unpark());
    let (receiver, hears) = outlet();
    let answers = captured.context().register_receiver(receiver);
    let doubler = Thread::start("doubler").unwrap();
    let questions = doubler
        .handle()
        .register_receiver(move |_| hear(move |message: u32, _| answers.send(message * 2).unwrap()));
    let end = deadline();
    let mut sum = 0;
    for question in 0..100 {
        questions.send(question).unwrap();
        loop {
            let next = captured.iterate();
            if let Ok(answer) = hears.try_recv() {
                sum += answer;
                break;
            }
            assert!(Instant::now() < end);
            if next == Next::OnMessage {
                std::thread::park_timeout(LIMIT);
            }
        }
    }
    assert_eq!(sum, 9900);
}

#[test]
fn a_thread_that_looks_before_it_sleeps_needs_no_wake_up_and_sleeps_in_the_end() {
    let thread = Thread::start("looking").unwrap();
    let (receiver, hears) = outlet();
    let address = thread.handle().register_receiver(|_| receiver);
    let sleeps = || os_thread("looking").map_or(0, |os| os.waits);
    // Looking for as long as the test lasts: it never goes to sleep between two messages.
    thread.handle().set_spin(LIMIT);
    address.send(0).unwrap();
    assert_eq!(hears.recv_timeout(LIMIT), Ok(0));
    let before = sleeps();
    for message in 0..1000_u32 {
        address.send(message).unwrap();
        assert_eq!(hears.recv_timeout(LIMIT), Ok(message));
    }
    let slept = sleeps() - before;
    assert!(slept < 500, "it slept {slept} times between 1,000 messages");
    // For a moment only, and then it sleeps; told to stop looking, it sleeps at once.
    for limit in [Duration::from_millis(1), Duration::ZERO] {
        thread.handle().set_spin(limit);
        eventually(LIMIT, || is_asleep("looking"));
        address.send(7).unwrap();
        assert_eq!(hears.recv_timeout(LIMIT), Ok(7));
    }
}

#[test]
fn a_thread_that_looks_keeps_its_alarms_and_can_be_stopped() {
    let thread = Thread::start("awaiting").unwrap();
    thread.handle().set_spin(LIMIT);
    let (rings, rang) = outlet();
    let bell = thread.handle().register_receiver(|_| rings);
    let begin = Instant::now();
    let mut rung = false;
    thread.handle().register_worker(move |thread: &mut Context| {
        let when = thread.now() + Duration::from_millis(20);
        thread.wake_at(when);
        work(move |thread: &mut Context| {
            if thread.now() >= when && !rung {
                rung = true;
                bell.send(()).unwrap();
            }
            true
        })
    });
    rang.recv_timeout(LIMIT).unwrap();
    assert!(begin.elapsed() < LIMIT / 2, "the alarm waited for the end of looking");
    thread.handle().remote_stop();
    Thread::wait_for(&[thread.handle().clone()], deadline()).unwrap();
    assert!(begin.elapsed() < LIMIT / 2);
}
