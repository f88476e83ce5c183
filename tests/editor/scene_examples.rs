//! The scenes in `editor/examples`: checked, posed, rendered; what is rendered agrees with what is posed, and feet do not slide.

use crate::program::run;
use dragonfly_anim::stage::StageScene;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::{Cancel, load_scene};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::skip::{TestNeed, skip};
use glam::{Mat4, Vec2, Vec3};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Every example, and what has its bones in the image of a camera at a time.
const EXAMPLES: [(&str, &str); 3] = [("duel", "ben"), ("walk", "anna"), ("crowd", "role-12")];

/// Bones inside of the surface of a figure.
const INSIDE: [&str; 9] =
    ["hips", "spine", "chest", "head", "upperleg.l", "upperleg.r", "lowerleg.l", "lowerleg.r", "upperarm.l"];

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(format!("{name}.meproj"))
}

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

fn numbers(value: &Value) -> Vec<f32> {
    let numbers = value.as_array().expect("a list").iter();
    numbers.map(|number| number.as_f64().expect("a number") as f32).collect()
}

#[test]
fn every_example_is_without_errors_and_its_roles_are_posed() {
    for (name, role) in EXAMPLES {
        run(["check", text(&example(name))]).expect(0);
        let poses =
            run(["pose", text(&example(name)), "--role", role, "--time", "0.5", "--json"]).expect(0).json();
        assert!(poses["poses"][0]["bones"].as_array().is_some_and(|bones| bones.len() > 20), "{name}");
    }
}

#[test]
fn every_text_of_the_examples_is_what_the_schemas_allow() {
    let folder = Folder::new("scene-schemas");
    for (kind, names) in [
        ("project", &["duel.meproj", "walk.meproj", "crowd.meproj"][..]),
        ("script", &["duel.xml", "walk.xml", "crowd.xml"][..]),
        ("lines", &["walk.lines.xml"][..]),
    ] {
        let schema = folder.join("schema.rng");
        std::fs::write(&schema, run(["script", "--schema", kind]).expect(0).text()).expect("a file");
        for name in names {
            let path = example("duel").with_file_name(name);
            match std::process::Command::new("xmllint")
                .args(["--noout", "--relaxng"])
                .args([&schema, &path])
                .output()
            {
                Ok(done) => assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr)),
                Err(_) => skip(TestNeed::Evaluators, "there is no xmllint"),
            }
        }
    }
}

#[test]
fn the_duel_has_a_rail_a_mark_rain_and_a_knife_that_falls_to_the_ground() {
    let scene = load_scene(&example("duel"), None, &Cancel::default()).expect("an example");
    assert_eq!(scene.warnings, [""; 0]);
    let (plan, script) = (&scene.plan, &scene.script);
    let thing = |id: &str| plan.thing_called(id).expect(id);
    let times = |id: &str| plan.schedule().times()[script.action_called(id).expect(id)];
    let mut shown = plan.new_scene();
    let mut at = |seconds: f64, id: &str| {
        plan.scene_at(StageTime::from_seconds(seconds), &mut shown);
        let state = &shown.things[thing(id)];
        (state.transform.translation, state.effect.map_or(0.0, |effect| effect.weight))
    };
    // Ben goes to the mark.
    assert!(at(0.0, "ben").0.distance(Vec3::new(1.5, 0.0, 0.0)) < 1e-3);
    assert!(at(4.0, "ben").0.distance(Vec3::new(0.6, 0.0, 0.0)) < 1e-3);
    // The camera is at the start and at the end of its rail.
    let offer = times("offer").begin.seconds();
    assert!(at(offer - 0.3, "close").0.distance(Vec3::new(0.5, 1.4, 3.4)) < 1e-3);
    assert!(at(offer + 2.0, "close").0.distance(Vec3::new(0.1, 1.4, 3.1)) < 1e-3);
    let cheer = times("cheer").begin.seconds();
    assert!(at(cheer - 0.1, "knife").0.y > 0.3, "in his hand");
    assert!(at(cheer + 0.5, "knife").0.y.abs() < 0.2, "on the ground");
    assert_eq!((at(1.0, "rain").1, at(cheer + 1.0, "rain").1), (0.0, 1.0));
    assert_eq!(plan.sounds().len(), 1);
}

#[cfg(unix)]
#[test]
fn the_crowd_is_what_its_script_writes() {
    let made = std::process::Command::new("sh")
        .arg(example("crowd").with_extension("sh"))
        .output()
        .expect("a shell");
    let kept = std::fs::read(example("crowd").with_extension("xml")).expect("an example");
    assert_eq!(String::from_utf8(made.stdout), String::from_utf8(kept));
}

/// Returns where a point is in an image of 320 × 180 pixels of a camera 36 mm wide that looks from `eye` at `target`.
fn pixel(eye: Vec3, target: Vec3, lens: f32, point: Vec3) -> Option<[u32; 2]> {
    let ahead = (target - eye).normalize();
    let right = ahead.cross(Vec3::Y).normalize();
    let (up, seen) = (right.cross(ahead), point - eye);
    let at = Vec2::new(seen.dot(right), -seen.dot(up)) / seen.dot(ahead) * lens / 36.0 * 320.0;
    let at = at + Vec2::new(160.0, 90.0);
    let inside = seen.dot(ahead) > 0.0 && at.cmpge(Vec2::ZERO).all() && at.x < 320.0 && at.y < 180.0;
    inside.then_some([at.x as u32, at.y as u32])
}

