//! Queries about the keys of the take shown: which bones are listed, the next key, the bounds of playback, ghosts.

use super::PanelContext;
use crate::panels::keys::{Drawn, Marker, channel};
use dragonfly_anim::data::{BoneIndex, Channel, Track};
use dragonfly_anim::lint::LintFinding;
use dragonfly_picture::between;
use std::sync::Arc;

/// A key closer to the time shown than this counts as the key at that time, and is not the next or previous one;
/// seconds.
const NEAR: f32 = 1e-4;

/// Returns whether two tracks have the same keys. Columns that they share are not compared key by key.
fn same_keys(a: &Track, b: &Track) -> bool {
    fn same<T: PartialEq>(a: &Channel<T>, b: &Channel<T>) -> bool {
        a.interpolation == b.interpolation
            && (Arc::ptr_eq(&a.times, &b.times) || a.times == b.times)
            && (Arc::ptr_eq(&a.values, &b.values) || a.values == b.values)
    }
    same(&a.translation, &b.translation) && same(&a.rotation, &b.rotation) && same(&a.scale, &b.scale)
}

impl<'a> PanelContext<'a> {
    /// Returns the keys as they are to be drawn now; `None` if no take is shown.
    pub fn drawn_keys(&self) -> Option<Drawn> {
        self.keys.drawn(self.shared_take())
    }

