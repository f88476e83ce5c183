//! Every index between the lists of a document, whether or not anything follows it.
//!
//! Who follows an index checks it again; this pass is for those that nothing follows, because a file with a broken
//! index was made by something broken.

use super::accessor::unresolved;
use crate::format::{ImportContext, ImportError};
use gltf::json::{Index, Root};

/// Refuses the document when an accessor, buffer view, texture or sampler names something that is not there.
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
        // The document model's way to say that there is none.
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

/// An error unless `index`, if there is one, names something in `list`.
fn named<T>(index: Option<Index<T>>, list: &[T], from: impl Fn() -> String) -> Result<(), ImportError> {
    match index {
        Some(index) if index.value() >= list.len() => Err(unresolved(&from(), index.value())),
        _ => Ok(()),
    }
}
