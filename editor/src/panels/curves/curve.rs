//! A channel as numbers over time, ready to be drawn: the numbers of each key, and the extents of every block of keys,
//! so that a column of pixels costs the same whether it contains one key or a thousand.

use super::form::RotationForm;
use super::given::GivenCurve;
use super::id::CurveId;
use super::shape_curves;
use crate::panels::keys::channel;
use crate::panels::keys::intervals::Intervals;
use dragonfly_anim::data::{Channel, Interpolation, Take};
use dragonfly_anim::sample::sample_channel;
use dragonfly_document::edit::Property;
use glam::{Quat, Vec3};
use std::ops::Range;
use std::sync::Arc;

/// Numbers of a key; the fourth of a vector is 0.
pub(in crate::panels) type CurveNumbers = [f32; 4];

/// The columns of a channel.
#[derive(Clone, Debug)]
enum CurveColumns {
    Vector(Channel<Vec3>),
    Turn(Channel<Quat>),
}

/// The curve of a channel.
#[derive(Clone, Debug)]
pub(in crate::panels) struct Curve {
    pub(super) id: CurveId,
    columns: CurveColumns,
    /// The weights of all shape keys that those of this one were read from.
    weights: Option<Arc<[f32]>>,
    form: RotationForm,
    /// Number of the angles that were given to its keys; 0 if there are none.
    given: u64,
    numbers: Vec<CurveNumbers>,
    /// Extents of blocks of keys; a block of each level is [`BLOCK`] blocks of the one before.
    levels: Vec<Vec<Extent>>,
    whole: bool,
}

/// Least and greatest numbers of some keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    pub(super) low: CurveNumbers,
    pub(super) high: CurveNumbers,
}

const BLOCK: usize = 16;

impl Extent {
    pub(super) const NONE: Self = Self { low: [f32::INFINITY; 4], high: [f32::NEG_INFINITY; 4] };

    pub(super) fn with(mut self, other: &Self) -> Self {
        for at in 0..4 {
            self.low[at] = self.low[at].min(other.low[at]);
            self.high[at] = self.high[at].max(other.high[at]);
        }
        self
    }

    fn of(numbers: &CurveNumbers) -> Self {
        Self { low: *numbers, high: *numbers }
    }
}

/// A key of a spline: its numbers, and their rates of change before and after it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes {
    pub(super) arrive: CurveNumbers,
    pub(super) leave: CurveNumbers,
}

impl Curve {
    /// Returns the curve of a channel, not yet computed; `None` if the channel has no keys.
    pub(super) fn new(take: &Take, id: CurveId, form: RotationForm, given: u64) -> Option<Self> {
        let mut weights = None;
        let columns = match id {
            CurveId::Bone(bone, property) => {
                let track = channel::track(take, bone)?;
                match property {
                    Property::Translation => CurveColumns::Vector(track.translation.clone()),
                    Property::Scale => CurveColumns::Vector(track.scale.clone()),
                    Property::Rotation => CurveColumns::Turn(track.rotation.clone()),
                }
            }
            CurveId::Shape { instance, shape } => {
                let track = shape_curves::track(take, instance)?;
                weights = Some(Arc::clone(&track.weights));
                CurveColumns::Vector(shape_curves::column(track, shape as usize))
            }
        };
        let (numbers, levels) = (Vec::new(), Vec::new());
        let curve = Self { id, columns, weights, form, given, numbers, levels, whole: false };
        (!curve.times().is_empty()).then_some(curve)
    }

    /// Whether the curve was made from these columns, in this form and with these given angles.
    pub(super) fn is_of(&self, take: &Take, form: RotationForm, given: u64) -> bool {
        let (bone, property) = match self.id {
            CurveId::Bone(bone, property) => (bone, property),
            CurveId::Shape { instance, .. } => {
                let track = shape_curves::track(take, instance);
                return track.zip(self.weights.as_ref()).is_some_and(|(track, weights)| {
                    Arc::ptr_eq(&track.weights, weights)
                        && Arc::as_ptr(&track.times).addr() == self.times().as_ptr().addr()
                        && track.interpolation == self.interpolation()
                });
            }
        };
        let Some(track) = channel::track(take, bone) else { return false };
        let same = |channel: &Channel<Vec3>, other: &Channel<Vec3>| {
            Arc::ptr_eq(&channel.times, &other.times)
                && Arc::ptr_eq(&channel.values, &other.values)
                && channel.interpolation == other.interpolation
        };
        match (&self.columns, property) {
            (CurveColumns::Vector(channel), Property::Translation) => same(channel, &track.translation),
            (CurveColumns::Vector(channel), Property::Scale) => same(channel, &track.scale),
            (CurveColumns::Turn(channel), _) => {
                let other = &track.rotation;
                (self.form, self.given) == (form, given)
                    && Arc::ptr_eq(&channel.times, &other.times)
                    && Arc::ptr_eq(&channel.values, &other.values)
                    && channel.interpolation == other.interpolation
            }
            _ => false,
        }
    }

