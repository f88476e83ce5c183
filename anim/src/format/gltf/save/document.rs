//! The animations of the JSON text and where their numbers are stored, without reading the numbers.

use super::super::target_path::{self, TargetPath};
use super::json::tree::{Json, ValueId};
use super::source::{SourceFile, is_data};
use crate::format::uri::DataUri;
use std::cell::OnceCell;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// A node and its animated property.
pub(super) type ChannelTarget = (u32, TargetPath);

/// A channel of an animation.
#[derive(Clone, Copy, Debug)]
pub(super) struct FileChannel {
    pub(super) id: ValueId,
    pub(super) sampler: Option<usize>,
    /// `None` for a target that the importer leaves out.
    pub(super) target: Option<ChannelTarget>,
}

/// An animation of the file.
#[derive(Clone, Debug)]
pub(super) struct FileAnimation {
    pub(super) id: ValueId,
    pub(super) channels: Vec<FileChannel>,
    pub(super) samplers: Vec<ValueId>,
    /// The first channel of each target, which is the one that the importer uses.
    firsts: HashMap<ChannelTarget, usize>,
}

impl FileAnimation {
    fn of(json: Json<'_>, id: ValueId) -> Self {
        let channels = json.list(id, "channels").into_iter().map(|id| {
            let target = json.member(id, "target").and_then(|target| target_of(json, target));
            FileChannel { id, sampler: json.index_member(id, "sampler"), target }
        });
        let channels: Vec<FileChannel> = channels.collect();
        let mut firsts = HashMap::new();
        for (number, channel) in channels.iter().enumerate() {
            if let Some(target) = channel.target {
                firsts.entry(target).or_insert(number);
            }
        }
        Self { id, channels, samplers: json.list(id, "samplers"), firsts }
    }

    /// Returns the number of the channel that the importer uses for a target.
    pub(super) fn channel(&self, target: ChannelTarget) -> Option<usize> {
        self.firsts.get(&target).copied()
    }
}

fn target_of(json: Json<'_>, target: ValueId) -> Option<ChannelTarget> {
    let Some(path) = TargetPath::named(&json.string_member(target, "path")?) else {
        let extension = json.member(json.member(target, "extensions")?, target_path::POINTER_EXTENSION)?;
        return target_path::node_target(&json.string_member(extension, "pointer")?);
    };
    let node = u32::try_from(json.whole_member(target, "node")?).ok()?;
    (node != u32::MAX).then_some((node, path))
}

/// The lists of a document that a save uses.
pub(super) struct SourceDocument<'a> {
    pub(super) source: &'a SourceFile,
    pub(super) json: Json<'a>,
    pub(super) accessors: Vec<ValueId>,
    pub(super) views: Vec<ValueId>,
    pub(super) buffers: Vec<ValueId>,
    pub(super) nodes: Vec<ValueId>,
    pub(super) animations: Vec<FileAnimation>,
    /// Bytes of the buffers, loaded when needed.
    bytes: Vec<OnceCell<Option<BufferBytes>>>,
}

/// Bytes of a buffer: all that exist, which may be more than its `byteLength`.
#[derive(Clone)]
pub(super) enum BufferBytes {
    /// A range of the file.
    Chunk(Range<usize>),
    /// A decoded data URI, or a referenced file.
    Shared(Arc<[u8]>),
}

impl<'a> SourceDocument<'a> {
    pub(super) fn of(source: &'a SourceFile) -> Self {
        let json = source.json();
        let buffers = json.list(0, "buffers");
        let animations = json.list(0, "animations");
        Self {
            source,
            json,
            accessors: json.list(0, "accessors"),
            views: json.list(0, "bufferViews"),
            bytes: buffers.iter().map(|_| OnceCell::new()).collect(),
            buffers,
            nodes: json.list(0, "nodes"),
            animations: animations.into_iter().map(|id| FileAnimation::of(json, id)).collect(),
        }
    }

