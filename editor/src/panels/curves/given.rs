//! Angles that the user gave rotation keys, by a drag or a typed number. They are shown as they were given, although
//! other angles describe the same rotation, and all other keys keep the angles that they had.

use super::curve::{Curve, CurveNumbers};
use super::form::RotationForm;
use crate::panels::keys::ChannelId;
use crate::panels::properties::parts::is_same_turn;
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_document::edit::SAME_TIME;
use glam::Quat;
use std::collections::HashMap;
use std::sync::Arc;

/// The angles that were given to keys of one channel.
#[derive(Debug)]
pub struct GivenCurve {
    id: ChannelId,
    form: RotationForm,
    /// The curve as it was before; `None` if there was none.
    start: Option<Arc<Curve>>,
    /// Times and numbers of the keys that were given angles, in the order of time.
    given: Vec<(f32, CurveNumbers)>,
}

/// The angles that were given last, by channel.
#[derive(Clone, Debug, Default)]
pub struct GivenAngles {
    curves: HashMap<ChannelId, (u64, Arc<GivenCurve>)>,
    /// Number of curves that were given so far.
    count: u64,
}

impl PartialEq for GivenCurve {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl GivenCurve {
    /// Returns the angles `given` to keys at some times, in this form; `start` is the curve before.
    pub(in crate::panels) fn new(
        id: ChannelId,
        form: RotationForm,
        start: Option<Arc<Curve>>,
        mut given: Vec<(f32, CurveNumbers)>,
    ) -> Arc<Self> {
        given.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        Arc::new(Self { id, form, start, given })
    }

    /// Returns the numbers of a key if it still has the rotation that it was given, or had before.
    pub(super) fn numbers(&self, key: usize, time: f32, rotation: Quat) -> Option<CurveNumbers> {
        let at = self.given.partition_point(|(given, _)| *given < time - SAME_TIME);
        if let Some((given, numbers)) = self.given.get(at)
            && (given - time).abs() <= SAME_TIME
            && is_same_turn(self.form.rotation(*numbers).as_dquat(), rotation.as_dquat())
        {
            return Some(*numbers);
        }
        let start = self.start.as_ref()?;
        let had = |key: usize| (start.turn(key) == Some(rotation)).then(|| start.key(key));
        // Keys that were moved in time keep their places among the others.
        had(key).or_else(|| {
            let at = start.times().partition_point(|before| *before < time);
            start.times().get(at).filter(|before| **before == time).and_then(|_| had(at))
        })
    }

    /// Returns the numbers of the first key before any was given.
    pub(super) fn first(&self) -> CurveNumbers {
        self.start.as_ref().map(|start| start.key(0)).unwrap_or_default()
    }
}

impl GivenAngles {
    /// Replaces the angles of a channel.
    pub(in crate::panels) fn give(&mut self, curve: Arc<GivenCurve>) {
        self.count += 1;
        self.curves.insert(curve.id, (self.count, curve));
    }

    /// Follows the bones to another skeleton.
    pub(in crate::panels) fn shift(&mut self, shift: BoneShift) {
        let curves = std::mem::take(&mut self.curves).into_iter();
        let shifted = |((bone, property), curve)| Some(((shift.bone(bone)?, property), curve));
        self.curves = curves.filter_map(shifted).collect();
    }

    /// Forgets all angles: another take is shown.
    pub(in crate::panels) fn forget(&mut self) {
        self.curves.clear();
    }

    /// Returns the angles of a channel in this form, with a number that differs for all that were ever given.
    pub(super) fn of(&self, id: ChannelId, form: RotationForm) -> Option<(u64, &GivenCurve)> {
        let (number, curve) = self.curves.get(&id)?;
        (curve.form == form).then_some((*number, &**curve))
    }
}
