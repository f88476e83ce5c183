//! Every instruction set of the machine gives the same results as scalar calculations.

use dragonfly_anim::fast::simd::{Float4, Float8, Kernel, Simd, SimdLevel, Word8};
use proptest::prelude::*;

type Floats8 = [f32; 8];

/// All operations on vectors of eight, on the same three operands.
struct Everything(Floats8, Floats8, Floats8);

impl Kernel for Everything {
    type Output = Vec<(&'static str, Floats8)>;

    #[inline(always)]
    fn run<S: Simd>(self) -> Self::Output {
        let (a, b, c) = (S::F8::load(&self.0), S::F8::load(&self.1), S::F8::load(&self.2));
        let rows = S::F8::transpose([a, b, c, a + b]);
        let (mut low, mut high) = ([0.0; 4], [0.0; 4]);
        a.store_halves(&mut low, &mut high);
        let mask = a.less(b);
        let mut points = [0.0; 24];
        S::F8::store_points([a, b, c], &mut points);
        assert!(a.less(a + S::F8::splat(1.0)).all() && !a.less(a).all());
        let is_less = self.0.iter().zip(&self.1).all(|(a, b)| a < b);
        assert_eq!(mask.all(), is_less);
        [
            ("add", a + b),
            ("sub", a - b),
            ("mul", a * b),
            ("div", a / b),
            ("neg", -a),
            ("mul_add", a.mul_add(b, c)),
            ("neg_mul_add", a.neg_mul_add(b, c)),
            ("sqrt", a.abs().sqrt()),
            ("max", a.max(b)),
            ("min", a.min(b)),
            ("flipped", a.flipped_by(b.sign())),
            ("select", mask.select(b, c)),
            ("splat", S::F8::splat(self.0[3])),
            ("twice", S::F8::twice(&low)),
            ("halves", S::F8::from_halves(&high, &low)),
            ("spread 0", a.spread::<0>()),
            ("spread 1", a.spread::<1>()),
            ("spread 2", a.spread::<2>()),
            ("spread 3", a.spread::<3>()),
            ("keep_last", a.keep_last()),
            ("row 0", rows[0]),
            ("row 1", rows[1]),
            ("row 2", rows[2]),
            ("row 3", rows[3]),
            ("back", S::F8::transpose(rows)[3]),
            ("bits", a.to_bits().as_float()),
            ("points", S::F8::load(points.first_chunk().unwrap())),
            ("more points", S::F8::load(points[8..].first_chunk().unwrap())),
            ("last points", S::F8::load(points.last_chunk().unwrap())),
        ]
        .map(|(name, vector)| {
            let mut numbers = [0.0; 8];
            vector.store(&mut numbers);
            (name, numbers)
        })
        .to_vec()
    }
}

/// Returns the scalar results; each may differ by the given amount.
fn scalar_results(a: Floats8, b: Floats8, c: Floats8) -> Vec<(&'static str, [f64; 8], f64)> {
    let lane = |f: &dyn Fn(f64, f64, f64) -> f64| -> [f64; 8] {
        std::array::from_fn(|at| f(f64::from(a[at]), f64::from(b[at]), f64::from(c[at])))
    };
    let pick = |f: &dyn Fn(usize) -> f32| -> [f64; 8] { std::array::from_fn(|at| f64::from(f(at))) };
    let row = |k: usize| {
        pick(&move |at| {
            let (from, lane) = (at % 4, k + at / 4 * 4);
            [a[lane], b[lane], c[lane], a[lane] + b[lane]][from]
        })
    };
    let point = |first: usize| pick(&move |at| [a, b, c][(first + at) % 3][(first + at) / 3]);
    let sign = |b: f64| if b.is_sign_negative() { -1.0 } else { 1.0 };
    vec![
        ("add", lane(&|a, b, _| a + b), 1e-5),
        ("sub", lane(&|a, b, _| a - b), 1e-5),
        ("mul", lane(&|a, b, _| a * b), 1e-5),
        ("div", lane(&|a, b, _| a / b), 1e-5),
        ("neg", lane(&|a, _, _| -a), 0.0),
        ("mul_add", lane(&|a, b, c| a * b + c), 1e-3),
        ("neg_mul_add", lane(&|a, b, c| c - a * b), 1e-3),
        ("sqrt", lane(&|a, _, _| a.abs().sqrt()), 1e-6),
        ("max", lane(&|a, b, _| a.max(b)), 0.0),
        ("min", lane(&|a, b, _| a.min(b)), 0.0),
        ("flipped", lane(&|a, b, _| a * sign(b)), 0.0),
        ("select", lane(&|a, b, c| if a < b { b } else { c }), 0.0),
        ("splat", pick(&|_| a[3]), 0.0),
        ("twice", pick(&|at| a[at % 4]), 0.0),
        ("halves", pick(&|at| a[(at + 4) % 8]), 0.0),
        ("spread 0", pick(&|at| a[at / 4 * 4]), 0.0),
        ("spread 1", pick(&|at| a[at / 4 * 4 + 1]), 0.0),
        ("spread 2", pick(&|at| a[at / 4 * 4 + 2]), 0.0),
        ("spread 3", pick(&|at| a[at / 4 * 4 + 3]), 0.0),
        ("keep_last", pick(&|at| if at % 4 == 3 { a[at] } else { 0.0 }), 0.0),
        ("row 0", row(0), 1e-5),
        ("row 1", row(1), 1e-5),
        ("row 2", row(2), 1e-5),
        ("row 3", row(3), 1e-5),
        ("back", pick(&|at| a[at] + b[at]), 1e-5),
        ("bits", lane(&|a, _, _| a), 0.0),
        ("points", point(0), 0.0),
        ("more points", point(8), 0.0),
        ("last points", point(16), 0.0),
    ]
}

proptest! {
    #[test]
    fn floats_compute_what_plain_numbers_compute(
        a in prop::array::uniform8(-1e2_f32..1e2),
        b in prop::array::uniform8(prop_oneof![-1e2_f32..-1e-2, 1e-2_f32..1e2]),
        c in prop::array::uniform8(-1e2_f32..1e2),
    ) {
        for level in SimdLevel::all() {
            for ((name, got), (expected_name, expected, off)) in
                level.run(Everything(a, b, c)).into_iter().zip(scalar_results(a, b, c))
            {
                prop_assert_eq!(name, expected_name);
                for (got, expected) in got.into_iter().zip(expected) {
                    let near = (f64::from(got) - expected).abs() <= off * expected.abs().max(1.0);
                    prop_assert!(near, "{} {}: {} instead of {}", level.name(), name, got, expected);
                }
            }
        }
    }
}

/// The operations on words of 32 bits.
struct WordOps([u32; 8], [u32; 8], Vec<u8>);

impl Kernel for WordOps {
    type Output = [[u32; 8]; 7];

