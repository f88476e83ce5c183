//! Pictures of scenes: things of one model share their draw calls, what is transparent is drawn from back to front, lamps shine.

use super::{SIZE, arms, projected, script, settings, shown, state, view, view_in};
use dragonfly_anim::fast::matrix::mat4;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::ScriptContext;
use dragonfly_kit::document::arm;
use dragonfly_kit::picture::images::difference;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{PictureSettings, ThingAppearance, ThroughCamera};
use glam::Vec3;
use image::RgbaImage;
use std::time::Instant;

#[test]
fn bones_of_each_role_lie_on_its_pixels() {
    let Some(mut studio) = studio::studio() else { return };
    let view = view(&arms());
    for seconds in [0.0_f32, 0.5, 1.75] {
        let picture = studio.render_scene(&view, &settings(ThroughCamera::Shot, seconds)).unwrap();
        let state = state(&view, f64::from(seconds));
        let camera = state.camera.unwrap();
        let (mut inside, mut found) = (0, 0);
        for thing in &state.things[..2] {
            let place = thing.transform.to_matrix();
            for matrix in thing.pose.as_ref().unwrap().to_root.matrices() {
                // A little along the bone, inside the tube and not at its lower end.
                let bone = place.transform_point3(mat4(matrix).transform_point3(Vec3::Y * 0.1));
                let Some(at) = projected(camera.position, camera.rotation, camera.lens, bone) else {
                    continue;
                };
                if at.abs().max_element() < 0.98 {
                    let [x, y] = [(at.x + 1.0) / 2.0 * SIZE[0] as f32, (1.0 - at.y) / 2.0 * SIZE[1] as f32];
                    inside += 1;
                    found += usize::from(picture.get_pixel(x as u32, y as u32)[3] > 128);
                }
            }
        }
        assert!(inside >= 2 && found == inside, "{found} of {inside} bones at {seconds}");
    }
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn roles_of_one_model_share_their_draw_calls() {
    let Some(mut studio) = studio::studio() else { return };
    let solid = |roles: usize| {
        let cast: String = (0..roles)
            .map(|role| format!("<role id=\"r{role}\" model=\"arm\" at=\"{role} 0 0\"/>"))
            .collect();
        view(&script(&cast, "<wait dur=\"1\"/>"))
    };
    let mut draws = |roles: usize| {
        studio.render_scene(&solid(roles), &settings(ThroughCamera::Free, 0.0)).unwrap();
        let scene = &studio.stage().scene;
        let solid: usize = scene.draw_sets().map(|set| set.batches().solid().len()).sum();
        let instances: usize = scene.draw_sets().map(|set| set.batches().instances().len()).sum();
        (solid, instances)
    };
    assert_eq!(draws(1), (1, 2));
    assert_eq!(draws(20), (1, 40));
}

#[test]
fn what_is_transparent_is_drawn_from_back_to_front_also_between_models() {
    let Some(mut studio) = studio::studio() else { return };
    // The panes of three arms in a row away from the camera; the middle one is of another model of the same shape.
    let text = script(
        r#"<role id="a" model="arm" at="0 0 0"/><role id="b" model="other" at="0 0 -2"/><role id="c" model="arm" at="0 0 -4"/>
        <camera id="eye" at="0 3 8" look="0 2.5 0"/>"#,
        "<wait dur=\"1\"/>",
    );
    let view = view(&text);
    let mut models = std::collections::BTreeMap::clone(&view.models);
    let other = dragonfly_kit::document::arm::loaded();
    models.insert("other".to_owned(), dragonfly_document::SceneModel::Loaded(other));
    let view = std::sync::Arc::new(dragonfly_document::SceneView {
        models: std::sync::Arc::new(models),
        ..dragonfly_document::SceneView::clone(&view)
    });
    let two = studio.render_scene(&view, &settings(ThroughCamera::Shot, 0.0)).unwrap();
    let blended = studio.stage().draw_calls();
    let one = studio.render_scene(&super::view(&text), &settings(ThroughCamera::Shot, 0.0)).unwrap();
    assert_eq!(difference(&two, &one), 0, "the picture does not depend on how models are shared");
    assert!(blended > studio.stage().draw_calls());
}

#[test]
fn the_grid_and_the_contact_shadow_are_as_high_as_the_ground_of_the_project() {
    let Some(mut studio) = studio::studio() else { return };
    // The same scene twice: on the ground at 0, and everything three meters higher.
    let mut draw = |ground: u32, grid: bool| {
        let project = format!("<project version=\"1\"><scene ground=\"{ground}\"/></project>");
        let project = StageProject::read(project).expect("a project");
        let context = ScriptContext { project: Some(project), ..ScriptContext::default() };
        let [eye, target] = [ground + 2, ground + 1];
        let cast = format!(
            r#"<role id="a" model="arm" at="0 {ground} 0"/><camera id="eye" at="0 {eye} 6" look="0 {target} 0"/>"#
        );
        let view = view_in(&context, &script(&cast, "<wait dur=\"1\"/>"), &arm::loaded());
        let settings = PictureSettings { grid, ..settings(ThroughCamera::Shot, 0.0) };
        studio.render_scene(&view, &settings).expect("a picture")
    };
    let (low, high, none) = (draw(0, true), draw(3, true), draw(0, false));
    let changed = low
        .pixels()
        .zip(high.pixels())
        .filter(|(a, b)| a.0.iter().zip(b.0).any(|(&a, b)| a.abs_diff(b) > 2))
        .count();
    let grid = difference(&low, &none);
    println!("{changed} of {} pixels differ", low.pixels().count());
    assert!(grid > 2000, "{grid} pixels: the ground is seen");
    assert!(changed * 200 < low.pixels().count(), "{changed} pixels");
}

/// Returns the mean brightness of the left and the right half of what is drawn.
fn halves(picture: &RgbaImage) -> [f64; 2] {
    let mut sums = [(0.0, 0.0); 2];
    for (x, _, pixel) in picture.enumerate_pixels().filter(|(.., pixel)| pixel[3] == 255) {
        let half = &mut sums[usize::from(x >= picture.width() / 2)];
        half.0 += f64::from(pixel[0]) + f64::from(pixel[1]) + f64::from(pixel[2]);
        half.1 += 3.0;
    }
    sums.map(|(sum, count)| sum / f64::max(count, 1.0))
}

#[test]
fn lamps_of_the_scene_replace_those_of_the_studio() {
    let Some(mut studio) = studio::studio() else { return };
    let lit = |light: &str| {
        let cast = format!(
            r#"<role id="a" model="arm"/><camera id="eye" at="0 1.5 5" look="0 1.5 0" lens="50mm"/>{light}"#
        );
        view(&script(&cast, "<wait dur=\"1\"/>"))
    };
    let mut picture =
        |light: &str| studio.render_scene(&lit(light), &settings(ThroughCamera::Shot, 0.0)).unwrap();
    let [studio_left, _] = halves(&picture(""));
    let sun = |x: &str, strength: &str| {
        format!(
            r##"<light id="sun" kind="sun" direction="{x} -0.4 -0.4" strength="{strength}" color="#ffffff"/>"##
        )
    };
    let (from_left, from_right) = (halves(&picture(&sun("1", "3"))), halves(&picture(&sun("-1", "3"))));
    println!("studio {studio_left:.0}, from the left {from_left:.0?}, from the right {from_right:.0?}");
    assert!(from_left[0] > 1.15 * from_left[1] && from_right[1] > 1.15 * from_right[0]);
    let weak = halves(&picture(&sun("1", "1")));
    assert!(weak[0] < 0.9 * from_left[0], "a weaker sun is darker");
    assert_eq!(halves(&picture(&sun("1", "0")))[0], studio_left, "a dark lamp counts as none");
    let near = |z: &str, kind: &str| {
        format!(r#"<light id="lamp" kind="{kind}" at="0 1.5 {z}" direction="0 0 -1" strength="6"/>"#)
    };
    let [close, _] = halves(&picture(&near("1.5", "point")));
    let [far, _] = halves(&picture(&near("6", "point")));
    assert!(close > 1.2 * far, "{close} {far}");
    let [spot, _] = halves(&picture(&near("3", "spot")));
    let behind = r#"<light id="lamp" kind="spot" at="0 1.5 3" direction="0 0 1" strength="6"/>"#.to_owned();
    assert!(spot > 1.1 * halves(&picture(&behind))[0], "a spot shines in its direction only");
}

#[test]
fn a_hidden_lamp_does_not_shine() {
    let Some(mut studio) = studio::studio() else { return };
    let cast = |light: &str| {
        format!(
            r#"<role id="a" model="arm"/><camera id="eye" at="0 1.5 5" look="0 1.5 0" lens="50mm"/>{light}"#
        )
    };
    let text = |light: &str| view(&script(&cast(light), "<wait dur=\"1\"/>"));
    let sun = r##"<light id="sun" kind="sun" direction="1 -0.4 -0.4" strength="3" color="#ffffff"/>"##;
    let mut picture = |light: &str, hidden: &[&str]| {
        let mut settings = settings(ThroughCamera::Shot, 0.0);
        settings.look.hidden_things = hidden.iter().map(|id| std::sync::Arc::from(*id)).collect();
        // Things are hidden when a scene is shown.
        studio.stage().scene.look = settings.look.clone();
        studio.render_scene(&text(light), &settings).unwrap()
    };
    let (dark, lit) = (picture("", &[]), picture(sun, &[]));
    assert!(difference(&dark, &lit) > 0, "the sun is seen");
    assert_eq!(difference(&picture(sun, &["sun"]), &dark), 0, "as without it");
    let fill = r##"<light id="fill" kind="sun" direction="-1 -0.4 -0.4" strength="1" color="#ffffff"/>"##;
    let both = picture(&format!("{sun}{fill}"), &["sun"]);
    assert_eq!(difference(&both, &picture(fill, &[])), 0, "other lamps shine on");
}

#[test]
fn the_distance_in_focus_is_marked_in_front_of_its_camera() {
    let cast = |focus: &str| format!(r#"<camera id="eye" at="0 1 8" look="0 1 0"{focus}/>"#);
    let drawn = |focus: &str| {
        let mut scene = shown(&view(&script(&cast(focus), "<wait dur=\"1\"/>")), 0.0);
        scene.look.helpers = true;
        scene.look.through = ThroughCamera::Free;
        scene.prepare(Instant::now());
        scene.controls.shape().lines().iter().map(|vertex| vertex.position).collect::<Vec<_>>()
    };
    let (without, with) = (drawn(""), drawn(r#" focus="3""#));
    // A frame and a cross, three meters ahead.
    assert_eq!(with.len() - without.len(), 6 * 2);
    let mark: Vec<_> = with.iter().filter(|at| !without.contains(at)).collect();
    assert!(!mark.is_empty() && mark.iter().all(|at| (at.z - 5.0).abs() < 1e-4), "{mark:?}");
}

#[test]
fn the_camera_that_is_looked_through_is_not_drawn_but_its_focus_is() {
    let cast =
        r#"<camera id="eye" at="0 1 8" look="0 1 0" focus="3"/><camera id="other" at="2 1 3" look="0 1 0"/>"#;
    let drawn = |through: ThroughCamera| {
        let mut scene = shown(&view(&script(cast, "<wait dur=\"1\"/>")), 0.0);
        scene.look.helpers = true;
        scene.look.through = through;
        scene.prepare(Instant::now());
        scene.controls.shape().lines().iter().map(|vertex| vertex.position).collect::<Vec<_>>()
    };
    let (free, through) = (drawn(ThroughCamera::Free), drawn(ThroughCamera::Of("eye".into())));
    // Four edges, four sides and a roof of two lines are missing.
    assert_eq!(free.len() - through.len(), 10 * 2);
    assert!(through.iter().any(|at| (at.z - 5.0).abs() < 1e-4), "the distance in focus");
    assert!(through.iter().all(|at| at.z < 7.0), "nothing is drawn around the eye");
}

#[test]
fn titles_are_drawn_while_they_are_shown() {
    let Some(mut studio) = studio::studio() else { return };
    let text = script(
        r#"<role id="a" model="arm"/><camera id="eye" at="0 1.5 9" look="0 1.5 0"/>"#,
        r#"<wait dur="3"/><title text="The End" begin="1" dur="1" at="0.5 0.85"/>"#,
    );
    let view = view(&text);
    let mut at = |time: f32| studio.render_scene(&view, &settings(ThroughCamera::Shot, time)).unwrap();
    let (before, during) = (at(0.5), at(1.5));
    let changed: Vec<(u32, u32)> = before
        .enumerate_pixels()
        .filter(|(x, y, pixel)| during.get_pixel(*x, *y) != *pixel)
        .map(|(x, y, _)| (x, y))
        .collect();
    assert!(changed.len() > 60, "only {} pixels", changed.len());
    let middle = changed.iter().map(|at| f64::from(at.0)).sum::<f64>() / changed.len() as f64;
    assert!((middle - f64::from(SIZE[0]) / 2.0).abs() < 8.0, "{middle}");
    assert!(changed.iter().all(|at| (130..176).contains(&at.1)), "around 0.85 of the height");
}

#[test]
fn helpers_and_boxes_of_selected_things_are_drawn_when_asked_for() {
    let view = view(&arms());
    let mut scene = shown(&view, 0.0);
    let mut lines = |change: &dyn Fn(&mut dragonfly_picture::scene::Scene)| {
        change(&mut scene);
        scene.prepare(Instant::now());
        scene.controls.shape().lines().len() / 2
    };
    assert_eq!(lines(&|_| {}), 0, "nothing unless asked for");
    let helpers = lines(&|scene| scene.look.helpers = true);
    // The camera of ten lines that is not the one of the shot, a mark of a circle and an arrow; paths are drawn with the lines.
    assert_eq!(helpers, 10 + 17);
    let selected = ThingAppearance { selected: vec!["anna".into()].into(), hovered: Some("door".into()) };
    let boxes = lines(&|scene| {
        scene.look.helpers = false;
        scene.appearances.set(selected.clone());
    });
    assert_eq!(boxes, 2 * 12);
}

#[test]
fn a_scene_after_a_lost_device_and_a_model_after_a_scene_are_drawn_as_before() {
    let Some(mut studio) = studio::studio() else { return };
    let (view, arm) = (view(&arms()), dragonfly_kit::document::arm::loaded());
    let before = studio.render(&arm, &settings(ThroughCamera::Free, 0.0)).unwrap();
    let first = studio.render_scene(&view, &settings(ThroughCamera::Shot, 0.5)).unwrap();
    studio.stage().device().lose();
    let second = studio.render_scene(&view, &settings(ThroughCamera::Shot, 0.5)).unwrap();
    assert_eq!(difference(&first, &second), 0);
    // A model shown after a scene is drawn as before it.
    let after = studio.render(&arm, &settings(ThroughCamera::Free, 0.0)).unwrap();
    assert_eq!(difference(&before, &after), 0);
}

#[test]
fn the_letters_of_a_large_title_stay_whole_after_many_other_titles() {
    let Some(mut studio) = studio::studio() else { return };
    let letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
    let title = |(at, letter): (usize, char)| {
        format!(r#"<title text="{letter}" begin="{at}" dur="1" at="0.5 0.5"/>"#)
    };
    let titles: String = letters.chars().enumerate().map(title).collect();
    let wait = format!(r#"<wait dur="{}"/>"#, letters.len());
    let view =
        view(&script(r#"<camera id="eye" at="0 0 5" look="0 0 0"/>"#, &format!("<par>{wait}{titles}</par>")));
    // As high as a picture of a movie for a wall, and as narrow as the middle of a letter.
    let size = [96, 8192];
    let mut at = |time: f32| {
        studio.render_scene(&view, &PictureSettings { size, ..settings(ThroughCamera::Shot, time) }).unwrap()
    };
    let first = at(0.5);
    for letter in 1..letters.len() {
        assert!(at(letter as f32 + 0.5) != first, "letter {letter} is another one");
    }
    assert!(at(0.5) == first, "the first letter looks different after all others");
}
