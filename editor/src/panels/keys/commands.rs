//! What the commands about keys do.

use super::drag::KeyDragOp;
use super::{KeysRequest, MarkerDeed, TimeWindow};
use crate::panels::state::{Effect, State};
use crate::panels::status::Level;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::Change;
use dragonfly_document::edit::{
    Between, BoneRef, DeleteKeys, Edit, Property, RippleKeys, SAME_TIME, SetInterpolation,
};
use std::collections::BTreeMap;

impl State {
    /// Seconds that a frame lasts.
    pub(in crate::panels) fn frame_seconds(&self) -> f32 {
        1.0 / self.settings.frame_rate.max(1) as f32
    }

    /// Deletes the selected keys.
    pub(in crate::panels) fn delete_keys(&mut self) -> Option<Effect> {
        let keys = self.keys.selection.key_sets(self.take()?);
        let take = self.take_ref()?;
        Some(Effect::Change(Change::Edit(Edit::DeleteKeys(DeleteKeys { take, keys }), None)))
    }

    /// Does to the selected keys what a drag would.
    pub(in crate::panels) fn do_keys(&mut self, op: KeyDragOp) -> Option<Effect> {
        if self.keys.drag.is_some() {
            return None;
        }
        // A first edit is always sent at once; letting go only says that it is over.
        let first = self.drag_keys(op);
        let last = self.release_keys();
        let changes: Vec<Change> = [first, last]
            .into_iter()
            .flatten()
            .flat_map(|effect| match effect {
                Effect::Change(change) => vec![change],
                Effect::Changes(changes) => changes,
                _ => Vec::new(),
            })
            .collect();
        (!changes.is_empty()).then_some(Effect::Changes(changes))
    }

    /// Copies the selected keys to the time shown; behind them where they begin there.
    pub(in crate::panels) fn duplicate_keys(&mut self) -> Option<Effect> {
        let [first, last] = self.keys.selection.extent(self.take()?)?;
        let by = self.time() - first;
        let behind = last - first + self.frame_seconds();
        self.do_keys(KeyDragOp::Duplicate(if by.abs() > SAME_TIME { by } else { behind }))
    }

    /// Scales the selected keys about the time shown.
    pub(in crate::panels) fn scale_keys(&mut self, factor: f32) -> Option<Effect> {
        let about = self.time();
        self.do_keys(KeyDragOp::Scale { about, factor })
    }

    /// Moves the selected keys by so many frames.
    pub(in crate::panels) fn nudge_keys(&mut self, frames: f32) -> Option<Effect> {
        let by = frames * self.frame_seconds();
        self.do_keys(KeyDragOp::Move(by))
    }

    /// Moves the selected keys to whole frames.
    pub(in crate::panels) fn snap_keys(&mut self) -> Option<Effect> {
        self.do_keys(KeyDragOp::Snap(self.settings.frame_rate as f32))
    }

    /// Makes room of so many frames at the time shown, or takes it away.
    pub(in crate::panels) fn ripple(&mut self, frames: f32) -> Option<Effect> {
        let (take, from) = (self.take_ref()?, self.time());
        let step = frames * self.frame_seconds();
        // Closing takes away what lies behind the time shown, so what comes after it is moved.
        let from = if frames < 0.0 { from - step } else { from };
        // Where there is no key to move the document says so.
        self.do_keys(KeyDragOp::Ripple { from, by: step }).or(Some(Effect::Change(Change::Edit(
            Edit::RippleKeys(RippleKeys { take, from, by: step }),
            None,
        ))))
    }

    /// Sets how the channels with selected keys find what lies between. Channels of different kinds are several steps.
    pub(in crate::panels) fn interpolate_keys(&mut self, between: Between) -> Option<Effect> {
        let take = self.take_ref()?;
        let mut masks: BTreeMap<BoneIndex, u8> = BTreeMap::new();
        for ((bone, property), _) in self.keys.selection.channels() {
            *masks.entry(bone).or_default() |= 1 << property as u8;
        }
        let mut groups: BTreeMap<u8, Vec<BoneRef>> = BTreeMap::new();
        for (bone, mask) in masks {
            groups.entry(mask).or_default().push(BoneRef::Index(bone));
        }
        let edits = groups.into_iter().map(|(mask, bones)| {
            Edit::SetInterpolation(SetInterpolation {
                take: take.clone(),
                bones,
                properties: Property::ALL
                    .into_iter()
                    .filter(|&property| mask & (1 << property as u8) != 0)
                    .collect(),
                interpolation: between,
            })
        });
        Some(Effect::Changes(edits.map(|edit| Change::Edit(edit, None)).collect()))
    }

    /// Puts a marker at the time shown.
    pub(in crate::panels) fn add_marker(&mut self) -> Option<Effect> {
        let time = self.time();
        let effect = self.keys_request(KeysRequest::Marker(MarkerDeed::Add(time)));
        if let Some(marker) = self.markers().iter().find(|marker| (marker.time - time).abs() < 1e-4) {
            let text = format!("{} at {time:.3} s: double click its flag to name it", marker.name);
            self.status.say(Level::Info, text);
        }
        effect
    }

    /// Goes to the marker beside.
    pub(in crate::panels) fn step_marker(&mut self, forward: bool) {
        match self.marker_beside(forward) {
            Some(time) => self.stop_at(time),
            None => self.status.say(Level::Info, "There is no marker on that side"),
        }
    }

    /// Plays what lies between the selected keys; what is in sight where none are selected.
    pub(in crate::panels) fn range_of_keys(&mut self) {
        let Some(take) = self.take() else { return };
        let window = self.keys.window(take);
        let seen = [window.start as f32, (window.start + window.length) as f32];
        let of_keys = self.keys.selection.extent(take).filter(|[from, to]| to > from);
        self.set_range(Some(of_keys.unwrap_or(seen)));
    }

    /// Plays from the time shown on, or up to it.
    pub(in crate::panels) fn range_end_here(&mut self, end: bool) {
        let (start, length) = self.take_bounds();
        let [from, to] = self.keys.range.unwrap_or([start, start + length]);
        let now = self.time();
        let range = if end { [from.min(now), now] } else { [now, to.max(now)] };
        self.set_range(Some(range));
    }

    /// Shows the selected keys, or the whole take.
    pub(in crate::panels) fn fit_keys(&mut self) {
        let Some(take) = self.take() else { return };
        let [from, to] = self.keys.selection.extent(take).unwrap_or([take.start, take.end()]);
        let (from, length) = (f64::from(from), f64::from(to - from));
        let whole = from <= f64::from(take.start) && f64::from(to) >= f64::from(take.end());
        let room = (length * 0.05).max(f64::from(self.frame_seconds()) * 2.0);
        let window = TimeWindow { start: from - room, length: length + 2.0 * room };
        self.keys.window = (!whole).then(|| window.mended());
    }
}
