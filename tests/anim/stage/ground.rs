//! Ways on ground that is a mesh.

use super::actors::{assets, bits, fox, planned, seconds};
use super::{listed, read};
use dragonfly_anim::data::{
    AnimationData, Bone, Mesh, MeshInstance, ModelData, Primitive, Skeleton, Vertices,
};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::hit::{HitSettings, Ray, ray_open};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::{GROUND_TRIANGLES, LiveStage, StageAssets, StageModel, StagePlan};
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::{DQuat, DVec3, Mat4, Vec3};
use std::sync::Arc;

/// Returns a model of these triangles, in one mesh that is placed with `place`.
fn model(positions: Vec<Vec3>, indices: Vec<u32>, place: Mat4) -> ModelData {
    let normals = vec![Vec3::Y; positions.len()];
    let vertices = Vertices { positions, normals, ..Vertices::default() };
    let primitive = Primitive { vertices, indices, ..Primitive::default() };
    let mesh = Mesh { primitives: vec![primitive], ..Mesh::default() };
    let instance = MeshInstance {
        mesh: 0,
        node: None,
        skin: None,
        bone: Some(0),
        to_bone: place,
        morph_weights: Vec::new(),
    };
    let skeleton = Arc::new(Skeleton { bones: vec![Bone::root("ground")] });
    ModelData {
        meshes: vec![mesh],
        instances: vec![instance],
        animation: AnimationData { skeleton, takes: Vec::new() },
        ..ModelData::default()
    }
}

/// Returns a square sheet of `cells`² cells of two triangles, `size` meters wide, around the origin, that faces up.
pub(super) fn sheet(cells: u32, size: f32, height: impl Fn(f32, f32) -> f32) -> ModelData {
    let at = |index: u32| (index as f32 / cells as f32 - 0.5) * size;
    let row = |z: u32| (0..=cells).map(move |x| (x, z));
    let positions = (0..=cells).flat_map(row).map(|(x, z)| Vec3::new(at(x), height(at(x), at(z)), at(z)));
    let cell = |x: u32, z: u32| {
        let first = z * (cells + 1) + x;
        let below = first + cells + 1;
        [first, below, first + 1, first + 1, below, below + 1]
    };
    let indices = (0..cells).flat_map(|z| (0..cells).flat_map(move |x| cell(x, z)));
    model(positions.collect(), indices.collect(), Mat4::IDENTITY)
}

/// Returns a closed box between two corners, whose faces look outwards.
pub(super) fn solid(min: Vec3, max: Vec3) -> ModelData {
    let corner = |at: usize| {
        let pick = |axis: usize| if at & (1 << axis) == 0 { min[axis] } else { max[axis] };
        Vec3::new(pick(0), pick(1), pick(2))
    };
    // Two triangles a face: -z, +z, -y, +y, -x, +x.
    let indices = [
        [0, 2, 1, 1, 2, 3],
        [4, 5, 6, 6, 5, 7],
        [0, 1, 4, 4, 1, 5],
        [2, 6, 3, 3, 6, 7],
        [0, 4, 2, 2, 4, 6],
        [1, 3, 5, 5, 3, 7],
    ];
    model((0..8).map(corner).collect(), indices.concat(), Mat4::IDENTITY)
}

/// Returns assets with the fox as `a.glb` and these models as `0.glb` and so on.
fn with_models(models: Vec<ModelData>) -> StageAssets {
    let mut assets = assets(&fox());
    for (number, model) in models.into_iter().enumerate() {
        assets.add_model(format!("{number}.glb"), Arc::new(StageModel::new(Arc::new(model))));
    }
    assets
}

/// Returns a script with a fox that goes along `points` in 10 s, over ground of the models `0.glb` and so on with these attributes.
fn walk(points: &str, ground: &[&str]) -> String {
    let prop = |(number, attributes): (usize, &&str)| {
        format!("<prop id=\"g{number}\" model=\"{number}.glb\" ground=\"yes\" {attributes}/>")
    };
    let props: String = ground.iter().enumerate().map(prop).collect();
    format!(
        "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"0.01\"/>{props}\
         <path id=\"way\" points=\"{points}\"/></cast><move who=\"anna\" path=\"way\" dur=\"10\" ground=\"mesh\"/></script>"
    )
}

