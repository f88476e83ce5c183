//! The parts of a file, in their order: the six of the thesis, then those with a tag; and the marks around them.

/// Major and minor version that is written. Files of another major version are refused. Files of a newer minor version
/// are read, with a warning, without the content that this version does not know.
pub const VERSION: (u16, u16) = (1, 0);

/// Tag before the directory of the parts.
pub(super) const DIRECTORY_TAG: [u8; 4] = *b"SUMS";

/// Last four bytes of every file.
pub(super) const ENDING_MAGIC: [u8; 4] = *b"dfm\x1a";

/// A part of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DfmPart {
    Vertices,
    Indices,
    Attributes,
    Materials,
    Bones,
    Takes,
    TextLengths,
    Text,
    Meshes,
    Primitives,
    Tangents,
    Colors,
    Influences,
    MorphTargets,
    Differences,
    Weights,
    Instances,
    Skins,
    Joints,
    Images,
    ImageBytes,
    Slopes,
    MorphTracks,
    MorphKeys,
}

/// Name and element size of a part.
pub(super) struct PartLayout {
    pub(super) part: DfmPart,
    /// Tag before the part (except for those of the thesis) and in the directory.
    pub(super) tag: [u8; 4],
    /// Name in messages.
    pub(super) name: &'static str,
    /// Size of one element in bytes; for takes: of the fixed parts of a take and of a track, and of a key-frame.
    pub(super) sizes: [usize; 3],
}

/// Number of parts.
const COUNT: usize = DfmPart::MorphKeys as usize + 1;

/// Every part, in the order of the file.
pub(super) type PartList = [PartLayout; COUNT];

impl DfmPart {
    /// Returns whether the part is one of the thesis, which have no tag.
    pub(super) fn is_of_thesis(self) -> bool {
        self as usize <= Self::Takes as usize
    }

    /// Returns the number of bytes before the first element: the tag if there is one, the count, the size; takes have
    /// three sizes.
    pub(super) fn header_bytes(self) -> usize {
        match self {
            Self::Takes => 16,
            part if part.is_of_thesis() => 8,
            _ => 12,
        }
    }
}
