//! Keys of channels as curves of the file.

use super::euler::EulerAngles;
use super::node::{FbxNode, setting};
use super::preset::KeyStyle;
use super::sample::{SampledValue, rotation, sample};
use super::scene::{ObjectId, SceneWriter, ticks};
use crate::fit::{FitKind, FitValue, FittedKeys, KeyTime, fit};
use dragonfly_anim::data::{Channel, Interpolation};
use glam::{DQuat, DVec3, Quat, Vec3};
use std::convert::Infallible;

/// Largest distance in meters between a motion and its keys.
const TOLERANCE_METERS: f64 = 1e-5;

/// Largest angle between a motion and its keys: a hundredth of a degree, in radians.
const TOLERANCE_ANGLE: f64 = 0.01 * std::f64::consts::PI / 180.0;

/// Angle in radians up to which a line between two quaternions follows a rotation within 0.01°.
const FAR: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// Longest time in seconds for which a line replaces the jump at the end of a step.
const JUMP: f64 = 1.0 / 2000.0;

/// How a curve runs from key to key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum WrittenCurveKind {
    Constant,
    Linear,
    Cubic,
}

/// Keys of a few curves at the same times.
pub(super) struct CurveKeys {
    kind: WrittenCurveKind,
    /// Seconds.
    times: Vec<f64>,
    /// The values of all curves at each time.
    values: Vec<Vec<f64>>,
    /// Slopes before and after each key, per second; only of cubic curves.
    slopes: Vec<[Vec<f64>; 2]>,
    /// Whether some motion is not followed within the tolerance.
    pub(super) is_coarse: bool,
}

impl CurveKeys {
    fn new(kind: WrittenCurveKind, times: Vec<f64>, values: Vec<Vec<f64>>) -> Self {
        Self { kind, times, values, slopes: Vec::new(), is_coarse: false }
    }

    fn fitted<V>(keys: &FittedKeys<V>, numbers: impl Fn(&V) -> Vec<f64>) -> Self {
        let times = keys.times.iter().map(|&time| f64::from(time)).collect();
        let values = keys.values.iter().map(&numbers).collect();
        let slopes = keys.tangents.iter();
        let slopes: Vec<_> = slopes.map(|tangents| [0, 1].map(|side| numbers(&tangents[side]))).collect();
        let kind = if slopes.is_empty() { WrittenCurveKind::Linear } else { WrittenCurveKind::Cubic };
        Self { kind, times, values, slopes, is_coarse: keys.is_coarse }
    }

    /// Returns keys whose values hold until the next key; as lines where steps are not read.
    fn steps(times: Vec<f64>, values: Vec<Vec<f64>>, style: KeyStyle) -> Self {
        match style {
            KeyStyle::Curves => Self::new(WrittenCurveKind::Constant, times, values),
            KeyStyle::Lines | KeyStyle::Frames => {
                let (mut more, mut held) = (Vec::new(), Vec::new());
                for (key, (&time, value)) in times.iter().zip(&values).enumerate() {
                    more.push(time);
                    held.push(value.clone());
                    if let Some(&next) = times.get(key + 1) {
                        more.push(next - JUMP.min(0.5 * (next - time)));
                        held.push(value.clone());
                    }
                }
                Self::new(WrittenCurveKind::Linear, more, held)
            }
        }
    }
}

/// Returns times at which the values of a channel of closest keys change: half way between its keys, and its ends.
fn closest(times: &[f32]) -> (Vec<f64>, Vec<usize>) {
    let (mut changes, mut keys) = (Vec::new(), Vec::new());
    for (key, &time) in times.iter().enumerate() {
        let before = key.checked_sub(1).map_or(time, |before| times[before]);
        changes.push(0.5 * (f64::from(before) + f64::from(time)));
        keys.push(key);
    }
    if let (Some(&last), true) = (times.last(), times.len() > 1) {
        changes.push(f64::from(last));
        keys.push(times.len() - 1);
    }
    (changes, keys)
}

fn key_times(times: &[f32]) -> Vec<KeyTime> {
    times.iter().map(|&key| KeyTime { at: f64::from(key), key }).collect()
}

/// Returns what cannot fail.
fn certain<T>(result: Result<T, Infallible>) -> T {
    match result {
        Ok(value) => value,
        Err(never) => match never {},
    }
}

