//! glTF 2.0, as JSON with files beside it (`.gltf`) or in one binary container (`.glb`).

use super::{AssetFs, Format, ImportError, guard::Guard};
use crate::data::ModelData;

/// Binary container.
pub const GLB: Format =
    Format { name: "glb", extensions: &["glb"], detect: |bytes| bytes.starts_with(b"glTF"), read: read_glb };

/// JSON text.
pub const GLTF: Format = Format { name: "gltf", extensions: &["gltf"], detect: looks_like_json, read: read_json };

fn looks_like_json(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'{')
}

fn read_glb(_bytes: &[u8], _door: &dyn AssetFs, _guard: &Guard<'_>) -> Result<ModelData, ImportError> {
    Err(ImportError::Cancelled)
}

fn read_json(_bytes: &[u8], _door: &dyn AssetFs, _guard: &Guard<'_>) -> Result<ModelData, ImportError> {
    Err(ImportError::Cancelled)
}
