//! Keys that glTF cannot represent are refused, with take, bone and reason, and nothing is written.

use crate::doors::data;
use crate::fixture::Fixture;
use crate::save_support::{OpenedFile, take_mut};
use dragonfly_anim::data::{Channel, Interpolation, Take};
use dragonfly_anim::format::gltf::save::{SaveError, SourceFile, plan};
use dragonfly_anim::format::{EditedTake, NoFiles, ReadOptions};
use glam::{Quat, Vec3};
use std::sync::Arc;

fn fox() -> OpenedFile {
    OpenedFile::alone("Fox.glb", &std::fs::read(data().join("gltf/Fox.glb")).unwrap())
}

/// Returns the error of saving the fox with its second take changed.
fn refused(change: impl Fn(&mut Take)) -> String {
    let fox = fox();
    let mut takes = fox.takes();
    change(take_mut(&mut takes, 1));
    plan(&fox.source, &fox.model, &takes).map(|plan| plan.changes().clone()).unwrap_err().to_string()
}

#[test]
fn keys_that_gltf_cannot_represent_are_refused_with_their_place() {
    let moved = |times: Vec<f32>| {
        move |take: &mut Take| {
            let values = vec![Vec3::ONE; times.len()];
            take.tracks[3].translation = Channel {
                times: times.clone().into(),
                values: values.into(),
                interpolation: Interpolation::Linear,
            };
        }
    };
    let bone = fox().model.animation.skeleton.bones[3].name.clone();
    let place = format!("take \"Walk\", bone \"{bone}\", translation: ");
    for (times, reason) in [
        (vec![0.0, 1.0, 1.0], "key 2 at 1 s is not later than the key before it"),
        (vec![0.0, 2.0, 1.0], "key 2 at 1 s is not later than the key before it"),
        (vec![0.0, f32::NAN], "the time of key 1 is NaN"),
        (vec![f32::INFINITY], "the time of key 0 is inf"),
        (vec![0.0, 1e6], "key 1 is at 1000000 s, at most 86400 s"),
    ] {
        assert_eq!(refused(moved(times)), format!("{place}{reason}"));
    }
    let odd =
        refused(|take| take.tracks[3].translation = Channel::new([0.0], [Vec3::NAN], Interpolation::Linear));
    assert_eq!(odd, format!("{place}key 0 is not finite"));
    let short = refused(|take| {
        take.tracks[3].translation = Channel {
            times: [0.0, 1.0].into(),
            values: [Vec3::ONE].into(),
            interpolation: Interpolation::Linear,
        };
    });
    assert_eq!(short, format!("{place}3 numbers for 2 keys of 3"));
    let long = refused(|take| {
        take.tracks[3].rotation =
            Channel::new([0.0], [Quat::from_xyzw(0.0, 0.0, 0.0, 2.0)], Interpolation::Linear);
    });
    assert_eq!(
        long,
        format!("take \"Walk\", bone \"{bone}\", rotation: the rotation of key 0 has length 2, not 1")
    );
}

#[test]
fn takes_of_another_model_are_refused() {
    assert!(refused(|take| _ = take.tracks.pop()).contains("tracks for"));
    assert!(refused(|take| take.tracks.swap(0, 1)).contains("is for bone 1"));
    assert!(refused(|take| take.morphs = vec![morph(9, 1)]).contains("no such mesh instance"));
    assert!(refused(|take| take.morphs = vec![morph(0, 1)]).contains("1 weights for 0 targets"));
    let fox = fox();
    let other = OpenedFile::alone("other.glb", &Fixture::new().glb());
    let mismatch = plan(&fox.source, &other.model, &other.takes()).err().unwrap();
    assert!(matches!(mismatch, SaveError::Mismatch { .. }), "{mismatch}");
    let nowhere = EditedTake { origin: Some(7), take: fox.takes()[0].take.clone() };
    let mismatch = plan(&fox.source, &fox.model, &[nowhere]).err().unwrap();
    assert_eq!(mismatch.to_string(), "take \"Survey\": the file has no animation 7");
}

fn morph(instance: u32, targets: u32) -> dragonfly_anim::data::MorphTrack {
    dragonfly_anim::data::MorphTrack {
        instance,
        targets,
        times: [0.0].into(),
        weights: vec![0.0; targets as usize].into(),
        interpolation: Interpolation::Linear,
    }
}

#[test]
fn a_bone_that_is_not_a_node_is_refused() {
    let fox = fox();
    let mut model = fox.model.clone();
    let skeleton = Arc::make_mut(&mut model.animation.skeleton);
    skeleton.bones[3].node = None;
    let name = skeleton.bones[3].name.clone();
    let mut takes = fox.takes();
    take_mut(&mut takes, 0).tracks[3].scale = Channel::new([0.0], [Vec3::ONE], Interpolation::Linear);
    let error = plan(&fox.source, &model, &takes).err().unwrap();
    assert_eq!(error.to_string(), format!("take \"Survey\": \"{name}\" is not a node of the file"));
}

#[test]
fn invalid_files_are_not_opened() {
    for (bytes, reason) in [
        (b"".as_slice(), "byte 0: the text ends too early"),
        (b"{\"asset\":{}", "byte 11: the text ends too early"),
        (b"{\"a\":1,}", "byte 7: the name of a member is missing"),
        (b"\xef\xbb\xbf{\"a\":\"\xff\"}", "byte 9: the text is not UTF-8"),
        (b"glTF", "byte 4: the file ends inside its header: 4 bytes of 12"),
    ] {
        let error = SourceFile::open("x.gltf", bytes, &NoFiles, &ReadOptions::default()).err().unwrap();
        assert_eq!(error.to_string(), reason);
    }
}
