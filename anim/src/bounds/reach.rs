//! How far a part of a mesh can reach in a pose, told from a few boxes rather than from its vertices.
//!
//! A skinned vertex is a sum of images of one point `m`, one a bone:
//!
//! ```text
//! p = Σ weight_i * final_i * m = P * (a mean of images with weight_i > 0) - N * (a mean of those with weight_i < 0)
//! P = Σ of the positive weights, N = Σ of the negative ones, both ≥ 0
//! ```
//!
//! A mean lies in every box that holds what it is the mean of. So it is enough to keep, for each joint, one box of the
//! `m` that it moves: the boxes moved by the final poses hold every image, a box around those holds every mean, and
//! `[P] * box - [N] * box`, with the smallest and largest sums that occur, holds every vertex. With weights that sum
//! to 1 and are not negative that is the box itself.
//!
//! Morph targets add `Σ weight_t * difference_t` to `m`; a box of each target's differences, times its weight, is added
//! to the joint's box. Vertices that no bone moves stand still and have a box of their own.
//!
//! Each box lies along the axes of the bind space or of the bone, whichever makes it smaller; turning it is part of the
//! matrix that moves it, so any choice is right.

use super::axis_box::{AxisBox, ROUNDING, widening};
use crate::data::{Primitive, Skin};
use crate::skin::Movement;
use glam::{Mat3, Mat4, Vec3};

/// Joints that a skin can name, so the size of the table that finds a joint's box.
const JOINTS: usize = 1 << 16;

/// A box of the unmoved vertices that one joint moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointBox {
    /// Position in the skin's list; 0 for a mesh without skin.
    pub(crate) joint: u16,
    /// Axes of the box → mesh space.
    turn: Mat3,
    /// Along those axes.
    held: AxisBox,
    /// First of [`Reaches::deltas`], and how many.
    deltas: (u32, u32),
}

/// What one morph target adds at most.
#[derive(Clone, Copy, Debug)]
struct Delta {
    target: u32,
    /// Holds the origin; along the axes of the joint's box.
    by: AxisBox,
}

/// One part: a range of boxes, and sums of weights.
#[derive(Clone, Copy, Debug)]
struct Reach {
    boxes: (u32, u32),
    /// Vertices that do not move.
    still: AxisBox,
    /// Smallest and largest sum of a vertex's positive weights, and of its negative ones.
    positive: [f32; 2],
    negative: [f32; 2],
}

/// Any number of parts, in flat lists.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reaches {
    parts: Vec<Reach>,
    boxes: Vec<JointBox>,
    deltas: Vec<Delta>,
}

impl Reaches {
    /// Number of parts.
    pub(crate) fn len(&self) -> usize {
        self.parts.len()
    }

    /// Boxes of part number `part`.
    fn boxes(&self, part: usize) -> &[JointBox] {
        let (first, count) = self.parts.get(part).map_or((0, 0), |part| part.boxes);
        self.boxes.get(first as usize..(first + count) as usize).unwrap_or(&[])
    }

    /// A box around part number `part` when `movement` moves it and its morph targets have `weights`.
    ///
    /// Empty for a part without vertices. Allocates nothing.
    pub(crate) fn fit(&self, part: usize, movement: Movement<'_>, weights: &[f32]) -> AxisBox {
        let Some(reach) = self.parts.get(part) else { return AxisBox::EMPTY };
        let mut hull = AxisBox::EMPTY;
        for joint in self.boxes(part) {
            let held = self.held(joint, weights);
            if held == AxisBox::WHOLE {
                // A sum that has no answer leaves its vertex where it is stored, wherever that is.
                return held;
            }
            hull = hull.union(held.moved(&placed(joint, movement)));
        }
        weighted(hull, reach).union(reach.still)
    }

