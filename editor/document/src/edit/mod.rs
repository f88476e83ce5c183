//! The vocabulary of edits: every change of a model's takes, and of its root bones, as values.
//!
//! The mouse, panels, menus, the command line, scripts and standard input all make edits, and nothing else changes a
//! document. In JSON an edit is an object with its name in `"edit"`:
//!
//! ```json
//! {"edit": "set", "take": "Survey", "time": 0.5, "poses": [{"bone": "b_Head_05", "rotation": [0, 0, 0.26, 0.97]}]}
//! ```
//!
//! Times are seconds, on the clock of the take. Bones and takes are given by name or by index. A number that is not finite,
//! a bone that does not exist, or a time without a key is an error that names it, and nothing changes.
//!
//! Each kind of edit is one file with its data, plan, label, example, the bones and the take that it changes, and a
//! generator for property tests. A new kind is such a file and a line in the list `edits!` below.

#![deny(clippy::wildcard_enum_match_arm)]

mod add_keys;
mod add_layer;
mod add_root_bone;
mod add_take;
mod add_takes;
mod arbitrary;
mod blend_keys;
mod bones;
mod close_loop;
mod contact_span;
mod copied;
mod cost;
mod create_take;
mod delete_keys;
mod delete_layer;
mod delete_take;
mod detect_contacts;
mod drop_pending;
mod duplicate_keys;
mod edit_script;
mod edit_unit;
mod examples;
mod filter_keys;
mod given_shapes;
mod hold;
mod kept_travel;
mod key_layer_weight;
mod key_pending;
mod kind;
mod lines;
mod lock_contacts;
mod map_parts;
mod map_references;
pub(crate) mod mapped_bones;
pub(crate) mod mapped_places;
mod merge_layers;
mod mirror_take;
mod misfit;
pub(crate) mod mode;
mod move_keys;
mod move_layer;
mod move_take;
mod move_travel;
mod noise_keys;
mod offset_keys;
mod offset_pose;
mod offset_shapes;
mod over;
mod paste_keys;
mod paste_pose;
mod paste_shapes;
mod pend_shapes;
pub(crate) mod pose;
mod reduce_keys;
pub(crate) mod reference_map;
mod remove_travel;
mod rename_take;
mod repeat_keys;
mod resample_keys;
mod reset_pose;
mod restore_travel;
mod retime_take;
mod reverse_take;
mod ripple_keys;
mod scale_keys;
mod script_label;
mod set_contacts;
mod set_events;
mod set_extras;
mod set_interpolation;
mod set_layer;
mod set_layer_weights;
mod set_many_tangents;
mod set_pending;
mod set_pose;
mod set_poses;
mod set_shape_keys;
mod set_shapes;
mod set_tangents;
mod shape_tangents;
mod shift_loop;
mod snap_keys;
mod split_take;
mod stretch_time;
mod take_event;
pub(crate) mod target;
mod text_ref;
mod travel_parts;
mod trim_take;
mod turn_keys;

pub use add_layer::LAYER_COLORS;
pub use add_take::GivenChannel;
#[doc(hidden)]
pub use arbitrary::Arbitrary;
pub use blend_keys::KeyTarget;
pub use bones::EditedBones;
pub use contact_span::ContactSpan;
pub use copied::{CopiedChannel, CopiedKey, CopiedShapeKey, CopiedShapes};
pub use edit_script::ScriptSplice;
pub use edit_unit::{EditUnit, UnitGuess};
pub use examples::Example;
pub use filter_keys::CurveFilter;
pub use given_shapes::GivenShapes;
pub use kept_travel::TRAVEL;
pub use kind::EditInfo;
pub use lines::{LONGEST_LINE, LineError, parse_lines};
pub use misfit::Misfit;
pub use mode::{KeyInterpolation, LayerKind, NewKey, ResetTo};
pub use over::{FadeShape, OffsetFalloff, OffsetRange, OffsetScope, ShapeScope};
pub use pose::{BonePose, PoseAt};
pub use repeat_keys::{RepeatCount, RepeatMode};
pub use script_label::ScriptLabel;
pub use set_layer_weights::LayerWeightKey;
pub use set_many_tangents::TangentsAt;
pub use set_shape_keys::ShapeKeyAt;
pub use set_shapes::ShapeWeight;
pub use shape_tangents::KeyTangents;
pub use take_event::TakeEvent;
pub use target::{BoneRef, KeySet, LayerRef, MeshRef, Property, SAME_TIME, ShapeRef, TakeRef};
pub use text_ref::TextRef;
pub use travel_parts::TravelPart;
pub use turn_keys::TurnWay;

