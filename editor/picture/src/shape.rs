//! The shape of a skeleton: the bodies that represent its bones, and their positions in a pose.
//!
//! A bone reaches from its joint to each of its children; a bone without children continues in the direction of its
//! parent. Bones that move no surface (such as the nodes above a character) are drawn as thin lines.

use super::message::{BoneLook, Look};
use crate::between;
use bytemuck::{Pod, Zeroable};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{BoneIndex, ModelData};
use glam::{Mat4, Vec3};

/// Ratio of the thickness of a bone to its length.
const SLIMNESS: f32 = 0.1;
/// Smallest and largest thickness of a bone, relative to the whole skeleton.
const THICKNESS: [f32; 2] = [0.0028, 0.02];
/// Length of a bone without children, relative to the bone before it.
const LAST_BONE: f32 = 0.45;

/// An instance of a body. WGSL twin: `Bone` in `shaders/skeleton.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BoneInstance {
    /// Start, scene space.
    pub head: Vec3,
    /// Radius, scene units.
    pub radius: f32,
    /// End, scene space.
    pub tail: Vec3,
    /// 1 if selected, plus 2 if hovered.
    pub state: u32,
    /// Unit vector across the bone.
    pub side: Vec3,
    /// Opacity of lines.
    pub strength: f32,
}

/// Bodies that a bone can be drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// A slim octahedron.
    Octahedron,
    /// A round stick.
    Stick,
    /// A ball at the head.
    Ball,
    /// A line a few pixels wide.
    Line,
}

impl Body {
    /// All bodies, in drawing order.
    pub const ALL: [Self; 4] = [Self::Line, Self::Stick, Self::Octahedron, Self::Ball];
}

/// A bone's link from one position to another.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BoneLink {
    bone: BoneIndex,
    tail: LinkTail,
    /// Whether the bone moves a surface, or the skeleton has no surface at all.
    is_joint: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum LinkTail {
    /// The joint of a child.
    Child(BoneIndex),
    /// A point in the bone's own space.
    Own(Vec3),
}

/// The bodies of a skeleton, with memory for their positions in a pose.
#[derive(Debug, Default)]
pub struct SkeletonShape {
    links: Vec<BoneLink>,
    joints: Vec<bool>,
    /// Diagonal of the joints at rest, scene units.
    size: f32,
    /// Thickness of the thickest link of each bone in this pose.
    thickness: Vec<f32>,
    /// Whether each bone is selected; looked up once per link, so not searched for in a list.
    selected: Vec<bool>,
    /// Instances of each body, in the order of [`Body::ALL`].
    instances: [Vec<BoneInstance>; 4],
    /// Bone that each instance belongs to.
    owners: [Vec<BoneIndex>; 4],
}

impl SkeletonShape {
    /// The shape of `model`'s skeleton.
    pub fn new(model: &ModelData) -> Self {
        let skeleton = &*model.animation.skeleton;
        let mut rest = vec![Mat4::IDENTITY; skeleton.len()];
        to_root(skeleton, &[], &mut rest);
        let joints = joints(model);
        let size = extent(&rest, &joints);
        let mut links = Vec::with_capacity(skeleton.len() * 2);
        let mut has_child = vec![false; skeleton.len()];
        for (index, bone) in skeleton.bones.iter().enumerate() {
            let Some(parent) = bone.parent else { continue };
            has_child[parent as usize] = true;
            let is_joint = joints[parent as usize];
            links.push(BoneLink { bone: parent, tail: LinkTail::Child(index as BoneIndex), is_joint });
        }
        for index in (0..skeleton.len()).filter(|&index| !has_child[index]) {
            let tail = LinkTail::Own(last_tail(model, &rest, index, size));
            links.push(BoneLink { bone: index as BoneIndex, tail, is_joint: joints[index] });
        }
        let room = links.len() + skeleton.len();
        let thickness = vec![0.0; skeleton.len()];
        let selected = vec![false; skeleton.len()];
        let mut shape = Self { links, joints, size, thickness, selected, ..Self::default() };
        shape.instances.iter_mut().for_each(|list| list.reserve(room));
        shape.owners.iter_mut().for_each(|list| list.reserve(room));
        shape
    }

