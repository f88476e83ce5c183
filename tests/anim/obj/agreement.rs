//! Numbers of meshes and triangles agree with those that ufbx finds.

use crate::doors::TestFolder;
use dragonfly_anim::format::{ReadOptions, read};
use serde_json::Value;
use std::collections::HashSet;

#[test]
fn meshes_vertices_and_triangles_are_those_that_another_reader_finds() {
    let Some(models) = dragonfly_kit::skip::models() else { return };
    let list = std::fs::read_to_string(models.join("../expected/obj_ufbx.jsonl")).unwrap();
    let mut compared = 0;
    for line in list.lines() {
        let expected: Value = serde_json::from_str(line).unwrap();
        let name = expected["file"].as_str().unwrap();
        let bytes = std::fs::read(models.join("obj").join(name)).unwrap();
        let result = read(name, &bytes, &TestFolder(models.join("obj")), &ReadOptions::default());
        if expected["error"].is_string() {
            println!("{name}: {}", result.as_ref().unwrap_err());
            assert!(result.is_err());
            continue;
        }
        let imported = result.unwrap();
        let (model, warnings) = (imported.model, imported.warnings);
        let primitives = || model.meshes.iter().flat_map(|mesh| &mesh.primitives);
        let triangles: usize = primitives().map(|primitive| primitive.indices.len() / 3).sum();
        let positions: HashSet<[u32; 3]> = primitives()
            .flat_map(|primitive| &primitive.vertices.positions)
            .map(|position| position.to_array().map(f32::to_bits))
            .collect();
        println!(
            "{name}: {} meshes, {} positions, {triangles} triangles",
            model.meshes.len(),
            positions.len()
        );
        if name == "box_UTF16BE.obj" {
            // That reader does not know UTF-16.
            assert_eq!((model.meshes.len(), positions.len(), triangles), (1, 8, 12));
            continue;
        }
        assert_eq!(model.meshes.len() as u64, expected["meshes"].as_u64().unwrap(), "{name}");
        let wanted = expected["tris"].as_u64().unwrap();
        // That reader keeps triangles without area, also those of a polygon that goes around the same four corners many times.
        let dropped = warnings.iter().filter(|warning| warning.code == "POLYGON_DEGENERATE");
        let dropped = dropped.map(|warning| warning.text.split(' ').next().unwrap().parse::<u64>().unwrap());
        let kept = triangles as u64 + dropped.sum::<u64>();
        assert!(kept == wanted || (name == "box_longline.obj" && kept < wanted), "{name}: {kept}");
        // That reader counts all positions of the file for each mesh, and those that are the same place.
        assert!(positions.len() as u64 <= expected["verts"].as_u64().unwrap(), "{name}");
        compared += 1;
    }
    assert!(compared >= 9);
}
