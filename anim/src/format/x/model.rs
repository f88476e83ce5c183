//! The objects of a file become a model.

use super::geometry::primitives;
use super::header::XFile;
use super::mesh::XMesh;
use super::scene::XScene;
use super::skeleton::BoneList;
use super::skin::{XInfluences, skin};
use super::surface::MaterialList;
use super::take::SetReader;
use crate::data::{AnimationData, BoneIndex, Mesh, MeshInstance, ModelData, Skin};
use crate::format::{Conversion, ImportContext, ImportError, Place};
use glam::Mat4;
use std::sync::Arc;

/// Returns the model.
pub(super) fn model(
    file: &XFile<'_>,
    scene: XScene,
    conversion: &Conversion,
    context: &ImportContext<'_>,
) -> Result<ModelData, ImportError> {
    let axes = conversion.axes();
    let mut bones = BoneList::of(&scene, &axes, context)?;
    let mut materials = MaterialList::new(&scene.materials, context)?;
    let (mut meshes, mut skins) = (context.vec(&Place::File, scene.meshes.len())?, Vec::new());
    let mut skin_of: Vec<Option<u32>> = context.vec(&Place::File, scene.meshes.len())?;
    context.charge(&Place::File, scene.meshes.len() as u64 * 2 * size_of::<Skin>() as u64)?;
    for (index, mesh) in scene.meshes.iter().enumerate() {
        let frame = scene.placed.iter().find(|(placed, _)| *placed == index).and_then(|(_, frame)| *frame);
        let frame = frame.map(|frame| frame as BoneIndex);
        let (own_skin, influences) = match skin(mesh, frame, &axes, &mut bones, context)? {
            Some((skin, influences)) => (Some(skin), influences),
            None => (None, XInfluences::default()),
        };
        let used = used_materials(mesh, &mut materials, context)?;
        let primitives = primitives(mesh, &used, &influences, &axes, context)?;
        meshes.push(Mesh { name: mesh.name.clone(), primitives, morph_weights: Vec::new() });
        skin_of.push(own_skin.is_some().then_some(skins.len() as u32));
        skins.extend(own_skin);
        context.progress(0.5 + 0.3 * (index + 1) as f32 / scene.meshes.len() as f32)?;
    }
    let mut instances = context.vec(&Place::File, scene.placed.len())?;
    for &(mesh, frame) in &scene.placed {
        let skin = skin_of[mesh];
        instances.push(MeshInstance {
            mesh: mesh as u32,
            node: None,
            skin,
            bone: frame.map(|frame| frame as BoneIndex).filter(|_| skin.is_none()),
            to_bone: Mat4::IDENTITY,
            morph_weights: Vec::new(),
        });
    }
    let mut takes = context.vec(&Place::File, scene.sets.len())?;
    let count = bones.len();
    let reader = SetReader { file, places: file.lexer(), bones: &bones, axes, conversion, context };
    for set in &scene.sets {
        takes.push(Arc::new(reader.take(set, count)?));
    }
    let offsets =
        skins.iter().flat_map(|skin: &Skin| skin.bones.iter().copied().zip(skin.offsets.iter().copied()));
    let skeleton = Arc::new(bones.finish(offsets));
    let (materials, images) = materials.finish();
    let animation = AnimationData { skeleton, takes };
    Ok(ModelData {
        name: String::new(),
        meshes,
        instances,
        skins,
        materials,
        images,
        animation,
        ..ModelData::default()
    })
}

/// Returns the numbers in the model of the materials of a mesh.
fn used_materials(
    mesh: &XMesh,
    materials: &mut MaterialList<'_>,
    context: &ImportContext<'_>,
) -> Result<Vec<Option<u32>>, ImportError> {
    let mut used = context.vec(&Place::File, mesh.materials.len())?;
    for material in &mesh.materials {
        used.push(materials.number(material)?);
    }
    Ok(used)
}
