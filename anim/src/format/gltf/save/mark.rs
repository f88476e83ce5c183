//! The name of what a save appends, by which later saves recognize it.

use super::json::tree::{Json, ValueId};

/// Name of the buffers, buffer views and accessors that a save appends.
pub const MARK: &str = "dragonfly.keys";

/// Returns whether an object has the name [`MARK`].
pub(super) fn is_ours(json: Json<'_>, id: ValueId) -> bool {
    json.string_member(id, "name").as_deref() == Some(MARK)
}
