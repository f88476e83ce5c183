//! Buffer views compressed by meshoptimizer: `EXT_meshopt_compression` and its successor `KHR_meshopt_compression`.
//!
//! Each view is decoded on its own: to elements of the same size (`attributes`, then `filter`), or to indices
//! (`triangles`, `indices`). Every byte that is read comes from [`MeshoptStream`], which knows where the data ends. Memory
//! is charged before anything is allocated.

mod attributes;
mod filter;
mod indices;
mod stream;
mod triangles;

use super::accessor::{invalid, unresolved};
use super::buffer::BufferData;
use super::check as code;
use crate::format::{ImportContext, ImportError, Place};
use filter::MeshoptFilter;
use gltf::json;
use serde_json::{Map, Value};
use std::collections::HashMap;
use stream::MeshoptFault;

/// Names of the extensions; the first one that a view has is used.
const NAMES: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// Encoding of the data of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MeshoptMode {
    /// Elements of any kind.
    Attributes,
    /// Indices of triangles.
    Triangles,
    /// Other indices.
    Indices,
}

/// The members of the extension object of a view.
struct CompressedView {
    buffer: usize,
    offset: usize,
    length: usize,
    stride: usize,
    count: usize,
    mode: MeshoptMode,
    filter: MeshoptFilter,
}

