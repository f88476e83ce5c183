//! The draw calls of a pose: instances of the same part of a mesh share one, and instances outside the view have none.

use super::draw_set::DrawItem;
use super::frustum::ViewFrustum;
use super::uniform::{Affine, DrawInstance};
use glam::Mat4;
use std::collections::HashMap;
use std::ops::Range;

/// A draw call: instances of one part of a mesh, drawn alike.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DrawBatch {
    /// Index of the first of its items; all have the same mesh, primitive and material.
    pub item: usize,
    /// Whether the pose mirrors all of them, so that their front faces wind the other way.
    pub mirrored: bool,
    /// Its part of [`DrawBatches::instances`].
    pub instances: Range<u32>,
}

/// The draw calls of a model in a pose.
#[derive(Default)]
pub struct DrawBatches {
    /// All items, those of the same part one after another, in the order in which the parts occur in the file.
    by_part: Vec<u32>,
    solid: Vec<DrawBatch>,
    blended: Vec<DrawBatch>,
    instances: Vec<DrawInstance>,
    /// Index of the item of each instance.
    drawn: Vec<u32>,
}

impl DrawBatches {
    /// Allocates memory for the draws of `items`.
    pub fn new(items: &[DrawItem]) -> Self {
        let mut parts: HashMap<(u32, u32), u32> = HashMap::new();
        let mut number = |item: &DrawItem| {
            let next = parts.len() as u32;
            *parts.entry(item.part()).or_insert(next)
        };
        let mut by_part: Vec<(u32, u32)> =
            items.iter().zip(0..).map(|(item, index)| (number(item), index)).collect();
        by_part.sort_unstable();
        let blended = items.iter().filter(|item| item.blend).count();
        Self {
            by_part: by_part.into_iter().map(|(_, index)| index).collect(),
            // A part is drawn twice where some of its instances are mirrored.
            solid: Vec::with_capacity(parts.len() * 2),
            blended: Vec::with_capacity(blended),
            instances: Vec::with_capacity(items.len()),
            drawn: Vec::with_capacity(items.len()),
        }
    }

    /// Allocates memory for other draws of the same items.
    pub(super) fn for_the_same_items(&self) -> Self {
        Self {
            by_part: self.by_part.clone(),
            solid: Vec::with_capacity(self.solid.capacity()),
            blended: Vec::new(),
            instances: Vec::with_capacity(self.by_part.len()),
            drawn: Vec::with_capacity(self.by_part.len()),
        }
    }

    /// Indices of all items, those of the same part one after another.
    pub(super) fn by_part(&self) -> &[u32] {
        &self.by_part
    }

    /// Index of the item of each of the [`instances`](Self::instances).
    pub(super) fn drawn(&self) -> &[u32] {
        &self.drawn
    }

    /// Draw calls of the solid surfaces.
    pub fn solid(&self) -> &[DrawBatch] {
        &self.solid
    }

    /// Draw calls of the blended surfaces, farthest first.
    pub fn blended(&self) -> &[DrawBatch] {
        &self.blended
    }

    /// The instances of all draw calls, ready for the device.
    pub fn instances(&self) -> &[DrawInstance] {
        &self.instances
    }

    /// Collects the draw calls of `items` in the pose of `palettes`. `back_to_front` are the blended ones; without it
    /// they are drawn as the solid ones are. Allocates nothing.
    pub(super) fn collect(
        &mut self,
        items: &[DrawItem],
        palettes: &[Affine],
        back_to_front: Option<&[(f32, u32)]>,
        frustum: &ViewFrustum,
    ) {
        self.solid.clear();
        self.blended.clear();
        self.instances.clear();
        self.drawn.clear();
        for run in self.by_part.chunk_by(|&a, &b| items[a as usize].part() == items[b as usize].part()) {
            let is_solid = |index: &usize| back_to_front.is_none() || !items[*index].blend;
            let solid = || run.iter().map(|&index| index as usize).filter(is_solid);
            for mirrored in [false, true] {
                for index in solid() {
                    let item = &items[index];
                    if item.is_mirrored(palettes) == mirrored && item.may_show(palettes, frustum) {
                        append(&mut self.solid, &mut self.instances, items, index, mirrored, true);
                        self.drawn.push(index as u32);
                    }
                }
            }
        }
        for &(_, index) in back_to_front.unwrap_or_default() {
            self.add_blended(items, palettes, index as usize, frustum, false);
        }
    }

    /// Adds a draw call of blended item number `index`, if it is inside `frustum`. It may share that of the item added before, unless it
    /// `is_first`. Allocates nothing.
    pub(super) fn add_blended(
        &mut self,
        items: &[DrawItem],
        palettes: &[Affine],
        index: usize,
        frustum: &ViewFrustum,
        is_first: bool,
    ) {
        let item = &items[index];
        if item.may_show(palettes, frustum) {
            // The far side of a surface is drawn before its near side, so both belong to one instance.
            let shares = !item.double_sided && !is_first;
            let mirrored = item.is_mirrored(palettes);
            append(&mut self.blended, &mut self.instances, items, index, mirrored, shares);
            self.drawn.push(index as u32);
        }
    }
}

/// Adds item number `index` to the last batch, if it shares that one's draw call, or to a new one.
fn append(
    batches: &mut Vec<DrawBatch>,
    instances: &mut Vec<DrawInstance>,
    items: &[DrawItem],
    index: usize,
    mirrored: bool,
    shares: bool,
) {
    let item = &items[index];
    instances.push(item.instance);
    let end = instances.len() as u32;
    match batches.last_mut() {
        Some(last) if shares && last.mirrored == mirrored && items[last.item].part() == item.part() => {
            last.instances.end = end;
        }
        _ => batches.push(DrawBatch { item: index, mirrored, instances: end - 1..end }),
    }
}

impl DrawItem {
    /// Mesh and primitive.
    pub fn part(&self) -> (u32, u32) {
        (self.mesh, self.primitive)
    }

    /// Returns whether a pose mirrors the item, so that its front faces wind the other way.
    fn is_mirrored(&self, palettes: &[Affine]) -> bool {
        let Affine { x, y, z } = palettes[self.main_matrix as usize];
        x.truncate().dot(y.truncate().cross(z.truncate())) < 0.0
    }

    /// Returns whether some of the item may be inside the view. Always true where more than one matrix moves it.
    fn may_show(&self, palettes: &[Affine], frustum: &ViewFrustum) -> bool {
        let Some(around) = &self.rigid_box else { return true };
        let moved = around.moved(&Mat4::from(palettes[self.main_matrix as usize]));
        frustum.may_show(&moved)
    }
}
