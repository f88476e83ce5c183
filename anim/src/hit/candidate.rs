//! Candidates of a query, their order, and the complete hit of the best one.

use super::triangle::{UnitRay, meet, nearest_on_flat, nearest_on_triangle, normal_of};
use super::{Hit, HitSettings};
use crate::data::{BoneIndex, MAX_INFLUENCES, ModelData, Primitive};
use crate::evaluator::Evaluator;
use crate::skin::Movement;
use glam::{DVec3, Mat3, Vec3};

/// Address of a triangle in the scene; ordered as in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct TriangleAddress {
    pub(super) instance: u32,
    pub(super) primitive: u32,
    pub(super) triangle: u32,
}

/// The best candidate so far, before the complete hit is computed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) distance: f64,
    address: TriangleAddress,
    barycentric: DVec3,
    corners: [Vec3; 3],
    front: bool,
}

impl Candidate {
    /// Replaces `best` by this candidate if that is nearer, or equally near and earlier in the file: so the result does
    /// not depend on the order of the tests.
    fn outdo(self, best: &mut Option<Self>) {
        let better = |best: Self| {
            self.distance < best.distance || (self.distance == best.distance && self.address < best.address)
        };
        if best.is_none_or(better) {
            *best = Some(self);
        }
    }
}

/// State of a ray query.
pub(super) struct RaySearch {
    pub(super) line: UnitRay,
    pub(super) settings: HitSettings,
    pub(super) best: Option<Candidate>,
}

impl RaySearch {
    /// Returns the distance beyond which nothing can improve the result.
    pub(super) fn limit(&self) -> f64 {
        self.best.map_or(f64::from(self.settings.max_distance), |best| best.distance)
    }

    /// Tests a triangle and keeps it if it is hit and better than the best. Returns whether it was hit.
    pub(super) fn test(
        &mut self,
        primitive: &Primitive,
        movement: Movement<'_>,
        address: TriangleAddress,
        corners: [Vec3; 3],
    ) -> bool {
        let Some(crossing) = meet(&self.line, corners) else { return false };
        let within = crossing.distance <= f64::from(self.settings.max_distance);
        let front = crossing.counter_clockwise != mirrored(primitive, movement, address.triangle);
        if !within || !(front || self.settings.back_faces) {
            return false;
        }
        let (distance, barycentric) = (crossing.distance, crossing.barycentric);
        Candidate { distance, address, barycentric, corners, front }.outdo(&mut self.best);
        true
    }
}

/// State of a sphere query: the nearest point within the sphere.
pub(super) struct SphereSearch {
    pub(super) center: DVec3,
    pub(super) radius: f64,
    /// Whether triangles without area count.
    pub(super) flat: bool,
    pub(super) best: Option<Candidate>,
}

impl SphereSearch {
    /// Creates a query. `None` for an empty sphere: a radius that is negative, or a number that is not finite. An
    /// infinite radius contains everything.
    pub(super) fn of(center: Vec3, radius: f32) -> Option<Self> {
        (center.is_finite() && radius >= 0.0).then(|| Self {
            center: center.as_dvec3(),
            radius: f64::from(radius),
            flat: false,
            best: None,
        })
    }

    /// Returns the distance beyond which nothing can improve the result.
    pub(super) fn limit(&self) -> f64 {
        self.best.map_or(self.radius, |best| best.distance)
    }

    /// Tests a triangle and keeps it if it is within and better than the best.
    pub(super) fn test(
        &mut self,
        primitive: &Primitive,
        movement: Movement<'_>,
        address: TriangleAddress,
        corners: [Vec3; 3],
    ) {
        let mut nearest = nearest_on_triangle(self.center, corners);
        if self.flat {
            nearest = nearest.or_else(|| nearest_on_flat(self.center, corners));
        }
        let Some((barycentric, distance)) = nearest else { return };
        if distance > self.limit() {
            return;
        }
        let normal = normal_of(corners).unwrap_or(DVec3::Y);
        let counter_clockwise = normal.dot(self.center - corners[0].as_dvec3()) >= 0.0;
        let front = counter_clockwise != mirrored(primitive, movement, address.triangle);
        Candidate { distance, address, barycentric, corners, front }.outdo(&mut self.best);
    }
}

/// Returns whether the matrix of the triangle's first corner mirrors, so that front and back are exchanged.
fn mirrored(primitive: &Primitive, movement: Movement<'_>, triangle: u32) -> bool {
    let corner = primitive.indices.get(triangle as usize * 3).copied().unwrap_or(0);
    let linear = Mat3::from_mat4(movement.matrix(primitive, corner as usize));
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis].map(|axis| axis.as_dvec3());
    x.cross(y).dot(z) < 0.0
}

/// Computes the complete hit of a candidate.
pub(super) fn complete(evaluator: &Evaluator, found: &Candidate) -> Hit {
    let TriangleAddress { instance, primitive, triangle } = found.address;
    let [a, b, c] = found.corners.map(|corner| corner.as_dvec3());
    let shares = found.barycentric;
    let normal = normal_of(found.corners).unwrap_or(DVec3::Y);
    let movement = evaluator.movement(instance as usize, primitive as usize);
    let of_instance = evaluator.primitives(instance as usize).get(primitive as usize);
    let mirrored = match (of_instance, movement) {
        (Some(primitive), Some(movement)) => mirrored(primitive, movement, triangle),
        _ => false,
    };
    Hit {
        instance,
        primitive,
        triangle,
        barycentric: shares.as_vec3(),
        bone: of_instance.and_then(|of| bone_at(evaluator.model(), instance, of, triangle, shares)),
        position: (a * shares.x + b * shares.y + c * shares.z).as_vec3(),
        normal: if mirrored { -normal } else { normal }.as_vec3(),
        distance: found.distance as f32,
        front: found.front,
    }
}

/// Returns the bone with the greatest weight at a point of a triangle; of bones with equal weights, the one found
/// first.
fn bone_at(
    model: &ModelData,
    instance: u32,
    primitive: &Primitive,
    triangle: u32,
    shares: DVec3,
) -> Option<BoneIndex> {
    let instance = model.instances.get(instance as usize)?;
    let Some(skin) = instance.skin.filter(|_| primitive.vertices.influences_per_vertex > 0) else {
        return instance.bone.filter(|&bone| (bone as usize) < model.animation.skeleton.len());
    };
    let skin = model.skins.get(skin as usize)?;
    const MOST: usize = 3 * MAX_INFLUENCES;
    let mut sums = [(0 as BoneIndex, 0.0_f64); MOST];
    let mut used = 0;
    let first = triangle as usize * 3;
    for (&corner, share) in primitive.indices.get(first..first + 3)?.iter().zip(shares.to_array()) {
        for influence in primitive.vertices.influences_of(corner as usize) {
            let Some(&bone) = skin.bones.get(usize::from(influence.joint)) else { continue };
            let weight = f64::from(influence.weight) * share;
            match sums[..used].iter_mut().find(|(other, _)| *other == bone) {
                Some((_, sum)) => *sum += weight,
                None if used < MOST => {
                    sums[used] = (bone, weight);
                    used += 1;
                }
                None => {}
            }
        }
    }
    let mut greatest: Option<(BoneIndex, f64)> = None;
    for &(bone, sum) in &sums[..used] {
        if sum > greatest.map_or(0.0, |(_, most)| most) {
            greatest = Some((bone, sum));
        }
    }
    greatest.map(|(bone, _)| bone)
}
