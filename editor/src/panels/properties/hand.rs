//! What a person changes in the panel: from numbers to edits.
//!
//! An edit takes some milliseconds until it is seen in a view. Until then the panel shows what was asked for, so that a
//! field does not jump back and the next number is put on top of the last one. And three angles that were typed stay
//! those angles as long as the rotation is the one that they say: many angles say the same rotation.

use super::super::commands::Id;
use super::super::context::PanelContext;
use super::super::number_field::Heard;
use super::super::request::Request;
use super::parts::{Column, Form, Numbers, Pair, Part, is_same_turn, numbers, part, turn_of};
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::sample::{rest_pose, sample_track};
use dragonfly_document::Change;
use dragonfly_document::edit::{BonePose, BoneRef, Property};
use dragonfly_document::history::Gesture;
use dragonfly_document::posing;
use glam::DQuat;
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// As long as this it is believed that an edit that was sent will come.
const PATIENCE: Duration = Duration::from_secs(1);

/// Which numbers of a bone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Spot {
    /// Translation, rotation or scale.
    pub(super) property: Property,
    /// Original, change or result.
    pub(super) column: Column,
    /// As which numbers.
    pub(super) form: Form,
}

/// What the panel remembers of the person's hand.
#[derive(Debug, Default)]
pub(super) struct Hand {
    held: Option<Held>,
    sent: Option<Sent>,
    /// Of the active bone.
    typed: Vec<Typed>,
}

/// A field that is dragged.
#[derive(Debug)]
struct Held {
    gesture: Gesture,
    spot: Spot,
    component: usize,
    moment: Moment,
    begun: Begun,
    /// How far it is from where it began.
    by: f64,
    /// Is it about something that is not shown any more?
    over: bool,
}

/// What a drag is about; when it becomes something else, the drag is over.
#[derive(Clone, Debug, PartialEq)]
struct Moment {
    take: Option<usize>,
    time: u32,
    bones: Vec<BoneIndex>,
}

/// How everything was when the drag began.
#[derive(Debug)]
struct Begun {
    starts: Vec<Start>,
    /// Of pinned bones, which stay.
    hold: Option<posing::Hold>,
}

/// A bone as it was when the drag began.
#[derive(Clone, Copy, Debug)]
struct Start {
    bone: BoneIndex,
    pair: Pair,
    numbers: Numbers,
}

/// Poses that were asked for.
#[derive(Debug)]
struct Sent {
    take: Option<usize>,
    time: u32,
    at: Instant,
    property: Property,
    parts: HashMap<BoneIndex, Part>,
}

/// Numbers of a rotation as somebody typed them.
#[derive(Clone, Copy, Debug)]
struct Typed {
    bone: BoneIndex,
    column: Column,
    form: Form,
    numbers: Numbers,
    rotation: DQuat,
}

/// What becomes of a number.
#[derive(Clone, Copy)]
enum Way {
    Set(f64),
    Add(f64),
}

impl Hand {
    /// Begins a frame: forgets what is over. `in_use`: has a field of the panel the focus, or is it dragged?
    pub(super) fn begin(&mut self, state: &PanelContext<'_>, in_use: bool) {
        if self
            .sent
            .as_ref()
            .is_some_and(|sent| !sent.counts(state) || (self.held.is_none() && sent.came(state)))
        {
            self.sent = None;
        }
        let active = state.selected();
        self.typed.retain(|typed| Some(typed.bone) == active && (in_use || typed.form != Form::Quaternion));
    }

    /// The active bone or another one, as it was read and as it is or is asked to be.
    pub(super) fn pair(&self, state: &PanelContext<'_>, bone: BoneIndex) -> Option<Pair> {
        let mut pair = pair(state, bone)?;
        if let Some(sent) = &self.sent
            && let Some(part) = sent.parts.get(&bone)
        {
            part.put(&mut pair.result, sent.property);
        }
        Some(pair)
    }

    /// The numbers of a bone at `spot`.
    pub(super) fn numbers(&self, bone: BoneIndex, pair: &Pair, spot: Spot) -> Option<Numbers> {
        let now = numbers(pair, spot.property, spot.column, spot.form)?;
        let typed = self.typed.iter().find(|typed| {
            spot.property == Property::Rotation
                && (typed.bone, typed.column, typed.form) == (bone, spot.column, spot.form)
        });
        let fits =
            |typed: &&Typed| turn_of(spot.form, now).is_some_and(|now| is_same_turn(typed.rotation, now));
        Some(typed.filter(fits).map_or(now, |typed| typed.numbers))
    }

