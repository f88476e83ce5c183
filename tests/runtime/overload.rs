//! R7: a producer that is ten times too fast neither exhausts memory nor is blocked.

use crate::helpers::{LIMIT, fn_receiver};
use dragonfly_kit::process::{alone, resident_bytes};
use dragonfly_runtime::{Context, SendError, Thread};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Duration of the test: 5 s, or the seconds in `DRAGONFLY_OVERLOAD` (30 before a release).
fn duration() -> Duration {
    let secs = std::env::var("DRAGONFLY_OVERLOAD").map_or(5, |secs| secs.parse().expect("seconds"));
    Duration::from_secs(secs)
}

#[test]
fn ten_times_too_many_messages_neither_fill_the_memory_nor_block_the_sender() {
    alone("overload::ten_times_too_many_messages_neither_fill_the_memory_nor_block_the_sender", || {
        let thread = Thread::start("slow").unwrap();
        let (edits, scrubs, loads) = [(); 3].map(|()| Arc::new(AtomicU64::new(0))).into();
        let count = |counter: &Arc<AtomicU64>| {
            let counter = Arc::clone(counter);
            move |_: &mut Context| {
                fn_receiver(move |message: Vec<u8>, _: &mut Context| {
                    // About 100 µs of work, so the thread handles a tenth of what is sent.
                    let begin = Instant::now();
                    while begin.elapsed() < Duration::from_micros(100) {
                        std::hint::black_box(&message);
                    }
                    counter.fetch_add(1, Ordering::Relaxed);
                })
            }
        };
        let edit = thread.handle().register_receiver(count(&edits));
        let scrub = thread.handle().register_receiver(count(&scrubs)).latest();
        let load = thread.handle().register_receiver(count(&loads)).bounded(1024);
        let before = resident_bytes();
        let (mut most, mut times) = (0, Vec::new());
        let (mut sent_edits, mut full) = (0, 0);
        let (begin, mut due) = (Instant::now(), Instant::now());
        // 100,000 messages per second: 1 % edits, half of the rest scrubs, half loads.
        for message in 0_u64.. {
            if begin.elapsed() > duration() {
                break;
            }
            while Instant::now() < due {
                std::hint::spin_loop();
            }
            due += Duration::from_micros(10);
            let content = vec![0; 1024];
            let start = Instant::now();
            match message % 100 {
                0 => edit.send(content).unwrap(),
                odd if odd % 2 == 1 => scrub.send(content).unwrap(),
                _ => full += u64::from(matches!(load.send(content), Err(SendError::Full(_)))),
            }
            times.push(start.elapsed());
            sent_edits += u64::from(message % 100 == 0);
            if message % 1000 == 0 {
                most = most.max(resident_bytes().saturating_sub(before));
            }
        }
        let sends = times.len();
        most = most.saturating_sub(times.capacity() * size_of::<Duration>());
        times.sort_unstable();
        let (median, slow, slowest) = (times[sends / 2], times[sends * 999 / 1000], times[sends - 1]);
        thread.handle().remote_stop();
        Thread::wait_for(&[thread.handle().clone()], Instant::now() + LIMIT).unwrap();
        println!(
            "R7: {sends} sends in {:?}: median {median:?}, p99.9 {slow:?}, slowest {slowest:?}; {} MiB grown; \
             {sent_edits} edits, {} scrubs of {}, {full} loads refused",
            duration(),
            most >> 20,
            scrubs.load(Ordering::Relaxed),
            sends / 2,
        );
        assert!(most <= 64 << 20, "{most} bytes");
        assert!(full > 0, "the producer was not too fast");
        assert_eq!(edits.load(Ordering::Relaxed), sent_edits, "no edit is dropped");
        // The guarantee is 50 µs; on a busy machine the sender may be preempted for longer.
        assert!(slow <= Duration::from_millis(5), "{slow:?}");
    });
}
