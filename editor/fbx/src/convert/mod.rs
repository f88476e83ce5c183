//! From a scene of `ufbx` to a model. Runs in the child, and in tests.
//!
//! `ufbx` evaluates everything that makes FBX difficult: pivots, pre-rotations, rotation orders, the three ways of inheriting
//! scale, layers of animation, extrapolation. This module samples those evaluations: bones get the transform of their node at
//! rest, tracks get keys (`keys.rs`) where the curves of the file have them, and more where a curve bends.

mod channel;
mod curves;
mod image;
mod keys;
mod load;
mod material;
mod mesh;
mod morph;
mod nodes;
mod scene;
mod skin;
mod space;
mod take;

pub(crate) use load::MEMORY;

use crate::textures::ExternalTexture;
use dragonfly_anim::data::{AnimationData, ModelData};
use dragonfly_anim::format::{ImportContext, ImportError};
use std::sync::Arc;

/// A model, and the textures that are in files of their own.
pub(crate) struct ConvertedScene {
    pub(crate) model: ModelData,
    pub(crate) textures: Vec<ExternalTexture>,
}

/// Parses the bytes of a file and converts what they contain.
pub(crate) fn convert(bytes: &[u8], context: &ImportContext<'_>) -> Result<ConvertedScene, ImportError> {
    let root = load::load(bytes, context)?;
    let scene: &ufbx::Scene = &root;
    let space = space::FbxSpace::new(&scene.settings, context);
    load::report(scene, context);
    let (images, textures, numbers) = image::images(scene, context)?;
    let materials = material::materials(scene, &numbers, context)?;
    let unweighted = skin::unweighted_meshes(scene, context)?;
    let layout = nodes::layout(scene, &unweighted, context)?;
    let (skins, joints) = skin::skins(scene, &space, &layout, &unweighted, context)?;
    let meshes = mesh::meshes(scene, &space, &joints, context)?;
    let (skeleton, instances) = scene::build(scene, &space, &layout, &skins, &meshes, context)?;
    let skeleton = Arc::new(skeleton);
    let takes = take::takes(scene, &space, &layout, &skeleton, &instances, &meshes, context)?;
    let model = ModelData {
        name: String::new(),
        meshes: meshes.into_iter().map(|read| read.mesh).collect(),
        instances,
        skins: skins.into_iter().map(|read| read.skin).collect(),
        materials,
        images,
        animation: AnimationData { skeleton, takes },
        ..ModelData::default()
    };
    Ok(ConvertedScene { model, textures })
}
