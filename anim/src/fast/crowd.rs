//! Several characters of one rig at once, one for each number of the widest register: from their poses to their final
//! matrices, one character in each lane.
//!
//! ```text
//! poses                           eight bones of one character in a register
//! to_parent, to_root, final_pose  one bone of eight or sixteen characters in a register
//! ```
//!
//! No product waits for another lane, and none needs its numbers moved within a register, so a bone costs less than half
//! as much as one of a single character. Bones that no joint needs are left out. Each number is the result of the same
//! operations as for a single character, in the same order.

use super::binding::{BoneUse, BoundJoint, SkinBinding};
use super::local::local_rows;
use super::matrix::Matrix34;
use super::played::PlayedPose;
use super::pose::PoseBlock;
use super::rig::Rig;
use super::simd::{Kernel, LANES, MOST_LANES, Many, Simd};
use super::still::StillPose;
use std::array::from_fn;
use std::sync::Arc;

/// Memory for one character in each lane.
#[derive(Clone, Debug)]
pub(super) struct Crowd {
    poses: [PlayedPose; MOST_LANES],
    /// The pose of each lane.
    places: [usize; MOST_LANES],
    /// A matrix of every lane for no bone, the parent of roots, and one for each bone.
    matrices: Vec<f32>,
}

/// The twelve numbers of a matrix, each of all characters.
type CrowdMatrix<M> = [<M as Many>::Numbers; 12];

/// The poses of eight bones of the characters: the four numbers of the rotation, then translation and scale, each with
/// one entry for each bone.
#[repr(C, align(64))]
struct CrowdPoses<M: Many>([[M::Numbers; LANES]; 10]);

/// Size of the widest register in bytes. Memory starts at a multiple of it, so that no load needs two cache lines.
const ALIGNMENT: usize = 64;

impl Crowd {
    /// Allocates memory for characters of `rig`.
    pub(super) fn new(rig: &Rig) -> Self {
        Self {
            poses: from_fn(|_| PlayedPose::new(rig)),
            places: from_fn(|lane| lane),
            matrices: vec![0.0; (1 + rig.bones()) * 12 * MOST_LANES + ALIGNMENT / size_of::<f32>()],
        }
    }

    /// Gives each of the first `count` lanes a pose, if possible one that contains what does not move of its take
    /// already: `wanted` is that of each lane.
    #[inline(always)]
    pub(super) fn assign(&mut self, wanted: &[Option<&Arc<StillPose>>; MOST_LANES], count: usize) {
        let mut is_free = [true; MOST_LANES];
        let mut is_served = [false; MOST_LANES];
        for (lane, wanted) in wanted.iter().enumerate().take(count) {
            let mut at = lane;
            for _ in 0..count {
                if is_free[at % MOST_LANES] && self.poses[at % MOST_LANES].contains(*wanted) {
                    (self.places[lane], is_free[at % MOST_LANES], is_served[lane]) = (at, false, true);
                    break;
                }
                at = if at + 1 < count { at + 1 } else { 0 };
            }
        }
        let mut left = (0..count).filter(|&at| is_free[at % MOST_LANES]);
        for (place, _) in self.places.iter_mut().zip(is_served).take(count).filter(|(_, served)| !served) {
            *place = left.next().unwrap_or(0);
        }
    }

    /// Returns the pose of `lane`, to be written.
    #[inline(always)]
    pub(super) fn pose(&mut self, lane: usize) -> &mut PlayedPose {
        &mut self.poses[self.places[lane % MOST_LANES] % MOST_LANES]
    }
}

/// Computes the final matrices from the poses of a crowd: those of one character after those of the other. Returns whether all
/// are finite; otherwise the characters have to be computed one by one.
pub(super) struct CrowdFinals<'a> {
    pub(super) crowd: &'a mut Crowd,
    pub(super) rig: &'a Rig,
    pub(super) binding: &'a SkinBinding,
    pub(super) out: &'a mut [Matrix34],
}

impl Kernel for CrowdFinals<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self) -> bool {
        let Self { crowd, rig, binding, out } = self;
        final_matrices::<S::Many>(crowd, rig, binding, out)
    }
}

