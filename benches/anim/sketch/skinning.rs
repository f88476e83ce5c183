//! The sketch's vertices on the CPU.
//!
//! ```text
//! M        = Σ weight_i * final[joint_i]         two rows in one register, the third in another
//! position = M * (position, 1)     normal = M * (normal, 0)
//! ```
//!
//! Less than the library does: normals are moved by the matrix itself, wrong under scales that differ by axis, and keep
//! the length that comes out; nothing is looked at for not being finite; every vertex has the same number of influences. The
//! prototype knew four of them; here it is told how many. It turned the rows of one vertex to columns, here those of two at
//! once are turned, which is as many steps for each.

use crate::case::Case;
use crate::inputs::{INFLUENCES, finals, primitive};
use crate::model::Subject;
use dragonfly_anim::data::Primitive;
use dragonfly_anim::fast::matrix::{IDENTITY, Matrix34, matrix34};
use dragonfly_anim::fast::simd::{Float4, Float8, Kernel, Level, Simd};
use std::hint::black_box;

/// Vertices in the order of the file, each with `N` influences.
struct Vertices<const N: usize> {
    joints: Vec<[u16; N]>,
    weights: Vec<[f32; N]>,
    /// Three numbers a vertex, and four more at the end, so that two vertices and one number more can be read.
    positions: Vec<f32>,
    normals: Vec<f32>,
}

impl<const N: usize> Vertices<N> {
    fn new(primitive: &Primitive) -> Self {
        let vertices = &primitive.vertices;
        let mut new = Self { joints: vec![], weights: vec![], positions: vec![], normals: vec![] };
        for index in 0..vertices.len() {
            let influence = |at: usize| vertices.influences_of(index).get(at).copied().unwrap_or_default();
            new.joints.push(std::array::from_fn(|at| influence(at).joint));
            new.weights.push(std::array::from_fn(|at| influence(at).weight));
            new.positions.extend(vertices.positions[index].to_array());
            new.normals.extend(vertices.normals[index].to_array());
        }
        new.positions.extend([0.0; 4]);
        new.normals.extend([0.0; 4]);
        new
    }
}

struct Skin<'a, const N: usize> {
    vertices: &'a Vertices<N>,
    finals: &'a [Matrix34],
    positions: &'a mut [[f32; 3]],
    normals: &'a mut [[f32; 3]],
}

impl<const N: usize> Kernel for Skin<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { vertices, finals, positions, normals } = self;
        let influences = vertices.joints.chunks(2).zip(vertices.weights.chunks(2));
        let places = vertices.positions.windows(7).step_by(6).zip(vertices.normals.windows(7).step_by(6));
        let outs = positions.chunks_mut(2).zip(normals.chunks_mut(2));
        let mut sums = [IDENTITY; 2];
        for (((joints, weights), (place, normal)), (positions, normals)) in influences.zip(places).zip(outs) {
            for ((sum, joints), weights) in sums.iter_mut().zip(joints).zip(weights) {
                weigh::<S, N>(joints, weights, finals, sum);
            }
            let [x, y, z, w] = columns::<S>(&sums);
            let p = two::<S>(place);
            let p = p.spread::<0>().mul_add(x, p.spread::<1>().mul_add(y, p.spread::<2>().mul_add(z, w)));
            store::<S>(p, positions);
            let n = two::<S>(normal);
            let n = n.spread::<0>().mul_add(x, n.spread::<1>().mul_add(y, n.spread::<2>() * z));
            store::<S>(n, normals);
        }
    }
}

/// The weighted sum of the matrices of one vertex.
#[inline(always)]
fn weigh<S: Simd, const N: usize>(
    joints: &[u16; N],
    weights: &[f32; N],
    finals: &[Matrix34],
    sum: &mut Matrix34,
) {
    let matrix = &finals[usize::from(joints[0])];
    let weight = S::F8::splat(weights[0]);
    let mut two = S::F8::load(matrix.first_chunk().unwrap()) * weight;
    let mut one = S::F4::load(matrix.last_chunk().unwrap()) * weight.low();
    for (&joint, &weight) in joints.iter().zip(weights).skip(1) {
        let (matrix, weight) = (&finals[usize::from(joint)], S::F8::splat(weight));
        two = S::F8::load(matrix.first_chunk().unwrap()).mul_add(weight, two);
        one = S::F4::load(matrix.last_chunk().unwrap()).mul_add(weight.low(), one);
    }
    two.store(sum.first_chunk_mut().unwrap());
    one.store(sum.last_chunk_mut().unwrap());
}

/// The columns of two matrices, one in each half; the fourth number of each says nothing.
#[inline(always)]
fn columns<S: Simd>([a, b]: &[Matrix34; 2]) -> [S::F8; 4] {
    let (a, b) = (a.as_chunks::<4>().0, b.as_chunks::<4>().0);
    let last = S::F8::from_halves(&a[2], &b[2]);
    S::F8::transpose([S::F8::from_halves(&a[0], &b[0]), S::F8::from_halves(&a[1], &b[1]), last, last])
}

/// The first three numbers and the next three, one a half.
#[inline(always)]
fn two<S: Simd>(six: &[f32]) -> S::F8 {
    S::F8::from_halves(six[..4].first_chunk().unwrap(), six[3..7].first_chunk().unwrap())
}

/// The first three numbers of each half, as many as there is room for.
#[inline(always)]
fn store<S: Simd>(two: S::F8, to: &mut [[f32; 3]]) {
    let (mut low, mut high) = ([0.0; 4], [0.0; 4]);
    two.store_halves(&mut low, &mut high);
    for (to, from) in to.iter_mut().zip([low, high]) {
        *to = [from[0], from[1], from[2]];
    }
}

pub(super) fn cases(subject: &'static Subject) -> [Case; 3] {
    let [one, two, four] = INFLUENCES;
    [case::<1>(subject, one), case::<2>(subject, two), case::<4>(subject, four)]
}

fn case<const N: usize>(subject: &'static Subject, most: usize) -> Case {
    let count = subject.primitive().vertices.len();
    Case::new("sketch", format!("skin/{}/{most}", subject.name), count, "vertex", move || {
        let vertices = Vertices::<N>::new(&primitive(subject, most));
        let finals: Vec<Matrix34> = finals(subject).into_iter().map(matrix34).collect();
        let (mut positions, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        let level = Level::best();
        move || {
            let (positions, normals) = (&mut positions, &mut normals);
            level.run(Skin { vertices: &vertices, finals: &finals, positions, normals });
            black_box((positions, normals));
        }
    })
}
