//! Content that is read, and content that is corrected.

use super::made::{import, pendulum, stored, with_header};
use crate::doors::{MemoryFs, data};
use crate::soundness::faults;
use crate::takes::{files_of, windings};
use dragonfly_anim::data::{AlphaMode, ModelData};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{ConventionSource, Conventions, Found, Handedness, ReadOptions, x::X};
use glam::{Mat4, Vec3};
use std::sync::Arc;

#[test]
fn text_binary_and_both_compressed_encodings_of_a_file_give_the_same_model() {
    let text = import(pendulum().as_bytes()).unwrap();
    assert_eq!(faults(&text.model), [""; 0]);
    for name in ["pendulum_bin.x", "pendulum_tzip.x", "pendulum_bzip.x"] {
        let other = import(&stored(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(other.model == text.model, "{name}");
        assert_eq!(other.conversion, text.conversion, "{name}");
    }
    let [cube, binary, compressed] = ["test_cube_text.x", "test_cube_binary.x", "test_cube_compressed.x"]
        .map(|name| import(&stored(name)).unwrap().model);
    assert!(binary == compressed);
    // The exporter wrote fewer digits into the text.
    let positions = |model: &ModelData| model.meshes[0].primitives[0].vertices.positions.clone();
    for (a, b) in positions(&cube).iter().zip(positions(&binary)) {
        assert!(a.distance(b) < 2e-6);
    }
    assert_eq!(cube.meshes[0].primitives[0].indices, binary.meshes[0].primitives[0].indices);
}

#[test]
fn frames_become_bones_and_meshes_follow_their_frame_or_their_skin() {
    let imported = import(pendulum().as_bytes()).unwrap();
    let model = &imported.model;
    let bones: Vec<(&str, Option<u32>)> =
        model.animation.skeleton.bones.iter().map(|bone| (bone.name.as_str(), bone.parent)).collect();
    assert_eq!(bones, [("World", None), ("Arm", Some(0)), ("Weight", Some(1))]);
    let instances: Vec<(Option<u32>, Option<u32>)> =
        model.instances.iter().map(|instance| (instance.skin, instance.bone)).collect();
    assert_eq!(instances, [(None, Some(2)), (Some(0), None)]);
    assert_eq!(model.skins[0].bones, [1, 2]);
    let names: Vec<&str> = model.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
    assert_eq!(names, ["Knob", "Rod"]);
    let knob = &model.meshes[0].primitives[0];
    // Five positions, a quadrangle of two triangles, smooth normals.
    assert_eq!((knob.vertices.len(), knob.indices.len()), (5, 18));
    assert_eq!(knob.vertices.colors[0].to_array(), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(knob.vertices.colors[1].to_array(), [1.0; 4]);
    let rod = &model.meshes[1];
    // The list of materials is shorter than the faces: the last one is that of all others.
    let counts: Vec<(Option<u32>, usize)> =
        rod.primitives.iter().map(|part| (part.material, part.indices.len() / 6)).collect();
    assert_eq!(counts, [(Some(0), 2), (Some(1), 8)]);
    // A vertex for each position and normal of it.
    assert_eq!(rod.primitives[0].vertices.len(), 8);
    let [brass, glass] = &model.materials[..] else { panic!("two materials") };
    assert_eq!((brass.name.as_str(), brass.phong.specular_power, brass.use_phong), ("Brass", 20.0, true));
    assert_eq!((glass.alpha_mode, glass.emissive), (AlphaMode::Blend, Vec3::new(0.2, 0.0, 0.0)));
}

#[test]
fn textures_are_found_with_either_kind_of_slash_and_missing_ones_are_warnings() {
    let files = MemoryFs::default();
    let imported = X.import(pendulum().as_bytes(), &files, &ReadOptions::default()).unwrap();
    assert_eq!(files.asked(), ["textures/brass.png"]);
    let texts: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        texts,
        ["line 16 column 20: \"textures/brass.png\": there is no such file; the image is left empty"]
    );
    let file = X.edit("a.x", pendulum().into_bytes(), &files, &ReadOptions::default()).unwrap();
    assert_eq!(file.neighbors(), ["textures/brass.png"]);
}

#[test]
fn triangles_face_where_their_normals_point_to_in_every_file() {
    for path in files_of("x") {
        let imported = import(&std::fs::read(&path).unwrap()).unwrap();
        let (right, wrong) = windings(&imported.model);
        println!("{}: {right} right, {wrong} wrong; {}", path.display(), imported.conversion);
        for warning in &imported.warnings {
            println!("  {warning}");
        }
        // Two sides of this cube have normals that point inwards.
        let is_cube = path.to_str().unwrap().contains("test_cube");
        assert!(right > 0 && (wrong * 100 <= right || is_cube && wrong == 4), "{}: {wrong}", path.display());
        assert_eq!(imported.conversion.handedness, Found::by_format(Handedness::Left));
        assert_eq!(faults(&imported.model), [""; 0], "{}", path.display());
    }
}

#[test]
fn every_polygon_is_covered_by_its_triangles() {
    let star: Vec<String> = (0..10)
        .map(|corner| {
            let (angle, radius) = (f64::from(corner) * 0.628_318_5, if corner % 2 == 0 { 3.0 } else { 1.0 });
            format!("{:.5};{:.5};0;", libm::cos(angle) * radius, libm::sin(angle) * radius)
        })
        .collect();
    let corners = (0..10).map(|corner| corner.to_string()).collect::<Vec<_>>().join(",");
    let text = format!("Mesh {{ 10; {}; 1; 10;{corners};; }}", star.join(","));
    let model = import(&with_header(&text)).unwrap().model;
    let part = &model.meshes[0].primitives[0];
    assert_eq!(part.indices.len(), 24);
    let area: f32 = part
        .indices
        .chunks_exact(3)
        .map(|corners| {
            let [a, b, c] = [0, 1, 2].map(|corner| part.vertices.positions[corners[corner] as usize]);
            (b - a).cross(c - a).z * -0.5
        })
        .sum();
    assert!((area - 8.816_78).abs() < 1e-3, "{area}");
    assert!(model.instances[0].bone.is_none());
}

#[test]
fn the_rate_of_ticks_is_that_of_the_file_the_usual_one_or_a_guess_and_the_user_chooses_another() {
    let text = pendulum();
    let rate = |text: &str, chosen: Option<f32>| {
        let conventions = Conventions { frame_rate: chosen, ..Conventions::default() };
        let options = ReadOptions { conventions, ..ReadOptions::default() };
        let imported = X.import(text.as_bytes(), &MemoryFs::default(), &options).unwrap();
        let rate = imported.conversion.frame_rate.unwrap();
        let guessed = imported.warnings.iter().any(|warning| warning.code == "TICKS_GUESSED");
        (rate.value, rate.source, imported.model.animation.takes[0].length, guessed)
    };
    assert_eq!(rate(&text, None), (24.0, ConventionSource::File, 1.0, false));
    assert_eq!(rate(&text, Some(12.0)), (12.0, ConventionSource::User, 2.0, false));
    let without = text.replace("AnimTicksPerSecond {\n 24;\n}", "");
    assert_eq!(rate(&without, None), (30.0, ConventionSource::Guess, 0.8, true));
    assert_eq!(rate(&without, Some(48.0)), (48.0, ConventionSource::User, 0.5, false));
    let long = without.replace("24;4;", "24000;4;");
    assert_eq!(rate(&long, None), (4800.0, ConventionSource::Format, 5.0, false));
}

#[test]
fn vertices_of_a_frame_that_is_missing_stay_and_those_without_weight_follow_the_mesh() {
    let text = "Frame Root { FrameTransformMatrix { 1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1;; }
        Mesh { 4; 1;0;0;, 0;1;0;, 0;0;1;, 0;0;0;; 2; 3;0,1,2;, 3;0,2,3;;
        SkinWeights { \"Lost\"; 2; 0,1; 1.0,1.0; 1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,7,1;; }
        SkinWeights { \"Root\"; 1; 2; 1.0; 1,0,0,0, 0,1,0,0, 0,0,1,0, -5,0,0,1;; } } }
        AnimationSet { Animation { { Lost } AnimationKey { 2; 1; 0;3;9,9,9;;; } }
                       Animation { { Root } AnimationKey { 2; 1; 0;3;6,0,0;;; } } }";
    let imported = import(&with_header(text)).unwrap();
    let texts: Vec<String> = imported.warnings.iter().map(|warning| warning.text.clone()).collect();
    assert_eq!(
        texts[..2],
        [
            "a skin refers to the frame \"Lost\", which is not in the file; its vertices do not move",
            "1 vertices have no weight; they follow the frame of the mesh"
        ]
    );
    assert!(texts[2].starts_with("keys of the frame \"Lost\""), "{texts:?}");
    let mut evaluator = Evaluator::new(Arc::new(imported.model));
    for (take, expected) in [
        (None, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [5.0, 0.0, 0.0]]),
        (Some(0), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, -1.0], [6.0, 0.0, 0.0]]),
    ] {
        evaluator.pose(take, 0.0);
        let mut positions = evaluator.all_positions();
        positions.sort_by_key(|position| (position.x * -2.0 + position.z) as i32);
        let mut expected = expected.map(Vec3::from).to_vec();
        expected.sort_by_key(|position| (position.x * -2.0 + position.z) as i32);
        assert_eq!(positions, expected);
    }
}

#[test]
fn odd_but_legal_texts_are_read() {
    // Carriage returns only, no names, comments, identifiers, strings without quotes, objects of other types.
    let text = "# a comment\rHeader { 1; 0; 1; }\rFrame {\r<12345678-1234-1234-1234-123456789abc>\r FrameTransformMatrix m { 1,0,0,0,0,1,0,0,0,0,1,0,0,2,0,1 }// x\r\
        Frame { Frame Bip 01 { } }\r}\rFrame Other { {  Loose } }\rMesh Loose { 3; 0;0;0;,1;0;0;,0;1;0;; 1; 3;0,1,2;; DeclData { 1;2;3;;1;2; } }\r\
        Material M { 1;1;1;1;; 1; 0;0;0;; 0;0;0;; TextureFileName { skin.png; } }\r\
        AnimationSet { Animation { AnimationKey { 9; 1; 0;1;5;; } AnimationKey { 0; 1; 2;4;1;0;0;0;;; } {Bip 01} } }";
    let imported = import(&with_header(text)).unwrap();
    let names: Vec<&str> =
        imported.model.animation.skeleton.bones.iter().map(|bone| bone.name.as_str()).collect();
    assert_eq!(names, ["frame", "frame_2", "Bip 01", "Other"]);
    assert_eq!(imported.model.instances[0].bone, Some(3));
    let take = &imported.model.animation.takes[0];
    assert_eq!((take.name.as_str(), take.tracks[2].rotation.len()), ("take", 1));
    let codes: Vec<&str> = imported.warnings.iter().map(|warning| warning.code).collect();
    assert_eq!(codes, ["KEY_TYPE_UNKNOWN", "TICKS_GUESSED", "IMAGE_DATA_INVALID"]);
    assert_eq!(imported.model.animation.skeleton.bones[0].rest.translation, Vec3::new(0.0, 2.0, 0.0));
}

#[test]
fn mirrored_matrices_are_mirrored_bones() {
    let imported = import(pendulum().as_bytes()).unwrap();
    let mut evaluator = Evaluator::new(Arc::new(imported.model));
    evaluator.pose(Some(1), 0.0);
    let determinants: Vec<bool> =
        evaluator.to_root().iter().map(|matrix: &Mat4| matrix.determinant() < 0.0).collect();
    assert_eq!(determinants, [false, true, true]);
}

#[test]
fn errors_name_the_line_or_the_byte_and_what_was_expected() {
    let error = |text: &str| import(&with_header(text)).unwrap_err().to_string();
    for (text, expected) in [
        ("Frame a {\n", "line 3 column 1: the file ends inside of 1 frames"),
        ("Frame a { }\n}", "line 3 column 1: one closing brace too many"),
        (
            "Mesh { 3; 0;0;0;,",
            "line 2 column 8: the number of vertices is 3, the file is too short for more than 1",
        ),
        ("Mesh { 1; 0;0;x;; 0; }", "line 2 column 15: \"x\" is no number where a position was expected"),
        ("Mesh { 1; 0;0;0;; 1; 3;0,0,1;; }", "line 2 column 28: the vertex of a face is 1, there are 1"),
        ("Mesh { 1; 0;0;nan;; 0; }", "line 2 column 15: \"nan\" is not finite where a position was expected"),
        (
            "Mesh { 1.5; }",
            "line 2 column 8: 1.5 where the number of vertices was expected, a whole number of at most 4294967295",
        ),
        ("Template { \"abc }", "line 2 column 12: a string has no end: there is no \""),
        ("Unknown { { }", "line 2 column 10: the object has no end"),
        (
            "AnimationSet { Animation { AnimationKey { 2; 50; 0;3;0,0,0;;; } } }",
            "line 2 column 46: the number of keys is 50, the file is too short for more than 2",
        ),
        (
            "AnimationSet { Animation { AnimationKey { 2; 1; 0;4;0,0,0,0;;; } } }",
            "line 2 column 49: a key of type 2 has 4 values, not 3",
        ),
    ] {
        let found = error(text);
        println!("{found}");
        let reason = |text: &str| text.split_once(": ").unwrap().1.to_owned();
        assert_eq!(reason(&found), reason(expected), "{found}");
        assert!(found.starts_with("line "), "{found}");
    }
    let of = |bytes: &[u8]| import(bytes).unwrap_err().to_string();
    assert_eq!(of(b"xof 0303txt"), "byte 11: the header has 16 bytes, the file ends before");
    assert_eq!(
        of(b"xof 0303gzip0032"),
        "byte 8: the encoding is none of \"txt \", \"bin \", \"tzip\" and \"bzip\""
    );
    assert_eq!(of(b"xof 0303bin 0016"), "byte 12: the size of floats is neither \"0032\" nor \"0064\"");
    assert_eq!(of(b"xof 0303bin 0032\x63\0"), "byte 16: a token of an unknown kind");
    let version = import(b"xof 9999txt 0032\n").unwrap();
    assert_eq!(
        version.warnings[0].to_string(),
        "byte 4: version \"9999\" is not known; the file is read as version 0303"
    );
    assert!(std::fs::exists(data().join("x/test.x")).unwrap());
}