    /// Returns the markers of the take that is shown.
    pub fn markers(&self) -> &'a [Marker] {
        self.slot().map_or(&[], |slot| self.keys.markers().of(slot.id))
    }

    /// Returns the problems of the take that is shown.
    pub fn take_findings(&self) -> &'a [LintFinding] {
        self.shown_take().map_or(&[], |take| self.findings.of(take))
    }

    /// Returns the duration of a frame, seconds.
    pub(in crate::panels) fn frame_seconds(&self) -> f32 {
        1.0 / self.frames_per_second().max(1.0) as f32
    }

    /// Returns start and length of the take that is shown.
    pub fn take_bounds(&self) -> (f32, f32) {
        let take = || self.shown_take().map_or((0.0, 0.0), |take| (take.start, take.length));
        self.scene_bounds().unwrap_or_else(take)
    }

    /// Returns start and length of the play range, or of the whole take if there is none, seconds.
    pub fn play_bounds(&self) -> (f32, f32) {
        let (start, length) = self.take_bounds();
        match self.keys.range() {
            Some([from, to]) => {
                let inside = |time| between(time, start, start + length);
                let (from, to) = (inside(from), inside(to));
                (from, to - from)
            }
            None => (start, length),
        }
    }

    /// Returns what trimming keeps, seconds: the play range, or the whole take if none is set.
    pub(in crate::panels) fn trim_range(&self) -> [f32; 2] {
        let (start, length) = self.play_bounds();
        [start, start + length]
    }

    /// Returns whether only the selected bones are listed; if none is selected, all bones are listed.
    pub(in crate::panels) fn lists_only_selected(&self) -> bool {
        self.keys.only_selected() && self.selected().is_some()
    }

    /// Returns the bones whose keys are not those of the take in the file, ascending; `None` where bones are listed whether
    /// they are changed or not. All bones of a take that is in no file are changed.
    pub(in crate::panels) fn changed_bones(&self) -> Option<Vec<BoneIndex>> {
        if !self.keys.only_changed() {
            return None;
        }
        let (slot, shown) = (self.slot()?, self.shown_take()?);
        let opened = slot.origin.and_then(|origin| self.loaded()?.model.animation.takes.get(origin));
        let is_changed = |track: &&Track| {
            let before = opened.and_then(|take| take.tracks.get(track.bone as usize));
            before.is_none_or(|before| !same_keys(before, track))
        };
        Some(shown.tracks.iter().filter(is_changed).map(|track| track.bone).collect())
    }

    /// Returns whether the timeline lists the keys of shape keys.
    pub fn lists_shapes(&self) -> bool {
        self.keys.filter().is_empty() && self.take().is_some_and(|take| !take.morphs.is_empty())
    }

    /// Returns the name of a shape key of a mesh; nothing where the model does not have it.
    pub(in crate::panels) fn shape_name(&self, instance: u32, shape: u32) -> &'a str {
        let mesh = self.view.and_then(|view| view.shapes.mesh(instance));
        mesh.and_then(|mesh| mesh.shapes().get(shape as usize)).map_or("", String::as_str)
    }

    /// Returns the bones that the timeline lists, in the order of the tree: those with keys, of these the selected ones where
    /// only they are listed, and those whose names contain the filter.
    pub fn listed_bones(&self) -> Vec<BoneIndex> {
        let Some(take) = self.take() else { return Vec::new() };
        let only = self.lists_only_selected();
        let changed = self.changed_bones();
        let filter = self.keys.filter().to_lowercase();
        let lists = self.keys.lists(self.selection);
        let listed = |&bone: &BoneIndex| {
            (!only || lists(bone))
                && changed.as_ref().is_none_or(|changed| changed.binary_search(&bone).is_ok())
                && channel::channels(take, bone).next().is_some()
                && (filter.is_empty() || self.bone_name(bone).to_lowercase().contains(&filter))
        };
        self.digest.rows.iter().map(|row| row.bone).filter(listed).collect()
    }

    /// Returns the next key after the time shown, or the last one before it: of the selected bones, or of all.
    pub(in crate::panels) fn next_key(&self, forward: bool) -> Option<f32> {
        self.next_key_from(self.time(), forward)
    }

    /// Returns the next key after a time, or the last one before it: of the selected bones, or of all. Uses a binary search in each
    /// channel, so a large number of keys costs little.
    pub(in crate::panels) fn next_key_from(&self, now: f32, forward: bool) -> Option<f32> {
        let take = self.take()?;
        let next = |times: &[f32]| {
            if forward {
                times.get(times.partition_point(|&key| key <= now + NEAR)).copied()
            } else {
                times.partition_point(|&key| key < now - NEAR).checked_sub(1).map(|at| times[at])
            }
        };
        let of_bone =
            |bone: BoneIndex| channel::channels(take, bone).filter_map(|id| next(channel::times(take, id)));
        let nearest = |found: &mut dyn Iterator<Item = f32>| {
            found.reduce(|a, b| if (a < b) == forward { a } else { b })
        };
        if self.selected().is_some() {
            return nearest(&mut self.selection.bones().iter().flat_map(|&bone| of_bone(bone)));
        }
        let bones = take.tracks.iter().flat_map(|track| of_bone(track.bone));
        let morphs = take.morphs.iter().filter_map(|morph| next(&morph.times));
        nearest(&mut bones.chain(morphs))
    }

    /// Returns the time of the next or the previous marker.
    pub(in crate::panels) fn next_marker(&self, forward: bool) -> Option<f32> {
        let (now, mut times) = (self.time(), self.markers().iter().map(|marker| marker.time));
        if forward { times.find(|&time| time > now + NEAR) } else { times.rfind(|&time| time < now - NEAR) }
    }

    /// Computes at which times the skeleton is shown as a ghost: seconds, and the number of the ghost counted from now;
    /// negative before now. There are none during playback.
    pub fn ghost_times(&self, out: &mut Vec<(f32, i32)>) {
        out.clear();
        let ghosts = &self.settings.tools.ghosts;
        if self.take().is_none() || !ghosts.shown || self.playback.playing {
            return;
        }
        let (start, length) = self.take_bounds();
        let end = start + length;
        for (direction, count) in [(-1, ghosts.count[0]), (1, ghosts.count[1])] {
            let mut time = self.time();
            for index in 1..=count as i32 {
                time = if ghosts.keys {
                    match self.next_key_from(time, direction > 0) {
                        Some(next) if (next - time) * direction as f32 > 0.0 => next,
                        Some(_) | None => break,
                    }
                } else {
                    time + (direction * ghosts.step as i32) as f32 / self.frame_rate.max(1) as f32
                };
                if time < start - 1e-4 || time > end + 1e-4 {
                    break;
                }
                out.push((time, direction * index));
            }
        }
    }
}
