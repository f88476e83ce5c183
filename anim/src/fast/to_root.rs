//! `to_root` of every bone: bone space → scene space (thesis §2.1.5.1).
//!
//! ```text
//! to_parent_i = T · R · S                       eight bones at once
//! to_root_i   = to_root_parent * to_parent_i    one after the other, parents first, two rows in one register
//! ```
//!
//! With the unit quaternion (x y z w), the scale (a b c) and the translation t:
//!
//! ```text
//!             ┌ a (1 - 2y² - 2z²)   b (2xy - 2zw)       c (2xz + 2yw)      tx ┐
//! to_parent = │ a (2xy + 2zw)       b (1 - 2x² - 2z²)   c (2yz - 2xw)      ty │
//!             └ a (2xz - 2yw)       b (2yz + 2xw)       c (1 - 2x² - 2y²)  tz ┘
//! ```

use super::matrix::{IDENTITY, Matrix34, Rows, mat4, matrix34};
use super::pose::PoseBlock;
use super::rig::Rig;
use super::simd::{Float8, Kernel, Level, Simd};
use glam::Mat4;

/// `to_root` of every bone of one character.
#[derive(Clone, Debug)]
pub struct RootPoses {
    /// The identity, where roots find their parent; then one a lane.
    pub(super) matrices: Vec<Matrix34>,
    bones: usize,
}

impl RootPoses {
    /// Room for the bones of `rig`, all in the origin.
    pub fn new(rig: &Rig) -> Self {
        Self { matrices: vec![IDENTITY; 1 + rig.parents.len() * 8], bones: rig.bones }
    }

    /// One a bone: bone space → scene space.
    pub fn matrices(&self) -> &[Matrix34] {
        &self.matrices[1..=self.bones]
    }

    /// That of `bone`; the identity past the end.
    pub fn get(&self, bone: usize) -> &Matrix34 {
        self.matrices().get(bone).unwrap_or(&IDENTITY)
    }
}

/// Computes `to_root` of every bone from `pose`, the blocks of a pose of `rig`'s bones.
///
/// Where `pose` has fewer blocks than the rig the rest poses stand in. A bone whose product is not finite stands where
/// its parent stands, as on the open path. Allocates nothing, unless `out` was made for another rig.
pub fn to_root(level: Level, rig: &Rig, pose: &[PoseBlock], out: &mut RootPoses) {
    level.run(ToRoot { rig, pose, out });
}

struct ToRoot<'a> {
    rig: &'a Rig,
    pose: &'a [PoseBlock],
    out: &'a mut RootPoses,
}

impl Kernel for ToRoot<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        to_root_with::<S>(self.rig, self.pose, self.out);
    }
}

/// The same, part of a larger kernel.
#[inline(always)]
pub(super) fn to_root_with<S: Simd>(rig: &Rig, pose: &[PoseBlock], out: &mut RootPoses) {
    fit(rig, out);
    let (mut sheared, mut first) = (rig.sheared.as_slice(), 1);
    let mut local = [[[0.0; 8]; 4]; 3];
    let poses = pose.iter().chain(rig.rest().blocks().get(pose.len()..).unwrap_or(&[]));
    for (parents, pose) in rig.parents.iter().zip(poses) {
        to_parent::<S>(pose, &mut local);
        if !sheared.is_empty() {
            sheared = put_sheared(sheared, first - 1, pose, &mut local);
        }
        chain::<S>(parents, &local, &mut out.matrices, first);
        first += 8;
    }
    if !leaves_are_finite::<S>(rig, &out.matrices) {
        carefully(rig, pose, &mut out.matrices);
    }
}

/// Makes room, where `out` was made for another rig.
#[inline(always)]
fn fit(rig: &Rig, out: &mut RootPoses) {
    if out.bones != rig.bones || out.matrices.len() != 1 + rig.parents.len() * 8 {
        *out = RootPoses::new(rig);
    }
}

/// `to_parent` of eight bones: rows of bone `k` in the low halves and of bone `k + 4` in the high halves of `[row][k]`.
type Local = [[[f32; 8]; 4]; 3];

