//! Parsing, with limits, and the messages of the parser.

use crate::code::{FBX_FOUND, FBX_INVALID, FBX_NOT_SHOWN, FBX_TEXT, FBX_TRUNCATED};
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use dragonfly_anim::limits::NODE_DEPTH;
use ufbx::{AllocatorOpts, ErrorType, LoadOpts, ProgressCb, ProgressResult};

/// Bytes between two reports of the parser, which give an error its place.
const REPORT_BYTES: u64 = 1024;

/// Parses the bytes. Memory of the parser is charged to the budget of the import.
pub(super) fn load(bytes: &[u8], context: &ImportContext<'_>) -> Result<ufbx::SceneRoot, ImportError> {
    let limit = usize::try_from(context.remaining_memory()).unwrap_or(usize::MAX);
    let allocator =
        |part: usize| AllocatorOpts { memory_limit: (limit / part).max(1), ..AllocatorOpts::default() };
    let mut reached = 0;
    let mut is_cancelled = false;
    let mut progress = |progress: &ufbx::Progress| {
        reached = progress.bytes_read;
        let part = progress.bytes_read as f32 / progress.bytes_total.max(1) as f32;
        is_cancelled = context.progress(0.5 * part.min(1.0)).is_err();
        if is_cancelled { ProgressResult::Cancel } else { ProgressResult::Continue }
    };
    let options = LoadOpts {
        // Both together stay within the limit.
        temp_allocator: allocator(2),
        result_allocator: allocator(2),
        file_format: ufbx::FileFormat::Fbx,
        no_format_from_extension: true,
        load_external_files: false,
        ignore_missing_external_files: true,
        generate_missing_normals: true,
        clean_skin_weights: true,
        node_depth_limit: NODE_DEPTH as u32 - 2,
        geometry_transform_handling: ufbx::GeometryTransformHandling::ModifyGeometry,
        inherit_mode_handling: ufbx::InheritModeHandling::Compensate,
        progress_cb: ProgressCb::Mut(&mut progress),
        progress_interval_hint: REPORT_BYTES,
        ..LoadOpts::default()
    };
    let loaded = ufbx::load_memory(bytes, options);
    let scene = match loaded {
        Ok(scene) => scene,
        Err(_) if is_cancelled => return Err(ImportError::Cancelled),
        Err(error) => return Err(parse_error(&error, reached, bytes.len() as u64, limit as u64)),
    };
    let used = scene.metadata.result_memory_used as u64;
    context.charge(&Place::File, used)?;
    Ok(scene)
}

/// Returns the error of the parser. It gives no place; `reached` is what it had read.
fn parse_error(error: &ufbx::Error, reached: u64, bytes: u64, limit: u64) -> ImportError {
    let info = error.info();
    let mut reason = error.description.to_string();
    if !info.is_empty() && info != reason {
        reason = format!("{reason} ({info})");
    }
    let invalid =
        |code| ImportError::Invalid { place: Place::Byte(reached.min(bytes)), code, reason: reason.clone() };
    match error.type_ {
        ErrorType::MemoryLimit | ErrorType::AllocationLimit | ErrorType::OutOfMemory => {
            ImportError::TooLarge {
                place: Place::Byte(reached.min(bytes)),
                what: MEMORY,
                size: limit + 1,
                limit,
            }
        }
        ErrorType::TruncatedFile | ErrorType::EmptyFile => invalid(FBX_TRUNCATED),
        ErrorType::UnsupportedVersion => {
            ImportError::Unsupported { place: Place::File, feature: format!("a newer parser: {reason}") }
        }
        ErrorType::None
        | ErrorType::Unknown
        | ErrorType::FileNotFound
        | ErrorType::ExternalFileNotFound
        | ErrorType::Io
        | ErrorType::Cancelled
        | ErrorType::UnrecognizedFileFormat
        | ErrorType::UninitializedOptions
        | ErrorType::ZeroVertexSize
        | ErrorType::TruncatedVertexStream
        | ErrorType::InvalidUtf8
        | ErrorType::FeatureDisabled
        | ErrorType::BadNurbs
        | ErrorType::BadIndex
        | ErrorType::NodeDepthLimit
        | ErrorType::ThreadedAsciiParse
        | ErrorType::UnsafeOptions
        | ErrorType::DuplicateOverride => invalid(FBX_INVALID),
    }
}

/// Name of the limited quantity in errors about memory.
pub(crate) const MEMORY: &str = "bytes of memory needed";

/// Passes the warnings of the parser on, and names content that is left out.
pub(super) fn report(scene: &ufbx::Scene, context: &ImportContext<'_>) {
    for warning in &scene.metadata.warnings {
        // Textures are opened later, by the parent.
        if warning.type_ == ufbx::WarningType::MissingExternalFile {
            continue;
        }
        let place = match scene.elements.get(warning.element_id as usize) {
            Some(element) if !element.name.is_empty() => Place::Pointer(format!("/{}", &*element.name)),
            _ => Place::File,
        };
        let times = if warning.count > 1 { format!(" ({} times)", warning.count) } else { String::new() };
        let code = match warning.type_ {
            ufbx::WarningType::BadUnicode => FBX_TEXT,
            _ => FBX_FOUND,
        };
        context.warn(place, code, format!("{}{times}", &*warning.description));
    }
    let left_out = [
        (scene.constraints.len(), "constraints are not evaluated; baked motion is unaffected"),
        (
            scene.nurbs_surfaces.len() + scene.nurbs_curves.len() + scene.line_curves.len(),
            "curves and NURBS surfaces are not shown",
        ),
        (scene.cache_deformers.len(), "caches of vertices are not played"),
    ];
    for (count, text) in left_out {
        if count > 0 {
            context.warn(Place::File, FBX_NOT_SHOWN, format!("{count} {text}"));
        }
    }
}
