use dragonfly_anim::compressed::{compress, CompressionSettings};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::*;
use dragonfly_anim::format::{read, NoFiles, ReadOptions};
use std::hint::black_box;
use std::time::Instant;
fn main() {
    let bytes = std::fs::read("/work/shared/assets/bench/pab.glb").unwrap();
    let model = read("pab.glb", &bytes, &NoFiles, &ReadOptions::default()).unwrap().model;
    let a = &model.animation;
    let rig = Rig::new(&a.skeleton);
    let binding = SkinBinding::new(&rig, &model.skins[0]);
    let take = compress(&a.takes[0], &a.skeleton, &CompressionSettings::default()).unwrap().0;
    let mut scratch = Scratch::new(&rig);
    let mut roots = RootPoses::new(&rig);
    let mut pose = rig.rest().clone();
    let mut out = vec![matrix::IDENTITY; binding.joints()];
    let args: Vec<String> = std::env::args().collect();
    let which = args[1].as_str();
    let level = SimdLevel::all().into_iter().find(|l| l.name() == args[2]).unwrap();
    let rounds: usize = args[3].parse().unwrap();
    let mut best = f64::MAX;
    let many = vec![matrix::IDENTITY; binding.joints() * 96];
    let mut many = many;
    for _ in 0..rounds {
        let n = 2000;
        let t = Instant::now();
        let mut units = n;
        match which {
            "one" => for i in 0..n {
                let time = (i % 60) as f32 / 60.0;
                pose_character(level, &rig, &binding, &[Playing::new(&take, time)], &mut scratch, &mut out);
                black_box(&out);
            },
            "sample" => for i in 0..n {
                let time = (i % 60) as f32 / 60.0;
                sample(level, &take, time, pose.blocks_mut());
                black_box(&pose);
            },
            "root" => for _ in 0..n {
                to_root(level, &rig, black_box(&pose).blocks(), &mut roots);
                black_box(&roots);
            },
            "final" => for _ in 0..n {
                final_poses(level, &binding, black_box(&roots), &mut out);
                black_box(&out);
            },
            "crowd" => {
                units = 96 * 20;
                let layers: Vec<[Playing<_>; 1]> = (0..96).map(|i| [Playing::new(&take, (i % 60) as f32 / 60.0)]).collect();
                for _ in 0..20 {
                    pose_crowd(level, &rig, &binding, layers.iter().map(|l| &l[..]), &mut scratch, &mut many);
                    black_box(&many);
                }
            }
            _ => panic!(),
        }
        best = best.min(t.elapsed().as_secs_f64() * 1e9 / units as f64);
    }
    println!("{which} {} {best:.1} ns", level.name());
}
