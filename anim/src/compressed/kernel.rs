//! A pose from three keys: eight bones at once, without a step from one time to the next.
//!
//! For each component of each bone, between keys `k` and `k + 1`, of which one is even: the even keys before and after,
//! and what the odd one has to add to half way between them.
//!
//! ```text
//! k even:  a = even                       b = (even + next) / 2 + odd
//! k odd:   a = (even + next) / 2 + odd    b = next
//! ```
//!
//! Vectors are then mixed; rotations get their w back and are slerped with the weights of [`Slerp`].

use super::slerp::Slerp;
use super::stored::{PER_EXTENT, PER_PLACE};
use super::table::{HeadBlock, MovingBlock, Reads, Tables};
use crate::fast::PoseBlock;
use crate::fast::simd::{Float8, Kernel, Simd, Word8};

/// The same for each of three components. An array's `map` would do, but its closure is not compiled with the
/// instructions of the level.
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

/// Decodes a pose.
pub(super) struct Decode<'a> {
    pub(super) tables: &'a Tables,
    pub(super) bytes: &'a [u8],
    /// Seconds.
    pub(super) time: f32,
    pub(super) out: &'a mut [PoseBlock],
}

/// Where the three keys lie, and how to put them together.
#[derive(Clone, Copy, Debug)]
struct Keys {
    /// Segments of the even key (and of the odd one), and of the next even key.
    segment: usize,
    next_segment: usize,
    /// Bits from the first byte.
    even: u32,
    next: u32,
    odd: u32,
    /// Is the first of the two keys around the time the odd one?
    late: bool,
}

/// The keys around `time`: the one before and how far the time is on the way to the next.
///
/// The same answer as [`crate::sample::find_keys`] gives for the times of the decompressed take.
#[inline(always)]
fn around(tables: &Tables, time: f32) -> (u32, f32) {
    let (clock, last) = (&tables.clock, tables.clock.frames - 1);
    // A conversion takes NaN and what is below zero to zero.
    let guess = ((f64::from(time) - f64::from(clock.start)) / tables.interval) as u32;
    if guess >= last {
        let before = clock.time(last, tables.interval);
        return if time >= before || last == 0 {
            (last, 0.0)
        } else {
            (last - 1, mix(tables, last - 1, time))
        };
    }
    let key = if time < clock.time(guess, tables.interval) {
        guess.saturating_sub(1)
    } else if time >= clock.time(guess + 1, tables.interval) {
        (guess + 1).min(last)
    } else {
        guess
    };
    if key == last { (last, 0.0) } else { (key, mix(tables, key, time)) }
}

#[inline(always)]
fn mix(tables: &Tables, key: u32, time: f32) -> f32 {
    let before = tables.clock.time(key, tables.interval);
    let after = tables.clock.time(key + 1, tables.interval);
    let mix = (time - before) / (after - before);
    // NaN and what is below zero become zero.
    if mix > 0.0 { mix.min(1.0) } else { 0.0 }
}

impl Keys {
    #[inline(always)]
    fn around(tables: &Tables, key: u32) -> Option<Self> {
        let (last, shift) = (tables.clock.frames - 1, tables.shift);
        let even = key & !1;
        // Without a next even key the last one stands in: nothing is between.
        let next = if even + 2 <= last { even + 2 } else { even };
        let inside = |key: u32| (key & ((1 << shift) - 1)) / 2;
        let (segment, next_segment) = ((even >> shift) as usize, (next >> shift) as usize);
        let (here, there) = (tables.segments.get(segment)?, tables.segments.get(next_segment)?);
        // The last key of all may be even: then there is no odd one after it, and its numbers count for nothing.
        let odd =
            if even < last { here.odd.wrapping_add(inside(even).wrapping_mul(here.odd_stride)) } else { 0 };
        Some(Self {
            segment,
            next_segment,
            even: here.even.wrapping_add(inside(even).wrapping_mul(here.even_stride)),
            next: there.even.wrapping_add(inside(next).wrapping_mul(there.even_stride)),
            odd,
            late: key & 1 == 1,
        })
    }
}

