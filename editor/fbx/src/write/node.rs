//! The binary encoding: a tree of named nodes with properties, and the bytes around it.
//!
//! ```text
//! magic, version │ nodes │ null node │ footer
//! node: end, number of properties, their bytes, name │ properties │ nodes, null node
//! ```
//!
//! Version 7400 counts bytes in 32 bits, version 7500 in 64. Identifier, creation time and footer belong together: programs of
//! Autodesk check them, so all files have those that the other open writers use.

use super::scene::FILE_ID;
use dragonfly_anim::format::ExportError;
use miniz_oxide::deflate::compress_to_vec_zlib;

/// First bytes of a file.
const MAGIC: &[u8] = b"Kaydara FBX Binary  \0\x1a\0";

/// The two parts of the footer that are always the same.
const FOOTER: [[u8; 16]; 2] = [
    [0xfa, 0xbc, 0xab, 0x09, 0xd0, 0xc8, 0xd4, 0x66, 0xb1, 0x76, 0xfb, 0x83, 0x1c, 0xf7, 0x26, 0x7e],
    [0xf8, 0x5a, 0x8c, 0x6a, 0xde, 0xf5, 0xd9, 0x7e, 0xec, 0xe9, 0x0c, 0xe3, 0x75, 0x8f, 0x29, 0x0b],
];

/// Number of bytes from which an array is compressed.
const COMPRESSED_FROM: usize = 128;

/// Level of compression, 0 to 10: most of what is possible, in a fraction of the time.
const COMPRESSION: u8 = 6;

/// A property of a node.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum FbxProperty {
    Flag(bool),
    Int(i32),
    Long(i64),
    Double(f64),
    Text(String),
    Bytes(Vec<u8>),
    Ints(Vec<i32>),
    Longs(Vec<i64>),
    Floats(Vec<f32>),
    Doubles(Vec<f64>),
}

macro_rules! property_from {
    ($($from:ty => $kind:ident),* $(,)?) => {
        $(impl From<$from> for FbxProperty {
            fn from(value: $from) -> Self {
                Self::$kind(value.into())
            }
        })*
    };
}

property_from! {
    bool => Flag,
    i32 => Int,
    i64 => Long,
    f64 => Double,
    &str => Text,
    String => Text,
    Vec<i32> => Ints,
    Vec<i64> => Longs,
    Vec<f32> => Floats,
    Vec<f64> => Doubles,
}

/// A node: a name, properties, and nodes in it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FbxNode {
    name: &'static str,
    properties: Vec<FbxProperty>,
    children: Vec<FbxNode>,
}

impl FbxNode {
    /// Returns a node without properties.
    pub(super) fn new(name: &'static str) -> Self {
        Self { name, properties: Vec::new(), children: Vec::new() }
    }

    /// Adds a property.
    pub(super) fn with(mut self, property: impl Into<FbxProperty>) -> Self {
        self.properties.push(property.into());
        self
    }

    /// Adds nodes.
    pub(super) fn containing(mut self, children: impl IntoIterator<Item = FbxNode>) -> Self {
        self.children.extend(children);
        self
    }

    /// Adds a node that has one property.
    pub(super) fn value(self, name: &'static str, property: impl Into<FbxProperty>) -> Self {
        self.containing([Self::new(name).with(property)])
    }

    /// Adds a node.
    pub(super) fn push(&mut self, child: FbxNode) {
        self.children.push(child);
    }
}

/// Returns a setting of a list of properties: name, type, label, flags.
pub(super) fn setting(name: &str, kind: &str, label: &str, flags: &str) -> FbxNode {
    FbxNode::new("P").with(name).with(kind).with(label).with(flags)
}

/// Returns the bytes of a file with these nodes at its top.
///
/// # Errors
///
/// An array or a text of 4 GiB.
pub(super) fn encode(nodes: &[FbxNode]) -> Result<Vec<u8>, ExportError> {
    let narrow = FbxEncoder::file(nodes, false)?;
    if u32::try_from(narrow.len()).is_ok() { Ok(narrow) } else { FbxEncoder::file(nodes, true) }
}

/// Bytes of a file so far.
struct FbxEncoder {
    bytes: Vec<u8>,
    /// Whether positions have 64 bits.
    is_wide: bool,
}

impl FbxEncoder {
    fn file(nodes: &[FbxNode], is_wide: bool) -> Result<Vec<u8>, ExportError> {
        let version: u32 = if is_wide { 7500 } else { 7400 };
        let mut encoder = Self { bytes: MAGIC.to_vec(), is_wide };
        encoder.bytes.extend(version.to_le_bytes());
        for node in nodes {
            encoder.node(node, false)?;
        }
        encoder.null();
        let mut bytes = encoder.bytes;
        bytes.extend(FOOTER[0]);
        bytes.extend([0; 4]);
        // At least one byte up to the next multiple of 16.
        bytes.resize((bytes.len() + 1).next_multiple_of(16), 0);
        bytes.extend(version.to_le_bytes());
        bytes.extend([0; 120]);
        bytes.extend(FOOTER[1]);
        Ok(bytes)
    }

