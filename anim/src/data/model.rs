//! A complete model: geometry, skins, materials, images, and animation data.

use super::{Avatar, Image, Material, Mesh, MeshInstance, Skeleton, Skin, Take};
use std::sync::Arc;

/// The animated part: a skeleton and the takes that move it (thesis §3.1.2, `AnimationBase`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AnimationData {
    /// Shared by edited copies, whose takes refer to it.
    pub skeleton: Arc<Skeleton>,
    /// The takes in file order; each has one track per bone.
    pub takes: Vec<Arc<Take>>,
}

/// Everything read from a file (thesis §3.1.2, `AnimatedModelBase`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelData {
    /// As in the file; may be empty.
    pub name: String,
    /// Geometry of the model.
    pub meshes: Vec<Mesh>,
    /// Placements of the meshes in the scene.
    pub instances: Vec<MeshInstance>,
    /// Links between geometry and skeleton.
    pub skins: Vec<Skin>,
    /// Surface properties.
    pub materials: Vec<Material>,
    /// Images used by materials.
    pub images: Vec<Image>,
    /// The skeleton and the takes.
    pub animation: AnimationData,
    /// Parts of the body and facial expressions; empty where the file has none.
    pub avatar: Avatar,
}
