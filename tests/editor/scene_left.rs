//! The state of a scene that stays when its file is read again, and while one of its models is edited.

use crate::scene_bench::{FOXES, scene};
use crate::workbench::Workbench;
use dragonfly::panels::keys::TimeWindow;
use dragonfly::panels::scene::{LineRequest, SceneRequest};
use dragonfly::panels::{PanelContext, Request};
use dragonfly_document::View;
use dragonfly_document::bones::Choice;
use dragonfly_kit::document::fixture;
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::camera::Camera;

/// Everything that stays.
#[derive(Debug, PartialEq)]
struct Kept {
    time: f32,
    window: TimeWindow,
    things: Vec<Box<str>>,
    action: Option<usize>,
    hidden: Vec<String>,
    locked: [bool; 2],
    line_hidden: bool,
    through: ThroughCamera,
}

impl Kept {
    fn of(read: &PanelContext<'_>) -> Self {
        let editing = read.scene_editing;
        Self {
            time: read.time(),
            window: editing.window(),
            things: editing.things().to_vec(),
            action: editing.action(),
            hidden: editing.hidden().map(str::to_owned).collect(),
            locked: ["sun", "ben"].map(|thing| editing.is_locked(thing)),
            line_hidden: editing.lines().is_hidden("note"),
            through: read.through.clone(),
        }
    }
}

/// A scene in which something is selected, hidden, locked, and seen at 2.5 s.
fn used() -> (Workbench, Camera) {
    let mut bench = scene(FOXES);
    let mut camera = bench.state.read().camera;
    camera.orbit(0.4, 0.1);
    let window = TimeWindow { start: 1.0, length: 2.0 };
    for request in [
        SceneRequest::SelectThings(vec!["ben".into()], Choice::Replace),
        SceneRequest::SelectAction(Some(3)),
        SceneRequest::Hide(vec!["anna".into()], true),
        SceneRequest::Lock(vec!["sun".into()], true),
        SceneRequest::Window(Some(window)),
        SceneRequest::Line(LineRequest::Hide("note".into(), true)),
    ] {
        bench.state.execute(Request::Scene(request));
    }
    bench.state.execute(Request::Camera(camera));
    bench.state.execute(Request::Scene(SceneRequest::Through(ThroughCamera::Of("close".into()))));
    bench.state.execute(Request::Seek(2.5));
    (bench, camera)
}

/// Returns the same file, read again.
fn again() -> View {
    scene(FOXES).state.read().view.cloned().expect("a view")
}

fn look_freely(bench: &mut Workbench) -> Camera {
    bench.state.execute(Request::Scene(SceneRequest::Through(ThroughCamera::Free)));
    let now = bench.state.read().now;
    bench.state.begin_frame(now);
    bench.state.read().camera
}

#[test]
fn a_scene_that_is_read_again_stays_as_it_was_seen() {
    let (mut bench, camera) = used();
    let before = Kept::of(&bench.state.read());
    assert_eq!((before.time, before.hidden.len(), before.action), (2.5, 1, Some(3)));
    bench.state.show(again());
    assert_eq!(Kept::of(&bench.state.read()), before);
    assert!(look_freely(&mut bench).eye().distance(camera.eye()) < 1e-4, "it was not framed again");
}

#[test]
fn a_scene_is_as_it_was_after_one_of_its_models_was_edited() {
    let (mut bench, camera) = used();
    let before = Kept::of(&bench.state.read());
    bench.state.show(fixture::full());
    assert_eq!(*bench.state.read().through, ThroughCamera::Free);
    bench.state.show(again());
    assert_eq!(Kept::of(&bench.state.read()), before);
    assert!(look_freely(&mut bench).eye().distance(camera.eye()) < 1e-4, "it was not framed again");
}

#[test]
fn the_sounds_of_a_scene_that_is_read_again_are_read_again() {
    let mut bench = scene(FOXES);
    bench.state.scene_sounds().receive("thunder.wav", Err("not found".to_owned()));
    let opened = bench.state.read().scene_editing.sounds().opened();
    bench.state.show(again());
    let read = bench.state.read();
    assert!(read.scene_editing.sounds().get("thunder.wav").is_none(), "the file may be another one");
    assert!(read.scene_editing.sounds().opened() > opened, "earlier answers mean nothing");
}

#[test]
fn another_scene_begins_at_its_start() {
    let (mut bench, _) = used();
    let view = again();
    let mut file = view.file.as_ref().clone();
    file.path = Some("other.xml".into());
    bench.state.show(View { file: file.into(), ..view });
    let now = Kept::of(&bench.state.read());
    assert_eq!((now.time, now.things, now.hidden), (0.0, Vec::new(), Vec::new()));
    assert_eq!(now.through, ThroughCamera::Free);
}