fn walked(points: &str, ground: &[&str], models: Vec<ModelData>) -> StagePlan {
    planned(&walk(points, ground), &with_models(models))
}

/// Returns the place of the fox.
fn place(plan: &StagePlan, time: f64) -> DVec3 {
    plan.placement(plan.thing_called("anna").unwrap(), seconds(time)).unwrap().position
}

fn check(plan: &StagePlan, time: f64, height: f64) {
    let found = place(plan, time);
    assert!((found.y - height).abs() < 1e-5, "{found} at {time} s instead of {height}");
}

#[test]
fn beside_the_ground_props_ways_and_what_falls_are_on_the_plane_of_the_project() {
    let text = walk("-4 0 1  6 0 1", &[""]).replace(
        "</cast>",
        "<mark id=\"cup\" at=\"9 1 0\"/><mark id=\"cap\" at=\"0 9 1\"/><prop id=\"bag\" model=\"a.glb\"/><prop id=\"hat\" model=\"a.glb\"/></cast>\
         <attach who=\"bag\" to=\"cup\"/><detach who=\"bag\" drop=\"ground\" begin=\"1\"/>\
         <attach who=\"hat\" to=\"cap\"/><detach who=\"hat\" drop=\"ground\" begin=\"1\"/>",
    );
    let assets = with_models(vec![sheet(1, 4.0, |x, z| 0.25 * x + 0.5 * z + 2.0)]);
    for height in [-0.75, 0.0, 1.5] {
        let project = format!("<project version=\"1\"><scene ground=\"{height}\"/></project>");
        let project = StageProject::read(project).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
        let script = StageScript::read_of(text.as_str(), Some(&project));
        let script = script.unwrap_or_else(|errors| panic!("{}", listed(&errors)));
        let plan = StagePlan::new(&script, &assets).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
        assert_eq!(plan.ground_plane(), height);
        // At x = t - 4; the sheet is from -2 to 2.
        check(&plan, 1.0, height);
        check(&plan, 4.0, 2.5);
        check(&plan, 6.5, height);
        let mut scene = plan.new_scene();
        plan.scene_at(seconds(5.0), &mut scene);
        let fallen =
            |id: &str| f64::from(scene.things[plan.thing_called(id).unwrap()].transform.translation.y);
        let wanted = if height < 1.0 { height } else { 1.0 };
        assert!((fallen("bag") - wanted).abs() < 1e-5, "what is below the plane stays: {}", fallen("bag"));
        assert!((fallen("hat") - 2.5).abs() < 1e-5, "it falls on the sheet: {}", fallen("hat"));
    }
}

#[test]
fn a_way_has_the_height_of_a_slope_and_of_the_plane_beside_it() {
    let slope = || sheet(1, 4.0, |x, z| 0.25 * x + 0.5 * z + 2.0);
    let plan = walked("-4 0 1  6 0 1", &[""], vec![slope()]);
    // At x = t - 4; the sheet is from -2 to 2.
    check(&plan, 1.0, 0.0);
    check(&plan, 2.5, 0.25 * -1.5 + 0.5 + 2.0);
    check(&plan, 4.0, 2.5);
    check(&plan, 5.75, 0.25 * 1.75 + 2.5);
    check(&plan, 6.5, 0.0);
    // Moved, turned and scaled: a quarter turn to the left takes x of the model to -z of the scene.
    let plan = walked("0 7 -4  0 7 6", &["at=\"0 3 0\" facing=\"90\" scale=\"2\""], vec![slope()]);
    let own = |z: f64| 3.0 + 2.0 * (0.25 * (-z / 2.0) + 0.5 * 0.0 + 2.0);
    check(&plan, 1.0, own(-3.0));
    check(&plan, 4.0, own(0.0));
    check(&plan, 7.5, own(3.5));
    // Without the mesh a way has its own height.
    let text = walk("0 7 -4  0 7 6", &[""]).replace(" ground=\"mesh\"", "");
    check(&planned(&text, &with_models(vec![slope()])), 4.0, 7.0);
}