    /// Returns all bytes of a buffer; `None` if they are not available.
    pub(super) fn buffer(&self, index: usize) -> Option<&[u8]> {
        match self.bytes.get(index)?.get_or_init(|| self.load(index)).as_ref()? {
            BufferBytes::Chunk(range) => self.source.bytes.get(range.clone()),
            BufferBytes::Shared(bytes) => Some(bytes),
        }
    }

    fn load(&self, index: usize) -> Option<BufferBytes> {
        let Some(uri) = self.json.member(self.buffers[index], "uri") else {
            let bin = self.source.container.glb.as_ref()?.bin.clone();
            return bin.filter(|_| index == 0).map(BufferBytes::Chunk);
        };
        let uri = self.json.string(uri)?;
        if !is_data(&uri) {
            return self.source.beside.get(&index).cloned().map(BufferBytes::Shared);
        }
        let data = DataUri::parse(&uri)?.ok()?;
        let mut bytes = Vec::with_capacity(data.capacity());
        data.decode(&mut bytes).ok()?;
        Some(BufferBytes::Shared(bytes.into()))
    }

    /// Returns whether this object has an extension.
    pub(super) fn is_extended(&self, id: ValueId) -> bool {
        self.json.member(id, "extensions").is_some()
    }

    /// Returns whether a buffer is for programs that do not support the extension of the views that refer to it; no other
    /// view may refer to it.
    pub(super) fn is_fallback(&self, buffer: ValueId) -> bool {
        let extensions = self.json.member(buffer, "extensions");
        let mut objects = extensions.into_iter().flat_map(|extensions| self.json.items(extensions));
        objects.any(|object| {
            let fallback = self.json.member(object, "fallback");
            fallback.is_some_and(|fallback| self.json.token(fallback) == b"true")
        })
    }

    /// Returns buffer, offset and length of a view.
    pub(super) fn view_range(&self, view: usize) -> Option<(usize, u64, u64)> {
        let id = *self.views.get(view)?;
        let offset = match self.json.member(id, "byteOffset") {
            Some(offset) => self.json.whole(offset)?,
            None => 0,
        };
        Some((self.json.index_member(id, "buffer")?, offset, self.json.whole_member(id, "byteLength")?))
    }

    /// Returns whether the accessor contains exactly the key times `times` as contiguous floats; `false` if its bytes
    /// are not available.
    pub(super) fn holds_times(&self, accessor: usize, times: &[f32]) -> bool {
        let bytes = self.plain_floats(accessor, "SCALAR", times.len());
        bytes.is_some_and(|bytes| {
            let floats = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
            // 0 and -0 are the same time.
            floats.eq(times.iter().copied())
        })
    }

    /// Returns the bytes of an accessor of `count` elements, if they are floats of that shape without gaps.
    fn plain_floats(&self, accessor: usize, shape: &str, count: usize) -> Option<&[u8]> {
        let json = self.json;
        let id = *self.accessors.get(accessor)?;
        let plain = json.whole_member(id, "componentType") == Some(5126)
            && json.string_member(id, "type").as_deref() == Some(shape)
            && json.whole_member(id, "count") == Some(count as u64)
            && json.member(id, "sparse").is_none();
        let view = json.index_member(id, "bufferView").filter(|_| plain)?;
        let view_id = *self.views.get(view)?;
        let stride = json.whole_member(view_id, "byteStride");
        if self.is_extended(view_id) || stride.is_some_and(|stride| stride != 4) {
            return None;
        }
        let (buffer, offset, length) = self.view_range(view)?;
        let within = json.whole_member(id, "byteOffset").unwrap_or(0);
        let size = count as u64 * 4;
        if within.checked_add(size)? > length {
            return None;
        }
        let from = usize::try_from(offset.checked_add(within)?).ok()?;
        self.buffer(buffer)?.get(from..from.checked_add(size as usize)?)
    }
}
