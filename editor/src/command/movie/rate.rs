//! Frames per second: those that the user writes, and those of a file.

use dragonfly_anim::stage::time::StageRate;
use dragonfly_document::LoadedModel;

/// Highest rate of a file that counts frames: a higher one counts ticks.
const MOST_FRAMES: f64 = 121.0;

/// Relative difference below which a rate of single precision is that of a fraction.
const PRECISION: f64 = 1e-4;

/// Parses frames per second.
pub(super) fn parse(text: &str) -> Result<StageRate, String> {
    let usage = "is no frame rate from 1 to 1000; write for example 24, 29.97 or 30000/1001";
    StageRate::parse(text).ok_or_else(|| usage.to_owned())
}

/// Returns the frames per second of a model's file; 24 where it has none.
pub(super) fn of_model(loaded: &LoadedModel) -> StageRate {
    loaded.conversion.frame_rate.and_then(|rate| known(rate.value)).unwrap_or_default()
}

/// Returns the fraction that a rate of single precision means; `None` for rates that no movie has.
fn known(rate: f32) -> Option<StageRate> {
    let rate = f64::from(rate);
    let whole = if (1.0..=MOST_FRAMES).contains(&rate) { rate.round() as u32 } else { return None };
    let decimal = StageRate::parse(&format!("{rate:.3}"));
    let rates = [StageRate::new(whole, 1), StageRate::new(whole * 1000, 1001), decimal];
    let is_near = |found: &StageRate| (found.per_second() - rate).abs() <= PRECISION * rate;
    rates.into_iter().flatten().find(is_near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_of_files_become_the_fractions_that_they_mean() {
        let found = |rate: f32| known(rate).map(|rate| rate.to_string());
        assert_eq!(found(30.000_03).as_deref(), Some("30"));
        assert_eq!(found(1.0 / 0.008_333).as_deref(), Some("120"));
        assert_eq!(found(29.97).as_deref(), Some("30000/1001"));
        assert_eq!(found(23.976).as_deref(), Some("24000/1001"));
        assert_eq!(found(12.5).as_deref(), Some("125/10"));
        assert_eq!([f32::NAN, 0.0, 0.5, 4800.0, -24.0].map(found), [None, None, None, None, None]);
    }
}
