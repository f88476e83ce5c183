//! The icons of things and lanes.

use crate::panels::icons::Icon;

/// Returns the icon of a kind of thing.
pub(super) fn icon(kind: &str) -> Icon {
    match kind {
        "role" => Icon::Figure,
        "prop" => Icon::Surface,
        "camera" => Icon::Camera,
        "light" => Icon::Sun,
        "effect" => Icon::Rain,
        "path" => Icon::Path,
        "mark" => Icon::Pin,
        "Shots" => Icon::View,
        "Titles" => Icon::Rename,
        _ => Icon::Take,
    }
}
