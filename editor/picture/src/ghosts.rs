//! The poses of ghosts (the model at other times) that are drawn as skins: one after another in one list for the
//! device.

use super::posed::PosedModel;
use super::uniform::Affine;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::View;
use std::sync::Arc;

/// Poses of all ghosts.
#[derive(Default)]
pub struct GhostSkins {
    /// Model that is posed at one time after another; `None` before ghosts are first shown.
    posed: Option<PosedModel>,
    /// The view whose takes it has, and the bones at rest.
    of: Option<(u64, Vec<BoneIndex>)>,
    /// Times and distances of the ghosts, farthest first.
    order: Vec<(f32, i32)>,
    palettes: Vec<Affine>,
    weights: Vec<f32>,
    tints: Vec<u32>,
    /// Whether each draw item is mirrored by the pose, ghost after ghost.
    mirrored: Vec<bool>,
}

impl GhostSkins {
    /// Removes all ghosts.
    pub fn clear(&mut self) {
        self.palettes.clear();
        self.weights.clear();
        self.tints.clear();
        self.mirrored.clear();
    }

    /// Poses `view` at each of `times` (seconds, and distance from the present) of a take. `colors` are those of past
    /// and future.
    pub fn pose(
        &mut self,
        view: &View,
        still: &[BoneIndex],
        take: Option<usize>,
        times: &[(f32, i32)],
        colors: [[f32; 3]; 2],
    ) {
        self.clear();
        if times.is_empty() {
            return;
        }
        if self.posed.as_ref().is_none_or(|posed| !Arc::ptr_eq(posed.loaded(), &view.loaded)) {
            self.posed = Some(PosedModel::new(Arc::clone(&view.loaded)));
            self.of = None;
        }
        let Some(posed) = &mut self.posed else { return };
        if self.of.as_ref().is_none_or(|(generation, of)| *generation != view.generation || of != still) {
            posed.show_takes(view, still);
            self.of = Some((view.generation, still.to_vec()));
        }
        let most = times.iter().map(|(_, place)| place.unsigned_abs()).max().unwrap_or(1).max(1) as f32;
        // Farthest first, so that nearer ghosts are drawn over them.
        self.order.clear();
        self.order.extend_from_slice(times);
        self.order.sort_unstable_by_key(|&(_, place)| (std::cmp::Reverse(place.unsigned_abs()), place));
        for &(time, place) in &self.order {
            posed.pose(take, time, true);
            self.mirrored.extend(posed.items().iter().map(|item| posed.is_mirrored(item)));
            self.palettes.extend_from_slice(posed.palettes());
            self.weights.extend_from_slice(posed.weights());
            let opacity = 0.75 - 0.55 * (place.unsigned_abs() as f32 - 1.0) / most;
            self.tints.push(tint(colors[usize::from(place > 0)], opacity));
        }
    }

    /// Number of ghosts.
    pub fn len(&self) -> usize {
        self.tints.len()
    }

    /// Returns whether there are no ghosts.
    pub fn is_empty(&self) -> bool {
        self.tints.is_empty()
    }

    /// Matrices, ghost after ghost.
    pub fn palettes(&self) -> &[Affine] {
        &self.palettes
    }

    /// Morph weights, ghost after ghost.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// Tint of each ghost.
    pub fn tints(&self) -> &[u32] {
        &self.tints
    }

    /// Returns whether the pose of a ghost mirrors a draw item, so that its front faces wind the other way.
    pub fn is_mirrored(&self, ghost: usize, item: usize) -> bool {
        let items = self.posed.as_ref().map_or(0, |posed| posed.items().len());
        self.mirrored.get(ghost * items + item).copied().unwrap_or_default()
    }

    /// The model, in the pose of the last ghost.
    pub fn posed(&self) -> Option<&PosedModel> {
        self.posed.as_ref()
    }
}

/// Packs a color into four bytes, red first, as `unpack4x8unorm` reads them.
fn tint([red, green, blue]: [f32; 3], alpha: f32) -> u32 {
    let byte = |part: f32| (part.clamp(0.0, 1.0) * 255.0).round() as u8;
    u32::from_le_bytes([byte(red), byte(green), byte(blue), byte(alpha)])
}