    /// Places the bodies for a pose, even if the skeleton is not shown: bones that are not drawn can be picked. Bones
    /// hidden by the user get no bodies. Allocates nothing.
    pub fn place(&mut self, to_root: &[Mat4], look: &Look) {
        self.instances.iter_mut().for_each(Vec::clear);
        self.owners.iter_mut().for_each(Vec::clear);
        self.thickness.fill(0.0);
        self.selected.fill(false);
        for &bone in &look.selected {
            if let Some(selected) = self.selected.get_mut(bone as usize) {
                *selected = true;
            }
        }
        for index in 0..self.links.len() {
            let link = self.links[index];
            if look.hidden.is_hidden(link.bone) {
                continue;
            }
            let Some(matrix) = to_root.get(link.bone as usize) else { continue };
            let head = matrix.w_axis.truncate();
            let tail = match link.tail {
                LinkTail::Child(child) => to_root.get(child as usize).map_or(head, |to| to.w_axis.truncate()),
                LinkTail::Own(point) => matrix.transform_point3(point),
            };
            let length = head.distance(tail);
            // Too short to be visible, or not finite: only the joint's ball is shown.
            if length.is_nan() || length <= self.size * 1e-4 {
                continue;
            }
            let body = match look.bone_look {
                _ if !link.is_joint => Body::Line,
                BoneLook::Octahedra => Body::Octahedron,
                BoneLook::Sticks => Body::Stick,
                BoneLook::Lines => Body::Line,
            };
            let thickness = self.radius(length);
            let radius = if body == Body::Stick { thickness * 0.34 } else { thickness };
            let thickest = &mut self.thickness[link.bone as usize];
            *thickest = thickest.max(thickness);
            let strength = if link.is_joint { 1.0 } else { 0.32 };
            let side = across(matrix, (tail - head) / length);
            let state = self.state(look, link.bone);
            self.add(body, link.bone, BoneInstance { head, radius, tail, state, side, strength });
        }
        self.place_balls(to_root, look);
    }

    /// Places a ball at every joint, so that joints without length can be seen and picked.
    fn place_balls(&mut self, to_root: &[Mat4], look: &Look) {
        if look.bone_look == BoneLook::Lines {
            return;
        }
        // As thick as the thickest link of the bone that starts here; the links of a bone need not be adjacent.
        for (index, matrix) in to_root.iter().enumerate().take(self.joints.len()) {
            if !self.joints[index] || look.hidden.is_hidden(index as BoneIndex) {
                continue;
            }
            let bone = index as BoneIndex;
            let thickest = self.thickness[index].max(self.size * THICKNESS[0] * 1.5);
            let radius = thickest * if look.bone_look == BoneLook::Sticks { 0.72 } else { 0.62 };
            let head = matrix.w_axis.truncate();
            let state = self.state(look, bone);
            let tail = head + Vec3::Y * radius;
            let ball = BoneInstance { head, radius, tail, state, side: Vec3::X, strength: 1.0 };
            self.add(Body::Ball, bone, ball);
        }
    }

    /// The instances of a body in the pose placed last.
    pub fn instances(&self, body: Body) -> &[BoneInstance] {
        &self.instances[position(body)]
    }

    /// The bone of each instance of a body.
    pub fn owners(&self, body: Body) -> &[BoneIndex] {
        &self.owners[position(body)]
    }

    /// Returns whether a bone moves a surface, rather than only controlling other bones.
    pub fn is_joint(&self, bone: BoneIndex) -> bool {
        self.joints.get(bone as usize) == Some(&true)
    }

    /// Largest number of instances in any pose.
    pub fn capacity(&self) -> usize {
        self.links.len() + self.joints.len()
    }