/// Returns the bytes of every compressed view, by its number.
pub(super) fn decode(
    root: &json::Root,
    buffers: &[BufferData<'_>],
    context: &ImportContext<'_>,
) -> Result<HashMap<usize, Vec<u8>>, ImportError> {
    let mut decoded = HashMap::new();
    for (number, view) in root.buffer_views.iter().enumerate() {
        context.work(1)?;
        if let Some((name, object)) = extension_of(view) {
            let path = format!("/bufferViews/{number}/extensions/{name}");
            decoded.insert(number, decode_view(view, object, &path, buffers, context)?);
        }
    }
    Ok(decoded)
}

/// Returns for each buffer whether only compressed views refer to it, so that its bytes are needed by programs without
/// the extension only.
pub(super) fn fallbacks(root: &json::Root, context: &ImportContext<'_>) -> Result<Vec<bool>, ImportError> {
    let place = Place::Pointer("/buffers".to_owned());
    let mut compressed = context.filled(&place, root.buffers.len(), false)?;
    let mut plain = context.filled(&place, root.buffers.len(), false)?;
    for view in &root.buffer_views {
        context.work(1)?;
        let extension = extension_of(view);
        let is_compressed = extension.is_some();
        let list = if is_compressed { &mut compressed } else { &mut plain };
        if let Some(is) = list.get_mut(view.buffer.value()) {
            *is = true;
        }
        let source = extension.and_then(|(_, object)| number_of(object, "buffer"));
        if let Some(is) = source.and_then(|source| plain.get_mut(source)) {
            *is = true;
        }
    }
    for (compressed, plain) in compressed.iter_mut().zip(plain) {
        *compressed &= !plain;
    }
    Ok(compressed)
}

/// Returns the name and the object of the extension of a view.
fn extension_of(view: &json::buffer::View) -> Option<(&'static str, &Map<String, Value>)> {
    let others = &view.extensions.as_ref()?.others;
    NAMES.iter().find_map(|name| Some((*name, others.get(*name)?.as_object()?)))
}

fn number_of(object: &Map<String, Value>, name: &str) -> Option<usize> {
    object.get(name).and_then(Value::as_u64).and_then(|number| usize::try_from(number).ok())
}

impl CompressedView {
    fn of(object: &Map<String, Value>, path: &str) -> Result<Self, ImportError> {
        let number = |name: &str| {
            number_of(object, name).ok_or_else(|| {
                let reason = format!("the member {name} is missing or no whole number");
                invalid(Place::Pointer(path.to_owned()), code::MESHOPT_INVALID, reason)
            })
        };
        let word = |name: &str| object.get(name).and_then(Value::as_str);
        let unknown = |name: &str| {
            let reason = "the value is not one of those allowed".to_owned();
            invalid(Place::Pointer(format!("{path}/{name}")), code::VALUE_NOT_IN_LIST, reason)
        };
        let mode = match word("mode") {
            Some("ATTRIBUTES") => MeshoptMode::Attributes,
            Some("TRIANGLES") => MeshoptMode::Triangles,
            Some("INDICES") => MeshoptMode::Indices,
            _ => return Err(unknown("mode")),
        };
        let filter = match object.get("filter") {
            None => MeshoptFilter::None,
            Some(name) => name.as_str().and_then(MeshoptFilter::named).ok_or_else(|| unknown("filter"))?,
        };
        let offset = if object.contains_key("byteOffset") { number("byteOffset")? } else { 0 };
        Ok(Self {
            buffer: number("buffer")?,
            offset,
            length: number("byteLength")?,
            stride: number("byteStride")?,
            count: number("count")?,
            mode,
            filter,
        })
    }

    /// Checks the size of an element against mode and filter.
    fn check(&self) -> Result<(), MeshoptFault> {
        match self.mode {
            MeshoptMode::Attributes
                if !self.stride.is_multiple_of(4) || !(4..=256).contains(&self.stride) =>
            {
                Err("the byte stride of attributes must be a multiple of 4, 4..256")
            }
            MeshoptMode::Attributes if !self.filter.allows(self.stride) => {
                Err("the filter does not allow this byte stride")
            }
            MeshoptMode::Attributes => Ok(()),
            MeshoptMode::Triangles | MeshoptMode::Indices if ![2, 4].contains(&self.stride) => {
                Err("the byte stride of indices must be 2 or 4")
            }
            MeshoptMode::Triangles | MeshoptMode::Indices if self.filter != MeshoptFilter::None => {
                Err("indices have no filter")
            }
            MeshoptMode::Triangles if !self.count.is_multiple_of(3) => {
                Err("the number of indices of triangles must be a multiple of 3")
            }
            MeshoptMode::Triangles | MeshoptMode::Indices => Ok(()),
        }
    }
}

fn decode_view(
    view: &json::buffer::View,
    object: &Map<String, Value>,
    path: &str,
    buffers: &[BufferData<'_>],
    context: &ImportContext<'_>,
) -> Result<Vec<u8>, ImportError> {
    let compressed = CompressedView::of(object, path)?;
    let place = Place::Pointer(path.to_owned());
    let refuse = |reason: String| invalid(place.clone(), code::MESHOPT_INVALID, reason);
    compressed.check().map_err(|fault| refuse(fault.to_owned()))?;
    let size = compressed.count.checked_mul(compressed.stride);
    let size = size.filter(|&size| size as u64 == view.byte_length.0).ok_or_else(|| {
        refuse(format!(
            "{} elements of {} bytes are not the {} bytes of the view",
            compressed.count, compressed.stride, view.byte_length.0
        ))
    })?;
    let buffer = buffers
        .get(compressed.buffer)
        .ok_or_else(|| unresolved(&format!("{path}/buffer"), compressed.buffer))?;
    if let BufferData::Missing(error) = buffer {
        return Err(error.clone());
    }
    let end = compressed.offset.checked_add(compressed.length);
    let data = end.and_then(|end| buffer.bytes().get(compressed.offset..end)).ok_or_else(|| {
        let (length, offset) = (compressed.length, compressed.offset);
        let reason = format!(
            "{length} bytes from byte {offset} do not fit into a buffer of {} bytes",
            buffer.bytes().len()
        );
        invalid(place.clone(), code::BUFFER_VIEW_TOO_LONG, reason)
    })?;
    let mut out = context.filled(&place, size, 0)?;
    match compressed.mode {
        MeshoptMode::Attributes => attributes::decode(data, compressed.stride, &mut out),
        MeshoptMode::Triangles => triangles::decode(data, compressed.stride, &mut out),
        MeshoptMode::Indices => indices::decode(data, compressed.stride, &mut out),
    }
    .map_err(|fault| refuse(format!("the compressed data is damaged: {fault}")))?;
    context.work(size)?;
    compressed.filter.apply(compressed.stride, &mut out);
    Ok(out)
}
