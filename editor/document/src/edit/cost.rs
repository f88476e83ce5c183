//! Estimates of the time that an edit takes, so that a sender knows whether it can carry it out on a copy between two frames.
//!
//! The unit is the time to remove one key and insert it elsewhere: 100 to 200 ns, also where the previous edit of the
//! same drag is undone first. Columns are copied as a whole where one of their keys changes: 2 to 10 ns per key. Keys that keep
//! their order are cheaper than estimated. `benches/editor/edits.rs` measures all three.

use super::{EditedBones, KeySet, Property, TakeRef};
use crate::adapter::{ModelAdapter, TakeVersions};

/// Number of keys that are copied with their columns in the time of one that is taken out and inserted elsewhere.
const COPIED: usize = 16;

/// Cost of giving a bone a pose at one time: a key of each of its channels is found and computed. Repeated edits of a drag change
/// their columns in place.
const POSE: usize = 6;

/// Returns the cost of giving this many poses.
pub(super) fn of_poses(poses: usize) -> usize {
    poses * POSE
}

/// Returns the cost of copying the columns of `bones`; `None` where a take changes as a whole.
pub(super) fn of_columns(adapter: &ModelAdapter, take: &TakeRef, bones: &EditedBones) -> Option<usize> {
    let slot = adapter.take(take).ok();
    let keys = |bone: u32| slot.map_or(0, |slot| keys_of_bone(slot, bone));
    let keys: usize = match bones {
        EditedBones::WholeTake => return None,
        EditedBones::All => slot.map_or(0, |slot| slot.original.keys()),
        EditedBones::Named(bones) => bones.iter().map(|&bone| keys(bone)).sum(),
    };
    Some(keys.div_ceil(COPIED))
}

/// Returns the cost of computing the keys that layers give over those of `bones`, which an edit of a layer or of the take
/// below it needs; zero for a take without layers.
pub(super) fn of_flattening(adapter: &ModelAdapter, take: &TakeRef, bones: &EditedBones) -> usize {
    let Some(base) = adapter.base(take).ok().filter(|base| !base.layers().is_empty()) else { return 0 };
    match bones {
        EditedBones::WholeTake | EditedBones::All => base.original.keys(),
        EditedBones::Named(bones) => bones.iter().map(|&bone| keys_of_bone(base, bone)).sum(),
    }
}

/// Returns the cost of reading `times` each key of the channels of `bones`, as filters do; `None` where a take changes as a whole.
pub(super) fn of_reading(
    adapter: &ModelAdapter,
    take: &TakeRef,
    bones: &EditedBones,
    times: usize,
) -> Option<usize> {
    let columns = of_columns(adapter, take, bones)?;
    Some(columns.saturating_mul(times))
}

/// Returns the cost of copying the weights of all shape keys of a take.
pub(super) fn of_shapes(adapter: &ModelAdapter, take: &TakeRef) -> usize {
    let morphs = adapter.take(take).map_or(&[][..], |slot| &slot.original.morphs);
    let numbers: usize = morphs.iter().map(|track| track.weights.len()).sum();
    // A key of a bone has about four numbers.
    POSE + numbers.div_ceil(4 * COPIED)
}

fn keys_of_bone(slot: &TakeVersions, bone: u32) -> usize {
    let Some(track) = slot.original.tracks.get(bone as usize) else { return 0 };
    track.translation.len() + track.rotation.len() + track.scale.len()
}

/// Returns the number of keys of `sets`; a key of several sets counts several times.
pub(super) fn of_keys(adapter: &ModelAdapter, take: &TakeRef, sets: &[KeySet]) -> usize {
    let Ok(slot) = adapter.take(take) else { return 0 };
    let of_set = |set: &KeySet| -> usize {
        let of_bone = |bone: u32| -> usize {
            let named = |property: &Property| set.properties.is_empty() || set.properties.contains(property);
            let times = Property::ALL.into_iter().filter(named).map(|property| slot.times(bone, property));
            times.map(|times| keys_of_set(times, set)).sum()
        };
        let tracks = slot.original.tracks.len() as u32;
        if set.bones.is_empty() {
            return (0..tracks).map(of_bone).sum();
        }
        let bones = set.bones.iter().filter_map(|bone| bone.find_in(adapter.skeleton()));
        bones.filter(|&bone| bone < tracks).map(of_bone).sum()
    };
    sets.iter().map(of_set).sum()
}

