//! The model at other times, for ghosts that are drawn as skins: one pose after the other, in one list for the device.

use super::posed::PosedModel;
use super::uniform::Affine;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::View;
use std::sync::Arc;

/// See the module.
#[derive(Default)]
pub struct GhostSkins {
    /// Posed at one time after the other; none before ghosts are wanted.
    posed: Option<PosedModel>,
    /// Which view it has the takes of, and which bones rest.
    of: Option<(u64, Vec<BoneIndex>)>,
    /// Times and places of the ghosts, those far away first.
    order: Vec<(f32, i32)>,
    palettes: Vec<Affine>,
    weights: Vec<f32>,
    tints: Vec<u32>,
    /// Whether each draw item of one ghost after the other is seen from inside.
    mirrored: Vec<bool>,
}

impl GhostSkins {
    /// No ghost.
    pub fn clear(&mut self) {
        self.palettes.clear();
        self.weights.clear();
        self.tints.clear();
        self.mirrored.clear();
    }

    /// Poses `view` at each of `times` (seconds, and how far from now) of a take. `colors` are of what was and of what comes.
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
        // Those far away first: the nearer ones over them.
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

    /// How many.
    pub fn len(&self) -> usize {
        self.tints.len()
    }

    /// Is there none?
    pub fn is_empty(&self) -> bool {
        self.tints.is_empty()
    }

    /// The matrices of one ghost after the other.
    pub fn palettes(&self) -> &[Affine] {
        &self.palettes
    }

    /// The same of morph weights.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// What each is tinted with.
    pub fn tints(&self) -> &[u32] {
        &self.tints
    }

    /// Is this draw item of this ghost seen from inside, because scales turn it inside out?
    pub fn is_mirrored(&self, ghost: usize, item: usize) -> bool {
        let items = self.posed.as_ref().map_or(0, |posed| posed.items().len());
        self.mirrored.get(ghost * items + item).copied().unwrap_or_default()
    }

    /// The model, in the pose of the last ghost.
    pub fn posed(&self) -> Option<&PosedModel> {
        self.posed.as_ref()
    }
}

/// Four bytes, red first, as `unpack4x8unorm` reads them.
fn tint([red, green, blue]: [f32; 3], alpha: f32) -> u32 {
    let byte = |part: f32| (part.clamp(0.0, 1.0) * 255.0).round() as u8;
    u32::from_le_bytes([byte(red), byte(green), byte(blue), byte(alpha)])
}
