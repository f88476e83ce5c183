//! From poses to final matrices, for one character.

use dragonfly_anim::fast::PoseBlock;
use dragonfly_anim::fast::matrix::{IDENTITY, Matrix34};
use dragonfly_anim::fast::simd::{Float4, Float8, Simd};

/// Reason why a matrix can be split into its first eight and its last four numbers.
pub(super) const TWELVE: &str = "a matrix has twelve numbers";

/// Returns `a * b`, computed with two rows in a register.
#[inline(always)]
fn product<S: Simd>(a: &Matrix34, b: &Matrix34) -> Matrix34 {
    let (two, one) =
        (S::F8::load(a.first_chunk().expect(TWELVE)), S::F4::load(a.last_chunk().expect(TWELVE)));
    let rows = b.as_chunks::<4>().0;
    let (x, y, z) = (S::F8::twice(&rows[0]), S::F8::twice(&rows[1]), S::F8::twice(&rows[2]));
    let upper = two.spread::<0>().mul_add(x, two.keep_last());
    let lower = one.spread::<0>().mul_add(x.low(), one.keep_last());
    let upper = two.spread::<1>().mul_add(y, upper);
    let lower = one.spread::<1>().mul_add(y.low(), lower);
    let mut out = IDENTITY;
    two.spread::<2>().mul_add(z, upper).store(out.first_chunk_mut().expect(TWELVE));
    one.spread::<2>().mul_add(z.low(), lower).store(out.last_chunk_mut().expect(TWELVE));
    out
}

/// Returns the three rows of eight matrices `T · R · S`, four columns each.
#[inline(always)]
pub(super) fn to_parent<S: Simd>(pose: &PoseBlock) -> [[S::F8; 4]; 3] {
    let [x, y, z, w] = S::F8::load_four(&pose.rotation);
    let [a, b, c] = S::F8::load_three(&pose.scale);
    let [tx, ty, tz] = S::F8::load_three(&pose.translation);
    let (x2, y2, z2, one) = (x + x, y + y, z + z, S::F8::splat(1.0));
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (not_x, not_y) = (x.neg_mul_add(x2, one), y.neg_mul_add(y2, one));
    [
        [z.neg_mul_add(z2, not_y) * a, w.neg_mul_add(z2, xy) * b, w.mul_add(y2, xz) * c, tx],
        [w.mul_add(z2, xy) * a, z.neg_mul_add(z2, not_x) * b, w.neg_mul_add(x2, yz) * c, ty],
        [w.neg_mul_add(y2, xz) * a, w.mul_add(x2, yz) * b, y.neg_mul_add(y2, not_x) * c, tz],
    ]
}

#[inline(always)]
pub(super) fn to_root<S: Simd>(parents: &[u32], pose: &[PoseBlock], out: &mut [Matrix34]) {
    let mut local = [IDENTITY; 8];
    for (block, pose) in pose.iter().enumerate() {
        let [upper, middle, lower] = to_parent::<S>(pose);
        scatter::<S>(upper, &mut local, 0);
        scatter::<S>(middle, &mut local, 1);
        scatter::<S>(lower, &mut local, 2);
        for (at, local) in local.iter().enumerate() {
            let bone = block * 8 + at;
            out[bone + 1] = product::<S>(&out[parents[bone] as usize], local);
        }
    }
}

#[inline(always)]
pub(super) fn finals<S: Simd>(
    roots: &[Matrix34],
    joints: &[u32],
    offsets: &[Matrix34],
    out: &mut [Matrix34],
) {
    for ((out, &joint), offset) in out.iter_mut().zip(joints).zip(offsets) {
        *out = product::<S>(&roots[joint as usize + 1], offset);
    }
}

/// Writes one row, given by its columns, of eight matrices.
#[inline(always)]
pub(super) fn scatter<S: Simd>(columns: [S::F8; 4], matrices: &mut [Matrix34; 8], row: usize) {
    let twos = S::F8::transpose(columns);
    let [a, b, c, d, e, f, g, h] = matrices;
    twos[0].store_halves(&mut a.as_chunks_mut::<4>().0[row], &mut e.as_chunks_mut::<4>().0[row]);
    twos[1].store_halves(&mut b.as_chunks_mut::<4>().0[row], &mut f.as_chunks_mut::<4>().0[row]);
    twos[2].store_halves(&mut c.as_chunks_mut::<4>().0[row], &mut g.as_chunks_mut::<4>().0[row]);
    twos[3].store_halves(&mut d.as_chunks_mut::<4>().0[row], &mut h.as_chunks_mut::<4>().0[row]);
}
