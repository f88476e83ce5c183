//! The reasons why there is no place in the scene under the pointer, as sentences for the user.

use crate::control::line::LineSurface;
use dragonfly_picture::camera::Projection;

/// Returns why a line cannot be drawn under the pointer.
pub fn no_place_text(surface: LineSurface, projection: Projection) -> &'static str {
    match surface {
        LineSurface::Ground => match projection {
            Projection::Perspective => "There is no ground above the horizon",
            Projection::Orthographic => {
                "The ground is seen from its edge: turn the view, or draw a line in the view"
            }
        },
        LineSurface::View => "The plane of the line is behind the camera: move the camera back",
        LineSurface::Surface => "There is no surface under the pointer",
        LineSurface::Bone => "There is no bone under the pointer",
    }
}

/// Returns why something that is dropped is not put under the pointer. `is_far` is whether there is ground, but far away.
pub fn no_drop_text(is_far: bool, projection: Projection) -> &'static str {
    if is_far {
        return "The ground under the pointer is far away: the model is put elsewhere";
    }
    match projection {
        Projection::Perspective => "There is no ground above the horizon: the model is put elsewhere",
        Projection::Orthographic => "The ground is seen from its edge: the model is put elsewhere",
    }
}
