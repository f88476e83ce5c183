//! Converts drags and typed numbers of the panel into edits.
//!
//! Typed Euler angles are kept as long as the rotation equals the one that they describe, because different angles
//! can describe the same rotation.

use super::super::commands::Id;
use super::super::context::PanelContext;
use super::super::curves::curve::Curve;
use super::super::curves::form::RotationForm;
use super::super::curves::given::GivenCurve;
use super::super::curves::id::CurveId;
use super::super::curves::shown::{MOST, ShownCurves};
use super::super::number_field::FieldEvent;
use super::super::request::Request;
use super::parts::{Column, FieldNumbers, NumberForm, Pair, PosePart, is_same_turn, numbers, part, turn_of};
use super::turn;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::joint::EulerOrder;
use dragonfly_anim::sample::{rest_pose, sample_track};
use dragonfly_document::Change;
use dragonfly_document::edit::{BonePose, Property};
use dragonfly_document::history::Gesture;
use dragonfly_document::posing;
use glam::DQuat;
use std::sync::Arc;

/// Identifies the numbers of a bone: a channel, a column and a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Spot {
    /// Translation, rotation or scale.
    pub(super) property: Property,
    /// Original, change or result.
    pub(super) column: Column,
    /// Form in which they are shown.
    pub(super) form: NumberForm,
}

/// The field that is dragged, and the angles that were typed.
#[derive(Debug, Default)]
pub(super) struct FieldDrag {
    held: Option<HeldNumber>,
    /// Typed angles of the active bone.
    typed: Vec<TypedAngles>,
    /// The other selected bones in this frame; `None` for those without a pose.
    others: Vec<(BoneIndex, Option<Pair>)>,
    /// Rotations of the selected bones as the curves show them.
    curves: ShownCurves,
    /// Time shown in this frame, seconds.
    time: f32,
}

/// A field that is dragged.
#[derive(Debug)]
struct HeldNumber {
    gesture: Gesture,
    spot: Spot,
    component: usize,
    moment: Moment,
    begun: Begun,
    /// Difference to the number at the start of the drag.
    by: f64,
    /// Whether the selection, the take or the time changed, so that the drag has no effect any more.
    over: bool,
}

/// Take, time and bones of a drag; the drag ends when they change.
#[derive(Clone, Debug, PartialEq)]
struct Moment {
    take: Option<usize>,
    time: u32,
    bones: Vec<BoneIndex>,
}

/// The bones when the drag began.
#[derive(Debug)]
struct Begun {
    starts: Vec<Start>,
    /// Holds pinned bones in place.
    hold: Option<posing::PoseDragState>,
}

/// A bone when the drag began.
#[derive(Clone, Debug)]
struct Start {
    bone: BoneIndex,
    pair: Pair,
    numbers: FieldNumbers,
    /// The curve of its rotation.
    curve: Option<Arc<Curve>>,
}

/// Numbers of a rotation as they were typed.
#[derive(Clone, Copy, Debug)]
struct TypedAngles {
    bone: BoneIndex,
    column: Column,
    form: NumberForm,
    numbers: FieldNumbers,
    rotation: DQuat,
}

/// A change of one number of all selected bones.
#[derive(Clone, Copy)]
struct NumberChange {
    spot: Spot,
    component: usize,
    to: NewNumber,
}

/// The new value of a number.
#[derive(Clone, Copy)]
enum NewNumber {
    Set(f64),
    Add(f64),
}

impl FieldDrag {
    /// Begins a frame: samples the selected bones once for all fields. `in_use` is whether a field of the panel has the focus or is dragged.
    /// Returns whether the next frame has to compute more.
    pub(super) fn begin(&mut self, context: &PanelContext<'_>, in_use: bool) -> bool {
        let active = context.selected();
        self.typed
            .retain(|typed| Some(typed.bone) == active && (in_use || typed.form != NumberForm::Quaternion));
        self.others.clear();
        let others = context.selection.bones().iter().filter(|&&bone| Some(bone) != active);
        self.others.extend(others.map(|&bone| (bone, pair_of(context, bone))));
        self.time = context.time();
        let Some(take) = context.take() else { return false };
        let bones = context.selection.bones().iter().rev().take(MOST);
        let ids: Vec<_> = bones.map(|&bone| CurveId::Bone(bone, Property::Rotation)).collect();
        let form = RotationForm::Euler(context.settings.properties.euler);
        self.curves.update(take, &ids, form, context.given)
    }

