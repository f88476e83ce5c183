//! R3: many messages between OS threads: none is lost, duplicated or out of order.

use crate::helpers::{fn_receiver, plain_thread};
use dragonfly_kit::process::alone;
use dragonfly_runtime::{Context, Thread};
use std::time::{Duration, Instant};

/// Total number of messages: 10 million, or the number in `DRAGONFLY_STRESS`.
fn messages() -> u64 {
    std::env::var("DRAGONFLY_STRESS").map_or(10_000_000, |count| count.parse().expect("a number"))
}

/// Four senders, each of which sends to all of four threads.
#[test]
fn ten_million_messages_arrive_once_each_and_in_order() {
    alone("stress::ten_million_messages_arrive_once_each_and_in_order", || {
        const SENDERS: u64 = 4;
        const THREADS: u64 = 4;
        let each = messages() / SENDERS / THREADS;
        let (inside, outside) = std::sync::mpsc::channel();
        let threads: Vec<_> = (0..THREADS).map(|_| Thread::start("taker").unwrap()).collect();
        let addresses: Vec<_> = threads
            .iter()
            .map(|thread| {
                let inside = inside.clone();
                thread.handle().register_receiver(move |_| {
                    let (mut next, mut sum) = ([0; SENDERS as usize], 0_u64);
                    fn_receiver(move |(sender, number): (usize, u64), _: &mut Context| {
                        assert_eq!(number, next[sender], "of sender {sender}");
                        next[sender] += 1;
                        sum = sum.wrapping_add(number * (sender as u64 + 1));
                        if next == [each; SENDERS as usize] {
                            inside.send(sum).unwrap();
                        }
                    })
                })
            })
            .collect();
        let begin = Instant::now();
        let senders: Vec<_> = (0..SENDERS as usize)
            .map(|sender| {
                let addresses = addresses.clone();
                plain_thread(move || {
                    for number in 0..each {
                        for address in &addresses {
                            address.send((sender, number)).unwrap();
                        }
                        // Senders are much faster than receivers; this bounds the queue.
                        while number % 1024 == 0 && addresses[0].queue_len() > 100_000 {
                            std::thread::yield_now();
                        }
                    }
                })
            })
            .collect();
        for sender in senders {
            sender.join().unwrap();
        }
        let limit = Duration::from_secs(300);
        let right = (1..=SENDERS).sum::<u64>() * (each * (each - 1) / 2);
        for _ in &threads {
            let sum = outside.recv_timeout(limit).expect("all arrive, in order");
            assert_eq!(sum, right);
        }
        let (took, sent) = (begin.elapsed(), each * SENDERS * THREADS);
        println!("R3: {sent} messages in {took:.2?}, {:.0} ns each", took.as_nanos() as f64 / sent as f64);
        for thread in &threads {
            assert_eq!(thread.handle().counters().panics, 0);
        }
    });
}