#[test]
fn bones_that_are_printed_lie_on_the_pixels_that_are_rendered() {
    let folder = Folder::new("scene-pixels");
    let image = folder.join("image.png");
    let cameras = [
        ("duel", "wide", Vec3::new(-0.6, 1.5, 6.2), Vec3::new(-0.6, 0.9, 0.0), 40.0),
        ("walk", "side", Vec3::new(0.0, 1.9, 7.0), Vec3::new(0.0, 0.6, 0.0), 35.0),
        ("crowd", "high", Vec3::new(0.0, 4.2, 10.5), Vec3::new(0.0, 0.6, 0.0), 35.0),
    ];
    for (name, camera, eye, target, lens) in cameras {
        let role = EXAMPLES.iter().find(|example| example.0 == name).expect("an example").1;
        for time in ["0", "1.5", "3"] {
            let script = example(name);
            let order = [
                "render",
                text(&script),
                "--time",
                time,
                "--camera",
                camera,
                "--size",
                "320x180",
                "--background",
                "00000000",
                "-o",
                text(&image),
            ];
            run(order).expect(0);
            let picture = image::open(&image).expect("an image").into_rgba8();
            let poses =
                run(["pose", text(&script), "--role", role, "--time", time, "--json"]).expect(0).json();
            let bones = poses["poses"][0]["bones"].as_array().expect("bones");
            let mut inside = 0;
            for bone in bones.iter().filter(|bone| INSIDE.contains(&bone["name"].as_str().expect("a name"))) {
                let matrix = Mat4::from_cols_slice(&numbers(&bone["to_scene"]));
                if let Some([x, y]) = pixel(eye, target, lens, matrix.w_axis.truncate()) {
                    assert!(
                        picture.get_pixel(x, y)[3] > 128,
                        "{name} at {time}: {} is not drawn at {x} {y}",
                        bone["name"]
                    );
                    inside += 1;
                }
            }
            assert!(inside >= 7, "{name} at {time}: {inside} bones in the image");
        }
    }
}

#[test]
fn frames_are_images_at_their_exact_times_in_the_size_of_the_script() {
    let folder = Folder::new("scene-frames");
    let (frames, single) = (folder.join("walk.png"), folder.join("single.png"));
    run(["render", text(&example("walk")), "--frames", "11..13", "-o", text(&frames)]).expect(0);
    run(["render", text(&example("walk")), "--time", "0.5", "-o", text(&single)]).expect(0);
    let open = |path: PathBuf| image::open(path).expect("an image").into_rgba8();
    let single = open(single);
    assert_eq!(single.dimensions(), (960, 540));
    assert!(open(folder.join("walk-0012.png")) == single, "frame 12 of 24 a second is at half a second");
    assert!(open(folder.join("walk-0011.png")) != single && open(folder.join("walk-0013.png")) != single);
    assert!(!folder.join("walk-0014.png").exists() && !frames.exists());
}

#[test]
fn wrong_orders_for_images_of_scenes_are_refused_with_what_there_is() {
    let folder = Folder::new("scene-refused");
    let (script, image) = (example("duel"), folder.join("x.png"));
    let image = text(&image);
    let refused = |order: &[&str], expected: &str| {
        let all = ["render", text(&script)].into_iter().chain(order.iter().copied());
        let outcome = run(all).expect(2);
        assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
    };
    refused(
        &["--camera", "side", "-o", image],
        "no camera is called \"side\"; there is shot, free, wide, close, over",
    );
    refused(&["--frames", "3..1", "-o", image], "ends before it begins");
    refused(&["--frames", "all", "-o", image], "write for example 0..47");
    refused(&["--frames", "0..1", "-o", "-"], "cannot be written to standard output");
    refused(&["--frames", "0..1", "--time", "1", "-o", image], "cannot be used with");
    let model = script.with_file_name("models").join("knife.gltf");
    let outcome = run(["render", text(&model), "--camera", "wide", "-o", image]).expect(2);
    assert!(outcome.stderr.contains("has to be a scene"), "{}", outcome.stderr);
}

#[test]
fn feet_of_the_walk_slide_less_than_five_millimeters_while_they_are_on_the_ground() {
    let scene = load_scene(&example("walk"), None, &Cancel::default()).expect("an example");
    let plan = &scene.plan;
    let anna = plan.thing_called("anna").expect("a role");
    let model = plan.things()[anna].model.as_ref().expect("a model");
    let take = &model.takes()[model.take_called("Walking_A").expect("a take")];
    let action = scene.script.action_called("walk").expect("an action");
    let times = plan.schedule().times()[action];
    let [begin, end] = [times.begin, times.end].map(StageTime::seconds);
    let mut shown = plan.new_scene();
    let foot_at = |seconds: f64, bone: u32, shown: &mut StageScene| {
        plan.scene_at(StageTime::from_seconds(seconds), shown);
        let state = &shown.things[anna];
        let to_root = state.pose.as_ref().expect("a pose").to_root.get(bone as usize);
        state.transform.to_matrix().transform_point3(Vec3::new(to_root[3], to_root[7], to_root[11]))
    };
    let (mut farthest, mut contacts) = (0.0_f32, 0);
    for contact in take.contacts() {
        let bone = model.feet()[contact.foot].bone;
        let length = (contact.to - contact.from).seconds();
        let mut start = begin + contact.from.seconds();
        while start + length <= end {
            let first = foot_at(start + 1e-6, bone, &mut shown);
            for step in 0..=20 {
                let now = foot_at(start + 1e-6 + (length - 2e-6) * f64::from(step) / 20.0, bone, &mut shown);
                farthest = farthest.max(now.distance(first));
            }
            contacts += 1;
            start += take.length().seconds();
        }
    }
    println!("{contacts} contacts in {:.2} s, slide {:.2} mm", end - begin, farthest * 1000.0);
    assert!(contacts >= 6 && farthest < 0.005, "{contacts} contacts, {:.1} mm", farthest * 1000.0);
}
