//! Skinning on the CPU: positions and normals moved by bones, eight vertices at once (thesis §2.1.4).
//!
//! ```text
//! M        = Σ weight_i * final[joint_i]                    one vertex after the other, two rows in one register
//! morphed  = stored + Σ weight_t * difference_t             from here on eight vertices at once
//! position = M * position
//! normal   = normalize(sign(determinant) * cofactors(M) * normal)
//! ```
//!
//! The sum of matrices and the sum of moved positions are the same; the matrix is used for the normal too. Its
//! cofactors, the transposed inverse but for its length, keep normals at right angles to the surface under any scale;
//! see [`crate::skin`].

use super::matrix::{IDENTITY, Matrix34, lower, mat4, upper};
use super::morph::{Differences, ShapeBlock};
use super::simd::{Float8, Kernel, LANES, Simd, SimdLevel};
use crate::data::{Primitive, Vertices};
use crate::skin::{first_direction, near_one, normal_matrix};
use glam::{Mat3, Mat4, Vec3};
use std::hint::black_box;

/// Vertices of a primitive in the layout of the fast path: eight per block, in file order.
#[derive(Clone, Debug, Default)]
pub struct SkinnedVertices {
    count: usize,
    blocks: Vec<VertexBlock>,
    influences: Vec<InfluenceBlock>,
    differences: Differences,
    /// Whether all joint numbers are below 256, so that a byte can index them.
    is_narrow: bool,
}

/// Number of joints that a byte can index.
const NARROW: usize = 256;

/// Number of vertices from which a table pays off; building it costs about as much as skinning forty of them.
const TABLE_THRESHOLD: usize = 128;

/// A matrix aligned to its size, so that a shifted index is its offset.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct PaddedMatrix([f32; 16]);

/// A matrix for each value of a byte, so that no index has to be checked.
type MatrixTable = [PaddedMatrix; NARROW];

/// The identity, and padding.
const PADDED_IDENTITY: PaddedMatrix =
    PaddedMatrix([1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.]);

/// Eight vertices; those past the end repeat the first of the eight.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct VertexBlock {
    shape: ShapeBlock,
    /// First of its influences, and number of influences of each of its vertices: 1, 2, 4 or 8.
    first: u32,
    each: u32,
}

/// The `k`-th influence of eight vertices.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct InfluenceBlock {
    joints: [u16; LANES],
    weights: [f32; LANES],
}

impl SkinnedVertices {
    /// Converts the vertices of `primitive` and their morph targets. Missing normals are +Y.
    ///
    /// All vertices of a block have the same number of influences, 1, 2, 4 or 8: the largest number that one of them
    /// needs.
    pub fn new(primitive: &Primitive) -> Self {
        let vertices = &primitive.vertices;
        let (count, differences) = (vertices.len(), Differences::new(primitive));
        let mut new = Self { count, differences, is_narrow: true, ..Self::default() };
        for first in (0..count).step_by(LANES) {
            let lanes = std::array::from_fn(|lane| if first + lane < count { first + lane } else { first });
            new.add(vertices, lanes);
        }
        new
    }

    /// Adds a block of the vertices `lanes`.
    fn add(&mut self, vertices: &Vertices, lanes: [usize; LANES]) {
        let used =
            |index: usize| vertices.influences_of(index).iter().filter(|influence| influence.weight != 0.0);
        let most = lanes.iter().map(|&index| used(index).count()).max().unwrap_or(0);
        let each = most.next_power_of_two().clamp(1, 8);
        let mut shape = ShapeBlock::default();
        let nothing = InfluenceBlock { joints: [0; LANES], weights: [0.0; LANES] };
        let mut influences = [nothing; 8];
        for (lane, index) in lanes.into_iter().enumerate() {
            let position = vertices.positions.get(index).copied().unwrap_or(Vec3::ZERO);
            let normal = vertices.normals.get(index).copied().unwrap_or(Vec3::Y);
            shape.set(lane, position, normal);
            for (slot, influence) in influences.iter_mut().zip(used(index)) {
                slot.joints[lane] = influence.joint;
                slot.weights[lane] = influence.weight;
                self.is_narrow &= usize::from(influence.joint) < NARROW;
            }
        }
        self.blocks.push(VertexBlock { shape, first: self.influences.len() as u32, each: each as u32 });
        self.influences.extend_from_slice(&influences[..each]);
    }

