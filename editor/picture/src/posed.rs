//! A model in a pose, laid out for the device: one list of matrices, one of morph weights, one of items to draw.

use super::batch::DrawBatches;
use super::contact::add_boxes;
use super::frustum::ViewFrustum;
use super::message::Look;
use super::shape::SkeletonShape;
use super::uniform::{Affine, DrawInstance};
use dragonfly_anim::animation::{Animation, final_poses};
use dragonfly_anim::bounds::{AxisBox, Bounds};
use dragonfly_anim::data::{AlphaMode, AnimationData, BoneIndex, ModelData, Primitive, Take, Transform};
use dragonfly_anim::sample::sample_morph_weights;
use dragonfly_anim::skin::rigid;
use dragonfly_document::adapter::TakeVersions;
use dragonfly_document::{LoadedModel, View};
use glam::{Mat4, Vec3};
use std::collections::HashMap;
use std::sync::Arc;

/// A primitive of a mesh, as part of an instance.
#[derive(Clone, Copy, Debug)]
pub struct DrawItem {
    /// Index in the model's meshes.
    pub mesh: u32,
    /// Index in the mesh's primitives.
    pub primitive: u32,
    /// Index in the model's materials.
    pub material: Option<u32>,
    /// Whether it blends with what is behind it.
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

/// A model in a pose.
pub struct PosedModel {
    loaded: Arc<LoadedModel>,
    animation: Animation,
    /// The pending poses of the takes, from the view.
    slots: Arc<[Arc<TakeVersions>]>,
    /// Matrices for the device: all skins, then one matrix per instance.
    palettes: Vec<Affine>,
    /// First matrix of each skin.
    skin_starts: Vec<usize>,
    /// First of the instances' own matrices.
    rigid_start: usize,
    /// Scratch memory for the largest skin.
    finals: Vec<Mat4>,
    weights: Vec<f32>,
    /// First weight of each instance, and their number.
    weight_ranges: Vec<(usize, usize)>,
    items: Vec<DrawItem>,
    /// For each matrix the box around the vertices that it moves most, for the contact shadow.
    part_boxes: Vec<AxisBox>,
    /// Distances and indices of the blended items, farthest first.
    back_to_front: Vec<(f32, u32)>,
    batches: DrawBatches,
    shape: SkeletonShape,
    at: (Option<usize>, f32),
}

impl PosedModel {
    /// `loaded` at rest.
    pub fn new(loaded: Arc<LoadedModel>) -> Self {
        let model = &loaded.model;
        let mut skin_starts = Vec::with_capacity(model.skins.len());
        let mut count = 0;
        for skin in &model.skins {
            skin_starts.push(count);
            count += skin.bones.len();
        }
        let rigid_start = count;
        let mut weight_ranges = Vec::with_capacity(model.instances.len());
        let mut weight_count = 0;
        for instance in &model.instances {
            let targets =
                primitives(model, instance.mesh).iter().map(|primitive| primitive.morph_targets.len());
            let targets = targets.max().unwrap_or(0);
            weight_ranges.push((weight_count, targets));
            weight_count += targets;
        }
        let largest = model.skins.iter().map(|skin| skin.bones.len()).max().unwrap_or(0);
        let mut posed = Self {
            animation: Animation::of(model),
            slots: Arc::default(),
            palettes: vec![Mat4::IDENTITY.into(); (rigid_start + model.instances.len()).max(1)],
            skin_starts,
            rigid_start,
            finals: vec![Mat4::IDENTITY; largest],
            weights: vec![0.0; weight_count.max(1)],
            weight_ranges,
            items: Vec::new(),
            part_boxes: Vec::new(),
            back_to_front: Vec::new(),
            batches: DrawBatches::default(),
            shape: SkeletonShape::new(model),
            at: (None, 0.0),
            loaded: Arc::clone(&loaded),
        };
        posed.items = posed.draw_items();
        posed.part_boxes = posed.boxes_of_parts();
        posed.batches = DrawBatches::new(&posed.items);
        posed.back_to_front.reserve(posed.items.iter().filter(|item| item.blend).count());
        posed.pose(None, 0.0, false);
        posed
    }

    /// Replaces the takes by those of `view`, which must be of the same model. The next [`pose`](Self::pose) uses
    /// them.
    ///
    /// Bones in `still` are shown at rest.
    pub fn show_takes(&mut self, view: &View, still: &[BoneIndex]) {
        self.slots = Arc::clone(&view.slots);
        let takes = view.takes_without(still);
        if self.animation.data().takes.len() == takes.len() {
            for (index, take) in takes.iter().enumerate() {
                self.animation.replace_take(index, Arc::clone(take));
            }
        } else {
            self.animation = Animation::new(AnimationData { takes: takes.to_vec(), ..view.animation() });
        }
    }

    /// The model.
    pub fn loaded(&self) -> &Arc<LoadedModel> {
        &self.loaded
    }

    /// Bounds of the model at rest.
    pub fn bounds(&self) -> &Bounds {
        &self.loaded.bounds
    }

    /// All matrices, ready for the device.
    pub fn palettes(&self) -> &[Affine] {
        &self.palettes
    }

    /// For each of the [`palettes`](Self::palettes) the box around the vertices that it moves most.
    pub(super) fn part_boxes(&self) -> &[AxisBox] {
        &self.part_boxes
    }

    /// All morph weights, ready for the device.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// All items to draw, in the order of the file.
    pub fn items(&self) -> &[DrawItem] {
        &self.items
    }

