//! The bones of a file, and what binds the meshes of a model to them.

use super::super::check as code;
use super::numbers::is_near;
use crate::animation::to_root;
use crate::data::{Bone, MeshInstance, ModelData, Skeleton, Skin, Transform};
use crate::format::losses::Losses;
use crate::format::matrices::inverse;
use crate::sample::sample_take;
use glam::Mat4;

/// Name of the bone that is added for meshes that nothing moves.
const STATIC: &str = "static";

/// The bones that a file gets.
pub(super) struct FileSkeleton {
    /// The bones of the model, and one that never moves if a mesh needs it.
    pub(super) skeleton: Skeleton,
}

/// How the vertices of a mesh get into the space of the file.
pub(super) struct MeshBinding {
    /// For each joint of the skin; one for a mesh without skin.
    pub(super) matrices: Vec<Mat4>,
    /// Number of the bone of each joint.
    pub(super) bones: Vec<u32>,
}

impl FileSkeleton {
    /// Returns the bones for a model.
    pub(super) fn of(model: &ModelData, losses: &mut Losses) -> Self {
        let mut skeleton = Skeleton::clone(&model.animation.skeleton);
        if skeleton.is_empty() {
            return Self { skeleton };
        }
        if model.instances.iter().any(|instance| instance.skin.is_none() && instance.bone.is_none()) {
            skeleton.bones.push(Bone::root(STATIC));
        }
        let mut locals = vec![Transform::IDENTITY; skeleton.len()];
        let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];
        sample_take(None, &skeleton, 0.0, &mut locals);
        to_root(&skeleton, &locals, &mut matrices);
        let is_bind = |(bone, matrix): (&Bone, &Mat4)| is_near(*matrix * bone.offset, Mat4::IDENTITY);
        if !skeleton.bones.iter().zip(&matrices).all(is_bind) {
            let text = "the rest pose is that in which the mesh is bound";
            losses.add("/animation/skeleton".to_owned(), code::REST_NOT_STORED, text);
        }
        Self { skeleton }
    }

    /// Returns how an instance is bound.
    pub(super) fn binding(&self, model: &ModelData, index: usize, losses: &mut Losses) -> MeshBinding {
        let instance = &model.instances[index];
        let skin = instance.skin.and_then(|skin| model.skins.get(skin as usize));
        let binding = match skin {
            Some(skin) => self.of_skin(skin),
            None => self.of_instance(instance),
        };
        let first = binding.matrices[0];
        if !binding.matrices.iter().all(|&matrix| is_near(first, matrix)) {
            let text = "the skin binds bones in another pose than the first skin; vertices between them are elsewhere";
            losses.add(format!("/instances/{index}/skin"), code::OFFSET_NOT_STORED, text);
        }
        binding
    }

    fn of_skin(&self, skin: &Skin) -> MeshBinding {
        let matrix = |(&bone, &offset): (&u32, &Mat4)| self.bone_to_file(bone) * offset;
        MeshBinding {
            matrices: skin.bones.iter().zip(&skin.offsets).map(matrix).collect(),
            bones: skin.bones.clone(),
        }
    }

    fn of_instance(&self, instance: &MeshInstance) -> MeshBinding {
        if self.skeleton.is_empty() {
            return MeshBinding { matrices: vec![instance.to_bone], bones: Vec::new() };
        }
        let bone = instance.bone.unwrap_or(self.skeleton.len() as u32 - 1);
        MeshBinding { matrices: vec![self.bone_to_file(bone) * instance.to_bone], bones: vec![bone] }
    }

    /// Returns the transform from the space of a bone to that in which the file binds it.
    fn bone_to_file(&self, bone: u32) -> Mat4 {
        inverse(self.skeleton.bones[bone as usize].offset).unwrap_or(Mat4::IDENTITY)
    }
}
