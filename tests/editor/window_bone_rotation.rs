//! Picking and rotating a bone in the real window with mouse and keys; the displayed numbers are the requested ones.

use crate::program::threads;
use crate::screen::{Screen, key};
use crate::viewport_tools_rig::find;
use crate::window::{Editor, SOON, alone, eventually_shows_something};
use dragonfly::control::gizmo::Gizmo;
use dragonfly::panels::{Request, Settings, State};
use dragonfly_document::{Cancel, Source, View, load_model};
use dragonfly_kit::folder::data;
use dragonfly_picture::gizmo::{GizmoAxis, GizmoView, Handle, Tool};
use glam::{Quat, Vec2};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The expected state of the window, computed by the test.
pub(crate) struct ExpectedWindow {
    pub(crate) state: State,
    corner: Vec2,
    size: Vec2,
}

impl ExpectedWindow {
    /// Creates the state for Fox at the start of its first take, in a given viewport.
    pub(crate) fn new([x, y, width, height]: [f32; 4]) -> Self {
        let source = Source::File(data("gltf/Fox.glb"));
        let loaded = load_model(&source, &mut |_| {}, &Cancel::default()).expect("Fox opens");
        let mut state = State::new(Settings::default(), Instant::now());
        let rect = egui::Rect::from_min_size(egui::pos2(x, y), egui::vec2(width, height));
        state.execute(Request::Viewport(rect));
        state.show(View::opened(1, Arc::new(loaded)));
        state.pause();
        state.execute(Request::Seek(0.0));
        Self { state, corner: Vec2::new(x, y), size: Vec2::new(width, height) }
    }

    fn bone(&self, name: &str) -> u32 {
        let bones = &self.state.read().loaded().expect("open").model.animation.skeleton.bones;
        bones.iter().position(|bone| bone.name == name).expect("a bone of Fox") as u32
    }

    fn view(&self) -> GizmoView {
        GizmoView::new(&self.state.read().camera, self.size)
    }

    /// Returns the window position of the middle of a bone, from its joint to another joint.
    pub(crate) fn middle(&mut self, from: &str, to: &str) -> Vec2 {
        let bones = [self.bone(from), self.bone(to)];
        self.state.execute(Request::Select(Some(bones[0])));
        self.state.begin_frame(self.state.read().now);
        let to_root = self.state.read().posed.animation().expect("posed").to_root();
        let place = bones.map(|bone| to_root[bone as usize].w_axis.truncate().as_dvec3());
        let at = self.view().to_screen((place[0] + place[1]) / 2.0).expect("in front of the camera");
        at.as_vec2() + self.corner
    }

    /// Returns a window position on a handle of the gizmo at a bone.
    pub(crate) fn handle(&mut self, bone: &str, wanted: Handle) -> Vec2 {
        let bone = self.bone(bone);
        self.state.execute(Request::Select(Some(bone)));
        self.state.begin_frame(self.state.read().now);
        let skeleton = &self.state.read().loaded().expect("open").model.animation.skeleton;
        let animation = self.state.read().posed.animation().expect("posed");
        let mut gizmo = Gizmo::new(Tool::Rotate);
        gizmo.settings.space = self.state.read().settings.tools.space;
        gizmo.select(skeleton, animation.poses(), animation.to_root(), &[bone], None);
        gizmo.look(self.view());
        let joint = animation.to_root()[bone as usize].w_axis.truncate().as_dvec3();
        let joint = self.view().to_screen(joint).expect("in front of the camera").as_vec2();
        find(&gizmo, joint, wanted).expect("the handle is seen") + self.corner
    }
}

/// Returns the newest value of a field in the log of the window.
pub(crate) fn shown(editor: &mut Editor, field: &str) -> Option<String> {
    editor.listen();
    let line = editor.lines.iter().rev().find(|line| line.contains("dragonfly::shown"))?;
    let value = line.split(&format!("{field}=")).nth(1)?;
    let end =
        if value.starts_with('[') { value.find(']')? + 1 } else { value.find(' ').unwrap_or(value.len()) };
    Some(value[..end].trim_matches('"').to_owned())
}

pub(crate) fn numbers<const N: usize>(text: &str) -> [f32; N] {
    let numbers =
        text.trim_matches(['[', ']']).split(',').map(|number| number.trim().parse().expect("a number"));
    numbers.collect::<Vec<f32>>().try_into().expect("so many numbers")
}

