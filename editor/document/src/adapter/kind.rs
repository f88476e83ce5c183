//! The three channels of a bone, each with its own rule of how original and change make the result.

use super::super::edit::Property;
use dragonfly_anim::data::{Channel, Track, Transform};
use dragonfly_anim::sample::Value;
use glam::{Quat, Vec3};

/// A number a component; a vector's fourth is 0.
pub type Numbers = [f32; 4];

/// One of [`Property`], as a type, so that columns keep the type of their values.
pub(super) trait Kind {
    /// What a key holds.
    type Value: PartialEq + Held;
    /// The change that changes nothing.
    const IDENTITY: Numbers;

    fn channel(track: &Track) -> &Channel<Self::Value>;
    fn channel_mut(track: &mut Track) -> &mut Channel<Self::Value>;
    fn of(pose: &Transform) -> Self::Value;
    fn numbers(value: Self::Value) -> Numbers;
    fn value(numbers: Numbers) -> Self::Value;

    /// original + change = result (the design's rule for this channel).
    fn result(original: Self::Value, change: Numbers) -> Self::Value;
    /// The same for a tangent of the original: what the rule does to a small difference.
    fn tangent(original: Self::Value, change: Numbers) -> Self::Value;
    /// The change that leads from one to the other; `None` where there is none.
    fn change(original: Self::Value, result: Self::Value) -> Option<Numbers>;
    /// A value between keys as a key may hold it.
    fn as_key(value: Self::Value) -> Self::Value {
        value
    }
    /// `on_top` applied to `value` (an offset of the person's).
    fn offset(value: Self::Value, on_top: Self::Value) -> Self::Value;
}

pub(super) enum Translation {}
pub(super) enum Rotation {}
pub(super) enum Scale {}

/// Calls a function that is generic over [`Kind`] with the kind of a property.
macro_rules! with_kind {
    ($property:expr, $function:ident :: <K $(, $more:ty)*> ( $($argument:expr),* $(,)? )) => {
        match $property {
            $crate::edit::Property::Translation => {
                $function::<$crate::adapter::kind::Translation $(, $more)*>($($argument),*)
            }
            $crate::edit::Property::Rotation => {
                $function::<$crate::adapter::kind::Rotation $(, $more)*>($($argument),*)
            }
            $crate::edit::Property::Scale => {
                $function::<$crate::adapter::kind::Scale $(, $more)*>($($argument),*)
            }
        }
    };
}
pub(super) use with_kind;

fn three(numbers: Numbers) -> Vec3 {
    Vec3::new(numbers[0], numbers[1], numbers[2])
}

fn four(vector: Vec3) -> Numbers {
    [vector.x, vector.y, vector.z, 0.0]
}

/// Translation: original + change.
impl Kind for Translation {
    type Value = Vec3;
    const IDENTITY: Numbers = [0.0; 4];

    fn channel(track: &Track) -> &Channel<Vec3> {
        &track.translation
    }

    fn channel_mut(track: &mut Track) -> &mut Channel<Vec3> {
        &mut track.translation
    }

    fn of(pose: &Transform) -> Vec3 {
        pose.translation
    }

    fn numbers(value: Vec3) -> Numbers {
        four(value)
    }

    fn value(numbers: Numbers) -> Vec3 {
        three(numbers)
    }

    fn result(original: Vec3, change: Numbers) -> Vec3 {
        original + three(change)
    }

    fn tangent(original: Vec3, _change: Numbers) -> Vec3 {
        original
    }

    fn change(original: Vec3, result: Vec3) -> Option<Numbers> {
        let change = [0, 1, 2].map(|axis| addend(original[axis], result[axis]));
        Some([change[0], change[1], change[2], 0.0]).filter(|change| change.iter().all(|x| x.is_finite()))
    }

    fn offset(value: Vec3, on_top: Vec3) -> Vec3 {
        value + on_top
    }
}

/// What added to `from` gives `to`, to the last bit where any number does.
fn addend(from: f32, to: f32) -> f32 {
    let guess = to - from;
    let exact = |addend: &f32| from + addend == to;
    [guess, guess.next_up(), guess.next_down()].into_iter().find(exact).unwrap_or(guess)
}

