//! Positions and normals moved by bones on the CPU, eight vertices at once (thesis §2.1.4).
//!
//! ```text
//! M        = Σ weight_i * final[joint_i]                    one vertex after the other, two rows in one register
//! position = M * position                                   from here on eight vertices at once
//! normal   = normalise(sign(determinant) * cofactors(M) * normal)
//! ```
//!
//! The sum of matrices and the sum of moved positions are the same; the matrix serves the normal too. Its cofactors, the
//! transposed inverse but for its length, keep normals at right angles to the surface under any scale; see
//! [`crate::skin`].

use super::matrix::{IDENTITY, Matrix34, Rows, lower, mat4, upper};
use super::simd::{Float4, Float8, Kernel, LANES, Level, Simd};
use crate::data::Primitive;
use crate::skin::{first_direction, near_one, normal_matrix};
use glam::{Mat3, Mat4, Vec3};

/// Vertices of a primitive brought to the layout of the fast path: eight a block, in file order.
#[derive(Clone, Debug, Default)]
pub struct SkinnedVertices {
    count: usize,
    blocks: Vec<Block>,
    influences: Vec<Influences>,
    /// Does it name no joint past the first 256?
    is_narrow: bool,
}

/// Joints that a byte can name.
const NARROW: usize = 256;

/// Matrices for each name that a byte can be, so that none has to be checked; each on a boundary of its own.
#[derive(Clone)]
#[repr(C, align(64))]
struct Table([[f32; 16]; NARROW]);

/// Eight vertices; those past the end have no influence.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Block {
    positions: [[f32; LANES]; 3],
    normals: [[f32; LANES]; 3],
    /// Where its influences begin, and how many each of its vertices has: 1, 2, 4 or 8.
    first: u32,
    each: u32,
}

/// The `k`-th influence of eight vertices.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Influences {
    joints: [u16; LANES],
    weights: [f32; LANES],
}

impl SkinnedVertices {
    /// The vertices of `primitive`, without morph targets. Positions that are not finite are the origin, normals that
    /// are missing or not finite +Y.
    ///
    /// Each block works with as many influences as the vertex in it that has most: 1, 2, 4 or 8.
    pub fn new(primitive: &Primitive) -> Self {
        let vertices = &primitive.vertices;
        let mut new = Self { count: vertices.len(), is_narrow: true, ..Self::default() };
        for first in (0..vertices.len()).step_by(LANES) {
            let here = first..(first + LANES).min(vertices.len());
            let used = |index: usize| {
                vertices.influences_of(index).iter().filter(|influence| influence.weight != 0.0)
            };
            let most = here.clone().map(|index| used(index).count()).max().unwrap_or(0);
            let each = most.next_power_of_two().clamp(1, 8);
            let mut block = Block {
                positions: [[0.0; LANES]; 3],
                normals: [[0.0; LANES], [1.0; LANES], [0.0; LANES]],
                first: new.influences.len() as u32,
                each: each as u32,
            };
            let nothing = Influences { joints: [0; LANES], weights: [0.0; LANES] };
            new.influences.extend(std::iter::repeat_n(nothing, each));
            for (lane, index) in here.enumerate() {
                let finite =
                    |vector: Option<&Vec3>, other| vector.copied().filter(|v| v.is_finite()).unwrap_or(other);
                let position = finite(vertices.positions.get(index), Vec3::ZERO);
                let normal = finite(vertices.normals.get(index), Vec3::Y);
                for at in 0..3 {
                    block.positions[at][lane] = position[at];
                    block.normals[at][lane] = normal[at];
                }
                for (slot, influence) in new.influences[block.first as usize..].iter_mut().zip(used(index)) {
                    slot.joints[lane] = influence.joint;
                    new.is_narrow &= usize::from(influence.joint) < NARROW;
                    slot.weights[lane] = influence.weight;
                }
            }
            new.blocks.push(block);
        }
        new
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Is there no vertex?
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    fn influences_of(&self, block: &Block) -> &[Influences] {
        let first = block.first as usize;
        self.influences.get(first..first + block.each as usize).unwrap_or(&[])
    }
}

/// Moves the first vertices, as many as both outputs have room for, to scene space; normals have unit length.
///
/// `finals` are those of the skin ([`super::final_poses()`]); a joint that they lack counts as the identity. Where a
/// result is not finite, or a normal has no direction, what [`crate::skin`] says. Returns how many were written.
/// Allocates nothing.
pub fn skin_vertices(
    level: Level,
    vertices: &SkinnedVertices,
    finals: &[Matrix34],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) -> usize {
    let count = vertices.count.min(positions.len()).min(normals.len());
    let (positions, normals) = (&mut positions[..count], &mut normals[..count]);
    level.run(Skin { vertices, finals, positions, normals });
    count
}

struct Skin<'a> {
    vertices: &'a SkinnedVertices,
    finals: &'a [Matrix34],
    positions: &'a mut [[f32; 3]],
    normals: &'a mut [[f32; 3]],
}

