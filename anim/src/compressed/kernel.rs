//! Decoding of a pose from two keys: eight bones at once, or sixteen where registers are that wide; and independent of
//! the time decoded before.
//!
//! Each number of each lane is masked out of its word and gives the component
//!
//! ```text
//! value = start + step * number
//! ```
//!
//! Vectors are then interpolated; rotations get their w restored and are slerped with the weights of [`Slerp`].

use super::head::{HeadPair, WideBlock};
use super::lane_groups::LaneGroup;
use super::slerp::Slerp;
use super::table::{ReferencePair, Tables};
use crate::fast::PoseBlock;
use crate::fast::simd::{Arithmetic, Float8, Kernel, LANES, RowPair, Rows, Simd, Word8};

/// Applies an expression to each of three components. An array's `map` would be shorter, but its closure is not
/// compiled with the instructions of the SIMD level.
macro_rules! three {
    ($axis:ident => $each:expr) => {
        [
            {
                let $axis = 0_usize;
                $each
            },
            {
                let $axis = 1_usize;
                $each
            },
            {
                let $axis = 2_usize;
                $each
            },
        ]
    };
}

/// Decodes what moves of a pose.
pub(super) struct Decode<'a> {
    pub(super) tables: &'a Tables,
    pub(super) bytes: &'a [u8],
    /// Seconds.
    pub(super) time: f32,
    pub(super) out: &'a mut [PoseBlock],
}

/// The two keys to decode, and the fraction of the time between them.
#[derive(Clone, Copy, Debug)]
struct KeyPair<'a> {
    bytes: &'a [u8],
    wide: &'a [WideBlock],
    /// The segment of each key.
    segments: [usize; 2],
    /// The first byte of each key.
    rows: [u32; 2],
    mix: f32,
}

/// Returns the key before `time`, and the fraction of the way to the next one.
///
/// The same result as [`crate::sample::find_keys`] gives for the times of the decompressed take.
#[inline(always)]
fn around(tables: &Tables, time: f32) -> (u32, f32) {
    let (clock, last) = (&tables.clock, tables.clock.frames - 1);
    let at = |key: u32| clock.time(key, tables.interval);
    // The conversion turns NaN and negative numbers into zero.
    let guess = ((f64::from(time) - f64::from(clock.start)) * tables.keys_per_second) as u32;
    if guess < last {
        let (before, after) = (at(guess), at(guess + 1));
        if time >= before && time < after {
            return (guess, (time - before) / (after - before));
        }
    }
    // The guess is off by rounding; or the time is outside, or NaN.
    let key = match guess.min(last) {
        key if key > 0 && time < at(key) => key - 1,
        key if key < last && time >= at(key + 1) => key + 1,
        key => key,
    };
    if key == last {
        return (last, 0.0);
    }
    let (before, after) = (at(key), at(key + 1));
    let mix = (time - before) / (after - before);
    // NaN and negative numbers become zero.
    (key, if mix > 0.0 { mix.min(1.0) } else { 0.0 })
}

impl<'a> KeyPair<'a> {
    #[inline(always)]
    fn new(tables: &'a Tables, bytes: &'a [u8], key: u32, mix: f32) -> Option<Self> {
        // Checked once here, so that the loads need no check of their own.
        if bytes.len() < super::extents::AHEAD {
            return None;
        }
        let after = (key + 1).min(tables.clock.frames - 1);
        let segment = |key: u32| (key >> tables.shift) as usize;
        let row = |key: u32| {
            let place = tables.segments.get(segment(key))?;
            Some(place.at.wrapping_add(place.stride.wrapping_mul(key & ((1 << tables.shift) - 1))))
        };
        let rows = [row(key)?, row(after)?];
        Some(Self { bytes, wide: &tables.wide, segments: [segment(key), segment(after)], rows, mix })
    }

