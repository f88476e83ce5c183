//! The text of one animation set: the old one with edited keys, or a new one.

use super::super::animation::{XAnimation, XKeyKind, XSet};
use super::super::check as code;
use super::super::key_text::KeyText;
use super::super::scene::XScene;
use super::list::ListEditor;
use crate::data::{Bone, Skeleton, Take, Track};
use crate::format::Conversion;
use crate::format::key_changes::KeyChanges;
use crate::format::key_rows::RowCounts;
use crate::format::losses::Losses;
use crate::format::patch::TextPatches;
use crate::sample::rest_pose;
use std::collections::HashMap;
use std::ops::Range;

/// Blanks before the lines of an animation and of its lists.
const ANIMATION_INDENT: &str = " ";
const LIST_INDENT: &str = "  ";

/// Writes animation sets.
pub(super) struct SetWriter<'a> {
    bytes: &'a [u8],
    skeleton: &'a Skeleton,
    conversion: &'a Conversion,
    keys: KeyText,
    /// Name in the file of each bone that keys can refer to.
    frames: Vec<Option<&'a str>>,
    /// The bone of each such name.
    bones: HashMap<&'a str, usize>,
}

impl<'a> SetWriter<'a> {
    pub(super) fn new(
        bytes: &'a [u8],
        scene: &'a XScene,
        conversion: &'a Conversion,
        skeleton: &'a Skeleton,
    ) -> Self {
        let mut frames = vec![None; skeleton.len()];
        let mut bones = HashMap::new();
        for (index, frame) in scene.frames.iter().enumerate().take(frames.len()) {
            if !frame.name.is_empty() && !bones.contains_key(frame.name.as_str()) {
                bones.insert(frame.name.as_str(), index);
                frames[index] = Some(frame.name.as_str());
            }
        }
        let keys = KeyText {
            to_file: conversion.axes().inverse(),
            ticks_per_second: conversion.frame_rate.map_or(4800.0, |rate| f64::from(rate.value)),
            line_end: if bytes.contains(&b'\r') { "\r\n" } else { "\n" },
        };
        Self { bytes, skeleton, conversion, keys, frames, bones }
    }