    /// The numbers that all selected bones have at `spot`; `None` where they differ. The active one is `pair`.
    pub(super) fn shared(
        &self,
        state: &PanelContext<'_>,
        active: BoneIndex,
        pair: &Pair,
        spot: Spot,
        grain: f64,
    ) -> [Option<f64>; 4] {
        let first = self.numbers(active, pair, spot);
        let mut shared = first.map_or([None; 4], |numbers| numbers.map(Some));
        for &bone in state.selection.bones().iter().filter(|&&bone| bone != active) {
            if shared == [None; 4] {
                break;
            }
            let other =
                self.pair(state, bone).and_then(|pair| numbers(&pair, spot.property, spot.column, spot.form));
            for (index, number) in shared.iter_mut().enumerate() {
                let same = number.zip(other).is_some_and(|(a, other)| (a - other[index]).abs() <= grain);
                *number = number.filter(|_| same);
            }
        }
        shared
    }

    /// Does what a person did to one number. An error is why it cannot be so.
    pub(super) fn hear(
        &mut self,
        state: &PanelContext<'_>,
        spot: Spot,
        component: usize,
        heard: Heard,
        requests: &mut Vec<Request>,
    ) -> Result<(), &'static str> {
        match heard {
            Heard::Nothing => {}
            Heard::Touched => stop(state, requests),
            Heard::Dragged(by) => {
                if self.held.is_none() && !state.playback.playing && by != 0.0 {
                    self.held = Some(Held {
                        gesture: state.new_gesture(),
                        spot,
                        component,
                        moment: Moment::of(state),
                        begun: self.begun(state, spot),
                        by: 0.0,
                        over: false,
                    });
                }
                self.drag(state, spot, component, by, requests);
            }
            Heard::Released => {
                if let Some(held) = self.held.take() {
                    let came_back = held.by == 0.0 && !held.over;
                    let end = if came_back { Change::Cancel } else { Change::Release };
                    requests.push(Request::Change(end(held.gesture)));
                }
            }
            Heard::Cancelled => {
                if let Some(held) = self.held.take() {
                    requests.push(Request::Change(Change::Cancel(held.gesture)));
                    self.sent = None;
                }
            }
            Heard::Typed(value) => {
                stop(state, requests);
                let mut begun = self.begun(state, spot);
                self.send(state, spot, component, &mut begun, Way::Set(value), None, requests)?;
            }
        }
        Ok(())
    }

    fn drag(
        &mut self,
        state: &PanelContext<'_>,
        spot: Spot,
        component: usize,
        by: f64,
        requests: &mut Vec<Request>,
    ) {
        let Some(mut held) = self.held.take() else { return };
        held.over |= (held.spot, held.component) != (spot, component) || held.moment != Moment::of(state);
        if !held.over {
            held.by = by;
            let (begun, gesture) = (&mut held.begun, Some(held.gesture));
            // A number that cannot be is left out on the way.
            let _ = self.send(state, spot, component, begun, Way::Add(by), gesture, requests);
        }
        self.held = Some(held);
    }

    fn begun(&self, state: &PanelContext<'_>, spot: Spot) -> Begun {
        let starts = state
            .bones_to_pose()
            .filter_map(|bone| {
                let pair = self.pair(state, bone)?;
                Some(Start { bone, pair, numbers: self.numbers(bone, &pair, spot)? })
            })
            .collect();
        Begun { starts, hold: state.hold_of_pins() }
    }

    #[expect(clippy::too_many_arguments, reason = "all of them say what is edited")]
    fn send(
        &mut self,
        state: &PanelContext<'_>,
        spot: Spot,
        component: usize,
        begun: &mut Begun,
        way: Way,
        gesture: Option<Gesture>,
        requests: &mut Vec<Request>,
    ) -> Result<(), &'static str> {
        let mut parts = HashMap::new();
        let mut poses: Vec<BonePose> = Vec::new();
        for start in &begun.starts {
            let mut numbers = start.numbers;
            numbers[component] = match way {
                Way::Set(value) => value,
                Way::Add(by) => numbers[component] + by,
            };
            let Some(part) = part(&start.pair.original, spot.property, spot.column, spot.form, numbers)
            else {
                return Err(reason(spot));
            };
            if Some(start.bone) == state.selected()
                && let Some(rotation) =
                    turn_of(spot.form, numbers).filter(|_| spot.property == Property::Rotation)
            {
                let Spot { column, form, .. } = spot;
                self.typed.retain(|typed| (typed.column, typed.form) != (column, form));
                self.typed.push(Typed { bone: start.bone, column, form, numbers, rotation });
            }
            poses.push(part.pose(start.bone, spot.property));
            parts.insert(start.bone, part);
        }
        let poses = PanelContext::with_pins(&mut begun.hold, poses);
        turn_parts(&mut parts, &poses);
        if let Some(edit) = state.pose_edit(poses) {
            requests.push(Request::Change(Change::Edit(edit, gesture)));
            self.expect(state, spot.property, parts);
        }
        Ok(())
    }

    /// Gives all selected bones other parts of their pose, as a step of its own.
    pub(super) fn set(
        &mut self,
        state: &PanelContext<'_>,
        property: Property,
        of: impl Fn(&Pair, BoneIndex) -> Option<Part>,
        requests: &mut Vec<Request>,
    ) {
        let mut parts: HashMap<BoneIndex, Part> = state
            .bones_to_pose()
            .filter_map(|bone| Some((bone, of(&self.pair(state, bone)?, bone)?)))
            .collect();
        let bones = state.bones_to_pose();
        let poses = bones.filter_map(|bone| Some(parts.get(&bone)?.pose(bone, property))).collect();
        let poses = PanelContext::with_pins(&mut state.hold_of_pins(), poses);
        turn_parts(&mut parts, &poses);
        if let Some(edit) = state.pose_edit(poses) {
            requests.push(Request::Change(Change::Edit(edit, None)));
            self.expect(state, property, parts);
        }
    }

    fn expect(&mut self, state: &PanelContext<'_>, property: Property, parts: HashMap<BoneIndex, Part>) {
        let (take, time) = (state.playback.take, state.time().to_bits());
        self.sent = Some(Sent { take, time, at: state.now, property, parts });
    }
}