    /// Decodes all packed channels. `ONE`: whether both keys are in one segment.
    #[inline(always)]
    fn put<S: Simd, const ONE: bool>(&self, tables: &Tables, out: &mut [PoseBlock]) {
        let slerp = Slerp::at(self.mix);
        let here = tables.heads_of(self.segments[0]);
        let there = if ONE { here } else { tables.heads_of(self.segments[1]) };
        let pair = |index: usize| -> Option<[&HeadPair; 2]> {
            let pair = here.get(index)?;
            Some([pair, if ONE { pair } else { there.get(index)? }])
        };
        // Two groups in one register, where there is one that wide.
        let paired = if S::Rows::IS_ONE_REGISTER { tables.turning.len() / 2 } else { 0 };
        let (groups, others) = tables.turning.split_at(2 * paired);
        for ((index, groups), reference) in
            groups.as_chunks::<2>().0.iter().enumerate().zip(&tables.references)
        {
            let Some(heads) = pair(index) else { return };
            let [a, b] = if heads.iter().any(|head| head.is_wide(0) || head.is_wide(1)) {
                [self.turned::<S, 0>(reference, heads, &slerp), self.turned::<S, 1>(reference, heads, &slerp)]
            } else {
                self.two_turned::<S>(reference, heads, &slerp)
            };
            put_rotations::<S>(&groups[0], a, out);
            put_rotations::<S>(&groups[1], b, out);
        }
        for (index, groups) in (paired..).zip(others.chunks(2)) {
            let (Some(heads), Some(reference)) = (pair(index), tables.references.get(index)) else { return };
            if let Some(group) = groups.first() {
                put_rotations::<S>(group, self.turned::<S, 0>(reference, heads, &slerp), out);
            }
            if let Some(group) = groups.get(1) {
                put_rotations::<S>(group, self.turned::<S, 1>(reference, heads, &slerp), out);
            }
        }
        let (from, to) = (S::F8::splat(1.0 - self.mix), S::F8::splat(self.mix));
        let mut next = tables.turning.len();
        for (part, groups) in tables.moving.iter().enumerate() {
            for group in groups {
                let Some(heads) = pair(next / 2) else { return };
                let [a, b] =
                    if next.is_multiple_of(2) { self.keys::<S, 0>(heads) } else { self.keys::<S, 1>(heads) };
                next += 1;
                let vector = three!(axis => b[axis].mul_add(to, a[axis] * from));
                put_vectors::<S>(group, vector, part, out);
            }
        }
    }

    /// Decodes the rotations of group `HALF` of a pair, from its heads in the segment of each key.
    #[inline(always)]
    fn turned<S: Simd, const HALF: usize>(
        &self,
        reference: &ReferencePair,
        heads: [&HeadPair; 2],
        slerp: &Slerp,
    ) -> [S::F8; 4] {
        let [a, b] = self.keys::<S, HALF>(heads);
        let ([x, y, z, w], half) = (&reference.rows, HALF % 2);
        let reference =
            [S::F8::load(&x[half]), S::F8::load(&y[half]), S::F8::load(&z[half]), S::F8::load(&w[half])];
        relative_to(reference, slerp.mix::<S>(with_w(a), with_w(b)))
    }

    /// Decodes the rotations of two groups, of which none is wide.
    #[inline(always)]
    fn two_turned<S: Simd>(
        &self,
        reference: &ReferencePair,
        heads: [&HeadPair; 2],
        slerp: &Slerp,
    ) -> [[S::F8; 4]; 2] {
        let (a, b) =
            (self.two_groups::<S>(self.rows[0], heads[0]), self.two_groups::<S>(self.rows[1], heads[1]));
        let [x, y, z, w] = &reference.rows;
        let reference = [S::Pair::load(x), S::Pair::load(y), S::Pair::load(z), S::Pair::load(w)];
        let [x, y, z, w] = relative_to(reference, slerp.mix_two::<S>(with_w(a), with_w(b)));
        let ([x, p], [y, q], [z, r], [w, s]) = (x.rows(), y.rows(), z.rows(), w.rows());
        [[x, y, z, w], [p, q, r, s]]
    }

    /// Decodes the components of group `HALF` of a pair at the two keys.
    #[inline(always)]
    fn keys<S: Simd, const HALF: usize>(&self, heads: [&HeadPair; 2]) -> [[S::F8; 3]; 2] {
        [self.key::<S, HALF>(self.rows[0], heads[0]), self.key::<S, HALF>(self.rows[1], heads[1])]
    }

    /// Decodes the components of two groups at the key whose first byte is `row`.
    #[inline(always)]
    fn two_groups<S: Simd>(&self, row: u32, heads: &HeadPair) -> [S::Pair; 3] {
        let at = [row.wrapping_add(heads.at[0]) as usize, row.wrapping_add(heads.at[1]) as usize];
        let first = S::Pair::near(self.bytes, at, heads.second, &heads.words[0]);
        let second = S::Pair::near(self.bytes, at, heads.second, &heads.words[1]);
        let words = [first, first, second];
        three!(axis => {
            let number = S::Pair::masked(words[axis], &heads.masks[axis]);
            let step = S::Pair::from_high_bits(&heads.step[axis]);
            number.times_plus(step, S::Pair::load(&heads.start[axis]))
        })
    }

    /// Decodes the components of group `HALF` of a pair at the key whose first byte is `row`.
    #[inline(always)]
    fn key<S: Simd, const HALF: usize>(&self, row: u32, heads: &HeadPair) -> [S::F8; 3] {
        let half = HALF % 2;
        if heads.is_wide(half) {
            return self.wide_key::<S, HALF>(row, heads);
        }
        let (at, second) = (row.wrapping_add(heads.at[half]) as usize, heads.second[half]);
        let first = S::U8::near(self.bytes, at, second, &heads.words[0][half]);
        let second = S::U8::near(self.bytes, at, second, &heads.words[1][half]);
        [
            value::<S, HALF>(first, heads, 0),
            value::<S, HALF>(first, heads, 1),
            value::<S, HALF>(second, heads, 2),
        ]
    }