    /// Returns the numbers of a bone at `spot`.
    pub(super) fn numbers(&self, bone: BoneIndex, pair: &Pair, spot: Spot) -> Option<FieldNumbers> {
        let now = match (spot.property, spot.form) {
            (Property::Rotation, NumberForm::Euler(order)) => self.angles(bone, pair, spot.column, order),
            _ => numbers(pair, spot.property, spot.column, spot.form)?,
        };
        let typed = self.typed.iter().find(|typed| {
            spot.property == Property::Rotation
                && (typed.bone, typed.column, typed.form) == (bone, spot.column, spot.form)
        });
        let fits = |typed: &&TypedAngles| {
            turn_of(spot.form, now).is_some_and(|now| is_same_turn(typed.rotation, now))
        };
        Some(typed.filter(fits).map_or(now, |typed| typed.numbers))
    }

    /// Returns the angles of a rotation: the result as the curves show it, the original nearest to it, and the change
    /// nearest to the difference of both.
    fn angles(&self, bone: BoneIndex, pair: &Pair, column: Column, order: EulerOrder) -> FieldNumbers {
        let [before, after] = [pair.original, pair.result].map(|pose| pose.rotation.as_dquat());
        let curve = self.curves.of((bone, Property::Rotation));
        let [x, y, z, _] = curve.map(|curve| curve.drawn_at(self.time)).unwrap_or_default().map(f64::from);
        let result = turn::nearest(order, after, [x, y, z]);
        let original = turn::nearest(order, before, result);
        let [x, y, z] = match column {
            Column::Original => original,
            Column::Result => result,
            Column::Change if before == after => [0.0; 3],
            Column::Change => {
                let difference = std::array::from_fn(|axis| result[axis] - original[axis]);
                turn::nearest(order, after * before.conjugate(), difference)
            }
        };
        [x, y, z, 0.0]
    }

    /// Returns whether the angles of original and change add up to those of the result.
    pub(super) fn adds_up(&self, bone: BoneIndex, pair: &Pair, order: EulerOrder) -> bool {
        let spot = |column| Spot { property: Property::Rotation, column, form: NumberForm::Euler(order) };
        let [original, change, result] =
            Column::ALL.map(|column| self.numbers(bone, pair, spot(column)).unwrap_or_default());
        (0..3).all(|axis| (original[axis] + change[axis] - result[axis]).abs() < 0.01)
    }

    /// Returns the numbers that all selected bones share at `spot`; `None` if they differ. `pair` is the active
    /// bone.
    pub(super) fn shared(&self, active: BoneIndex, pair: &Pair, spot: Spot, grain: f64) -> [Option<f64>; 4] {
        let first = self.numbers(active, pair, spot);
        let mut shared = first.map_or([None; 4], |numbers| numbers.map(Some));
        for (bone, other) in &self.others {
            if shared == [None; 4] {
                break;
            }
            let other = other.as_ref().and_then(|pair| self.numbers(*bone, pair, spot));
            for (index, number) in shared.iter_mut().enumerate() {
                let same = number.zip(other).is_some_and(|(a, other)| (a - other[index]).abs() <= grain);
                *number = number.filter(|_| same);
            }
        }
        shared
    }

