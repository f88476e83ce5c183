//! The camera.

use super::*;
use crate::panels::actions::{framing, scene_camera};
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::camera::ViewSide;

commands! {
    LookThroughShot => When::Scene, "Look through the shot", [], "Switches between the camera of the shot at the playhead and the free camera", |w| { scene_camera::toggle_shot(w); None };
    LookThroughSelected => When::Thing, "Look through the selected camera", [], "Shows the scene as the selected camera sees it", |w| { scene_camera::through_selected(w); None };
    LookFreely => When::Scene, "Look through the free camera", [], "Shows the scene from where the view was before it looked through a camera", |w| { scene_camera::look_through(w, ThroughCamera::Free); None };
    AttachCamera => When::Scene, "Camera to view", [], "Lets orbit, pan and zoom move the camera that the viewport looks through (lock camera to view)", |w| { scene_camera::toggle_attached(w); None };
    FrameSelected => When::Model, "Frame selected", [key(NONE, Key::F)], "Frames the selection in the viewport", |w| { framing::frame_selected(w); None };
    FrameAll => When::Model, "Frame all", [key(SHIFT, Key::F)], "Frames the whole model in the viewport", |w| { framing::frame_shown(w); None };
    ViewFront => When::Always, "Front", [key(NONE, Key::Num1)], "Sets the camera to the front view", |w| { w.camera.camera_mut().look_from(ViewSide::Front); None };
    ViewBack => When::Always, "Back", [key(CTRL, Key::Num1)], "Sets the camera to the back view", |w| { w.camera.camera_mut().look_from(ViewSide::Back); None };
    ViewRight => When::Always, "Right", [key(NONE, Key::Num3)], "Sets the camera to the right view", |w| { w.camera.camera_mut().look_from(ViewSide::Right); None };
    ViewLeft => When::Always, "Left", [key(CTRL, Key::Num3)], "Sets the camera to the left view", |w| { w.camera.camera_mut().look_from(ViewSide::Left); None };
    ViewTop => When::Always, "Top", [key(NONE, Key::Num7)], "Sets the camera to the top view", |w| { w.camera.camera_mut().look_from(ViewSide::Top); None };
    ViewBottom => When::Always, "Bottom", [key(CTRL, Key::Num7)], "Sets the camera to the bottom view", |w| { w.camera.camera_mut().look_from(ViewSide::Bottom); None };
    ToggleProjection => When::Always, "Perspective / orthographic", [key(NONE, Key::Num5)], "Switches between perspective and orthographic projection", |w| { w.camera.camera_mut().toggle_projection(); None };
}
