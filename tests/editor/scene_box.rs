//! Selection by a box in the viewport of a scene: every tool that selects begins one where no handle of the gizmo is.

use crate::scene_bench::{FOXES, scene};
use crate::workbench::Window;
use dragonfly::control::{Button, InputEvent};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_document::bones::Choice;
use dragonfly_picture::pick::OwnedRegion;
use egui_kittest::kittest::Queryable;
use glam::Vec2;

/// Drags with the left button. Returns the effects.
fn drag(window: &mut Window, from: Vec2, to: Vec2) -> Vec<Effect> {
    let mut effects = Vec::new();
    for event in [
        InputEvent::MouseMove(from),
        InputEvent::MouseDown(Button::Left),
        InputEvent::MouseMove(from.lerp(to, 0.5)),
        InputEvent::MouseMove(to),
        InputEvent::MouseUp(Button::Left),
    ] {
        window.state_mut().state.input(event, &mut effects);
    }
    window.run_steps(2);
    effects
}

/// Returns a window whose role is selected, with the gizmo of a tool, and the bottom right of the viewport.
fn window_with(tool: Id) -> (Window, Vec2) {
    let mut window = scene(FOXES).window();
    let select = SceneRequest::SelectThings(vec!["anna".into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(select));
    window.state_mut().state.execute(Request::Command(tool));
    window.run_steps(3);
    let corner = window.get_by_label("Viewport").rect().right_bottom();
    (window, Vec2::new(corner.x, corner.y))
}

#[test]
fn a_drag_beside_the_gizmo_selects_by_a_box_with_every_tool() {
    for tool in [Id::ToolSelect, Id::ToolMove, Id::ToolRotate, Id::ToolScale] {
        let (mut window, corner) = window_with(tool);
        let effects = drag(&mut window, corner - 60.0, corner - 20.0);
        let is_box = |effect: &Effect| matches!(effect, Effect::Catch(OwnedRegion::Box(from, to), Choice::Replace) if (*to - *from).abs_diff_eq(Vec2::splat(40.0), 1e-3));
        assert!(effects.iter().any(is_box), "{tool:?}: {effects:?}");
        assert_eq!(window.state().steps(), (0, 0), "{tool:?}");
    }
}

#[test]
fn the_command_for_a_box_begins_it_on_a_handle_of_the_gizmo_as_well() {
    let (mut window, _) = window_with(Id::ToolRotate);
    let controls = window.state().state.read().tools.controls();
    let view = dragonfly_picture::gizmo::GizmoView::new(
        &window.state().state.read().camera,
        controls.picture().size,
    );
    let pivot = controls.gizmo().gizmo.pivot().expect("the gizmo");
    let at = controls.picture().corner + view.to_screen(pivot).expect("in front of the camera").as_vec2();
    window.state_mut().state.execute(Request::Command(Id::BoxSelect));
    let effects = drag(&mut window, at, at + 30.0);
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Catch(..))), "{effects:?}");
    assert_eq!(window.state().steps(), (0, 0));
}
