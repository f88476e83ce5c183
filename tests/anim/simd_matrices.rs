//! Matrices and pairs of rows of every instruction set give the same results as scalar calculations. All numbers are
//! small and whole, so that nothing is rounded.

use dragonfly_anim::fast::simd::{Arithmetic, Float4, Float8, Kernel, RowPair, Rows, Simd, SimdLevel};

type Matrix = [f32; 12];

/// Returns matrices whose numbers all differ from those around them.
fn matrices() -> [Matrix; 8] {
    std::array::from_fn(|matrix| std::array::from_fn(|at| ((matrix * 5 + at * 7) % 23) as f32 - 11.0))
}

/// Returns three coordinates of four points.
fn points(first: usize) -> [[f32; 4]; 3] {
    std::array::from_fn(|axis| {
        std::array::from_fn(|point| ((first + point * 3 + axis * 4) % 13) as f32 - 6.0)
    })
}

/// Moves two times four points by the matrices, each times 2 and plus itself.
struct MoveFours;

/// The moved points and directions, and the second column of all matrices.
struct MovedFours {
    points: [f32; 24],
    directions: [f32; 24],
    column: [[f32; 8]; 3],
}

impl Kernel for MoveFours {
    type Output = MovedFours;

    #[inline(always)]
    fn run<S: Simd>(self) -> MovedFours {
        let all = matrices();
        let [a, b, c, d, e, f, g, h] = &all;
        let first = S::Rows::turned([
            three_times::<S>(a),
            three_times::<S>(b),
            three_times::<S>(c),
            three_times::<S>(d),
        ]);
        let last = S::Rows::turned([
            three_times::<S>(e),
            three_times::<S>(f),
            three_times::<S>(g),
            three_times::<S>(h),
        ]);
        let ([x, y, z], [p, q, r]) = (points(0), points(5));
        let mut out = MovedFours { points: [0.0; 24], directions: [0.0; 24], column: [[0.0; 8]; 3] };
        let moved = [S::Rows::moved(first, [&x, &y, &z]), S::Rows::moved(last, [&p, &q, &r])];
        S::Rows::store_points(moved, &mut out.points);
        let directed = [S::Rows::directed(first, [&x, &y, &z]), S::Rows::directed(last, [&p, &q, &r])];
        S::Rows::store_points(directed, &mut out.directions);
        S::F8::store_three(S::Rows::joined([first[1], last[1]]), &mut out.column);
        out
    }
}

#[inline(always)]
fn three_times<S: Simd>(matrix: &Matrix) -> S::Rows {
    let matrix = S::Rows::load_packed(matrix);
    matrix.scaled_add(2.0, matrix.scaled(1.0))
}

#[test]
fn eight_points_are_moved_each_by_its_own_matrix() {
    let matrices = matrices();
    let coordinate = |at: usize, translates: f32| {
        let (vertex, row) = (at / 3, at % 3);
        let point = if vertex < 4 { points(0) } else { points(5) }.map(|axis| axis[vertex % 4]);
        let row = &matrices[vertex][row * 4..];
        3.0 * (row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3] * translates)
    };
    for level in SimdLevel::all() {
        let got = level.run(MoveFours);
        assert_eq!(got.points, std::array::from_fn(|at| coordinate(at, 1.0)), "{}", level.name());
        assert_eq!(got.directions, std::array::from_fn(|at| coordinate(at, 0.0)), "{}", level.name());
        let column =
            std::array::from_fn(|row| std::array::from_fn(|vertex| 3.0 * matrices[vertex][row * 4 + 1]));
        assert_eq!(got.column, column, "{}", level.name());
    }
}

/// The operations on pairs of rows.
struct PairsOfRows([f32; 8], [f32; 8]);

impl Kernel for PairsOfRows {
    type Output = [[f32; 8]; 9];

    #[inline(always)]
    fn run<S: Simd>(self) -> Self::Output {
        let (pair, other) = (S::Pair::from_rows(&self.0, &self.1), S::Pair::from_rows(&self.1, &self.0));
        let mask = S::F8::load(&self.0).less(S::F8::load(&self.1));
        let row = S::F8::load(&self.1);
        let [mut a, mut b, mut c, mut d, mut e, mut f, mut g, mut h, mut sum] = [[0.0; 8]; 9];
        pair.store_rows(&mut a, &mut b);
        pair.times_plus(S::Pair::both(row), other * other).store_rows(&mut c, &mut d);
        S::Pair::chosen(mask, pair, other).store_rows(&mut e, &mut f);
        S::Pair::all(0.0).times_plus(pair, S::Pair::both(row)).store_rows(&mut g, &mut h);
        pair.sum().store(&mut sum);
        [a, b, c, d, e, f, g, h, sum]
    }
}

/// The operations with which pairs of rows are decoded.
struct DecodedRows<'a> {
    bytes: &'a [u8],
    lanes: &'a [[u8; 8]; 2],
    masks: &'a [[u32; 8]; 2],
    factors: &'a [[u16; 8]; 2],
    addends: &'a [[f32; 8]; 2],
}

