//! Skinning on the CPU: positions and normals moved by bones, eight vertices at once (thesis §2.1.4).
//!
//! ```text
//! M        = Σ weight_i * final[joint_i]                    one vertex after the other, or two at once: `weigh.rs`
//! morphed  = stored + Σ weight_t * difference_t             from here on four or eight vertices at once
//! position = M * position
//! normal   = normalize(sign(determinant) * cofactors(M) * normal)
//! ```
//!
//! The sum of matrices and the sum of moved positions are the same; the matrix is used for the normal too. Its
//! cofactors, the transposed inverse but for its length, keep normals at right angles to the surface under any scale;
//! see [`crate::skin`]. [`skin_vertices_by_matrix`] leaves that out.

use super::matrix::{Matrix34, RootMatrix, mat4};
use super::morph::{Differences, ShapeBlock};
use super::simd::{Float8, Kernel, LANES, Rows, Simd, SimdLevel, high, low};
use super::weigh::{
    Finals, InfluenceBlock, NARROW, Sums, WeighedColumns, columns, few, weigh, weigh_carefully,
    weigh_in_memory,
};
use crate::data::{Primitive, Vertices};
use crate::skin::{first_direction, near_one, normal_matrix};
use glam::{Mat3, Vec3};
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

/// Number of vertices from which a table pays off; building it costs about as much as skinning forty of them.
const TABLE_THRESHOLD: usize = 128;

/// Eight vertices; those past the end repeat the first of the eight.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct VertexBlock {
    shape: ShapeBlock,
    /// First of its influences, and number of influences of each of its vertices: 1, 2, 4 or 8.
    first: u32,
    each: u32,
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
        let mut influences = [InfluenceBlock::NOTHING; 8];
        for (lane, index) in lanes.into_iter().enumerate() {
            let position = vertices.positions.get(index).copied().unwrap_or(Vec3::ZERO);
            let normal = vertices.normals.get(index).copied().unwrap_or(Vec3::Y);
            shape.set(lane, position, normal);
            for (slot, influence) in influences.iter_mut().zip(used(index)) {
                slot.set(lane, *influence);
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
    skin::<true>(level, vertices, &[], finals, positions, normals)
}

/// As [`skin_vertices`], but normals are moved by the matrix itself and not normalized, which costs less.
///
/// Right where matrices rotate, and also scale by one factor for all axes; the normals of several influences, and of
/// scaled bones, are then not of unit length, so a shader has to normalize them. A normal that is not finite is left as
/// stored. Allocates nothing.
pub fn skin_vertices_by_matrix(
    level: SimdLevel,
    vertices: &SkinnedVertices,
    finals: &[Matrix34],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) -> usize {
    skin::<false>(level, vertices, &[], finals, positions, normals)
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
    skin::<true>(level, vertices, morph_weights, finals, positions, normals)
}

/// Moves vertices up to the length of the shorter output. `EXACT`: whether normals are exact and of unit length.
fn skin<const EXACT: bool>(
    level: SimdLevel,
    vertices: &SkinnedVertices,
    morph_weights: &[f32],
    finals: &[Matrix34],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) -> usize {
    let count = vertices.count.min(positions.len()).min(normals.len());
    let (positions, normals) = (&mut positions[..count], &mut normals[..count]);
    let wanted = count.div_ceil(LANES);
    level.run(SkinKernel::<EXACT> { wanted, vertices, morph_weights, finals, positions, normals });
    count
}

/// `EXACT`: as for [`skin`].
struct SkinKernel<'a, const EXACT: bool> {
    /// Number of blocks to be moved, the last one possibly in part.
    wanted: usize,
    vertices: &'a SkinnedVertices,
    morph_weights: &'a [f32],
    finals: &'a [Matrix34],
    positions: &'a mut [[f32; 3]],
    normals: &'a mut [[f32; 3]],
}

