//! The argument `--time`: seconds of a take, or an exact time of a scene as its script writes times.

use super::choice::finite;
use dragonfly_anim::stage::time::{StageRate, StageTime, parse_time};
use std::str::FromStr;

/// A time as it was written. A scene reads it with its own frame rate and exactly, because what begins at 2.3 s has not begun at the nearest
/// number of single precision, which is a little before.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TimeArgument {
    text: Box<str>,
    /// Seconds, for a take; `None` for frames, which a model file does not have.
    seconds: Option<f32>,
}

impl FromStr for TimeArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let made = |seconds: Option<f32>| Self { text: text.into(), seconds };
        if let Some(time) = parse_time(text, StageRate::default()) {
            // A number is read at once, so that it is rounded once.
            let seconds = text.parse().ok().or_else(|| (!text.ends_with('f')).then(|| time.seconds() as f32));
            return Ok(made(seconds));
        }
        // Also what scripts do not have, such as 1e-3.
        let usage = "is no time; write for example 2.5, 250ms, 1:05.5, or of a scene 36f";
        finite(text).map(|seconds| made(Some(seconds))).map_err(|reason| match reason.as_str() {
            "is not a number" => usage.to_owned(),
            _ => reason,
        })
    }
}

impl TimeArgument {
    /// Returns the time in a take, seconds.
    ///
    /// # Errors
    ///
    /// It is in frames.
    pub(super) fn of_take(&self) -> Result<f32, super::Failure> {
        self.seconds.ok_or_else(|| {
            let reason = format_args!("{}: frames are times of scenes; write seconds for a model", self.text);
            super::Failure::input("--time", reason)
        })
    }

    /// Returns the time in a scene with this frame rate.
    pub(super) fn of_scene(&self, rate: StageRate) -> StageTime {
        // Read again, because it was rounded for a take.
        let exact = self.text.parse().ok().or(self.seconds.map(f64::from));
        parse_time(&self.text, rate).unwrap_or_else(|| StageTime::from_seconds(exact.unwrap_or(0.0)))
    }
}
