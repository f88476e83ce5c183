//! Options of an import: units, axes and frame rate of a file that does not state them, or states them wrongly.

use super::choice::finite;
use clap::ValueEnum;
use dragonfly_anim::format::{Conventions, Handedness, UpAxis};

/// Units, axes and frame rate of the input.
#[derive(Clone, Debug, Default, clap::Args)]
#[command(next_help_heading = "Import options")]
pub(super) struct ImportArguments {
    /// Length of a unit of the input in meters, for example 0.01
    #[arg(long, value_name = "METERS", value_parser = positive)]
    scale: Option<f32>,
    /// Axis of the input that points up
    #[arg(long, value_enum)]
    up: Option<Up>,
    /// Sense of the axes of the input
    #[arg(long, value_enum)]
    hand: Option<AxisSense>,
    /// Frames or ticks per second of the input, for formats that count them
    #[arg(long, value_name = "FPS", value_parser = positive)]
    rate: Option<f32>,
}

/// The axis that points up.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Up {
    /// The x axis
    X,
    /// The y axis
    Y,
    /// The z axis
    Z,
}

/// The sense of the axes.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum AxisSense {
    /// Left-handed
    Left,
    /// Right-handed
    Right,
}

impl ImportArguments {
    /// Returns what was chosen.
    pub(super) fn conventions(&self) -> Conventions {
        Conventions {
            meters_per_unit: self.scale,
            up: self.up.map(|up| match up {
                Up::X => UpAxis::X,
                Up::Y => UpAxis::Y,
                Up::Z => UpAxis::Z,
            }),
            handedness: self.hand.map(|hand| match hand {
                AxisSense::Left => Handedness::Left,
                AxisSense::Right => Handedness::Right,
            }),
            frame_rate: self.rate,
        }
    }

    /// Returns the options as they are written on a command line.
    pub(super) fn to_arguments(&self) -> Vec<String> {
        let word = |value: Option<clap::builder::PossibleValue>| Some(value?.get_name().to_owned());
        let options = [
            ("--scale", self.scale.map(|scale| scale.to_string())),
            ("--up", word(self.up.and_then(|up| up.to_possible_value()))),
            ("--hand", word(self.hand.and_then(|hand| hand.to_possible_value()))),
            ("--rate", self.rate.map(|rate| rate.to_string())),
        ];
        let chosen = options.into_iter().filter_map(|(name, value)| Some([name.to_owned(), value?]));
        chosen.flatten().collect()
    }
}

pub(super) fn positive(text: &str) -> Result<f32, String> {
    match finite(text)? {
        number if number > 0.0 => Ok(number),
        _ => Err("must be greater than zero".to_owned()),
    }
}