/// Returns the keys of vectors; `convert` is linear, `tolerance` in units of the model.
pub(super) fn vector_keys(
    channel: &Channel<Vec3>,
    style: KeyStyle,
    is_length: bool,
    convert: impl Fn(DVec3) -> DVec3,
) -> CurveKeys {
    let numbers = |value: &DVec3| convert(*value).to_array().to_vec();
    let value = |key: usize| numbers(&channel.value(key).unwrap_or(Vec3::ZERO).as_dvec3());
    let times: Vec<f64> = channel.times.iter().map(|&time| f64::from(time)).collect();
    let values = |keys: &mut dyn Iterator<Item = usize>| keys.map(value).collect::<Vec<_>>();
    match channel.interpolation {
        Interpolation::Step => {
            let values = values(&mut (0..times.len()));
            CurveKeys::steps(times, values, style)
        }
        Interpolation::Closest => {
            let (times, keys) = closest(&channel.times);
            CurveKeys::steps(times, values(&mut keys.into_iter()), style)
        }
        Interpolation::Linear => {
            let values = values(&mut (0..times.len()));
            CurveKeys::new(WrittenCurveKind::Linear, times, values)
        }
        Interpolation::CubicSpline if style == KeyStyle::Curves => {
            let tangent = |at: usize| numbers(&channel.values.get(at).map_or(DVec3::ZERO, |v| v.as_dvec3()));
            let slopes = (0..times.len()).map(|key| [tangent(3 * key), tangent(3 * key + 2)]).collect();
            let values = values(&mut (0..times.len()));
            CurveKeys { slopes, ..CurveKeys::new(WrittenCurveKind::Cubic, times, values) }
        }
        Interpolation::CubicSpline => {
            let mut at = |at: f64| Ok::<_, Infallible>(sample(channel, at).map(|value| value.truncate()));
            let tolerance = if is_length { TOLERANCE_METERS } else { 1e-4 };
            let keys = certain(fit(&key_times(&channel.times), FitKind::Lines, tolerance, &mut at));
            CurveKeys::fitted(&keys, numbers)
        }
    }
}

/// Returns times with more of them where a rotation is far: programs that read lines only interpolate quaternions, not angles.
fn divided_turns(channel: &Channel<Quat>, times: &[KeyTime]) -> Vec<KeyTime> {
    let smooth = matches!(channel.interpolation, Interpolation::Linear | Interpolation::CubicSpline);
    let mut divided: Vec<KeyTime> = Vec::with_capacity(times.len());
    for &time in times {
        if let Some(&last) = divided.last().filter(|_| smooth) {
            let at = |time: f64| rotation(channel, Quat::IDENTITY, time);
            let pieces = (at(last.at).distance(&at(time.at)) / FAR).ceil().clamp(1.0, 64.0);
            let inner =
                (1..pieces as u32).map(|piece| last.at + (time.at - last.at) * f64::from(piece) / pieces);
            let inner = inner.map(|at| KeyTime { at: f64::from(at as f32), key: at as f32 });
            divided.extend(inner.filter(|inner| inner.key > last.key && inner.key < time.key));
        }
        divided.push(time);
    }
    divided
}

/// Returns the keys of rotations as angles in degrees.
pub(super) fn rotation_keys(
    channel: &Channel<Quat>,
    style: KeyStyle,
    convert: impl Fn(DQuat) -> DQuat,
) -> CurveKeys {
    let numbers = |angles: &EulerAngles| angles.degrees().to_array().to_vec();
    let mut at =
        |at: f64| Ok::<_, Infallible>(Some(EulerAngles::of(convert(rotation(channel, Quat::IDENTITY, at)))));
    let mut times = key_times(&channel.times);
    if style == KeyStyle::Lines {
        times = divided_turns(channel, &times);
    }
    let kind = match (channel.interpolation, style) {
        (Interpolation::Step | Interpolation::Closest, _) => FitKind::Step,
        (Interpolation::Linear | Interpolation::CubicSpline, KeyStyle::Curves) => FitKind::Smooth,
        (Interpolation::Linear | Interpolation::CubicSpline, KeyStyle::Lines) => FitKind::Lines,
        (Interpolation::Linear | Interpolation::CubicSpline, KeyStyle::Frames) => FitKind::Given,
    };
    let keys = certain(fit(&times, kind, TOLERANCE_ANGLE, &mut at));
    let made = CurveKeys::fitted(&keys, numbers);
    match channel.interpolation {
        Interpolation::Step => CurveKeys::steps(made.times, made.values, style),
        Interpolation::Closest => {
            let (times, keys) = closest(&channel.times);
            let values = keys.into_iter().filter_map(|key| made.values.get(key).cloned()).collect();
            CurveKeys::steps(times, values, style)
        }
        Interpolation::Linear | Interpolation::CubicSpline => made,
    }
}

/// A number as a channel has it.
impl SampledValue for f32 {
    fn numbers(self) -> glam::DVec4 {
        glam::DVec4::splat(f64::from(self))
    }

    fn between(start: glam::DVec4, end: glam::DVec4, part: f64) -> glam::DVec4 {
        start * (1.0 - part) + end * part
    }
}