    #[inline(always)]
    fn run<S: Simd>(self) -> Self::Output {
        let (a, b) = (S::U8::load(&self.0), S::U8::load(&self.1));
        [
            a + b,
            a & b,
            a | b,
            a.shifted_right(b & S::U8::splat(63)),
            a.shifted_left(b & S::U8::splat(63)),
            S::U8::gather(&self.2, a),
            (a & S::U8::splat(0x00FF_FFFF)).to_float().to_bits(),
        ]
        .map(|vector| {
            let mut words = [0; 8];
            vector.store(&mut words);
            words
        })
    }
}

proptest! {
    #[test]
    fn words_compute_what_plain_numbers_compute(
        a in prop::array::uniform8(prop_oneof![any::<u32>(), 0_u32..80]),
        b in prop::array::uniform8(any::<u32>()),
        bytes in prop::collection::vec(any::<u8>(), 0..70),
    ) {
        let gathered = |offset: u32| match bytes.len().checked_sub(4) {
            Some(last) => {
                let from = (offset as usize).min(last);
                u32::from_le_bytes(bytes[from..from + 4].try_into().unwrap())
            }
            None => 0,
        };
        for level in SimdLevel::all() {
            let got = level.run(WordOps(a, b, bytes.clone()));
            for at in 0..8 {
                let (x, y, count) = (a[at], b[at], b[at] & 63);
                let expected = [
                    x.wrapping_add(y),
                    x & y,
                    x | y,
                    x.checked_shr(count).unwrap_or(0),
                    x.checked_shl(count).unwrap_or(0),
                    gathered(x),
                    ((x & 0x00FF_FFFF) as f32).to_bits(),
                ];
                prop_assert_eq!(got.map(|words| words[at]), expected, "{}", level.name());
            }
        }
    }
}

/// Words made from bytes.
struct Near(Vec<u8>, usize, u8, [u8; 8], [u16; 8]);

impl Kernel for Near {
    type Output = [[u32; 8]; 4];