impl Kernel for DecodedRows<'_> {
    type Output = [[[f32; 8]; 2]; 3];

    #[inline(always)]
    fn run<S: Simd>(self) -> Self::Output {
        let Self { bytes, lanes, masks, factors, addends } = self;
        let mut out = [[[0.0; 8]; 2]; 3];
        let [[a, b], [c, d], [e, f]] = &mut out;
        // The second position is past the last one from which 32 bytes can be read.
        let words = S::Pair::near(bytes, [3, 70], [13, 200], lanes);
        let numbers = S::Pair::masked(words, masks);
        let addends = S::Pair::load(addends);
        numbers.times_plus(S::Pair::from_high_bits(factors), addends).store_rows(a, b);
        addends.times_from(addends, S::Pair::all(9.0)).larger(S::Pair::all(0.0)).root().store_rows(c, d);
        let [first, second] = addends.rows();
        let no = S::Pair::all(if addends.any_less(S::Pair::all(-4.0)) { 1.0 } else { 2.0 });
        (S::Pair::of([second, first]) + no).store_rows(e, f);
        out
    }
}

#[test]
fn a_pair_of_rows_is_decoded_as_single_rows_are() {
    let bytes: Vec<u8> = (0..80_u32).map(|byte| (byte * 37 % 256) as u8).collect();
    let lanes = [[0, 2, 3, 12, 0, 1, 7, 12], [1, 5, 9, 15, 2, 128, 126, 123]];
    let masks = [[0xff, 0x3ff0, 0x7f_0000, 0, 0x7fff_0000, 1, 0xff00, 0xfff], [0xf0; 8]];
    let factors = [[0x3f80, 0x4000, 0x3f00, 0x3f80, 0x3780, 0x3f80, 0x3e80, 0x4080], [0x3f80; 8]];
    let addends = [[1.0, -2.0, 3.0, 4.0, -0.5, 2.5, 0.0, 1.5], [-4.5, 2.0, -3.0, 1.0, 0.25, 2.0, -1.0, 0.5]];
    let word = |row: usize, lane: usize| -> u32 {
        // As the documentation of `Word8::near` has it: the last 32 bytes begin at 48; 200 % 16 is 8.
        let first = [3, 48][row] + if lane < 4 { 0 } else { [13, 8][row] };
        let byte = |step: usize| match usize::from(lanes[row][lane]) + step {
            offset if offset < 128 => u32::from(bytes[first + offset % 16]),
            _ => 0,
        };
        byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24
    };
    let expected = [0, 1].map(|row| {
        std::array::from_fn::<f32, 8, _>(|lane| {
            let word = word(row, lane);
            let factor = f32::from_bits(u32::from(factors[row][lane]) << 16);
            // Exact, so that it does not matter how often it is rounded.
            ((word & masks[row][lane]) as i32 as f32).mul_add(factor, addends[row][lane])
        })
    });
    let root = |row: [f32; 8]| row.map(|number| (9.0 - number * number).max(0.0).sqrt());
    let more = |row: [f32; 8]| row.map(|number| number + 1.0);
    for level in SimdLevel::all() {
        let got = level.run(DecodedRows {
            bytes: &bytes,
            lanes: &lanes,
            masks: &masks,
            factors: &factors,
            addends: &addends,
        });
        assert_eq!(got[0], expected, "{}", level.name());
        assert_eq!(got[1], addends.map(root), "{}", level.name());
        assert_eq!(got[2], [more(addends[1]), more(addends[0])], "{}", level.name());
    }
}

#[test]
fn a_pair_of_rows_computes_what_single_rows_compute() {
    let a = [1.0, -2.0, 3.0, 4.0, -5.0, 6.0, 7.0, 8.0];
    let b = [2.0, 2.0, -3.0, 1.0, 5.0, 7.0, -9.0, 8.5];
    let lanes = |f: &dyn Fn(f32, f32) -> f32| -> [f32; 8] { std::array::from_fn(|at| f(a[at], b[at])) };
    let expected = [
        a,
        b,
        lanes(&|a, b| a * b + b * b),
        lanes(&|a, b| b * b + a * a),
        lanes(&|a, b| if a < b { a } else { b }),
        lanes(&|a, b| if a < b { b } else { a }),
        b,
        b,
        lanes(&|a, b| a + b),
    ];
    for level in SimdLevel::all() {
        assert_eq!(level.run(PairsOfRows(a, b)), expected, "{}", level.name());
    }
}

/// Transposes four vectors of four.
struct TransposeFour;

impl Kernel for TransposeFour {
    type Output = [[f32; 4]; 4];

    #[inline(always)]
    fn run<S: Simd>(self) -> Self::Output {
        let row = |first: f32| [first, first + 1.0, first + 2.0, first + 3.0];
        let [a, b, c, d] = S::F4::transpose([
            S::F4::load(&row(0.0)),
            S::F4::load(&row(10.0)),
            S::F4::load(&row(20.0)),
            S::F4::load(&row(30.0)),
        ]);
        let mut rows = [[0.0; 4]; 4];
        a.store(&mut rows[0]);
        b.store(&mut rows[1]);
        c.store(&mut rows[2]);
        d.store(&mut rows[3]);
        rows
    }
}

#[test]
fn four_rows_of_four_are_transposed() {
    let expected = std::array::from_fn(|row| std::array::from_fn(|at| (at * 10 + row) as f32));
    for level in SimdLevel::all() {
        assert_eq!(level.run(TransposeFour), expected, "{}", level.name());
    }
}