    /// Appends a number of bytes or properties.
    fn count(&mut self, count: usize) {
        match self.is_wide {
            true => self.bytes.extend((count as u64).to_le_bytes()),
            // A file that is too long is written again with wide numbers.
            false => self.bytes.extend((count as u32).to_le_bytes()),
        }
    }

    /// Appends the node that ends a list.
    fn null(&mut self) {
        for _ in 0..3 {
            self.count(0);
        }
        self.bytes.push(0);
    }

    fn node(&mut self, node: &FbxNode, is_last: bool) -> Result<(), ExportError> {
        let start = self.bytes.len();
        self.count(0);
        self.count(node.properties.len());
        self.count(0);
        self.bytes.push(node.name.len() as u8);
        self.bytes.extend(node.name.as_bytes());
        let first = self.bytes.len();
        for property in &node.properties {
            self.property(property)?;
        }
        let properties = self.bytes.len() - first;
        for (index, child) in node.children.iter().enumerate() {
            self.node(child, index + 1 == node.children.len())?;
        }
        let is_list = matches!(node.name, "AnimationStack" | "AnimationLayer");
        if !node.children.is_empty() || is_list || (node.properties.is_empty() && !is_last) {
            self.null();
        }
        let width = if self.is_wide { 8 } else { 4 };
        for (position, count) in [(start, self.bytes.len()), (start + 2 * width, properties)] {
            let number = (count as u64).to_le_bytes();
            self.bytes[position..position + width].copy_from_slice(&number[..width]);
        }
        Ok(())
    }

    fn property(&mut self, property: &FbxProperty) -> Result<(), ExportError> {
        match property {
            FbxProperty::Flag(flag) => self.bytes.extend([b'C', u8::from(*flag)]),
            FbxProperty::Int(number) => self.scalar(b'I', &number.to_le_bytes()),
            FbxProperty::Long(number) => self.scalar(b'L', &number.to_le_bytes()),
            FbxProperty::Double(number) => self.scalar(b'D', &number.to_le_bytes()),
            FbxProperty::Text(text) => {
                self.scalar(b'S', &length(text.len())?);
                self.bytes.extend(text.as_bytes());
            }
            FbxProperty::Bytes(bytes) => {
                self.scalar(b'R', &length(bytes.len())?);
                self.bytes.extend(bytes);
            }
            FbxProperty::Ints(numbers) => self.array(b'i', numbers, |number| number.to_le_bytes())?,
            FbxProperty::Longs(numbers) => self.array(b'l', numbers, |number| number.to_le_bytes())?,
            FbxProperty::Floats(numbers) => self.array(b'f', numbers, |number| number.to_le_bytes())?,
            FbxProperty::Doubles(numbers) => self.array(b'd', numbers, |number| number.to_le_bytes())?,
        }
        Ok(())
    }

    fn scalar(&mut self, kind: u8, bytes: &[u8]) {
        self.bytes.push(kind);
        self.bytes.extend(bytes);
    }

    fn array<T: Copy, const N: usize>(
        &mut self,
        kind: u8,
        numbers: &[T],
        bytes_of: impl Fn(T) -> [u8; N],
    ) -> Result<(), ExportError> {
        let plain: Vec<u8> = numbers.iter().flat_map(|&number| bytes_of(number)).collect();
        let is_compressed = plain.len() >= COMPRESSED_FROM;
        let stored = if is_compressed { compress_to_vec_zlib(&plain, COMPRESSION) } else { plain };
        self.scalar(kind, &length(numbers.len())?);
        self.bytes.extend(u32::from(is_compressed).to_le_bytes());
        self.bytes.extend(length(stored.len())?);
        self.bytes.extend(stored);
        Ok(())
    }
}

/// Returns the bytes of a length.
fn length(count: usize) -> Result<[u8; 4], ExportError> {
    let count = u32::try_from(count)
        .map_err(|_| ExportError::new("a list is longer than an FBX file can store (4 GiB)"))?;
    Ok(count.to_le_bytes())
}

/// Returns the node with the identifier of the file.
pub(super) fn file_id() -> FbxNode {
    let mut node = FbxNode::new("FileId");
    node.properties.push(FbxProperty::Bytes(FILE_ID.to_vec()));
    node
}

/// Returns a node with bytes.
pub(super) fn bytes_node(name: &'static str, bytes: &[u8]) -> FbxNode {
    let mut node = FbxNode::new(name);
    node.properties.push(FbxProperty::Bytes(bytes.to_vec()));
    node
}