    #[inline(always)]
    fn run<S: Simd>(self) -> Self::Output {
        let (bytes, words) = (S::U8::from_u8(&self.3), S::U8::from_u16(&self.4));
        let near = S::U8::near(&self.0, self.1, self.2, &self.3);
        [bytes, words, words.without(bytes), near].map(|vector| {
            let mut words = [0; 8];
            vector.store(&mut words);
            words
        })
    }
}

proptest! {
    #[test]
    fn words_made_from_bytes_agree_with_scalar_results_and_no_byte_outside_is_read(
        bytes in prop::collection::vec(any::<u8>(), 0..90),
        at in prop_oneof![0_usize..100, Just(usize::MAX)],
        second in any::<u8>(),
        lanes in prop::array::uniform8(prop_oneof![0_u8..16, any::<u8>()]),
        words in prop::array::uniform8(any::<u16>()),
    ) {
        for level in SimdLevel::all() {
            let got = level.run(Near(bytes.clone(), at, second, lanes, words));
            for lane in 0..8 {
                let byte = |step: u8| match (bytes.len().checked_sub(32), lanes[lane].wrapping_add(step)) {
                    (Some(last), from @ 0..128) => {
                        let half = at.min(last) + if lane < 4 { 0 } else { usize::from(second % 16) };
                        bytes[half + usize::from(from % 16)]
                    }
                    _ => 0,
                };
                let (narrow, wide) = (u32::from(lanes[lane]), u32::from(words[lane]));
                let near = u32::from_le_bytes([byte(0), byte(1), byte(2), byte(3)]);
                let expected = [narrow, wide, wide & !narrow, near];
                prop_assert_eq!(got.map(|words| words[lane]), expected, "{}", level.name());
            }
        }
    }
}

/// Small whole numbers as floats, and the operations on vectors of four.
struct SmallNumbers([u16; 8], [u8; 8]);

impl Kernel for SmallNumbers {
    type Output = ([Floats8; 2], [[f32; 4]; 5]);

    #[inline(always)]
    fn run<S: Simd>(self) -> Self::Output {
        let wide = [S::F8::from_u16(&self.0), S::F8::from_u8(&self.1)].map(|vector| {
            let mut numbers = [0.0; 8];
            vector.store(&mut numbers);
            numbers
        });
        let four = S::F4::load(&[1.0, 2.0, 3.0, 4.0]);
        let two = S::F4::splat(2.0);
        let four =
            [four.mul_add(two, four), four - two, -four + two * four, four.spread::<2>(), four.keep_last()];
        let four = four.map(|vector| {
            let mut numbers = [0.0; 4];
            vector.store(&mut numbers);
            numbers
        });
        (wide, four)
    }
}

#[test]
fn small_whole_numbers_become_the_same_floats() {
    let (u16s, u8s) = ([0, 1, 2, 255, 256, 32_768, 65_534, 65_535], [0, 1, 2, 127, 128, 200, 254, 255]);
    for level in SimdLevel::all() {
        let ([wide, narrow], four) = level.run(SmallNumbers(u16s, u8s));
        assert_eq!(wide, u16s.map(f32::from), "{}", level.name());
        assert_eq!(narrow, u8s.map(f32::from), "{}", level.name());
        let expected = [
            [3.0, 6.0, 9.0, 12.0],
            [-1.0, 0.0, 1.0, 2.0],
            [1.0, 2.0, 3.0, 4.0],
            [3.0; 4],
            [0.0, 0.0, 0.0, 4.0],
        ];
        assert_eq!(four, expected, "{}", level.name());
    }
}

#[test]
fn the_fastest_level_is_first_and_the_portable_one_last() {
    let levels = SimdLevel::all();
    assert_eq!((levels.first(), levels.last()), (Some(&SimdLevel::best()), Some(&SimdLevel::PORTABLE)));
    println!("levels here: {:?}", levels.iter().map(|level| level.name()).collect::<Vec<_>>());
}
