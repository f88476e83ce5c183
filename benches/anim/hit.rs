//! What a hit test and bounds cost: the tree beside every triangle, boxes of bones beside every vertex.

use dragonfly_anim::bounds::BoneBoxes;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{AssetError, AssetFs, ReadOptions, read};
use dragonfly_anim::hit::{HitPose, HitSettings, HitTree, Ray, ray_open, sphere_open};
use dragonfly_kit::random::Random;
use glam::Vec3;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Models: the small one of the repository, and larger ones beside it where they are there.
const MODELS: &[(&str, &str)] = &[
    ("fox", "../tests/data/gltf/Fox.glb"),
    ("pab", "../../shared/assets/bench/pab.glb"),
    ("robot", "../../shared/assets/gltf/robot.glb"),
    ("cesium_man", "../../shared/assets/gltf/CesiumMan/CesiumMan.gltf"),
];

/// Rays that take turns.
const RAYS: usize = 256;

/// Runs all cases whose name holds the first argument.
pub(crate) fn run() {
    let wanted = std::env::args().skip(1).find(|argument| !argument.starts_with('-')).unwrap_or_default();
    for (name, path) in MODELS {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        if format!("anim/hit/{name}").contains(&wanted) || wanted.contains(&format!("anim/hit/{name}")) {
            match load(&path) {
                Some(model) => compare(name, &Arc::new(model)),
                None => println!("anim/hit/{name}: skipped, {} is not there", path.display()),
            }
        }
    }
}

fn compare(name: &str, model: &Arc<ModelData>) {
    let begin = Instant::now();
    let tree = Arc::new(HitTree::of(model).expect("a small model"));
    let built = begin.elapsed();
    let boxes = BoneBoxes::of(model);
    let mut evaluator = Evaluator::new(Arc::clone(model));
    let take = (!model.animation.takes.is_empty()).then_some(0);
    evaluator.pose(take, 0.4);
    let mut pose = HitPose::new(Arc::clone(&tree));
    pose.refit(&evaluator);
    let positions = evaluator.all_positions();
    let (rays, hits) = rays(&evaluator, &positions);
    let parts = tree.parts();
    println!(
        "anim/hit/{name}: {} vertices, {} triangles, {} leaves, built in {built:?}; {hits} of {RAYS} rays hit",
        positions.len(),
        parts.triangles.len(),
        parts.leaves.len()
    );
    let settings = HitSettings::default();
    let radius = evaluator.bounds().sphere.radius * 0.1;
    let mut turn = 0;
    let mut next = move || {
        turn += 1;
        rays[turn % RAYS]
    };
    let mut room = vec![Vec3::ZERO; positions.len()];
    let line = |case: &str, open: f64, tree: f64| {
        let case = format!("anim/hit/{name}/{case}");
        println!("{case:<36} open {open:>12.1} ns   tree {tree:>10.1} ns   {:>7.1} times", open / tree);
    };
    let open = least(|| ray_open(&evaluator, &positions, &next(), &settings));
    line("ray", open, least(|| pose.ray(&evaluator, &next(), &settings)));
    line("any", open, least(|| pose.any(&evaluator, &next(), &settings)));
    let open = least(|| sphere_open(&evaluator, &positions, next().origin, f32::INFINITY));
    line("nearest", open, least(|| pose.sphere(&evaluator, next().origin, f32::INFINITY)));
    let mut turn = 0;
    let mut near = || {
        turn = (turn + 1) % RAYS;
        positions[turn * 37 % positions.len()] + Vec3::splat(radius * 0.3)
    };
    let open = least(|| sphere_open(&evaluator, &positions, near(), radius));
    line("sphere", open, least(|| pose.sphere(&evaluator, near(), radius)));
    let open = least(|| skin(&evaluator, &mut room));
    line("new_pose", open, least(|| pose.refit(&evaluator)));
    let open = least(|| {
        skin(&evaluator, &mut room);
        ray_open(&evaluator, &room, &next(), &settings)
    });
    let tree = least(|| {
        pose.refit(&evaluator);
        pose.ray(&evaluator, &next(), &settings)
    });
    line("new_pose_and_ray", open, tree);
    let exact = least(|| evaluator.bounds());
    line("bounds", exact, least(|| boxes.bounds(&evaluator)));
}

/// All positions, without asking for memory.
fn skin(evaluator: &Evaluator, out: &mut [Vec3]) {
    let mut rest = out;
    for instance in 0..evaluator.model().instances.len() {
        for primitive in 0..evaluator.primitives(instance).len() {
            let written = evaluator.positions(instance, primitive, rest);
            rest = &mut rest[written..];
        }
    }
}

/// Rays from around the model to places in it, and how many hit.
fn rays(evaluator: &Evaluator, positions: &[Vec3]) -> (Vec<Ray>, usize) {
    let sphere = evaluator.bounds().sphere;
    let mut random = Random::new(7);
    let mut vector = || Vec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0)));
    let rays: Vec<Ray> = (0..RAYS)
        .map(|_| {
            let origin = sphere.center + vector().normalize_or(Vec3::X) * sphere.radius * 2.0;
            Ray { origin, direction: sphere.center + vector() * sphere.radius * 0.4 - origin }
        })
        .collect();
    let settings = HitSettings::default();
    let hits = rays.iter().filter(|ray| ray_open(evaluator, positions, ray, &settings).is_some()).count();
    (rays, hits)
}

/// Calls that are timed together: few, so that some go through undisturbed on a busy machine.
const TOGETHER: usize = 16;

/// Nanoseconds a call, over calls that take turns with the rays: of each few the least of many rounds, then the mean.
fn least<T>(mut work: impl FnMut() -> T) -> f64 {
    let mut least = [f64::INFINITY; RAYS / TOGETHER];
    for _ in 0..40 {
        for least in &mut least {
            let begin = Instant::now();
            for _ in 0..TOGETHER {
                black_box(work());
            }
            *least = least.min(begin.elapsed().as_secs_f64() * 1e9 / TOGETHER as f64);
        }
    }
    least.iter().sum::<f64>() / least.len() as f64
}

fn load(path: &Path) -> Option<ModelData> {
    let bytes = std::fs::read(path).ok()?;
    let door = Folder(path.parent()?.to_owned());
    let name = path.file_name()?.to_str()?;
    Some(read(name, &bytes, &door, &ReadOptions::default()).ok()?.model)
}

/// The folder of a model.
struct Folder(PathBuf);

impl AssetFs for Folder {
    fn read(&self, path: &str, _: u64) -> Result<Vec<u8>, AssetError> {
        std::fs::read(self.0.join(path)).map_err(|_| AssetError::Missing)
    }
}
