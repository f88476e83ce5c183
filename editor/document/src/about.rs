//! Names of the bones and the take that an edit changes, for the list of the history.

use super::adapter::ModelAdapter;
use super::edit::{Edit, EditedBones};
use dragonfly_anim::data::BoneIndex;
use std::sync::Arc;

/// Length of the longest name in a list, in characters. Longer names are cut.
const LONGEST: usize = 60;

/// Returns the bone or the number of bones, then the take, then its keys where the edit has a text for them: `head · Walk`. Empty where the edit names neither.
pub(super) fn about(adapter: &ModelAdapter, edit: &Edit) -> Arc<str> {
    let take = edit.take_title(adapter).map(|take| shortened(&take));
    let parts = [bones(adapter, edit), take, edit.detail(adapter)];
    parts.into_iter().flatten().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("  ·  ").into()
}

fn bones(adapter: &ModelAdapter, edit: &Edit) -> Option<String> {
    let bones = match edit.bones(adapter.skeleton()) {
        EditedBones::Named(bones) => bones,
        EditedBones::All | EditedBones::WholeTake => return None,
    };
    match bones.len() {
        0 => None,
        1 => bones.first().map(|&bone| bone_name(adapter, bone)),
        count => Some(format!("{count} bones")),
    }
}

fn bone_name(adapter: &ModelAdapter, bone: BoneIndex) -> String {
    let name = adapter.skeleton().bones.get(bone as usize).map_or("", |bone| bone.name.as_str());
    if name.is_empty() { format!("Bone {bone}") } else { shortened(name) }
}

/// Returns the name, cut to [`LONGEST`] characters.
pub(crate) fn shortened(name: &str) -> String {
    match name.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::edit::{BonePose, BoneRef, EDITS, PastePose, TakeRef};
    use dragonfly_anim::data::{AnimationData, Bone, Skeleton, Take};

    /// Creates a root bone.
    pub(crate) fn bone(name: &str) -> Bone {
        Bone::root(name)
    }

    fn take(name: &str) -> Arc<Take> {
        Arc::new(Take { name: name.to_owned(), ..Take::default() })
    }

    #[test]
    fn the_description_of_the_target_of_every_edit_is_short() {
        let long = "é".repeat(10_000);
        let skeleton = Skeleton { bones: vec![bone("b_Head_05"), bone(&long)] };
        let takes = vec![take("Survey"), take(&long)];
        let adapter = ModelAdapter::new(&AnimationData { skeleton: Arc::new(skeleton), takes });
        for kind in EDITS {
            let text = about(&adapter, &serde_json::from_str(kind.example.json).expect("an edit"));
            assert!(text.chars().count() <= 2 * LONGEST + 8, "{text}");
        }
    }

    #[test]
    fn the_target_of_a_mirrored_pose_is_the_bones_that_it_changes() {
        let names = ["hips", "hand.L", "hand.R"];
        let skeleton = Skeleton { bones: names.into_iter().map(bone).collect() };
        let adapter =
            ModelAdapter::new(&AnimationData { skeleton: Arc::new(skeleton), takes: vec![take("Walk")] });
        let paste = |mirrored: bool, bones: &[&str]| {
            let pose = |name: &&str| {
                let bone = BoneRef::Name((*name).to_owned());
                BonePose { bone, translation: None, rotation: None, scale: None }
            };
            let poses = bones.iter().map(pose).collect();
            let edit = PastePose {
                take: TakeRef::Index(0),
                time: 0.0,
                poses,
                mirrored,
                pending: false,
                unstep: false,
                over: None,
                falloff: None,
            };
            about(&adapter, &edit.into()).to_string()
        };
        assert_eq!(paste(false, &["hand.L"]), "hand.L  ·  Walk");
        assert_eq!(paste(true, &["hand.L"]), "hand.R  ·  Walk");
        assert_eq!(paste(true, &["hips"]), "hips  ·  Walk");
        assert_eq!(paste(true, &["hand.R", "tail of another model"]), "hand.L  ·  Walk");
        assert_eq!(paste(false, &["hand.L", "hips"]), "2 bones  ·  Walk");
    }

    #[test]
    fn a_bone_that_an_edit_names_twice_is_counted_once() {
        let skeleton = Skeleton { bones: ["hips", "hand.L"].into_iter().map(bone).collect() };
        let adapter =
            ModelAdapter::new(&AnimationData { skeleton: Arc::new(skeleton), takes: vec![take("Walk")] });
        let named = |keys: &str| {
            let json = format!(r#"{{"edit":"duplicate_keys","take":"Walk","by":1,"keys":[{keys}]}}"#);
            about(&adapter, &serde_json::from_str(&json).expect("an edit")).to_string()
        };
        let hips = r#"{"bones":["hips"],"at":[1]}"#;
        assert_eq!(named(&format!(r#"{hips},{{"bones":[0],"from":2}}"#)), "hips  ·  Walk");
        assert_eq!(named(&format!(r#"{hips},{{"bones":["hips","hand.L"],"from":2}}"#)), "2 bones  ·  Walk");
    }

    #[test]
    fn the_target_of_pasted_keys_is_each_bone_of_the_model_once() {
        let skeleton = Skeleton { bones: ["hips", "hand.L"].into_iter().map(bone).collect() };
        let adapter =
            ModelAdapter::new(&AnimationData { skeleton: Arc::new(skeleton), takes: vec![take("Walk")] });
        let channel = |bone: &str, property: &str, value: &str| {
            let keys = format!(r#"[{{"after":0,"value":{value}}}]"#);
            format!(r#"{{"bone":"{bone}","property":"{property}","interpolation":"linear","keys":{keys}}}"#)
        };
        let turn = |bone| channel(bone, "rotation", "[0,0,0,1]");
        let place = |bone| channel(bone, "translation", "[0,0,0]");
        let named = |channels: &[String]| {
            let json = format!(
                r#"{{"edit":"paste_keys","take":"Walk","time":0,"channels":[{}]}}"#,
                channels.join(",")
            );
            about(&adapter, &serde_json::from_str(&json).expect("an edit")).to_string()
        };
        let of_a_hand = [turn("hand.L"), turn("tail"), place("hand.L")];
        assert_eq!(named(&of_a_hand), "hand.L  ·  Walk");
        let of_both = [turn("hand.L"), turn("hips"), place("hand.L")];
        assert_eq!(named(&of_both), "2 bones  ·  Walk");
    }
}