/// `T · R · S` of eight bones.
#[inline(always)]
fn to_parent<S: Simd>(pose: &PoseBlock, local: &mut Local) {
    let [x, y, z, w] = S::F8::load_four(&pose.rotation);
    let [a, b, c] = S::F8::load_three(&pose.scale);
    let [tx, ty, tz] = S::F8::load_three(&pose.translation);
    let (x2, y2, z2, one) = (x + x, y + y, z + z, S::F8::splat(1.0));
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (not_x, not_y) = (x.neg_mul_add(x2, one), y.neg_mul_add(y2, one));
    let upper = [z.neg_mul_add(z2, not_y) * a, w.neg_mul_add(z2, xy) * b, w.mul_add(y2, xz) * c, tx];
    let middle = [w.mul_add(z2, xy) * a, z.neg_mul_add(z2, not_x) * b, w.neg_mul_add(x2, yz) * c, ty];
    let lower = [w.neg_mul_add(y2, xz) * a, w.mul_add(x2, yz) * b, y.neg_mul_add(y2, not_x) * c, tz];
    S::F8::store_four(S::F8::transpose(upper), &mut local[0]);
    S::F8::store_four(S::F8::transpose(middle), &mut local[1]);
    S::F8::store_four(S::F8::transpose(lower), &mut local[2]);
}

/// `to_root` of eight bones, parents first; bone `first - 1 + k` is at `first + k`.
#[inline(always)]
fn chain<S: Simd>(parents: &[u32; 8], local: &Local, out: &mut [Matrix34], first: usize) {
    for (at, &parent) in parents.iter().enumerate() {
        let rows = [half::<S>(&local[0], at), half::<S>(&local[1], at), half::<S>(&local[2], at)];
        let Some(parent) = out.get(parent as usize) else { return };
        let product = Rows::<S>::load(parent).times(rows);
        let Some(out) = out.get_mut(first + at) else { return };
        product.store(out);
    }
}

/// A row of bone `at`, in both halves.
#[inline(always)]
fn half<S: Simd>(row: &[[f32; 8]; 4], at: usize) -> S::F8 {
    S::F8::twice(&row[at % 4].as_chunks::<4>().0[at / 4])
}

/// Puts the matrices of the sheared bones of this block in the place of those that their poses give, where they rest;
/// the sheared bones of later blocks.
fn put_sheared<'a>(
    mut sheared: &'a [super::rig::Sheared],
    first: usize,
    pose: &PoseBlock,
    local: &mut Local,
) -> &'a [super::rig::Sheared] {
    while let Some((next, others)) = sheared.split_first() {
        if next.bone >= first + 8 {
            break;
        }
        let at = next.bone % 8;
        if pose.get(at) == next.rest {
            for (row, from) in local.iter_mut().zip(matrix34(next.matrix).as_chunks::<4>().0) {
                row[at % 4][at / 4 * 4..][..4].copy_from_slice(from);
            }
        }
        sheared = others;
    }
    sheared
}

/// A number that is not finite reaches the leaves: it spreads along its row from parent to child.
#[inline(always)]
fn leaves_are_finite<S: Simd>(rig: &Rig, matrices: &[Matrix34]) -> bool {
    let mut sum = [0.0; 8];
    let (mut upper, mut lower) = (S::F8::splat(0.0), S::F8::splat(0.0));
    for &leaf in &rig.leaves {
        if let Some(leaf) = matrices.get(leaf as usize) {
            upper = S::F8::load(super::matrix::upper(leaf)).mul_add(S::F8::splat(0.0), upper);
            lower = S::F8::twice(super::matrix::lower(leaf)).mul_add(S::F8::splat(0.0), lower);
        }
    }
    (upper + lower).store(&mut sum);
    sum.iter().sum::<f32>() == 0.0
}

/// The open path's way, for poses that lead out of what f32 can hold.
#[cold]
fn carefully(rig: &Rig, pose: &[PoseBlock], out: &mut [Matrix34]) {
    for bone in 0..rig.bones {
        let block = pose.get(bone / 8).or(rig.rest().blocks().get(bone / 8));
        let transform = block.map_or_else(Default::default, |block| block.get(bone));
        let sheared = rig.sheared.iter().find(|sheared| sheared.bone == bone && sheared.rest == transform);
        let to_parent = sheared.map_or_else(|| transform.to_matrix(), |sheared| sheared.matrix);
        let parent = rig.parent(bone).map_or(Mat4::IDENTITY, |parent| mat4(&out[1 + parent]));
        let product = parent * to_parent;
        out[1 + bone] = matrix34(if product.is_finite() { product } else { parent });
    }
}
