//! Decoding of a pose from two keys: eight bones at once, and independent of the time decoded before.
//!
//! Each number of each lane is masked out of its word and gives the component
//!
//! ```text
//! value = start + step * number
//! ```
//!
//! Vectors are then interpolated; rotations get their w restored and are slerped with the weights of [`Slerp`].

use super::head::{HeadBlock, WideBlock};
use super::slerp::Slerp;
use super::table::{Tables, Turning};
use crate::fast::PoseBlock;
use crate::fast::simd::{Float8, Kernel, LANES, Simd, Word8};

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
        let (mut here, mut there) = (here.iter(), there.iter());
        for Turning { reference, group } in &tables.turning {
            let Some([a, b]) = self.two::<S, ONE>(&mut here, &mut there) else { return };
            let rotation = rotation::<S>(reference, a, b, &slerp);
            if let Some(block) = group.block {
                if let Some(out) = out.get_mut(block as usize) {
                    S::F8::store_four(rotation, &mut out.rotation);
                }
                continue;
            }
            for shared in &group.shared {
                if let Some(out) = out.get_mut(shared.block as usize) {
                    let picked = picked::<S, 4>(rotation, &shared.lanes, S::F8::load_four(&out.rotation));
                    S::F8::store_four(picked, &mut out.rotation);
                }
            }
        }
        let (from, to) = (S::F8::splat(1.0 - self.mix), S::F8::splat(self.mix));
        for (part, groups) in tables.moving.iter().enumerate() {
            for group in groups {
                let Some([a, b]) = self.two::<S, ONE>(&mut here, &mut there) else { return };
                let vector = three!(axis => b[axis].mul_add(to, a[axis] * from));
                if let Some(block) = group.block {
                    if let Some(out) = out.get_mut(block as usize) {
                        S::F8::store_three(vector, vectors(out, part));
                    }
                    continue;
                }
                for shared in &group.shared {
                    if let Some(out) = out.get_mut(shared.block as usize) {
                        let rows = vectors(out, part);
                        let picked = picked::<S, 3>(vector, &shared.lanes, S::F8::load_three(rows));
                        S::F8::store_three(picked, rows);
                    }
                }
            }
        }
    }

    /// Decodes the components of the two keys, and advances the iterators.
    #[inline(always)]
    fn two<'t, S: Simd, const ONE: bool>(
        &self,
        here: &mut impl Iterator<Item = &'t HeadBlock>,
        there: &mut impl Iterator<Item = &'t HeadBlock>,
    ) -> Option<[[S::F8; 3]; 2]> {
        let head = here.next()?;
        let next = if ONE { head } else { there.next()? };
        Some([self.key::<S>(self.rows[0], head), self.key::<S>(self.rows[1], next)])
    }

    /// Decodes the components of the key whose first byte is `row`.
    #[inline(always)]
    fn key<S: Simd>(&self, row: u32, head: &HeadBlock) -> [S::F8; 3] {
        if head.is_wide() {
            return self.wide_key::<S>(row, head);
        }
        let at = row.wrapping_add(head.at) as usize;
        let first = S::U8::near(self.bytes, at, head.second, &head.words[0]);
        let second = S::U8::near(self.bytes, at, head.second, &head.words[1]);
        [value::<S>(first, head, 0), value::<S>(first, head, 1), value::<S>(second, head, 2)]
    }

    /// As [`Self::key`], for lanes of which not all numbers are in one word.
    #[inline(always)]
    fn wide_key<S: Simd>(&self, row: u32, head: &HeadBlock) -> [S::F8; 3] {
        let none = WideBlock { bits: [[0; LANES]; 3] };
        let wide = self.wide.get(head.at as usize).unwrap_or(&none);
        three!(axis => {
            let bits = S::U8::load(&wide.bits[axis]);
            let at = S::U8::splat(row) + bits.shifted_right(S::U8::splat(3));
            value::<S>(S::U8::gather(self.bytes, at), head, axis)
        })
    }
}

/// Returns the component whose number is in `word`.
#[inline(always)]
fn value<S: Simd>(word: S::U8, head: &HeadBlock, axis: usize) -> S::F8 {
    let number = word & S::U8::load(&head.masks[axis]);
    let step = S::U8::from_u16(&head.step[axis]).shifted_left(S::U8::splat(16)).as_float();
    number.to_float().mul_add(step, S::F8::load(&head.start[axis]))
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

/// Returns the rotation between those with components `a` and `b`, which are relative to `reference`.
#[inline(always)]
fn rotation<S: Simd>(
    reference: &[[f32; LANES]; 4],
    a: [S::F8; 3],
    b: [S::F8; 3],
    slerp: &Slerp,
) -> [S::F8; 4] {
    let [x, y, z, w] = slerp.mix::<S>(with_w::<S>(a), with_w::<S>(b));
    let [p, q, r, s] = S::F8::load_four(reference);
    [
        r.neg_mul_add(y, q.mul_add(z, p.mul_add(w, s * x))),
        p.neg_mul_add(z, r.mul_add(x, q.mul_add(w, s * y))),
        q.neg_mul_add(x, p.mul_add(y, r.mul_add(w, s * z))),
        r.neg_mul_add(z, q.neg_mul_add(y, p.neg_mul_add(x, s * w))),
    ]
}

/// Appends the fourth component of unit quaternions, which is not negative.
#[inline(always)]
fn with_w<S: Simd>([x, y, z]: [S::F8; 3]) -> [S::F8; 4] {
    let rest = z.neg_mul_add(z, y.neg_mul_add(y, x.neg_mul_add(x, S::F8::splat(1.0))));
    [x, y, z, rest.max(S::F8::splat(0.0)).sqrt()]
}
