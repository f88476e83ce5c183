//! The things of a scene that share a model.

use super::pick::GroupPicker;
use crate::draw_set::{DrawSet, PaletteLayout};
use crate::uniform::Affine;
use dragonfly_anim::animation::final_pose;
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::fast::matrix::mat4;
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{Matrix34, Rig, RootPoses, SkinBinding, final_poses, to_root};
use dragonfly_anim::stage::ThingPose;
use dragonfly_document::LoadedModel;
use glam::Mat4;
use std::sync::Arc;

/// Copies of a model, one for each thing.
pub(super) struct CastGroup {
    draws: DrawSet,
    copies: usize,
    bindings: Vec<SkinBinding>,
    /// The pose of things that have none: at rest.
    rest: RootPoses,
    /// Their weights of the shape keys, in the order of the instances.
    rest_weights: Vec<f32>,
    bones: usize,
    /// Created when the pointer is first over the box around one of them.
    picker: Option<GroupPicker>,
}

impl CastGroup {
    pub(super) fn new(loaded: Arc<LoadedModel>, layout: PaletteLayout, copies: usize) -> Self {
        let model = &loaded.model;
        let rig = Rig::new(&model.animation.skeleton);
        let mut rest = RootPoses::new(&rig);
        to_root(SimdLevel::best(), &rig, rig.rest().blocks(), &mut rest);
        let bindings = model.skins.iter().map(|skin| SkinBinding::new(&rig, skin)).collect();
        let mut rest_weights = vec![0.0; layout.shapes()];
        for (instance, &(start, count)) in model.instances.iter().zip(&layout.weights) {
            for (weight, &given) in rest_weights[start..start + count].iter_mut().zip(&instance.morph_weights)
            {
                *weight = given;
            }
        }
        let draws = DrawSet::with_layout(Arc::clone(&loaded), layout, copies);
        Self { draws, copies, bindings, rest, rest_weights, bones: rig.bones(), picker: None }
    }

    pub(super) fn is_of(&self, loaded: &Arc<LoadedModel>, copies: usize) -> bool {
        Arc::ptr_eq(self.draws.loaded(), loaded) && self.copies == copies
    }

    pub(super) fn draws(&self) -> &DrawSet {
        &self.draws
    }

    pub(super) fn draws_mut(&mut self) -> &mut DrawSet {
        &mut self.draws
    }

    /// The picker of the model.
    pub(super) fn picker(&mut self) -> &mut GroupPicker {
        let loaded = self.draws.loaded();
        self.picker.get_or_insert_with(|| GroupPicker::new(&loaded.model))
    }

    /// Poses a copy at `place`, at rest without a pose. Returns the box around it in the scene. Allocates nothing.
    pub(super) fn pose(
        &mut self,
        level: SimdLevel,
        copy: usize,
        place: Mat4,
        pose: Option<&ThingPose>,
    ) -> AxisBox {
        let fits = |pose: &&ThingPose| pose.to_root.matrices().len() == self.bones;
        let shown = pose.filter(fits);
        let pose = shown.map_or(&self.rest, |shown| &shown.to_root);
        let loaded = Arc::clone(self.draws.loaded());
        let (layout, palettes, weights) = self.draws.write(copy);
        // A pose has the weights of all instances one after another, too.
        let shapes = shown.map_or(&self.rest_weights, |shown| &shown.shapes);
        if shapes.len() == self.rest_weights.len() {
            weights[..shapes.len()].copy_from_slice(shapes);
        }
        let scene_from_model = Affine::from(place);
        let (skins, rigid) = palettes.split_at_mut(layout.rigid);
        for (binding, &start) in self.bindings.iter().zip(&layout.skins) {
            let finals: &mut [Matrix34] =
                bytemuck::cast_slice_mut(&mut skins[start..start + binding.joints()]);
            final_poses(level, binding, pose, finals);
        }
        for matrix in skins {
            *matrix = scene_from_model.after(matrix);
        }
        for (matrix, instance) in rigid.iter_mut().zip(&loaded.model.instances) {
            let carrier = instance.bone.map_or(Mat4::IDENTITY, |bone| mat4(pose.get(bone as usize)));
            *matrix = scene_from_model.after(&final_pose(carrier, instance.to_bone).into());
        }
        let around = self.draws.box_of(copy);
        if around.is_empty() { AxisBox::at(place.w_axis.truncate()) } else { around }
    }
}
