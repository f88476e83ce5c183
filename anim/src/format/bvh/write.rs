//! Writes a BVH file of any model: the skeleton in its rest pose, and the first take at its frames.

use super::angles::angles;
use super::channel::{BvhChannel, CHANNELS, ChannelList};
use super::check as code;
use super::common_root;
use super::sampled::FramePoses;
use super::save::spelled;
use super::unit;
use crate::data::{ModelData, Skeleton};
use crate::format::losses::Losses;
use crate::format::names::UniqueNames;
use crate::format::{ExportError, WholeFile};
use crate::model_unit::longest_way;
use glam::DVec3;
use std::fmt::Write;

/// Units of the file per meter: centimeters, as most programs expect.
const UNITS_PER_METER: f64 = 100.0;

/// Distance in meters by which a bone moves in its parent before it gets position channels.
const MOVES: f64 = 1e-5;

/// Text of a number that has the usual number of decimals.
const SIX_DECIMALS: &[u8] = b"0.000000";

/// Writes a model as a BVH file: the skeleton and the first take, at the lowest usual frame rate that has its
/// keys, or at the double of it, up to 240, until bones are within 0.1 % of the size of the figure of their curves between frames.
///
/// Lengths are in centimeters. The rest pose of a BVH file has no rotations: the joints have the axes of the scene, and are
/// at rest where the bones are at rest, as in the files that Blender writes. Every joint rotates about z, x and y; roots,
/// and bones that move in their parent, also have position channels. Several roots are below one more joint, since most programs
/// read one root only; [`BVH`](super::BVH) leaves it out. The origins of all joints are those of the bones in every
/// frame, whatever scale the bones have.
///
/// Errors: the take has more than [`MOST_POSES`](crate::frames::MOST_POSES) poses.
pub fn write(model: &ModelData) -> Result<WholeFile, ExportError> {
    let skeleton = &model.animation.skeleton;
    if skeleton.is_empty() {
        return Err(ExportError::new("the model has no bone, and a BVH file consists of bones"));
    }
    let mut losses = Losses::default();
    list_losses(model, &mut losses);
    let take = FramePoses::of(model.animation.takes.first().map(AsRef::as_ref), skeleton, &mut losses)
        .map_err(ExportError::new)?;
    let tree = JointTree::of(skeleton, &take, &mut losses);
    let mut text = String::from("HIERARCHY\n");
    tree.write_hierarchy(skeleton, &take, &mut losses, &mut text);
    let (frames, seconds) = (take.frames(), 1.0 / take.rate());
    let _ = write!(text, "MOTION\nFrames: {frames}\nFrame Time: {}\n", spelled(seconds, b"0.0000000000"));
    let mut last = vec![[0.0; CHANNELS]; skeleton.len()];
    for frame in 0..frames {
        tree.write_row(&take, frame, &mut last, &mut text);
    }
    Ok(WholeFile { bytes: text.into_bytes(), lost: losses.into_list_of(model) })
}

/// Lists what a BVH file has no room for.
fn list_losses(model: &ModelData, losses: &mut Losses) {
    if !model.meshes.is_empty() {
        let text = "only bones are stored: no meshes, skins, materials and images";
        losses.add("/meshes".to_owned(), code::MESHES_NOT_STORED, text);
    }
    for (index, take) in model.animation.takes.iter().enumerate() {
        let path = format!("/animation/takes/{index}");
        if index > 0 {
            let text = format!("take \"{}\": a BVH file has one take", take.name);
            losses.add(path, code::TAKE_NOT_STORED, text);
            continue;
        }
        if !take.extras.is_empty() {
            let text = "layers, contacts and events are not stored";
            losses.add(format!("{path}/extras"), code::EXTRAS_NOT_STORED, text);
        }
        if !take.morphs.is_empty() {
            losses.add(
                format!("{path}/morphs"),
                code::MORPHS_NOT_STORED,
                "weights of shape keys are not stored",
            );
        }
        if take.tracks.iter().any(|track| !track.scale.is_empty()) {
            let text = "bones have no scale; only the positions of the bones below follow it";
            losses.add(format!("{path}/tracks"), code::SCALE_NOT_STORED, text);
        }
    }
}

/// The bones in the order of the file.
struct JointTree {
    /// Bones with their depth, each parent before its children and each branch as a whole.
    order: Vec<(usize, usize)>,
    /// Channels of each bone; none for one that is written as an end site.
    channels: Vec<ChannelList>,
    is_end: Vec<bool>,
    has_children: Vec<bool>,
    /// Whether all roots are below one more joint.
    has_common_root: bool,
}

impl JointTree {
    fn of(skeleton: &Skeleton, take: &FramePoses, losses: &mut Losses) -> Self {
        let count = skeleton.len();
        let mut children = vec![Vec::new(); count];
        let has_common_root = common_root::is_needed(skeleton, losses);
        let mut pending = Vec::new();
        for (index, bone) in skeleton.bones.iter().enumerate().rev() {
            match bone.parent {
                Some(parent) => children[parent as usize].push(index),
                None => pending.push((index, usize::from(has_common_root))),
            }
        }
        let is_end: Vec<bool> = (0..count).map(|bone| is_end_site(skeleton, take, bone, &children)).collect();
        let mut order = Vec::with_capacity(count);
        while let Some((bone, depth)) = pending.pop() {
            order.push((bone, depth));
            pending.extend(children[bone].iter().map(|&child| (child, depth + 1)));
        }
        let channels = |bone: usize| match is_end[bone] {
            true => ChannelList::default(),
            false => ChannelList::usual(skeleton.bones[bone].parent.is_none() || take.moves(bone, MOVES)),
        };
        let channels = (0..count).map(channels).collect();
        let has_children = children.iter().map(|children| !children.is_empty()).collect();
        Self { order, channels, is_end, has_children, has_common_root }
    }