impl<const EXACT: bool> Kernel for SkinKernel<'_, EXACT> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        if self.vertices.is_narrow && self.positions.len() >= TABLE_THRESHOLD {
            // `black_box` hides the value from the compiler, which then copies whole rows instead of calling a function
            // that fills bytes.
            let mut table = [black_box(RootMatrix::IDENTITY); NARROW];
            for (row, matrix) in table.iter_mut().zip(self.finals) {
                row.set(matrix);
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

impl<const EXACT: bool> SkinKernel<'_, EXACT> {
    #[inline(always)]
    fn with<S: Simd>(self, finals: &(impl Finals + ?Sized)) {
        let Self { vertices, morph_weights, positions, normals, .. } = self;
        let is_morphed = vertices.differences.are_added(morph_weights);
        let (points, last_points) = positions.as_flattened_mut().as_chunks_mut();
        let (directions, last_directions) = normals.as_flattened_mut().as_chunks_mut();
        let (mut points, mut directions) = (points.iter_mut(), directions.iter_mut());
        // For the last block, of which fewer than eight vertices are wanted.
        let (mut moved, mut turned) = ([0.0; 3 * LANES], [0.0; 3 * LANES]);
        let wanted = vertices.blocks.iter().take(self.wanted);
        for (at, block) in wanted.enumerate() {
            let influences = vertices.influences_of(block);
            let (moved, turned) = match (points.next(), directions.next()) {
                (Some(points), Some(directions)) => (points, directions),
                (None, _) | (_, None) => (&mut moved, &mut turned),
            };
            let morphed;
            let shape = if is_morphed {
                morphed = vertices.differences.added::<S>(at, &block.shape, morph_weights);
                &morphed
            } else {
                &block.shape
            };
            if !move_block::<S, EXACT>(influences, shape, finals, moved, turned) {
                let matrices = weigh_carefully(influences, self.finals);
                carefully(EXACT, shape, &block.shape, &matrices, moved, turned);
            }
        }
        for (to, from) in last_points.iter_mut().zip(&moved) {
            *to = *from;
        }
        for (to, from) in last_directions.iter_mut().zip(&turned) {
            *to = *from;
        }
    }
}

/// Moves eight vertices; `shape` are their values after morphing. Returns false if a result is not finite or a normal
/// has no direction.
#[inline(always)]
fn move_block<S: Simd, const EXACT: bool>(
    influences: &[InfluenceBlock],
    shape: &ShapeBlock,
    finals: &(impl Finals + ?Sized),
    moved: &mut PointBlock,
    turned: &mut PointBlock,
) -> bool {
    // Written out, so that the sums stay in registers.
    let is_one = S::Rows::IS_ONE_REGISTER;
    match influences {
        [a] if is_one => move_fours::<S, EXACT>(&weigh::<S, 1>([a], finals), shape, moved, turned),
        [a, b] if is_one => move_fours::<S, EXACT>(&weigh::<S, 2>([a, b], finals), shape, moved, turned),
        [a, b, c, d] if is_one => {
            move_fours::<S, EXACT>(&weigh::<S, 4>([a, b, c, d], finals), shape, moved, turned)
        }
        [a, b, c, d, e, f, g, h] if is_one => {
            let columns = weigh::<S, 8>([a, b, c, d, e, f, g, h], finals);
            move_fours::<S, EXACT>(&columns, shape, moved, turned)
        }
        [a] if S::IS_WIDE => move_by::<S, EXACT>(&few::<S, 1>([a], finals), shape, moved, turned),
        [a, b] if S::IS_WIDE => move_by::<S, EXACT>(&few::<S, 2>([a, b], finals), shape, moved, turned),
        more => {
            let mut matrices = [RootMatrix::IDENTITY; LANES];
            weigh_in_memory::<S>(more, finals, &mut matrices);
            let sums = [columns::<S>(&matrices, 0), columns::<S>(&matrices, 1), columns::<S>(&matrices, 2)];
            move_by::<S, EXACT>(&sums, shape, moved, turned)
        }
    }
}

/// Moves two times four vertices by `columns`. Returns false if a result is not finite or a normal has no direction.
#[inline(always)]
fn move_fours<S: Simd, const EXACT: bool>(
    &[first, last]: &WeighedColumns<S>,
    shape: &ShapeBlock,
    moved: &mut PointBlock,
    turned: &mut PointBlock,
) -> bool {
    let (near, far) = halves(&shape.positions);
    let (a, b) = (S::Rows::moved(first, near), S::Rows::moved(last, far));
    S::Rows::store_points([a, b], moved);
    let sum = a.checked(b.checked(S::Rows::zero()));
    if EXACT {
        let x = S::Rows::joined([first[0], last[0]]);
        let y = S::Rows::joined([first[1], last[1]]);
        let z = S::Rows::joined([first[2], last[2]]);
        return turn_exactly::<S>([x, y, z], S::F8::splat(0.0), shape, turned) && sum.is_number();
    }
    let (near, far) = halves(&shape.normals);
    let (a, b) = (S::Rows::directed(first, near), S::Rows::directed(last, far));
    S::Rows::store_points([a, b], turned);
    a.checked(b.checked(sum)).is_number()
}

/// Returns the coordinates of four of eight points, and of the others.
#[inline(always)]
fn halves([x, y, z]: &[[f32; LANES]; 3]) -> ([&[f32; 4]; 3], [&[f32; 4]; 3]) {
    ([low(x), low(y), low(z)], [high(x), high(y), high(z)])
}

