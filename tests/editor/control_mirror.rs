//! Left and right bones are paired by name, in every naming convention, and every guess is reported.

use dragonfly_anim::format::{AssetError, AssetFs, ReadOptions, read};
use dragonfly_document::bones::{BodySide, MirrorGuess, MirrorPairs};
use dragonfly_kit::random::{Random, seed};
use std::path::{Path, PathBuf};
use std::time::Instant;

fn pairs(names: &[&str]) -> Vec<(u32, u32, MirrorGuess)> {
    let found = MirrorPairs::of_names(names);
    found.pairs.iter().map(|pair| (pair.left, pair.right, pair.guess)).collect()
}

#[test]
fn every_naming_convention_is_recognized() {
    use MirrorGuess::{Capitals, Glued, Name, Numbers, Words};
    let customs = [
        ("arm.L", "arm.R", Name),
        ("arm.l", "arm.r", Name),
        ("arm_l", "arm_r", Name),
        ("Arm-L", "Arm-R", Name),
        ("arm L", "arm R", Name),
        ("L_arm", "R_arm", Name),
        ("l.arm", "r.arm", Name),
        ("LArm", "RArm", Name),
        ("armL", "armR", Name),
        ("LeftArm", "RightArm", Name),
        ("ArmLeft", "ArmRight", Name),
        ("left_arm", "right_arm", Name),
        ("ARM_LEFT", "ARM_RIGHT", Name),
        ("mixamorig:LeftArm", "mixamorig:RightArm", Name),
        ("mixamorig:LeftHandIndex1", "mixamorig:RightHandIndex1", Name),
        ("Bip01 L Arm", "Bip01 R Arm", Name),
        ("Bip001 L Finger01", "Bip001 R Finger01", Name),
        ("左腕", "右腕", Name),
        ("腕.左", "腕.右", Name),
        ("ひだりうで_ひだり", "ひだりうで_みぎ", Name),
        ("arm.L.001", "arm.R.001", Name),
        ("L1_hand", "R1_hand", Name),
        ("DEF-upper_arm.L.002", "DEF-upper_arm.R.002", Name),
        ("L_eye_L", "R_eye_R", Name),
        ("ORG-f_index.01.L", "ORG-f_index.01.R", Name),
        ("Lft_knee", "Rgt_knee", Name),
        ("Armature|LeftFoot", "Armature|RightFoot", Name),
        ("joint_bras_gauche", "joint_bras_droite", Name),
        ("LeftArm", "rightarm", Glued),
        ("leftArm", "RightArm", Capitals),
        ("Arm_L", "arm_r", Capitals),
        ("LeftArm", "arm_r", Words),
        ("Arm.Left", "R_Arm", Words),
        ("b_LeftUpperArm_09", "b_RightUpperArm_06", Numbers),
        ("Arm.L", "Arm.R.001", Numbers),
        ("arm_joint_L__4_", "arm_joint_R", Numbers),
        ("leftarm", "rightarm", Glued),
        ("lfoot", "rfoot", Glued),
        ("eyel", "eyer", Glued),
    ];
    for (left, right, guess) in customs {
        for (names, expected) in [([left, right], (0, 1, guess)), ([right, left], (1, 0, guess))] {
            assert_eq!(pairs(&names), [expected], "{names:?}");
        }
    }
}

#[test]
fn names_without_a_counterpart_are_not_paired() {
    for names in [
        ["Arm.L", "Leg.R"],
        ["Arm.L", "Arm.L.R"],
        ["Spine", "Spine1"],
        ["L", "Right"],
        ["Spine1", "Spine2"],
        ["", ""],
        ["Tail", "Trail"],
        ["左", "左"],
        ["Arm.L", "Arm.L"],
    ] {
        assert_eq!(pairs(&names), [], "{names:?}");
    }
}

#[test]
fn names_that_differ_least_are_paired_and_ambiguous_names_are_not() {
    let names = ["Arm_R", "arm_r", "Arm_L", "arm_l"];
    assert_eq!(pairs(&names), [(2, 0, MirrorGuess::Name), (3, 1, MirrorGuess::Name)]);
    // Two figures in one file: the first left arm is paired with the first right arm.
    let names = ["Arm.L", "Arm.R", "Arm.L", "Arm.R"];
    assert_eq!(pairs(&names), [(0, 1, MirrorGuess::Name), (2, 3, MirrorGuess::Name)]);
    assert_eq!(pairs(&["Arm.L", "Arm.R", "Arm.L"]), [], "which of the two?");
}

