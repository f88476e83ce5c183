//! The text of one clip: the old one with edited rows, or a new one.

use super::super::check as code;
use super::super::clips::{M3dClip, M3dKeys};
use super::super::scan::M3dScanner;
use super::super::text::M3dText;
use crate::data::{Channel, Skeleton, Take, Track, Transform};
use crate::format::key_changes::KeyChanges;
use crate::format::key_rows::{OldRow, RowCounts, RowEdits, number, rewrite};
use crate::format::losses::Losses;
use crate::format::patch::TextPatches;
use crate::format::pose_rows::pose_rows;
use crate::format::straight::{JUMP, is_straight};
use crate::format::{AxisMap, ImportError};
use glam::Vec3;
use std::fmt::Write;

/// Writes clips in the style of a file.
pub(in super::super) struct ClipWriter<'a> {
    bytes: &'a [u8],
    skeleton: &'a Skeleton,
    /// From the space of the model to that of the file.
    to_file: AxisMap,
    line_end: &'static str,
    /// Labels of time, position, scale and rotation.
    labels: [String; 4],
}

impl<'a> ClipWriter<'a> {
    pub(super) fn new(bytes: &'a [u8], text: &M3dText, skeleton: &'a Skeleton) -> Self {
        let row = text.clips.iter().flat_map(|clip| &clip.bones).find_map(|keys| keys.rows.first());
        let labels = row.and_then(|row| labels(bytes, row.at).ok());
        Self {
            bytes,
            line_end: if bytes.contains(&b'\r') { "\r\n" } else { "\n" },
            labels: labels.unwrap_or_else(usual_labels),
            ..Self::plain(skeleton, text.conversion.axes().inverse())
        }
    }

    /// Returns a writer of clips in the style of the books.
    pub(in super::super) fn plain(skeleton: &'a Skeleton, to_file: AxisMap) -> Self {
        Self { bytes: b"", skeleton, to_file, line_end: "\n", labels: usual_labels() }
    }

