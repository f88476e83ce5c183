//! Durations of frames in formats that count in whole units of time.

use dragonfly_anim::stage::time::StageRate;

/// Returns the start of a frame in units of which `units` are a second, rounded to the nearest: so the rounding never adds up.
pub(crate) fn start_of(frame: u64, rate: StageRate, units: u32) -> u64 {
    let (frames, seconds) = rate.fraction();
    let by = u128::from(frames);
    ((u128::from(frame) * u128::from(seconds) * u128::from(units) + by / 2) / by) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_of_frames_do_not_drift() {
        let rate = |text| StageRate::parse(text).unwrap();
        let starts = |text, units| (0..6).map(|frame| start_of(frame, rate(text), units)).collect::<Vec<_>>();
        assert_eq!(starts("30", 100), [0, 3, 7, 10, 13, 17]);
        assert_eq!(starts("24", 1000), [0, 42, 83, 125, 167, 208]);
        assert_eq!(start_of(24_000 * 3600, rate("24000/1001"), 100), 1001 * 3600 * 100);
        assert_eq!(start_of(u64::MAX, rate("1"), 1), u64::MAX);
    }
}
