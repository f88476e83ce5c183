//! Edits of one list of keys.

use super::super::animation::{XKeyKind, XKeys};
use super::super::key_text::{FileKeys, KeyText, decimal};
use super::super::lexer::XLexer;
use super::super::take::{seconds, used_rows};
use crate::data::{Bone, Track, Transform};
use crate::format::Conversion;
use crate::format::key_rows::{OldRow, RowCounts, RowEdits, rewrite};
use crate::format::patch::TextPatches;
use crate::format::pose_rows::{TimedPose, pose_rows};
use std::collections::HashSet;

/// Share of a number of a matrix below which it stays: what decomposing and composing rounds.
const SAME: f32 = 4e-6;

/// Edits lists of keys.
pub(super) struct ListEditor<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) keys: &'a KeyText,
    pub(super) conversion: &'a Conversion,
}

impl ListEditor<'_> {
    /// Edits the rows of a list; `old` are the keys of the opened channel.
    pub(super) fn rows(
        &self,
        list: &XKeys,
        new: &FileKeys,
        old: &FileKeys,
        patches: &mut TextPatches,
    ) -> RowCounts {
        let edit = |row: usize, key: usize, number: usize| {
            let mut patches = TextPatches::default();
            let (values, before) = (&new.values[number], old.values.get(key));
            // The importer normalizes rotations and changes their sign, so an edited one is written as a whole.
            let is_whole = list.kind == XKeyKind::Rotation;
            if before != Some(values) {
                let is_kept =
                    |slot: usize| !is_whole && before.is_some_and(|before| before[slot] == values[slot]);
                self.edit_row(list, row, values, |slot, new, old| !is_kept(slot) && new != old, &mut patches);
            }
            patches
        };
        let make = |number: usize| self.keys.row(new.times[number], &new.values[number]);
        self.rewrite(list, &new.times, edit, make, patches)
    }

    /// Edits the rows of a list of matrices.
    pub(super) fn matrices(
        &self,
        list: &XKeys,
        new: &Track,
        old: &Track,
        bone: &Bone,
        patches: &mut TextPatches,
    ) -> RowCounts {
        let start = list.rows.first().map_or(0.0, |(ticks, _)| seconds(*ticks, self.conversion));
        let wanted: Vec<TimedPose> = pose_rows(Some(new), bone, start, self.keys.jump());
        let times: Vec<f32> = wanted.iter().map(|row| row.time).collect();
        let edit = |row: usize, key: usize, number: usize| {
            let mut patches = TextPatches::default();
            let pose = wanted[number].pose;
            let Some(before) = pose_of(old, key).filter(|before| *before != pose) else { return patches };
            let values = self.keys.matrix(pose);
            let scale = values[..12].iter().fold(0.0_f32, |largest, value| largest.max(value.abs()));
            let is_moved_only = (before.rotation, before.scale) == (pose.rotation, pose.scale);
            let length = values[12..].iter().fold(0.0_f32, |largest, value| largest.max(value.abs()));
            self.edit_row(
                list,
                row,
                &values,
                |slot, new, old| match slot {
                    0..12 => !is_moved_only && (new - old).abs() > SAME * scale,
                    _ => before.translation != pose.translation && (new - old).abs() > 1e-7 * length,
                },
                &mut patches,
            );
            patches
        };
        let make = |number: usize| self.keys.row(times[number], &self.keys.matrix(wanted[number].pose));
        self.rewrite(list, &times, edit, make, patches)
    }

    fn rewrite(
        &self,
        list: &XKeys,
        wanted: &[f32],
        edit: impl FnMut(usize, usize, usize) -> TextPatches,
        make: impl FnMut(usize) -> String,
        patches: &mut TextPatches,
    ) -> RowCounts {
        let rows: Vec<OldRow> = list
            .rows
            .iter()
            .map(|(ticks, range)| OldRow { range: range.clone(), time: seconds(*ticks, self.conversion) })
            .collect();
        let times: Vec<f32> = rows.iter().map(|row| row.time).collect();
        let (used, _) = used_rows(list, self.conversion);
        let mut edits = RowEdits::matched(&times, &used, wanted, edit, make);
        // At one tick there can be one key: an old one, or the last of the new ones.
        let kept = list.rows.iter().zip(&edits.kept).filter(|(_, kept)| kept.is_some());
        let mut taken: HashSet<i64> = kept.map(|((ticks, _), _)| ticks.round() as i64).collect();
        edits.added.reverse();
        edits.added.retain(|row| taken.insert(self.keys.ticks(row.time)));
        edits.added.reverse();
        if edits.len() != rows.len() {
            patches.replace(list.count.clone(), edits.len().to_string());
        }
        let separator = format!(";;,{}   ", self.keys.line_end);
        rewrite(self.bytes, &rows, edits, &separator, patches)
    }

    /// Replaces the numbers of a row that differ.
    fn edit_row(
        &self,
        list: &XKeys,
        row: usize,
        values: &[f32],
        differs: impl Fn(usize, f32, f32) -> bool,
        patches: &mut TextPatches,
    ) {
        let mut lexer = XLexer::new(self.bytes, false, false);
        lexer.go_to(list.rows[row].1.start);
        let width = list.kind.width();
        let old = &list.values[row * width..(row + 1) * width];
        // Ticks and the number of values come first.
        for slot in 0..width + 2 {
            let Ok(Some(token)) = lexer.next() else { return };
            let Some(slot) = slot.checked_sub(2) else { continue };
            if differs(slot, values[slot], old[slot]) {
                patches.replace(token.range(), decimal(values[slot]));
            }
        }
    }
}

/// Returns the pose of a key of a track whose channels have the same times.
fn pose_of(track: &Track, key: usize) -> Option<Transform> {
    Some(Transform {
        translation: track.translation.value(key)?,
        rotation: track.rotation.value(key)?,
        scale: track.scale.value(key)?,
    })
}