    /// The draw calls that [`Self::batch`] collected last.
    pub fn batches(&self) -> &DrawBatches {
        &self.batches
    }

    /// Matrices bone space → scene space of every bone in this pose.
    pub fn to_root(&self) -> &[Mat4] {
        self.animation.to_root()
    }

    /// Transforms bone space → parent space of every bone in this pose.
    pub fn poses(&self) -> &[Transform] {
        self.animation.poses()
    }

    /// Take and time of this pose.
    pub fn at(&self) -> (Option<usize>, f32) {
        self.at
    }

    /// The takes that are shown.
    pub fn takes(&self) -> &[Arc<Take>] {
        &self.animation.data().takes
    }

    /// The skeleton's bodies in this pose.
    pub fn shape(&self) -> &SkeletonShape {
        &self.shape
    }

    /// Poses the model at `time` of `take`. With `standing` it includes pending poses; during playback only keys are
    /// shown. Allocates nothing.
    pub fn pose(&mut self, take: Option<usize>, time: f32, standing: bool) {
        self.at = (take, time);
        let model = &self.loaded.model;
        self.animation.to_root_bone_poses(take, time);
        let slot = take.filter(|_| standing).and_then(|take| self.slots.get(take));
        if let Some(pending) = slot.and_then(|slot| slot.pending_at(time)) {
            self.animation.to_root_bone_poses_with(|poses| pending.put_on(poses));
        }
        let to_root = self.animation.to_root();
        for (skin, &start) in model.skins.iter().zip(&self.skin_starts) {
            let finals = &mut self.finals[..skin.bones.len()];
            final_poses(skin, to_root, finals);
            for (matrix, &pose) in self.palettes[start..].iter_mut().zip(&*finals) {
                *matrix = pose.into();
            }
        }
        for (matrix, instance) in self.palettes[self.rigid_start..].iter_mut().zip(&model.instances) {
            *matrix = rigid(instance, to_root).into();
        }
        let pending = slot.and_then(|slot| slot.pending_at(time));
        let take = take.and_then(|take| self.animation.data().takes.get(take)).map(Arc::as_ref);
        for (index, (instance, &(start, count))) in
            model.instances.iter().zip(&self.weight_ranges).enumerate()
        {
            let weights = &mut self.weights[start..start + count];
            sample_morph_weights(take, index as u32, &instance.morph_weights, time, weights);
            if let Some(pending) = pending {
                pending.put_weights(index as u32, weights);
            }
        }
    }

    /// Sorts the blended items by distance from `eye`. Allocates nothing.
    pub fn sort(&mut self, eye: Vec3, back: Vec3) {
        self.back_to_front.clear();
        for (index, item) in self.items.iter().enumerate().filter(|(_, item)| item.blend) {
            let Affine { x, y, z } = self.palettes[item.main_matrix as usize];
            let center = item.center.extend(1.0);
            let place = Vec3::new(x.dot(center), y.dot(center), z.dot(center));
            self.back_to_front.push(((eye - place).dot(back), index as u32));
        }
        self.back_to_front.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    }

    /// Collects the draw calls of what is inside `frustum`, after [`Self::sort`]. Allocates nothing.
    pub fn batch(&mut self, frustum: &ViewFrustum) {
        self.batches.collect(&self.items, &self.palettes, Some(&self.back_to_front), frustum);
    }

    /// Collects the draw calls of what is inside `frustum` for drawing all surfaces alike. Allocates nothing.
    pub fn batch_alike(&mut self, frustum: &ViewFrustum) {
        self.batches.collect(&self.items, &self.palettes, None, frustum);
    }

    /// Places the skeleton's bodies. Allocates nothing.
    pub fn place_bones(&mut self, look: &Look) {
        self.shape.place(self.animation.to_root(), look);
    }

    fn boxes_of_parts(&self) -> Vec<AxisBox> {
        let mut boxes = vec![AxisBox::EMPTY; self.palettes.len()];
        for item in &self.items {
            let primitives = primitives(&self.loaded.model, item.mesh);
            if let Some(primitive) = primitives.get(item.primitive as usize) {
                let DrawInstance { palette, influences, .. } = item.instance;
                add_boxes(&mut boxes, primitive, palette as usize, influences as usize);
            }
        }
        boxes
    }

    fn draw_items(&self) -> Vec<DrawItem> {
        let model = &self.loaded.model;
        let mut items = Vec::new();
        // Found once for each primitive, however often it is placed.
        let mut found: HashMap<(u32, usize), (AxisBox, usize)> = HashMap::new();
        for (index, instance) in model.instances.iter().enumerate() {
            let own = self.rigid_start + index;
            let (weights, _) = self.weight_ranges[index];
            for (position, primitive) in primitives(model, instance.mesh).iter().enumerate() {
                if primitive.vertices.is_empty() || primitive.indices.is_empty() {
                    continue;
                }
                let (around, joint) = *found
                    .entry((instance.mesh, position))
                    .or_insert_with(|| (around(&primitive.vertices.positions), main_joint(primitive)));
                let skin = instance.skin.and_then(|skin| self.skin_starts.get(skin as usize).copied());
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
                    },
                    center: around.center(),
                    rigid_box: (influences == 0 && primitive.morph_targets.is_empty()).then_some(around),
                    main_matrix: main.min(self.palettes.len() - 1) as u32,
                });
            }
        }
        items
    }
}

fn primitives(model: &ModelData, mesh: u32) -> &[Primitive] {
    model.meshes.get(mesh as usize).map_or(&[], |mesh| &mesh.primitives)
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
