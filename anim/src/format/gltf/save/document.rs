//! What the JSON says about animations and where their numbers are, without reading the numbers.

use super::json::tree::{Id, Json};
use super::source::{SourceFile, is_data};
use crate::format::uri::DataUri;
use std::cell::OnceCell;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// What a channel moves of a node or mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Path {
    Translation,
    Rotation,
    Scale,
    Weights,
}

impl Path {
    /// As the file says it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Translation => "translation",
            Self::Rotation => "rotation",
            Self::Scale => "scale",
            Self::Weights => "weights",
        }
    }

    fn named(name: &str) -> Option<Self> {
        [Self::Translation, Self::Rotation, Self::Scale, Self::Weights]
            .into_iter()
            .find(|path| path.name() == name)
    }
}

/// A node and what of it is moved.
pub(super) type Target = (u32, Path);

/// A channel of an animation.
#[derive(Clone, Copy, Debug)]
pub(super) struct FileChannel {
    pub(super) id: Id,
    pub(super) sampler: Option<usize>,
    /// `None` when it moves something that importing leaves out.
    pub(super) target: Option<Target>,
}

/// An animation of the file.
#[derive(Clone, Debug)]
pub(super) struct FileAnimation {
    pub(super) id: Id,
    pub(super) channels: Vec<FileChannel>,
    pub(super) samplers: Vec<Id>,
    /// The first channel of each target: the one that importing takes.
    firsts: HashMap<Target, usize>,
}

impl FileAnimation {
    fn of(json: Json<'_>, id: Id) -> Self {
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

    /// The number of the channel that importing takes for a target.
    pub(super) fn channel(&self, target: Target) -> Option<usize> {
        self.firsts.get(&target).copied()
    }
}

fn target_of(json: Json<'_>, target: Id) -> Option<Target> {
    let path = Path::named(&json.string_member(target, "path")?)?;
    let node = u32::try_from(json.whole_member(target, "node")?).ok()?;
    (node != u32::MAX).then_some((node, path))
}

/// The lists of a document that a save deals with.
pub(super) struct Document<'a> {
    pub(super) source: &'a SourceFile,
    pub(super) json: Json<'a>,
    pub(super) accessors: Vec<Id>,
    pub(super) views: Vec<Id>,
    pub(super) buffers: Vec<Id>,
    pub(super) nodes: Vec<Id>,
    pub(super) animations: Vec<FileAnimation>,
    /// Bytes of the buffers, as they are asked for.
    bytes: Vec<OnceCell<Option<BufferBytes>>>,
}

/// The bytes of a buffer: all that are there, which may be more than it announces.
#[derive(Clone)]
pub(super) enum BufferBytes {
    /// A part of the file.
    Chunk(Range<usize>),
    /// A decoded data URI, or a file beside this one.
    Shared(Arc<[u8]>),
}

impl<'a> Document<'a> {
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

    /// All bytes that are there for a buffer; `None` where they cannot be had.
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

    /// Is there an extension on this object?
    pub(super) fn is_extended(&self, id: Id) -> bool {
        self.json.member(id, "extensions").is_some()
    }

    /// Buffer, offset and length of a view.
    pub(super) fn view_range(&self, view: usize) -> Option<(usize, u64, u64)> {
        let id = *self.views.get(view)?;
        let offset = match self.json.member(id, "byteOffset") {
            Some(offset) => self.json.whole(offset)?,
            None => 0,
        };
        Some((self.json.index_member(id, "buffer")?, offset, self.json.whole_member(id, "byteLength")?))
    }

    /// Do the key times that an accessor holds equal `times`, as plain floats in a row? `false` where it is not known.
    pub(super) fn holds_times(&self, accessor: usize, times: &[f32]) -> bool {
        let bytes = self.plain_floats(accessor, "SCALAR", times.len());
        bytes.is_some_and(|bytes| {
            let floats = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
            // 0 and -0 are the same time.
            floats.eq(times.iter().copied())
        })
    }

    /// The bytes of an accessor of `count` elements, if they are floats of that shape without gaps.
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
