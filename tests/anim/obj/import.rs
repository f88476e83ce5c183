//! Reading polygons, indices, groups, normals, colors.

use super::{import, model};
use crate::doors::{TestFolder, data};
use crate::soundness::faults;
use dragonfly_anim::format::{
    Conventions, Formats, Handedness, NoFiles, ReadOptions, UpAxis, obj::OBJ, read,
};
use glam::{Vec2, Vec3, Vec4};

const SQUARE: &str = "v 0 0 0\nv 2 0 0\nv 2 0 -2\nv 0 0 -2\n";

#[test]
fn every_stored_file_is_read_into_a_sound_model_with_surfaces() {
    for entry in std::fs::read_dir(data().join("obj")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if !name.ends_with(".obj") {
            continue;
        }
        let door = TestFolder(data().join("obj"));
        let imported = read(name, &std::fs::read(&path).unwrap(), &door, &ReadOptions::default()).unwrap();
        println!("{name}: {:?}", imported.warnings);
        assert_eq!(faults(&imported.model), [""; 0], "{name}");
        assert!(!imported.model.instances.is_empty() && imported.model.animation.skeleton.is_empty());
    }
}

#[test]
fn a_concave_polygon_with_holes_is_covered_exactly() {
    let text = std::fs::read_to_string(data().join("obj/concave_polygon.obj")).unwrap();
    let door = TestFolder(data().join("obj"));
    let imported = OBJ.import(text.as_bytes(), &door, &ReadOptions::default()).unwrap();
    assert_eq!(imported.warnings, []);
    let primitive = &imported.model.meshes[0].primitives[0];
    let positions = &primitive.vertices.positions;
    let area = |corners: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|corner| positions[corners[corner] as usize].as_dvec3());
        (b - a).cross(c - a)
    };
    let areas: Vec<_> = primitive.indices.chunks_exact(3).map(area).collect();
    let sum: glam::DVec3 = areas.iter().copied().sum();
    let total: f64 = areas.iter().map(|area| area.length()).sum();
    // If triangles overlapped or turned over, the sum of the areas would be larger than the area of the sum.
    assert!((total / sum.length() - 1.0).abs() < 1e-9, "{total} {sum}");
    assert!(sum.x > 0.0, "the sense of the polygon is kept");
}

#[test]
fn corners_share_vertices_only_if_position_texture_and_normal_agree() {
    let text = format!(
        "{SQUARE}vt 0 0\nvt 1 0\nvt 1 0.25\nvn 0 1 0\nvn 0 0 3\n\
         f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/2/1\nf 1/2/1 3/3/2 4/2/1\n"
    );
    let model = model(&text);
    let vertices = &model.meshes[0].primitives[0].vertices;
    assert_eq!(model.meshes[0].primitives[0].indices, [0, 1, 2, 0, 2, 3, 4, 5, 3]);
    assert_eq!(vertices.texture_coordinates[0][2], Vec2::new(1.0, 0.75), "v is measured from the top");
    assert_eq!(vertices.normals[5], Vec3::Z, "normalized");
}

#[test]
fn negative_indices_count_from_the_end_of_what_was_read_so_far() {
    let text = format!("{SQUARE}f -4 -3 -2\nv 9 9 9\nf -5 -3 -2\n");
    let model = model(&text);
    let positions = &model.meshes[0].primitives[0].vertices.positions;
    assert_eq!(positions.len(), 6, "flat polygons share nothing");
    assert_eq!(positions[3..], [Vec3::ZERO, Vec3::new(2.0, 0.0, -2.0), Vec3::new(0.0, 0.0, -2.0)]);
}

#[test]
fn normals_are_smooth_within_a_smoothing_group_and_flat_without_one() {
    let roof = "v 0 0 0\nv 1 1 0\nv 2 0 0\nv 0 0 -1\nv 1 1 -1\nv 2 0 -1\n";
    let faces = "f 1 2 5 4\nf 2 3 6 5\n";
    let normals = |head: &str, faces: &str| {
        let model = model(&format!("{roof}{head}{faces}"));
        let vertices = model.meshes[0].primitives[0].vertices.clone();
        (vertices.len(), vertices.normals[1])
    };
    let diagonal = Vec3::new(-1.0, 1.0, 0.0).normalize();
    for head in ["", "s off\n", "s 0\n"] {
        let (count, normal) = normals(head, faces);
        assert_eq!(count, 8, "{head}");
        assert!(normal.distance(-diagonal) < 1e-6 || normal.distance(diagonal) < 1e-6, "{head} {normal}");
    }
    let (count, normal) = normals("s 1\n", faces);
    assert_eq!(count, 6);
    assert!(normal.distance(Vec3::Y) < 1e-6 || normal.distance(-Vec3::Y) < 1e-6, "{normal}");
    let (count, _) = normals("s 1\n", "f 1 2 5 4\ns 2\nf 2 3 6 5\n");
    assert_eq!(count, 8, "two groups");
}

#[test]
fn objects_groups_and_materials_divide_a_file_into_meshes_and_primitives() {
    let text = format!(
        "{SQUARE}o chair\ng seat\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\ng back\nf 1 2 4\ng seat\nusemtl red\nf 2 3 4\n\
         o table\nf 1 2 3\ng default\nf 3 2 1\n"
    );
    let imported = import(&text).unwrap();
    let listed: Vec<_> = imported
        .model
        .meshes
        .iter()
        .map(|mesh| {
            let primitives = mesh.primitives.iter().map(|one| (one.material, one.indices.len() / 3));
            (mesh.name.as_str(), primitives.collect::<Vec<_>>())
        })
        .collect();
    assert_eq!(
        listed,
        [
            ("chair seat", vec![(Some(0), 2), (Some(1), 1)]),
            ("chair back", vec![(Some(1), 1)]),
            ("table seat", vec![(Some(0), 1)]),
            ("table", vec![(Some(0), 1)]),
        ]
    );
    let names: Vec<_> = imported.model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["red", "blue"]);
    assert_eq!(
        imported.warnings[0].to_string(),
        "line 7 column 1: no file has the material \"red\"; it is gray"
    );
}

