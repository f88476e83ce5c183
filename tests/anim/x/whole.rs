//! A text of any model has its vertices in the same places.

use super::made::import;
use crate::doors::{TestFolder, model_files};
use crate::soundness::faults;
use crate::takes::{distance_of_nearest, used_positions, windings};
use dragonfly_anim::format::x::{X, write};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use std::sync::Arc;

#[test]
fn models_of_every_kind_keep_the_places_of_their_vertices() {
    let mut compared = 0;
    for path in model_files() {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let door = TestFolder(path.parent().unwrap().to_owned());
        let model =
            read(&name, &std::fs::read(&path).unwrap(), &door, &ReadOptions::default()).unwrap().model;
        let parts = || model.meshes.iter().flat_map(|mesh| &mesh.primitives);
        let vertices: usize = parts().map(|part| part.vertices.len()).sum();
        if vertices > 5_000 || parts().any(|part| !part.morph_targets.is_empty()) {
            continue;
        }
        let file = write(&model).unwrap();
        assert!((X.sniff)(&file.bytes));
        let imported = import(&file.bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(faults(&imported.model), [""; 0], "{name}");
        let (right, wrong) = windings(&imported.model);
        let own = windings(&model);
        assert!(wrong <= own.1.min(own.0) + right / 50, "{name}: {wrong} of {right}");
        let moved = file
            .lost
            .iter()
            .any(|lost| lost.code == "KEYS_BETWEEN_TICKS" || lost.code == "INTERPOLATION_NOT_STORED");
        let models = [Arc::new(model.clone()), Arc::new(imported.model)];
        let takes = (0..model.animation.takes.len().min(2)).map(Some).chain([None]);
        for take in takes {
            let range = take.and_then(|take| model.animation.takes[take].range_of_keys()).unwrap_or_default();
            for part in [0.0, 0.37, 1.0] {
                let time = range.0 + (range.1 - range.0) * part;
                let [ours, theirs] = models.each_ref().map(|model| used_positions(model, take, time));
                let worst = distance_of_nearest(&ours, &theirs);
                assert!(worst < if moved { 2e-2 } else { 2e-3 }, "{name}, {take:?} at {time}: {worst}");
                compared += 1;
            }
        }
    }
    println!("{compared} poses compared");
    assert!(compared > 60);
}

#[test]
fn a_text_has_the_templates_of_skins_and_losses_are_listed() {
    let path = crate::doors::data().join("gltf/Fox.glb");
    let fox =
        read("Fox.glb", &std::fs::read(path).unwrap(), &NoFiles, &ReadOptions::default()).unwrap().model;
    let file = write(&fox).unwrap();
    let lost: Vec<String> = file.lost.iter().map(ToString::to_string).collect();
    println!("{lost:#?}");
    let text = String::from_utf8(file.bytes).unwrap();
    assert!(text.starts_with("xof 0303txt 0032\n\ntemplate XSkinMeshHeader {"));
    for word in ["AnimTicksPerSecond {\n 4800;\n}", "AnimationSet Survey {", "SkinWeights {\n\"b_Hip_01\";"] {
        assert!(text.contains(word), "{word}");
    }
    assert!(
        lost.contains(&"/materials/0/texture: an image that is no file of its own is not stored".to_owned())
    );
    assert!(write(&Default::default()).unwrap().lost.is_empty());
}

#[test]
fn no_list_of_weights_is_empty_and_joints_without_vertices_stay_so() {
    let path = crate::doors::data().join("gltf/Fox.glb");
    let fox =
        read("Fox.glb", &std::fs::read(path).unwrap(), &NoFiles, &ReadOptions::default()).unwrap().model;
    let bytes = write(&fox).unwrap().bytes;
    let text = String::from_utf8(bytes.clone()).unwrap();
    let starts = text.split("SkinWeights {\n\"").skip(1).map(|rest| rest.split('\n').nth(1).unwrap());
    let counts: Vec<usize> = starts.map(|count| count.trim_end_matches(';').parse().unwrap()).collect();
    let again = import(&bytes).unwrap().model;
    assert_eq!(counts.len(), again.skins[0].bones.len());
    assert!(counts.iter().all(|&count| count > 0), "{counts:?}");
    let joints = |model: &dragonfly_anim::data::ModelData| {
        let influences = model.meshes[0].primitives[0].vertices.influences.iter();
        let used = influences.filter(|influence| influence.weight > 0.0).map(|influence| influence.joint);
        used.collect::<std::collections::BTreeSet<_>>().len()
    };
    assert_eq!(joints(&again), joints(&fox));
}

#[test]
fn the_time_to_read_a_text_grows_as_its_length_does() {
    let path = crate::doors::data().join("bench/pab.glb");
    let rig =
        read("pab.glb", &std::fs::read(path).unwrap(), &NoFiles, &ReadOptions::default()).unwrap().model;
    let time = |repeated: usize| {
        let mut model = rig.clone();
        model.animation.takes = vec![Arc::clone(&rig.animation.takes[0]); repeated];
        let bytes = write(&model).unwrap().bytes;
        let read_once = || {
            let start = std::time::Instant::now();
            import(&bytes).unwrap();
            start.elapsed().as_secs_f64()
        };
        (0..3).map(|_| read_once()).fold(f64::INFINITY, f64::min)
    };
    let [short, long] = [time(2), time(32)];
    assert!(long < 60.0 * short, "16 times the takes take {} times as long", long / short);
}

#[test]
fn fast_curves_get_as_many_lines_as_they_need() {
    use crate::bvh::rate::{arm, swing};
    use dragonfly_anim::data::Interpolation;
    use dragonfly_anim::evaluator::Evaluator;
    let fast = arm(swing(&[0.0, 0.1, 0.2], &[0.0, 1.5, 0.0], Interpolation::CubicSpline));
    let file = write(&fast).unwrap();
    let again = X.import(&file.bytes, &NoFiles, &ReadOptions::default()).unwrap().model;
    let keys = again.animation.takes[0].tracks[0].rotation.len();
    let [mut ours, mut theirs] = [fast, again].map(|model| Evaluator::new(Arc::new(model)));
    let mut worst = 0.0_f32;
    for step in 0..=1000 {
        let time = 0.2 * step as f32 / 1000.0;
        ours.pose(Some(0), time);
        theirs.pose(Some(0), time);
        let tips = [&ours, &theirs].map(|one| one.to_root()[2].w_axis.truncate());
        worst = worst.max(tips[0].distance(tips[1]));
    }
    // An arm of two meters: at 60 lines per second it is off by 60 mm.
    println!("{keys} keys, {worst} m");
    assert!(keys <= 49 && worst < 5e-3, "{keys} keys, {worst} m");
    // A slow one needs no more than 60 keys per second.
    let slow = arm(swing(&[0.0, 1.0], &[0.0, 0.01], Interpolation::CubicSpline));
    let file = write(&slow).unwrap();
    let again = X.import(&file.bytes, &NoFiles, &ReadOptions::default()).unwrap().model;
    assert_eq!(again.animation.takes[0].tracks[0].rotation.len(), 61);
}