    /// Returns the number of vertices.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Returns whether there is no vertex.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    fn influences_of(&self, block: &VertexBlock) -> &[InfluenceBlock] {
        let first = block.first as usize;
        self.influences.get(first..first + block.each as usize).unwrap_or(&[])
    }
}

/// Moves vertices to scene space, up to the length of the shorter output; normals have unit length.
///
/// `finals` are those of the skin ([`super::final_poses()`]); a missing joint counts as the identity. Where a vertex or
/// a result is not finite, or a normal has no direction, the result is as documented in [`crate::skin`]. Returns the
/// number of vertices written. Allocates nothing.
pub fn skin_vertices(
    level: SimdLevel,
    vertices: &SkinnedVertices,
    finals: &[Matrix34],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) -> usize {
    let count = vertices.count.min(positions.len()).min(normals.len());
    let (positions, normals) = (&mut positions[..count], &mut normals[..count]);
    level.run(SkinKernel::<false> { vertices, morph_weights: &[], finals, positions, normals });
    count
}

/// As [`skin_vertices`], with morph targets: first their differences are added to each vertex, each times its weight.
///
/// `morph_weights`: one per morph target; missing ones count as 0 ([`crate::sample::sample_morph_weights`] gives those
/// of a take). A vertex that is not finite after that counts as not morphed; otherwise the results are as documented in
/// [`crate::skin`]. Allocates nothing.
pub fn skin_morphed_vertices(
    level: SimdLevel,
    vertices: &SkinnedVertices,
    morph_weights: &[f32],
    finals: &[Matrix34],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) -> usize {
    let count = vertices.count.min(positions.len()).min(normals.len());
    let (positions, normals) = (&mut positions[..count], &mut normals[..count]);
    if vertices.differences.are_added(morph_weights) {
        level.run(SkinKernel::<true> { vertices, morph_weights, finals, positions, normals });
    } else {
        level.run(SkinKernel::<false> { vertices, morph_weights, finals, positions, normals });
    }
    count
}

struct SkinKernel<'a, const MORPHED: bool> {
    vertices: &'a SkinnedVertices,
    morph_weights: &'a [f32],
    finals: &'a [Matrix34],
    positions: &'a mut [[f32; 3]],
    normals: &'a mut [[f32; 3]],
}

impl<const MORPHED: bool> Kernel for SkinKernel<'_, MORPHED> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        if self.vertices.is_narrow && self.positions.len() >= TABLE_THRESHOLD {
            // `black_box` hides the value from the compiler, which then copies whole rows instead of calling a function
            // that fills bytes.
            let mut table = [black_box(PADDED_IDENTITY); NARROW];
            for (row, matrix) in table.iter_mut().zip(self.finals) {
                row.0[..12].copy_from_slice(matrix);
            }
            self.with::<S>(&table);
        } else {
            let finals = self.finals;
            self.with::<S>(finals);
        }
    }
}

/// Eight points, one after the other.
type PointBlock = [f32; 3 * LANES];

impl<const MORPHED: bool> SkinKernel<'_, MORPHED> {
    #[inline(always)]
    fn with<S: Simd>(self, finals: &(impl Finals + ?Sized)) {
        let Self { vertices, morph_weights, positions, normals, .. } = self;
        let (points, last_points) = positions.as_flattened_mut().as_chunks_mut();
        let (directions, last_directions) = normals.as_flattened_mut().as_chunks_mut();
        let mut blocks = vertices.blocks.iter().enumerate();
        let mut matrices = [PADDED_IDENTITY; LANES];
        for ((moved, turned), (at, block)) in points.iter_mut().zip(directions).zip(&mut blocks) {
            weigh_block::<S>(vertices.influences_of(block), finals, &mut matrices);
            if MORPHED {
                let shape = vertices.differences.added::<S>(at, &block.shape, morph_weights);
                move_block::<S>(&shape, &block.shape, &matrices, moved, turned);
            } else {
                move_block::<S>(&block.shape, &block.shape, &matrices, moved, turned);
            }
        }
        // Fewer than eight are left.
        if let Some((at, block)) = blocks.next().filter(|_| !last_points.is_empty()) {
            let (mut moved, mut turned) = ([0.0; 3 * LANES], [0.0; 3 * LANES]);
            weigh_block::<S>(vertices.influences_of(block), finals, &mut matrices);
            let shape = vertices.differences.added::<S>(at, &block.shape, morph_weights);
            move_block::<S>(&shape, &block.shape, &matrices, &mut moved, &mut turned);
            for (to, from) in last_points.iter_mut().zip(&moved) {
                *to = *from;
            }
            for (to, from) in last_directions.iter_mut().zip(&turned) {
                *to = *from;
            }
        }
    }
}

