//! The time on screen, at any moment and after any sequence of commands.

use dragonfly_kit::random::{Random, seed};
use dragonfly_picture::playback::{PlaybackClock, Repeat};
use std::time::{Duration, Instant};

const REPEATS: [Repeat; 3] = [Repeat::Once, Repeat::Loop, Repeat::PingPong];

fn playback(now: Instant, length: f32, repeat: Repeat) -> PlaybackClock {
    PlaybackClock {
        take: Some(0),
        start: 1.0,
        length,
        anchor_time: 1.0,
        playing: true,
        repeat,
        ..PlaybackClock::rest(now)
    }
}

fn later(now: Instant, seconds: f64) -> Instant {
    now + Duration::from_secs_f64(seconds)
}

#[test]
fn the_time_stays_within_the_take() {
    let now = Instant::now();
    for repeat in REPEATS {
        for length in [0.0, 1e-6, 0.5, 3.0, 1e5] {
            for speed in [-8.0, -1.0, 0.0, 0.3, 1.0, 8.0] {
                let playback = PlaybackClock { speed, ..playback(now, length, repeat) };
                for seconds in [0.0, 0.1, 1.0, 2.9, 100.0, 1e6] {
                    let time = playback.time_at(later(now, seconds));
                    let end = playback.start + length;
                    assert!((playback.start..=end).contains(&time), "{playback:?} after {seconds} s: {time}");
                }
            }
        }
    }
}

#[test]
fn each_repeat_mode_handles_the_end_of_the_take() {
    let now = Instant::now();
    assert_eq!(playback(now, 2.0, Repeat::Once).time_at(later(now, 5.0)), 3.0);
    assert!((playback(now, 2.0, Repeat::Loop).time_at(later(now, 5.0)) - 2.0).abs() < 1e-5);
    assert!((playback(now, 2.0, Repeat::PingPong).time_at(later(now, 3.0)) - 2.0).abs() < 1e-5);
}

#[test]
fn the_last_frame_of_a_loop_can_be_shown() {
    let now = Instant::now();
    let playback = PlaybackClock { playing: false, ..playback(now, 2.0, Repeat::Loop) }.seek(3.0, now);
    assert_eq!(playback.time_at(now), 3.0);
}

#[test]
fn the_time_may_be_outside_the_take_when_paused_but_not_when_playing() {
    let now = Instant::now();
    let plays = playback(now, 2.0, Repeat::Loop);
    let stands = PlaybackClock { playing: false, ..plays };
    for (wanted, standing, playing) in
        [(7.5, 7.5, 3.0), (0.25, 0.25, 1.0), (-1.0, 0.0, 1.0), (1e9, 86_400.0, 3.0), (f32::NAN, 1.0, 1.0)]
    {
        assert_eq!(stands.seek(wanted, now).time_at(later(now, 9.0)), standing);
        assert_eq!(plays.seek(wanted, now).time_at(now), playing);
    }
    // The rest pose has no time.
    assert_eq!(PlaybackClock { take: None, ..PlaybackClock::rest(now) }.seek(2.0, now).time_at(now), 0.0);
}

#[test]
fn no_playback_command_makes_the_time_jump() {
    let seed = seed(7);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let mut now = Instant::now();
    let mut state = playback(now, 2.5, Repeat::Loop);
    for _ in 0..5_000 {
        now = later(now, f64::from(random.unit()) * 0.3);
        let before = state.time_at(now);
        let speed = [-2.0, -1.0, 0.25, 1.0, 3.0][random.below(5)];
        let playing = random.below(2) == 0;
        // The repeat mode affects only times beyond the end, which do not occur here.
        state = state.with(playing, speed, REPEATS[random.below(3)], now);
        let after = state.time_at(now);
        assert!((after - before).abs() < 1e-4, "{before} became {after}");
    }
}

#[test]
fn paused_playback_does_not_advance() {
    let now = Instant::now();
    let stands = PlaybackClock { playing: false, ..playback(now, 2.0, Repeat::Loop) };
    assert!(!stands.moves(now));
    assert!(!PlaybackClock { speed: 0.0, ..playback(now, 2.0, Repeat::Loop) }.moves(now));
    assert!(!playback(now, 0.0, Repeat::Loop).moves(now));
    assert!(playback(now, 2.0, Repeat::Once).moves(now));
    assert!(!playback(now, 2.0, Repeat::Once).moves(later(now, 2.5)), "it has arrived");
}
