//! A model in a pose, laid out for the device: one list of matrices, one of morph weights, one of items to draw.

use super::batch::DrawBatches;
use super::draw_set::{DrawItem, DrawSet};
use super::frustum::ViewFrustum;
use super::message::Look;
use super::shape::SkeletonShape;
use super::uniform::Affine;
use dragonfly_anim::animation::{Animation, final_poses};
use dragonfly_anim::bounds::{AxisBox, Bounds};
use dragonfly_anim::data::{AnimationData, BoneIndex, Take, Transform};
use dragonfly_anim::sample::sample_morph_weights;
use dragonfly_anim::skin::rigid;
use dragonfly_document::adapter::TakeVersions;
use dragonfly_document::{LoadedModel, View};
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// A model in a pose.
pub struct PosedModel {
    animation: Animation,
    /// The pending poses of the takes, from the view.
    slots: Arc<[Arc<TakeVersions>]>,
    /// What is drawn of it.
    draws: DrawSet,
    /// Scratch memory for the largest skin.
    finals: Vec<Mat4>,
    shape: SkeletonShape,
    at: (Option<usize>, f32),
    /// Whether the pose includes pending poses; `None` where it has to be computed again.
    standing: Option<bool>,
}

impl PosedModel {
    /// `loaded` at rest.
    pub fn new(loaded: Arc<LoadedModel>) -> Self {
        let model = &loaded.model;
        let largest = model.skins.iter().map(|skin| skin.bones.len()).max().unwrap_or(0);
        let mut posed = Self {
            animation: Animation::of(model),
            slots: Arc::default(),
            finals: vec![Mat4::IDENTITY; largest],
            shape: SkeletonShape::new(model),
            at: (None, 0.0),
            standing: None,
            draws: DrawSet::new(Arc::clone(&loaded), 1),
        };
        posed.pose(None, 0.0, false);
        posed
    }

    /// Replaces the takes by those of `view`, which must be of the same model. The next [`pose`](Self::pose) uses
    /// them.
    ///
    /// Bones in `still` are shown at rest.
    pub fn show_takes(&mut self, view: &View, still: &[BoneIndex]) {
        self.standing = None;
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

    /// What is drawn of it.
    pub fn draws(&self) -> &DrawSet {
        &self.draws
    }

    /// The model.
    pub fn loaded(&self) -> &Arc<LoadedModel> {
        self.draws.loaded()
    }

    /// Bounds of the model at rest.
    pub fn bounds(&self) -> &Bounds {
        &self.loaded().bounds
    }

    /// All matrices, ready for the device.
    pub fn palettes(&self) -> &[Affine] {
        self.draws.palettes()
    }

    /// For each of the [`palettes`](Self::palettes) the box around the vertices that it moves most.
    pub(super) fn part_boxes(&self) -> &[AxisBox] {
        self.draws.part_boxes()
    }

    /// All morph weights, ready for the device.
    pub fn weights(&self) -> &[f32] {
        self.draws.weights()
    }

    /// All items to draw, in the order of the file.
    pub fn items(&self) -> &[DrawItem] {
        self.draws.items()
    }

    /// The draw calls that [`Self::batch`] collected last.
    pub fn batches(&self) -> &DrawBatches {
        self.draws.batches()
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
    /// shown. Allocates nothing; in the pose computed last, it does nothing.
    pub fn pose(&mut self, take: Option<usize>, time: f32, standing: bool) {
        if self.standing == Some(standing) && self.at == (take, time) {
            return;
        }
        (self.at, self.standing) = ((take, time), Some(standing));
        self.animation.to_root_bone_poses(take, time);
        let slot = take.filter(|_| standing).and_then(|take| self.slots.get(take));
        if let Some(pending) = slot.and_then(|slot| slot.pending_at(time)) {
            self.animation.to_root_bone_poses_with(|poses| pending.put_on(poses));
        }
        let to_root = self.animation.to_root();
        let loaded = Arc::clone(self.draws.loaded());
        let model = &loaded.model;
        let (layout, palettes, all_weights) = self.draws.write(0);
        for (skin, &start) in model.skins.iter().zip(&layout.skins) {
            let finals = &mut self.finals[..skin.bones.len()];
            final_poses(skin, to_root, finals);
            for (matrix, &pose) in palettes[start..].iter_mut().zip(&*finals) {
                *matrix = pose.into();
            }
        }
        for (matrix, instance) in palettes[layout.rigid..].iter_mut().zip(&model.instances) {
            *matrix = rigid(instance, to_root).into();
        }
        let pending = slot.and_then(|slot| slot.pending_at(time));
        let take = take.and_then(|take| self.animation.data().takes.get(take)).map(Arc::as_ref);
        for (index, (instance, &(start, count))) in model.instances.iter().zip(&layout.weights).enumerate() {
            let weights = &mut all_weights[start..start + count];
            sample_morph_weights(take, index as u32, &instance.morph_weights, time, weights);
            if let Some(pending) = pending {
                pending.put_weights(index as u32, weights);
            }
        }
    }

    /// Sorts the blended items by distance from `eye`. Allocates nothing.
    pub fn sort(&mut self, eye: Vec3, back: Vec3) {
        self.draws.sort(eye, back);
    }

    /// Collects the draw calls of what is inside `frustum`, after [`Self::sort`]. Allocates nothing.
    pub fn batch(&mut self, frustum: &ViewFrustum) {
        self.draws.batch(frustum);
    }

    /// Collects the draw calls of what is inside `frustum` for drawing all surfaces alike. Allocates nothing.
    pub fn batch_alike(&mut self, frustum: &ViewFrustum) {
        self.draws.batch_alike(frustum);
    }

    /// Collects the draw calls of what casts shadows in each of some maps, as [`DrawSet::batch_casters`] does.
    pub(super) fn batch_casters(&mut self, maps: impl Iterator<Item = ViewFrustum>) {
        self.draws.batch_casters(maps);
    }

    /// Places the skeleton's bodies. Allocates nothing.
    pub fn place_bones(&mut self, look: &Look) {
        self.shape.place(self.animation.to_root(), look);
    }
}
