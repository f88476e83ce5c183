//! Edits of one list of keys.

use super::super::animation::XKeys;
use super::super::key_text::{FileKeys, KeyText, decimal};
use super::super::lexer::XLexer;
use super::super::take::{seconds, used_rows};
use crate::data::{Bone, Track, Transform};
use crate::format::Conversion;
use crate::format::key_rows::{OldRow, RowCounts, RowEdits, rewrite};
use crate::format::patch::TextPatches;
use crate::format::pose_rows::{PoseRow, pose_rows};

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
            if old.values.get(key) != Some(&new.values[number]) {
                self.edit_row(list, row, &new.values[number], |new, old| new != old, &mut patches);
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
        let wanted: Vec<PoseRow> = pose_rows(Some(new), bone, start);
        let times: Vec<f32> = wanted.iter().map(|row| row.time).collect();
        let edit = |row: usize, key: usize, number: usize| {
            let mut patches = TextPatches::default();
            let pose = wanted[number].pose;
            let Some(before) = pose_of(old, key).filter(|before| *before != pose) else { return patches };
            let values = self.keys.matrix(pose);
            let scale = values[..12].iter().fold(0.0_f32, |largest, value| largest.max(value.abs()));
            let is_moved_only = (before.rotation, before.scale) == (pose.rotation, pose.scale);
            let length = values[12..].iter().fold(0.0_f32, |largest, value| largest.max(value.abs()));
            self.edit_slots(
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
        let edits = RowEdits::matched(&times, &used, wanted, edit, make);
        if edits.len() != rows.len() {
            patches.replace(list.count.clone(), edits.len().to_string());
        }
        let separator = format!(";;,{}   ", self.keys.line_end);
        rewrite(self.bytes, &rows, edits, &separator, patches)
    }

    fn edit_row(
        &self,
        list: &XKeys,
        row: usize,
        values: &[f32],
        differs: impl Fn(f32, f32) -> bool,
        patches: &mut TextPatches,
    ) {
        self.edit_slots(list, row, values, |_, new, old| differs(new, old), patches);
    }

    /// Replaces the numbers of a row that differ.
    fn edit_slots(
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
