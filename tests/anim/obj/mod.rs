//! The `.obj` format: static models, and one pose of any model.

mod agreement;
mod damage;
mod forms;
mod import;
mod materials;
mod write;

use crate::doors::MemoryFs;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{ImportError, Imported, ReadOptions, obj::OBJ};

/// Reads a text without other files.
pub(crate) fn import(text: impl AsRef<[u8]>) -> Result<Imported, ImportError> {
    OBJ.import(text.as_ref(), &MemoryFs::default(), &ReadOptions::default())
}

/// Reads a text that is complete.
pub(crate) fn model(text: &str) -> ModelData {
    let imported = import(text).unwrap();
    assert_eq!(imported.warnings, []);
    imported.model
}
