//! A click on a scene means a thing and its bone; a box or a lasso means things.

use super::{SIZE, arms, drawn_at, script, shown, state, view};
use dragonfly_anim::fast::matrix::mat4;
use dragonfly_picture::gizmo::LineInk;
use dragonfly_picture::pick::Region;
use dragonfly_picture::scene::Scene;
use dragonfly_picture::{LineAppearance, LineLook, Look};
use glam::{Vec2, Vec3};
use std::sync::Arc;
use std::time::Instant;

/// Returns the pixel where a point is drawn.
fn pixel(scene: &Scene, point: Vec3) -> [f32; 2] {
    let at = drawn_at(scene, point).expect("in front of the camera");
    [(at.x + 1.0) / 2.0 * SIZE[0] as f32, (1.0 - at.y) / 2.0 * SIZE[1] as f32]
}

#[test]
fn a_click_picks_the_thing_and_the_bone_that_is_drawn_there() {
    let view = view(&arms());
    for seconds in [0.0_f32, 0.9] {
        let mut scene = shown(&view, seconds);
        let state = state(&view, f64::from(seconds));
        for (thing, id) in [(0, "anna"), (1, "ben")] {
            let place = state.things[thing].transform.to_matrix();
            let pose = state.things[thing].pose.as_ref().unwrap();
            for bone in 0..3_u32 {
                let to_root = mat4(pose.to_root.get(bone as usize));
                let at = pixel(&scene, place.transform_point3(to_root.transform_point3(Vec3::Y * 0.3)));
                let picked = scene.pick_things(at);
                let first = picked.first().unwrap_or_else(|| panic!("nothing at {at:?}"));
                assert_eq!((&*first.thing, first.bone), (id, Some(bone)), "at {seconds}");
            }
        }
        assert!(scene.pick_things([1.0, 1.0]).is_empty());
    }
}

#[test]
fn things_behind_each_other_are_picked_nearest_first_and_placeholders_too() {
    let text = script(
        r#"<role id="far" model="arm" at="0 0 -3"/><role id="lost" model="lost" at="0 0 2"/><role id="near" model="arm" at="0 0 0"/>
        <camera id="eye" at="0 1 8" look="0 1 0"/>"#,
        "<wait dur=\"1\"/>",
    );
    let mut scene = shown(&view(&text), 0.0);
    let picked = scene.pick_things(pixel(&scene, Vec3::new(0.0, 1.0, 0.0)));
    let ids: Vec<&str> = picked.iter().map(|picked| &*picked.thing).collect();
    assert_eq!(ids, ["lost", "near", "far"]);
    assert_eq!(picked[0].bone, None);
}

#[test]
fn cameras_and_marks_are_picked_where_they_are_drawn() {
    let view = view(&arms());
    let mut scene = shown(&view, 0.0);
    let door = pixel(&scene, Vec3::new(0.0, 0.0, 2.0));
    let near = |scene: &mut Scene| {
        scene.pick_things([door[0] + 4.0, door[1]]).first().map(|picked| picked.thing.to_string())
    };
    assert_eq!(near(&mut scene), None, "it is not drawn");
    scene.look.helpers = true;
    scene.prepare(Instant::now());
    assert_eq!(near(&mut scene).as_deref(), Some("door"));
}

#[test]
fn a_region_has_the_things_whose_middle_is_inside() {
    let view = view(&arms());
    let scene = shown(&view, 0.0);
    let size = Vec2::new(SIZE[0] as f32, SIZE[1] as f32);
    let ids = |region: &Region<'_>| -> Vec<String> {
        scene.things_in(region).iter().map(|picked| picked.thing.to_string()).collect()
    };
    assert_eq!(ids(&Region::Box(Vec2::ZERO, size)), ["anna", "ben"]);
    assert_eq!(ids(&Region::Box(Vec2::ZERO, size * Vec2::new(0.5, 1.0))), ["anna"]);
    let right = [size * Vec2::new(0.5, 0.0), size * Vec2::X, size, size * Vec2::new(0.5, 1.0)];
    assert_eq!(ids(&Region::Lasso(&right)), ["ben"]);
}