/// With length one as exactly as single precision can say it, so that reading a saved file finds nothing to mend.
fn unit(rotation: Quat) -> Quat {
    rotation.as_dquat().normalize().as_quat()
}

/// Rotation: change * original, in the space of the parent, normalised.
impl Kind for Rotation {
    type Value = Quat;
    const IDENTITY: Numbers = [0.0, 0.0, 0.0, 1.0];

    fn channel(track: &Track) -> &Channel<Quat> {
        &track.rotation
    }

    fn channel_mut(track: &mut Track) -> &mut Channel<Quat> {
        &mut track.rotation
    }

    fn of(pose: &Transform) -> Quat {
        pose.rotation
    }

    fn numbers(value: Quat) -> Numbers {
        value.to_array()
    }

    fn value(numbers: Numbers) -> Quat {
        Quat::from_array(numbers)
    }

    fn result(original: Quat, change: Numbers) -> Quat {
        unit(Quat::from_array(change) * original)
    }

    fn tangent(original: Quat, change: Numbers) -> Quat {
        // A product is linear in each factor, so a derivative goes through it.
        Quat::from_array(change) * original
    }

    fn change(original: Quat, result: Quat) -> Option<Numbers> {
        let change = result * original.conjugate();
        (change.is_finite() && change.length_squared() > 1e-12).then(|| change.normalize().to_array())
    }

    fn as_key(value: Quat) -> Quat {
        unit(value)
    }

    fn offset(value: Quat, on_top: Quat) -> Quat {
        unit(on_top * value)
    }
}

/// Scale: original * change, per component.
impl Kind for Scale {
    type Value = Vec3;
    const IDENTITY: Numbers = [1.0, 1.0, 1.0, 0.0];

    fn channel(track: &Track) -> &Channel<Vec3> {
        &track.scale
    }

    fn channel_mut(track: &mut Track) -> &mut Channel<Vec3> {
        &mut track.scale
    }

    fn of(pose: &Transform) -> Vec3 {
        pose.scale
    }

    fn numbers(value: Vec3) -> Numbers {
        four(value)
    }

    fn value(numbers: Numbers) -> Vec3 {
        three(numbers)
    }

    fn result(original: Vec3, change: Numbers) -> Vec3 {
        original * three(change)
    }

    fn tangent(original: Vec3, change: Numbers) -> Vec3 {
        original * three(change)
    }

    fn change(original: Vec3, result: Vec3) -> Option<Numbers> {
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

/// What `from` must be multiplied with to give `to`, to the last bit where any number does.
fn factor(from: f32, to: f32) -> Option<f32> {
    if from == to {
        return Some(1.0);
    }
    let guess = to / from;
    let exact = |factor: &f32| from * factor == to;
    let best = [guess, guess.next_up(), guess.next_down()].into_iter().find(exact).unwrap_or(guess);
    // From nothing no factor leads anywhere.
    (best.is_finite() && from != 0.0).then_some(best)
}

/// A channel of any of the three.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum AnyChannel {
    /// Translation or scale.
    Vector(Channel<Vec3>),
    /// Rotation.
    Turn(Channel<Quat>),
}

/// A value type that [`AnyChannel`] knows.
pub(super) trait Held: Value {
    fn wrap(channel: Channel<Self>) -> AnyChannel;
    fn unwrap(channel: &AnyChannel) -> Option<&Channel<Self>>;
}

impl Held for Vec3 {
    fn wrap(channel: Channel<Self>) -> AnyChannel {
        AnyChannel::Vector(channel)
    }

    fn unwrap(channel: &AnyChannel) -> Option<&Channel<Self>> {
        if let AnyChannel::Vector(channel) = channel { Some(channel) } else { None }
    }
}

impl Held for Quat {
    fn wrap(channel: Channel<Self>) -> AnyChannel {
        AnyChannel::Turn(channel)
    }

    fn unwrap(channel: &AnyChannel) -> Option<&Channel<Self>> {
        if let AnyChannel::Turn(channel) = channel { Some(channel) } else { None }
    }
}

impl Property {
    /// The change that changes nothing.
    pub(super) fn identity(self) -> Numbers {
        match self {
            Self::Translation => Translation::IDENTITY,
            Self::Rotation => Rotation::IDENTITY,
            Self::Scale => Scale::IDENTITY,
        }
    }
}