    /// As [`Self::key`], for lanes of which not all numbers are in one word.
    #[inline(always)]
    fn wide_key<S: Simd, const HALF: usize>(&self, row: u32, heads: &HeadPair) -> [S::F8; 3] {
        let none = WideBlock { bits: [[0; LANES]; 3] };
        let wide = self.wide.get(heads.at[HALF % 2] as usize).unwrap_or(&none);
        three!(axis => {
            let bits = S::U8::load(&wide.bits[axis]);
            let at = S::U8::splat(row) + bits.shifted_right(S::U8::splat(3));
            value::<S, HALF>(S::U8::gather(self.bytes, at), heads, axis)
        })
    }
}

/// Returns the component whose number is in `word`, of group `HALF` of a pair.
#[inline(always)]
fn value<S: Simd, const HALF: usize>(word: S::U8, heads: &HeadPair, axis: usize) -> S::F8 {
    let half = HALF % 2;
    let number = word & S::U8::load(&heads.masks[axis][half]);
    let step = S::U8::from_u16(&heads.step[axis][half]).shifted_left(S::U8::splat(16)).as_float();
    number.to_float().mul_add(step, S::F8::load(&heads.start[axis][half]))
}

/// Writes the rotations of a group.
#[inline(always)]
fn put_rotations<S: Simd>(group: &LaneGroup, rotation: [S::F8; 4], out: &mut [PoseBlock]) {
    if let Some(block) = group.block {
        if let Some(out) = out.get_mut(block as usize) {
            S::F8::store_four(rotation, &mut out.rotation);
        }
        return;
    }
    for shared in &group.shared {
        if let Some(out) = out.get_mut(shared.block as usize) {
            let picked = picked::<S, 4>(rotation, &shared.lanes, S::F8::load_four(&out.rotation));
            S::F8::store_four(picked, &mut out.rotation);
        }
    }
}

/// Writes the translations or scales of a group.
#[inline(always)]
fn put_vectors<S: Simd>(group: &LaneGroup, vector: [S::F8; 3], part: usize, out: &mut [PoseBlock]) {
    if let Some(block) = group.block {
        if let Some(out) = out.get_mut(block as usize) {
            S::F8::store_three(vector, vectors(out, part));
        }
        return;
    }
    for shared in &group.shared {
        if let Some(out) = out.get_mut(shared.block as usize) {
            let rows = vectors(out, part);
            let picked = picked::<S, 3>(vector, &shared.lanes, S::F8::load_three(rows));
            S::F8::store_three(picked, rows);
        }
    }
}

/// Returns the translations or scales.
#[inline(always)]
fn vectors(block: &mut PoseBlock, part: usize) -> &mut [[f32; LANES]; 3] {
    if part == 0 { &mut block.translation } else { &mut block.scale }
}

/// Returns `rows` of a block with the lanes that it has in a group.
#[inline(always)]
fn picked<S: Simd, const ROWS: usize>(
    group: [S::F8; ROWS],
    lanes: &[u32; LANES],
    mut rows: [S::F8; ROWS],
) -> [S::F8; ROWS] {
    for (row, group) in rows.iter_mut().zip(group) {
        *row = group.picked(lanes, *row);
    }
    rows
}

impl Kernel for Decode<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { tables, bytes, time, out } = self;
        let (key, mix) = around(tables, time);
        if let Some(keys) = KeyPair::new(tables, bytes, key, mix) {
            if keys.segments[0] == keys.segments[1] {
                keys.put::<S, true>(tables, out);
            } else {
                keys.put::<S, false>(tables, out);
            }
        }
        if !tables.whole.is_empty() {
            let after = (key + 1).min(tables.clock.frames - 1);
            super::whole::put(&tables.whole, bytes, [key, after], mix, out);
        }
    }
}

/// Returns the rotations that are `rotation` relative to `reference`.
#[inline(always)]
fn relative_to<A: Arithmetic>([p, q, r, s]: [A; 4], [x, y, z, w]: [A; 4]) -> [A; 4] {
    [
        r.times_from(y, q.times_plus(z, p.times_plus(w, s * x))),
        p.times_from(z, r.times_plus(x, q.times_plus(w, s * y))),
        q.times_from(x, p.times_plus(y, r.times_plus(w, s * z))),
        r.times_from(z, q.times_from(y, p.times_from(x, s * w))),
    ]
}

/// Appends the fourth component of unit quaternions, which is not negative.
#[inline(always)]
fn with_w<A: Arithmetic>([x, y, z]: [A; 3]) -> [A; 4] {
    let rest = z.times_from(z, y.times_from(y, x.times_from(x, A::all(1.0))));
    [x, y, z, rest.larger(A::all(0.0)).root()]
}
