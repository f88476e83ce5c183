//! The matrices, the morph weights and the items to draw of one model, in one or more copies, as a device needs them.

use super::batch::DrawBatches;
use super::contact::add_boxes;
use super::frustum::ViewFrustum;
use super::uniform::{Affine, DrawInstance, NOT_POSED};
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::data::{AlphaMode, ModelData, Primitive};
use dragonfly_document::LoadedModel;
use glam::{Mat4, Vec3};
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A primitive of a mesh, as part of an instance.
#[derive(Clone, Copy, Debug)]
pub struct DrawItem {
    /// Index in the model's meshes.
    pub mesh: u32,
    /// Index in the mesh's primitives.
    pub primitive: u32,
    /// Index in the model's materials.
    pub material: Option<u32>,
    /// Whether it is transparent.
    pub blend: bool,
    /// Whether alpha discards samples.
    pub mask: bool,
    /// Whether back faces are drawn too.
    pub double_sided: bool,
    /// The instance for the shader.
    pub instance: DrawInstance,
    /// Center of its vertices, mesh space.
    center: Vec3,
    /// The box around its vertices, mesh space; `None` where more than one matrix or morph targets move them.
    pub(super) rigid_box: Option<AxisBox>,
    /// Index of the matrix that represents the whole item: that of the joint with the largest total weight.
    pub(super) main_matrix: u32,
}

/// The places of the matrices and morph weights of one copy of a model in their lists: all skins, then one matrix per instance.
#[derive(Clone, Debug, Default)]
pub(super) struct PaletteLayout {
    /// First matrix of each skin.
    pub(super) skins: Vec<usize>,
    /// First of the instances' own matrices.
    pub(super) rigid: usize,
    /// Number of matrices, at least one.
    pub(super) matrices: usize,
    /// First weight of each instance, and their number.
    pub(super) weights: Vec<(usize, usize)>,
    /// Number of morph weights, at least one.
    pub(super) weight_count: usize,
    /// Largest number of items.
    items: usize,
}

impl PaletteLayout {
    pub(super) fn of(model: &ModelData) -> Self {
        let mut skins = Vec::with_capacity(model.skins.len());
        let mut rigid = 0;
        for skin in &model.skins {
            skins.push(rigid);
            rigid += skin.bones.len();
        }
        let mut weights = Vec::with_capacity(model.instances.len());
        let (mut weight_count, mut items) = (0, 0);
        for instance in &model.instances {
            let primitives = primitives(model, instance.mesh);
            items += primitives.len();
            let targets = primitives.iter().map(|primitive| primitive.morph_targets.len()).max().unwrap_or(0);
            weights.push((weight_count, targets));
            weight_count += targets;
        }
        let matrices = (rigid + model.instances.len()).max(1);
        Self { skins, rigid, matrices, weights, weight_count: weight_count.max(1), items }
    }

    /// Returns the number of morph weights of all instances together.
    pub(super) fn shapes(&self) -> usize {
        self.weights.last().map_or(0, |&(start, count)| start + count)
    }

    /// Returns the bytes of matrices, weights and items of one copy.
    pub(super) fn bytes(&self) -> usize {
        self.matrices * size_of::<Affine>()
            + self.weight_count * size_of::<f32>()
            + self.items * size_of::<DrawItem>()
    }
}

/// Copies of a model, each in its pose, as a device draws them.
pub struct DrawSet {
    loaded: Arc<LoadedModel>,
    layout: PaletteLayout,
    palettes: Vec<Affine>,
    weights: Vec<f32>,
    items: Vec<DrawItem>,
    /// For each matrix of a copy the box around the vertices that it moves most.
    part_boxes: Vec<AxisBox>,
    /// Distances and indices of the blended items, farthest first.
    back_to_front: Vec<(f32, u32)>,
    batches: DrawBatches,
    /// Draw calls of what casts shadows, one list for each map; empty until there is one.
    casters: Vec<DrawBatches>,
    /// Number of vertices of a copy that more than one matrix or morph targets move.
    posed: u64,
    /// Number of this set among all sets, and how often it was written.
    revision: (u64, u64),
}

