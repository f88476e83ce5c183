//! The tools: their words, their numbers, and the edits that they make.

use crate::panels::context::PanelContext;
use crate::panels::number_slider::SliderScale;
use crate::panels::number_text::Digits;
use dragonfly_document::edit::{
    BlendKeys, BonePose, BoneRef, CurveFilter, Edit, FilterKeys, KeySet, KeyTarget, NoiseKeys, ReduceKeys,
    RepeatCount, RepeatKeys, RepeatMode, TakeRef, TurnKeys, TurnWay,
};
use dragonfly_picture::between;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// A tool that changes the values of the selected keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InBetweenTool {
    /// Between the neighbors.
    Tween,
    /// Away from the line between the neighbors, or onto it.
    Push,
    /// Toward the average of the keys directly before and after each key.
    Relax,
    /// Toward the neighbor before or after.
    Neighbor,
    /// A slow start or a slow end.
    Ease,
    /// Toward the rest pose.
    Rest,
    /// Toward another take.
    Take,
    /// Toward the pose that was copied last.
    Pose,
    /// The values of earlier or later times.
    Delay,
    /// Random offsets.
    Noise,
    /// A Gaussian.
    Gaussian,
    /// A Butterworth filter.
    Butterworth,
    /// Removal of single peaks.
    Peaks,
    /// Removal of redundant keys.
    Reduce,
    /// Full turns from key to key.
    Turns,
    /// The same values again, after the keys or before them.
    Repeat,
    /// Cycles that start where the one before ends.
    RepeatOffset,
    /// Cycles of which every other runs backwards.
    RepeatMirror,
}

/// The axis of the space of a bone about which full turns go where two keys have the same rotation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TurnAxis {
    /// Its x axis.
    X,
    /// Its y axis, which in most models is along the bone.
    #[default]
    Y,
    /// Its z axis.
    Z,
}

impl TurnAxis {
    /// All axes, in the order of the menu.
    pub(super) const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// Returns its name on the screen.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::X => "X",
            Self::Y => "Y",
            Self::Z => "Z",
        }
    }

    fn direction(self) -> [f32; 3] {
        match self {
            Self::X => [1.0, 0.0, 0.0],
            Self::Y => [0.0, 1.0, 0.0],
            Self::Z => [0.0, 0.0, 1.0],
        }
    }
}

/// The selected keys as the edits of the tools name them.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenKeys {
    take: TakeRef,
    keys: Vec<KeySet>,
    shapes: Vec<[f32; 2]>,
    /// Length of a frame, seconds.
    frame: f32,
    seed: u32,
    axis: TurnAxis,
    /// Another take.
    other: Option<TakeRef>,
    /// The pose that was copied last.
    pose: Option<Arc<[BonePose]>>,
    /// Millimeters in one unit of the model.
    unit: f32,
    /// Feet that smoothing holds in the contacts of the take.
    feet: Vec<BoneRef>,
}

impl ChosenKeys {
    /// Returns the selected keys of the take that is shown; `None` without any. `seed` determines noise, and `other` is the take
    /// toward which keys are blended.
    pub fn of(context: &PanelContext<'_>, seed: u32, other: Option<usize>) -> Option<Self> {
        let (selection, shown) = (context.keys.selection(), context.take()?);
        let (keys, shapes) = (selection.key_sets(shown), selection.shapes().stretches().to_vec());
        let any = !keys.is_empty() || !shapes.is_empty();
        let take = context.take_ref()?;
        any.then(|| Self {
            take,
            keys,
            shapes,
            frame: context.frame_seconds(),
            seed,
            axis: TurnAxis::default(),
            other: other.map(TakeRef::Index),
            pose: context.copied_pose.cloned(),
            unit: context.unit.millimeters(),
            feet: context.held_feet(),
        })
    }

    /// Returns them for full turns about this axis.
    #[must_use]
    pub fn about(self, axis: TurnAxis) -> Self {
        Self { axis, ..self }
    }

