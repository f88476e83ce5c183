//! Frames of scenes at rates that are no whole numbers, and what is computed while nothing shows it.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use dragonfly::panels::commands::Id;
use dragonfly::panels::ruler::Ruler;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::stage::time::StageRate;
use dragonfly_document::bones::Choice;

#[test]
fn steps_and_lines_of_a_scene_at_29_97_frames_a_second_are_on_its_frames() {
    for written in ["24000/1001", "30000/1001", "60000/1001"] {
        let rate = StageRate::parse(written).expect("a rate");
        let own = FOXES.replace("fps=\"24\"", &format!("fps=\"{written}\""));
        let mut bench = scene(&own);
        for frame in 1..=100 {
            bench.state.execute(Request::Command(Id::NextFrame));
            assert_eq!(bench.state.read().scene_time(), rate.frame(frame), "{written}, frame {frame}");
        }
        bench.state.execute(Request::Command(Id::PreviousFrame));
        assert_eq!(bench.state.read().scene_time(), rate.frame(99), "{written}");
        let ruler = Ruler { left: 0.0, width: 900.0, start: 0.0, length: 30.0 };
        let ticks = ruler.ticks(rate.per_second());
        assert!(ticks.iter().filter(|tick| tick.major).count() > 3, "{ticks:?}");
        for tick in ticks {
            let frame = f64::from(tick.time) * rate.per_second();
            assert!((frame - frame.round()).abs() < 1e-3, "{written}: a line at frame {frame}");
        }
    }
}

#[test]
fn an_action_that_is_moved_to_the_playhead_begins_at_a_frame() {
    let own = FOXES
        .replace("fps=\"24\"", "fps=\"30000/1001\"")
        .replace("begin=\"4\" dur=\"1\"", "begin=\"96f\" dur=\"1\"");
    let mut window = scene(&own).window();
    for _ in 0..11 {
        window.state_mut().state.execute(Request::Command(Id::NextFrame));
    }
    window.state_mut().state.execute(Request::Scene(SceneRequest::SelectAction(Some(10))));
    let effect = window.state_mut().state.execute(Request::Command(Id::ClipToPlayhead));
    let Some(Effect::Change(change)) = effect else { panic!("{effect:?}") };
    window.state_mut().change(change);
    let new = new_lines(&own, &text(&window));
    assert!(new.len() == 1 && new[0].contains("begin=\"11f\""), "{new:?}");
}

#[test]
fn the_things_of_a_scene_are_computed_only_where_something_shows_them() {
    let mut bench = scene(FOXES);
    let now = bench.state.read().now;
    let camera =
        |bench: &crate::workbench::Workbench| bench.state.read().stage.shown_camera().map(str::to_owned);
    let first = camera(&bench);
    // Another shot, which nothing shows.
    bench.state.execute(Request::Seek(3.0));
    bench.state.begin_frame(now);
    assert_eq!(camera(&bench), first, "nothing is selected");
    bench.state.execute(Request::Command(Id::ToolMove));
    bench.state.execute(Request::Scene(SceneRequest::SelectThings(vec!["ben".into()], Choice::Replace)));
    bench.state.begin_frame(now);
    assert_ne!(camera(&bench), first, "the gizmo is at its time");
}