/// A list of final poses.
trait Finals {
    /// Returns rows 0 and 1.
    fn upper<S: Simd>(&self, joint: u16) -> S::F8;
    /// Returns row 2, and four meaningless numbers.
    fn lower<S: Simd>(&self, joint: u16) -> S::F8;
}

impl Finals for [Matrix34] {
    #[inline(always)]
    fn upper<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::load(upper(self.get(usize::from(joint)).unwrap_or(&IDENTITY)))
    }

    #[inline(always)]
    fn lower<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::twice(lower(self.get(usize::from(joint)).unwrap_or(&IDENTITY)))
    }
}

impl Finals for MatrixTable {
    #[inline(always)]
    fn upper<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::load(&self[usize::from(joint as u8)].0.as_chunks().0[0])
    }

    #[inline(always)]
    fn lower<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::load(&self[usize::from(joint as u8)].0.as_chunks().0[1])
    }
}

/// Computes the weighted sum of the matrices of each of eight vertices, for the block's number of influences.
#[inline(always)]
fn weigh_block<S: Simd>(
    influences: &[InfluenceBlock],
    finals: &(impl Finals + ?Sized),
    out: &mut [PaddedMatrix; LANES],
) {
    match influences {
        [a] => weigh::<S, 1>([a], finals, out),
        [a, b] => weigh::<S, 2>([a, b], finals, out),
        [a, b, c, d] => weigh::<S, 4>([a, b, c, d], finals, out),
        [a, b, c, d, e, f, g, h] => weigh::<S, 8>([a, b, c, d, e, f, g, h], finals, out),
        _ => {}
    }
}

/// Computes the sums with the number of influences known at compile time.
#[inline(always)]
fn weigh<S: Simd, const N: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
    out: &mut [PaddedMatrix; LANES],
) {
    // Unrolled, so that every index is known at compile time.
    weigh_one::<S, N>(influences, finals, out, 0);
    weigh_one::<S, N>(influences, finals, out, 1);
    weigh_one::<S, N>(influences, finals, out, 2);
    weigh_one::<S, N>(influences, finals, out, 3);
    weigh_one::<S, N>(influences, finals, out, 4);
    weigh_one::<S, N>(influences, finals, out, 5);
    weigh_one::<S, N>(influences, finals, out, 6);
    weigh_one::<S, N>(influences, finals, out, 7);
}

#[inline(always)]
fn weigh_one<S: Simd, const N: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
    out: &mut [PaddedMatrix; LANES],
    lane: usize,
) {
    let joint = influences[0].joints[lane];
    let weight = S::F8::splat(influences[0].weights[lane]);
    // Row 2 has only four numbers, but is computed in a register of eight too, because a register of four would need
    // the weight broadcast once more.
    let (mut two, mut one) = (finals.upper::<S>(joint) * weight, finals.lower::<S>(joint) * weight);
    for influence in &influences[1..] {
        let (joint, weight) = (influence.joints[lane], S::F8::splat(influence.weights[lane]));
        two = finals.upper::<S>(joint).mul_add(weight, two);
        one = finals.lower::<S>(joint).mul_add(weight, one);
    }
    if let [upper, lower] = out[lane].0.as_chunks_mut().0 {
        two.store(upper);
        one.store(lower);
    }
}