impl Kernel for Skin<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        if self.vertices.is_narrow {
            let mut table = Table([[0.0; 16]; NARROW]);
            for (at, row) in table.0.iter_mut().enumerate() {
                row[..12].copy_from_slice(self.finals.get(at).unwrap_or(&IDENTITY));
            }
            self.with::<S>(&table);
        } else {
            let finals = self.finals;
            self.with::<S>(finals);
        }
    }
}

impl Skin<'_> {
    #[inline(always)]
    fn with<S: Simd>(self, finals: &(impl Finals + ?Sized)) {
        let Self { vertices, positions, normals, .. } = self;
        let (positions, normals) = (positions.as_flattened_mut(), normals.as_flattened_mut());
        let mut matrices = [IDENTITY; LANES];
        let (mut last_positions, mut last_normals) = ([0.0; ROOM], [0.0; ROOM]);
        let mut first = 0;
        for block in &vertices.blocks {
            match vertices.influences_of(block) {
                [a] => weigh::<S, 1>([a], finals, &mut matrices),
                [a, b] => weigh::<S, 2>([a, b], finals, &mut matrices),
                [a, b, c, d] => weigh::<S, 4>([a, b, c, d], finals, &mut matrices),
                [a, b, c, d, e, f, g, h] => {
                    weigh::<S, 8>([a, b, c, d, e, f, g, h], finals, &mut matrices);
                }
                _ => {}
            }
            let moved = positions.get_mut(first..).and_then(<[f32]>::first_chunk_mut::<ROOM>);
            let turned = normals.get_mut(first..).and_then(<[f32]>::first_chunk_mut::<ROOM>);
            if let (Some(moved), Some(turned)) = (moved, turned) {
                move_block::<S>(block, &matrices, moved, turned);
            } else {
                move_block::<S>(block, &matrices, &mut last_positions, &mut last_normals);
                let (Some(positions), Some(normals)) = (positions.get_mut(first..), normals.get_mut(first..))
                else {
                    return;
                };
                for (to, from) in positions.iter_mut().zip(&last_positions[..24]) {
                    *to = *from;
                }
                for (to, from) in normals.iter_mut().zip(&last_normals[..24]) {
                    *to = *from;
                }
            }
            first += 3 * LANES;
        }
    }
}

/// Eight points are written as four numbers each, of which the next point overwrites the last: so many more are touched.
const ROOM: usize = 3 * LANES + 1;

/// Where matrices are looked up.
trait Finals {
    fn upper(&self, joint: u16) -> &[f32; 8];
    fn lower(&self, joint: u16) -> &[f32; 4];
}

impl Finals for [Matrix34] {
    #[inline(always)]
    fn upper(&self, joint: u16) -> &[f32; 8] {
        upper(self.get(usize::from(joint)).unwrap_or(&IDENTITY))
    }

    #[inline(always)]
    fn lower(&self, joint: u16) -> &[f32; 4] {
        lower(self.get(usize::from(joint)).unwrap_or(&IDENTITY))
    }
}

impl Finals for Table {
    #[inline(always)]
    fn upper(&self, joint: u16) -> &[f32; 8] {
        &self.0[usize::from(joint as u8)].as_chunks::<8>().0[0]
    }

    #[inline(always)]
    fn lower(&self, joint: u16) -> &[f32; 4] {
        &self.0[usize::from(joint as u8)].as_chunks::<4>().0[2]
    }
}

/// The weighted sum of the matrices of each of eight vertices.
#[inline(always)]
fn weigh<S: Simd, const N: usize>(
    influences: [&Influences; N],
    finals: &(impl Finals + ?Sized),
    out: &mut [Matrix34; LANES],
) {
    // Written out, so that every place is known when it is compiled.
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
    influences: [&Influences; N],
    finals: &(impl Finals + ?Sized),
    out: &mut [Matrix34; LANES],
    lane: usize,
) {
    let joint = influences[0].joints[lane];
    let weight = S::F8::splat(influences[0].weights[lane]);
    let mut two = S::F8::load(finals.upper(joint)) * weight;
    let mut one = S::F4::load(finals.lower(joint)) * weight.low();
    for influence in &influences[1..] {
        let (joint, weight) = (influence.joints[lane], S::F8::splat(influence.weights[lane]));
        two = S::F8::load(finals.upper(joint)).mul_add(weight, two);
        one = S::F4::load(finals.lower(joint)).mul_add(weight.low(), one);
    }
    Rows::<S>(two, one).store(&mut out[lane]);
}

