//! The sketch's vertices on the CPU.
//!
//! ```text
//! M        = Σ weight_i * final[joint_i]         two rows in one register, the third in another
//! position = M * (position, 1)     normal = M * (normal, 0)
//! ```
//!
//! One vertex after the other. Less than the library does: normals are moved by the matrix itself, wrong under scales that
//! differ by axis, and keep the length that comes out; nothing is looked at for not being finite; every vertex has the same
//! number of influences. The prototype knew four of them; here it is told how many.

use super::kernels::TWELVE;
use crate::case::Case;
use crate::inputs::{INFLUENCES, finals, primitive};
use crate::model::Subject;
use dragonfly_anim::data::{Influence, Primitive};
use dragonfly_anim::fast::matrix::{IDENTITY, Matrix34, matrix34};
use dragonfly_anim::fast::simd::{Float4, Float8, Kernel, Simd, SimdLevel};
use std::hint::black_box;

/// A vertex with `N` influences.
struct Vertex<const N: usize> {
    influences: [Influence; N],
    position: [f32; 3],
    normal: [f32; 3],
}

/// In the order of the file.
fn vertices<const N: usize>(primitive: &Primitive) -> Vec<Vertex<N>> {
    let vertices = &primitive.vertices;
    let influence = |vertex, at| vertices.influences_of(vertex).get(at).copied().unwrap_or_default();
    let vertex = |index: usize| Vertex {
        influences: std::array::from_fn(|at| influence(index, at)),
        position: vertices.positions[index].to_array(),
        normal: vertices.normals[index].to_array(),
    };
    (0..vertices.len()).map(vertex).collect()
}

struct Skin<'a, const N: usize> {
    vertices: &'a [Vertex<N>],
    finals: &'a [Matrix34],
    positions: &'a mut [[f32; 3]],
    normals: &'a mut [[f32; 3]],
}

impl<const N: usize> Kernel for Skin<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { vertices, finals, positions, normals } = self;
        let mut sum = IDENTITY;
        for ((vertex, position), normal) in vertices.iter().zip(positions).zip(normals) {
            weigh::<S, N>(&vertex.influences, finals, &mut sum);
            let [x, y, z, w] = columns::<S>(&sum);
            let [a, b, c] = vertex.position;
            let (a, b, c) = (S::F8::splat(a), S::F8::splat(b), S::F8::splat(c));
            store::<S>(a.mul_add(x, b.mul_add(y, c.mul_add(z, w))), position);
            let [a, b, c] = vertex.normal;
            let (a, b, c) = (S::F8::splat(a), S::F8::splat(b), S::F8::splat(c));
            store::<S>(a.mul_add(x, b.mul_add(y, c * z)), normal);
        }
    }
}

/// The weighted sum of the matrices of one vertex.
#[inline(always)]
fn weigh<S: Simd, const N: usize>(influences: &[Influence; N], finals: &[Matrix34], sum: &mut Matrix34) {
    let matrix = &finals[usize::from(influences[0].joint)];
    let weight = S::F8::splat(influences[0].weight);
    let mut two = S::F8::load(matrix.first_chunk().expect(TWELVE)) * weight;
    let mut one = S::F4::load(matrix.last_chunk().expect(TWELVE)) * weight.low();
    for influence in &influences[1..] {
        let (matrix, weight) = (&finals[usize::from(influence.joint)], S::F8::splat(influence.weight));
        two = S::F8::load(matrix.first_chunk().expect(TWELVE)).mul_add(weight, two);
        one = S::F4::load(matrix.last_chunk().expect(TWELVE)).mul_add(weight.low(), one);
    }
    two.store(sum.first_chunk_mut().expect(TWELVE));
    one.store(sum.last_chunk_mut().expect(TWELVE));
}

/// The columns of a matrix, in both halves alike; the fourth number of each says nothing.
#[inline(always)]
fn columns<S: Simd>(matrix: &Matrix34) -> [S::F8; 4] {
    let rows = matrix.as_chunks::<4>().0;
    let last = S::F8::twice(&rows[2]);
    S::F8::transpose([S::F8::twice(&rows[0]), S::F8::twice(&rows[1]), last, last])
}

/// The first three numbers.
#[inline(always)]
fn store<S: Simd>(vector: S::F8, to: &mut [f32; 3]) {
    let mut four = [0.0; 4];
    vector.low().store(&mut four);
    *to = [four[0], four[1], four[2]];
}

pub(super) fn cases(subject: &'static Subject) -> [Case; 3] {
    let [one, two, four] = INFLUENCES;
    [case::<1>(subject, one), case::<2>(subject, two), case::<4>(subject, four)]
}

fn case<const N: usize>(subject: &'static Subject, most: usize) -> Case {
    let count = subject.primitive().vertices.len();
    Case::new("sketch", format!("skin/{}/{most}", subject.name), count, "vertex", move || {
        let vertices = vertices::<N>(&primitive(subject, most));
        let finals: Vec<Matrix34> = finals(subject).into_iter().map(matrix34).collect();
        let (mut positions, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        let level = SimdLevel::best();
        move || {
            let (positions, normals) = (&mut positions, &mut normals);
            level.run(Skin { vertices: &vertices, finals: &finals, positions, normals });
            black_box((positions, normals));
        }
    })
}