impl Kernel for Decode<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { tables, bytes, time, out } = self;
        let blocks = out.len().min(tables.base.len());
        out[..blocks].copy_from_slice(&tables.base[..blocks]);
        let (key, mix) = around(tables, time);
        if let Some(keys) = Keys::around(tables, key) {
            let slerp = Slerp::at(mix);
            let [rotations, translations, scales] = &tables.parts;
            let (here, there) = rotations.heads_of(keys.segment, keys.next_segment);
            for ((moving, head), next) in rotations.blocks.iter().zip(here).zip(there) {
                let [a, b] = two_keys::<S>(moving, head, next, &keys, bytes);
                if let Some(out) = out.get_mut(moving.block) {
                    rotation::<S>(moving, a, b, &slerp, &mut out.rotation);
                }
            }
            let (here, there) = translations.heads_of(keys.segment, keys.next_segment);
            for ((moving, head), next) in translations.blocks.iter().zip(here).zip(there) {
                let [a, b] = two_keys::<S>(moving, head, next, &keys, bytes);
                if let Some(out) = out.get_mut(moving.block) {
                    vector::<S>(a, b, mix, &mut out.translation);
                }
            }
            let (here, there) = scales.heads_of(keys.segment, keys.next_segment);
            for ((moving, head), next) in scales.blocks.iter().zip(here).zip(there) {
                let [a, b] = two_keys::<S>(moving, head, next, &keys, bytes);
                if let Some(out) = out.get_mut(moving.block) {
                    vector::<S>(a, b, mix, &mut out.scale);
                }
            }
        }
        if !tables.whole.is_empty() {
            super::whole::put(tables, bytes, key, mix, out);
        }
    }
}

/// The components of the two keys around the time.
#[inline(always)]
fn two_keys<S: Simd>(
    moving: &MovingBlock,
    head: &HeadBlock,
    next_head: &HeadBlock,
    keys: &Keys,
    bytes: &[u8],
) -> [[S::F8; 3]; 2] {
    let bits = S::U8::load(&head.bits);
    let (even_widths, odd_widths) = (widths::<S>(bits, 0), widths::<S>(bits, 15));
    let even_masks = three!(axis => mask::<S>(even_widths[axis]));
    let (start, step) = ranges::<S>(moving, head, &even_masks);
    let even = numbers::<S>(bytes, keys.even, &head.even_at, head.reads[0], &even_widths, &even_masks);
    let odd_masks = three!(axis => mask::<S>(odd_widths[axis]));
    let odd = numbers::<S>(bytes, keys.odd, &head.odd_at, head.reads[1], &odd_widths, &odd_masks);
    let even = three!(axis => even[axis].mul_add(step[axis], start[axis]));
    let next = if keys.next_segment == keys.segment {
        let next = numbers::<S>(bytes, keys.next, &head.even_at, head.reads[0], &even_widths, &even_masks);
        three!(axis => next[axis].mul_add(step[axis], start[axis]))
    } else {
        other_segment::<S>(moving, next_head, keys, bytes)
    };
    let half = S::F8::splat(0.5);
    let one = S::U8::splat(1);
    let middle = three!(axis => {
        // (mask + 1) / 2: what stands for zero; none for a number of no bits.
        let zero = (odd_masks[axis] + one).shifted_right(one).to_float();
        (odd[axis] - zero).mul_add(step[axis], next[axis].mul_add(half, even[axis] * half))
    });
    if keys.late { [middle, next] } else { [even, middle] }
}

/// The next even key, where it is the first of another segment.
#[inline(always)]
fn other_segment<S: Simd>(moving: &MovingBlock, head: &HeadBlock, keys: &Keys, bytes: &[u8]) -> [S::F8; 3] {
    let widths = widths::<S>(S::U8::load(&head.bits), 0);
    let masks = three!(axis => mask::<S>(widths[axis]));
    let (start, step) = ranges::<S>(moving, head, &masks);
    let next = numbers::<S>(bytes, keys.next, &head.even_at, head.reads[0], &widths, &masks);
    three!(axis => next[axis].mul_add(step[axis], start[axis]))
}

/// Three widths of five bits each, from bit `from` on.
#[inline(always)]
fn widths<S: Simd>(bits: S::U8, from: u32) -> [S::U8; 3] {
    three!(axis => bits.shifted_right(S::U8::splat(from + 5 * axis as u32)) & S::U8::splat(31))
}

