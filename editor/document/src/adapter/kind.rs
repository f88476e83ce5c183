//! The three channels of a bone, each with its rule of how original and change make the result.

use crate::edit::target::Property;
use dragonfly_anim::data::{Channel, Track, Transform};
use dragonfly_anim::inbetween::KeyValue;
use dragonfly_anim::layers::{LayerRule, RotationRule, ScaleRule, TranslationRule};
use dragonfly_anim::offset::{AddedTranslation, KeyOffset, ParentRotation, ScaleFactors};
use dragonfly_anim::sample::Value;
use glam::{Quat, Vec3};

/// One number per component; the fourth of a vector is 0.
pub type ChannelNumbers = [f32; 4];

/// One of [`Property`], as a type, so that columns keep the type of their values.
pub(crate) trait ChannelKind {
    /// The value of a key.
    type Value: PartialEq + ChannelValue + KeyValue;
    /// The identity: the change that leaves the original as it is.
    const IDENTITY: ChannelNumbers;
    /// An offset of many keys.
    type Offset: KeyOffset<Value = Self::Value>;
    /// The rule by which layers change it.
    type Rule: LayerRule<Value = Self::Value>;

    fn channel(track: &Track) -> &Channel<Self::Value>;
    fn channel_mut(track: &mut Track) -> &mut Channel<Self::Value>;
    fn of(pose: &Transform) -> Self::Value;
    fn numbers(value: Self::Value) -> ChannelNumbers;
    fn value(numbers: ChannelNumbers) -> Self::Value;

    /// Returns the result of an original and a change.
    fn result(original: Self::Value, change: ChannelNumbers) -> Self::Value;
    /// Returns a tangent of the result, from the tangent of the original and the change of the value.
    fn tangent(original: Self::Value, change: ChannelNumbers) -> Self::Value;
    /// Returns the change that turns `original` into `result`; `None` where there is none.
    fn change(original: Self::Value, result: Self::Value) -> Option<ChannelNumbers>;
    /// Returns a value as a key stores it and a file that is read again has it: rotations are normalized, those of unit length stay to the bit.
    fn as_key(value: Self::Value) -> Self::Value {
        value
    }
    /// Returns `value` with the offset `on_top` of the user.
    fn offset(value: Self::Value, on_top: Self::Value) -> Self::Value;
}

pub(crate) enum TranslationChannel {}
pub(crate) enum RotationChannel {}
pub(crate) enum ScaleChannel {}

/// Calls a function that is generic over [`ChannelKind`] with the kind of a property.
macro_rules! with_kind {
    ($property:expr, $function:ident :: <K $(, $more:ty)*> ( $($argument:expr),* $(,)? )) => {
        match $property {
            $crate::edit::target::Property::Translation => {
                $function::<$crate::adapter::kind::TranslationChannel $(, $more)*>($($argument),*)
            }
            $crate::edit::target::Property::Rotation => {
                $function::<$crate::adapter::kind::RotationChannel $(, $more)*>($($argument),*)
            }
            $crate::edit::target::Property::Scale => {
                $function::<$crate::adapter::kind::ScaleChannel $(, $more)*>($($argument),*)
            }
        }
    };
}
pub(crate) use with_kind;

fn three(numbers: ChannelNumbers) -> Vec3 {
    Vec3::new(numbers[0], numbers[1], numbers[2])
}

fn four(vector: Vec3) -> ChannelNumbers {
    [vector.x, vector.y, vector.z, 0.0]
}

/// Translation: original + change.
impl ChannelKind for TranslationChannel {
    type Value = Vec3;
    const IDENTITY: ChannelNumbers = [0.0; 4];
    type Offset = AddedTranslation;
    type Rule = TranslationRule;

    fn channel(track: &Track) -> &Channel<Vec3> {
        &track.translation
    }

    fn channel_mut(track: &mut Track) -> &mut Channel<Vec3> {
        &mut track.translation
    }

    fn of(pose: &Transform) -> Vec3 {
        pose.translation
    }

    fn numbers(value: Vec3) -> ChannelNumbers {
        four(value)
    }

    fn value(numbers: ChannelNumbers) -> Vec3 {
        three(numbers)
    }

    fn result(original: Vec3, change: ChannelNumbers) -> Vec3 {
        original + three(change)
    }

    fn tangent(original: Vec3, _change: ChannelNumbers) -> Vec3 {
        original
    }

    fn change(original: Vec3, result: Vec3) -> Option<ChannelNumbers> {
        let change = [0, 1, 2].map(|axis| addend(original[axis], result[axis]));
        Some([change[0], change[1], change[2], 0.0]).filter(|change| change.iter().all(|x| x.is_finite()))
    }

    fn offset(value: Vec3, on_top: Vec3) -> Vec3 {
        value + on_top
    }
}

/// Returns the number that turns `from` into `to` when it is added; exact to the last bit where such a number exists.
fn addend(from: f32, to: f32) -> f32 {
    let guess = to - from;
    let exact = |addend: &f32| from + addend == to;
    [guess, guess.next_up(), guess.next_down()].into_iter().find(exact).unwrap_or(guess)
}

/// Normalizes a rotation as exactly as single precision allows, so that a saved file needs no sanitizing.
fn unit(rotation: Quat) -> Quat {
    rotation.as_dquat().normalize().as_quat()
}

/// Rotation: change * original, in parent space, normalized.
impl ChannelKind for RotationChannel {
    type Value = Quat;
    const IDENTITY: ChannelNumbers = [0.0, 0.0, 0.0, 1.0];
    type Offset = ParentRotation;
    type Rule = RotationRule;