/// Returns row `row` of eight matrices: four vectors, one per column.
#[inline(always)]
fn columns<S: Simd>(matrices: &[PaddedMatrix; LANES], row: usize) -> [S::F8; 4] {
    let [a, b, c, d, e, f, g, h] = matrices;
    let [a, b, c, d] = [a, b, c, d].map(|matrix| &matrix.0.as_chunks::<4>().0[row]);
    let [e, f, g, h] = [e, f, g, h].map(|matrix| &matrix.0.as_chunks::<4>().0[row]);
    S::F8::transpose([
        S::F8::from_halves(a, e),
        S::F8::from_halves(b, f),
        S::F8::from_halves(c, g),
        S::F8::from_halves(d, h),
    ])
}

/// Moves eight vertices; `stored` are their values before morphing.
#[inline(always)]
fn move_block<S: Simd>(
    shape: &ShapeBlock,
    stored: &ShapeBlock,
    matrices: &[PaddedMatrix; LANES],
    moved: &mut PointBlock,
    turned: &mut PointBlock,
) {
    let ([ax, bx, cx, tx], [ay, by, cy, ty]) = (columns::<S>(matrices, 0), columns::<S>(matrices, 1));
    let [az, bz, cz, tz] = columns::<S>(matrices, 2);
    let [x, y, z] = S::F8::load_three(&shape.positions);
    let px = ax.mul_add(x, bx.mul_add(y, cx.mul_add(z, tx)));
    let py = ay.mul_add(x, by.mul_add(y, cy.mul_add(z, ty)));
    let pz = az.mul_add(x, bz.mul_add(y, cz.mul_add(z, tz)));
    S::F8::store_points([px, py, pz], moved);
    // The columns of the cofactors: b×c, c×a, a×b.
    let [fx, fy, fz] = cross::<S>([bx, by, bz], [cx, cy, cz]);
    let [gx, gy, gz] = cross::<S>([cx, cy, cz], [ax, ay, az]);
    let [hx, hy, hz] = cross::<S>([ax, ay, az], [bx, by, bz]);
    let zero = S::F8::splat(0.0);
    let determinant = ax.mul_add(fx, ay.mul_add(fy, az.mul_add(fz, zero)));
    let [x, y, z] = S::F8::load_three(&shape.normals);
    let nx = fx.mul_add(x, gx.mul_add(y, hx * z));
    let ny = fy.mul_add(x, gy.mul_add(y, hy * z));
    let nz = fz.mul_add(x, gz.mul_add(y, hz * z));
    let square = nx.mul_add(nx, ny.mul_add(ny, nz * nz));
    let shrink = (S::F8::splat(1.0) / square.sqrt()).flipped_by(determinant.sign());
    S::F8::store_points([nx * shrink, ny * shrink, nz * shrink], turned);
    // A position that is not finite makes it NaN, which fails every comparison.
    let square = (px + py + pz).mul_add(zero, square);
    let enough = S::F8::splat(1e-24).less(square);
    if !enough.select(square.less(S::F8::splat(1e24)), zero).all() {
        carefully(shape, stored, matrices, moved, turned);
    }
}

#[inline(always)]
fn cross<S: Simd>([ax, ay, az]: [S::F8; 3], [bx, by, bz]: [S::F8; 3]) -> [S::F8; 3] {
    [az.neg_mul_add(by, ay * bz), ax.neg_mul_add(bz, az * bx), ay.neg_mul_add(bx, ax * by)]
}

/// Computes as the open path does, one vertex at a time.
#[cold]
fn carefully(
    shape: &ShapeBlock,
    stored: &ShapeBlock,
    matrices: &[PaddedMatrix; LANES],
    moved: &mut PointBlock,
    turned: &mut PointBlock,
) {
    for (lane, matrix) in matrices.iter().enumerate() {
        let matrix = matrix.0.first_chunk().map_or(Mat4::IDENTITY, mat4);
        let ((position, normal), (old_position, old_normal)) = (shape.get(lane), stored.get(lane));
        let candidates = [matrix.transform_point3(position), old_position];
        let point = candidates.into_iter().find(|point| point.is_finite()).unwrap_or(Vec3::ZERO);
        let upright = near_one(Mat3::from_mat4(matrix)) * normal;
        let direction = first_direction([normal_matrix(matrix) * normal, upright, normal, old_normal]);
        for at in 0..3 {
            (moved[lane * 3 + at], turned[lane * 3 + at]) = (point[at], direction[at]);
        }
    }
}
