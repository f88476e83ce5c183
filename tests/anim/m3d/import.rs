//! Content of each dialect that is read, and content that is corrected.

use super::made::{ODD, import, small, stored};
use crate::doors::{MemoryFs, data};
use crate::soundness::faults;
use crate::takes::{files_of, windings};
use dragonfly_anim::data::AlphaMode;
use dragonfly_anim::format::{
    ConventionSource, Conventions, Formats, Handedness, ReadOptions, m3d::M3D, read,
};
use glam::{Quat, Vec3};

#[test]
fn every_dialect_is_read_with_its_materials_and_labels_are_not_compared() {
    let odd = import(ODD.as_bytes()).unwrap();
    assert_eq!(faults(&odd.model), [""; 0]);
    let [skin, eyes] = &odd.model.materials[..] else { panic!("two materials") };
    assert_eq!((skin.name.as_str(), skin.base_color.to_array()), ("skin", [1.0, 0.5, 0.25, 1.0]));
    assert_eq!(
        (skin.alpha_mode, skin.metallic.roughness, skin.use_phong),
        (AlphaMode::Mask(0.1), 0.75, false)
    );
    assert!(skin.base_color_texture.is_some() && skin.normal_texture.is_none());
    assert!(eyes.base_color_texture.is_none() && eyes.normal_texture.is_some());
    let [mesh] = &odd.model.meshes[..] else { panic!("one mesh") };
    let counts: Vec<(usize, usize)> =
        mesh.primitives.iter().map(|part| (part.vertices.len(), part.indices.len() / 3)).collect();
    assert_eq!(counts, [(4, 3), (3, 1)]);

    let rigged = import(&stored("RiggedSimple.m3d")).unwrap();
    let material = &rigged.model.materials[0];
    assert!(material.use_phong && material.phong.specular_power == 16.0);
    assert_eq!(material.phong.ambient, Vec3::new(0.279_635_4, 0.64, 0.210_943_9));
    let names: Vec<&str> =
        rigged.model.animation.skeleton.bones.iter().map(|bone| bone.name.as_str()).collect();
    assert_eq!(names, ["bone0", "bone1"]);

    for name in ["sword_static_dx10_lh.m3d", "sword_static_dx11_lh.m3d"] {
        let sword = import(&stored(name)).unwrap();
        assert!(sword.model.skins.is_empty() && sword.model.animation.skeleton.is_empty());
        assert_eq!(sword.model.meshes[0].primitives[0].vertices.len(), 88);
        assert_eq!(sword.model.materials.len(), 1);
    }
    let [old, new] =
        ["sword_static_dx10_lh.m3d", "sword_static_dx11_lh.m3d"].map(|name| import(&stored(name)).unwrap());
    assert_eq!(old.model.meshes[0].primitives[0].indices, new.model.meshes[0].primitives[0].indices);
}

#[test]
fn textures_next_to_the_model_are_read_and_missing_ones_are_warnings() {
    let png = std::fs::read(data().join("gltf/Fox.glb")).unwrap();
    let at = png.windows(8).position(|bytes| bytes == b"\x89PNG\r\n\x1a\n").unwrap();
    let files = MemoryFs::with(&[("skin.png", &png[at..])]);
    let imported = M3D.import(ODD.as_bytes(), &files, &ReadOptions::default()).unwrap();
    assert_eq!(files.asked(), ["skin.png", "bumps.png"]);
    assert_eq!(imported.model.images[0].mime, "image/png");
    assert_eq!(
        imported.warnings[0].to_string(),
        "line 24 column 12: \"bumps.png\": there is no such file; the image is left empty"
    );
    let file = M3D.edit("a.m3d", ODD.as_bytes(), &files, &ReadOptions::default()).unwrap();
    assert_eq!(file.neighbors(), ["skin.png", "bumps.png"]);
}

#[test]
fn the_other_format_of_the_same_extension_is_named_and_refused() {
    for bytes in [&b"3DMO\x10\0\0\0"[..], b"3dmodel 1.0\nTest\n"] {
        let error = read("a.m3d", bytes, &MemoryFs::default(), &ReadOptions::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "byte 0: needs the other format called .m3d, Model 3D (3DMO), which is not supported"
        );
        assert_eq!(Formats::builtin().detect("a.m3d", bytes), Some(&M3D));
    }
}

#[test]
fn triangles_face_where_their_normals_point_to_in_every_file() {
    for path in files_of("m3d") {
        let imported = import(&std::fs::read(&path).unwrap()).unwrap();
        let (right, wrong) = windings(&imported.model);
        println!("{}: {right} right, {wrong} wrong; {}", path.display(), imported.conversion);
        assert!(right > 0 && wrong * 200 <= right, "{}", path.display());
        assert_eq!(imported.conversion.handedness.source, ConventionSource::Guess);
        let is_left = imported.conversion.handedness.value == Handedness::Left;
        assert_eq!(is_left, path.to_str().unwrap().contains("sword"), "{}", path.display());
    }
}

#[test]
fn the_user_chooses_the_sense_of_the_axes_and_triangles_still_face_outwards() {
    for (name, bytes) in small() {
        let guessed = import(&bytes).unwrap();
        for side in [Handedness::Left, Handedness::Right] {
            let conventions = Conventions { handedness: Some(side), ..Conventions::default() };
            let options = ReadOptions { conventions, ..ReadOptions::default() };
            let chosen = M3D.import(&bytes, &MemoryFs::default(), &options).unwrap();
            assert_eq!(chosen.conversion.handedness.source, ConventionSource::User);
            let is_same = side == guessed.conversion.handedness.value;
            assert_eq!(chosen.model == guessed.model, is_same, "{name}");
            let (right, wrong) = windings(&chosen.model);
            assert!(wrong * 200 <= right, "{name} {side:?}");
            let [a, b] = [&chosen, &guessed]
                .map(|imported| imported.model.meshes[0].primitives[0].vertices.positions[1]);
            assert_eq!(a, if is_same { b } else { b * Vec3::new(1.0, 1.0, -1.0) });
        }
    }
}

