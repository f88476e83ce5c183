//! The values of a base and its layers at ascending times, and how far their sum may be from a line between two of them.

use super::rule::{LayerRule, LayerSum};
use super::{LayerChannel, LayerMode};
use crate::data::{Channel, Interpolation};
use crate::sample::{KeyCursor, sample_between};

/// Samples a base and its layers at ascending times.
#[derive(Debug)]
pub(super) struct StackSampler<'a, R: LayerRule> {
    base: ChannelSampler<'a, R::Value>,
    rest: R::Value,
    layers: Vec<SampledLayer<'a, R::Value>>,
    /// The sums of all layers at the last time and at the one before, with the base first.
    ends: [Vec<LayerSum<R::Value>>; 2],
    times: [f32; 2],
}

impl<'a, R: LayerRule> StackSampler<'a, R> {
    /// Creates one before all times. `rest` is the value of a base without keys.
    pub(super) fn new(
        base: &'a Channel<R::Value>,
        layers: &[LayerChannel<'a, R::Value>],
        rest: R::Value,
    ) -> Self {
        let layers: Vec<_> = layers.iter().map(|layer| (*layer, ChannelSampler::new(layer.keys))).collect();
        let none = LayerSum { below: rest, offset: rest, weight: 0.0, part: R::IDENTITY };
        let ends = [(); 2].map(|()| vec![none; layers.len() + 1]);
        Self { base: ChannelSampler::new(base), rest, layers, ends, times: [f32::NEG_INFINITY; 2] }
    }

    /// Goes on to a later time. Returns what is seen there: the same as [`super::seen`], bit for bit.
    pub(super) fn at(&mut self, time: f32) -> R::Value {
        self.ends.swap(0, 1);
        self.times = [self.times[1], time];
        let [_, sums] = &mut self.ends;
        let mut value = self.base.at(self.rest, time);
        sums[0] = LayerSum { below: value, offset: value, weight: 1.0, part: R::IDENTITY };
        for ((layer, keys), sum) in self.layers.iter_mut().zip(&mut sums[1..]) {
            let weight = layer.settings.weight_at(time);
            let below = value;
            let (offset, part);
            match layer.settings.mode {
                LayerMode::Additive => {
                    offset = keys.at(R::IDENTITY, time);
                    part = R::part(offset, weight);
                    value = R::add(below, part);
                }
                LayerMode::Override => {
                    offset = keys.at(below, time);
                    part = R::IDENTITY;
                    value = R::mix(below, offset, weight.min(1.0));
                }
            }
            *sum = LayerSum { below, offset, weight, part };
        }
        value
    }

    /// Returns a bound of how far what is seen is from a line between the last two times, in the unit of
    /// [`LayerRule::distance`]; infinity where none is known.
    pub(super) fn bend(&self) -> f32 {
        let [before, now] = &self.ends;
        let (mut below, mut off) = ([before[0].below, now[0].below], 0.0);
        if !self.base.is_straight(self.times, below) {
            off = f32::INFINITY;
        }
        for ((layer, keys), (&from, &to)) in self.layers.iter().zip(before.iter().zip(now).skip(1)) {
            below = [from.below, to.below];
            let stays = from.weight == to.weight;
            let is_straight = keys.is_straight(self.times, [from.offset, to.offset]);
            off = match layer.settings.mode {
                LayerMode::Additive if is_straight && (stays || from.offset == to.offset) => {
                    R::bend([from, to], off)
                }
                LayerMode::Override if stays && from.weight == 0.0 => off,
                LayerMode::Override if stays && from.weight >= 1.0 && is_straight => 0.0,
                LayerMode::Override
                    if stays
                        && is_straight
                        && off == 0.0
                        && below[0] == below[1]
                        && from.offset == to.offset =>
                {
                    0.0
                }
                LayerMode::Additive | LayerMode::Override => f32::INFINITY,
            };
        }
        off
    }
}

/// A layer with the sampler of its keys.
type SampledLayer<'a, T> = (LayerChannel<'a, T>, ChannelSampler<'a, T>);

/// A channel that is sampled at ascending times.
#[derive(Debug)]
struct ChannelSampler<'a, T> {
    channel: &'a Channel<T>,
    cursor: KeyCursor,
}

impl<'a, T: crate::sample::Value + PartialEq> ChannelSampler<'a, T> {
    fn new(channel: &'a Channel<T>) -> Self {
        Self { channel, cursor: KeyCursor::default() }
    }

    fn at(&mut self, rest: T, time: f32) -> T {
        match self.cursor.find(&self.channel.times, time) {
            Some(keys) => sample_between(self.channel, rest, keys),
            None => rest,
        }
    }

    /// Returns whether the channel goes a straight way between two times without a key between them, or stays as it is.
    fn is_straight(&self, [from, to]: [f32; 2], values: [T; 2]) -> bool {
        let times = &self.channel.times;
        let is_outside =
            times.first().is_none_or(|&first| first >= to) || times.last().is_none_or(|&last| last <= from);
        is_outside
            || match self.channel.interpolation {
                Interpolation::Linear => true,
                Interpolation::Step | Interpolation::Closest => values[0] == values[1],
                Interpolation::CubicSpline => false,
            }
    }
}