    /// How far from `center` the part can reach, never less than it does. `within` is what [`Self::fit`] gave.
    pub(crate) fn radius(
        &self,
        part: usize,
        movement: Movement<'_>,
        weights: &[f32],
        center: Vec3,
        within: AxisBox,
    ) -> f64 {
        let Some(reach) = self.parts.get(part).filter(|_| !within.is_empty()) else { return 0.0 };
        let outer = furthest(center, within);
        // The corners below hold means, so they say nothing of a part whose weights do not make means.
        if reach.negative[1] > 0.0 || !reach.still.is_empty() || within == AxisBox::WHOLE {
            return outer;
        }
        let mut inner = 0.0_f64;
        for joint in self.boxes(part) {
            inner = inner.max(corner(&self.held(joint, weights), &placed(joint, movement), center));
        }
        let off = (1.0 - reach.positive[0]).abs().max((reach.positive[1] - 1.0).abs());
        let size = within.min.abs().max(within.max.abs()).as_dvec3().length();
        let inner = inner + f64::from(off + ROUNDING) * size;
        if inner.is_finite() { inner.min(outer) } else { outer }
    }

    /// The joint's box, grown by what the morph targets add.
    fn held(&self, joint: &JointBox, weights: &[f32]) -> AxisBox {
        let (first, count) = joint.deltas;
        let deltas = self.deltas.get(first as usize..(first + count) as usize).unwrap_or(&[]);
        let mut held = joint.held;
        let mut added = 0;
        for delta in deltas {
            let weight = weights.get(delta.target as usize).copied().unwrap_or(0.0);
            if weight != 0.0 {
                let (a, b) = (delta.by.min * weight, delta.by.max * weight);
                (held.min, held.max) = (held.min + a.min(b), held.max + a.max(b));
                added += 1;
            }
        }
        if added > 0 {
            // Each sum may be rounded once more; both the box and what was added lie within these sizes.
            let slack = widening(held.min.abs().max(held.max.abs())) * (added as f32 + 1.0);
            (held.min, held.max) = (held.min - slack, held.max + slack);
        }
        held.or_whole()
    }
}

/// The matrix that moves the joint's box: along its axes → scene space.
fn placed(joint: &JointBox, movement: Movement<'_>) -> Mat4 {
    let matrix = match movement {
        Movement::Rigid(matrix) => matrix,
        Movement::Skin(finals) => finals.get(usize::from(joint.joint)).copied().unwrap_or(Mat4::IDENTITY),
    };
    if joint.turn == Mat3::IDENTITY { matrix } else { matrix * Mat4::from_mat3(joint.turn) }
}

/// `[P] * hull - [N] * hull`.
fn weighted(hull: AxisBox, reach: &Reach) -> AxisBox {
    if hull.is_empty() {
        return hull;
    }
    let ([p0, p1], [n0, n1]) = (reach.positive, reach.negative);
    let mut min = (hull.min * p0).min(hull.min * p1);
    let mut max = (hull.max * p0).max(hull.max * p1);
    if n1 > 0.0 {
        min -= (hull.max * n0).max(hull.max * n1);
        max -= (hull.min * n0).min(hull.min * n1);
    }
    let slack = widening(hull.min.abs().max(hull.max.abs()) * (p1 + n1));
    AxisBox { min: min - slack, max: max + slack }.or_whole()
}

/// Distance from `center` to the furthest corner of `held`.
fn furthest(center: Vec3, held: AxisBox) -> f64 {
    let center = center.as_dvec3();
    (held.min.as_dvec3() - center).abs().max((held.max.as_dvec3() - center).abs()).length()
}

