//! A whole model: geometry, skins, materials, images, and animation data.

use super::{Image, Material, Mesh, MeshInstance, Skeleton, Skin, Take};
use std::sync::Arc;

/// The moving part: a skeleton and the takes that move it (thesis §3.1.2, `AnimationBase`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AnimationData {
    /// Shared: takes of an edited copy keep it.
    pub skeleton: Arc<Skeleton>,
    /// In file order; each has one track a bone.
    pub takes: Vec<Arc<Take>>,
}

/// Everything read from a file (thesis §3.1.2, `AnimatedModelBase`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelData {
    /// As in the file; may be empty.
    pub name: String,
    /// Geometry.
    pub meshes: Vec<Mesh>,
    /// Where and how the meshes stand in the scene.
    pub instances: Vec<MeshInstance>,
    /// Links between geometry and skeleton.
    pub skins: Vec<Skin>,
    /// Surfaces.
    pub materials: Vec<Material>,
    /// Pictures used by materials.
    pub images: Vec<Image>,
    /// Skeleton and takes.
    pub animation: AnimationData,
}
