//! Guesses the frame rate at which the keys of a model were made from their times: files do not contain it.

use super::settings::FRAME_RATES;
use dragonfly_anim::data::Take;
use std::sync::Arc;

/// Maximum distance of a key to a frame, in frames. Times are stored in single precision, and often rounded.
const ON: f64 = 0.02;
/// Maximum number of keys that are read: of a channel, and of a take.
const MOST: (usize, usize) = (500, 5_000);
/// Maximum number of takes that are read.
const MOST_TAKES: usize = 100;
/// Minimum number of keys; fewer may be at whole frames by chance.
const LEAST: usize = 3;

/// Returns the frame rate that the keys of most takes fit, if these are at least half of the takes; of two rates with
/// the same number of takes, the one that comes first. `None` if there are too few keys, or if they fit no rate.
pub(super) fn rate_of(takes: &[Arc<Take>], now: u32) -> Option<u32> {
    let told: Vec<Option<u32>> =
        takes.iter().take(MOST_TAKES).filter_map(|take| rate_of_take(take, now)).collect();
    let votes = |rate: u32| told.iter().filter(|&&other| other == Some(rate)).count();
    // Reversed, because `max_by_key` returns the last of several maxima.
    let most = told.iter().rev().copied().flatten().max_by_key(|&rate| votes(rate))?;
    (votes(most) * 2 >= told.len()).then_some(most)
}

/// Returns the rate that nearly all keys of a take fit: `now`, otherwise the lowest usual rate, or `Some(None)` if none
/// fits. `None` if there are too few keys.
fn rate_of_take(take: &Take, now: u32) -> Option<Option<u32>> {
    let columns = take.tracks.iter().flat_map(|track| [&track.translation.times, &track.rotation.times]);
    let keys = columns.flat_map(|times| times.iter().take(MOST.0)).take(MOST.1);
    let times: Vec<f64> = keys.map(|&time| f64::from(time)).filter(|time| *time > 0.0).collect();
    let fits = |rate: &u32| {
        let on = |time: &&f64| (*time * f64::from(*rate) - (*time * f64::from(*rate)).round()).abs() < ON;
        // A few keys may be off the frames: the last key of a take is often where the take was cut.
        times.iter().filter(on).count() * 100 >= times.len() * 95
    };
    let mut apart = times.clone();
    apart.sort_by(f64::total_cmp);
    apart.dedup();
    if apart.len() < LEAST {
        return None;
    }
    // The rates ascend, so the lower one is found if the frames of another rate include its frames.
    Some([now].iter().chain(FRAME_RATES).copied().find(fits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_anim::data::{Channel, Interpolation, Track};
    use glam::Vec3;

    fn take(times: impl IntoIterator<Item = f32>) -> Vec<Arc<Take>> {
        let times: Arc<[f32]> = times.into_iter().collect();
        let values = vec![Vec3::ZERO; times.len()];
        let translation = Channel::new(times, values, Interpolation::Linear);
        let track = Track { bone: 0, translation, ..Track::default() };
        vec![Arc::new(Take { tracks: vec![track], ..Take::default() })]
    }

    #[test]
    fn the_frame_rate_is_guessed_from_the_times_of_keys() {
        let every = |rate: f32| take((0..40).map(|key| key as f32 / rate));
        for (rate, now) in [(24, 30), (25, 30), (30, 24), (60, 24), (60, 30), (100, 30), (120, 30)] {
            assert_eq!(rate_of(&every(rate as f32), now), Some(rate), "{rate}");
        }
        // The current frame rate stays if all keys are on its frames.
        assert_eq!(rate_of(&every(30.0), 60), Some(60));
        assert_eq!(rate_of(&take((0..9).map(|key| key as f32)), 30), Some(30));
        // Rounded to milliseconds, as some exporters do, and with an end that was trimmed between two frames.
        let rounded = (0..40).map(|key| (key as f32 / 24.0 * 1e3).round() / 1e3);
        assert_eq!(rate_of(&take(rounded.chain([1.6301])), 30), Some(24));
    }

    #[test]
    fn the_rate_that_most_takes_fit_is_chosen_not_a_higher_one_that_all_fit() {
        let at = |rate: f32| take((0..40).map(|key| key as f32 / rate)).remove(0);
        assert_eq!(rate_of(&[at(24.0), at(24.0), at(120.0)], 30), Some(24));
        assert_eq!(rate_of(&[at(25.0), at(24.0)], 30), Some(25), "the first where none has more");
        let anywhere = || take((0..40).map(|key| key as f32 * 0.0854)).remove(0);
        assert_eq!(rate_of(&[anywhere(), at(24.0), anywhere()], 30), None, "one of three says little");
        assert_eq!(rate_of(&[at(24.0), at(30.0), at(30.0)], 30), Some(30));
    }

    #[test]
    fn no_rate_is_guessed_from_keys_between_frames_or_from_too_few_keys() {
        let anywhere = take((0..40).map(|key| key as f32 * 0.0854));
        assert_eq!(rate_of(&anywhere, 30), None);
        assert_eq!(rate_of(&take([0.0, 0.041_667, 0.083_333]), 30), None);
        assert_eq!(rate_of(&[], 30), None);
    }
}
