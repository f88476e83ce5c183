//! Takes: one for each animation stack, with all its layers evaluated.

use super::channel::{channel, hold, interpolation};
use super::curves::{AnimatedPart, ElementCurves, element_curves, range_of};
use super::keys::{ChannelTimes, channel_times, exactly};
use super::mesh::FbxMesh;
use super::morph::effective_weights;
use super::nodes::{BoneLayout, is_top, place_of};
use super::space::{FbxSpace, Pose64, dmat4, warn_numbers};
use crate::code::FBX_KEYS;
use crate::fit::{FitKind, FitValue, FittedKeys, KeyTime, fit};
use dragonfly_anim::data::{MeshInstance, MorphTrack, Skeleton, Take, TakeExtras, Track, Transform};
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use glam::{DQuat, DVec3};
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::sync::Arc;
use ufbx::{AnimCurve, AnimStack, Node};

/// Largest distance in meters, in the scene at rest, between a motion and its keys.
const TOLERANCE_METERS: f64 = 1e-5;

/// Largest angle between a motion and its keys: a hundredth of a degree, in radians. Small, because the errors of a chain of
/// bones add up.
const TOLERANCE_ANGLE: f64 = 0.01 * std::f64::consts::PI / 180.0;

/// Largest difference of a scale or of the weight of a morph target.
const TOLERANCE_FACTOR: f64 = 2e-4;

/// Largest number of evaluations of a motion in one import. Afterwards only the keys of the file are kept.
const EVALUATIONS: usize = 20_000_000;

/// Rotation between two keys, in degrees, that needs keys between them even if both ends look alike.
const TURN: f64 = 90.0;

/// Largest number of pieces into which a span with full turns is divided at first.
const TURN_PIECES: f64 = 4096.0;

/// A take of the file, and everything that its conversion needs.
struct StackReader<'a> {
    scene: &'a ufbx::Scene,
    space: &'a FbxSpace,
    context: &'a ImportContext<'a>,
    stack: &'a AnimStack,
    curves: ElementCurves<'a>,
    range: (f64, f64),
    evaluations: &'a Cell<usize>,
    is_coarse: Cell<bool>,
}

/// Returns the takes of the file in its order.
pub(super) fn takes(
    scene: &ufbx::Scene,
    space: &FbxSpace,
    layout: &BoneLayout,
    skeleton: &Skeleton,
    instances: &[MeshInstance],
    meshes: &[FbxMesh],
    context: &ImportContext<'_>,
) -> Result<Vec<Arc<Take>>, ImportError> {
    let count = scene.anim_stacks.len();
    let mut takes = context.vec(&Place::Pointer("/takes".to_owned()), count)?;
    let evaluations = Cell::new(EVALUATIONS);
    for (number, stack) in scene.anim_stacks.into_iter().enumerate() {
        let curves = element_curves(stack, context)?;
        let range = range_of(stack, &curves);
        let is_coarse = Cell::new(false);
        let reader =
            StackReader { scene, space, context, stack, curves, range, evaluations: &evaluations, is_coarse };
        takes.push(Arc::new(reader.take(layout, skeleton, instances, meshes)?));
        if reader.is_coarse.get() {
            let place = Place::Pointer(format!("/takes/{}", &*stack.element.name));
            let text =
                "some motion is too fast or too long to be followed exactly between the keys of the file";
            context.warn(place, FBX_KEYS, text);
        }
        context.progress(0.7 + 0.25 * (number + 1) as f32 / count as f32)?;
    }
    Ok(takes)
}

/// Tolerances of one node in the units of the file.
struct Tolerances {
    translation: f64,
    rotation: f64,
    scale: f64,
}