/// Distance from `center` to the furthest corner of `held` moved by `matrix`.
fn corner(held: &AxisBox, matrix: &Mat4, center: Vec3) -> f64 {
    let (middle, half) = (held.center(), held.half().as_dvec3());
    let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate().as_dvec3());
    let [x, y, z] = [axes[0] * half.x, axes[1] * half.y, axes[2] * half.z];
    let from = matrix.transform_point3(middle).as_dvec3() - center.as_dvec3();
    let mut furthest = 0.0_f64;
    for corner in [x + y + z, x + y - z, x - y + z, y + z - x] {
        // Opposite corners together.
        furthest = furthest.max((from + corner).length_squared()).max((from - corner).length_squared());
    }
    let sizes = (middle.abs() + held.half()).as_dvec3();
    let summed = axes[0].abs() * sizes.x + axes[1].abs() * sizes.y + axes[2].abs() * sizes.z;
    let summed = summed.length() + matrix.w_axis.truncate().as_dvec3().length();
    furthest.sqrt() + summed * f64::from(ROUNDING)
}

/// Makes parts, with a table that finds a joint's box at once.
pub(crate) struct ReachBuilder {
    reaches: Reaches,
    /// Of each joint: one more than its place among the boxes of the part being made; 0 for none.
    place: Vec<u32>,
}

impl ReachBuilder {
    /// Without parts.
    pub(crate) fn new() -> Self {
        Self { reaches: Reaches::default(), place: vec![0; JOINTS] }
    }

    /// All parts made.
    pub(crate) fn finish(self) -> Reaches {
        self.reaches
    }

    /// Adds the part of `primitive` that `vertices` are.
    ///
    /// `skinned`: do joints move it, or one matrix? `skin` gives the directions of the bones, where it is known.
    /// `targets` are the morph targets that may move anything: [`moving_targets`].
    pub(crate) fn add(
        &mut self,
        primitive: &Primitive,
        skinned: bool,
        skin: Option<&Skin>,
        targets: &[u32],
        vertices: impl Iterator<Item = usize> + Clone,
    ) {
        let first = self.reaches.boxes.len();
        let mut reach = Reach {
            boxes: (first as u32, 0),
            still: AxisBox::EMPTY,
            positive: [f32::INFINITY, 0.0],
            negative: [f32::INFINITY, 0.0],
        };
        // Along both kinds of axes at once; the better is kept.
        let mut turned: Vec<AxisBox> = Vec::new();
        for vertex in vertices.clone() {
            let Some(&stored) = primitive.vertices.positions.get(vertex) else { continue };
            self.weigh(primitive, skinned, vertex, stored, &mut reach);
            for joint in joints(primitive, skinned, vertex) {
                let place = self.place_of(joint, first, skin, &mut turned);
                let joint = &mut self.reaches.boxes[first + place];
                joint.held.add(stored);
                add_turned(&mut turned[place], joint.turn, stored);
            }
        }
        for (joint, turned) in self.reaches.boxes[first..].iter_mut().zip(turned) {
            if turned.half_surface() < joint.held.half_surface() {
                joint.held = turned;
            } else {
                joint.turn = Mat3::IDENTITY;
            }
        }
        self.add_deltas(primitive, skinned, targets, vertices, first, &mut reach);
        self.forget(first);
        reach.boxes.1 = (self.reaches.boxes.len() - first) as u32;
        reach.positive = outward(reach.positive);
        reach.negative = outward(reach.negative);
        self.reaches.parts.push(reach);
    }

    /// The place of `joint`'s box among those of the part, which is made where it is not there.
    fn place_of(
        &mut self,
        joint: u16,
        first: usize,
        skin: Option<&Skin>,
        turned: &mut Vec<AxisBox>,
    ) -> usize {
        let place = &mut self.place[usize::from(joint)];
        if *place == 0 {
            let offset = skin.and_then(|skin| skin.offsets.get(usize::from(joint)));
            let turn = offset.map_or(Mat3::IDENTITY, |offset| axes(*offset));
            self.reaches.boxes.push(JointBox { joint, turn, held: AxisBox::EMPTY, deltas: (0, 0) });
            turned.push(AxisBox::EMPTY);
            *place = (self.reaches.boxes.len() - first) as u32;
        }
        *place as usize - 1
    }