    fn channel(track: &Track) -> &Channel<Quat> {
        &track.rotation
    }

    fn channel_mut(track: &mut Track) -> &mut Channel<Quat> {
        &mut track.rotation
    }

    fn of(pose: &Transform) -> Quat {
        pose.rotation
    }

    fn numbers(value: Quat) -> ChannelNumbers {
        value.to_array()
    }

    fn value(numbers: ChannelNumbers) -> Quat {
        Quat::from_array(numbers)
    }

    fn result(original: Quat, change: ChannelNumbers) -> Quat {
        unit(Quat::from_array(change) * original)
    }

    fn tangent(original: Quat, change: ChannelNumbers) -> Quat {
        // The product is linear in the original, so its tangent is multiplied in the same way.
        Quat::from_array(change) * original
    }

    fn change(original: Quat, result: Quat) -> Option<ChannelNumbers> {
        let change = result * original.conjugate();
        (change.is_finite() && change.length_squared() > 1e-12).then(|| change.normalize().to_array())
    }

    fn as_key(value: Quat) -> Quat {
        // As files are read: of unit length as far as single precision goes.
        let length = value.as_dquat().length();
        let is_unit = (length - 1.0).abs() <= f64::from(f32::EPSILON);
        if is_unit || length == 0.0 || !length.is_finite() { value } else { unit(value) }
    }

    fn offset(value: Quat, on_top: Quat) -> Quat {
        unit(on_top * value)
    }
}

/// Scale: original * change, per component.
impl ChannelKind for ScaleChannel {
    type Value = Vec3;
    const IDENTITY: ChannelNumbers = [1.0, 1.0, 1.0, 0.0];
    type Offset = ScaleFactors;
    type Rule = ScaleRule;

    fn channel(track: &Track) -> &Channel<Vec3> {
        &track.scale
    }

    fn channel_mut(track: &mut Track) -> &mut Channel<Vec3> {
        &mut track.scale
    }

    fn of(pose: &Transform) -> Vec3 {
        pose.scale
    }

    fn numbers(value: Vec3) -> ChannelNumbers {
        four(value)
    }

    fn value(numbers: ChannelNumbers) -> Vec3 {
        three(numbers)
    }

    fn result(original: Vec3, change: ChannelNumbers) -> Vec3 {
        original * three(change)
    }

    fn tangent(original: Vec3, change: ChannelNumbers) -> Vec3 {
        original * three(change)
    }

    fn change(original: Vec3, result: Vec3) -> Option<ChannelNumbers> {
        let mut change = Self::IDENTITY;
        for axis in 0..3 {
            change[axis] = factor(original[axis], result[axis])?;
        }
        Some(change)
    }

    fn offset(value: Vec3, on_top: Vec3) -> Vec3 {
        value * on_top
    }
}

/// Returns the factor that turns `from` into `to`; exact to the last bit where such a factor exists. `None` where no
/// finite factor does.
fn factor(from: f32, to: f32) -> Option<f32> {
    if from == to {
        return Some(1.0);
    }
    let guess = to / from;
    let exact = |factor: &f32| from * factor == to;
    let best = [guess, guess.next_up(), guess.next_down()].into_iter().find(exact).unwrap_or(guess);
    // No factor turns zero into another number.
    (best.is_finite() && from != 0.0).then_some(best)
}

/// A channel of any of the three kinds.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum AnyChannel {
    /// Translation or scale.
    Vector(Channel<Vec3>),
    /// Rotation.
    Turn(Channel<Quat>),
}

/// A value type of [`AnyChannel`].
pub(crate) trait ChannelValue: Value {
    fn wrap(channel: Channel<Self>) -> AnyChannel;
    fn unwrap(channel: &AnyChannel) -> Option<&Channel<Self>>;
}

impl ChannelValue for Vec3 {
    fn wrap(channel: Channel<Self>) -> AnyChannel {
        AnyChannel::Vector(channel)
    }

    fn unwrap(channel: &AnyChannel) -> Option<&Channel<Self>> {
        if let AnyChannel::Vector(channel) = channel { Some(channel) } else { None }
    }
}

impl ChannelValue for Quat {
    fn wrap(channel: Channel<Self>) -> AnyChannel {
        AnyChannel::Turn(channel)
    }

    fn unwrap(channel: &AnyChannel) -> Option<&Channel<Self>> {
        if let AnyChannel::Turn(channel) = channel { Some(channel) } else { None }
    }
}

impl AnyChannel {
    /// Changes the rotations of keys, not those of tangents, to what [`ChannelKind::as_key`] returns for them.
    pub(crate) fn make_keys(&mut self) {
        let Self::Turn(channel) = self else { return };
        let step = channel.values_per_key();
        let is_kept = |value: &Quat| RotationChannel::as_key(*value) == *value;
        if channel.values.iter().skip(step / 2).step_by(step).all(is_kept) {
            return;
        }
        let values = channel.values.iter().enumerate();
        let made = values
            .map(|(at, &value)| if at % step == step / 2 { RotationChannel::as_key(value) } else { value });
        channel.values = made.collect();
    }
}

impl Property {
    /// The identity: the change that leaves the original as it is.
    pub(crate) fn identity(self) -> ChannelNumbers {
        match self {
            Self::Translation => TranslationChannel::IDENTITY,
            Self::Rotation => RotationChannel::IDENTITY,
            Self::Scale => ScaleChannel::IDENTITY,
        }
    }
}
