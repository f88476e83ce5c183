//! Properties of lights, cameras and effects over time.

use crate::stage::ease::StageEase;
use crate::stage::table::PropertyType;
use crate::stage::time::{Decimal, StageTime};

/// A value: one number three times, or a color in linear light.
pub(super) type PropertyNumbers = [f64; 3];

/// A `set` or `change`.
#[derive(Clone, Copy, Debug)]
pub(super) struct PropertyCue {
    pub(super) begin: StageTime,
    pub(super) stop: StageTime,
    pub(super) dur: StageTime,
    pub(super) ease: StageEase,
    pub(super) is_released: bool,
    pub(super) to: PropertyNumbers,
    /// The value at the start.
    pub(super) start: PropertyNumbers,
}

/// A property and its changes, in the order of their begins.
#[derive(Clone, Debug)]
pub(super) struct PropertyLane {
    pub(super) name: &'static str,
    pub(super) base: PropertyNumbers,
    pub(super) cues: Vec<PropertyCue>,
}

impl PropertyLane {
    /// Returns the value at `time`.
    pub(super) fn at(&self, time: StageTime) -> PropertyNumbers {
        let begun = self.cues.partition_point(|cue| cue.begin <= time);
        let counts = |cue: &&PropertyCue| !(cue.is_released && time >= cue.stop);
        let Some(cue) = self.cues[..begun].iter().rfind(counts) else { return self.base };
        if cue.dur <= StageTime::ZERO {
            return cue.to;
        }
        let after = time.min(cue.stop) - cue.begin;
        let x = cue.ease.at(after.ticks() as f64 / cue.dur.ticks() as f64);
        std::array::from_fn(|at| cue.start[at] + (cue.to[at] - cue.start[at]) * x)
    }

    /// Adds a change that begins after all others, or with the last one.
    pub(super) fn push(&mut self, cue: PropertyCue) {
        let start = self.at(cue.begin);
        self.cues.push(PropertyCue { start, ..cue });
    }
}

/// Reads the value of a property; 0 for a text that is none.
pub(super) fn property_value(kind: PropertyType, text: &str) -> PropertyNumbers {
    match kind {
        PropertyType::Number | PropertyType::Lens => {
            [Decimal::parse(text.strip_suffix("mm").unwrap_or(text)).map_or(0.0, Decimal::to_f64); 3]
        }
        PropertyType::Color => {
            let part = |at: usize| {
                let hex = text.get(1 + 2 * at..3 + 2 * at).and_then(|hex| u8::from_str_radix(hex, 16).ok());
                linear(f64::from(hex.unwrap_or(0)) / 255.0)
            };
            [part(0), part(1), part(2)]
        }
    }
}

/// Returns the linear light of a part of an sRGB color (IEC 61966-2-1).
fn linear(value: f64) -> f64 {
    if value <= 0.040_45 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
}