    fn blend(&self, toward: KeyTarget, percent: f64) -> Edit {
        let Self { take, keys, shapes, .. } = self.clone();
        let hold = match toward {
            KeyTarget::Average => self.feet.clone(),
            _ => Vec::new(),
        };
        Edit::BlendKeys(BlendKeys { take, keys, shapes, toward, factor: (percent / 100.0) as f32, hold })
    }

    fn filter(&self, filter: CurveFilter) -> Edit {
        let Self { take, keys, shapes, feet: hold, .. } = self.clone();
        Edit::FilterKeys(FilterKeys { take, keys, shapes, filter, rate: None, hold })
    }
}

/// The settings of a tool's number.
struct Number {
    unit: &'static str,
    scale: SliderScale,
    range: [f64; 2],
    snap: f64,
    /// Digits after the point.
    digits: usize,
    /// Number at which the slider rests.
    neutral: f64,
}

const PERCENT: Number = Number {
    unit: "%",
    scale: SliderScale::Linear(150.0),
    range: [-150.0, 150.0],
    snap: 10.0,
    digits: 0,
    neutral: 0.0,
};

const COUNT: Number = Number {
    unit: "×",
    scale: SliderScale::Linear(10.0),
    range: [-1000.0, 1000.0],
    snap: 1.0,
    digits: 0,
    neutral: 0.0,
};

impl InBetweenTool {
    /// All tools in the order of the panel.
    pub const ALL: &[Self] = &[
        Self::Tween,
        Self::Push,
        Self::Relax,
        Self::Neighbor,
        Self::Ease,
        Self::Rest,
        Self::Take,
        Self::Pose,
        Self::Delay,
        Self::Noise,
        Self::Gaussian,
        Self::Butterworth,
        Self::Peaks,
        Self::Reduce,
        Self::Turns,
        Self::Repeat,
        Self::RepeatOffset,
        Self::RepeatMirror,
    ];