#[test]
fn unpaired_bones_are_reported_with_their_side() {
    let found = MirrorPairs::of_names(&["Hips", "Arm.L", "Arm.R", "Horn.L", "Wing_Right"]);
    let left: Vec<_> = found.unpaired.iter().map(|alone| (alone.bone, alone.side)).collect();
    assert_eq!(left, [(0, None), (3, Some(BodySide::Left)), (4, Some(BodySide::Right))]);
    assert_eq!(found.partner(1), Some(2));
    assert_eq!(found.mirror_of(0), Some(0), "a bone of the middle mirrors itself");
    assert_eq!(found.mirror_of(2), Some(1));
    assert_eq!(found.mirror_of(3), None, "its other side is missing");
    assert_eq!((found.partner(99), found.mirror_of(99)), (None, None));
}

#[test]
fn any_names_are_paired_in_bounded_time() {
    let seed = seed(71);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let pieces = [
        "L", "l", "R", "left", "Right", "左", "右", "_", ".", " ", "1", "007", "arm", "Ä", "😀", "\0", "|",
        ":",
    ];
    for _ in 0..300 {
        let names: Vec<String> = (0..random.below(40))
            .map(|_| (0..random.below(8)).map(|_| random.choice(&pieces)).collect())
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let found = MirrorPairs::of_names(&names);
        assert_eq!(found.pairs.len() * 2 + found.unpaired.len(), names.len());
        for pair in &found.pairs {
            assert_eq!(found.partner(pair.left), Some(pair.right));
            assert_eq!(found.partner(pair.right), Some(pair.left));
            assert_ne!(pair.left, pair.right);
        }
        assert_eq!(found, MirrorPairs::of_names(&names), "the same every time");
    }
    let start = Instant::now();
    let long = "l_".repeat(100_000);
    let mut names: Vec<&str> = vec!["Arm.L"; 30_000];
    names.extend(vec!["Arm.R"; 30_000]);
    names.extend([long.as_str(), "l_l_l_l_l_l_l_l_l_l_l_l_l_l_l_l_l"]);
    assert_eq!(MirrorPairs::of_names(&names).pairs.len(), 30_000);
    assert!(start.elapsed().as_secs() < 20);
}

/// Reads files of a folder for the importer.
struct FolderFs(PathBuf);

impl AssetFs for FolderFs {
    fn read(&self, path: &str, _limit: u64) -> Result<Vec<u8>, AssetError> {
        std::fs::read(self.0.join(path)).map_err(|_| AssetError::Missing)
    }
}

#[test]
fn in_the_sample_rigs_every_sided_bone_has_a_counterpart() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data");
    let mut folders = Vec::from(["gltf", "bench", "collection"].map(|folder| data.join(folder)));
    let mut sided = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let Ok(bytes) = std::fs::read(&path) else { continue };
            let door = FolderFs(folder.clone());
            let Ok(imported) = read(&name, &bytes, &door, &ReadOptions::default()) else { continue };
            let skeleton = &imported.model.animation.skeleton;
            let found = MirrorPairs::of(skeleton);
            assert_eq!(found.pairs.len() * 2 + found.unpaired.len(), skeleton.len(), "{name}");
            let lonely: Vec<&str> = found
                .unpaired
                .iter()
                .filter(|alone| alone.side.is_some())
                .map(|alone| skeleton.bones[alone.bone as usize].name.as_str())
                .collect();
            sided += found.pairs.len();
            if !found.pairs.is_empty() || !lonely.is_empty() {
                println!("{name}: {} pairs of {} bones, alone {lonely:?}", found.pairs.len(), skeleton.len());
                for pair in &found.pairs {
                    let [left, right] =
                        [pair.left, pair.right].map(|bone| &skeleton.bones[bone as usize].name);
                    println!("    {left} – {right} {:?}", pair.guess);
                }
            }
            assert!(lonely.len() <= found.pairs.len(), "{name}: {lonely:?}");
        }
    }
    assert!(sided > 20, "{sided}");
}