#[test]
fn all_tokens_may_be_on_one_line() {
    let bytes = stored("RiggedSimple.m3d");
    let line = String::from_utf8(bytes.clone()).unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
    let crlf = String::from_utf8(bytes.clone()).unwrap().replace('\n', "\r\n");
    let model = import(&bytes).unwrap().model;
    assert_eq!(import(line.as_bytes()).unwrap().model, model);
    assert_eq!(import(crlf.as_bytes()).unwrap().model, model);
}

#[test]
fn weights_that_do_not_add_up_leave_the_rest_to_the_fourth_bone() {
    let imported = import(ODD.as_bytes()).unwrap();
    let vertices = &imported.model.meshes[0].primitives[0].vertices;
    let of = |vertex: usize| -> Vec<(u16, f32)> {
        let influences = vertices.influences_of(vertex).iter();
        influences
            .filter(|influence| influence.weight > 0.0)
            .map(|influence| (influence.joint, influence.weight))
            .collect()
    };
    assert_eq!(of(1), [(0, 0.75), (1, 0.25)]);
    // A bone that occurs twice counts once.
    assert_eq!(of(2), [(0, 0.5), (1, 0.5)]);
    // 0.5 + 0.25, and the remaining 0.25 on bone 1.
    assert_eq!(of(3), [(1, 0.75), (0, 0.25)]);
    let texts: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
    assert!(
        texts.iter().any(|text| text.contains("1 vertices have weights that do not add up to one")),
        "{texts:?}"
    );
    let nan = ODD.replace("W: 0.75 0.25 0 0", "W: nan inf 0 0");
    assert_eq!(faults(&import(nan.as_bytes()).unwrap().model), [""; 0]);
}

#[test]
fn keys_out_of_order_of_no_length_and_missing_ones_are_corrected_with_warnings() {
    let imported = import(ODD.as_bytes()).unwrap();
    let takes = &imported.model.animation.takes;
    let names: Vec<&str> = takes.iter().map(|take| take.name.as_str()).collect();
    assert_eq!(names, ["walk", "stand"]);
    assert!(takes[0].tracks[1].is_empty() && takes[0].tracks[0].scale.len() == 3);
    let track = &takes[1].tracks[1];
    assert_eq!(track.translation.times[..], [0.0, 1.0, 2.0]);
    let heights: Vec<f32> = track.translation.values.iter().map(|value| value.y).collect();
    assert_eq!(heights, [1.75, 2.0, 2.5]);
    assert_eq!(track.rotation.values[2], Quat::IDENTITY);
    assert_eq!(takes[1].tracks[0].rotation.values[0], Quat::IDENTITY);
    // The third key is -1 about y in the file; in the hemisphere of the one before it.
    assert!(takes[0].tracks[0].rotation.values[2].dot(takes[0].tracks[0].rotation.values[1]) > 0.0);
    let codes: Vec<&str> = imported.warnings.iter().map(|warning| warning.code).collect();
    for code in ["KEYS_MISSING", "TIMES_NOT_ASCENDING", "ROTATION_NON_UNIT"] {
        assert!(codes.contains(&code), "{code} in {codes:?}");
    }
}

#[test]
fn errors_name_the_line_and_what_was_expected() {
    let error = |from: &str, to: &str| import(ODD.replacen(from, to, 1).as_bytes()).unwrap_err().to_string();
    for (from, to, expected) in [
        ("P: 1 0 0", "P: 1 0", "line 37 column 1: \"T:\" is no number where a position was expected"),
        (
            "W: 0.75 0.25 0 0",
            "W: 0.75 0.25 0",
            "line 41 column 1: \"I:\" is no number where a weight was expected",
        ),
        (
            "W: 0.75 0.25 0 0",
            "W: 0.75 0.25 0 0 0",
            "line 41 column 18: the number \"0\" where the label of the bones of a vertex was expected",
        ),
        ("I: 0 1 0 0", "I: 0 2 0 0", "line 42 column 6: a vertex refers to bone 2, there are 2 bones"),
        ("0 3 2", "0 4 2", "line 63 column 3: the vertex of a triangle is 4, there are 4"),
        (
            "0 3 2",
            "0 -3 2",
            "line 63 column 3: \"-3\" is no whole number where the vertex of a triangle was expected",
        ),
        (
            "Bone1: 0",
            "Bone1: 1",
            "line 72 column 22: the parent of bone 1 is bone 1, which has to come before it",
        ),
        ("Bone1: 0", "Bone1: 7", "line 72 column 22: the parent of bone 1 is bone 7, there are 2"),
        (
            "FaceCount: 1",
            "FaceCount: 2",
            "line 28 column 66: a subset has 2 faces from face 3 on, there are 4",
        ),
        (
            "NumBones 2",
            "NumBones 99999999",
            "line 5 column 10: the number of bones is 99999999, the text after it is too short for more than 39",
        ),
        ("T: 0.1 P", "T: 99999 P", "line 80 column 5: seconds: 99999, at most 86400"),
        ("P: 1 0 0", "P: 1e13 0 0", "line 37 column 3: the position is too large"),
    ] {
        let found = error(from, to);
        println!("{found}");
        let place = |text: &str| text.split(':').next().unwrap().to_owned();
        let reason = |text: &str| text.split_once(": ").unwrap().1.to_owned();
        assert_eq!(reason(&found), reason(expected), "{found}");
        assert!(place(&found).starts_with("line "), "{found}");
    }
}
