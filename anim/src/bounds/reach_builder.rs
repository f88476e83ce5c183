//! Construction of the boxes of [`super::reach`]: once per model, from its vertices.

use super::axis_box::AxisBox;
use super::reach::{Delta, JointBox, PartReach, Reaches};
use crate::data::{Primitive, Skin};
use glam::{Mat3, Mat4, Vec3};

/// Number of joints that a skin can have, and size of the table that finds a joint's box.
const JOINTS: usize = 1 << 16;

/// Builds parts, with a table that finds a joint's box in constant time.
pub(crate) struct ReachBuilder {
    reaches: Reaches,
    /// For each joint, one more than the position of its box in the part under construction; 0 for none.
    place: Vec<u32>,
}

impl ReachBuilder {
    /// Creates a builder without parts.
    pub(crate) fn new() -> Self {
        Self { reaches: Reaches::default(), place: vec![0; JOINTS] }
    }

    /// Returns all parts.
    pub(crate) fn finish(self) -> Reaches {
        self.reaches
    }

    /// Adds the part of `primitive` that consists of `vertices`.
    ///
    /// `skinned`: whether joints move it, or one matrix. `skin` gives the directions of the bones, where it is known.
    /// `targets` are the morph targets that may move a vertex: [`moving_targets`].
    pub(crate) fn add(
        &mut self,
        primitive: &Primitive,
        skinned: bool,
        skin: Option<&Skin>,
        targets: &[u32],
        vertices: impl Iterator<Item = usize> + Clone,
    ) {
        let first = self.reaches.boxes.len();
        let mut reach = PartReach {
            boxes: (first as u32, 0),
            still: AxisBox::EMPTY,
            positive: [f32::INFINITY, 0.0],
            negative: [f32::INFINITY, 0.0],
        };
        // For each joint, a box along the axes of its bone; `extent` is the one along the axes of bind space. The
        // smaller of the two is kept.
        let mut turned: Vec<AxisBox> = Vec::new();
        for vertex in vertices.clone() {
            let Some(&stored) = primitive.vertices.positions.get(vertex) else { continue };
            self.weigh(primitive, skinned, vertex, stored, &mut reach);
            for joint in joints(primitive, skinned, vertex) {
                let place = self.place_of(joint, first, skin, &mut turned);
                let joint = &mut self.reaches.boxes[first + place];
                joint.extent.add(stored);
                add_turned(&mut turned[place], joint.turn, stored);
            }
        }
        for (joint, turned) in self.reaches.boxes[first..].iter_mut().zip(turned) {
            if turned.half_surface() < joint.extent.half_surface() {
                joint.extent = turned;
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

    /// Returns the position of `joint`'s box in the part, and adds the box if it is missing.
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
            self.reaches.boxes.push(JointBox { joint, turn, extent: AxisBox::EMPTY, deltas: (0, 0) });
            turned.push(AxisBox::EMPTY);
            *place = (self.reaches.boxes.len() - first) as u32;
        }
        *place as usize - 1
    }

    /// Adds a part that contains parts number `a` and `b`, which are of one primitive and were added without directions
    /// of bones.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let first = self.reaches.boxes.len();
        let (of_a, of_b) = (self.reaches.parts[a], self.reaches.parts[b]);
        let mut deltas: Vec<(usize, Delta)> = Vec::new();
        for part in [of_a, of_b] {
            for at in part.boxes.0..part.boxes.0 + part.boxes.1 {
                let joint = self.reaches.boxes[at as usize];
                let place = self.place_of(joint.joint, first, None, &mut Vec::new());
                let joined = &mut self.reaches.boxes[first + place];
                joined.extent = joined.extent.union(joint.extent);
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
        let sums = |of: fn(&PartReach) -> [f32; 2]| match (of_a.boxes.1, of_b.boxes.1) {
            // The sums of a part that nothing moves have no meaning.
            (0, _) => of(&of_b),
            (_, 0) => of(&of_a),
            _ => [of(&of_a)[0].min(of(&of_b)[0]), of(&of_a)[1].max(of(&of_b)[1])],
        };
        self.reaches.parts.push(PartReach {
            boxes: (first as u32, (self.reaches.boxes.len() - first) as u32),
            still: of_a.still.union(of_b.still),
            positive: sums(|part| part.positive),
            negative: sums(|part| part.negative),
        });
    }

    /// Returns the number of parts so far.
    pub(crate) fn len(&self) -> usize {
        self.reaches.parts.len()
    }

    /// Removes the joints of the most recent part from the table.
    fn forget(&mut self, first: usize) {
        for joint in &self.reaches.boxes[first..] {
            self.place[usize::from(joint.joint)] = 0;
        }
    }

    /// Stores the movements of the morph targets, sorted by the position of the box.
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

    /// Widens the part's ranges of weight sums to include those of the vertex. A vertex that skinning leaves in place
    /// or puts at the origin is added to the box of vertices that do not move.
    fn weigh(
        &mut self,
        primitive: &Primitive,
        skinned: bool,
        vertex: usize,
        stored: Vec3,
        reach: &mut PartReach,
    ) {
        if !stored.is_finite() {
            // Skinning puts a vertex that cannot be computed at the origin.
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
                // Without any weight, the skinned position is an empty sum: the origin.
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

    /// Adds the possible movement of each target to each box of the part.
    fn add_deltas(
        &mut self,
        primitive: &Primitive,
        skinned: bool,
        targets: &[u32],
        vertices: impl Iterator<Item = usize> + Clone,
        first: usize,
        reach: &mut PartReach,
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
                    // Skinning ignores a morph sum that is not finite: the vertex stays at its stored position, or at
                    // the origin if it has none.
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

/// Returns the morph targets of `primitive` that may move a vertex.
pub(crate) fn moving_targets(primitive: &Primitive) -> Vec<u32> {
    let moves = |positions: &[Vec3]| positions.iter().any(|by| *by != Vec3::ZERO);
    let targets = primitive.morph_targets.iter().enumerate();
    targets.filter(|(_, target)| moves(&target.positions)).map(|(index, _)| index as u32).collect()
}

/// Returns the joints that move vertex `vertex`; joint 0 for a mesh without skin.
fn joints(primitive: &Primitive, skinned: bool, vertex: usize) -> impl Iterator<Item = u16> + '_ {
    let influences = if skinned { primitive.vertices.influences_of(vertex) } else { &[] };
    let moving =
        influences.iter().filter(|influence| influence.weight != 0.0).map(|influence| influence.joint);
    moving.chain((!skinned).then_some(0))
}

/// Grows `extent`, whose axes are given by `turn`, by a finite `vector`; to everything where rotating it leaves the
/// range of f32.
fn add_turned(extent: &mut AxisBox, turn: Mat3, vector: Vec3) {
    let turned = turn.transpose() * vector;
    if vector.is_finite() && !turned.is_finite() {
        *extent = AxisBox::WHOLE;
    }
    extent.add(turned);
}

/// Returns the directions of a bone's axes in bind space, from its offset; the identity where they cannot be computed.
fn axes(offset: Mat4) -> Mat3 {
    let (_, rotation, _) = offset.to_scale_rotation_translation();
    let turn = Mat3::from_quat(rotation).transpose();
    let unit = (turn.transpose() * turn).abs_diff_eq(Mat3::IDENTITY, 1e-5);
    if turn.is_finite() && unit { turn } else { Mat3::IDENTITY }
}

/// Returns a range widened by the rounding of its sums; zero for a range that was never set.
fn outward([low, high]: [f32; 2]) -> [f32; 2] {
    if low > high {
        return [0.0, 0.0];
    }
    if low == high && (low == 0.0 || low == 1.0) {
        return [low, high];
    }
    [(low * (1.0 - f32::EPSILON)).max(0.0), (high * (1.0 + f32::EPSILON)).min(f32::MAX)]
}
