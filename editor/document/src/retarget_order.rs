//! Takes of another model for the open one: orders, results, and the computation.

use super::LoadedModel;
use super::bone_map::BoneMap;
use super::clips::{ClipNaming, take_name};
use crate::adapter::ModelAdapter;
use crate::edit::{AddLayer, AddTake, Edit, LayerKind, TakeRef};
use dragonfly_anim::data::{BoneIndex, ModelData};
use dragonfly_anim::retarget::{FigureOptions, SkeletonBinding, retarget_expressions, retarget_figure};
use dragonfly_runtime::Job;
use std::path::PathBuf;
use std::sync::Arc;

/// A take of the source for the open model.
#[derive(Clone, Debug, PartialEq)]
pub struct RetargetOrder {
    /// Index of the take in the source.
    pub take: usize,
    /// The take of the open model over which the result becomes a layer of poses; where absent, it becomes a take.
    pub layer_of: Option<TakeRef>,
    /// Bones of the source and of the open model.
    pub pairs: Vec<(BoneIndex, BoneIndex)>,
    /// Options for the figure.
    pub options: FigureOptions,
}

/// An action with a file of a bone map.
#[derive(Clone, Debug, PartialEq)]
pub enum MapFile {
    /// Reads it.
    Read(PathBuf),
    /// Writes it; a file of the name is replaced.
    Write(PathBuf, BoneMap),
}

/// The source of takes, and the jobs for it.
#[derive(Default)]
pub(super) struct Retargeting {
    pub(super) source: Option<Arc<LoadedModel>>,
    /// The last job; dropping it cancels it.
    pub(super) job: Option<Job>,
}

/// The result of a job.
#[derive(Debug)]
pub(super) enum RetargetNews {
    /// The source was read.
    Source(Result<Arc<LoadedModel>, String>),
    /// A take was computed, with a sentence about it.
    Take(Result<(Box<Edit>, String), String>),
    /// A map was read.
    Map(Result<BoneMap, String>),
    /// A map was written.
    Written(Result<PathBuf, String>),
}

/// Writes a bone map. A file that is no bone map, for example a model whose path was typed, is not overwritten.
pub(super) fn write_map(path: &std::path::Path, map: &BoneMap) -> Result<(), String> {
    if path.exists() && BoneMap::read(path).is_err() {
        return Err(format!("{} exists and is no bone map: choose another name", path.display()));
    }
    let written = dragonfly_store::replace(path, map.to_text().as_bytes());
    written.map(|_| ()).map_err(|error| format!("{}: {error}", path.display()))
}

/// Returns the edit that adds the take, or a layer with its keys, to the model `target`, with the takes of `adapter`, and a sentence about it.
pub(super) fn computed(
    source: &LoadedModel,
    adapter: &ModelAdapter,
    target: &ModelData,
    order: &RetargetOrder,
) -> Result<(Box<Edit>, String), String> {
    let animation = &source.model.animation;
    let take = animation.takes.get(order.take).ok_or("the source has no such take")?;
    let (from, to) = (&*animation.skeleton, &*target.animation.skeleton);
    let binding = SkeletonBinding::from_map(from, to, &order.pairs).map_err(|error| error.to_string())?;
    let done =
        retarget_figure(take, from, to, &binding, &order.options).map_err(|error| error.to_string())?;
    let base = take_name(&source.title, take, 1, ClipNaming::Automatic);
    let feet = match done.contacts.len() {
        0 => String::new(),
        count => format!(", {count} contacts of feet within {:.1} mm", done.slide_after),
    };
    let facts = format!("{} bones move{feet}", binding.bound());
    let mut add = AddTake::of(base.clone(), &done.take);
    if let Some(over) = &order.layer_of {
        let layers = adapter.base(over).map_err(|error| error.to_string())?.layers();
        let names: Vec<&str> = layers.iter().map(|layer| &*layer.settings.name).collect();
        let name = unused_name(&base, &names);
        let text = format!("Added the layer {name}: {facts}");
        let layer = AddLayer { tracks: add.tracks, ..AddLayer::new(over.clone(), name, LayerKind::Override) };
        return Ok((Box::new(Edit::AddLayer(layer)), text));
    }
    let names: Vec<&str> = adapter.slots().iter().map(|slot| &*slot.original.name).collect();
    let name = unused_name(&base, &names);
    let text = format!("Added {name}: {facts}");
    let shapes = retarget_expressions(take, &source.model.avatar, target);
    add.name = name;
    Ok((Box::new(Edit::AddTake(add.with_shapes(&shapes))), text))
}

/// Returns `base`, with the first number that makes it another name than all of `names`; 1 is not written.
fn unused_name(base: &str, names: &[&str]) -> String {
    let numbered = |number: usize| if number == 1 { base.to_owned() } else { format!("{base} {number}") };
    let unused = |name: &String| !names.contains(&name.as_str());
    (1..=names.len() + 1).map(numbered).find(unused).unwrap_or_default()
}