    pub(super) fn times(&self) -> &[f32] {
        match &self.columns {
            CurveColumns::Vector(channel) => &channel.times,
            CurveColumns::Turn(channel) => &channel.times,
        }
    }

    pub(super) fn interpolation(&self) -> Interpolation {
        match &self.columns {
            CurveColumns::Vector(channel) => channel.interpolation,
            CurveColumns::Turn(channel) => channel.interpolation,
        }
    }

    /// Returns how many numbers a key has.
    pub(super) fn width(&self) -> usize {
        match self.id {
            CurveId::Bone(_, Property::Rotation) => self.form.numbers(),
            CurveId::Bone(..) => 3,
            CurveId::Shape { .. } => 1,
        }
    }

    /// Returns the components that are shown; `components` has a bit for each axis. A weight has no axis and is always shown.
    pub(super) fn shown(&self, components: u8) -> impl Iterator<Item = usize> + use<> {
        let components = if self.id.is_shape() { 1 } else { components };
        (0..self.width()).filter(move |at| components & (1 << at) != 0)
    }

    /// Whether the numbers of all keys are computed.
    pub(super) fn is_whole(&self) -> bool {
        self.whole
    }

    /// Computes more keys, at most `budget`, and subtracts their number from it. A key has the angles that it was given,
    /// or those nearest to the key before.
    pub(super) fn compute(&mut self, budget: &mut usize, given: Option<&GivenCurve>) {
        if self.whole {
            return;
        }
        let count = self.times().len();
        let until = (self.numbers.len() + *budget).min(count);
        *budget -= until - self.numbers.len();
        let first = || given.map(GivenCurve::first).unwrap_or_default();
        let mut near = self.numbers.last().copied().unwrap_or_else(first);
        for key in self.numbers.len()..until {
            near = match &self.columns {
                CurveColumns::Vector(channel) => vector(channel.value(key).unwrap_or_default()),
                CurveColumns::Turn(channel) => {
                    let rotation = channel.value(key).unwrap_or_default();
                    let given = given.and_then(|given| given.numbers(key, channel.times[key], rotation));
                    given.unwrap_or_else(|| self.form.of(rotation, near))
                }
            };
            self.numbers.push(near);
        }
        if self.numbers.len() == count {
            self.whole = true;
            self.levels = levels(&self.numbers);
        }
    }

    /// Returns the numbers of a key; zeros if there is none.
    pub(super) fn key(&self, key: usize) -> CurveNumbers {
        self.numbers.get(key).copied().unwrap_or_default()
    }

    /// Returns the rotation of a key; `None` if the curve is of another property.
    pub(super) fn turn(&self, key: usize) -> Option<Quat> {
        match &self.columns {
            CurveColumns::Vector(_) => None,
            CurveColumns::Turn(channel) => channel.value(key),
        }
    }

    /// Returns the numbers at a time, as the curve is drawn there: continued from the key before.
    pub(in crate::panels) fn drawn_at(&self, time: f32) -> CurveNumbers {
        /// Number of samples between the key and the time.
        const STEPS: u8 = 8;
        let key = self.times().partition_point(|&key| key <= time).saturating_sub(1);
        let from = self.times().get(key).copied().unwrap_or(time).min(time);
        (1..=STEPS).fold(self.key(key), |near, step| {
            self.at(from + (time - from) * (f32::from(step) / f32::from(STEPS)), near)
        })
    }

    /// Returns the extent of some keys.
    pub(super) fn extent(&self, keys: Range<usize>) -> Extent {
        let (mut from, mut to) = (keys.start, keys.end.min(self.numbers.len()));
        let mut found = Extent::NONE;
        let mut below: Option<&[Extent]> = None;
        // Single keys up to the border of a block, then blocks up to the border of a block of the next level, and so
        // on.
        for level in 0..=self.levels.len() {
            let at =
                |index: usize| below.map_or_else(|| Extent::of(&self.numbers[index]), |below| below[index]);
            if from >= to {
                break;
            }
            if level == self.levels.len() || to - from < 2 * BLOCK {
                for index in from..to {
                    found = found.with(&at(index));
                }
                break;
            }
            while !from.is_multiple_of(BLOCK) {
                found = found.with(&at(from));
                from += 1;
            }
            while !to.is_multiple_of(BLOCK) {
                to -= 1;
                found = found.with(&at(to));
            }
            (from, to) = (from / BLOCK, to / BLOCK);
            below = Some(&self.levels[level]);
        }
        found
    }

    /// Returns the extent of the whole curve, of a long one at its keys.
    pub(super) fn full_extent(&self) -> Extent {
        /// Number of keys above which only keys are looked at.
        const LOOKED_AT: usize = 1000;
        let keys = self.extent(0..self.times().len());
        if self.times().len() > LOOKED_AT { keys } else { keys.with(&self.extent_between_keys()) }
    }