    pub(super) fn line_end(&self) -> &'static str {
        self.keys.line_end
    }

    /// Returns the block of a set with the edits of its take; `takes` are the edited and the opened one.
    pub(super) fn edited(
        &self,
        set: &XSet,
        takes: [&Take; 2],
        name: &str,
        index: usize,
        changes: &mut KeyChanges,
        losses: &mut Losses,
    ) -> Vec<u8> {
        let mut patches = TextPatches::default();
        if name != takes[1].name {
            match &set.name {
                Some(place) => patches.replace(place.clone(), name),
                None => patches.replace(set.head..set.head, format!(" {name}")),
            }
            changes.take(name, "renamed");
        }
        let animations = self.animations(set);
        let nothing = Track::default();
        for (number, bone) in self.skeleton.bones.iter().enumerate() {
            let [new, old] = takes.map(|take| take.tracks.get(number).unwrap_or(&nothing));
            if new.translation == old.translation && new.rotation == old.rotation && new.scale == old.scale {
                continue;
            }
            let Some(frame) = self.frame(number, index, losses) else { continue };
            self.keys.list_losses(new, old, index, losses);
            match animations.get(&number) {
                Some(&animation) => {
                    let edit = TrackEdit { new, old, bone, animation };
                    self.edit_animation(
                        &edit,
                        |property, counts| changes.keys(name, &bone.name, property, counts),
                        &mut patches,
                    );
                }
                None => {
                    let lists = self.keys.lists(new, rest_pose(bone));
                    let text = self.keys.animation(frame, &lists, ANIMATION_INDENT);
                    insert_before_brace(
                        set.block.end,
                        &format!("{ANIMATION_INDENT}{text}"),
                        self.line_end(),
                        &mut patches,
                    );
                    let added = RowCounts { added: new.keys(), ..RowCounts::default() };
                    changes.keys(name, &bone.name, "keys", added);
                }
            }
        }
        patches.apply(self.bytes, set.block.clone())
    }

    /// Returns the animation of each bone: the first one that has keys.
    fn animations<'s>(&self, set: &'s XSet) -> HashMap<usize, &'s XAnimation> {
        let mut found: HashMap<usize, &XAnimation> = HashMap::new();
        let has_keys = |animation: &XAnimation| animation.keys.iter().any(|keys| !keys.rows.is_empty());
        for animation in &set.animations {
            let bone = animation.frame.as_deref().and_then(|frame| self.bones.get(frame));
            let Some(&bone) = bone else { continue };
            let known = found.entry(bone).or_insert(animation);
            if !has_keys(known) {
                *known = animation;
            }
        }
        found
    }

    /// Returns the name of the frame of a bone; without one its keys are listed as lost.
    fn frame(&self, bone: usize, take: usize, losses: &mut Losses) -> Option<&'a str> {
        let frame = self.frames[bone];
        if frame.is_none() {
            let name = &self.skeleton.bones[bone].name;
            let text = format!("the frame of \"{name}\" has no name of its own that keys can refer to");
            losses.add(format!("/animation/takes/{take}/tracks/{bone}"), code::BONE_NOT_STORED, text);
        }
        frame
    }

    fn edit_animation(
        &self,
        edit: &TrackEdit<'_>,
        mut changed: impl FnMut(&str, RowCounts),
        patches: &mut TextPatches,
    ) {
        let editor = ListEditor { bytes: self.bytes, keys: &self.keys, conversion: self.conversion };
        let matrices = edit.animation.of(XKeyKind::Matrix).filter(|keys| !keys.rows.is_empty());
        if let Some(keys) = matrices {
            changed("matrix", editor.matrices(keys, edit.new, edit.old, edit.bone, patches));
            return;
        }
        let rest = rest_pose(edit.bone);
        let TrackEdit { new, old, animation, .. } = *edit;
        let text = &self.keys;
        if new.rotation != old.rotation {
            let [new, old] = [&new.rotation, &old.rotation].map(|channel| {
                text.channel(XKeyKind::Rotation, channel, rest.rotation, |value| text.rotation(value))
            });
            changed("rotation", self.edit_list(animation, &editor, &new, &old, patches));
        }
        if new.scale != old.scale {
            let [new, old] = [&new.scale, &old.scale]
                .map(|channel| text.channel(XKeyKind::Scale, channel, rest.scale, |value| text.scale(value)));
            changed("scale", self.edit_list(animation, &editor, &new, &old, patches));
        }
        if new.translation != old.translation {
            let [new, old] = [&new.translation, &old.translation].map(|channel| {
                text.channel(XKeyKind::Position, channel, rest.translation, |value| text.position(value))
            });
            changed("translation", self.edit_list(animation, &editor, &new, &old, patches));
        }
    }

    /// Edits, adds or removes the list of one property.
    fn edit_list(
        &self,
        animation: &XAnimation,
        editor: &ListEditor<'_>,
        new: &super::super::key_text::FileKeys,
        old: &super::super::key_text::FileKeys,
        patches: &mut TextPatches,
    ) -> RowCounts {
        let added = RowCounts { added: new.times.len(), ..RowCounts::default() };
        match animation.of(new.kind) {
            Some(list) if new.times.is_empty() => {
                patches.replace(self.with_blanks(list.block.clone()), "");
                RowCounts { removed: list.rows.len(), ..RowCounts::default() }
            }
            Some(list) if list.rows.is_empty() => {
                patches.replace(list.block.clone(), self.keys.block(new, LIST_INDENT));
                added
            }
            Some(list) => editor.rows(list, new, old, patches),
            None => {
                let text = format!("{ANIMATION_INDENT}{}", self.keys.block(new, LIST_INDENT));
                insert_before_brace(animation.block.end, &text, self.line_end(), patches);
                added
            }
        }
    }

    /// Returns a range with the blanks before it.
    fn with_blanks(&self, range: Range<usize>) -> Range<usize> {
        let before = self.bytes[..range.start].iter().rev();
        let blanks = before.take_while(|byte| byte.is_ascii_whitespace()).count();
        range.start - blanks..range.end
    }

    /// Returns the block of a new set.
    pub(super) fn made(&self, take: &Take, name: &str, index: usize, losses: &mut Losses) -> String {
        let line = self.line_end();
        let mut text = format!("AnimationSet {name} {{{line}");
        let nothing = Track::default();
        for (number, bone) in self.skeleton.bones.iter().enumerate() {
            let Some(track) = take.tracks.get(number).filter(|track| !track.is_empty()) else { continue };
            let Some(frame) = self.frame(number, index, losses) else { continue };
            self.keys.list_losses(track, &nothing, index, losses);
            let lists = self.keys.lists(track, rest_pose(bone));
            text += ANIMATION_INDENT;
            text += &self.keys.animation(frame, &lists, ANIMATION_INDENT);
            text += line;
        }
        text + "}"
    }
}

/// An edited track, the opened one, and its animation in the file.
struct TrackEdit<'a> {
    new: &'a Track,
    old: &'a Track,
    bone: &'a Bone,
    animation: &'a XAnimation,
}

/// Inserts a block of lines before a closing brace, whose end is at `end`.
fn insert_before_brace(end: usize, text: &str, line: &str, patches: &mut TextPatches) {
    patches.replace(end - 1..end - 1, format!("{line}{text}{line}"));
}
