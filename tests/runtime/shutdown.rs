//! R6: a shutdown never hangs, whatever the threads are doing.

use crate::helpers::{LIMIT, fn_receiver, fn_worker, panic_quietly};
use dragonfly_kit::process::{alone, os_threads};
use dragonfly_kit::{eventually, random};
use dragonfly_runtime::{Context, Thread};
use std::time::{Duration, Instant};

#[test]
fn a_thousand_shutdowns_at_random_moments_all_end() {
    alone("shutdown::a_thousand_shutdowns_at_random_moments_all_end", || {
        let seed = random::seed(6);
        println!("seed {seed}");
        let mut random = random::Random::new(seed);
        let baseline = os_threads().len();
        let mut longest = Duration::ZERO;
        for run in 0..1000 {
            longest = longest.max(shut_down_once(&mut random));
            assert!(longest <= Duration::from_secs(2), "run {run} took {longest:?}");
        }
        eventually(LIMIT, || os_threads().len() == baseline);
        println!("R6: 1000 shutdowns, the longest {longest:.2?}, {baseline} OS threads as before");
    });
}

/// Stops, in random order and after a random time, five threads that send to one another: one after a
/// panic, one asleep, one paused, one busy, and one with a full queue. Returns how long that took.
fn shut_down_once(random: &mut random::Random) -> Duration {
    let threads: Vec<_> =
        ["panicked", "asleep", "paused", "busy", "full"].map(|name| Thread::start(name).unwrap()).into();
    let handles: Vec<_> = threads.iter().map(|thread| thread.handle().clone()).collect();
    let addresses: Vec<_> = handles.iter().map(|handle| handle.reserve_address::<u32>()).collect();
    for (index, handle) in handles.iter().enumerate() {
        let next = addresses[(index + 1) % addresses.len()].clone();
        handle.register_receiver_at(&addresses[index], move |_| {
            // The next thread may have stopped already.
            fn_receiver(move |message: u32, _: &mut Context| {
                if message > 0 {
                    let _ = next.send(message - 1);
                }
            })
        });
    }
    handles[0].register_worker(|_| fn_worker(|_| panic_quietly("on purpose")));
    handles[1].remote_sleep(LIMIT);
    handles[2].pause();
    handles[3].register_worker(|_| {
        fn_worker(|thread| {
            thread.iterate_again();
            true
        })
    });
    for message in 0..random.below(300) as u32 {
        for address in &addresses {
            address.send(message % 7).unwrap();
        }
    }
    for _ in 0..random.below(2000) {
        std::hint::spin_loop();
    }
    let begin = Instant::now();
    let mut order = handles.clone();
    while !order.is_empty() {
        order.swap_remove(random.below(order.len())).remote_stop();
    }
    Thread::wait_for(&handles, begin + LIMIT).expect("all end");
    drop(threads);
    begin.elapsed()
}

#[test]
fn dropping_a_stuck_thread_returns_at_the_deadline() {
    let (release, held) = std::sync::mpsc::channel::<()>();
    let thread = Thread::start("stuck").unwrap();
    let handle = thread.handle().clone();
    handle.run(move |_| _ = held.recv()).unwrap();
    let begin = Instant::now();
    drop(thread);
    assert!(begin.elapsed() >= dragonfly_runtime::DROP_DEADLINE && begin.elapsed() < LIMIT);
    assert!(!handle.is_stopped());
    drop(release);
    eventually(LIMIT, || handle.is_stopped());
}