/// Number of sets made so far.
static SETS: AtomicU64 = AtomicU64::new(0);

impl DrawSet {
    /// Allocates memory for `copies` of `loaded`; all matrices are the identity.
    pub(super) fn new(loaded: Arc<LoadedModel>, copies: usize) -> Self {
        let layout = PaletteLayout::of(&loaded.model);
        Self::with_layout(loaded, layout, copies)
    }

    /// Does the same as [`Self::new`] with the layout of the model.
    pub(super) fn with_layout(loaded: Arc<LoadedModel>, layout: PaletteLayout, copies: usize) -> Self {
        let mut one = draw_items(&loaded.model, &layout);
        let posed = number_posed(&mut one);
        let part_boxes = boxes_of_parts(&loaded.model, &one, layout.matrices);
        let mut items = Vec::with_capacity(one.len() * copies);
        for copy in 0..copies {
            let (matrices, weights) = ((copy * layout.matrices) as u32, (copy * layout.weight_count) as u32);
            items.extend(one.iter().map(|item| DrawItem {
                instance: DrawInstance {
                    palette: item.instance.palette + matrices,
                    morph_weights: item.instance.morph_weights + weights,
                    posed: match item.instance.posed {
                        NOT_POSED => NOT_POSED,
                        // Sets for which this wraps have no room for posed vertices.
                        first => first.wrapping_add((posed as u32).wrapping_mul(copy as u32)),
                    },
                    ..item.instance
                },
                main_matrix: item.main_matrix + matrices,
                ..*item
            }));
        }
        Self {
            palettes: vec![Mat4::IDENTITY.into(); layout.matrices * copies.max(1)],
            weights: vec![0.0; layout.weight_count * copies.max(1)],
            batches: DrawBatches::new(&items),
            casters: Vec::new(),
            posed,
            back_to_front: Vec::with_capacity(items.iter().filter(|item| item.blend).count()),
            items,
            part_boxes,
            layout,
            loaded,
            revision: (SETS.fetch_add(1, Ordering::Relaxed), 0),
        }
    }

    /// The model.
    pub fn loaded(&self) -> &Arc<LoadedModel> {
        &self.loaded
    }

    /// All matrices, copy after copy, ready for the device.
    pub fn palettes(&self) -> &[Affine] {
        &self.palettes
    }

    /// All morph weights, copy after copy, ready for the device.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// All items to draw, copy after copy in the order of the file.
    pub fn items(&self) -> &[DrawItem] {
        &self.items
    }

    /// The draw calls that were collected last.
    pub fn batches(&self) -> &DrawBatches {
        &self.batches
    }

    /// The draw calls of what casts shadows in map number `map`, collected last; `None` before the first.
    pub fn casters(&self, map: usize) -> Option<&DrawBatches> {
        self.casters.get(map)
    }

    /// Returns the number of vertices of all copies that more than one matrix or morph targets move.
    pub fn posed_vertices(&self) -> u64 {
        let copies = self.palettes.len() / self.layout.matrices;
        self.posed.saturating_mul(copies as u64)
    }

    /// Returns the box around the parts of a copy in its pose; empty without any.
    pub(super) fn box_of(&self, copy: usize) -> AxisBox {
        let parts = self.part_boxes.iter().zip(self.palettes_of(copy)).filter(|(part, _)| !part.is_empty());
        parts.fold(AxisBox::EMPTY, |around, (part, matrix)| around.union(part.moved(&Mat4::from(*matrix))))
    }

    /// Number of transparent items.
    pub(super) fn blended(&self) -> usize {
        self.items.iter().filter(|item| item.blend).count()
    }