#[test]
fn a_model_without_a_scene_has_no_things() {
    let mut scene = Scene::new(Instant::now());
    scene.show_model(dragonfly_kit::document::arm::loaded());
    scene.look.viewport = [0, 0, SIZE[0], SIZE[1]];
    scene.prepare(Instant::now());
    assert!(scene.pick_things([160.0, 90.0]).is_empty());
    assert!(scene.things_in(&Region::Box(Vec2::ZERO, Vec2::splat(1000.0))).is_empty());
}

#[test]
fn the_first_thing_under_the_pointer_is_the_first_of_all_that_are_there() {
    // Roles in rows, some of them inside of the boxes of others.
    let roles: String = (0..12)
        .map(|role| {
            let (x, z) = (f64::from(role % 4) * 0.4 - 0.6, f64::from(role / 4) * -0.3);
            format!(
                r#"<role id="r{role}" model="arm" at="{x} 0 {z}" scale="{}"/>"#,
                0.4 + f64::from(role) * 0.05
            )
        })
        .collect();
    let cast =
        format!(r#"{roles}<camera id="eye" at="0 1 4" look="0 0.7 0"/><mark id="door" at="0.9 0.2 0"/>"#);
    let view = view(&script(&cast, r#"<play who="r3" take="bend"/>"#));
    let mut scene = shown(&view, 0.4);
    scene.look.helpers = true;
    let mut found = 0;
    for x in (0..SIZE[0]).step_by(7) {
        for y in (0..SIZE[1]).step_by(5) {
            let at = [x as f32 + 0.5, y as f32 + 0.5];
            let first = scene.pick_thing(at);
            assert_eq!(first, scene.pick_things(at).into_iter().next(), "at {at:?}");
            found += usize::from(first.is_some());
        }
    }
    assert!(found > 100, "only {found} places have a thing");
}

#[test]
fn a_path_is_picked_along_its_whole_length_while_lines_are_drawn() {
    let view = view(&arms());
    let mut scene = shown(&view, 0.0);
    scene.look.helpers = true;
    scene.prepare(Instant::now());
    // Away from the role at its start.
    let middle = pixel(&scene, Vec3::new(2.0, 0.0, 2.6));
    let near = |scene: &mut Scene| {
        scene.pick_things([middle[0], middle[1] + 3.0]).iter().any(|picked| &*picked.thing == "way")
    };
    assert!(!near(&mut scene), "no line is drawn");
    let line = LineLook {
        points: vec![Vec3::X, Vec3::Y].into(),
        ink: LineInk::default(),
        opacity: 1.0,
        shown: [None; 2],
        of: None,
        arrows: Arc::default(),
        ticks: Arc::default(),
        dots: Arc::default(),
    };
    scene.appearances.set(LineAppearance { lines: vec![line].into(), ..LineAppearance::default() });
    assert!(near(&mut scene));
    scene.set_look(Look { hidden_things: vec!["way".into()].into(), ..scene.look.clone() });
    scene.prepare(Instant::now());
    assert!(!near(&mut scene), "a hidden path is not picked");
}

#[test]
fn an_effect_has_a_symbol_where_it_is_and_is_picked_there() {
    let text = script(
        r#"<effect id="rain" kind="particles" at="0 1 0"/><camera id="eye" at="0 1 8" look="0 1 0"/>"#,
        "<wait dur=\"1\"/>",
    );
    let mut scene = shown(&view(&text), 0.0);
    let lines = |scene: &mut Scene| {
        scene.prepare(Instant::now());
        scene.controls.shape().lines().len() / 2
    };
    assert_eq!(lines(&mut scene), 0);
    scene.look.helpers = true;
    // A ring of sixteen lines and four drops; the camera is that of the shot.
    assert_eq!(lines(&mut scene), 16 + 4);
    let at = pixel(&scene, Vec3::Y);
    assert_eq!(scene.pick_things(at).first().map(|picked| picked.thing.to_string()).as_deref(), Some("rain"));
}
