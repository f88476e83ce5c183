//! The timer (thesis §3.2.5.1).

use dragonfly_runtime::{Stage, Timer};
use std::time::{Duration, Instant};

const SECOND: Duration = Duration::from_secs(1);

#[test]
fn many_objects_can_measure_time_with_one_timer() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let timer = stage.context(&thread).timer();
    stage.advance(SECOND);
    let early = timer.time();
    stage.advance(SECOND);
    let late = timer.clone().time();
    stage.advance(SECOND / 2);
    assert_eq!((timer.elapsed(early), timer.elapsed(late)), (SECOND * 3 / 2, SECOND / 2));
    assert_eq!(timer.elapsed(SECOND * 100), Duration::ZERO, "a stamp from the future");
}

#[test]
fn a_timer_on_the_system_clock_does_not_go_back() {
    let before = Instant::now();
    let timer = Timer::start();
    assert!(timer.start_time() >= before);
    let first = timer.time();
    let second = timer.time();
    assert!(second >= first);
    assert!(timer.start_time() + second <= Instant::now());
}