    fn state(&self, look: &Look, bone: BoneIndex) -> u32 {
        let selected = self.selected.get(bone as usize) == Some(&true);
        u32::from(selected) + 2 * u32::from(look.hovered == Some(bone))
    }

    fn radius(&self, length: f32) -> f32 {
        between(length * SLIMNESS, self.size * THICKNESS[0], self.size * THICKNESS[1]).min(length * 0.3)
    }

    fn add(&mut self, body: Body, bone: BoneIndex, instance: BoneInstance) {
        self.instances[position(body)].push(instance);
        self.owners[position(body)].push(bone);
    }
}

fn position(body: Body) -> usize {
    Body::ALL.iter().position(|&other| other == body).unwrap_or(0)
}

/// Returns which bones move a surface: some vertex has weight for them, or they carry a mesh. Without any such bone,
/// all of them count.
fn joints(model: &ModelData) -> Vec<bool> {
    let mut joints = vec![false; model.animation.skeleton.len()];
    let mut mark = |bone: BoneIndex| {
        if let Some(joint) = joints.get_mut(bone as usize) {
            *joint = true;
        }
    };
    for instance in &model.instances {
        let Some(skin) = instance.skin.and_then(|skin| model.skins.get(skin as usize)) else {
            instance.bone.into_iter().for_each(&mut mark);
            continue;
        };
        let primitives = model.meshes.get(instance.mesh as usize).map_or(&[][..], |mesh| &mesh.primitives);
        let influences = primitives.iter().flat_map(|primitive| &primitive.vertices.influences);
        let mut used = vec![false; skin.bones.len()];
        for influence in influences.filter(|influence| influence.weight > 0.0) {
            if let Some(used) = used.get_mut(usize::from(influence.joint)) {
                *used = true;
            }
        }
        skin.bones.iter().zip(used).filter(|(_, used)| *used).for_each(|(&bone, _)| mark(bone));
    }
    if !joints.contains(&true) {
        joints.fill(true);
    }
    joints
}

/// Diagonal of the box around the joints; one unit for a single point.
fn extent(rest: &[Mat4], joints: &[bool]) -> f32 {
    let places =
        rest.iter().zip(joints).filter(|(_, is_joint)| **is_joint).map(|(to, _)| to.w_axis.truncate());
    let around = |(low, high): (Vec3, Vec3), place: Vec3| (low.min(place), high.max(place));
    let (low, high) = places.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), around);
    let size = (high - low).length();
    if size.is_finite() && size > 0.0 { size } else { 1.0 }
}

/// End of a bone without children, in its own space: it continues in the direction from its parent.
fn last_tail(model: &ModelData, rest: &[Mat4], index: usize, size: f32) -> Vec3 {
    let to_root = rest[index];
    let head = to_root.w_axis.truncate();
    let parent = model.animation.skeleton.bones[index].parent;
    let before = parent.map_or(Vec3::ZERO, |parent| head - rest[parent as usize].w_axis.truncate());
    let longest = size * 0.12;
    let onwards = if before.length() > size * 1e-3 {
        before.clamp_length_max(longest / LAST_BONE) * LAST_BONE
    } else {
        to_root.y_axis.truncate().normalize_or(Vec3::Y) * size * 0.06
    };
    let own = to_root.inverse().transform_point3(head + onwards);
    if own.is_finite() { own } else { Vec3::ZERO }
}

/// Unit vector across the bone that rotates with it: from the axis of the bone that is least parallel to it.
fn across(matrix: &Mat4, along: Vec3) -> Vec3 {
    let axes = [matrix.x_axis, matrix.z_axis, matrix.y_axis].map(|axis| axis.truncate().normalize_or_zero());
    let least = axes.into_iter().min_by(|a, b| a.dot(along).abs().total_cmp(&b.dot(along).abs()));
    let axis = least.unwrap_or(Vec3::X);
    (axis - along * axis.dot(along)).try_normalize().unwrap_or_else(|| along.any_orthonormal_vector())
}