    /// Returns the extent of the curve between its keys, where it may go beyond them.
    pub(super) fn extent_between_keys(&self) -> Extent {
        /// Number of samples between two keys.
        const STEPS: u8 = 8;
        let mut found = Extent::NONE;
        let steps = matches!(self.interpolation(), Interpolation::Step | Interpolation::Closest);
        if steps || self.is_straight() {
            return found;
        }
        for (key, times) in self.times().windows(2).enumerate() {
            let mut near = self.key(key);
            for step in 1..STEPS {
                near = self.at(times[0] + (times[1] - times[0]) * (f32::from(step) / f32::from(STEPS)), near);
                found = found.with(&Extent::of(&near));
            }
        }
        found
    }

    /// Returns the numbers at a time; of equivalent angles, those nearest to `near`.
    pub(super) fn at(&self, time: f32, near: CurveNumbers) -> CurveNumbers {
        match &self.columns {
            CurveColumns::Vector(channel) => vector(sample_channel(channel, Vec3::ZERO, time)),
            CurveColumns::Turn(channel) => self.form.of(sample_channel(channel, Quat::IDENTITY, time), near),
        }
    }

    /// Whether the curve is drawn as straight lines between keys.
    pub(super) fn is_straight(&self) -> bool {
        matches!((&self.columns, self.interpolation()), (CurveColumns::Vector(_), Interpolation::Linear))
    }

    /// Returns the rates of change of the numbers at a key of a spline.
    pub(super) fn slopes(&self, key: usize) -> Option<Slopes> {
        if self.interpolation() != Interpolation::CubicSpline {
            return None;
        }
        match &self.columns {
            CurveColumns::Vector(channel) => Some(Slopes {
                arrive: vector(*channel.values.get(key * 3)?),
                leave: vector(*channel.values.get(key * 3 + 2)?),
            }),
            CurveColumns::Turn(channel) => {
                let value = channel.value(key)?;
                let of = |rate: Quat| self.form.slopes(value, rate, self.key(key));
                Some(Slopes {
                    arrive: of(*channel.values.get(key * 3)?),
                    leave: of(*channel.values.get(key * 3 + 2)?),
                })
            }
        }
    }

    /// Returns the tangent, as edits contain it, at which the numbers of a key change by `slopes` per second.
    pub(super) fn tangent(&self, key: usize, arrive: bool, slopes: CurveNumbers) -> Option<Vec<f32>> {
        match &self.columns {
            CurveColumns::Vector(_) => Some(slopes[..3].to_vec()),
            CurveColumns::Turn(channel) => {
                let rate = *channel.values.get(key * 3 + if arrive { 0 } else { 2 })?;
                let rate = self.form.rate(channel.value(key)?, rate, self.key(key), slopes);
                Some(rate.to_array().to_vec())
            }
        }
    }

    /// Whether the key is selected, if `chosen` are the selected ones.
    pub(super) fn is_chosen(&self, key: usize, chosen: &Intervals) -> bool {
        self.times().get(key).is_some_and(|&time| chosen.holds(time))
    }

    /// Returns the form in which its rotations are shown.
    pub(super) fn form(&self) -> RotationForm {
        self.form
    }
}

fn vector(value: Vec3) -> CurveNumbers {
    [value.x, value.y, value.z, 0.0].map(|number| if number.is_finite() { number } else { 0.0 })
}

fn levels(numbers: &[CurveNumbers]) -> Vec<Vec<Extent>> {
    let mut all: Vec<Vec<Extent>> = Vec::new();
    let fold = |block: &[Extent]| block.iter().fold(Extent::NONE, |sum, next| sum.with(next));
    let mut level: Vec<Extent> = numbers
        .chunks(BLOCK)
        .map(|block| block.iter().fold(Extent::NONE, |sum, next| sum.with(&Extent::of(next))))
        .collect();
    while level.len() > 1 {
        let next = level.chunks(BLOCK).map(fold).collect();
        all.push(std::mem::replace(&mut level, next));
    }
    all.push(level);
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::{Random, seed};

    #[test]
    fn the_extent_from_blocks_equals_the_extent_of_every_key() {
        let seed = seed(9);
        let mut random = Random::new(seed);
        for count in [1, 15, 16, 17, 255, 257, 5000] {
            let numbers: Vec<CurveNumbers> =
                (0..count).map(|_| [(); 4].map(|()| random.between(-9.0, 9.0))).collect();
            let channel = Channel::<Vec3>::default();
            let curve = Curve {
                id: CurveId::Bone(0, Property::Translation),
                columns: CurveColumns::Vector(channel),
                weights: None,
                form: RotationForm::default(),
                given: 0,
                levels: levels(&numbers),
                numbers,
                whole: true,
            };
            for _ in 0..200 {
                let from = random.below(count);
                let to = from + random.below(count - from + 1);
                let slow = curve.numbers[from..to]
                    .iter()
                    .fold(Extent::NONE, |sum, next| sum.with(&Extent::of(next)));
                assert_eq!(curve.extent(from..to), slow, "seed {seed} {from}..{to} of {count}");
            }
        }
    }
}