impl StackReader<'_> {
    fn take(
        &self,
        layout: &BoneLayout,
        skeleton: &Skeleton,
        instances: &[MeshInstance],
        meshes: &[FbxMesh],
    ) -> Result<Take, ImportError> {
        let place = Place::Pointer("/takes".to_owned());
        let mut tracks = self.context.vec(&place, skeleton.len())?;
        let mut first_moving = None;
        for (bone, (&node, rest)) in layout.nodes.iter().zip(&skeleton.bones).enumerate() {
            self.context.work(1)?;
            let node = &self.scene.nodes[node as usize];
            let mut track = Track { bone: bone as u32, ..Track::default() };
            if self.fill(node, &rest.rest, &mut track)? {
                first_moving = first_moving.or(Some(bone));
            }
            tracks.push(track);
        }
        let morphs = self.morph_tracks(instances, meshes)?;
        let name = self.stack.element.name.to_string();
        let mut take = Take { name, start: 0.0, length: 0.0, tracks, morphs, extras: TakeExtras::default() };
        if let Some(bone) = first_moving {
            self.cover(&mut take, bone, &skeleton.bones[bone].rest);
        }
        if let Some((start, end)) = take.range_of_keys() {
            (take.start, take.length) = (start, end - start);
        }
        Ok(take)
    }

    /// Adds keys that hold the pose of a bone, if the take would be shorter than its curves: of constant curves no key is
    /// kept.
    fn cover(&self, take: &mut Take, bone: usize, rest: &Transform) {
        let keys = self.curves.values().flatten().filter_map(|(_, curve)| *curve);
        let keys = keys.filter(|curve| !curve.keyframes.is_empty());
        let within = |time: f64| exactly(time.clamp(self.range.0, self.range.1)).key;
        let needed = keys.map(|curve| (within(curve.min_time), within(curve.max_time)));
        let Some((start, end)) = needed.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else { return };
        if take.range_of_keys().is_some_and(|(first, last)| first <= start && last >= end) || start >= end {
            return;
        }
        let track = &mut take.tracks[bone];
        for channel in [0, 1, 2] {
            match channel {
                0 if track.translation.len() < 2 => {
                    return hold(&mut track.translation, rest.translation, start, end);
                }
                1 if track.rotation.len() < 2 => return hold(&mut track.rotation, rest.rotation, start, end),
                2 if track.scale.len() < 2 => return hold(&mut track.scale, rest.scale, start, end),
                _ => {}
            }
        }
    }

    /// Samples a node. Returns whether the take animates it.
    fn fill(&self, node: &Node, rest: &Transform, track: &mut Track) -> Result<bool, ImportError> {
        let mut curves: Vec<(AnimatedPart, Option<&AnimCurve>)> = Vec::new();
        if let Some(own) = self.curves.get(&node.element.element_id) {
            curves.extend(own.iter().filter(|(target, _)| *target != AnimatedPart::Weight));
        }
        self.add_helpers(node, &mut curves);
        if curves.is_empty() {
            return Ok(false);
        }
        let pivots = has_pivots(node);
        let of = |targets: &[AnimatedPart]| -> Vec<&AnimCurve> {
            let wanted = curves.iter().filter(|(target, _)| targets.contains(target));
            wanted.filter_map(|(_, curve)| *curve).filter(|curve| !curve.keyframes.is_empty()).collect()
        };
        use AnimatedPart::{Pose, Rotation, Scale, Translation};
        // Parts that the take does not move rest: `ufbx` 0.11.5 may evaluate them as those of another node.
        let moves = |targets: &[AnimatedPart]| curves.iter().any(|(target, _)| targets.contains(target));
        let parts: &[AnimatedPart] =
            if pivots { &[Translation, Rotation, Scale, Pose] } else { &[Translation, Pose] };
        let is_moved = [moves(parts), moves(&[Rotation, Pose]), moves(&[Scale])];
        let translation = of(parts);
        let (rotation, scale) = (of(&[Rotation, Pose]), of(&[Scale]));
        let top = is_top(node);
        let tolerances = self.tolerances(node);
        let known: RefCell<HashMap<u64, Pose64>> = RefCell::default();
        let pose = |at: f64| self.pose(node, at, &known);
        let space = self.space;

        if is_moved[0] {
            let times = self.times(&translation)?;
            let mut sample = |at| Ok(pose(at)?.map(|pose| pose.translation));
            let keys = self.fit(&times, tolerances.translation, &mut sample)?;
            let convert = |value: &DVec3| space.translation(*value, top);
            track.translation = channel(&keys, times.kind, &rest.translation, convert, convert);
        }
        if is_moved[1] {
            let mut times = self.times(&rotation)?;
            if times.kind == FitKind::Smooth {
                self.divide_turns(node, &mut times)?;
            }
            let keys =
                self.fit(&times, tolerances.rotation, &mut |at| Ok(pose(at)?.map(|pose| pose.rotation)))?;
            let value = |value: &DQuat| space.rotation(*value, top).normalize();
            track.rotation =
                channel(&keys, times.kind, &rest.rotation, value, |value| space.rotation(*value, top));
        }
        if is_moved[2] {
            let times = self.times(&scale)?;
            let keys = self.fit(&times, tolerances.scale, &mut |at| Ok(pose(at)?.map(|pose| pose.scale)))?;
            let convert = |value: &DVec3| space.factors(*value);
            track.scale = channel(&keys, times.kind, &rest.scale, convert, convert);
        }
        self.context.charge(&Place::File, 64 * track.keys() as u64)?;
        Ok(true)
    }

    /// Adds the curves of scale helpers on which the pose of a node depends.
    fn add_helpers<'b>(&'b self, node: &Node, curves: &mut Vec<(AnimatedPart, Option<&'b AnimCurve>)>) {
        let Some(parent) = &node.parent else { return };
        let mut add = |helper: &Node, target: AnimatedPart| {
            let own = self.curves.get(&helper.element.element_id).into_iter().flatten();
            curves.extend(
                own.filter(|(target, _)| *target == AnimatedPart::Scale).map(|(_, curve)| (target, *curve)),
            );
        };
        if let Some(helper) = parent.scale_helper.as_ref().filter(|_| !node.is_scale_helper) {
            add(helper, AnimatedPart::Translation);
        }
        let mut ancestor = parent.inherit_scale_node.as_deref();
        let mut left = self.scene.nodes.len();
        while let Some(node_above) = ancestor.filter(|_| left > 0) {
            left -= 1;
            if let Some(helper) = &node_above.scale_helper {
                add(
                    helper,
                    if node.is_scale_helper { AnimatedPart::Scale } else { AnimatedPart::Translation },
                );
            }
            ancestor = node_above.inherit_scale_node.as_deref();
        }
    }

    /// Returns the pose of a node at a time; `None` when the work of this import is used up.
    fn pose(
        &self,
        node: &Node,
        at: f64,
        known: &RefCell<HashMap<u64, Pose64>>,
    ) -> Result<Option<Pose64>, ImportError> {
        if let Some(pose) = known.borrow().get(&at.to_bits()) {
            return Ok(Some(*pose));
        }
        if !self.evaluate()? {
            return Ok(None);
        }
        let (pose, is_fixed) = Pose64::of(&ufbx::evaluate_transform(&self.stack.anim, node, at));
        if is_fixed {
            warn_numbers(place_of(node), self.context);
        }
        self.context.charge(&Place::File, 2 * (size_of::<Pose64>() + 8) as u64)?;
        known.borrow_mut().insert(at.to_bits(), pose);
        Ok(Some(pose))
    }

    /// Counts one evaluation. Returns whether it may be done.
    fn evaluate(&self) -> Result<bool, ImportError> {
        self.context.work(64)?;
        let left = self.evaluations.get();
        self.evaluations.set(left.saturating_sub(1));
        Ok(left > 0)
    }

    fn times(&self, curves: &[&AnimCurve]) -> Result<ChannelTimes, ImportError> {
        channel_times(curves, self.range, self.context)
    }

    fn fit<V: FitValue>(
        &self,
        times: &ChannelTimes,
        tolerance: f64,
        sample: &mut dyn FnMut(f64) -> Result<Option<V>, ImportError>,
    ) -> Result<FittedKeys<V>, ImportError> {
        let keys = fit(&times.times, times.kind, tolerance, sample)?;
        self.is_coarse.set(self.is_coarse.get() || keys.is_coarse);
        Ok(keys)
    }

    /// Returns the tolerances of a node: a distance in its parent's space is larger in the scene if the parent is scaled.
    fn tolerances(&self, node: &Node) -> Tolerances {
        let scale = node.parent.as_ref().map_or(1.0, |parent| {
            let matrix = dmat4(&parent.node_to_world);
            let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
            axes.iter().map(|axis| axis.length()).fold(0.0, f64::max)
        });
        let units = self.space.meters() * if scale.is_finite() { scale.max(1e-9) } else { 1.0 };
        Tolerances {
            translation: TOLERANCE_METERS / units,
            rotation: TOLERANCE_ANGLE,
            scale: TOLERANCE_FACTOR,
        }
    }

    /// Adds times where a node turns so far between two keys that the ends do not show which way.
    fn divide_turns(&self, node: &Node, times: &mut ChannelTimes) -> Result<(), ImportError> {
        let mut more = Vec::new();
        for pair in times.times.windows(2) {
            let [start, end] = [pair[0], pair[1]];
            let mut travel = 0.0;
            let mut last = None;
            // Also inside, since a curve can return to where it starts.
            for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
                if !self.evaluate()? {
                    return Ok(());
                }
                let at = start.at + (end.at - start.at) * part;
                let property = ufbx::evaluate_prop(&self.stack.anim, &node.element, "Lcl Rotation", at);
                let angles = property.value_vec4;
                let angles = DVec3::new(angles.x, angles.y, angles.z);
                travel += last.map_or(0.0, |last: DVec3| (angles - last).abs().element_sum());
                last = Some(angles);
            }
            if travel > TURN {
                let pieces = (travel / TURN).ceil().clamp(2.0, TURN_PIECES);
                let inner = (1..pieces as u32)
                    .map(|piece| exactly(start.at + (end.at - start.at) * f64::from(piece) / pieces));
                let inner: Vec<KeyTime> =
                    inner.filter(|time| time.key > start.key && time.key < end.key).collect();
                self.context.charge(&Place::File, (inner.len() * size_of::<KeyTime>()) as u64)?;
                more.extend(inner);
            }
        }
        times.times.extend(more);
        times.times.sort_by(|a, b| a.key.total_cmp(&b.key));
        times.times.dedup_by(|next, kept| next.key == kept.key);
        Ok(())
    }

    /// Returns the weights of morph targets over time, for every instance whose mesh has animated ones.
    fn morph_tracks(
        &self,
        instances: &[MeshInstance],
        meshes: &[FbxMesh],
    ) -> Result<Vec<MorphTrack>, ImportError> {
        let mut tracks: Vec<MorphTrack> = Vec::new();
        for (number, instance) in instances.iter().enumerate() {
            self.context.work(1)?;
            let same = tracks.iter().find(|track| instances[track.instance as usize].mesh == instance.mesh);
            let track = match same.cloned() {
                Some(track) => Some(MorphTrack { instance: number as u32, ..track }),
                None => self.morph_track(
                    number,
                    &self.scene.meshes[instance.mesh as usize],
                    &meshes[instance.mesh as usize],
                )?,
            };
            tracks.extend(track);
        }
        Ok(tracks)
    }

    fn morph_track(
        &self,
        instance: usize,
        mesh: &ufbx::Mesh,
        read: &FbxMesh,
    ) -> Result<Option<MorphTrack>, ImportError> {
        let channels: Vec<_> =
            mesh.blend_deformers.into_iter().flat_map(|deformer| &deformer.channels).collect();
        let animated = |channel: &&ufbx::BlendChannel| self.curves.get(&channel.element.element_id);
        let curves = channels.iter().filter_map(animated).flatten().filter_map(|(_, curve)| *curve);
        let curves: Vec<&AnimCurve> = curves.filter(|curve| !curve.keyframes.is_empty()).collect();
        if curves.is_empty() || read.shapes.is_empty() {
            return Ok(None);
        }
        let times = self.times(&curves)?;
        let mut sample = |at: f64| {
            if !self.evaluate()? {
                return Ok(None);
            }
            self.context.work(channels.len())?;
            let weights = channels.iter().flat_map(|channel| {
                effective_weights(channel, ufbx::evaluate_blend_weight(&self.stack.anim, channel, at))
            });
            Ok(Some(weights.collect::<Vec<f64>>()))
        };
        let keys = self.fit(&times, TOLERANCE_FACTOR, &mut sample)?;
        let targets = read.shapes.len();
        self.context.charge(&Place::File, 16 * (keys.times.len() * targets) as u64)?;
        let mut weights: Vec<f32> = Vec::new();
        for (key, values) in keys.values.iter().enumerate() {
            let narrow = |values: &[f64]| values.iter().map(|&value| value as f32).collect::<Vec<f32>>();
            match keys.tangents.get(key) {
                Some([arrives, leaves]) => {
                    weights.extend([narrow(arrives), narrow(values), narrow(leaves)].concat())
                }
                None => weights.extend(narrow(values)),
            }
        }
        Ok(Some(MorphTrack {
            instance: instance as u32,
            targets: targets as u32,
            interpolation: interpolation(&keys, times.kind),
            times: keys.times.into(),
            weights: weights.into(),
        }))
    }
}

/// Returns whether the translation of a node depends on its rotation and scale.
fn has_pivots(node: &Node) -> bool {
    let pivots = ["RotationPivot", "ScalingPivot", "ScalingOffset"];
    let is_zero = |vector: &ufbx::Vec4| vector.x == 0.0 && vector.y == 0.0 && vector.z == 0.0;
    pivots
        .iter()
        .any(|name| node.element.props.find_prop(name).is_some_and(|prop| !is_zero(&prop.value_vec4)))
}
