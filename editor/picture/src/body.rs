//! The unit bodies that bones are drawn and picked with.

use super::shape::{Body, BoneInstance};
use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};
use std::f32::consts::TAU;

/// WGSL twin: `Corner` in `shaders/skeleton.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BodyVertex {
    /// x and z across in radii, y along in lengths, w along in radii.
    pub place: [f32; 4],
    /// x and z across, y along.
    pub normal: [f32; 3],
    /// Distance from the edges of a flat face; 1 on round ones.
    pub edges: [f32; 3],
}

/// Sides of a stick and of a ball.
const ROUND: usize = 10;
/// Rings of a ball between its poles.
const RINGS: usize = 5;
/// How far from the head the octahedron is thickest, in radii.
const WAIST: f32 = 1.15;

/// Triangles of `body`, three corners each, counter-clockwise from outside; none for lines, which have no body.
pub fn triangles(body: Body) -> Vec<BodyVertex> {
    let mut corners = match body {
        Body::Line => Vec::new(),
        Body::Octahedron => octahedron(),
        Body::Stick => stick(),
        Body::Ball => ball(),
    };
    // A bone of some length, to see which way round each triangle runs.
    let bone = BoneInstance { radius: 1.0, tail: Vec3::Y * 10.0, side: Vec3::X, ..BoneInstance::default() };
    for face in corners.chunks_exact_mut(3) {
        let [a, b, c] = [0, 1, 2].map(|corner| placed(&face[corner], &bone));
        let outwards: Vec3 = face.iter().map(|corner| Vec3::from(corner.normal)).sum();
        if (b - a).cross(c - a).dot(outwards) < 0.0 {
            face.swap(1, 2);
        }
    }
    corners
}

/// Where a corner of a body stands for a bone: what the vertex shader computes.
pub fn placed(corner: &BodyVertex, bone: &BoneInstance) -> Vec3 {
    let along = bone.tail - bone.head;
    let length = along.length().max(1e-12);
    let (x, y) = (bone.side, along / length);
    let z = x.cross(y);
    let [a, b, c, d] = corner.place;
    bone.head + x * (a * bone.radius) + y * (b * length + d * bone.radius) + z * (c * bone.radius)
}

fn octahedron() -> Vec<BodyVertex> {
    let head = Vec4::ZERO;
    let tail = Vec4::new(0.0, 1.0, 0.0, 0.0);
    let waist = |quarter: usize| {
        let (sin, cos) = (quarter as f32 * TAU / 4.0).sin_cos();
        Vec4::new(cos, 0.0, sin, WAIST)
    };
    let mut corners = Vec::with_capacity(24);
    for quarter in 0..4 {
        let (a, b) = (waist(quarter), waist(quarter + 1));
        let across = (a + b).truncate() * Vec3::new(0.5, 0.0, 0.5);
        // The long faces lean little, the short ones much.
        corners.extend(face([b, a, tail], (across * 1.4 + Vec3::Y * 0.1).normalize()));
        corners.extend(face([a, b, head], (across * 1.4 - Vec3::Y * 0.62).normalize()));
    }
    corners
}

fn face(corners: [Vec4; 3], normal: Vec3) -> [BodyVertex; 3] {
    let edges = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    std::array::from_fn(|corner| BodyVertex {
        place: corners[corner].into(),
        normal: normal.into(),
        edges: edges[corner],
    })
}

fn stick() -> Vec<BodyVertex> {
    let at = |side: usize, along: f32| {
        let (sin, cos) = (side as f32 * TAU / ROUND as f32).sin_cos();
        BodyVertex { place: [cos, along, sin, 0.0], normal: [cos, 0.0, sin], edges: [1.0; 3] }
    };
    let quad = |side| {
        let (a, b, c, d) = (at(side, 0.0), at(side + 1, 0.0), at(side, 1.0), at(side + 1, 1.0));
        [b, a, c, b, c, d]
    };
    (0..ROUND).flat_map(quad).collect()
}

fn ball() -> Vec<BodyVertex> {
    let at = |ring: usize, side: usize| {
        let (sin_ring, cos_ring) = (ring as f32 * TAU / 2.0 / (RINGS + 1) as f32).sin_cos();
        let (sin, cos) = (side as f32 * TAU / ROUND as f32).sin_cos();
        let normal = [cos * sin_ring, cos_ring, sin * sin_ring];
        BodyVertex { place: [normal[0], 0.0, normal[2], normal[1]], normal, edges: [1.0; 3] }
    };
    let quad = |(ring, side): (usize, usize)| {
        let (a, b, c, d) = (at(ring, side), at(ring, side + 1), at(ring + 1, side), at(ring + 1, side + 1));
        [a, b, c, b, d, c]
    };
    (0..=RINGS).flat_map(|ring| (0..ROUND).map(move |side| (ring, side))).flat_map(quad).collect()
}