#[test]
fn a_way_passes_under_a_bridge_over_it_and_over_what_stands_on_a_floor() {
    let floor = || sheet(3, 40.0, |_, _| 0.0);
    let boxed = |min: [f32; 3], max: [f32; 3]| solid(min.into(), max.into());
    let bridge = || boxed([-2.0, 2.6, -2.0], [2.0, 3.0, 2.0]);
    let both = ["", ""];
    check(&walked("-5 0 0  5 0 0", &both, vec![floor(), bridge()]), 5.0, 0.0);
    check(&walked("-5 3 0  5 3 0", &both, vec![floor(), bridge()]), 5.0, 3.0);
    // Nearer to the floor than to the bridge, and in the middle, where the higher one counts.
    check(&walked("-5 1.4 0  5 1.4 0", &both, vec![floor(), bridge()]), 5.0, 0.0);
    check(&walked("-5 1.5 0  5 1.5 0", &both, vec![floor(), bridge()]), 5.0, 3.0);
    // A block on the floor, in it, or a hand above it: there is no room below.
    for low in [-1.0, 0.0, 0.1] {
        let block = boxed([-2.0, low, -2.0], [2.0, 9.0, 2.0]);
        let plan = walked("-5 0 0  5 0 0", &both, vec![floor(), block]);
        check(&plan, 5.0, 9.0);
        check(&plan, 2.0, 0.0);
    }
    // A hill without an underside hides the floor as well.
    let hill = sheet(20, 8.0, |x, z| 5.0 - x.abs().max(z.abs()));
    check(&walked("-5 0 0  5 0 0", &both, vec![floor(), hill]), 5.0, 5.0);
}

#[test]
fn sides_are_those_that_are_drawn() {
    // A sheet that a mirrored placement turns over faces up; one whose triangles all face down counts as if they faced up.
    let mirrored = |place: Mat4| {
        let mut model = sheet(2, 10.0, |_, _| 1.0);
        model.instances[0].to_bone = place;
        model
    };
    let down = || {
        let mut model = sheet(2, 10.0, |_, _| 1.0);
        model.meshes[0].primitives[0].indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(0, 1));
        model
    };
    check(
        &walked("-4 0 0  4 0 0", &[""], vec![mirrored(Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)))]),
        5.0,
        1.0,
    );
    check(&walked("-4 0 0  4 0 0", &[""], vec![down()]), 5.0, 1.0);
    // In a model that has both, what faces down is a ceiling.
    let mut room = sheet(2, 10.0, |_, _| 0.25);
    let mut ceiling =
        mirrored(Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * Mat4::from_translation(Vec3::Y * -4.0));
    ceiling.instances[0].mesh = 1;
    room.meshes.append(&mut ceiling.meshes);
    room.instances.append(&mut ceiling.instances);
    check(&walked("-4 9 0  4 9 0", &[""], vec![room]), 5.0, 0.25);
}

/// Returns a height of gentle hills.
fn hills(x: f32, z: f32) -> f32 {
    0.4 * (0.9 * x).sin() + 0.3 * (1.3 * z + 0.5 * x).cos()
}