/// Waits until a field has the expected value.
#[track_caller]
pub(crate) fn wait_for(
    editor: &mut Editor,
    screen: &Screen,
    what: &str,
    mut holds: impl FnMut(&mut Editor) -> bool,
) {
    let deadline = Instant::now() + SOON;
    while !holds(editor) {
        if Instant::now() > deadline {
            screen.keep("waiting");
            println!("{}", threads(editor.process()));
            panic!("never: {what}\n{}", editor.log());
        }
        std::thread::park_timeout(Duration::from_millis(20));
    }
}

fn rotation(editor: &mut Editor) -> Quat {
    Quat::from_array(numbers(&shown(editor, "rotation").expect("it is told")))
}

#[track_caller]
fn wait_for_turn(editor: &mut Editor, screen: &Screen, wanted: Quat) {
    let what = format!("a rotation of {wanted}");
    wait_for(editor, screen, &what, |editor| {
        let now = rotation(editor);
        let apart = (now - wanted).length().min((now + wanted).length());
        apart < 1e-4
    });
}

#[test]
fn a_bone_is_picked_rotated_by_thirty_degrees_undone_and_redone() {
    let _one = alone();
    let mut screen = Screen::new("hands", 1280, 800);
    let log = [("DRAGONFLY_LOG", "error,dragonfly=info,dragonfly::shown=debug")];
    let mut editor = Editor::open(&mut screen, &[], &log);
    eventually_shows_something(&screen);
    screen.press(key::SPACE);
    screen.press(key::HOME);
    wait_for(&mut editor, &screen, "the start", |editor| shown(editor, "time").as_deref() == Some("0.0"));
    let mut inside = ExpectedWindow::new(numbers(&shown(&mut editor, "viewport").expect("told")));

    // A click on the bone of the head; where only skin is visible, the click hits the skin.
    let head = inside.middle("b_Head_05", "b_Neck_04");
    let head = inside.middle("b_Head_05", "b_Head_05").lerp(head, -0.6);
    screen.click(head.x as i16, head.y as i16);
    wait_for(&mut editor, &screen, "the head is selected", |editor| {
        shown(editor, "bone").as_deref() == Some("b_Head_05")
    });
    let before = rotation(&mut editor);
    let turned = before * Quat::from_rotation_x(30f32.to_radians());

    // The head is rotated by its ring; the angle is typed during the drag.
    let ring = inside.handle("b_Head_05", Handle::Axis(GizmoAxis::X));
    screen.point(ring.x as i16, ring.y as i16);
    screen.hold();
    screen.point(ring.x as i16 + 9, ring.y as i16 + 14);
    screen.press(key::DIGIT_3);
    screen.press(key::DIGIT_0);
    screen.keep("hands-drag");
    screen.press(key::ENTER);
    screen.release_button();
    wait_for_turn(&mut editor, &screen, turned);
    assert_eq!(shown(&mut editor, "done").as_deref(), Some("1"), "one drag is one step");

    screen.press_with(key::CONTROL, key::Z);
    wait_for_turn(&mut editor, &screen, before);
    screen.press_with(key::CONTROL, key::Y);
    wait_for_turn(&mut editor, &screen, turned);

    // The head is rotated about the same axis again, by a command and keys alone.
    screen.press(key::F3);
    for letter in [27, 32, 28, 38, 28, 26, 65, 25, 31, 28, 43] {
        // "rotate with" on a US keyboard.
        screen.press(letter);
    }
    screen.press(key::ENTER);
    screen.press(key::X);
    screen.press(key::DIGIT_3);
    screen.press(key::DIGIT_0);
    screen.press(key::ENTER);
    wait_for_turn(&mut editor, &screen, before * Quat::from_rotation_x(60f32.to_radians()));
    assert_eq!(shown(&mut editor, "done").as_deref(), Some("2"));

    // Escape during a drag leaves no change.
    let ring = inside.handle("b_Head_05", Handle::Ring);
    screen.point(ring.x as i16, ring.y as i16);
    screen.hold();
    screen.point(ring.x as i16 + 40, ring.y as i16 + 40);
    screen.press(key::ESCAPE);
    screen.release_button();
    wait_for_turn(&mut editor, &screen, before * Quat::from_rotation_x(60f32.to_radians()));
    screen.keep("hands-end");
    // The changes are discarded.
    screen.close(editor.window);
    editor.wait_for_log("asked what becomes of unsaved work", 1, SOON);
    screen.press_with(key::SHIFT, key::TAB);
    screen.press(key::ENTER);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}