    /// Applies what the user did to one number. An error is the reason why the number is impossible.
    pub(super) fn apply(
        &mut self,
        context: &PanelContext<'_>,
        spot: Spot,
        component: usize,
        event: FieldEvent,
        requests: &mut Vec<Request>,
    ) -> Result<(), &'static str> {
        match event {
            FieldEvent::Nothing | FieldEvent::Changed(_) => {}
            FieldEvent::Touched => stop(context, requests),
            FieldEvent::Dragged(by) => {
                if self.held.is_none() && !context.playback.playing && by != 0.0 {
                    self.held = Some(HeldNumber {
                        gesture: context.new_gesture(),
                        spot,
                        component,
                        moment: Moment::of(context),
                        begun: self.begun(context, spot),
                        by: 0.0,
                        over: false,
                    });
                }
                self.drag(context, spot, component, by, requests);
            }
            FieldEvent::Released => {
                if let Some(held) = self.held.take() {
                    let came_back = held.by == 0.0 && !held.over;
                    let end = if came_back { Change::Cancel } else { Change::Release };
                    requests.push(Request::Change(end(held.gesture)));
                }
            }
            FieldEvent::Cancelled => {
                if let Some(held) = self.held.take() {
                    requests.push(Request::Change(Change::Cancel(held.gesture)));
                }
            }
            FieldEvent::Typed(value) => {
                stop(context, requests);
                let mut begun = self.begun(context, spot);
                let change = NumberChange { spot, component, to: NewNumber::Set(value) };
                self.send(context, change, &mut begun, None, requests)?;
            }
        }
        Ok(())
    }

    fn drag(
        &mut self,
        context: &PanelContext<'_>,
        spot: Spot,
        component: usize,
        by: f64,
        requests: &mut Vec<Request>,
    ) {
        let Some(mut held) = self.held.take() else { return };
        held.over |= (held.spot, held.component) != (spot, component) || held.moment != Moment::of(context);
        if !held.over {
            held.by = by;
            let (begun, gesture) = (&mut held.begun, Some(held.gesture));
            // A number that is impossible is skipped during a drag.
            let change = NumberChange { spot, component, to: NewNumber::Add(by) };
            let _ = self.send(context, change, begun, gesture, requests);
        }
        self.held = Some(held);
    }

    fn begun(&self, context: &PanelContext<'_>, spot: Spot) -> Begun {
        let starts = context
            .bones_to_pose()
            .filter_map(|bone| {
                let pair = pair_of(context, bone)?;
                let curve = self.curves.of((bone, Property::Rotation)).cloned();
                Some(Start { bone, pair, numbers: self.numbers(bone, &pair, spot)?, curve })
            })
            .collect();
        Begun { starts, hold: context.hold_of_pins() }
    }

    fn send(
        &mut self,
        context: &PanelContext<'_>,
        change: NumberChange,
        begun: &mut Begun,
        gesture: Option<Gesture>,
        requests: &mut Vec<Request>,
    ) -> Result<(), &'static str> {
        let NumberChange { spot, component, to } = change;
        let mut poses: Vec<BonePose> = Vec::new();
        for start in &begun.starts {
            let mut numbers = start.numbers;
            numbers[component] = match to {
                NewNumber::Set(value) => value,
                NewNumber::Add(by) => numbers[component] + by,
            };
            let Some(part) = part(&start.pair.original, spot.property, spot.column, spot.form, numbers)
            else {
                return Err(reason(spot));
            };
            if Some(start.bone) == context.selected()
                && let Some(rotation) =
                    turn_of(spot.form, numbers).filter(|_| spot.property == Property::Rotation)
            {
                let Spot { column, form, .. } = spot;
                self.typed.retain(|typed| (typed.column, typed.form) != (column, form));
                self.typed.push(TypedAngles { bone: start.bone, column, form, numbers, rotation });
            }
            if let (Property::Rotation, Column::Result, NumberForm::Euler(order)) =
                (spot.property, spot.column, spot.form)
            {
                let (id, form) = ((start.bone, Property::Rotation), RotationForm::Euler(order));
                let given = vec![(self.time, numbers.map(|number| number as f32))];
                requests.push(Request::Angles(GivenCurve::new(id, form, start.curve.clone(), given)));
            }
            poses.push(part.pose(start.bone, spot.property));
        }
        let poses = PanelContext::with_pins(&mut begun.hold, poses);
        let edit = context.pose_edit(poses);
        requests.extend(edit.map(|edit| Request::Change(Change::Edit(edit, gesture))));
        Ok(())
    }
}

/// Returns the change that gives all selected bones other parts of their pose at the time shown, as a step of its own.
pub(super) fn set(
    context: &PanelContext<'_>,
    property: Property,
    of: impl Fn(&Pair, BoneIndex) -> Option<PosePart>,
) -> Option<Request> {
    let bones = context.bones_to_pose();
    let poses =
        bones.filter_map(|bone| Some(of(&pair_of(context, bone)?, bone)?.pose(bone, property))).collect();
    let poses = PanelContext::with_pins(&mut context.hold_of_pins(), poses);
    context.pose_edit_here(poses).map(|edit| Request::Change(Change::Edit(edit, None)))
}

impl Moment {
    fn of(context: &PanelContext<'_>) -> Self {
        let bones = context.selection.bones().to_vec();
        Self { take: context.playback.take, time: context.time().to_bits(), bones }
    }
}

/// Returns original and result of a bone at the time shown.
pub(super) fn pair_of(context: &PanelContext<'_>, bone: BoneIndex) -> Option<Pair> {
    let view = context.view?;
    let rules = view.loaded.model.animation.skeleton.bones.get(bone as usize)?;
    let result = *context.posed.animation()?.poses().get(bone as usize)?;
    let slot = context.playback.take.and_then(|take| view.slots.get(take));
    let original = match slot.and_then(|slot| slot.original.tracks.get(bone as usize)) {
        Some(track) => sample_track(track, rules, context.time()),
        None => rest_pose(rules),
    };
    Some(Pair { original, result })
}

/// Pauses playback while numbers are edited.
pub(in crate::panels) fn stop(context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    if context.playback.playing {
        let backwards = context.playback.speed < 0.0;
        requests.push(Request::Command(if backwards { Id::PlayBackwards } else { Id::PlayPause }));
    }
}

fn reason(spot: Spot) -> &'static str {
    match (spot.property, spot.column) {
        (Property::Rotation, _) => "Four zeros are not a rotation",
        (Property::Scale, Column::Change) => "The original scale is 0, which no factor can change",
        _ => "The number is too large",
    }
}
