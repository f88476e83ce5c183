//! Takes: a stack with one layer for each.

use super::curves::{AnimatedProperty, CurveKeys, rotation_keys, vector_keys, weight_keys};
use super::losses::FbxLosses;
use super::node::{FbxNode, setting};
use super::preset::KeyStyle;
use super::scene::{ObjectId, SceneWriter, WrittenTake, ticks};
use super::space::FileSpace;
use dragonfly_anim::data::{Channel, Interpolation, ModelData, MorphTrack, Take};
use glam::Quat;

/// The objects to which the takes of a file refer.
pub(super) struct TakeSource<'a> {
    pub(super) model: &'a ModelData,
    pub(super) space: &'a FileSpace,
    pub(super) keys: KeyStyle,
    /// Node of each bone.
    pub(super) bones: &'a [ObjectId],
    /// Channels of the shapes of each instance.
    pub(super) shapes: &'a [Vec<ObjectId>],
}

/// Names of the curves of a vector.
const XYZ: [&str; 3] = ["X", "Y", "Z"];

impl TakeSource<'_> {
    /// Adds all takes under these names.
    pub(super) fn add(&self, scene: &mut SceneWriter, names: Vec<String>, losses: &mut FbxLosses) {
        for (index, (take, name)) in self.model.animation.takes.iter().zip(names).enumerate() {
            self.add_take(scene, index, take, name, losses);
        }
    }

    fn add_take(
        &self,
        scene: &mut SceneWriter,
        index: usize,
        take: &Take,
        name: String,
        losses: &mut FbxLosses,
    ) {
        let place = format!("/animation/takes/{index}");
        if !take.extras.is_empty() {
            losses.add(format!("{place}/extras"), "layers, contacts and events are not stored");
        }
        let (start, end) = take.range_of_keys().unwrap_or((take.start, take.end()));
        let (start, stop) = (ticks(f64::from(start)), ticks(f64::from(end)));
        let time = |name: &str, value: i64| setting(name, "KTime", "Time", "").with(value);
        let properties = FbxNode::new("Properties70").containing([
            time("LocalStart", start),
            time("LocalStop", stop),
            time("ReferenceStart", start),
            time("ReferenceStop", stop),
        ]);
        let stack = scene.object("AnimationStack", &name, ("AnimStack", ""), [properties]);
        // Blender names actions after both unless they are the same.
        let layer = scene.object("AnimationLayer", &name, ("AnimLayer", ""), []);
        scene.connect(layer, stack);
        scene.takes.push(WrittenTake { name, start, stop });
        let mut is_coarse = false;
        let mut add = |scene: &mut SceneWriter, object, property, name, parts: &[&str], keys: &CurveKeys| {
            is_coarse |= keys.is_coarse;
            AnimatedProperty { object, property, name, parts }.add(scene, layer, keys);
        };
        for track in &take.tracks {
            let Some(&bone) = self.bones.get(track.bone as usize) else { continue };
            let (style, space) = (self.keys, self.space);
            if !track.translation.is_empty() {
                let keys = vector_keys(&track.translation, style, true, |value| space.position(value));
                add(scene, bone, "Lcl Translation", "T", &XYZ, &keys);
            }
            // Every bone that moves has curves of its rotation: `ufbx` 0.11.5 takes the translation of a bone without one from the
            // next bone if that has no rotation either.
            let rest = self.model.animation.skeleton.bones.get(track.bone as usize);
            let held = Channel::new(
                [take.start],
                [rest.map_or(Quat::IDENTITY, |bone| bone.rest.rotation)],
                Interpolation::Linear,
            );
            if !track.is_empty() {
                let rotation = if track.rotation.is_empty() { &held } else { &track.rotation };
                let keys = rotation_keys(rotation, style, |value| space.rotation(value));
                add(scene, bone, "Lcl Rotation", "R", &XYZ, &keys);
            }
            if !track.scale.is_empty() {
                let keys = vector_keys(&track.scale, style, false, |value| space.factors(value));
                add(scene, bone, "Lcl Scaling", "S", &XYZ, &keys);
            }
            list_moved_keys(track, &place, losses);
        }
        for morph in &take.morphs {
            let shapes = self.shapes.get(morph.instance as usize).map_or(&[][..], |shapes| shapes);
            if weights_below_zero(morph) {
                losses.add(
                    format!("{place}/morphs"),
                    "weights below zero are stored, but most programs show none",
                );
            }
            for (target, &shape) in shapes.iter().enumerate().take(morph.targets as usize) {
                let keys = weight_keys(&weights_of(morph, target), self.keys);
                add(scene, shape, "DeformPercent", "DeformPercent", &["DeformPercent"], &keys);
            }
        }
        if is_coarse {
            let text = "some rotation is too fast to be followed exactly by angles";
            losses.add(format!("{place}/tracks"), text);
        }
    }
}

/// Lists keys that are stored at other times.
fn list_moved_keys(track: &dragonfly_anim::data::Track, place: &str, losses: &mut FbxLosses) {
    let kinds = [track.translation.interpolation, track.rotation.interpolation, track.scale.interpolation];
    let is_used = [!track.translation.is_empty(), !track.rotation.is_empty(), !track.scale.is_empty()];
    if kinds.iter().zip(is_used).any(|(kind, used)| used && *kind == Interpolation::Closest) {
        let text = "keys of which the closest one applies are stored as steps half way between them";
        losses.add(format!("{place}/tracks"), text);
    }
}

fn weights_below_zero(morph: &MorphTrack) -> bool {
    (0..morph.targets as usize).any(|target| {
        let weights = weights_of(morph, target);
        (0..weights.len()).any(|key| weights.value(key).is_some_and(|weight| weight < -1e-6))
    })
}

/// Returns the weights of one target.
fn weights_of(morph: &MorphTrack, target: usize) -> Channel<f32> {
    let targets = morph.targets as usize;
    let rows = if morph.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let values = (0..morph.times.len() * rows)
        .map(|row| morph.weights.get(row * targets + target).copied().unwrap_or(0.0));
    let values: Vec<f32> = values.collect();
    Channel { times: morph.times.clone(), values: values.into(), interpolation: morph.interpolation }
}