    /// Returns its name on the screen.
    pub fn title(self) -> &'static str {
        match self {
            Self::Tween => "Tween",
            Self::Push => "Push, pull",
            Self::Relax => "Relax",
            Self::Neighbor => "To neighbor",
            Self::Ease => "Ease",
            Self::Rest => "To rest pose",
            Self::Take => "To take",
            Self::Pose => "To pose",
            Self::Delay => "Delay",
            Self::Noise => "Noise",
            Self::Gaussian => "Smooth",
            Self::Butterworth => "Low-pass",
            Self::Peaks => "Peaks",
            Self::Reduce => "Reduce",
            Self::Turns => "Full turns",
            Self::Repeat => "Repeat",
            Self::RepeatOffset => "Repeat on",
            Self::RepeatMirror => "Mirror",
        }
    }

    /// Returns its tooltip: what its number means.
    pub fn help(self) -> &'static str {
        match self {
            Self::Tween => {
                "Places keys between their neighbors: −100 % is the key before, 0 % halfway, 100 % the key after"
            }
            Self::Push => {
                "Exaggerates: moves keys away from the straight line between their neighbors; negative numbers flatten"
            }
            Self::Relax => {
                "Moves each key toward the average of the keys directly before and after it; negative numbers sharpen"
            }
            Self::Neighbor => "Moves keys toward the key before (negative) or the key after (positive)",
            Self::Ease => "Moves keys onto a curve with a slow start (negative) or a slow end (positive)",
            Self::Rest => "Moves keys toward the rest pose; negative numbers move them away",
            Self::Take => {
                "Moves keys toward the values of another take at the same times; negative numbers move them away"
            }
            Self::Pose => {
                "Moves keys toward the pose that was copied last, of any frame of any take; negative numbers move them away"
            }
            Self::Delay => {
                "Gives keys the values of earlier times (positive) or later times (negative); the keys stay where they are"
            }
            Self::Noise => {
                "Turns keys by up to this angle per axis at random, moves them by up to 5 mm and scales them by up to 1 % per degree"
            }
            Self::Gaussian => {
                "Smooths by a Gaussian of this width; the first and the last key of a channel stay"
            }
            Self::Butterworth => {
                "Removes movements faster than this frequency without delay (Butterworth filter of order 2)"
            }
            Self::Peaks => {
                "Replaces keys that are further from the median of 5 keys than this many deviations; smaller numbers replace more"
            }
            Self::Reduce => {
                "Removes the selected keys without which no point near any bone moves further than this; the line above shows the number of keys and the largest error"
            }
            Self::Turns => {
                "Turns this many more times around from each selected rotation key to the next; keys are inserted. Keys of the same rotation turn about the chosen axis"
            }
            Self::Repeat => {
                "Repeats the selected keys this many times after them; negative numbers before them (cycle)"
            }
            Self::RepeatOffset => {
                "Repeats the selected keys, each time starting where the time before ends; negative numbers before them (cycle with offset)"
            }
            Self::RepeatMirror => {
                "Repeats the selected keys, every other time backwards; negative numbers before them (oscillate)"
            }
        }
    }

    fn number(self) -> Number {
        match self {
            Self::Tween
            | Self::Push
            | Self::Relax
            | Self::Neighbor
            | Self::Ease
            | Self::Rest
            | Self::Take
            | Self::Pose => PERCENT,
            Self::Delay => Number {
                unit: "fr",
                scale: SliderScale::Linear(10.0),
                range: [-1000.0, 1000.0],
                snap: 1.0,
                digits: 1,
                neutral: 0.0,
            },
            Self::Noise => Number {
                unit: "°",
                scale: SliderScale::Upward(20.0),
                range: [0.0, 180.0],
                snap: 1.0,
                digits: 1,
                neutral: 0.0,
            },
            Self::Gaussian => Number {
                unit: "fr",
                scale: SliderScale::Upward(10.0),
                range: [0.0, 200.0],
                snap: 0.5,
                digits: 1,
                neutral: 0.0,
            },
            Self::Butterworth => Number {
                unit: "Hz",
                scale: SliderScale::Around { middle: 6.0, factor: 10.0 },
                range: [0.01, 500.0],
                snap: 0.5,
                digits: 1,
                neutral: 6.0,
            },
            Self::Reduce => Number {
                unit: "mm",
                scale: SliderScale::Upward(10.0),
                range: [0.0, 10_000.0],
                snap: 0.5,
                digits: 2,
                neutral: 0.0,
            },
            Self::Turns => Number { range: [-100.0, 100.0], ..COUNT },
            Self::Repeat | Self::RepeatOffset | Self::RepeatMirror => COUNT,
            Self::Peaks => Number {
                unit: "σ",
                scale: SliderScale::Around { middle: 3.0, factor: 10.0 },
                range: [0.0, 1000.0],
                snap: 0.5,
                digits: 1,
                neutral: 3.0,
            },
        }
    }

    /// Returns how its number is written.
    pub(super) fn digits(self) -> Digits {
        Digits::Fixed(self.number().digits)
    }

    /// Returns the unit of its number.
    pub(super) fn unit(self) -> &'static str {
        self.number().unit
    }

    /// Returns the mapping between its number and positions of its slider.
    pub(super) fn scale(self) -> SliderScale {
        self.number().scale
    }

    /// Returns the numbers that can be typed and dragged to.
    pub(super) fn range(self) -> RangeInclusive<f64> {
        let [least, most] = self.number().range;
        least..=most
    }

    /// Returns the nearest number that is allowed.
    pub(super) fn within(self, value: f64) -> f64 {
        let [least, most] = self.number().range;
        let value = if self.is_count() { value.round() } else { value };
        between(value, least, most)
    }

    /// Whether its number is a whole number.
    fn is_count(self) -> bool {
        matches!(self, Self::Turns | Self::Repeat | Self::RepeatOffset | Self::RepeatMirror)
    }

    /// Returns the step to which a drag with Ctrl snaps.
    pub(super) fn snap(self) -> f64 {
        self.number().snap
    }

    /// Returns the number at which the slider rests.
    pub(super) fn neutral(self) -> f64 {
        self.number().neutral
    }

    /// Returns whether the slider stays where it is released: its number is a setting, not an amount.
    pub(super) fn keeps_number(self) -> bool {
        matches!(self, Self::Butterworth | Self::Peaks)
    }

    /// Returns whether keys stay as they are with this number.
    pub(super) fn changes_nothing(self, value: f64) -> bool {
        value == 0.0 && !self.keeps_number() && self != Self::Tween
    }

    /// Returns the edit that applies it; `None` where it needs another take and there is none.
    pub fn edit(self, value: f64, chosen: &ChosenKeys) -> Option<Edit> {
        let seconds = (value * f64::from(chosen.frame)) as f32;
        let amount = value.abs();
        let repeat = |mode| {
            let ChosenKeys { take, keys, .. } = chosen.clone();
            let count = |sign: f64| RepeatCount::Times((value.round() * sign).max(0.0) as u32);
            let edit = RepeatKeys { take, keys, mode, before: count(-1.0), after: count(1.0) };
            (!edit.keys.is_empty()).then_some(Edit::RepeatKeys(edit))
        };
        Some(match self {
            // No turn and no cycle leaves the keys as they are.
            Self::Reduce if value == 0.0 => chosen.blend(KeyTarget::Rest, 0.0),
            Self::Reduce => {
                let ChosenKeys { take, keys, .. } = chosen.clone();
                Edit::ReduceKeys(ReduceKeys {
                    take,
                    keys,
                    tolerance: value as f32,
                    unit: Some(chosen.unit.into()),
                })
            }
            Self::Turns | Self::Repeat | Self::RepeatOffset | Self::RepeatMirror if value.round() == 0.0 => {
                chosen.blend(KeyTarget::Rest, 0.0)
            }
            Self::Turns => {
                let ChosenKeys { take, keys, .. } = chosen.clone();
                let way = TurnWay::Full { turns: value.round() as i32, axis: chosen.axis.direction() };
                Edit::TurnKeys(TurnKeys { take, keys, way })
            }
            Self::Repeat => repeat(RepeatMode::Repeat)?,
            Self::RepeatOffset => repeat(RepeatMode::Offset)?,
            Self::RepeatMirror => repeat(RepeatMode::Mirror)?,
            Self::Tween => chosen.blend(KeyTarget::Between((0.5 + value / 200.0) as f32), 100.0),
            Self::Push => chosen.blend(KeyTarget::AwayFromLine, value),
            Self::Relax => chosen.blend(KeyTarget::Average, value),
            Self::Neighbor if value < 0.0 => chosen.blend(KeyTarget::Previous, amount),
            Self::Neighbor => chosen.blend(KeyTarget::Next, amount),
            Self::Ease if value < 0.0 => chosen.blend(KeyTarget::SlowStart, amount),
            Self::Ease => chosen.blend(KeyTarget::SlowEnd, amount),
            Self::Rest => chosen.blend(KeyTarget::Rest, value),
            Self::Take => {
                chosen.blend(KeyTarget::OtherTake { take: chosen.other.clone()?, later: 0.0 }, value)
            }
            Self::Pose => chosen.blend(KeyTarget::Pose(chosen.pose.as_deref()?.to_vec()), value),
            Self::Delay => chosen.blend(KeyTarget::Delayed(seconds), 100.0),
            Self::Noise => {
                let ChosenKeys { take, keys, shapes, seed, feet: hold, .. } = chosen.clone();
                let degrees = value as f32;
                let (translation, scale) = (degrees * 0.005, degrees * 0.01);
                Edit::NoiseKeys(NoiseKeys {
                    take,
                    keys,
                    shapes,
                    translation,
                    rotation: degrees,
                    scale,
                    frequency: 8.0,
                    seed,
                    hold,
                })
            }
            Self::Gaussian => chosen.filter(CurveFilter::Gaussian(seconds.min(10.0))),
            Self::Butterworth => chosen.filter(CurveFilter::Butterworth { cutoff: value as f32, order: 2 }),
            Self::Peaks => chosen.filter(CurveFilter::Peaks { window: 5, threshold: value as f32 }),
        })
    }
}
