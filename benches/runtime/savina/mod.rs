//! The standard suite for actors: Shams Imam and Vivek Sarkar, "Savina – An Actor Benchmark Suite", AGERE 2014; only
//! its benchmarks of messages, without those of arithmetic.
//!
//! The actors of each benchmark are written once (`suite/`), without an additional call or box between them and the
//! actor systems (`systems/`). Assertions in the actors check the result of every run. A failed assertion, any other
//! panic, and a run of more than a minute end the program, which prints the system and the benchmark.
//!
//! | benchmark | original | `Full` | `Short` |
//! |---|---|---|---|
//! | `ping_pong` | 40,000 rounds | 1 | 1/4 |
//! | `counting` | 1,000,000 messages | 1 | 1/4 |
//! | `fork_join_throughput` | 60 actors, 10,000 messages each | 1 | 1/4 |
//! | `fork_join_creation` | 40,000 actors | 1 | 1/4 |
//! | `thread_ring` | 100 actors, 100,000 hops | 1 | 1/5 |
//! | `chameneos` | 100 creatures, 200,000 meetings | 1 | 1/10 |
//! | `big` | 120 actors, 20,000 pings each | 1/5 | 1/20 |
//! | `dictionary` | 20 workers, 10,000 requests each, one in ten writes | 1 | 1/10 |
//! | `bounded_buffer` | 40 producers, 1,000 items each, 40 consumers, a buffer of 50 | 1 | 1/5 |
//! | `philosophers` | 20 philosophers, 10,000 meals each | 1 | 1/10 |
//! | `barber` | 5,000 haircuts, 1,000 seats | 1/2 of both | 1/5 of both |
//! | `smokers` | 200 smokers, 1,000 rounds | 1 | 1 |
//!
//! A fraction is relative to the messages of the original. The number of actors is that of the original, except in
//! `barber`, whose customers are actors.
//!
//! Metrics: `total` is the time from before the creation of the first actor to the last message that the result needs,
//! without the start of threads and runtimes; `per_message` is `total` divided by the number of these messages. Each
//! benchmark documents which messages it counts, and its differences from the original.

// Each system compiles the suite for itself; `suite/mod.rs` explains why.
#![allow(clippy::duplicate_mod)]

mod run;
mod systems;

use crate::{RunValues, Study, Variant};
use run::Finish;
use systems::{SYSTEMS, System};

/// The benchmarks, and whether their actors create other actors and end one by one.
const BENCHMARKS: [(&str, bool); 12] = [
    ("ping_pong", false),
    ("counting", false),
    ("fork_join_throughput", false),
    ("fork_join_creation", true),
    ("thread_ring", false),
    ("chameneos", false),
    ("big", false),
    ("dictionary", false),
    ("bounded_buffer", false),
    ("philosophers", false),
    ("barber", true),
    ("smokers", false),
];

/// Measures every benchmark in every system that supports it.
pub fn all(study: &mut Study) {
    let mode = study.mode;
    for (name, creates) in BENCHMARKS {
        let case = format!("savina/{name}");
        let variant = |system: &'static System| {
            let case = case.clone();
            Variant::new(system.label, move |measured| {
                let finish = (system.play)(name, mode);
                record(
                    measured,
                    finish.unwrap_or_else(|problem| panic!("{case}, {}: {problem}", system.label)),
                );
            })
        };
        let able = SYSTEMS.iter().filter(|system| system.creates || !creates);
        study.compare(&case, mode.pick(1, 3, 5), able.map(variant).collect());
    }
}

fn record(measured: &mut RunValues, finish: Finish) {
    let nanoseconds = finish.took.as_nanos() as f64;
    measured.value("total", "ns", nanoseconds);
    measured.value("per_message", "ns", nanoseconds / finish.messages as f64);
    if let Some(retries) = finish.retries {
        measured.value("retries", "count", retries as f64);
    }
}
