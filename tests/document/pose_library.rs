//! The pose library: poses in files that people read and share; a file that is no pose is never replaced or deleted.

use dragonfly_anim::data::{Bone, Skeleton, Transform};
use dragonfly_document::edit::{BonePose, BoneRef, Edit, EditedBones};
use dragonfly_document::posing::{blended_pose, clipboard, stick_figure};
use dragonfly_document::{DocumentMessage, DocumentReply, PoseFolder, PoseOrder, StoredPose};
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_kit::folder::Folder;
use glam::{Mat4, Quat, Vec3};
use std::path::Path;

fn pose(bone: &str, height: f32) -> BonePose {
    let bone = BoneRef::Name(bone.to_owned());
    BonePose {
        bone,
        translation: Some([0.0, height, 0.0]),
        rotation: Some([0.0, 0.0, 0.0, 1.0]),
        scale: None,
    }
}

fn fist() -> StoredPose {
    StoredPose::new("Fist".to_owned(), vec!["hand".to_owned()], vec![pose("hand.L", 0.5)])
}

fn save(folder: &Path, file: Option<&str>, pose: StoredPose) -> DocumentMessage {
    let (folder, file) = (folder.to_owned(), file.map(str::to_owned));
    DocumentMessage::Poses(PoseOrder::Save { folder, file, pose })
}

fn poses(document: &mut TestDocument) -> PoseFolder {
    document.wait_for_reply(|reply| match reply {
        DocumentReply::Poses(folder) => Some(folder.clone()),
        _ => None,
    })
}

fn names(folder: &PoseFolder) -> Vec<(&str, &str)> {
    folder.poses.iter().map(|file| (file.file.as_str(), file.pose.name.as_str())).collect()
}

#[test]
fn a_saved_pose_is_a_readable_file_that_can_also_be_pasted() {
    let folder = Folder::new("pose-library-saved");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let library = folder.join("new/poses");
    document.send(save(&library, None, fist()));
    let read = poses(&mut document);
    assert_eq!(names(&read), [("Fist.pose.json", "Fist")]);
    assert_eq!(read.poses[0].pose, fist());
    let text = std::fs::read_to_string(library.join("Fist.pose.json")).expect("a file");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(json["dragonfly"], "pose");
    assert_eq!((&json["name"], &json["tags"][0]), (&"Fist".into(), &"hand".into()));
    assert_eq!(json["poses"][0]["bone"], "hand.L");
    assert_eq!(json["poses"][0]["translation"], serde_json::json!([0.0, 0.5, 0.0]));
    assert_eq!(clipboard::from_text(&text), Some(vec![pose("hand.L", 0.5)]));
    // The poses are those that edits take.
    for name in ["paste", "set"] {
        let edit = serde_json::json!({"edit": name, "take": 0, "time": 0.5, "poses": json["poses"]});
        let edit: Edit = serde_json::from_value(edit).expect(name);
        let skeleton = Skeleton { bones: vec![bone("hand.L", None, Vec3::ZERO)] };
        assert_eq!(edit.bones(&skeleton), EditedBones::Named([0].into()), "{name}");
    }
}

#[test]
fn poses_with_one_name_have_files_of_their_own_and_a_renamed_pose_keeps_its_file() {
    let folder = Folder::new("pose-library-names");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let library = folder.join("poses");
    for _ in 0..2 {
        document.send(save(&library, None, fist()));
        poses(&mut document);
    }
    let open = StoredPose::new("Open: a/b".to_owned(), Vec::new(), vec![pose("hand.L", 0.0)]);
    document.send(save(&library, Some("Fist-2.pose.json"), open.clone()));
    assert_eq!(names(&poses(&mut document)), [("Fist.pose.json", "Fist"), ("Fist-2.pose.json", "Open: a/b")]);
    // A name with letters that files cannot have becomes another name of the file.
    document.send(save(&library, None, open));
    assert!(names(&poses(&mut document)).contains(&("Open--a-b.pose.json", "Open: a/b")));
    let (gone, file) = (library.clone(), "Fist.pose.json".to_owned());
    document.send(DocumentMessage::Poses(PoseOrder::Delete { folder: gone, file }));
    assert_eq!(poses(&mut document).poses.len(), 2);
    assert!(!library.join("Fist.pose.json").exists());
}

