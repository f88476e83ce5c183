//! The frame rate of the document. Files do not contain it, so it is guessed from the times of keys until one is chosen.

use dragonfly_anim::data::Take;
use dragonfly_anim::frames::OFF_FRAME;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Frame rates that the timeline offers, ascending.
pub(super) const OFFERED: &[u32] = &[12, 15, 24, 25, 30, 48, 50, 60, 90, 100, 120];
/// Lowest and highest frame rate that can be typed.
pub(super) const RATES: RangeInclusive<u32> = 1..=480;
/// Lowest frame rate that is guessed: keys on every second frame of 24 are not keys of 12 frames per second.
const LOWEST_GUESS: u32 = 24;
/// Frame rate of a document whose keys tell none.
const USUAL: u32 = 30;

/// The frame rate of the document that is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FrameRate {
    rate: u32,
    is_chosen: bool,
}

impl Default for FrameRate {
    fn default() -> Self {
        Self { rate: USUAL, is_chosen: false }
    }
}

impl FrameRate {
    /// Returns the frames per second.
    pub(super) fn get(self) -> u32 {
        self.rate
    }

    /// Returns the rate if the user chose it for this document, not if it was guessed.
    pub(super) fn chosen(self) -> Option<u32> {
        self.is_chosen.then_some(self.rate)
    }

    /// Sets the rate that the user chose, or the nearest valid one.
    pub(super) fn choose(&mut self, rate: u32) {
        *self = Self { rate: rate.clamp(*RATES.start(), *RATES.end()), is_chosen: true };
    }

    /// Sets the rate that the keys of a model fit, or the usual one if they fit none.
    pub(super) fn guess(&mut self, takes: &[Arc<Take>]) {
        *self = Self { rate: rate_of(takes).unwrap_or(USUAL), is_chosen: false };
    }
}

/// Maximum number of keys that are read: of a channel, and of a take.
const MOST: (usize, usize) = (500, 5_000);
/// Maximum number of takes that are read.
const MOST_TAKES: usize = 100;
/// Minimum number of keys; fewer may be at whole frames by chance.
const LEAST: usize = 3;

/// Returns the frame rate that the keys of most takes fit, if these are at least half of the takes; of two rates with
/// the same number of takes, the one that comes first. `None` if there are too few keys, or if they fit no rate.
fn rate_of(takes: &[Arc<Take>]) -> Option<u32> {
    let told: Vec<Option<u32>> =
        takes.iter().take(MOST_TAKES).filter_map(|take| rate_of_take(take)).collect();
    let votes = |rate: u32| told.iter().filter(|&&other| other == Some(rate)).count();
    // Reversed, because `max_by_key` returns the last of several maxima.
    let most = told.iter().rev().copied().flatten().max_by_key(|&rate| votes(rate))?;
    (votes(most) * 2 >= told.len()).then_some(most)
}

/// Returns the lowest usual rate that nearly all keys of a take fit, or `Some(None)` if none
/// fits. `None` if there are too few keys.
fn rate_of_take(take: &Take) -> Option<Option<u32>> {
    let columns = take.tracks.iter().flat_map(|track| [&track.translation.times, &track.rotation.times]);
    let keys = columns.flat_map(|times| times.iter().take(MOST.0)).take(MOST.1);
    let times: Vec<f64> = keys.map(|&time| f64::from(time)).filter(|time| *time > 0.0).collect();
    let fits = |rate: &u32| {
        let on =
            |time: &&f64| (*time * f64::from(*rate) - (*time * f64::from(*rate)).round()).abs() < OFF_FRAME;
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
    Some(OFFERED.iter().copied().filter(|&rate| rate >= LOWEST_GUESS).find(fits))
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
        for rate in [24, 25, 30, 60, 100, 120] {
            assert_eq!(rate_of(&every(rate as f32)), Some(rate), "{rate}");
        }
        // The lowest of those that fit, but keys on every second frame are not a lower rate.
        assert_eq!(rate_of(&every(12.0)), Some(24));
        assert_eq!(rate_of(&take((0..9).map(|key| key as f32))), Some(24));
        // Rounded to milliseconds, as some exporters do, and with an end that was trimmed between two frames.
        let rounded = (0..40).map(|key| (key as f32 / 24.0 * 1e3).round() / 1e3);
        assert_eq!(rate_of(&take(rounded.chain([1.6301]))), Some(24));
    }

    #[test]
    fn the_rate_that_most_takes_fit_is_chosen_not_a_higher_one_that_all_fit() {
        let at = |rate: f32| take((0..40).map(|key| key as f32 / rate)).remove(0);
        assert_eq!(rate_of(&[at(24.0), at(24.0), at(120.0)]), Some(24));
        assert_eq!(rate_of(&[at(25.0), at(24.0)]), Some(25), "the first where none has more");
        let anywhere = || take((0..40).map(|key| key as f32 * 0.0854)).remove(0);
        assert_eq!(rate_of(&[anywhere(), at(24.0), anywhere()]), None, "one of three says little");
        assert_eq!(rate_of(&[at(24.0), at(30.0), at(30.0)]), Some(30));
    }

    #[test]
    fn no_rate_is_guessed_from_keys_between_frames_or_from_too_few_keys() {
        let anywhere = take((0..40).map(|key| key as f32 * 0.0854));
        assert_eq!(rate_of(&anywhere), None);
        assert_eq!(rate_of(&take([0.0, 0.041_667, 0.083_333])), None);
        assert_eq!(rate_of(&[]), None);
    }
}
