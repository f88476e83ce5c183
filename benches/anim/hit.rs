//! Hit tests and bounds: the tree compared with testing every triangle, boxes of bones with every vertex.

use crate::Section;
use crate::case::BenchCase;
use dragonfly_anim::bounds::BoneBoxes;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{AssetError, AssetFs, ReadOptions, read};
use dragonfly_anim::hit::{HitPose, HitSettings, HitTree, Ray, ray_open, sphere_open};
use dragonfly_kit::random::Random;
use glam::Vec3;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

/// Models: a small and a larger one.
const MODELS: [(&str, &str); 2] =
    [("fox", "../tests/data/gltf/Fox.glb"), ("pab", "../tests/data/bench/pab.glb")];

/// Number of rays, or of spheres, in one call. Many, because their costs differ much.
const RAYS: usize = 64;

/// A model in a pose, with the rays and spheres that are tested against it.
struct HitScene {
    tree: Arc<HitTree>,
    built: String,
    evaluator: Evaluator,
    positions: Vec<Vec3>,
    rays: Vec<Ray>,
    /// Centers of spheres that touch the surface.
    centers: Vec<Vec3>,
    radius: f32,
}

/// Returns a section for each model.
pub(crate) fn sections() -> Vec<Section> {
    MODELS.map(|(name, path)| section(name, Path::new(env!("CARGO_MANIFEST_DIR")).join(path))).into()
}

fn section(name: &'static str, path: PathBuf) -> Section {
    let later: &'static OnceLock<HitScene> = Box::leak(Box::default());
    let scene = move || later.get_or_init(|| HitScene::of(&path).expect("a model that can be read"));
    let scene: &'static dyn Fn() -> &'static HitScene = Box::leak(Box::new(scene));
    Section { about: Box::new(move || format!("hit/{name}: {}", scene().about())), cases: cases(name, scene) }
}

/// Returns the scene, and builds it at the first call.
type LazyScene = &'static dyn Fn() -> &'static HitScene;

fn cases(name: &str, scene: LazyScene) -> Vec<BenchCase> {
    let task = |work: &str| format!("hit/{name}/{work}");
    let both = |work: &str, unit, open: fn(&HitScene), tree: fn(&HitScene, &mut HitPose)| {
        let units = if unit == "pose" { 1 } else { RAYS };
        [
            BenchCase::new("open", task(work), units, unit, move || {
                let scene = scene();
                move || open(scene)
            }),
            BenchCase::new("tree", task(work), units, unit, move || {
                let (scene, mut pose) = (scene(), scene().pose());
                move || tree(scene, &mut pose)
            }),
        ]
    };
    let mut cases = Vec::new();
    cases.extend(both("ray", "ray", HitScene::rays_open, |scene, pose| {
        for ray in &scene.rays {
            black_box(pose.ray(&scene.evaluator, ray, &HitSettings::default()));
        }
    }));
    cases.extend(both("any", "ray", HitScene::rays_open, |scene, pose| {
        for ray in &scene.rays {
            black_box(pose.any(&scene.evaluator, ray, &HitSettings::default()));
        }
    }));
    cases.extend(both(
        "nearest",
        "point",
        |scene| scene.rays.iter().for_each(|ray| scene.sphere_open(ray.origin, f32::INFINITY)),
        |scene, pose| {
            for ray in &scene.rays {
                black_box(pose.sphere(&scene.evaluator, ray.origin, f32::INFINITY));
            }
        },
    ));
    cases.extend(both(
        "sphere",
        "sphere",
        |scene| scene.centers.iter().for_each(|&center| scene.sphere_open(center, scene.radius)),
        |scene, pose| {
            for &center in &scene.centers {
                black_box(pose.sphere(&scene.evaluator, center, scene.radius));
            }
        },
    ));
    cases.extend(new_poses(name, scene));
    cases.into_iter().map(BenchCase::counted_once).collect()
}

