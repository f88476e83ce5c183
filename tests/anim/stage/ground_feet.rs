//! Feet on ground that is a mesh: they do not slide, and are on it.

use super::actors::{bone, fox, planned, rogue, seconds, thing};
use super::ground::{sheet, solid};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::stage::{StageAssets, StageModel, StagePlan, StageScene};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Slope of the ground: the tangent of 15 degrees.
const SLOPE: f32 = 0.267_949_2;

/// The feet of a role on its way, measured; meters.
#[derive(Debug, Default)]
struct GroundFeet {
    /// Largest distance of a foot in contact from where it was at the start of the contact.
    slide: f32,
    /// Largest distance of a point of the sole of a foot in contact from the ground, along its normal, compared with a way on a plane.
    off: f32,
    /// Largest jump of a foot between frames at 240 frames per second.
    jump: f32,
    contacts: usize,
}

struct GroundWalk<'a> {
    model: &'a Arc<StageModel>,
    scale: f64,
    take: &'a str,
    points: &'a str,
}

impl GroundWalk<'_> {
    fn plan(&self, ground: ModelData, attributes: &str) -> StagePlan {
        let mut assets = StageAssets::default();
        assets.add_model("a.glb", Arc::clone(self.model));
        assets.add_model("g.glb", Arc::new(StageModel::new(Arc::new(ground))));
        let Self { scale, take, points, .. } = self;
        planned(
            &format!(
                "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"{scale}\"/>\
                 <prop id=\"hill\" model=\"g.glb\" ground=\"yes\"/><path id=\"way\" points=\"{points}\"/></cast>\
                 <move who=\"anna\" path=\"way\" take=\"{take}\" {attributes}/></script>"
            ),
            &assets,
        )
    }

    /// Returns the points of the sole of each foot in contact: below the joint of the foot, and below the joint under it, such as that of the toes, by the
    /// heights that these have on a plane.
    fn measure(&self, slope: Vec2) -> GroundFeet {
        let plan = self.plan(sheet(1, 60.0, |x, z| slope.x * x + slope.y * z), "ground=\"mesh\"");
        let flat = self.plan(sheet(1, 60.0, |_, _| 0.0), "ground=\"mesh\"");
        let walk = &self.model.takes()[self.model.take_called(self.take).unwrap()];
        let normal = Vec3::new(-slope.x, 1.0, -slope.y).normalize();
        let (cycle, end) = (walk.length().seconds(), plan.length().seconds());
        let mut found = GroundFeet::default();
        let (mut scene, mut on_plane) = (plan.new_scene(), flat.new_scene());
        let bones = &self.model.skeleton().bones;
        for contact in walk.contacts() {
            let foot = self.model.feet()[contact.foot].bone;
            let toe = bones.iter().position(|bone| bone.parent == Some(foot)).map_or(foot, |toe| toe as u32);
            let (mut start, length) = (contact.from.seconds(), (contact.to - contact.from).seconds());
            while start + length <= end {
                plan.scene_at(seconds(start + 1e-6), &mut scene);
                let first = bone(&plan, &scene, "anna", foot);
                for step in 0..=20 {
                    let time = seconds(start + 1e-6 + (length - 2e-6) * f64::from(step) / 20.0);
                    plan.scene_at(time, &mut scene);
                    flat.scene_at(time, &mut on_plane);
                    found.slide = found.slide.max(bone(&plan, &scene, "anna", foot).distance(first));
                    for joint in [foot, toe] {
                        let above = bone(&plan, &scene, "anna", joint).dot(normal);
                        let expected = bone(&flat, &on_plane, "anna", joint).y;
                        found.off = found.off.max((above - expected).abs());
                    }
                }
                found.contacts += 1;
                start += cycle;
            }
        }
        let places = |scene: &StageScene| -> Vec<Vec3> {
            self.model.feet().iter().map(|foot| bone(&plan, scene, "anna", foot.bone)).collect()
        };
        plan.scene_at(seconds(0.0), &mut scene);
        let mut before = places(&scene);
        for step in 1..(end * 240.0) as usize {
            plan.scene_at(seconds(step as f64 / 240.0), &mut scene);
            let now = places(&scene);
            let jumps = now.iter().zip(&before).map(|(now, before)| now.distance(*before));
            found.jump = jumps.fold(found.jump, f32::max);
            before = now;
        }
        assert!(thing(&plan, &scene, "anna").transform.is_finite());
        found
    }
}