#[test]
fn a_file_that_is_no_pose_is_neither_replaced_nor_deleted() {
    let folder = Folder::new("pose-library-other");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let library = folder.join("poses");
    std::fs::create_dir_all(&library).expect("a folder");
    for (name, text) in [
        ("model.pose.json", r#"{"asset":{"version":"2.0"}}"#),
        ("newer.pose.json", r#"{"dragonfly":"pose","version":2,"poses":[]}"#),
        ("keys.pose.json", r#"{"dragonfly":"keys","version":1,"poses":[{"bone":"a"}]}"#),
        ("notes.txt", "notes"),
    ] {
        std::fs::write(library.join(name), text).expect("a file");
    }
    document.send(save(&library, None, fist()));
    let read = poses(&mut document);
    assert_eq!((names(&read), read.problems.len()), (vec![("Fist.pose.json", "Fist")], 3), "{read:?}");
    for name in
        ["model.pose.json", "newer.pose.json", "keys.pose.json", "notes.txt", "../poses/Fist.pose.json"]
    {
        let before = std::fs::read(library.join(name)).expect("a file");
        document.send(save(&library, Some(name), fist()));
        document.wait_for_warning("pose");
        let (folder, file) = (library.clone(), name.to_owned());
        document.send(DocumentMessage::Poses(PoseOrder::Delete { folder, file }));
        document.wait_for_warning("pose");
        assert_eq!(std::fs::read(library.join(name)).expect(name), before, "{name}");
    }
}

#[test]
fn a_folder_that_does_not_exist_has_no_poses() {
    let folder = Folder::new("pose-library-none");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.send(DocumentMessage::Poses(PoseOrder::Read(folder.join("poses"))));
    assert_eq!(poses(&mut document).poses, []);
    assert!(!folder.join("poses").exists(), "reading creates nothing");
}

fn bone(name: &str, parent: Option<u32>, offset: Vec3) -> Bone {
    Bone {
        name: name.to_owned(),
        parent,
        rest: Transform { translation: offset, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    }
}

#[test]
fn the_picture_of_a_pose_is_the_skeleton_from_the_front() {
    // A stalk of length 2 with an arm of length 1; the pose turns the arm from +x to +y.
    let skeleton = Skeleton {
        bones: vec![
            bone("root", None, Vec3::ZERO),
            bone("shoulder", Some(0), Vec3::Y * 2.0),
            bone("hand", Some(1), Vec3::X),
        ],
    };
    let rest = stick_figure(&skeleton, &[]);
    assert_eq!(rest.len(), 2);
    assert!(rest.iter().all(|line| !line.posed));
    // Fitted into a square: 2 high, 1 wide, so x goes from 1/4 to 3/4, and y from the top at 0 to 1.
    assert_eq!((rest[0].from, rest[0].to), ([0.25, 1.0], [0.25, 0.0]));
    assert_eq!((rest[1].from, rest[1].to), ([0.25, 0.0], [0.75, 0.0]));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let raised = BonePose {
        bone: BoneRef::Name("shoulder".to_owned()),
        translation: None,
        rotation: Some([0.0, 0.0, half, half]),
        scale: None,
    };
    let other = pose("tail", 1.0);
    let lines = stick_figure(&skeleton, &[raised, other]);
    assert!(lines.iter().all(|line| line.posed));
    let [_, arm] = lines[..] else { panic!("{lines:?}") };
    let near = |a: [f32; 2], b: [f32; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-5;
    assert!(near(arm.from, [0.5, 1.0 / 3.0]) && near(arm.to, [0.5, 0.0]), "{arm:?}");
    assert_eq!(stick_figure(&Skeleton { bones: Vec::new() }, &[]), []);
}

#[test]
fn a_blend_is_between_the_pose_before_and_the_one_of_the_library() {
    let from = Transform { translation: Vec3::X, rotation: Quat::IDENTITY, scale: Vec3::ONE };
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // -q is the same rotation: 90° about z, which the blend reaches on the shorter way.
    for sign in [1.0, -1.0] {
        let to = BonePose { rotation: Some([0.0, 0.0, sign * half, sign * half]), ..pose("hand", 3.0) };
        let blended = blended_pose(&from, &to, 0.5);
        assert_eq!((blended.translation, blended.scale), (Some([0.5, 1.5, 0.0]), None));
        let [x, y, z, w] = blended.rotation.expect("given");
        let (sine, cosine) = (22.5_f32.to_radians().sin(), 22.5_f32.to_radians().cos());
        assert!(x == 0.0 && y == 0.0 && (z - sine).abs() < 1e-6 && (w - cosine).abs() < 1e-6, "{z} {w}");
        assert_eq!(blended_pose(&from, &to, 1.0), to, "exactly");
        assert_eq!(blended_pose(&from, &to, 0.0).translation, Some([1.0, 0.0, 0.0]));
        assert_eq!(blended_pose(&from, &to, f32::NAN).translation, Some([1.0, 0.0, 0.0]));
    }
}
