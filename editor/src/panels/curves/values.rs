//! Edits of one component of several keys, by a drag or a typed number.

use super::curve::{Curve, CurveNumbers};
use super::form::RotationForm;
use super::given::GivenCurve;
use super::id::CurveId;
use crate::panels::request::Request;
use dragonfly_document::edit::{
    BonePose, BoneRef, Edit, MeshRef, PoseAt, Property, SetPose, SetPoses, SetShapeKeys, ShapeKeyAt,
    ShapeRef, TakeRef,
};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A key with the numbers that it had when a drag began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ValueKey {
    pub(super) id: CurveId,
    pub(super) time: f32,
    pub(super) numbers: CurveNumbers,
    pub(super) form: RotationForm,
}

impl ValueKey {
    pub(super) fn of(curve: &Curve, key: usize) -> Option<Self> {
        let time = *curve.times().get(key)?;
        Some(Self { id: curve.id, time, numbers: curve.key(key), form: curve.form() })
    }

    /// Returns how many numbers the key has.
    pub(super) fn width(&self) -> usize {
        match self.id {
            CurveId::Bone(_, Property::Rotation) => self.form.numbers(),
            CurveId::Bone(..) => 3,
            CurveId::Shape { .. } => 1,
        }
    }

    /// Returns the pose that gives the key these numbers; `None` for a shape key.
    fn pose(&self, numbers: CurveNumbers) -> Option<BonePose> {
        let (bone, property) = self.id.channel()?;
        let mut pose =
            BonePose { bone: BoneRef::Index(bone), translation: None, rotation: None, scale: None };
        let vector = Some([numbers[0], numbers[1], numbers[2]]);
        match property {
            Property::Translation => pose.translation = vector,
            Property::Scale => pose.scale = vector,
            Property::Rotation => pose.rotation = Some(self.form.rotation(numbers).to_array()),
        }
        Some(pose)
    }
}

/// A change of one component of keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ValueChange {
    /// Adds this.
    Add(f32),
    /// Multiplies by this.
    Multiply(f32),
    /// Gives all keys this value.
    Set(f32),
}

impl ValueChange {
    /// Returns a number after the change.
    pub(super) fn of(self, number: f32) -> f32 {
        match self {
            Self::Add(by) => number + by,
            Self::Multiply(by) => number * by,
            Self::Set(to) => to,
        }
    }
}

/// Returns the angles that keys have after a change of one component; `curves` are the curves before.
pub(super) fn given_angles<'a>(
    curves: &'a [Arc<Curve>],
    keys: &'a [ValueKey],
    component: usize,
    change: ValueChange,
) -> impl Iterator<Item = Request> + 'a {
    let turns = curves
        .iter()
        .filter_map(|curve| Some((curve, curve.id.channel().filter(|_| curve.id.is_rotation())?)));
    turns.map(move |(curve, id)| {
        let keys = keys.iter().filter(|key| key.id == curve.id);
        let given = keys.map(|key| {
            let mut numbers = key.numbers;
            let number = &mut numbers[component.min(3)];
            *number = change.of(*number);
            (key.time, numbers)
        });
        Request::Angles(GivenCurve::new(id, curve.form(), Some(Arc::clone(curve)), given.collect()))
    })
}

/// Returns the edit that changes one component of keys; none without keys, and if a value were not finite.
pub(super) fn value_edit(
    take: TakeRef,
    keys: &[ValueKey],
    component: usize,
    change: ValueChange,
) -> Option<Edit> {
    if component > 3 || !keys.iter().all(|key| change.of(key.numbers[component]).is_finite()) {
        return None;
    }
    if keys.first().is_some_and(|key| key.id.is_shape()) {
        return Some(Edit::SetShapeKeys(SetShapeKeys { take, keys: shape_keys(keys, change) }));
    }
    let mut at: BTreeMap<u32, PoseAt> = BTreeMap::new();
    for key in keys {
        let mut numbers = key.numbers;
        numbers[component] = change.of(numbers[component]);
        let Some(pose) = key.pose(numbers) else { continue };
        let there =
            at.entry(key.time.to_bits()).or_insert_with(|| PoseAt { time: key.time, poses: Vec::new() });
        there.poses.push(pose);
    }
    let at: Vec<PoseAt> = at.into_values().collect();
    match at.len() {
        0 => None,
        // A single time is written in the simpler form of the edit.
        1 => at
            .into_iter()
            .next()
            .map(|PoseAt { time, poses }| Edit::SetPose(SetPose { take, time, poses, unstep: true })),
        _ => Some(Edit::SetPoses(SetPoses { take, at, unstep: true })),
    }
}

/// Returns the weights of keys of shape keys after a change.
fn shape_keys(keys: &[ValueKey], change: ValueChange) -> Vec<ShapeKeyAt> {
    let key = |key: &ValueKey| match key.id {
        CurveId::Bone(..) => None,
        CurveId::Shape { instance, shape } => Some(ShapeKeyAt {
            time: key.time,
            mesh: Some(MeshRef::Index(instance)),
            shape: ShapeRef::Index(shape),
            weight: Some(change.of(key.numbers[0])),
            arrive: None,
            leave: None,
        }),
    };
    keys.iter().filter_map(key).collect()
}
