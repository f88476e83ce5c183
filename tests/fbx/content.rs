//! Content of models: units and axes, keys, textures, in-between shapes, choices of the user.

use crate::support::{OneFile, file, parser, read_here, read_with};
use dragonfly_anim::animation::Animation;
use dragonfly_anim::data::Interpolation;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{Conventions, Handedness, UpAxis};
use dragonfly_fbx::code::FBX_TEXTURE;
use dragonfly_kit::skip::models;
use glam::Vec3;
use std::sync::Arc;

/// Returns a text file with a triangle, a material with a texture called `texture`, and more objects and connections.
fn triangle(settings: &str, texture: &str, (objects, connections): (String, &str)) -> Vec<u8> {
    format!(
        "; FBX 7.4.0 project file\nFBXHeaderExtension:  {{\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}}\n\
         GlobalSettings:  {{\nVersion: 1000\nProperties70:  {{\n{settings}}}\n}}\n\
         Objects:  {{\n\
         Geometry: 10, \"Geometry::\", \"Mesh\" {{\nVertices: *9 {{\na: 0,0,0,100,0,0,0,100,0\n}}\n\
         PolygonVertexIndex: *3 {{\na: 0,1,-3\n}}\n\
         LayerElementUV: 0 {{\nMappingInformationType: \"ByPolygonVertex\"\nReferenceInformationType: \"Direct\"\n\
         UV: *6 {{\na: 0,0,1,0,0,0.75\n}}\n}}\n\
         Layer: 0 {{\nLayerElement:  {{\nType: \"LayerElementUV\"\nTypedIndex: 0\n}}\n}}\n}}\n\
         Model: 20, \"Model::node\", \"Mesh\" {{\nVersion: 232\n}}\n\
         Material: 30, \"Material::wood\", \"\" {{\nVersion: 102\nShadingModel: \"phong\"\n}}\n\
         Texture: 40, \"Texture::wood\", \"\" {{\nFileName: \"C:\\Users\\me\\{texture}\"\nRelativeFilename: \"{texture}\"\n}}\n\
         {objects}\n}}\n\
         Connections:  {{\nC: \"OO\",20,0\nC: \"OO\",10,20\nC: \"OO\",30,20\nC: \"OP\",40,30,\"DiffuseColor\"\n{connections}}}\n"
    )
    .into_bytes()
}

/// Returns a setting of `triangle`.
fn setting(name: &str, value: &str) -> String {
    format!("P: \"{name}\", \"int\", \"Integer\", \"\",{value}\n")
}