#[inline(always)]
fn final_matrices<M: Many>(
    crowd: &mut Crowd,
    rig: &Rig,
    binding: &SkinBinding,
    out: &mut [Matrix34],
) -> bool {
    let Crowd { poses, places, matrices } = crowd;
    let start = matrices.as_ptr().align_offset(ALIGNMENT).min(matrices.len());
    let matrices = M::numbers_of(&mut matrices[start..]).as_chunks_mut().0;
    if let Some(first) = matrices.first_mut() {
        *first = [M::ZEROS; 12];
        M::all(1.0).put(&mut first[0]);
        M::all(1.0).put(&mut first[5]);
        M::all(1.0).put(&mut first[10]);
    }
    let poses = from_fn(|lane| poses[places[lane] % MOST_LANES].blocks());
    pose_bones::<M>(rig, binding, &poses, matrices, out).is_some_and(M::is_number)
}

/// Computes `to_root` of every bone that a joint needs, and the final matrices, of each character. Returns NaN in some
/// places if not all are finite; `None` if not all could be computed.
#[inline(always)]
fn pose_bones<M: Many>(
    rig: &Rig,
    binding: &SkinBinding,
    blocks: &[&[PoseBlock]; MOST_LANES],
    matrices: &mut [CrowdMatrix<M>],
    out: &mut [Matrix34],
) -> Option<M> {
    let mut sum = M::all(0.0);
    let mut bones = CrowdPoses::<M>([[M::ZEROS; LANES]; 10]);
    for (block, (parents, uses)) in rig.parents().chunks(LANES).zip(binding.uses().chunks(LANES)).enumerate()
    {
        if uses.iter().all(|used| *used == BoneUse::NotNeeded) {
            continue;
        }
        turn::<M>(blocks, block, &mut bones);
        for (lane, (&parent, &used)) in parents.iter().zip(uses).enumerate() {
            if used == BoneUse::NotNeeded {
                continue;
            }
            // A parent comes before its children.
            let (before, own) = matrices.split_at_mut_checked(1 + block * LANES + lane)?;
            let (parent, own) = (before.get(parent as usize)?, own.first_mut()?);
            bone::<M>(&bones, lane, parent, own);
            if let BoneUse::Joint(joint) = used {
                sum = finals::<M>(own, binding, joint as usize, out, sum)?;
            }
        }
    }
    for further in binding.further() {
        let bound = binding.list().get(further.joint as usize)?;
        let to_root = matrices.get(bound.slot as usize)?;
        sum = finals::<M>(to_root, binding, further.joint as usize, out, sum)?;
    }
    Some(sum)
}

/// Turns the poses of eight bones of each character, so that those of one bone are in one register.
#[inline(always)]
fn turn<M: Many>(poses: &[&[PoseBlock]; MOST_LANES], block: usize, out: &mut CrowdPoses<M>) {
    const NONE: &PoseBlock = &PoseBlock::IDENTITY;
    let mut blocks = [NONE; MOST_LANES];
    for (to, pose) in blocks.iter_mut().zip(poses).take(M::COUNT) {
        *to = pose.get(block).unwrap_or(NONE);
    }
    let [x, y, z, w, tx, ty, tz, sx, sy, sz] = &mut out.0;
    for (at, out) in [x, y, z, w].into_iter().enumerate() {
        M::turn(&blocks.map(|block| &block.rotation[at]), out);
    }
    for (at, out) in [tx, ty, tz].into_iter().enumerate() {
        M::turn(&blocks.map(|block| &block.translation[at]), out);
    }
    for (at, out) in [sx, sy, sz].into_iter().enumerate() {
        M::turn(&blocks.map(|block| &block.scale[at]), out);
    }
}