/// A bone between the hand and a pin may be turned otherwise than the hand said: that is then what is asked for.
fn turn_parts(parts: &mut HashMap<BoneIndex, Part>, poses: &[BonePose]) {
    for pose in poses {
        if let (BoneRef::Index(bone), Some(rotation)) = (&pose.bone, pose.rotation)
            && let Some(Part::Turn(turn)) = parts.get_mut(bone)
        {
            *turn = glam::Quat::from_array(rotation);
        }
    }
}

impl Sent {
    /// Is it still about what is shown, and believed?
    fn counts(&self, state: &PanelContext<'_>) -> bool {
        let shown = (state.playback.take, state.time().to_bits());
        shown == (self.take, self.time) && state.now.saturating_duration_since(self.at) < PATIENCE
    }

    /// Is it there?
    fn came(&self, state: &PanelContext<'_>) -> bool {
        let here = |(&bone, part): (&BoneIndex, &Part)| {
            pair(state, bone).is_some_and(|pair| Part::of(&pair.result, self.property).is_near(*part))
        };
        self.parts.iter().all(here)
    }
}

impl Moment {
    fn of(state: &PanelContext<'_>) -> Self {
        let bones = state.selection.bones().to_vec();
        Self { take: state.playback.take, time: state.time().to_bits(), bones }
    }
}

/// A bone at the time shown.
fn pair(state: &PanelContext<'_>, bone: BoneIndex) -> Option<Pair> {
    let view = state.view?;
    let rules = view.loaded.model.animation.skeleton.bones.get(bone as usize)?;
    let result = *state.posed.animation()?.poses().get(bone as usize)?;
    let slot = state.playback.take.and_then(|take| view.slots.get(take));
    let original = match slot.and_then(|slot| slot.original.tracks.get(bone as usize)) {
        Some(track) => sample_track(track, rules, state.time()),
        None => rest_pose(rules),
    };
    Some(Pair { original, result })
}

/// Time stands while numbers are changed.
fn stop(state: &PanelContext<'_>, requests: &mut Vec<Request>) {
    if state.playback.playing {
        let backwards = state.playback.speed < 0.0;
        requests.push(Request::Command(if backwards { Id::PlayBackwards } else { Id::PlayPause }));
    }
}

fn reason(spot: Spot) -> &'static str {
    match (spot.property, spot.column) {
        (Property::Rotation, _) => "Four times 0 is no rotation",
        (Property::Scale, Column::Change) => "The original scale is 0, and no factor changes that",
        _ => "The number is too large",
    }
}