/// As many ones as `width` says.
#[inline(always)]
fn mask<S: Simd>(width: S::U8) -> S::U8 {
    S::U8::splat(1).shifted_left(width) + S::U8::splat(u32::MAX)
}

/// Start and step of each component: see [`super::stored::Head::start_and_step`].
#[inline(always)]
fn ranges<S: Simd>(moving: &MovingBlock, head: &HeadBlock, masks: &[S::U8; 3]) -> ([S::F8; 3], [S::F8; 3]) {
    let (per_place, per_extent, one) = (S::F8::splat(PER_PLACE), S::F8::splat(PER_EXTENT), S::F8::splat(1.0));
    let extent = three!(axis => S::F8::load(&moving.extent[axis]));
    let start = three!(axis => {
        let place = S::F8::from_u16(&head.place[axis]) * per_place;
        extent[axis].mul_add(place, S::F8::load(&moving.low[axis]))
    });
    let step = three!(axis => {
        let part = S::F8::from_u8(&head.extent[axis]) * per_extent;
        extent[axis] * part / masks[axis].to_float().max(one)
    });
    (start, step)
}

/// Three numbers of each lane, one after the other.
#[inline(always)]
fn numbers<S: Simd>(
    bytes: &[u8],
    at: u32,
    lanes: &[u32; 8],
    reads: Reads,
    widths: &[S::U8; 3],
    masks: &[S::U8; 3],
) -> [S::F8; 3] {
    let x = S::U8::splat(at) + S::U8::load(lanes);
    let y = x + widths[0];
    let word = word::<S>(bytes, x);
    let first = word & masks[0];
    let (second, third) = match reads {
        Reads::One => (word.shifted_right(widths[0]), word.shifted_right(widths[0] + widths[1])),
        Reads::Two => (word.shifted_right(widths[0]), self::word::<S>(bytes, y + widths[1])),
        Reads::Three => (self::word::<S>(bytes, y), self::word::<S>(bytes, y + widths[1])),
    };
    [first.to_float(), (second & masks[1]).to_float(), (third & masks[2]).to_float()]
}

/// At least 25 bits of each lane, from bit `at` on.
#[inline(always)]
fn word<S: Simd>(bytes: &[u8], at: S::U8) -> S::U8 {
    S::U8::gather(bytes, at.shifted_right(S::U8::splat(3))).shifted_right(at & S::U8::splat(7))
}

#[inline(always)]
fn vector<S: Simd>(a: [S::F8; 3], b: [S::F8; 3], mix: f32, out: &mut [[f32; 8]; 3]) {
    let (from, to) = (S::F8::splat(1.0 - mix), S::F8::splat(mix));
    for axis in 0..3 {
        b[axis].mul_add(to, a[axis] * from).store(&mut out[axis]);
    }
}

#[inline(always)]
fn rotation<S: Simd>(
    moving: &MovingBlock,
    a: [S::F8; 3],
    b: [S::F8; 3],
    slerp: &Slerp,
    out: &mut [[f32; 8]; 4],
) {
    let (a, b) = (with_w::<S>(a), with_w::<S>(b));
    let [x, y, z, w] = slerp.mix::<S>(a, b);
    let (p, q) = (S::F8::load(&moving.reference[0]), S::F8::load(&moving.reference[1]));
    let (r, s) = (S::F8::load(&moving.reference[2]), S::F8::load(&moving.reference[3]));
    // reference * relative
    r.neg_mul_add(y, q.mul_add(z, p.mul_add(w, s * x))).store(&mut out[0]);
    p.neg_mul_add(z, r.mul_add(x, q.mul_add(w, s * y))).store(&mut out[1]);
    q.neg_mul_add(x, p.mul_add(y, r.mul_add(w, s * z))).store(&mut out[2]);
    r.neg_mul_add(z, q.neg_mul_add(y, p.neg_mul_add(x, s * w))).store(&mut out[3]);
}

/// The fourth component of unit quaternions, which is not negative.
#[inline(always)]
fn with_w<S: Simd>([x, y, z]: [S::F8; 3]) -> [S::F8; 4] {
    let rest = z.neg_mul_add(z, y.neg_mul_add(y, x.neg_mul_add(x, S::F8::splat(1.0))));
    [x, y, z, rest.max(S::F8::splat(0.0)).sqrt()]
}