/// Measures a take up, down and across a slope of 15 degrees, and on a plane.
fn measure(model: &Arc<StageModel>, scale: f64, take: &str, most_off: f32) {
    let walk = GroundWalk { model, scale, take, points: "-3 0 0.2  3 0 0.2" };
    let level = walk.measure(Vec2::ZERO);
    for slope in [Vec2::X * SLOPE, Vec2::X * -SLOPE, Vec2::Y * SLOPE] {
        let found = walk.measure(slope);
        println!(
            "{take} on {slope}: {} contacts, slide {:.2} mm, off {:.1} mm, jump {:.0} mm and {:.0} mm on a plane",
            found.contacts,
            1000.0 * found.slide,
            1000.0 * found.off,
            1000.0 * found.jump,
            1000.0 * level.jump,
        );
        assert!(found.contacts > 4 && found.slide < 0.005, "{take} {slope}: {found:?}");
        assert!(found.off < most_off, "{take} {slope}: {found:?}");
        assert!(found.jump < 1.6 * level.jump + 0.005, "{take} {slope}: {found:?}, {level:?}");
    }
}

#[test]
fn feet_of_a_human_stand_on_a_slope_of_fifteen_degrees_and_do_not_slide() {
    let Some(model) = rogue() else { return };
    for take in ["Walking_A", "Walking_Backwards"] {
        measure(&model, 1.0, take, 0.02);
    }
}

#[test]
fn paws_of_a_fox_stand_on_a_slope_of_fifteen_degrees_and_do_not_slide() {
    measure(&fox(), 0.01, "Walk", 0.02);
}

#[test]
fn footprints_are_on_the_ground() {
    let model = fox();
    let walk = GroundWalk { model: &model, scale: 0.01, take: "Walk", points: "-3 0 0  0 0 1  3 0 0" };
    let plan = walk.plan(sheet(30, 20.0, |x, z| 0.3 * x + 0.1 * z * z), "ground=\"mesh\"");
    let walk = plan.path_walks().next().unwrap();
    let prints = plan.footprints_of(walk);
    assert!(prints.len() >= 8, "{}", prints.len());
    for print in prints {
        let ground = plan.ground_at(print.position).unwrap();
        assert!((print.position.y - ground).abs() < 1e-9, "{print:?} {ground}");
        let expected = 0.3 * print.position.x + 0.1 * print.position.z * print.position.z;
        assert!((ground - expected).abs() < 0.02, "{ground} {expected}");
    }
}

#[test]
fn a_foot_beyond_the_edge_of_a_platform_stays_at_its_height() {
    let model = fox();
    let mut assets = StageAssets::default();
    assets.add_model("a.glb", Arc::clone(&model));
    let platform = solid(Vec3::new(-2.0, 2.0, -9.0), Vec3::new(2.0, 3.0, 9.0));
    for (name, ground) in [("platform.glb", platform), ("floor.glb", sheet(1, 40.0, |_, _| 0.0))] {
        assets.add_model(name, Arc::new(StageModel::new(Arc::new(ground))));
    }
    let floor = "<prop id=\"floor\" model=\"floor.glb\" ground=\"yes\"/>";
    let walk = |floor: &str, x: f32| {
        planned(
            &format!(
                "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"0.01\"/>{floor}\
                 <prop id=\"high\" model=\"platform.glb\" ground=\"yes\"/><path id=\"way\" points=\"{x} 3 -2  {x} 3 2\"/></cast>\
                 <move who=\"anna\" path=\"way\" take=\"Walk\" ground=\"mesh\"/></script>"
            ),
            &assets,
        )
    };
    for floor in ["", floor] {
        let (middle, edge) = (walk(floor, 0.0), walk(floor, 1.99));
        let (mut one, mut other) = (middle.new_scene(), edge.new_scene());
        let mut beyond = 0;
        for step in 0..200 {
            let time = seconds(edge.length().seconds() * f64::from(step) / 200.0);
            middle.scene_at(time, &mut one);
            edge.scene_at(time, &mut other);
            for foot in model.feet() {
                let expected = bone(&middle, &one, "anna", foot.bone) + Vec3::X * 1.99;
                let found = bone(&edge, &other, "anna", foot.bone);
                assert!(found.distance(expected) < 2e-4, "{found} instead of {expected} at {time:?}");
                beyond += usize::from(found.x > 2.0);
            }
        }
        assert!(beyond > 100, "{beyond}");
        let across = walk(floor, -1.99);
        let mut prints = edge.footprints_of(edge.path_walks().next().unwrap());
        prints.extend(across.footprints_of(across.path_walks().next().unwrap()));
        assert!(prints.iter().any(|print| print.position.x.abs() > 2.0), "{prints:?}");
        for print in prints {
            assert!((print.position.y - 3.0).abs() < 1e-9, "{print:?}");
        }
    }
}