#[test]
fn heights_agree_with_rays_that_are_tested_against_every_triangle() {
    let first = seed(3);
    println!("seed {first}");
    let mut random = Random::new(first);
    let data = Arc::new(sheet(24, 12.0, hills));
    let assets = with_models(vec![ModelData::clone(&data)]);
    let mut evaluator = Evaluator::new(Arc::clone(&data));
    evaluator.pose(None, 0.0);
    let mut hits = 0;
    for _ in 0..40 {
        let [x, y, z, turn] = [3.0, 3.0, 3.0, 180.0].map(|most: f32| f64::from(random.between(-most, most)));
        let scale = f64::from(random.between(0.5, 2.0));
        let attributes = format!("at=\"{x} {y} {z}\" facing=\"{turn}\" scale=\"{scale}\"");
        let plan = planned(&walk("-5 0 -2  5 0 3", &[&attributes]), &assets);
        for _ in 0..50 {
            let found = place(&plan, f64::from(random.between(0.0, 10.0)));
            let rotation = DQuat::from_rotation_y(turn.to_radians());
            let own = rotation.inverse() * (found - DVec3::new(x, y, z)) / scale;
            let ray = Ray { origin: own.with_y(50.0).as_vec3(), direction: Vec3::NEG_Y };
            let hit = ray_open(&evaluator, &evaluator.all_positions(), &ray, &HitSettings::default());
            let expected = hit.map_or(0.0, |hit| y + scale * f64::from(hit.position.y));
            assert!((found.y - expected).abs() < 2e-4, "{found} instead of {expected}, {attributes}");
            hits += usize::from(hit.is_some());
        }
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn heights_are_continuous_and_have_no_gaps_along_edges_of_triangles() {
    let plan = walked("-5.5 0 -5.5  5.5 0 5.5", &[""], vec![sheet(24, 12.0, hills)]);
    let mut before = place(&plan, 0.0);
    let (mut steepest, steps) = (0.0_f64, 200_000);
    for step in 1..=steps {
        // The way is along a diagonal of all cells: on edges and corners all the time.
        let now = place(&plan, 10.0 * f64::from(step) / f64::from(steps));
        let flat = (now - before).with_y(0.0).length();
        steepest = steepest.max((now.y - before.y).abs() / flat);
        before = now;
    }
    // The slope of the hills is below 0.36 + 0.39 + 0.15.
    assert!(steepest < 0.9, "{steepest}");
}

#[test]
fn a_scene_on_a_mesh_has_the_same_bits_in_any_order_and_on_any_thread_and_allocates_nothing() {
    let models = || with_models(vec![sheet(24, 12.0, hills), sheet(1, 3.0, |_, _| 1.5)]);
    let text = walk("-5 0 -2  0 1 0  5 0 3", &["", "at=\"2 0 1\" facing=\"30\""])
        .replace("dur=\"10\"", "take=\"Walk\"")
        .replace("<move ", "<move begin=\"1\" fade-in=\"0.5\" ");
    let plan = planned(&text, &models());
    let mut scene = plan.new_scene();
    let frames = 240;
    let forward: Vec<Vec<u32>> = (0..frames)
        .map(|frame| {
            plan.frame(frame, &mut scene);
            bits(&scene)
        })
        .collect();
    assert!(forward.windows(2).filter(|pair| pair[0] != pair[1]).count() > 100);
    std::thread::scope(|scope| {
        let (plan, forward) = (&plan, &forward);
        scope.spawn(move || {
            let mut scene = plan.new_scene();
            for frame in (0..frames).rev() {
                plan.frame(frame, &mut scene);
                assert_eq!(bits(&scene), forward[frame as usize], "frame {frame}");
            }
        });
    });
    let again = planned(&text, &models());
    again.frame(100, &mut scene);
    assert_eq!(bits(&scene), forward[100]);
    let (asked, ()) = count(|| (0..frames).for_each(|frame| plan.frame(frame, &mut scene)));
    assert_eq!(asked.allocations, 0);
}

#[test]
fn what_falls_stops_on_the_ground_below_it() {
    let text = |height: f64| {
        walk("0 0 0  1 0 0", &["", ""]).replace("<path ", "<prop id=\"ball\" model=\"s.glb\"/><path ").replace(
            "<move ",
            &format!("<attach who=\"ball\" to=\"0.5 {height} 0.5\"/><detach who=\"ball\" begin=\"1\" drop=\"ground\"/><move "),
        )
    };
    let ground = || {
        let bridge = solid(Vec3::new(-2.0, 2.6, -2.0), Vec3::new(2.0, 3.0, 2.0));
        with_models(vec![sheet(1, 40.0, |x, _| x - 1.0), bridge])
    };
    for (from, to) in [(5.0, 3.0), (2.0, -0.5), (-3.0, -3.0)] {
        let plan = planned(&text(from), &ground());
        let ball = plan.thing_called("ball").unwrap();
        let mut scene = plan.new_scene();
        for (time, expected) in [(1.0, from), (1.1, (from - 0.049_05).max(to)), (9.0, to)] {
            plan.scene_at(seconds(time), &mut scene);
            let found = scene.things[ball].transform.translation.y;
            assert!((f64::from(found) - expected).abs() < 1e-4, "{found} at {time} s instead of {expected}");
        }
    }
}

#[test]
fn errors_say_what_is_missing_and_what_stands_still() {
    let models = || with_models(vec![sheet(1, 4.0, |_, _| 0.0)]);
    let refused = |text: &str| {
        let errors = StagePlan::new(&read(text), &models()).expect_err("an error");
        listed(&errors)
    };
    let without = walk("0 0 0  1 0 0", &[""]).replace(" ground=\"yes\"", "");
    let said = refused(&without);
    assert!(said.contains("no prop of the cast is ground") && said.contains("(props: g0)"), "{said}");
    let said = refused(&walk("0 0 0  1 0 0", &[]));
    assert!(said.contains("add a <prop> with ground=\"yes\" to the cast"), "{said}");
    let moves = [
        "<move who=\"g0\" path=\"way\" speed=\"1\"/>",
        "<place who=\"g0\" at=\"1 0 0\"/>",
        "<turn who=\"g0\" to=\"90\"/>",
        "<attach who=\"g0\" to=\"anna\"/>",
    ];
    for action in moves {
        let said = refused(
            &walk("0 0 0  1 0 0", &[""])
                .replace("<move who=\"anna\"", &format!("{action}<move who=\"anna\"")),
        );
        assert!(said.contains("\"g0\" is ground, and ground stands still"), "{action}: {said}");
    }
    let wrong = walk("0 0 0  1 0 0", &[""]).replace("ground=\"mesh\"", "ground=\"mash\"");
    let errors = dragonfly_anim::stage::script::StageScript::read(wrong).expect_err("no such word");
    assert!(listed(&errors).contains("\"mesh\""), "{}", listed(&errors));
}

#[test]
fn a_model_that_is_too_large_is_refused_before_its_triangles_are_read() {
    let mut huge = sheet(100, 4.0, |_, _| 0.0);
    let instance = huge.instances[0].clone();
    huge.instances = vec![instance; GROUND_TRIANGLES / 20_000 + 1];
    let (text, assets) = (read(&walk("0 0 0  1 0 0", &[""])), with_models(vec![huge]));
    let (asked, planned) = count(|| StagePlan::new(&text, &assets));
    let said = listed(&planned.expect_err("too many triangles"));
    assert!(said.contains("more than 2097152 triangles"), "{said}");
    assert!(asked.bytes < 1 << 20, "{} bytes", asked.bytes);
}

#[test]
fn the_ground_is_prepared_once_for_all_texts_and_props_of_its_model() {
    let assets = with_models(vec![sheet(200, 12.0, hills)]);
    let text = walk("-5 0 -2  5 0 3", &[""]);
    let mut live = LiveStage::default();
    let (first, is_right) = count(|| live.update(text.clone(), &assets));
    assert!(is_right);
    let twice =
        text.replace("<path ", "<prop id=\"more\" model=\"0.glb\" ground=\"yes\" at=\"0 1 0\"/><path ");
    let (second, is_right) = count(|| live.update(twice, &assets));
    assert!(is_right);
    // 80,000 triangles are some megabytes.
    assert!(first.bytes > 3 << 20 && second.bytes < 1 << 20, "{} {}", first.bytes, second.bytes);
}

/// Returns a closed double cone of `around` triangles above and below, whose tips are over each other.
fn spindle(around: u32) -> ModelData {
    let ring = |at: u32| {
        let angle = std::f32::consts::TAU * at as f32 / around as f32;
        Vec3::new(angle.cos(), 2.5, angle.sin())
    };
    let positions = [Vec3::Y * 3.0, Vec3::Y * 2.0].into_iter().chain((0..around).map(ring)).collect();
    let sides = (0..around).flat_map(|at| {
        let (this, next) = (2 + at, 2 + (at + 1) % around);
        [0, next, this, 1, this, next]
    });
    model(positions, sides.collect(), Mat4::IDENTITY)
}

#[test]
fn below_the_tip_of_a_fan_of_triangles_is_the_floor() {
    for around in [5, 31, 48, 200] {
        let plan = walked("-4 0 0  6 0 0", &["", ""], vec![spindle(around), sheet(1, 20.0, |_, _| 0.0)]);
        for height in [0.0, 0.4] {
            assert_eq!(plan.ground_at(DVec3::Y * height), Some(0.0), "{around}");
        }
        let top = plan.ground_at(DVec3::Y * 3.0).unwrap();
        assert!((top - 3.0).abs() < 1e-9, "{around}: {top}");
    }
}
