//! The rules that an OBJ file can break: codes of errors and warnings.

/// The text has no statement of an OBJ file.
pub const NO_STATEMENT: &str = "NO_STATEMENT";
/// A statement has too few values.
pub const VALUE_MISSING: &str = "VALUE_MISSING";
/// A corner refers to a vertex that does not exist.
pub const INDEX_INVALID: &str = "INDEX_INVALID";
/// A corner refers to a normal or texture coordinate that does not exist; it is left out.
pub const ATTRIBUTE_INVALID: &str = "ATTRIBUTE_INVALID";
/// A polygon has no area, or fewer than three corners; it is left out.
pub const POLYGON_DEGENERATE: &str = "POLYGON_DEGENERATE";
/// A polygon crosses itself, or is too large; its triangles may overlap.
pub const POLYGON_APPROXIMATE: &str = "POLYGON_APPROXIMATE";
/// A statement is not shown: points, lines, curves, surfaces, and unknown ones.
pub const STATEMENT_IGNORED: &str = "STATEMENT_IGNORED";
/// The file of the materials cannot be read.
pub const MATERIALS_MISSING: &str = "MATERIALS_MISSING";
/// No file of materials has a material of this name; a gray one is used.
pub const MATERIAL_UNKNOWN: &str = "MATERIAL_UNKNOWN";
/// A value of a material is ignored.
pub const MATERIAL_VALUE_IGNORED: &str = "MATERIAL_VALUE_IGNORED";