    /// Numbers that change whenever matrices or weights are written, and that no two sets have in common.
    pub fn revision(&self) -> (u64, u64) {
        self.revision
    }

    /// For each matrix of a copy the box around the vertices that it moves most.
    pub(super) fn part_boxes(&self) -> &[AxisBox] {
        &self.part_boxes
    }

    /// The matrices of a copy.
    pub(super) fn palettes_of(&self, copy: usize) -> &[Affine] {
        &self.palettes[self.part_of(copy)]
    }

    /// The layout, and the matrices and morph weights of a copy, to be written.
    pub(super) fn write(&mut self, copy: usize) -> (&PaletteLayout, &mut [Affine], &mut [f32]) {
        self.revision.1 += 1;
        let (part, count) = (self.part_of(copy), self.layout.weight_count);
        (&self.layout, &mut self.palettes[part], &mut self.weights[copy * count..(copy + 1) * count])
    }

    fn part_of(&self, copy: usize) -> Range<usize> {
        copy * self.layout.matrices..(copy + 1) * self.layout.matrices
    }

    /// Calls `found` with the distance of each blended item from `eye` against the direction of view, and its index.
    pub(super) fn for_each_blended(&self, eye: Vec3, back: Vec3, mut found: impl FnMut(f32, u32)) {
        for (index, item) in self.items.iter().enumerate().filter(|(_, item)| item.blend) {
            let Affine { x, y, z } = self.palettes[item.main_matrix as usize];
            let center = item.center.extend(1.0);
            let place = Vec3::new(x.dot(center), y.dot(center), z.dot(center));
            found((eye - place).dot(back), index as u32);
        }
    }

    /// Sorts the blended items by distance from `eye`. Allocates nothing.
    pub(super) fn sort(&mut self, eye: Vec3, back: Vec3) {
        let mut order = std::mem::take(&mut self.back_to_front);
        order.clear();
        self.for_each_blended(eye, back, |distance, index| order.push((distance, index)));
        order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        self.back_to_front = order;
    }

    /// Collects the draw calls of what is inside `frustum`, after [`Self::sort`]. Allocates nothing.
    pub(super) fn batch(&mut self, frustum: &ViewFrustum) {
        self.batches.collect(&self.items, &self.palettes, Some(&self.back_to_front), frustum);
    }

    /// Collects the draw calls of what is inside `frustum` for drawing all surfaces alike. Allocates nothing.
    pub(super) fn batch_alike(&mut self, frustum: &ViewFrustum) {
        self.batches.collect(&self.items, &self.palettes, None, frustum);
    }

    /// Collects the draw calls of what casts shadows in each of some maps, which show what is inside these frusta. Allocates only for more maps
    /// than before.
    pub(super) fn batch_casters(&mut self, maps: impl Iterator<Item = ViewFrustum>) {
        for (map, frustum) in maps.enumerate() {
            if map == self.casters.len() {
                self.casters.push(self.batches.for_the_same_items());
            }
            self.casters[map].collect(&self.items, &self.palettes, None, &frustum);
        }
    }

    /// Collects the draw calls of the solid surfaces inside `frustum`; the blended ones follow by [`Self::add_blended`]. Allocates nothing.
    pub(super) fn batch_solid(&mut self, frustum: &ViewFrustum) {
        self.batches.collect(&self.items, &self.palettes, Some(&[]), frustum);
    }

    /// Adds a blended item that is inside `frustum`. With `is_first` it shares no draw call with the one before.
    pub(super) fn add_blended(&mut self, item: u32, frustum: &ViewFrustum, is_first: bool) {
        self.batches.add_blended(&self.items, &self.palettes, item as usize, frustum, is_first);
    }
}

/// Returns the primitives of a mesh; none past the end.
pub(super) fn primitives(model: &ModelData, mesh: u32) -> &[Primitive] {
    model.meshes.get(mesh as usize).map_or(&[], |mesh| &mesh.primitives)
}