#[test]
fn colors_after_positions_are_read_and_converted_to_linear_values() {
    let model = model("v 0 0 0\nv 1 0 0 1 0.5 0\nv 0 1 0 0 0 1\nv 0 1 1 0.5\nf 1 2 3\nf 2 3 4\n");
    let vertices = &model.meshes[0].primitives[0].vertices;
    assert_eq!(vertices.colors[0], Vec4::ONE);
    assert!((vertices.colors[1] - Vec4::new(1.0, 0.214_041, 0.0, 1.0)).length() < 1e-5);
    assert_eq!(vertices.colors[5], Vec4::ONE, "a weight is no color");
}

#[test]
fn lines_continue_after_a_backslash_and_comments_end_them() {
    let text = "v 0 0 0 # a comment\r\nv 1 0 \\\r\n 0\r\nv 0 1 0\r\nf 1 \\\n2 3";
    assert_eq!(model(text).meshes[0].primitives[0].indices, [0, 1, 2]);
    let utf_16: Vec<u8> =
        [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    assert!(import(&utf_16).unwrap().model == model(text));
    assert!((OBJ.sniff)(&utf_16));
}

#[test]
fn points_lines_and_unknown_statements_are_left_out_with_one_warning_each() {
    let text = format!("{SQUARE}l 1 2\np 1\nl 2 3\ncurv 0 1 1 2\nf 1 2 3\nf 1 2\n");
    let warnings: Vec<String> = import(&text).unwrap().warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        warnings,
        [
            "line 5 column 1: the statement \"l\" is not shown",
            "line 6 column 1: the statement \"p\" is not shown",
            "line 8 column 1: the statement \"curv\" is not shown",
            "line 10 column 1: a polygon with 2 corners is left out",
        ]
    );
}

#[test]
fn polygons_without_area_and_references_to_nothing_are_handled() {
    let warning = |more: &str| import(format!("{SQUARE}f 1 2 3\n{more}")).unwrap().warnings[0].to_string();
    assert_eq!(
        warning("f 1 2 1 2\nf 3 3 3\n"),
        "line 6 column 1: 2 polygons, this one the first, have no area; they are left out"
    );
    assert_eq!(warning("f 1/7 2/7 3\n"), "line 6 column 1: there is no texture coordinate 7; it is left out");
    let error = |more: &str| import(format!("{SQUARE}{more}")).unwrap_err().to_string();
    assert_eq!(error("f 1 2 5\n"), "line 5 column 1: there is no vertex 5, the file has 4");
    assert_eq!(error("f 1 2 0\n"), "line 5 column 7: \"0\" refers to nothing in the file");
    assert_eq!(error("f 1 2 -5\n"), "line 5 column 7: \"-5\" refers to nothing in the file");
    assert_eq!(
        error("f 1 2 99999999999999999999\n"),
        "line 5 column 7: \"99999999999999999999\" refers to nothing in the file"
    );
    assert_eq!(
        error("f 1 2 3/1/1/1\n"),
        "line 5 column 7: \"3/1/1/1\" where a corner such as 1/2/3 was expected"
    );
    assert_eq!(error("v 1 2\n"), "line 5 column 1: 2 values for a position, at least 3 are needed");
    assert_eq!(error("v 1 2 1,5\n"), "line 5 column 7: \"1,5\" is no number where a position was expected");
    assert_eq!(error("v 1 2 nan\n"), "line 5 column 7: \"nan\" is not finite where a position was expected");
    assert_eq!(
        import("hello\nworld\n").unwrap_err().to_string(),
        "line 1 column 1: the text has no statement of an OBJ file"
    );
}

#[test]
fn units_and_axes_that_the_user_chooses_are_converted_and_triangles_keep_their_front() {
    let conventions = Conventions {
        meters_per_unit: Some(0.01),
        up: Some(UpAxis::Z),
        handedness: Some(Handedness::Left),
        frame_rate: None,
    };
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    let text = "v 0 0 0\nv 100 0 0\nv 0 100 0\ns 1\nf 1 2 3\n";
    let chosen = OBJ.import(text.as_bytes(), &NoFiles, &options).unwrap().model;
    let primitive = &chosen.meshes[0].primitives[0];
    let [a, b, c] = [0, 1, 2].map(|corner| primitive.vertices.positions[primitive.indices[corner] as usize]);
    assert_eq!(
        chosen.meshes[0].primitives[0].vertices.positions.iter().map(|p| p.length()).fold(0.0, f32::max),
        1.0
    );
    let front = (b - a).cross(c - a).normalize();
    assert!(primitive.vertices.normals.iter().all(|normal| normal.distance(front) < 1e-6));
}

#[test]
fn a_text_is_recognized_only_by_lines_that_all_fit() {
    let name = |bytes: &[u8]| Formats::builtin().detect("file", bytes).map(|format| format.name);
    assert_eq!(name(b"# x\n\nmtllib a.mtl\no a\nv 1 2 3\nf 1 2 3"), Some("obj"));
    for text in
        ["v 1 2", "v is a letter", "f 1 2 3", "v 1 2 3\nhello", "", "# only a comment", "varnish 1 2 3"]
    {
        assert_eq!(name(text.as_bytes()), None, "{text}");
    }
}
