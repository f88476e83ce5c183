//! The timeline of a scene: bars are dragged, and the script changes by a line.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::workbench::{Window, move_to, press, release};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::TimeScale;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::scene::timeline::{SceneBarPart, SceneHit, SceneLaneLayout};
use dragonfly_document::Change;
use egui::{Key, Modifiers, Pos2, Rect, pos2};
use egui_kittest::kittest::Queryable;

/// The lanes of a window: the rectangle, the places in it, and the position of each time.
pub(crate) struct Lanes {
    pub(crate) canvas: Rect,
    pub(crate) layout: SceneLaneLayout,
    pub(crate) scale: TimeScale,
}

impl Lanes {
    pub(crate) fn of(window: &Window) -> Self {
        let actions = window
            .state()
            .state
            .read()
            .scene_editing
            .lanes()
            .list
            .iter()
            .map(|lane| lane.bars.len())
            .sum::<usize>();
        let canvas = window.get_by_label(&format!("Lanes of the scene, {actions} actions")).rect();
        let context = window.state().state.read();
        let scale = TimeScale {
            left: canvas.left() + 16.0,
            width: canvas.width() - 32.0,
            window: context.scene_editing.window(),
        };
        Self { canvas, layout: SceneLaneLayout::of(context.scene_editing.lanes()), scale }
    }

    /// Returns the rectangle of the bar of an action.
    pub(crate) fn bar(&self, window: &Window, action: usize) -> Rect {
        let lanes = window.state().state.read().scene_editing.lanes().clone();
        let (index, bar) = lanes
            .list
            .iter()
            .enumerate()
            .find_map(|(index, lane)| Some((index, lane.bars.iter().find(|bar| bar.action == action)?)))
            .unwrap();
        self.layout.bar(index, bar, self.canvas.top(), &self.scale)
    }
}

fn window() -> Window {
    scene(FOXES).window()
}

/// Drags from a point by some seconds.
pub(crate) fn drag(window: &mut Window, from: Pos2, seconds: f64, modifiers: Modifiers) {
    let by = (seconds * Lanes::of(window).scale.per_second()) as f32;
    press(window, from);
    for step in 1..=4 {
        move_to(window, pos2(from.x + by * step as f32 / 4.0, from.y), modifiers);
    }
    release(window, pos2(from.x + by, from.y));
}

/// Positions of the actions of the scene in the script.
const LOOKS: usize = 5;
const RUN: usize = 6;
const MOVE: usize = 7;
const LOOK: usize = 8;
const TITLE: usize = 10;