use crate::adapter::plan::{PoseMode, Transaction};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use kind::{EditKind, edits};
use map_references::MapReferences;
use reference_map::ReferenceMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Version of the vocabulary. It grows when an older reader could misunderstand a newer edit.
pub const VERSION: u32 = 1;

edits! {
    "set" => set_pose::SetPose,
    "set_many" => set_poses::SetPoses,
    "offset" => offset_pose::OffsetPose,
    "offset_keys" => offset_keys::OffsetKeys,
    "reset" => reset_pose::ResetPose,
    "pend" => set_pending::SetPending,
    "paste" => paste_pose::PastePose,
    "key_pending" => key_pending::KeyPending,
    "drop_pending" => drop_pending::DropPending,
    "add_keys" => add_keys::AddKeys,
    "delete_keys" => delete_keys::DeleteKeys,
    "move_keys" => move_keys::MoveKeys,
    "scale_keys" => scale_keys::ScaleKeys,
    "duplicate_keys" => duplicate_keys::DuplicateKeys,
    "paste_keys" => paste_keys::PasteKeys,
    "ripple" => ripple_keys::RippleKeys,
    "snap_keys" => snap_keys::SnapKeys,
    "set_interpolation" => set_interpolation::SetInterpolation,
    "set_tangents" => set_tangents::SetTangents,
    "set_many_tangents" => set_many_tangents::SetManyTangents,
    "shape_tangents" => shape_tangents::ShapeTangents,
    "blend_keys" => blend_keys::BlendKeys,
    "filter_keys" => filter_keys::FilterKeys,
    "noise_keys" => noise_keys::NoiseKeys,
    "resample_keys" => resample_keys::ResampleKeys,
    "reduce_keys" => reduce_keys::ReduceKeys,
    "turn_keys" => turn_keys::TurnKeys,
    "repeat_keys" => repeat_keys::RepeatKeys,
    "create_take" => create_take::CreateTake,
    "add_take" => add_take::AddTake,
    "add_takes" => add_takes::AddTakes,
    "delete_take" => delete_take::DeleteTake,
    "set_extras" => set_extras::SetExtras,
    "rename_take" => rename_take::RenameTake,
    "move_take" => move_take::MoveTake,
    "split_take" => split_take::SplitTake,
    "trim_take" => trim_take::TrimTake,
    "reverse_take" => reverse_take::ReverseTake,
    "retime_take" => retime_take::RetimeTake,
    "stretch_time" => stretch_time::StretchTime,
    "mirror_take" => mirror_take::MirrorTake,
    "add_root_bone" => add_root_bone::AddRootBone,
    "move_travel" => move_travel::MoveTravel,
    "remove_travel" => remove_travel::RemoveTravel,
    "restore_travel" => restore_travel::RestoreTravel,
    "lock_contacts" => lock_contacts::LockContacts,
    "detect_contacts" => detect_contacts::DetectContacts,
    "set_contacts" => set_contacts::SetContacts,
    "set_events" => set_events::SetEvents,
    "add_layer" => add_layer::AddLayer,
    "delete_layer" => delete_layer::DeleteLayer,
    "set_layer" => set_layer::SetLayer,
    "key_layer_weight" => key_layer_weight::KeyLayerWeight,
    "set_layer_weights" => set_layer_weights::SetLayerWeights,
    "move_layer" => move_layer::MoveLayer,
    "merge_layers" => merge_layers::MergeLayers,
    "close_loop" => close_loop::CloseLoop,
    "shift_loop" => shift_loop::ShiftLoop,
    "set_shapes" => set_shapes::SetShapes,
    "set_shape_keys" => set_shape_keys::SetShapeKeys,
    "offset_shapes" => offset_shapes::OffsetShapes,
    "pend_shapes" => pend_shapes::PendShapes,
    "script" => edit_script::EditScript,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapter::TakeVersions;
    use dragonfly_anim::data::{AnimationData, Bone, Transform};
    use dragonfly_kit::random::{Random, seed};
    use glam::Mat4;
    use std::collections::BTreeSet;
    use std::sync::Arc;

    const BONES: [&str; 6] = ["hips", "hand.L", "hand.R", "thigh.L", "shin.L", "foot.L"];

    fn bone(name: &str) -> Bone {
        let rest = Transform::IDENTITY;
        Bone {
            name: name.to_owned(),
            parent: match name {
                "shin.L" => Some(3),
                "foot.L" => Some(4),
                _ => None,
            },
            rest: Transform { translation: glam::Vec3::Y, ..rest },
            rest_matrix: None,
            offset: Mat4::IDENTITY,
            node: None,
        }
    }

    /// Two takes with linear and with spline channels, keys at several times, and a pending pose.
    fn model() -> ModelAdapter {
        let skeleton = Arc::new(Skeleton { bones: BONES.map(bone).into() });
        let model = ModelAdapter::new(&AnimationData { skeleton, takes: Vec::new() });
        let texts = crate::adapter::TextFiles::one("scene.xml", "<script version=\"1\"/>\n");
        let mut model = model.with_shapes(crate::shapes::tests::two_meshes()).with_texts(texts);
        for line in [
            r#"{"edit":"create_take","name":"walk"}"#,
            r#"{"edit":"set","take":0,"time":0.5,"poses":[{"bone":0,"translation":[0,1,0]},{"bone":1,"rotation":[1,0,0,0]}]}"#,
            r#"{"edit":"set","take":0,"time":1,"poses":[{"bone":0,"scale":[2,1,1]},{"bone":2,"translation":[0,0,1]}]}"#,
            r#"{"edit":"set_interpolation","take":0,"bones":[0],"interpolation":"cubic_spline"}"#,
            r#"{"edit":"create_take","name":"run","copy":0}"#,
            r#"{"edit":"set","take":1,"time":1,"poses":[{"bone":0,"translation":[0,2,1]}]}"#,
            r#"{"edit":"remove_travel","take":1,"bone":0,"parts":["height"],"smooth":0.0}"#,
            r#"{"edit":"add_layer","take":0,"name":"up"}"#,
            r#"{"edit":"add_layer","take":0,"name":"pose","kind":"override","bones":[0,1,4]}"#,
            r#"{"edit":"set","take":{"take":0,"layer":0},"time":0.2,"poses":[{"bone":0,"translation":[0,3,0]}]}"#,
            r#"{"edit":"set","take":{"take":0,"layer":"pose"},"time":0.7,"poses":[{"bone":1,"rotation":[0,1,0,0]}]}"#,
            r#"{"edit":"key_layer_weight","take":{"take":0,"layer":1},"time":0.6,"weight":0.5}"#,
            r#"{"edit":"pend","take":0,"time":0.3,"poses":[{"bone":1,"translation":[0,2,0]}]}"#,
            r#"{"edit":"set_shapes","take":0,"time":0.3,"shapes":[{"shape":"smile","weight":1}]}"#,
            r#"{"edit":"set_shapes","take":0,"time":0.77,"shapes":[{"shape":"smile","weight":0}]}"#,
        ] {
            model.apply(&serde_json::from_str(line).expect("an edit")).expect(line);
        }
        model
    }

    /// Asserts that two models are the same in everything that an edit can change.
    fn assert_same(a: &ModelAdapter, b: &ModelAdapter, context: &str) {
        let changes = |slot: &TakeVersions| -> Vec<_> {
            let changed = slot.changed();
            changed.map(|(bone, property)| (bone, property, slot.changes(bone, property).to_vec())).collect()
        };
        assert_eq!((a.skeleton(), a.texts()), (b.skeleton(), b.texts()), "{context}");
        assert_eq!(a.slots().len(), b.slots().len(), "{context}");
        for (a, b) in a.slots().iter().zip(b.slots()) {
            assert_eq!((a.id, a.origin), (b.id, b.origin), "{context}");
            assert_eq!((&a.original, &a.result), (&b.original, &b.result), "{context}");
            assert_eq!((changes(a), a.pending()), (changes(b), b.pending()), "{context}");
            assert_eq!((a.shown(), a.layers().len()), (b.shown(), b.layers().len()), "{context}");
            for (a, b) in a.layers().iter().zip(b.layers()) {
                assert_eq!((&a.settings, a.keys.id), (&b.settings, b.keys.id), "{context}");
                assert_eq!(
                    (&a.keys.original, &a.keys.result),
                    (&b.keys.original, &b.keys.result),
                    "{context}"
                );
                assert_eq!(
                    (changes(&a.keys), a.keys.pending()),
                    (changes(&b.keys), b.keys.pending()),
                    "{context}"
                );
            }
        }
    }

    #[test]
    fn every_kind_of_edit_has_a_name_an_example_and_a_label() {
        let mut names = BTreeSet::new();
        for kind in EDITS {
            assert!(names.insert(kind.name), "{} is in the list twice", kind.name);
            let json: serde_json::Value = serde_json::from_str(kind.example.json).expect(kind.name);
            assert_eq!(json["edit"], kind.name);
            let edit: Edit = serde_json::from_value(json).expect(kind.name);
            assert!(!edit.label().is_empty(), "{}", kind.name);
            assert!(kind.example.description.ends_with('.'), "{}", kind.name);
        }
    }

    #[test]
    fn every_kind_of_edit_is_read_back_as_it_was_written() {
        let mut random = Random::new(seed(40));
        let bones = BONES.map(|name| BoneRef::Name(name.to_owned()));
        for kind in EDITS {
            for _ in 0..100 {
                let edit = (kind.arbitrary)(&mut Arbitrary::new(&mut || random.bits(), 3, &bones));
                let json = serde_json::to_string(&edit).expect(kind.name);
                assert!(json.starts_with(&format!(r#"{{"edit":"{}""#, kind.name)), "{json}");
                assert_eq!(serde_json::from_str::<Edit>(&json).expect(&json), edit);
            }
        }
    }

    #[test]
    fn every_kind_of_edit_can_be_applied_undone_and_redone() {
        let mut random = Random::new(seed(41));
        let bones = BONES.map(|name| BoneRef::Name(name.to_owned()));
        let before = model();
        for kind in EDITS {
            let mut applied = 0;
            for _ in 0..500 {
                let edit = (kind.arbitrary)(&mut Arbitrary::new(&mut || random.bits(), 3, &bones));
                let context = format!("{edit:?}");
                let mut model = before.clone();
                let Ok(undo) = model.apply(&edit) else {
                    assert_same(&model, &before, &context);
                    continue;
                };
                applied += 1;
                let after = model.clone();
                assert_eq!(after.check(), Ok(()), "{context}");
                let redo = model.revert(undo);
                assert_same(&model, &before, &context);
                model.revert(redo);
                assert_same(&model, &after, &context);
            }
            assert!(applied > 0, "no random {} could be applied", kind.name);
        }
    }

    #[test]
    fn the_bones_of_an_edit_are_those_whose_keys_it_changes() {
        let mut random = Random::new(seed(42));
        let names = BONES.map(|name| BoneRef::Name(name.to_owned()));
        let before = model();
        for kind in EDITS {
            for _ in 0..100 {
                let edit = (kind.arbitrary)(&mut Arbitrary::new(&mut || random.bits(), 2, &names));
                let EditedBones::Named(named) = edit.bones(before.skeleton()) else { continue };
                let mut after = before.clone();
                if after.apply(&edit).is_err() {
                    continue;
                }
                for (before, after) in before.slots().iter().zip(after.slots()) {
                    let pending = |slot: &TakeVersions, bone: u32| -> Vec<_> {
                        let poses = slot.pending().iter().filter_map(|at| Some((at.time, *at.of(bone)?)));
                        poses.collect()
                    };
                    for bone in 0..BONES.len() as u32 {
                        let keys = [before, after].map(|slot| &slot.result.tracks[bone as usize]);
                        let waiting = [before, after].map(|slot| pending(slot, bone));
                        let changed = keys[0] != keys[1] || waiting[0] != waiting[1];
                        assert!(!changed || named.contains(&bone), "{edit:?} changes bone {bone}");
                    }
                }
            }
        }
    }
}