fn boxes_of_parts(model: &ModelData, items: &[DrawItem], matrices: usize) -> Vec<AxisBox> {
    let mut boxes = vec![AxisBox::EMPTY; matrices];
    for item in items {
        if let Some(primitive) = primitives(model, item.mesh).get(item.primitive as usize) {
            let DrawInstance { palette, influences, .. } = item.instance;
            add_boxes(&mut boxes, primitive, palette as usize, influences as usize);
        }
    }
    boxes
}

/// Assigns places among the posed vertices to the items of one copy whose parts more than one matrix or morph targets move. Returns the number
/// of vertices.
fn number_posed(items: &mut [DrawItem]) -> u64 {
    let is_deformed = |item: &&DrawItem| item.instance.influences > 0 || item.instance.morph_targets > 0;
    // All instances of a part are drawn alike.
    let deformed: HashSet<(u32, u32)> = items.iter().filter(is_deformed).map(DrawItem::part).collect();
    let mut next = 0;
    for item in items.iter_mut().filter(|item| deformed.contains(&item.part())) {
        item.instance.posed = next as u32;
        next += u64::from(item.instance.vertices);
    }
    next
}

/// Returns the items of one copy.
fn draw_items(model: &ModelData, layout: &PaletteLayout) -> Vec<DrawItem> {
    let mut items = Vec::new();
    // Found once for each primitive, however often it is placed.
    let mut found: HashMap<(u32, usize), (AxisBox, usize)> = HashMap::new();
    for (index, instance) in model.instances.iter().enumerate() {
        let own = layout.rigid + index;
        let (weights, _) = layout.weights[index];
        for (position, primitive) in primitives(model, instance.mesh).iter().enumerate() {
            if primitive.vertices.is_empty() || primitive.indices.is_empty() {
                continue;
            }
            let (around, joint) = *found
                .entry((instance.mesh, position))
                .or_insert_with(|| (around(&primitive.vertices.positions), main_joint(primitive)));
            let skin = instance.skin.and_then(|skin| layout.skins.get(skin as usize).copied());
            let influences = primitive.vertices.influences_per_vertex;
            let (palette, influences, main) = match skin {
                Some(start) if influences > 0 => (start, influences, start + joint),
                _ => (own, 0, own),
            };
            let material = primitive.material.and_then(|material| model.materials.get(material as usize));
            items.push(DrawItem {
                mesh: instance.mesh,
                primitive: position as u32,
                material: primitive.material,
                blend: material.is_some_and(|material| material.alpha_mode == AlphaMode::Blend),
                mask: material.is_some_and(|material| matches!(material.alpha_mode, AlphaMode::Mask(_))),
                double_sided: material.is_some_and(|material| material.double_sided),
                instance: DrawInstance {
                    palette: palette as u32,
                    influences: influences as u32,
                    morph_targets: primitive.morph_targets.len() as u32,
                    morph_weights: weights as u32,
                    vertices: primitive.vertices.len() as u32,
                    tint: 0,
                    posed: NOT_POSED,
                },
                center: around.center(),
                rigid_box: (influences == 0 && primitive.morph_targets.is_empty()).then_some(around),
                main_matrix: main.min(layout.matrices - 1) as u32,
            });
        }
    }
    items
}

/// Returns the box around `points`.
fn around(points: &[Vec3]) -> AxisBox {
    let mut around = AxisBox::EMPTY;
    points.iter().for_each(|&point| around.add(point));
    around
}

/// Returns the joint with the largest weight in all vertices together.
fn main_joint(primitive: &Primitive) -> usize {
    let mut sums: Vec<f32> = Vec::new();
    for influence in &primitive.vertices.influences {
        let joint = usize::from(influence.joint);
        if sums.len() <= joint {
            sums.resize(joint + 1, 0.0);
        }
        sums[joint] += influence.weight;
    }
    let best = sums.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    best.map_or(0, |(joint, _)| joint)
}