/// Returns settings of an up axis with the usual front of that axis.
fn z_up(unit: f32) -> String {
    [
        setting("UpAxis", "2"),
        setting("UpAxisSign", "1"),
        setting("FrontAxis", "1"),
        setting("FrontAxisSign", "-1"),
        setting("CoordAxis", "0"),
        setting("CoordAxisSign", "1"),
        format!("P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",{unit}\n"),
    ]
    .concat()
}

/// Returns a take with one curve, whose keys are at 0 and 1 s.
fn curve(end: f32, flags: u32, property: &str) -> String {
    format!(
        "AnimationStack: 60, \"AnimStack::turn\", \"\" {{\n}}\nAnimationLayer: 61, \"AnimLayer::base\", \"\" {{\n}}\n\
         AnimationCurveNode: 62, \"AnimCurveNode::R\", \"\" {{\nProperties70:  {{\n\
         P: \"{property}\", \"Number\", \"\", \"A\",0\n}}\n}}\n\
         AnimationCurve: 63, \"AnimCurve::\", \"\" {{\nDefault: 0\nKeyVer: 4009\n\
         KeyTime: *2 {{\na: 0,46186158000\n}}\nKeyValueFloat: *2 {{\na: 0,{end}\n}}\n\
         KeyAttrFlags: *1 {{\na: {flags}\n}}\nKeyAttrDataFloat: *4 {{\na: 0,0,0,0\n}}\nKeyAttrRefCount: *1 {{\na: 2\n}}\n}}\n"
    )
}

/// Returns an animation of the rotation about y.
fn turning(degrees: f32, flags: u32) -> (String, &'static str) {
    let connections =
        "C: \"OO\",61,60\nC: \"OO\",62,61\nC: \"OP\",62,20,\"Lcl Rotation\"\nC: \"OP\",63,62,\"d|Y\"\n";
    (curve(degrees, flags, "d|Y"), connections)
}

/// Returns nothing but the triangle.
fn nothing() -> (String, &'static str) {
    (String::new(), "")
}

/// Returns a channel with a shape at a half and one at the end, and its animation from 0 to 100 %.
fn smiling() -> (String, &'static str) {
    let shape = |number: u32, name: &str, offset: f32| {
        format!(
            "Geometry: {number}, \"Geometry::{name}\", \"Shape\" {{\nVersion: 100\nIndexes: *1 {{\na: 1\n}}\n\
             Vertices: *3 {{\na: {offset},0,0\n}}\nNormals: *3 {{\na: 0,0,0\n}}\n}}\n"
        )
    };
    let objects = [
        "Deformer: 70, \"Deformer::face\", \"BlendShape\" {\nVersion: 100\n}\n".to_owned(),
        "Deformer: 71, \"SubDeformer::smile\", \"BlendShapeChannel\" {\nVersion: 100\nDeformPercent: 0\n\
         FullWeights: *2 {\na: 50,100\n}\n}\n"
            .to_owned(),
        shape(72, "half", 10.0),
        shape(73, "full", 50.0),
        curve(100.0, LINEAR, "d|DeformPercent"),
    ];
    let connections = "C: \"OO\",70,10\nC: \"OO\",71,70\nC: \"OO\",72,71\nC: \"OO\",73,71\nC: \"OO\",61,60\nC: \"OO\",62,61\n\
                       C: \"OP\",62,71,\"DeformPercent\"\nC: \"OP\",63,62,\"d|DeformPercent\"\n";
    (objects.concat(), connections)
}

/// Flags of a linear and of a constant key.
const LINEAR: u32 = 4;
const CONSTANT: u32 = 2;

/// The first bytes of a PNG image of one pixel, which is all that an import looks at.
fn png() -> Vec<u8> {
    b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\x02\0\0\0".to_vec()
}

#[test]
fn units_and_axes_of_the_file_are_converted_and_recorded() {
    let read = read_here(&triangle(&z_up(2.5), "wood.png", nothing())).expect("a good file");
    assert_eq!(read.conversion.to_string(), "1 unit = 0.025 m (file), Z up (file), right-handed (file)");
    let positions = &read.model.meshes[0].primitives[0].vertices.positions;
    let far = positions.iter().fold(Vec3::ZERO, |far, position| far.max(position.abs()));
    assert!((far - Vec3::new(2.5, 0.0, 2.5)).length() < 1e-5, "y of a Z-up file is -z: {far}");
}

#[test]
fn choices_of_the_user_take_precedence_in_the_child_too() {
    let bytes = triangle(&z_up(1.0), "wood.png", nothing());
    let chosen = Conventions {
        meters_per_unit: Some(1.0),
        up: Some(UpAxis::Y),
        handedness: Some(Handedness::Left),
        ..Conventions::default()
    };
    let files = OneFile("wood.png", png());
    let read =
        read_with(|context| parser().read(&bytes, context), &bytes, &files, chosen).expect("a good file");
    assert_eq!(read.conversion.to_string(), "1 unit = 1 m (chosen), Y up (chosen), left-handed (chosen)");
    let primitive = &read.model.meshes[0].primitives[0];
    assert_eq!(primitive.vertices.positions.iter().map(|position| position.y).fold(0.0, f32::max), 100.0);
    let [a, b, c] = [0, 1, 2].map(|corner| primitive.vertices.positions[primitive.indices[corner] as usize]);
    let normal = primitive.vertices.normals[0];
    assert!((b - a).cross(c - a).dot(normal) > 0.0, "the triangle faces its normal after the mirroring");
}

#[test]
fn external_textures_are_opened_by_the_parent_and_missing_ones_are_a_warning() {
    let bytes = triangle("", "textures\\wood 1.png", nothing());
    for path in ["textures/wood 1.png", "wood 1.png"] {
        let files = OneFile(path, png());
        let read =
            read_with(|context| parser().read(&bytes, context), &bytes, &files, Conventions::default());
        let read = read.expect("a good file");
        let image = &read.model.images[0];
        assert_eq!(
            (image.file_name.as_deref(), image.mime.as_str(), image.width),
            (Some(path), "image/png", 1)
        );
        assert!(!image.bytes.is_empty());
        let texture = read.model.materials[0].base_color_texture.expect("a texture");
        assert_eq!(texture.image, 0);
        assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    }
    let read = read_here(&bytes).expect("a good file");
    assert!(read.model.images[0].bytes.is_empty());
    assert_eq!(read.warnings.iter().map(|warning| warning.code).collect::<Vec<_>>(), [FBX_TEXTURE]);
}

#[test]
fn texture_coordinates_point_down() {
    let read = read_here(&triangle("", "wood.png", nothing())).expect("a good file");
    let [first, _] = &read.model.meshes[0].primitives[0].vertices.texture_coordinates;
    assert!(first.iter().any(|uv| uv.to_array() == [0.0, 0.25]), "{first:?}");
}

#[test]
fn full_turns_between_two_keys_stay_full_turns() {
    for degrees in [360.0_f32, 720.0, 1080.0, 10.0 * 360.0, 2880.0] {
        let read = read_here(&triangle("", "wood.png", turning(degrees, LINEAR))).expect("a good file");
        let take = &read.model.animation.takes[0];
        assert_eq!((take.name.as_str(), take.start, take.length), ("turn", 0.0, 1.0));
        let mut animation = Animation::of(&read.model);
        for step in 0..=200 {
            let time = step as f32 / 200.0;
            let x = animation.to_root_bone_poses(Some(0), time)[0].x_axis;
            let angle = (f64::from(degrees) * f64::from(time)).to_radians();
            let expected = [angle.cos() as f32, -angle.sin() as f32];
            assert!(
                (x.x - expected[0]).abs() + (x.z - expected[1]).abs() < 2e-3,
                "{degrees}° at {time} s: {x}"
            );
        }
    }
}

#[test]
fn constant_keys_stay_steps_and_constant_curves_keep_no_key() {
    let read = read_here(&triangle("", "wood.png", turning(90.0, CONSTANT))).expect("a good file");
    let rotation = &read.model.animation.takes[0].tracks[0].rotation;
    assert_eq!((rotation.interpolation, rotation.len()), (Interpolation::Step, 2));
    let read = read_here(&triangle("", "wood.png", turning(0.0, LINEAR))).expect("a good file");
    let take = &read.model.animation.takes[0];
    assert!(take.tracks[0].rotation.is_empty(), "a rotation that does not change is the rest pose");
    assert_eq!((take.start, take.length), (0.0, 1.0), "but the take has the length of its curves");
}

#[test]
fn in_between_shapes_are_targets_that_take_turns() {
    let read = read_here(&triangle("", "wood.png", smiling())).expect("a good file");
    let targets = &read.model.meshes[0].primitives[0].morph_targets;
    assert_eq!(
        targets.iter().map(|target| target.name.as_str()).collect::<Vec<_>>(),
        ["smile half", "smile full"]
    );
    let mut evaluator = Evaluator::new(Arc::new(read.model));
    for (time, weights, x) in [
        (0.0, [0.0, 0.0], 1.0),
        (0.25, [0.5, 0.0], 1.05),
        (0.5, [1.0, 0.0], 1.1),
        (0.75, [0.5, 0.5], 1.3),
        (1.0, [0.0, 1.0], 1.5),
    ] {
        evaluator.pose(Some(0), time);
        let found = evaluator.morph_weights(0);
        let difference = found.iter().zip(weights).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(found.len() == 2 && difference < 1e-3, "{found:?} at {time} s");
        let far = evaluator.all_positions().iter().map(|position| position.x).fold(0.0, f32::max);
        assert!((far - x).abs() < 1e-3, "{far} at {time} s");
    }
}

#[test]
fn cubic_curves_keep_their_keys() {
    let read = read_here(&file("maya_blend_shape_cube_7700_binary.fbx")).expect("a good file");
    let morph = &read.model.animation.takes[0].morphs[0];
    assert_eq!((morph.interpolation, morph.targets), (Interpolation::CubicSpline, 2));
    assert!(morph.times.len() <= 6, "{:?}", morph.times);
}

#[test]
fn a_captured_human_is_as_tall_as_one_and_no_bone_is_scaled_by_a_hundredth() {
    let Some(folder) = models() else { return };
    let bytes = std::fs::read(folder.join("fbx/pab_run.fbx")).expect("a file");
    let read = read_here(&bytes).expect("a good file");
    let mut animation = Animation::of(&read.model);
    let bones = &read.model.animation.skeleton.bones;
    // Cameras and lights of the file are bones, too, since they move.
    let mut is_human = vec![false; bones.len()];
    for (index, bone) in bones.iter().enumerate() {
        is_human[index] = bone.name == "Hips" || bone.parent.is_some_and(|parent| is_human[parent as usize]);
    }
    let poses = animation.to_root_bone_poses(None, 0.0).iter().zip(&is_human);
    let heights = poses.filter(|(_, is_human)| **is_human).map(|(matrix, _)| matrix.w_axis.y);
    let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), y| (low.min(y), high.max(y)));
    assert!((1.4..2.1).contains(&(high - low)), "{} m", high - low);
    for bone in bones {
        assert!(bone.rest.scale.abs().min_element() > 0.1, "{}: {}", bone.name, bone.rest.scale);
    }
}
