//! Checks every index between the lists of a document, including those that no other module uses.
//!
//! Modules that use an index check it again. This pass covers the unused ones, because a file with an invalid index was
//! written by a faulty exporter.

use super::accessor::unresolved;
use crate::format::{ImportContext, ImportError};
use gltf::json::{Index, Root};

/// Refuses a document in which an accessor, buffer view, texture or sampler has an index that is out of range.
pub(super) fn check(root: &Root, context: &ImportContext<'_>) -> Result<(), ImportError> {
    for (index, accessor) in root.accessors.iter().enumerate() {
        context.work(1)?;
        let at = |rest: &str| format!("/accessors/{index}/{rest}");
        named(accessor.buffer_view, &root.buffer_views, || at("bufferView"))?;
        if let Some(sparse) = &accessor.sparse {
            named(Some(sparse.indices.buffer_view), &root.buffer_views, || at("sparse/indices/bufferView"))?;
            named(Some(sparse.values.buffer_view), &root.buffer_views, || at("sparse/values/bufferView"))?;
        }
    }
    for (index, view) in root.buffer_views.iter().enumerate() {
        context.work(1)?;
        named(Some(view.buffer), &root.buffers, || format!("/bufferViews/{index}/buffer"))?;
    }
    for (index, texture) in root.textures.iter().enumerate() {
        context.work(1)?;
        named(texture.sampler, &root.samplers, || format!("/textures/{index}/sampler"))?;
        // The document model's value for "no source".
        let source = Some(texture.source).filter(|source| source.value() != u32::MAX as usize);
        named(source, &root.images, || format!("/textures/{index}/source"))?;
    }
    for (index, animation) in root.animations.iter().enumerate() {
        for (number, sampler) in animation.samplers.iter().enumerate() {
            context.work(1)?;
            let at = |end: &str| format!("/animations/{index}/samplers/{number}/{end}");
            named(Some(sampler.input), &root.accessors, || at("input"))?;
            named(Some(sampler.output), &root.accessors, || at("output"))?;
        }
    }
    Ok(())
}

/// Returns an error if `index` is out of the range of `list`.
fn named<T>(index: Option<Index<T>>, list: &[T], from: impl Fn() -> String) -> Result<(), ImportError> {
    match index {
        Some(index) if index.value() >= list.len() => Err(unresolved(&from(), index.value())),
        _ => Ok(()),
    }
}