/// Returns the cases that start with a new pose.
fn new_poses(name: &str, scene: LazyScene) -> [BenchCase; 6] {
    let task = |work: &str| format!("hit/{name}/{work}");
    [
        BenchCase::new("open", task("new_pose"), 1, "pose", move || {
            let (scene, mut positions) = (scene(), scene().positions.clone());
            move || skin(&scene.evaluator, &mut positions)
        }),
        BenchCase::new("tree", task("new_pose"), 1, "pose", move || {
            let (scene, mut pose) = (scene(), scene().pose());
            move || pose.refit(&scene.evaluator)
        }),
        BenchCase::new("open", task("new_pose_and_ray"), RAYS, "pose", move || {
            let (scene, mut positions) = (scene(), scene().positions.clone());
            move || {
                for ray in &scene.rays {
                    skin(&scene.evaluator, &mut positions);
                    black_box(ray_open(&scene.evaluator, &positions, ray, &HitSettings::default()));
                }
            }
        }),
        BenchCase::new("tree", task("new_pose_and_ray"), RAYS, "pose", move || {
            let (scene, mut pose) = (scene(), scene().pose());
            move || {
                for ray in &scene.rays {
                    pose.refit(&scene.evaluator);
                    black_box(pose.ray(&scene.evaluator, ray, &HitSettings::default()));
                }
            }
        }),
        BenchCase::new("open", task("bounds"), 1, "pose", move || {
            let scene = scene();
            move || {
                black_box(scene.evaluator.bounds());
            }
        }),
        BenchCase::new("boxes", task("bounds"), 1, "pose", move || {
            let scene = scene();
            let boxes = BoneBoxes::of(scene.evaluator.model());
            move || {
                black_box(boxes.bounds(&scene.evaluator));
            }
        }),
    ]
}

impl HitScene {
    fn of(path: &Path) -> Option<Self> {
        let model = Arc::new(load(path)?);
        let begin = Instant::now();
        let tree = Arc::new(HitTree::of(&model).ok()?);
        let built = format!("{:.1?}", begin.elapsed());
        let mut evaluator = Evaluator::new(Arc::clone(&model));
        evaluator.pose((!model.animation.takes.is_empty()).then_some(0), 0.4);
        let positions = evaluator.all_positions();
        let radius = evaluator.bounds().sphere.radius * 0.1;
        let near = |at: usize| positions[at * 37 % positions.len()] + Vec3::splat(radius * 0.3);
        let centers = (0..RAYS).map(near).collect();
        Some(Self { rays: rays(&evaluator), tree, built, evaluator, positions, centers, radius })
    }

    fn about(&self) -> String {
        let (parts, settings) = (self.tree.parts(), HitSettings::default());
        let hits = |ray: &&Ray| ray_open(&self.evaluator, &self.positions, ray, &settings).is_some();
        format!(
            "{} vertices, {} triangles, {} leaves, built in {}; {} of {RAYS} rays hit",
            self.positions.len(),
            parts.triangles.len(),
            parts.leaves.len(),
            self.built,
            self.rays.iter().filter(hits).count(),
        )
    }

    /// Returns the tree, fitted to the pose.
    fn pose(&self) -> HitPose {
        let mut pose = HitPose::new(Arc::clone(&self.tree));
        pose.refit(&self.evaluator);
        pose
    }

    fn rays_open(&self) {
        for ray in &self.rays {
            black_box(ray_open(&self.evaluator, &self.positions, ray, &HitSettings::default()));
        }
    }

    fn sphere_open(&self, center: Vec3, radius: f32) {
        black_box(sphere_open(&self.evaluator, &self.positions, center, radius));
    }
}

/// Writes the skinned positions of all vertices to `out`, without allocating.
fn skin(evaluator: &Evaluator, out: &mut [Vec3]) {
    let mut rest = &mut *out;
    for instance in 0..evaluator.model().instances.len() {
        for primitive in 0..evaluator.primitives(instance).len() {
            let written = evaluator.positions(instance, primitive, rest);
            rest = &mut rest[written..];
        }
    }
    black_box(out);
}

/// Returns rays from points around the model to points in it.
fn rays(evaluator: &Evaluator) -> Vec<Ray> {
    let sphere = evaluator.bounds().sphere;
    let mut random = Random::new(7);
    let mut vector = || Vec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0)));
    let mut ray = || {
        let origin = sphere.center + vector().normalize_or(Vec3::X) * sphere.radius * 2.0;
        Ray { origin, direction: sphere.center + vector() * sphere.radius * 0.4 - origin }
    };
    (0..RAYS).map(|_| ray()).collect()
}

fn load(path: &Path) -> Option<ModelData> {
    let bytes = std::fs::read(path).ok()?;
    let door = ModelFolder(path.parent()?.to_owned());
    let name = path.file_name()?.to_str()?;
    Some(read(name, &bytes, &door, &ReadOptions::default()).ok()?.model)
}

/// The folder of a model.
struct ModelFolder(PathBuf);

impl AssetFs for ModelFolder {
    fn read(&self, path: &str, _: u64) -> Result<Vec<u8>, AssetError> {
        std::fs::read(self.0.join(path)).map_err(|_| AssetError::Missing)
    }
}