    pub(super) fn line_end(&self) -> &'static str {
        self.line_end
    }

    /// Returns the name of a take in the file, where blanks are not possible, and lists what else a clip has no room for.
    pub(in super::super) fn name(
        &self,
        take: &Take,
        before: Option<&Take>,
        index: usize,
        losses: &mut Losses,
    ) -> String {
        let path = format!("/animation/takes/{index}");
        if !take.extras.is_empty() {
            let text = "layers, contacts and events are not stored";
            losses.add(format!("{path}/extras"), code::EXTRAS_NOT_STORED, text);
        }
        if !take.morphs.is_empty() {
            let text = "weights of shape keys are not stored";
            losses.add(format!("{path}/morphs"), code::MORPHS_NOT_STORED, text);
        }
        if before.is_some_and(|before| before.name == take.name) {
            return take.name.clone();
        }
        let name = possible_name(&take.name);
        if name != take.name {
            let text = format!("the take \"{}\" is called \"{name}\"", take.name);
            losses.add(format!("{path}/name"), code::NAME_NOT_STORED, text);
        }
        name
    }

    /// Returns the block of a clip with the edits of its take.
    #[expect(clippy::too_many_arguments, reason = "the clip, both takes, and where their changes are listed")]
    pub(super) fn edited(
        &mut self,
        clip: &M3dClip,
        take: &Take,
        before: &Take,
        name: &str,
        index: usize,
        changes: &mut KeyChanges,
        losses: &mut Losses,
    ) -> Vec<u8> {
        let mut patches = TextPatches::default();
        if name != before.name {
            patches.replace(clip.name.clone(), name);
            changes.take(name, "renamed");
        }
        let nothing = Track::default();
        for (bone, keys) in clip.bones.iter().enumerate() {
            let [new, old] = [take, before].map(|take| take.tracks.get(bone).unwrap_or(&nothing));
            if new.translation == old.translation && new.rotation == old.rotation && new.scale == old.scale {
                continue;
            }
            self.list_curves(new, old, index, losses);
            let counts = self.edit_keys(bone, keys, new, old, &mut patches);
            changes.keys(name, &format!("bone{bone}"), "keys", counts);
        }
        patches.apply(self.bytes, clip.block.clone())
    }

    fn edit_keys(
        &self,
        bone: usize,
        keys: &M3dKeys,
        new: &Track,
        old: &Track,
        patches: &mut TextPatches,
    ) -> RowCounts {
        let start = keys.rows.first().map_or(0.0, |row| row.time);
        let wanted = pose_rows(Some(new), &self.skeleton.bones[bone], start, JUMP);
        let wanted_times: Vec<f32> = wanted.iter().map(|row| row.time).collect();
        let times: Vec<f32> = keys.rows.iter().map(|row| row.time).collect();
        let edits = RowEdits::matched(
            &times,
            &keys.used(),
            &wanted_times,
            |row, key, number| self.edit_row(keys.rows[row].at, key, &wanted[number].pose, new, old),
            |number| self.row(wanted[number].time, wanted[number].pose),
        );
        let rows: Vec<OldRow> =
            keys.rows.iter().map(|row| OldRow { range: row.at..row.end, time: row.time }).collect();
        let separator = format!("{}\t\t", self.line_end);
        if rows.is_empty() {
            let text: String = edits.added.iter().map(|row| format!("{separator}{}", row.text)).collect();
            patches.replace(keys.open..keys.open, text);
        }
        if edits.len() != keys.rows.len() {
            patches.replace(keys.count.clone(), edits.len().to_string());
        }
        rewrite(self.bytes, &rows, edits, &separator, patches)
    }

    /// Returns the replacements in the row at `at`, which is key number `key` of the opened track.
    fn edit_row(&self, at: usize, key: usize, pose: &Transform, new: &Track, old: &Track) -> TextPatches {
        let mut patches = TextPatches::default();
        let file = self.to_file.transform(*pose);
        // Numbers of the file that the edit does not change, although a conversion would round them.
        let same = |new: Vec3, old: Option<Vec3>| old.map_or([false; 3], |old| new.cmpeq(old).into());
        let moved = same(pose.translation, old.translation.value(key));
        let scaled = same(pose.scale, old.scale.value(key));
        let is_turned = new.rotation != old.rotation && old.rotation.value(key) != Some(pose.rotation);
        let [x, y, z] = self.to_file.factors(Vec3::new(0.0, 1.0, 2.0)).to_array().map(|axis| axis as usize);
        let mut scanner = M3dScanner::new(self.bytes);
        scanner.go_to(at);
        let mut replace = |count: usize, values: &[f32], is_kept: &[bool]| -> Result<(), ImportError> {
            scanner.label("a label")?;
            for slot in 0..count {
                let token = scanner.word("a number")?;
                scanner.go_to(token.at);
                let [old] = scanner.floats("a number")?;
                if let Some(&value) =
                    values.get(slot).filter(|&&value| value != old && is_kept.get(slot) == Some(&false))
                {
                    patches.replace(token.at..token.at + token.text.len(), number(value));
                }
            }
            Ok(())
        };
        // The row was read before, so there are no errors.
        let _ = replace(1, &[], &[])
            .and_then(|()| replace(3, &file.translation.to_array(), &[moved[x], moved[y], moved[z]]))
            .and_then(|()| replace(3, &file.scale.to_array(), &[scaled[x], scaled[y], scaled[z]]))
            .and_then(|()| replace(4, &file.rotation.to_array(), &[!is_turned; 4]));
        patches
    }

    /// Returns the text of a row.
    fn row(&self, time: f32, pose: Transform) -> String {
        let [time_label, position, scale, rotation] = &self.labels;
        let file = self.to_file.transform(pose);
        let list = |numbers: &[f32]| numbers.iter().map(|&value| number(value)).collect::<Vec<_>>().join(" ");
        format!(
            "{time_label} {} {position} {} {scale} {} {rotation} {}",
            number(time),
            list(&file.translation.to_array()),
            list(&file.scale.to_array()),
            list(&file.rotation.to_array())
        )
    }

    /// Returns the block of a new clip.
    pub(in super::super) fn made(
        &self,
        take: &Take,
        name: &str,
        index: usize,
        losses: &mut Losses,
    ) -> String {
        let line = self.line_end;
        let mut text = format!("AnimationClip {name}{line}{{{line}");
        let nothing = Track::default();
        let start = take.range_of_keys().map_or(0.0, |(first, _)| first);
        for (number, bone) in self.skeleton.bones.iter().enumerate() {
            let track = take.tracks.get(number);
            self.list_curves(track.unwrap_or(&nothing), &nothing, index, losses);
            let rows = pose_rows(track, bone, start, JUMP);
            let _ = write!(text, "\tBone{number} #Keyframes: {}{line}\t{{{line}", rows.len());
            for row in rows {
                let _ = write!(text, "\t\t{}{line}", self.row(row.time, row.pose));
            }
            let _ = write!(text, "\t}}{line}{line}");
        }
        text + "}"
    }

    /// Lists edited curves that are no straight lines.
    fn list_curves(&self, new: &Track, old: &Track, take: usize, losses: &mut Losses) {
        fn is_curve<T: PartialEq>(new: &Channel<T>, old: &Channel<T>) -> bool {
            new != old && !is_straight(new)
        }
        if is_curve(&new.translation, &old.translation)
            || is_curve(&new.rotation, &old.rotation)
            || is_curve(&new.scale, &old.scale)
        {
            let path = format!("/animation/takes/{take}/tracks");
            let text = "steps and curves are stored as straight lines between more keys";
            losses.add(path, code::INTERPOLATION_NOT_STORED, text);
        }
    }
}

fn usual_labels() -> [String; 4] {
    ["Time:", "Pos:", "Scale:", "Quat:"].map(str::to_owned)
}

/// Returns the labels of a row.
fn labels(bytes: &[u8], at: usize) -> Result<[String; 4], ImportError> {
    let mut scanner = M3dScanner::new(bytes);
    scanner.go_to(at);
    let mut label = |numbers: usize| -> Result<String, ImportError> {
        let label = String::from_utf8_lossy(scanner.label("a label")?.text).into_owned();
        for _ in 0..numbers {
            scanner.floats::<1>("a number")?;
        }
        Ok(label)
    };
    Ok([label(1)?, label(3)?, label(3)?, label(4)?])
}

/// Returns a name without blanks.
pub(in super::super) fn possible_name(name: &str) -> String {
    let is_odd = |character: char| character.is_whitespace() || character.is_control();
    let name: String =
        name.trim().chars().map(|character| if is_odd(character) { '_' } else { character }).collect();
    if name.is_empty() { "take".to_owned() } else { name }
}
