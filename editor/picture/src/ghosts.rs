//! The poses of ghosts (the model at other times) that are drawn as skins: one after another in one list for the
//! device.

use super::batch::DrawBatch;
use super::frustum::ViewFrustum;
use super::posed::PosedModel;
use super::uniform::{Affine, DrawInstance};
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
    /// Draw calls and instances, ghost after ghost.
    batches: Vec<DrawBatch>,
    instances: Vec<DrawInstance>,
    /// First draw call of each ghost.
    starts: Vec<usize>,
}

impl GhostSkins {
    /// Removes all ghosts.
    pub fn clear(&mut self) {
        self.palettes.clear();
        self.weights.clear();
        self.batches.clear();
        self.instances.clear();
        self.starts.clear();
    }

    /// Poses `view` at each of `times` (seconds, and distance from the present) of a take. `colors` are those of past
    /// and future. What is outside of `frustum` is left out.
    pub fn pose(
        &mut self,
        view: &View,
        still: &[BoneIndex],
        take: Option<usize>,
        times: &[(f32, i32)],
        colors: [[f32; 3]; 2],
        frustum: &ViewFrustum,
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
            posed.batch_alike(frustum);
            let opacity = 0.75 - 0.55 * (place.unsigned_abs() as f32 - 1.0) / most;
            let tint = tint(colors[usize::from(place > 0)], opacity);
            let (matrices, weights) = (self.palettes.len() as u32, self.weights.len() as u32);
            let before = self.instances.len() as u32;
            self.instances.extend(posed.batches().instances().iter().map(|instance| DrawInstance {
                palette: instance.palette + matrices,
                morph_weights: instance.morph_weights + weights,
                tint,
                ..*instance
            }));
            self.starts.push(self.batches.len());
            self.batches.extend(posed.batches().solid().iter().map(|batch| DrawBatch {
                instances: batch.instances.start + before..batch.instances.end + before,
                ..*batch
            }));
            self.palettes.extend_from_slice(posed.palettes());
            self.weights.extend_from_slice(posed.weights());
        }
    }

    /// Number of ghosts.
    pub fn len(&self) -> usize {
        self.starts.len()
    }

    /// Returns whether there are no ghosts.
    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }

    /// Matrices, ghost after ghost.
    pub fn palettes(&self) -> &[Affine] {
        &self.palettes
    }

    /// Morph weights, ghost after ghost.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// Instances of all draw calls, ghost after ghost.
    pub fn instances(&self) -> &[DrawInstance] {
        &self.instances
    }

    /// Draw calls of ghost number `ghost` and of those after it.
    pub fn batches_from(&self, ghost: usize) -> &[DrawBatch] {
        self.starts.get(ghost).map_or(&[], |&start| &self.batches[start..])
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
