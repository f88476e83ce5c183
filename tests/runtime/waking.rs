//! A thread sleeps when it has nothing to do, and wakes when it has work.

use crate::helpers::{LIMIT, deadline, fn_receiver, fn_worker, forwarder};
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
fn the_os_thread_has_the_name_of_the_runtime_thread() {
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
fn a_thread_without_work_sleeps_and_does_not_iterate() {
    let idle = Thread::start("idle").unwrap();
    idle.handle().register_worker(|_| fn_worker(|_| true));
    let settled = || {
        let os = os_thread("idle")?;
        (os.state == 'S' && idle.handle().counters().iterations > 0).then_some(os.waits)
    };
    eventually(LIMIT, || settled().is_some());
    let before = (settled(), idle.handle().counters());
    // Waits until another thread has slept for 200 ms.
    let timer = Thread::start("timer").unwrap();
    let (rings, rang) = forwarder();
    let bell = timer.handle().register_receiver(|_| rings);
    timer.handle().remote_sleep(Duration::from_millis(200));
    bell.send(()).unwrap();
    rang.recv_timeout(LIMIT).unwrap();
    assert_eq!((settled(), idle.handle().counters()), before, "it woke without a reason");
}

#[test]
fn an_idle_thread_wakes_for_every_message() {
    let thread = Thread::start("doze").unwrap();
    let (receiver, received) = forwarder();
    let address = thread.handle().register_receiver(|_| receiver);
    for message in 0..1000_u32 {
        address.send(message).unwrap();
        assert_eq!(received.recv_timeout(LIMIT), Ok(message));
    }
}

#[test]
fn a_thread_wakes_at_its_alarm_and_not_earlier() {
    let thread = Thread::start("alarm").unwrap();
    let (inside, outside) = std::sync::mpsc::channel();
    let when = Instant::now() + Duration::from_millis(50);
    thread.handle().register_worker(move |_| {
        fn_worker(move |thread| {
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
fn a_thread_keeps_running_only_while_a_worker_requests_it() {
    let thread = Thread::start("runner").unwrap();
    let handle = thread.handle().clone();
    let (inside, outside) = std::sync::mpsc::channel();
    handle.register_worker(move |_| {
        let mut left = 500;
        fn_worker(move |thread| {
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
    assert!(outside.try_recv().is_err(), "it was called without having requested it");
    assert!(handle.counters().iterations >= 501);
}

#[test]
fn a_waiting_captured_thread_is_woken_once_for_several_messages() {
    let woken = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&woken);
    let mut captured = Thread::capture("main", move || {
        count.fetch_add(1, Ordering::SeqCst);
    });
    let address = captured.context().register_receiver(fn_receiver(|_: u32, _| ()));
    address.send(1).unwrap();
    assert_eq!(woken.load(Ordering::SeqCst), 0, "it does not wait yet");
    assert_eq!(captured.iterate(), Next::OnMessage);
    address.send(2).unwrap();
    address.send(3).unwrap();
    assert_eq!(woken.load(Ordering::SeqCst), 1, "only the first message wakes it");
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
fn a_captured_thread_and_an_os_thread_exchange_messages() {
    let main = std::thread::current();
    let mut captured = Thread::capture("main", move || main.unpark());
    let (receiver, received) = forwarder();
    let answers = captured.context().register_receiver(receiver);
    let doubler = Thread::start("doubler").unwrap();
    let questions = doubler
        .handle()
        .register_receiver(move |_| fn_receiver(move |message: u32, _| answers.send(message * 2).unwrap()));
    let end = deadline();
    let mut sum = 0;
    for question in 0..100 {
        questions.send(question).unwrap();
        loop {
            let next = captured.iterate();
            if let Ok(answer) = received.try_recv() {
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
fn a_spinning_thread_needs_no_wake_up_and_sleeps_in_the_end() {
    let thread = Thread::start("spinning").unwrap();
    let (receiver, received) = forwarder();
    let address = thread.handle().register_receiver(|_| receiver);
    let sleeps = || os_thread("spinning").map_or(0, |os| os.waits);
    // The limit is longer than the test: the thread never sleeps between two messages.
    thread.handle().set_spin(LIMIT);
    address.send(0).unwrap();
    assert_eq!(received.recv_timeout(LIMIT), Ok(0));
    let before = sleeps();
    for message in 0..1000_u32 {
        address.send(message).unwrap();
        assert_eq!(received.recv_timeout(LIMIT), Ok(message));
    }
    let slept = sleeps() - before;
    assert!(slept < 500, "it slept {slept} times between 1,000 messages");
    // With a limit of 1 ms the thread spins for a moment and then sleeps; with zero it sleeps
    // at once.
    for limit in [Duration::from_millis(1), Duration::ZERO] {
        thread.handle().set_spin(limit);
        eventually(LIMIT, || is_asleep("spinning"));
        address.send(7).unwrap();
        assert_eq!(received.recv_timeout(LIMIT), Ok(7));
    }
}

#[test]
fn a_spinning_thread_keeps_its_alarms_and_can_be_stopped() {
    let thread = Thread::start("awaiting").unwrap();
    thread.handle().set_spin(LIMIT);
    let (rings, rang) = forwarder();
    let bell = thread.handle().register_receiver(|_| rings);
    let begin = Instant::now();
    let mut rung = false;
    thread.handle().register_worker(move |thread: &mut Context| {
        let when = thread.now() + Duration::from_millis(20);
        thread.wake_at(when);
        fn_worker(move |thread: &mut Context| {
            if thread.now() >= when && !rung {
                rung = true;
                bell.send(()).unwrap();
            }
            true
        })
    });
    rang.recv_timeout(LIMIT).unwrap();
    assert!(begin.elapsed() < LIMIT / 2, "the alarm came only after the spinning");
    thread.handle().remote_stop();
    Thread::wait_for(&[thread.handle().clone()], deadline()).unwrap();
    assert!(begin.elapsed() < LIMIT / 2);
}
