//! The dialects of the format, and the other format of the same extension.

/// The dialects, called after the version of Direct3D in the book.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum M3dDialect {
    /// The book of 2008: no bones; the subset of each triangle is its fourth number.
    Dx10,
    /// The book of 2012: ambient, diffuse and specular colors.
    Dx11,
    /// The book of 2016: materials with names, reflectance and roughness.
    Dx12,
}

/// Returns whether this is the other format whose files are named `.m3d`.
pub(super) fn is_other_format(bytes: &[u8]) -> bool {
    bytes.starts_with(b"3DMO") || bytes.starts_with(b"3dmodel")
}