/// Returns an upper bound for the number of ascending `times` that belong to a set.
fn keys_of_set(times: &[f32], set: &KeySet) -> usize {
    let begin = set.from.map_or(0, |from| times.partition_point(|&time| time < from));
    let end = set.to.map_or(times.len(), |to| times.partition_point(|&time| time <= to));
    let range = end.saturating_sub(begin);
    set.at.as_ref().map_or(range, |at| at.len().min(range))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit::{
        BonePose, BoneRef, CurveFilter, Edit, FilterKeys, MoveKeys, PoseAt, ReverseTake, SetPoses,
    };
    use crate::{Cancel, Source, load_model};

    fn built_in() -> ModelAdapter {
        let loaded =
            load_model(&Source::BuiltIn, &mut |_| {}, &Cancel::default()).expect("part of the program");
        ModelAdapter::new(&loaded.model.animation)
    }

    fn moved(keys: KeySet) -> Edit {
        Edit::MoveKeys(MoveKeys { take: TakeRef::Index(0), keys: vec![keys], shapes: Vec::new(), by: 0.1 })
    }

    #[test]
    fn moved_keys_cost_more_than_keys_that_are_copied_with_them() {
        let model = built_in();
        let keys = model.slots()[0].original.keys();
        assert_eq!(moved(KeySet::default()).cost(&model), Some(keys + keys.div_ceil(COPIED)));
        let none = KeySet { from: Some(1e6), ..KeySet::default() };
        assert_eq!(moved(none).cost(&model), Some(keys.div_ceil(COPIED)));
    }

    #[test]
    fn the_cost_of_an_edit_of_one_bone_counts_only_the_keys_of_that_bone() {
        let model = built_in();
        let bones = vec![BoneRef::Index(1)];
        let of_bone = keys_of_bone(&model.slots()[0], 1);
        assert_eq!(
            moved(KeySet { bones, ..KeySet::default() }).cost(&model),
            Some(of_bone + of_bone.div_ceil(COPIED))
        );
    }

    #[test]
    fn an_edit_of_a_layer_costs_as_much_as_the_keys_below_it_are_many() {
        let mut model = built_in();
        let pose = |take: TakeRef| {
            let bone = BoneRef::Index(1);
            let pose =
                BonePose { bone, translation: None, rotation: Some([0.0, 0.0, 0.0, 1.0]), scale: None };
            Edit::SetPose(crate::edit::SetPose { take, time: 0.0, poses: vec![pose], unstep: false })
        };
        let below = keys_of_bone(&model.slots()[0], 1);
        let before = pose(TakeRef::Index(0)).cost(&model).expect("a quick edit");
        let layer = r#"{"edit":"add_layer","take":0,"name":"up"}"#;
        model.apply(&serde_json::from_str(layer).expect("an edit")).expect("a new layer");
        let layer: TakeRef = serde_json::from_str(r#"{"take":0,"layer":0}"#).expect("a layer");
        assert!(below > 0);
        assert_eq!(pose(layer).cost(&model), Some(before + below));
        assert_eq!(pose(TakeRef::Index(0)).cost(&model), Some(before + below), "the take below it");
        assert_eq!(pose(TakeRef::Index(1)).cost(&model), Some(before), "a take without layers");
    }

    #[test]
    fn a_filter_costs_more_the_more_keys_it_reads_and_the_wider_it_is() {
        let model = built_in();
        let filter = |bones: Vec<BoneRef>, sigma: f32| {
            let keys = vec![KeySet { bones, ..KeySet::default() }];
            let (take, shapes, filter) = (TakeRef::Index(0), Vec::new(), CurveFilter::Gaussian(sigma));
            Edit::FilterKeys(FilterKeys { take, keys, shapes, filter, rate: None, hold: Vec::new() })
                .cost(&model)
        };
        let (one, all) = (filter(vec![BoneRef::Index(1)], 0.1), filter(Vec::new(), 0.1));
        assert!(one.is_some() && one < all && all < filter(Vec::new(), 1.0), "{one:?} {all:?}");
        assert!(all.is_some_and(|cost| cost >= 2 * model.slots()[0].original.keys()));
    }

    #[test]
    fn the_cost_of_poses_is_their_number_and_an_edit_of_a_whole_take_has_no_cost() {
        let model = built_in();
        let pose =
            BonePose { bone: BoneRef::Index(1), translation: Some([0.0; 3]), rotation: None, scale: None };
        let at = vec![PoseAt { time: 0.0, poses: vec![pose; 3] }; 5];
        let take = || TakeRef::Index(0);
        let poses = Edit::SetPoses(SetPoses { take: take(), at, unstep: false });
        assert_eq!(poses.cost(&model), Some(15 * POSE));
        assert_eq!(Edit::ReverseTake(ReverseTake { take: take() }).cost(&model), None);
    }
}