#[test]
fn a_dragged_bar_changes_its_line_and_undo_restores_the_text() {
    let mut window = window();
    let from = Lanes::of(&window).bar(&window, MOVE).center();
    drag(&mut window, from, 0.5, Modifiers::NONE);
    assert_eq!(
        new_lines(FOXES, &text(&window)),
        [r#"<move who="ben" path="aisle" take="Walk" begin="1.5"/>"#]
    );
    assert_eq!(window.state().steps(), (1, 1), "a drag is one step");
    assert_eq!(window.state().state.read().scene_editing.action(), Some(MOVE), "what is dragged is selected");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(text(&window), FOXES);
    assert_eq!(window.state().refused, [""; 0]);
}

#[test]
fn escape_during_a_drag_leaves_the_text_as_it_was() {
    let mut window = window();
    let from = Lanes::of(&window).bar(&window, MOVE).center();
    press(&mut window, from);
    move_to(&mut window, pos2(from.x + 40.0, from.y), Modifiers::NONE);
    move_to(&mut window, pos2(from.x + 60.0, from.y), Modifiers::NONE);
    assert_ne!(text(&window), FOXES, "the text follows the pointer");
    window.key_press(Key::Escape);
    window.run_steps(2);
    release(&mut window, pos2(from.x + 60.0, from.y));
    assert_eq!(text(&window), FOXES);
    assert_eq!(window.state().steps(), (0, 0));
}

#[test]
fn a_drag_back_to_where_it_began_is_no_step() {
    let mut window = window();
    let from = Lanes::of(&window).bar(&window, MOVE).center();
    press(&mut window, from);
    for x in [30.0, 60.0, 30.0, 0.5] {
        move_to(&mut window, pos2(from.x + x, from.y), Modifiers::NONE);
    }
    release(&mut window, from);
    assert_eq!((text(&window).as_str(), window.state().steps().0), (FOXES, 0));
}

#[test]
fn ends_and_fades_are_dragged_by_their_handles() {
    let mut window = window();
    let bar = Lanes::of(&window).bar(&window, TITLE);
    drag(&mut window, pos2(bar.right() - 2.0, bar.center().y), 0.5, Modifiers::NONE);
    assert_eq!(
        new_lines(FOXES, &text(&window)),
        [r#"<title text="The End" begin="4" dur="1.5" fade-in="0.5"/>"#]
    );
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    let lanes = Lanes::of(&window);
    let bar = lanes.bar(&window, LOOK);
    let handle = pos2(bar.left() + (0.25 * lanes.scale.per_second()) as f32 + 12.0, bar.top() + 3.0);
    drag(&mut window, handle, 0.25, Modifiers::NONE);
    let line = r#"<look who="ben" at="anna" bones="b_Head_05" begin="looks.sees" dur="2" fade-in="0.5" fade-out="0.25"/>"#;
    assert_eq!(new_lines(FOXES, &text(&window)), [line]);
}

#[test]
fn every_part_of_a_bar_is_where_it_is_drawn() {
    let window = window();
    let lanes = Lanes::of(&window);
    let all = window.state().state.read().scene_editing.lanes().clone();
    let bar = lanes.bar(&window, TITLE);
    let at = |x: f32, y: f32| lanes.layout.hit(&all, pos2(x, y), lanes.canvas.top(), &lanes.scale);
    let part = |hit: SceneHit| match hit {
        SceneHit::Bar { part, action: TITLE, .. } => Some(part),
        SceneHit::Bar { .. } | SceneHit::Lane(_) | SceneHit::Nothing => None,
    };
    let middle = bar.center();
    assert_eq!(part(at(middle.x, middle.y + 4.0)), Some(SceneBarPart::Body));
    assert_eq!(part(at(bar.left() + 2.0, bar.bottom() - 2.0)), Some(SceneBarPart::Start));
    assert_eq!(part(at(bar.right() - 2.0, bar.bottom() - 2.0)), Some(SceneBarPart::End));
    let fade = (0.5 * lanes.scale.per_second()) as f32;
    assert_eq!(part(at(bar.left() + fade + 12.0, bar.top() + 2.0)), Some(SceneBarPart::FadeIn));
    assert_eq!(part(at(bar.right() - 12.0, bar.top() + 2.0)), Some(SceneBarPart::FadeOut));
    // The ends of a bar trim it over its whole height, also where nothing fades.
    assert_eq!(part(at(bar.right() - 2.0, bar.top() + 2.0)), Some(SceneBarPart::End));
    assert_eq!(part(at(bar.left() + 2.0, bar.top() + 2.0)), Some(SceneBarPart::Start));
    assert!(matches!(at(bar.right() + 12.0, middle.y), SceneHit::Lane(_)));
    assert_eq!(at(middle.x, lanes.canvas.top() + lanes.layout.height() + 5.0), SceneHit::Nothing);
}

#[test]
fn the_ruler_moves_the_playhead_to_a_frame() {
    let mut window = window();
    let ruler = window.get_by_label("Time of the scene").rect();
    let x = Lanes::of(&window).scale.x_of(1.49);
    press(&mut window, pos2(x, ruler.center().y));
    release(&mut window, pos2(x, ruler.center().y));
    let frame = window.state().state.read().time() * 24.0;
    assert!((frame - 36.0).abs() < 1e-3, "{frame}");
}

#[test]
fn commands_change_the_selected_action_at_the_playhead() {
    let mut window = window();
    let run = |window: &mut Window, action: usize, time: f32, id: Id| {
        window.state_mut().state.execute(Request::Scene(SceneRequest::SelectAction(Some(action))));
        window.state_mut().state.execute(Request::Seek(time));
        let effect = window.state_mut().state.execute(Request::Command(id));
        if let Some(dragonfly::panels::Effect::Change(change)) = effect {
            window.state_mut().change(change);
        }
        window.run_steps(2);
        let lines = new_lines(FOXES, &text(window));
        window.state_mut().change(Change::Undo);
        window.run_steps(2);
        assert_eq!(text(window), FOXES);
        lines
    };
    assert_eq!(
        run(&mut window, MOVE, 2.0, Id::ClipToPlayhead),
        [r#"<move who="ben" path="aisle" take="Walk" begin="2"/>"#]
    );
    assert_eq!(
        run(&mut window, MOVE, 2.0, Id::KeysLater),
        [r#"<move who="ben" path="aisle" take="Walk" begin="25f"/>"#]
    );
    assert_eq!(
        run(&mut window, TITLE, 4.5, Id::ClipEndToPlayhead),
        [r#"<title text="The End" begin="4" dur="0.5" fade-in="0.5"/>"#]
    );
    assert_eq!(run(&mut window, LOOKS, 1.0, Id::CutHere), [r#"<shot who="close" begin="1"/>"#]);
    assert_eq!(
        run(&mut window, RUN, 0.0, Id::DeleteKeys),
        [""; 0],
        "the key that deletes keys deletes actions here"
    );
}

#[test]
fn a_locked_role_is_not_dragged() {
    let mut window = window();
    window.state_mut().state.execute(Request::Scene(SceneRequest::Lock(vec!["ben".into()], true)));
    window.run_steps(1);
    let from = Lanes::of(&window).bar(&window, MOVE).center();
    drag(&mut window, from, 0.5, Modifiers::NONE);
    assert_eq!(text(&window), FOXES);
}
