//! Writes a whole binary FBX file from any model.
//!
//! ```text
//! prepare/     what a preset wants: bind pose at rest, one root, no scale, keys at frames
//! names.rs     names of bones and takes
//! bones.rs     a node for each bone
//! instances.rs nodes of meshes ── mesh.rs geometry, shapes ── skin.rs clusters, bind pose
//! materials.rs Phong values ── images.rs textures and images, in the file or next to it
//! takes.rs     a stack for each take ── curves.rs keys ── euler.rs angles, sample.rs channels
//! scene.rs     objects and connections, the sections around them ── node.rs the bytes
//! ```
//!
//! Keys keep their times and values. Between two keys angles do not run as rotations do: where they differ by more than 0.01°, the
//! curve is cubic or gets more keys. The same model gives the same bytes on every system.

mod bones;
mod curves;
mod euler;
mod images;
mod instances;
mod losses;
mod materials;
mod mesh;
mod names;
mod node;
mod options;
mod prepare;
mod preset;
mod sample;
mod scene;
mod skin;
mod space;
mod takes;

pub use options::{FbxOptions, TexturePlacement};
pub use preset::{ExportPreset, PRESETS, preset};
pub(crate) use scene::CREATOR;

use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{ExportError, OutputFile, SavePlan};
use dragonfly_anim::frames::frame_rate;
use images::ImageTarget;
use losses::FbxLosses;
use preset::{ExportSettings, USUAL};

/// Writes a model as a binary FBX file called `name`. Images that are not in it are files of the plan, with the name of the
/// file without its extension before their own.
///
/// # Errors
///
/// An array of 4 GiB.
pub fn export_with(model: &ModelData, name: &str, options: &FbxOptions) -> Result<SavePlan, ExportError> {
    let settings = options.preset.map_or(&USUAL, ExportPreset::settings);
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let mut images = match options.textures {
        TexturePlacement::Embedded => ImageTarget::Embedded,
        TexturePlacement::Beside => ImageTarget::beside(stem),
    };
    let mut losses = FbxLosses::default();
    if !model.avatar.is_empty() {
        losses.add("/avatar", "humanoid bones and facial expressions are written to .vrma only");
    }
    let bytes = match prepare::prepared(model, settings, &mut losses)? {
        Some(prepared) => write(&prepared, settings, &mut images, &mut losses)?,
        None => write(model, settings, &mut images, &mut losses)?,
    };
    let mut files = images.into_files();
    files.push(OutputFile { name: name.to_owned(), bytes });
    Ok(SavePlan { files, lost: losses.into_list(), changes: None })
}

fn write(
    model: &ModelData,
    settings: &ExportSettings,
    images: &mut ImageTarget<'_>,
    losses: &mut FbxLosses,
) -> Result<Vec<u8>, ExportError> {
    let space = &space::FileSpace::new(settings.up, settings.meters_per_unit);
    let skeleton = &model.animation.skeleton;
    let mut scene = scene::SceneWriter::default();
    for (index, bone) in skeleton.bones.iter().enumerate() {
        if bone.rest_matrix.is_some() {
            let place = format!("/animation/skeleton/bones/{index}/rest_matrix");
            losses.add(place, format!("the shear of the bone \"{}\" is not stored", bone.name));
        }
    }
    let rest = &bones::rest_matrices(skeleton);
    let names = names::bone_names(model, settings.unique_bones, losses);
    let bones = &bones::add_bones(&mut scene, space, model, &names, settings.one_root);
    let images = images::add_images(&mut scene, &model.images, images, losses);
    let materials = &materials::add_materials(&mut scene, &model.materials, &images, losses);
    let bound: Vec<skin::BoundSkin> = model.skins.iter().map(|skin| skin::bind(skin, rest)).collect();
    let source = instances::InstanceSource { model, space, bones, rest, materials, bound: &bound };
    let shapes = &source.add(&mut scene, losses);
    let takes = takes::TakeSource { model, space, keys: settings.keys, bones, shapes };
    let names = names::take_names(model, losses);
    takes.add(&mut scene, names, losses);
    let rate = model.animation.takes.first().map_or(30.0, |take| frame_rate(take));
    scene.finish(&model.name, rate, settings)
}