/// Returns the keys of the weight of one target, in percent.
pub(super) fn weight_keys(weights: &Channel<f32>, style: KeyStyle) -> CurveKeys {
    // A weight is a vector of one number.
    let values: Vec<Vec3> = weights.values.iter().map(|&weight| Vec3::new(weight, 0.0, 0.0)).collect();
    let channel =
        Channel { times: weights.times.clone(), values: values.into(), interpolation: weights.interpolation };
    let mut keys = vector_keys(&channel, style, false, |value| value * 100.0);
    keys.values.iter_mut().for_each(|values| values.truncate(1));
    keys.slopes.iter_mut().flatten().for_each(|slopes| slopes.truncate(1));
    keys
}

/// A property that curves move.
pub(super) struct AnimatedProperty<'a> {
    pub(super) object: ObjectId,
    /// Name of the property: `Lcl Rotation`.
    pub(super) property: &'a str,
    /// Name of the node of its curves: `R`.
    pub(super) name: &'a str,
    /// Names of the curves: `X`, `Y`, `Z`.
    pub(super) parts: &'a [&'a str],
}

impl AnimatedProperty<'_> {
    /// Adds the curves of the property to a layer.
    pub(super) fn add(&self, scene: &mut SceneWriter, layer: ObjectId, keys: &CurveKeys) {
        let Some(first) = keys.values.first() else { return };
        let defaults = self.parts.iter().zip(first);
        let defaults =
            defaults.map(|(part, &value)| setting(&format!("d|{part}"), "Number", "", "A").with(value));
        let properties = FbxNode::new("Properties70").containing(defaults);
        let node = scene.object("AnimationCurveNode", self.name, ("AnimCurveNode", ""), [properties]);
        scene.connect(node, layer);
        scene.connect_property(node, self.object, self.property);
        for (part, name) in self.parts.iter().enumerate() {
            let curve = scene.object("AnimationCurve", "", ("AnimCurve", ""), curve(keys, part));
            scene.connect_property(curve, node, &format!("d|{name}"));
        }
    }
}

/// Returns the content of one curve.
fn curve(keys: &CurveKeys, part: usize) -> Vec<FbxNode> {
    let value = |key: usize| keys.values.get(key).and_then(|values| values.get(part)).copied().unwrap_or(0.0);
    let slope = |key: usize, side: usize| {
        let slopes = keys.slopes.get(key).map(|slopes| &slopes[side]);
        slopes.and_then(|slopes| slopes.get(part)).copied().unwrap_or(0.0)
    };
    let count = keys.times.len();
    let is_flat =
        (0..count).all(|key| value(key) == value(0) && slope(key, 0) == 0.0 && slope(key, 1) == 0.0);
    let mut kept: Vec<usize> = Vec::with_capacity(count);
    for key in 0..count {
        // Of a curve that does not change, the first and the last key are enough.
        let is_needed = !is_flat || key == 0 || key + 1 == count;
        let is_later = kept.last().is_none_or(|&last| ticks(keys.times[last]) < ticks(keys.times[key]));
        if is_needed && is_later {
            kept.push(key);
        }
    }
    let kind =
        if is_flat && keys.kind == WrittenCurveKind::Cubic { WrittenCurveKind::Linear } else { keys.kind };
    // Weights of a third on both sides, as two numbers of 16 bits.
    let third = f32::from_bits(0x0d05_0d05);
    let (flags, data, counts) = match kind {
        WrittenCurveKind::Constant => (vec![0x2], vec![0.0, 0.0, third, 0.0], vec![kept.len() as i32]),
        WrittenCurveKind::Linear => (vec![0x4], vec![0.0, 0.0, third, 0.0], vec![kept.len() as i32]),
        WrittenCurveKind::Cubic => {
            let next = |at: usize| kept.get(at + 1).map_or(0.0, |&next| slope(next, 0));
            let rows = kept.iter().enumerate();
            let rows = rows.flat_map(|(at, &key)| [slope(key, 1) as f32, next(at) as f32, third, 0.0]);
            // Cubic, with tangents of the user that differ on both sides.
            (vec![0x8 | 0x400 | 0x800; kept.len()], rows.collect(), vec![1; kept.len()])
        }
    };
    vec![
        FbxNode::new("Default").with(value(0)),
        FbxNode::new("KeyVer").with(4009),
        FbxNode::new("KeyTime").with(kept.iter().map(|&key| ticks(keys.times[key])).collect::<Vec<i64>>()),
        FbxNode::new("KeyValueFloat").with(kept.iter().map(|&key| value(key) as f32).collect::<Vec<f32>>()),
        FbxNode::new("KeyAttrFlags").with(flags),
        FbxNode::new("KeyAttrDataFloat").with(data),
        FbxNode::new("KeyAttrRefCount").with(counts),
    ]
}