/// Row `row` of eight matrices: four vectors, one a column.
#[inline(always)]
fn columns<S: Simd>(matrices: &[Matrix34; LANES], row: usize) -> [S::F8; 4] {
    let [a, b, c, d, e, f, g, h] = matrices;
    let [a, b, c, d] = [a, b, c, d].map(|matrix| &matrix.as_chunks::<4>().0[row]);
    let [e, f, g, h] = [e, f, g, h].map(|matrix| &matrix.as_chunks::<4>().0[row]);
    S::F8::transpose([
        S::F8::from_halves(a, e),
        S::F8::from_halves(b, f),
        S::F8::from_halves(c, g),
        S::F8::from_halves(d, h),
    ])
}

/// Moves eight vertices.
#[inline(always)]
fn move_block<S: Simd>(
    block: &Block,
    matrices: &[Matrix34; LANES],
    moved: &mut [f32; ROOM],
    turned: &mut [f32; ROOM],
) {
    let ([ax, bx, cx, tx], [ay, by, cy, ty]) = (columns::<S>(matrices, 0), columns::<S>(matrices, 1));
    let [az, bz, cz, tz] = columns::<S>(matrices, 2);
    let [x, y, z] = S::F8::load_three(&block.positions);
    let px = ax.mul_add(x, bx.mul_add(y, cx.mul_add(z, tx)));
    let py = ay.mul_add(x, by.mul_add(y, cy.mul_add(z, ty)));
    let pz = az.mul_add(x, bz.mul_add(y, cz.mul_add(z, tz)));
    store_points::<S>([px, py, pz], moved);
    // The columns of the cofactors: b×c, c×a, a×b.
    let [fx, fy, fz] = cross::<S>([bx, by, bz], [cx, cy, cz]);
    let [gx, gy, gz] = cross::<S>([cx, cy, cz], [ax, ay, az]);
    let [hx, hy, hz] = cross::<S>([ax, ay, az], [bx, by, bz]);
    let zero = S::F8::splat(0.0);
    let determinant = ax.mul_add(fx, ay.mul_add(fy, az.mul_add(fz, zero)));
    let [x, y, z] = S::F8::load_three(&block.normals);
    let nx = fx.mul_add(x, gx.mul_add(y, hx * z));
    let ny = fy.mul_add(x, gy.mul_add(y, hy * z));
    let nz = fz.mul_add(x, gz.mul_add(y, hz * z));
    let square = nx.mul_add(nx, ny.mul_add(ny, nz * nz));
    let shrink = (S::F8::splat(1.0) / square.sqrt()).flipped_by(determinant.sign());
    store_points::<S>([nx * shrink, ny * shrink, nz * shrink], turned);
    // Written so that NaN is not as it should be.
    let healthy = S::F8::splat(1e-24).less(square).select(square.less(S::F8::splat(1e24)), zero);
    let finite = (px + py + pz).abs().less(S::F8::splat(f32::INFINITY));
    if healthy.select(finite, zero).select(zero, -zero).any() {
        carefully(block, matrices, moved, turned);
    }
}

#[inline(always)]
fn cross<S: Simd>([ax, ay, az]: [S::F8; 3], [bx, by, bz]: [S::F8; 3]) -> [S::F8; 3] {
    [az.neg_mul_add(by, ay * bz), ax.neg_mul_add(bz, az * bx), ay.neg_mul_add(bx, ax * by)]
}

/// From eight x, y and z to eight points.
#[inline(always)]
fn store_points<S: Simd>([x, y, z]: [S::F8; 3], to: &mut [f32; ROOM]) {
    let [a, b, c, d] = S::F8::transpose([x, y, z, z]);
    store_at::<S>(a.low(), to, 0);
    store_at::<S>(b.low(), to, 3);
    store_at::<S>(c.low(), to, 6);
    store_at::<S>(d.low(), to, 9);
    store_at::<S>(a.high(), to, 12);
    store_at::<S>(b.high(), to, 15);
    store_at::<S>(c.high(), to, 18);
    store_at::<S>(d.high(), to, 21);
}

#[inline(always)]
fn store_at<S: Simd>(point: S::F4, to: &mut [f32; ROOM], at: usize) {
    if let Some(to) = to.get_mut(at..).and_then(<[f32]>::first_chunk_mut) {
        point.store(to);
    }
}

/// The open path's way, one by one.
#[cold]
fn carefully(block: &Block, matrices: &[Matrix34; LANES], moved: &mut [f32; ROOM], turned: &mut [f32; ROOM]) {
    for lane in 0..LANES {
        let matrix: Mat4 = mat4(&matrices[lane]);
        let three = |rows: &[[f32; LANES]; 3]| Vec3::new(rows[0][lane], rows[1][lane], rows[2][lane]);
        let (position, normal) = (three(&block.positions), three(&block.normals));
        let point = matrix.transform_point3(position);
        let point = if point.is_finite() { point } else { position };
        let candidates = [normal_matrix(matrix) * normal, near_one(Mat3::from_mat4(matrix)) * normal, normal];
        let direction = first_direction(candidates);
        for at in 0..3 {
            (moved[lane * 3 + at], turned[lane * 3 + at]) = (point[at], direction[at]);
        }
    }
}