    /// Adds a part that holds parts number `a` and `b`, which are of one primitive and were added without directions of
    /// bones.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let first = self.reaches.boxes.len();
        let (of_a, of_b) = (self.reaches.parts[a], self.reaches.parts[b]);
        let mut deltas: Vec<(usize, Delta)> = Vec::new();
        for part in [of_a, of_b] {
            for at in part.boxes.0..part.boxes.0 + part.boxes.1 {
                let joint = self.reaches.boxes[at as usize];
                let place = self.place_of(joint.joint, first, None, &mut Vec::new());
                let joined = &mut self.reaches.boxes[first + place];
                joined.held = joined.held.union(joint.held);
                let of_joint = joint.deltas.0 as usize..(joint.deltas.0 + joint.deltas.1) as usize;
                deltas.extend(self.reaches.deltas[of_joint].iter().map(|delta| (place, *delta)));
            }
        }
        deltas.sort_by_key(|(place, delta)| (*place, delta.target));
        deltas.dedup_by(|next, kept| {
            let same = (next.0, next.1.target) == (kept.0, kept.1.target);
            if same {
                kept.1.by = kept.1.by.union(next.1.by);
            }
            same
        });
        self.store(deltas, first);
        self.forget(first);
        let sums = |of: fn(&Reach) -> [f32; 2]| match (of_a.boxes.1, of_b.boxes.1) {
            // The sums of a part that nothing moves say nothing.
            (0, _) => of(&of_b),
            (_, 0) => of(&of_a),
            _ => [of(&of_a)[0].min(of(&of_b)[0]), of(&of_a)[1].max(of(&of_b)[1])],
        };
        self.reaches.parts.push(Reach {
            boxes: (first as u32, (self.reaches.boxes.len() - first) as u32),
            still: of_a.still.union(of_b.still),
            positive: sums(|part| part.positive),
            negative: sums(|part| part.negative),
        });
    }

    /// Number of parts so far.
    pub(crate) fn len(&self) -> usize {
        self.reaches.parts.len()
    }

    /// Takes the joints of the part made last out of the table.
    fn forget(&mut self, first: usize) {
        for joint in &self.reaches.boxes[first..] {
            self.place[usize::from(joint.joint)] = 0;
        }
    }

    /// Stores what targets add, sorted by the place of the box.
    fn store(&mut self, found: Vec<(usize, Delta)>, first: usize) {
        for (place, delta) in found {
            let joint = &mut self.reaches.boxes[first + place];
            if joint.deltas.1 == 0 {
                joint.deltas.0 = self.reaches.deltas.len() as u32;
            }
            joint.deltas.1 += 1;
            self.reaches.deltas.push(delta);
        }
    }

    /// Adds the sums of the vertex's weights to those of the part, or the vertex to those that stand still.
    fn weigh(
        &mut self,
        primitive: &Primitive,
        skinned: bool,
        vertex: usize,
        stored: Vec3,
        reach: &mut Reach,
    ) {
        if !stored.is_finite() {
            // What cannot be computed stands in the origin.
            reach.still.add(Vec3::ZERO);
        }
        if !skinned {
            reach.positive = [1.0, 1.0];
            reach.negative = [0.0, 0.0];
            return;
        }
        let (mut positive, mut negative) = (0.0_f64, 0.0_f64);
        for influence in primitive.vertices.influences_of(vertex) {
            let weight = f64::from(influence.weight);
            if weight > 0.0 { positive += weight } else { negative -= weight }
        }
        if positive.is_finite() && negative.is_finite() {
            if positive == 0.0 && negative == 0.0 {
                // A sum of nothing.
                reach.still.add(Vec3::ZERO);
                return;
            }
            let spread = |range: &mut [f32; 2], sum: f64| {
                let sum = (sum as f32).min(f32::MAX);
                *range = [range[0].min(sum), range[1].max(sum)];
            };
            spread(&mut reach.positive, positive);
            spread(&mut reach.negative, negative);
        } else {
            reach.still.add(stored);
        }
    }

    /// Adds what each target may add to each box of the part.
    fn add_deltas(
        &mut self,
        primitive: &Primitive,
        skinned: bool,
        targets: &[u32],
        vertices: impl Iterator<Item = usize> + Clone,
        first: usize,
        reach: &mut Reach,
    ) {
        let boxes = self.reaches.boxes.len() - first;
        let mut found: Vec<(usize, Delta)> = Vec::new();
        let nothing = AxisBox::at(Vec3::ZERO);
        let mut of_target = vec![nothing; if targets.is_empty() { 0 } else { boxes }];
        for &target in targets {
            let mut any = false;
            for vertex in vertices.clone() {
                let differences = &primitive.morph_targets[target as usize].positions;
                let Some(&difference) = differences.get(vertex).filter(|by| **by != Vec3::ZERO) else {
                    continue;
                };
                if !difference.is_finite() {
                    // The vertex goes where it would be without the sum that has no answer, or to the origin.
                    reach.still.add(primitive.vertices.positions.get(vertex).copied().unwrap_or(Vec3::ZERO));
                    continue;
                }
                for joint in joints(primitive, skinned, vertex) {
                    let Some(place) = (self.place[usize::from(joint)] as usize).checked_sub(1) else {
                        continue;
                    };
                    add_turned(&mut of_target[place], self.reaches.boxes[first + place].turn, difference);
                    any = true;
                }
            }
            if any {
                for (place, by) in of_target.iter_mut().enumerate().filter(|(_, by)| **by != nothing) {
                    found.push((place, Delta { target, by: std::mem::replace(by, nothing) }));
                }
            }
        }
        found.sort_by_key(|(place, _)| *place);
        self.store(found, first);
    }
}