/// Computes `to_root` of bone `lane` of the eight bones in `bones`.
#[inline(always)]
fn bone<M: Many>(bones: &CrowdPoses<M>, lane: usize, parent: &CrowdMatrix<M>, own: &mut CrowdMatrix<M>) {
    let lane = lane % LANES;
    let [x, y, z, w, tx, ty, tz, a, b, c] = &bones.0;
    let local = local_rows::<M>(
        [M::get(&x[lane]), M::get(&y[lane]), M::get(&z[lane]), M::get(&w[lane])],
        [M::get(&tx[lane]), M::get(&ty[lane]), M::get(&tz[lane])],
        [M::get(&a[lane]), M::get(&b[lane]), M::get(&c[lane])],
    );
    product_row::<M, 0>(parent, &local, own);
    product_row::<M, 1>(parent, &local, own);
    product_row::<M, 2>(parent, &local, own);
}

/// Computes row `ROW` of `parent * local`.
#[inline(always)]
fn product_row<M: Many, const ROW: usize>(
    parent: &CrowdMatrix<M>,
    [[l00, l01, l02, l03], [l10, l11, l12, l13], [l20, l21, l22, l23]]: &[[M; 4]; 3],
    out: &mut CrowdMatrix<M>,
) {
    let at = ROW % 3 * 4;
    let (a, b) = (M::get(&parent[at]), M::get(&parent[at + 1]));
    let (c, d) = (M::get(&parent[at + 2]), M::get(&parent[at + 3]));
    c.times_plus(*l20, b.times_plus(*l10, a * *l00)).put(&mut out[at]);
    c.times_plus(*l21, b.times_plus(*l11, a * *l01)).put(&mut out[at + 1]);
    c.times_plus(*l22, b.times_plus(*l12, a * *l02)).put(&mut out[at + 2]);
    c.times_plus(*l23, b.times_plus(*l13, a.times_plus(*l03, d))).put(&mut out[at + 3]);
}

/// Computes `final_pose` of a joint of each character. Returns `sum`, with NaN where one is not finite; `None` if `out`
/// is too short.
#[inline(always)]
fn finals<M: Many>(
    to_root: &CrowdMatrix<M>,
    binding: &SkinBinding,
    joint: usize,
    out: &mut [Matrix34],
    sum: M,
) -> Option<M> {
    let BoundJoint { offset, .. } = binding.list().get(joint)?;
    let rows = [
        final_row::<M, 0>(to_root, offset),
        final_row::<M, 1>(to_root, offset),
        final_row::<M, 2>(to_root, offset),
    ];
    let sum = checked::<M>(&rows, sum);
    M::store_matrices(&rows, out, joint, binding.joints()).then_some(sum)
}

/// Computes row `ROW` of `to_root * offset`.
#[inline(always)]
fn final_row<M: Many, const ROW: usize>(to_root: &CrowdMatrix<M>, [i, j, k]: &[[f32; 4]; 3]) -> [M; 4] {
    let at = ROW % 3 * 4;
    let (x, y) = (M::get(&to_root[at]), M::get(&to_root[at + 1]));
    let (z, t) = (M::get(&to_root[at + 2]), M::get(&to_root[at + 3]));
    [
        z.times_plus(M::all(k[0]), y.times_plus(M::all(j[0]), x * M::all(i[0]))),
        z.times_plus(M::all(k[1]), y.times_plus(M::all(j[1]), x * M::all(i[1]))),
        z.times_plus(M::all(k[2]), y.times_plus(M::all(j[2]), x * M::all(i[2]))),
        z.times_plus(M::all(k[3]), y.times_plus(M::all(j[3]), x.times_plus(M::all(i[3]), t))),
    ]
}

/// Returns `sum`, with NaN where a number of `rows` is not finite.
#[inline(always)]
fn checked<M: Many>([[a, b, c, d], [e, f, g, h], [i, j, k, l]]: &[[M; 4]; 3], sum: M) -> M {
    let zero = M::all(0.0);
    let sum = d.times_plus(zero, c.times_plus(zero, b.times_plus(zero, a.times_plus(zero, sum))));
    let sum = h.times_plus(zero, g.times_plus(zero, f.times_plus(zero, e.times_plus(zero, sum))));
    l.times_plus(zero, k.times_plus(zero, j.times_plus(zero, i.times_plus(zero, sum))))
}
