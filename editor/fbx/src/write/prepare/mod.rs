//! Changes of a model before it is written with a preset.

mod bind_pose;
mod frames;
mod root;

use super::losses::FbxLosses;
use super::preset::{ExportSettings, KeyStyle};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::ExportError;

/// Returns the model that is written; `None` if it is the model itself.
pub(super) fn prepared(
    model: &ModelData,
    settings: &ExportSettings,
    losses: &mut FbxLosses,
) -> Result<Option<ModelData>, ExportError> {
    let mut prepared = None;
    if settings.rests_in_bind_pose {
        prepared = bind_pose::at_rest(model, losses);
    }
    if settings.keys == KeyStyle::Frames {
        prepared = Some(frames::at_frames(prepared.as_ref().unwrap_or(model), settings.no_scale, losses)?);
    }
    if settings.one_root {
        prepared = root::below_root(prepared.as_ref().unwrap_or(model)).or(prepared);
    }
    Ok(prepared)
}