    fn write_hierarchy(
        &self,
        skeleton: &Skeleton,
        take: &FramePoses,
        losses: &mut Losses,
        text: &mut String,
    ) {
        let mut names = UniqueNames::default();
        names.make(common_root::NAME.to_owned());
        let mut open = 0;
        if self.has_common_root {
            text.push_str(common_root::LINES);
            open = 1;
        }
        for &(bone, depth) in &self.order {
            close(text, &mut open, depth);
            let tabs = "\t".repeat(depth);
            let offset = take.offset(bone);
            if self.is_end[bone] {
                let _ = writeln!(text, "{tabs}End Site\n{tabs}{{\n{tabs}\tOFFSET {}", vector(offset));
                open = depth + 1;
                continue;
            }
            let own = &skeleton.bones[bone].name;
            let (name, is_new) = names.make(possible(own));
            if !is_new || name != *own {
                let reason = format!("the bone \"{own}\" is called \"{name}\"");
                losses.add(format!("/animation/skeleton/bones/{bone}/name"), code::NAME_NOT_STORED, reason);
            }
            let word = if depth == 0 { "ROOT" } else { "JOINT" };
            let _ = writeln!(text, "{tabs}{word} {name}\n{tabs}{{\n{tabs}\tOFFSET {}", vector(offset));
            let channels = &self.channels[bone];
            let _ = write!(text, "{tabs}\tCHANNELS {}", channels.len());
            for channel in channels.iter() {
                let (axis, kind) = match channel {
                    BvhChannel::Position(axis) => (axis, "position"),
                    BvhChannel::Rotation(axis) => (axis, "rotation"),
                };
                let _ = write!(text, " {}{kind}", ["X", "Y", "Z"][axis]);
            }
            text.push('\n');
            if !self.has_children[bone] {
                // A tip, half as far from the joint as the joint is from its parent: many programs need one.
                let tip = vector(offset * 0.5);
                let _ = writeln!(text, "{tabs}\tEnd Site\n{tabs}\t{{\n{tabs}\t\tOFFSET {tip}\n{tabs}\t}}");
            }
            open = depth + 1;
        }
        close(text, &mut open, 0);
        let way = self.longest_way(skeleton, take);
        if (f64::from(unit::guess(way * UNITS_PER_METER)) * UNITS_PER_METER - 1.0).abs() > 1e-3 {
            let text = "lengths are in centimeters, which the file does not contain, and the figure is not as large as a human";
            losses.add("/animation/skeleton".to_owned(), code::UNIT_NOT_STORED, text);
        }
    }

    /// Returns the length in meters of the longest way along the bones.
    fn longest_way(&self, skeleton: &Skeleton, take: &FramePoses) -> f64 {
        let parents = skeleton.bones.iter().map(|bone| bone.parent.map(|parent| parent as usize));
        longest_way(parents.enumerate().map(|(bone, parent)| (parent, take.offset(bone).length())))
    }

    fn write_row(&self, take: &FramePoses, frame: usize, last: &mut [[f64; CHANNELS]], text: &mut String) {
        let mut blank = "";
        if self.has_common_root {
            text.push_str(common_root::ROW);
        }
        for &(bone, _) in &self.order {
            let channels = &self.channels[bone];
            let (rotation, translation) = take.local(frame, bone);
            let mut numbers = angles(channels, rotation, &last[bone][..channels.len()]);
            for (number, channel) in numbers.iter_mut().zip(channels.iter()) {
                if let BvhChannel::Position(axis) = channel {
                    *number = translation[axis] * UNITS_PER_METER;
                }
            }
            last[bone] = numbers;
            for number in &numbers[..channels.len()] {
                text.push_str(blank);
                text.push_str(&spelled(*number, SIX_DECIMALS));
                blank = " ";
            }
        }
        text.push('\n');
    }
}

/// Returns whether a bone is written as the end site of its parent: the only child, never animated, and named as one that was
/// read from an end site.
fn is_end_site(skeleton: &Skeleton, take: &FramePoses, bone: usize, children: &[Vec<usize>]) -> bool {
    let Some(parent) = skeleton.bones[bone].parent else { return false };
    let parent = parent as usize;
    let is_named = skeleton.bones[bone].name.strip_suffix("_end") == Some(&skeleton.bones[parent].name);
    children[bone].is_empty() && children[parent].len() == 1 && is_named && !take.is_animated(bone)
}

fn close(text: &mut String, open: &mut usize, depth: usize) {
    while *open > depth {
        *open -= 1;
        let _ = writeln!(text, "{}}}", "\t".repeat(*open));
    }
}

/// Returns a vector in meters as three numbers of the file.
fn vector(meters: DVec3) -> String {
    let [x, y, z] = (meters * UNITS_PER_METER).to_array().map(|number| spelled(number, SIX_DECIMALS));
    format!("{x} {y} {z}")
}

/// Returns a name that every program reads: without blanks, braces and control characters.
fn possible(name: &str) -> String {
    let is_possible =
        |character: char| !character.is_whitespace() && !character.is_control() && !"{}".contains(character);
    name.trim().chars().map(|character| if is_possible(character) { character } else { '_' }).collect()
}