/// Moves eight vertices by `sums`. Returns false if a result is not finite or a normal has no direction.
#[inline(always)]
fn move_by<S: Simd, const EXACT: bool>(
    &[[ax, bx, cx, tx], [ay, by, cy, ty], [az, bz, cz, tz]]: &Sums<S>,
    shape: &ShapeBlock,
    moved: &mut PointBlock,
    turned: &mut PointBlock,
) -> bool {
    let [x, y, z] = S::F8::load_three(&shape.positions);
    let px = ax.mul_add(x, bx.mul_add(y, cx.mul_add(z, tx)));
    let py = ay.mul_add(x, by.mul_add(y, cy.mul_add(z, ty)));
    let pz = az.mul_add(x, bz.mul_add(y, cz.mul_add(z, tz)));
    S::F8::store_points([px, py, pz], moved);
    if EXACT {
        return turn_exactly::<S>([[ax, ay, az], [bx, by, bz], [cx, cy, cz]], px + py + pz, shape, turned);
    }
    let zero = S::F8::splat(0.0);
    let [x, y, z] = S::F8::load_three(&shape.normals);
    let nx = ax.mul_add(x, bx.mul_add(y, cx * z));
    let ny = ay.mul_add(x, by.mul_add(y, cy * z));
    let nz = az.mul_add(x, bz.mul_add(y, cz * z));
    S::F8::store_points([nx, ny, nz], turned);
    // Stays zero while everything is finite.
    let check = (px + py + pz).mul_add(zero, (nx + ny + nz) * zero);
    check.less(S::F8::splat(1.0)).all()
}

/// Turns the normals of eight vertices by the cofactors of matrices with these columns. Returns false if a normal has no
/// direction, or a number of `checked` is not finite.
#[inline(always)]
fn turn_exactly<S: Simd>(
    [a, b, c]: [[S::F8; 3]; 3],
    checked: S::F8,
    shape: &ShapeBlock,
    turned: &mut PointBlock,
) -> bool {
    let zero = S::F8::splat(0.0);
    let [x, y, z] = S::F8::load_three(&shape.normals);
    // The columns of the cofactors.
    let [fx, fy, fz] = cross::<S>(b, c);
    let [gx, gy, gz] = cross::<S>(c, a);
    let [hx, hy, hz] = cross::<S>(a, b);
    let [ax, ay, az] = a;
    let determinant = ax.mul_add(fx, ay.mul_add(fy, az.mul_add(fz, zero)));
    let nx = fx.mul_add(x, gx.mul_add(y, hx * z));
    let ny = fy.mul_add(x, gy.mul_add(y, hy * z));
    let nz = fz.mul_add(x, gz.mul_add(y, hz * z));
    let square = nx.mul_add(nx, ny.mul_add(ny, nz * nz));
    let shrink = (S::F8::splat(1.0) / square.sqrt()).flipped_by(determinant.sign());
    S::F8::store_points([nx * shrink, ny * shrink, nz * shrink], turned);
    // A number that is not finite makes it NaN, which fails every comparison.
    let square = checked.mul_add(zero, square);
    let enough = S::F8::splat(1e-24).less(square);
    enough.select(square.less(S::F8::splat(1e24)), zero).all()
}

#[inline(always)]
fn cross<S: Simd>([ax, ay, az]: [S::F8; 3], [bx, by, bz]: [S::F8; 3]) -> [S::F8; 3] {
    [az.neg_mul_add(by, ay * bz), ax.neg_mul_add(bz, az * bx), ay.neg_mul_add(bx, ax * by)]
}

/// Computes as the open path does, one vertex at a time.
#[cold]
fn carefully(
    is_exact: bool,
    shape: &ShapeBlock,
    stored: &ShapeBlock,
    matrices: &[RootMatrix; LANES],
    moved: &mut PointBlock,
    turned: &mut PointBlock,
) {
    for (lane, matrix) in matrices.iter().enumerate() {
        let matrix = mat4(matrix.packed());
        let ((position, normal), (old_position, old_normal)) = (shape.get(lane), stored.get(lane));
        let candidates = [matrix.transform_point3(position), old_position];
        let point = candidates.into_iter().find(|point| point.is_finite()).unwrap_or(Vec3::ZERO);
        let direction = if is_exact {
            let upright = near_one(Mat3::from_mat4(matrix)) * normal;
            first_direction([normal_matrix(matrix) * normal, upright, normal, old_normal])
        } else {
            let candidates = [matrix.transform_vector3(normal), old_normal];
            candidates.into_iter().find(|normal| normal.is_finite()).unwrap_or(Vec3::ZERO)
        };
        for at in 0..3 {
            (moved[lane * 3 + at], turned[lane * 3 + at]) = (point[at], direction[at]);
        }
    }
}
