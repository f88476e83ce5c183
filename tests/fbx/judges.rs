//! A second judge: single frames that Maya, 3ds Max and MotionBuilder exported themselves.

use crate::support::{InFileSpace, read_here};
use dragonfly_kit::skip::models;
use glam::DVec3;

#[test]
fn skinned_vertices_lie_where_the_authoring_programs_put_them() {
    let Some(folder) = models() else { return };
    let folder = folder.join("fbx/groundtruth");
    let index = std::fs::read_to_string(folder.join("INDEX.tsv")).expect("the index");
    let mut failed = Vec::new();
    let mut frames = 0;
    for row in index.lines().skip(1) {
        let columns: Vec<&str> = row.split('\t').collect();
        let number = |column: usize| columns[column].parse::<f64>().expect("a number");
        let text = std::fs::read_to_string(folder.join(columns[0])).expect("an OBJ file");
        let points: Vec<DVec3> = text
            .lines()
            .filter_map(|line| line.strip_prefix("v "))
            .map(|line| {
                let numbers: Vec<f64> =
                    line.split_whitespace().map(|word| word.parse().expect("a number")).collect();
                DVec3::from_slice(&numbers) * number(5)
            })
            .collect();
        let bytes = std::fs::read(folder.join("..").join(columns[1])).expect("an FBX file");
        let mut scene = InFileSpace::new(read_here(&bytes).expect("a good file"));
        let takes = &scene.evaluator.model().animation.takes;
        let take = takes.iter().position(|take| take.name == columns[2]).expect("the take");
        scene.evaluator.pose(Some(take), number(3) as f32);
        let meshes = scene.evaluator.model().meshes.len() as u32;
        let ours: Vec<DVec3> = (0..meshes).flat_map(|mesh| scene.positions(mesh)).collect();
        assert!(!ours.is_empty());
        // Each point of the other program has one of ours.
        let nearest = |point: &DVec3| ours.iter().map(|own| own.distance(*point)).fold(f64::MAX, f64::min);
        let worst = points.iter().map(nearest).fold(0.0, f64::max);
        let allowed = (2.0 * number(6)).max(1e-5 * number(7));
        println!(
            "{}: {} points, {worst:.1e} of {:.3} units, allowed {allowed:.1e}",
            columns[0],
            points.len(),
            number(7)
        );
        frames += 1;
        if worst > allowed {
            failed.push(format!("{}: {worst:e}, allowed {allowed:e}", columns[0]));
        }
    }
    assert!(frames >= 8, "only {frames} frames");
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
