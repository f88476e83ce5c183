//! Unit meshes of the bodies that bones are drawn and picked with.

use super::shape::{Body, BoneInstance};
use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};
use std::f32::consts::TAU;

/// A vertex of a unit body. WGSL twin: `Corner` in `shaders/skeleton.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BodyVertex {
    /// Position: x and z across the bone in radii, y along it in lengths, w along it in radii.
    pub place: [f32; 4],
    /// Normal: x and z across the bone, y along it.
    pub normal: [f32; 3],
    /// Distance from the three edges of a flat face; 1 on round bodies.
    pub edges: [f32; 3],
}

/// Number of sides of a stick and of a ball.
const ROUND: usize = 10;
/// Number of rings of a ball between its poles.
const RINGS: usize = 5;
/// Distance from the head at which the octahedron is thickest, in radii.
const WAIST: f32 = 1.15;

/// Returns the triangles of `body`, three vertices each, counter-clockwise from outside; empty for lines, which have
/// no mesh.
pub fn triangles(body: Body) -> Vec<BodyVertex> {
    let mut corners = match body {
        Body::Line => Vec::new(),
        Body::Octahedron => octahedron(),
        Body::Stick => stick(),
        Body::Ball => ball(),
    };
    // A sample bone, to determine the winding of each triangle.
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

/// A body as a device draws it: each vertex once, and the triangles as indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyMesh {
    /// All vertices, each different.
    pub vertices: Vec<BodyVertex>,
    /// Three per triangle.
    pub indices: Vec<u16>,
}

impl BodyMesh {
    /// The mesh of `body`. A vertex that several triangles share is computed once for all of them.
    pub fn of(body: Body) -> Self {
        let mut mesh = Self::default();
        for face in triangles(body).chunks_exact(3) {
            let corners = [0, 1, 2].map(|corner| mesh.index_of(&face[corner]));
            let [a, b, c] = corners;
            // The triangles at the poles of a ball have two equal corners.
            if a != b && b != c && c != a {
                mesh.indices.extend(corners);
            }
        }
        mesh
    }

    fn index_of(&mut self, vertex: &BodyVertex) -> u16 {
        let known = self.vertices.iter().position(|other| other == vertex);
        let index = known.unwrap_or_else(|| {
            self.vertices.push(*vertex);
            self.vertices.len() - 1
        });
        index as u16
    }
}

/// Returns the position of a body's vertex for a bone, as the vertex shader computes it.
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
        // The long faces are nearly parallel to the bone, the short ones much steeper.
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
        let (sin, cos) = ((side % ROUND) as f32 * TAU / ROUND as f32).sin_cos();
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
        // All corners at a pole are the same one.
        let sin_ring = if ring.is_multiple_of(RINGS + 1) { 0.0 } else { sin_ring };
        let (sin, cos) = ((side % ROUND) as f32 * TAU / ROUND as f32).sin_cos();
        let normal = [cos * sin_ring, cos_ring, sin * sin_ring];
        BodyVertex { place: [normal[0], 0.0, normal[2], normal[1]], normal, edges: [1.0; 3] }
    };
    let quad = |(ring, side): (usize, usize)| {
        let (a, b, c, d) = (at(ring, side), at(ring, side + 1), at(ring + 1, side), at(ring + 1, side + 1));
        [a, b, c, b, d, c]
    };
    (0..=RINGS).flat_map(|ring| (0..ROUND).map(move |side| (ring, side))).flat_map(quad).collect()
}
