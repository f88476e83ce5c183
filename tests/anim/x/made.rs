//! Files for the tests of the format.

use crate::doors::data;
use dragonfly_anim::format::{ImportError, Imported, NoFiles, ReadOptions, x::X};

pub(crate) fn import(bytes: &[u8]) -> Result<Imported, ImportError> {
    X.import(bytes, &NoFiles, &ReadOptions::default())
}

/// Returns a file of `tests/data/x`.
pub(crate) fn stored(name: &str) -> Vec<u8> {
    std::fs::read(data().join("x").join(name)).unwrap()
}

/// Returns the text of the pendulum: two takes, keys of every type, two meshes.
pub(crate) fn pendulum() -> String {
    String::from_utf8(stored("pendulum.x")).unwrap()
}

/// Returns a text with a header.
pub(crate) fn with_header(text: &str) -> Vec<u8> {
    format!("xof 0303txt 0032\n{text}").into_bytes()
}

/// Small files of every encoding.
pub(crate) fn small() -> Vec<(&'static str, Vec<u8>)> {
    ["pendulum.x", "pendulum_bin.x", "pendulum_tzip.x", "pendulum_bzip.x", "test_cube_compressed.x"]
        .map(|name| (name, stored(name)))
        .into()
}

/// Returns a compressed file of these blocks: the size that each announces, and its data.
pub(crate) fn compressed(total: usize, blocks: &[(usize, Vec<u8>)]) -> Vec<u8> {
    let mut bytes = b"xof 0303tzip0032".to_vec();
    bytes.extend((total as u32).to_le_bytes());
    for (size, data) in blocks {
        bytes.extend((*size as u16).to_le_bytes());
        bytes.extend((data.len() as u16 + 2).to_le_bytes());
        bytes.extend(b"CK");
        bytes.extend(data);
    }
    bytes
}
