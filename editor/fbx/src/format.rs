//! The row of the format.

use crate::parser::FbxParser;
use crate::write::{FbxOptions, export_with};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{
    ExportError, Format, ImportContext, ImportError, SavePlan, WholeFile, WriteSupport,
};

/// FBX 5.0 to 7.7, binary and text; written as binary 7.4.
///
/// A file is parsed by the running program, started again as a child process: a program with this format calls
/// [`child::serve`](crate::child::serve) first of all if [`child::is_requested`](crate::child::is_requested).
pub const FBX: Format = Format {
    name: "fbx",
    title: "Autodesk FBX",
    extensions: &["fbx"],
    sniff: looks_like_fbx,
    read,
    write: WriteSupport::Rewritten(rewrite),
    export: Some(|model, name| export_with(model, name, &FbxOptions::default())),
};

/// Writes a whole file with its images.
fn rewrite(model: &ModelData) -> Result<WholeFile, ExportError> {
    let SavePlan { mut files, lost, .. } = export_with(model, "model.fbx", &FbxOptions::default())?;
    Ok(WholeFile { bytes: files.pop().map(|main| main.bytes).unwrap_or_default(), lost })
}

/// Start of a binary file.
const BINARY: &[u8] = b"Kaydara FBX Binary  \0";

/// Number of bytes in which a text file must identify itself.
const TEXT_BYTES: usize = 1024;

/// Returns whether the bytes look like a binary or text file of this format.
pub fn looks_like_fbx(bytes: &[u8]) -> bool {
    if bytes.starts_with(BINARY) {
        return true;
    }
    let start = &bytes[..bytes.len().min(TEXT_BYTES)];
    let has = |word: &[u8]| start.windows(word.len()).any(|part| part == word);
    start.starts_with(b";") && has(b"FBX") || has(b"FBXHeaderExtension:")
}

fn read(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    FbxParser::this_program()?.read(bytes, context)
}