/// Morph targets of `primitive` that may move a vertex.
pub(crate) fn moving_targets(primitive: &Primitive) -> Vec<u32> {
    let moves = |positions: &[Vec3]| positions.iter().any(|by| *by != Vec3::ZERO);
    let targets = primitive.morph_targets.iter().enumerate();
    targets.filter(|(_, target)| moves(&target.positions)).map(|(index, _)| index as u32).collect()
}

/// Joints that move vertex `vertex`; joint 0 of a mesh without skin.
fn joints(primitive: &Primitive, skinned: bool, vertex: usize) -> impl Iterator<Item = u16> + '_ {
    let influences = if skinned { primitive.vertices.influences_of(vertex) } else { &[] };
    let moving =
        influences.iter().filter(|influence| influence.weight != 0.0).map(|influence| influence.joint);
    moving.chain((!skinned).then_some(0))
}

/// Grows `held`, whose axes `turn` gives, by a finite `vector`; to everything where turning leaves the range of f32.
fn add_turned(held: &mut AxisBox, turn: Mat3, vector: Vec3) {
    let turned = turn.transpose() * vector;
    if vector.is_finite() && !turned.is_finite() {
        *held = AxisBox::WHOLE;
    }
    held.add(turned);
}

/// The directions of a bone's axes in bind space, from its offset; the identity where they cannot be told.
fn axes(offset: Mat4) -> Mat3 {
    let (_, rotation, _) = offset.to_scale_rotation_translation();
    let turn = Mat3::from_quat(rotation).transpose();
    let unit = (turn.transpose() * turn).abs_diff_eq(Mat3::IDENTITY, 1e-5);
    if turn.is_finite() && unit { turn } else { Mat3::IDENTITY }
}

/// A range with room for the rounding of its sums; nothing for one that was never set.
fn outward([low, high]: [f32; 2]) -> [f32; 2] {
    if low > high {
        return [0.0, 0.0];
    }
    if low == high && (low == 0.0 || low == 1.0) {
        return [low, high];
    }
    [(low * (1.0 - f32::EPSILON)).max(0.0), (high * (1.0 + f32::EPSILON)).min(f32::MAX)]
}
