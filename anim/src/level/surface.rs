//! A primitive with vertices merged into places, and the triangles around each place.

use crate::bounds::reach_builder::moving_targets;
use crate::data::{Influence, Primitive};
use glam::{DVec3, Vec3};
use std::cmp::Ordering;

/// A place with more triangles around it is not moved, and no collapse exceeds this number.
pub(super) const MOST_AROUND: usize = 64;

/// A primitive as a surface of places.
pub(super) struct Surface<'a> {
    pub(super) primitive: &'a Primitive,
    /// For each vertex its place, which is the first vertex there.
    pub(super) place: Vec<u32>,
    /// For each vertex its side of a seam, which is the first vertex with the same place, texture coordinates and
    /// color.
    pub(super) side: Vec<u32>,
    /// Vertices of each side that triangles use, grouped: `members[first[side]..]`.
    members: Vec<(u32, u32)>,
    /// For each triangle, the current vertices of its corners; `None` once it is removed.
    pub(super) triangles: Vec<Option<[u32; 3]>>,
    /// For each place, the triangles around it, some of which may be removed.
    around: Vec<Vec<u32>>,
    /// For each place, whether it must stay.
    pub(super) locked: Vec<bool>,
    /// Positions as stored, and in each pose; one per vertex, scaled to at most 1, so that no square overflows.
    pub(super) poses: Vec<Vec<DVec3>>,
    /// Morph targets that move anything.
    pub(super) targets: Vec<u32>,
    /// Scale of the stored positions in the first of `poses`.
    pub(super) scale: f64,
}

impl<'a> Surface<'a> {
    /// Builds the surface of `primitive`, which has the positions `poses` in some poses; vertices for which `locked`
    /// returns true stay. A pose that is too short is ignored.
    pub(super) fn of(primitive: &'a Primitive, poses: &[Vec<Vec3>], locked: &dyn Fn(usize) -> bool) -> Self {
        let count = primitive.vertices.len();
        let targets = moving_targets(primitive);
        let mut order: Vec<u32> = (0..count as u32).collect();
        let by_place = |a: &u32, b: &u32| compare_places(primitive, &targets, *a as usize, *b as usize);
        let by_side = |a: &u32, b: &u32| compare_sides(primitive, *a as usize, *b as usize);
        order.sort_unstable_by(|a, b| by_place(a, b).then_with(|| by_side(a, b)).then(a.cmp(b)));
        let (mut place, mut side) = (vec![0; count], vec![0; count]);
        for group in order.chunk_by(|a, b| by_place(a, b).is_eq()) {
            let first = group.iter().copied().min().unwrap_or(0);
            for sides in group.chunk_by(|a, b| by_side(a, b).is_eq()) {
                for &vertex in sides {
                    place[vertex as usize] = first;
                    side[vertex as usize] = sides[0];
                }
            }
        }
        let (stored, scale) = near_one(&primitive.vertices.positions);
        let poses = poses.iter().filter(|pose| pose.len() >= count).map(|pose| near_one(&pose[..count]).0);
        let poses = std::iter::once(stored).chain(poses).collect();
        let mut surface = Self {
            primitive,
            place,
            side,
            members: Vec::new(),
            triangles: Vec::new(),
            around: vec![Vec::new(); count],
            locked: (0..count).map(|vertex| !primitive.vertices.positions[vertex].is_finite()).collect(),
            poses,
            targets,
            scale,
        };
        surface.add_triangles();
        for vertex in (0..count).filter(|&vertex| locked(vertex)) {
            let place = surface.place[vertex] as usize;
            surface.locked[place] = true;
        }
        surface
    }

    /// Adds the triangles that have three places, and locks the places with too many triangles.
    fn add_triangles(&mut self) {
        let count = self.place.len();
        for (index, corners) in self.primitive.indices.chunks_exact(3).enumerate() {
            let corners = [corners[0], corners[1], corners[2]];
            let there = corners.iter().all(|&corner| (corner as usize) < count);
            let places = corners.map(|corner| if there { self.place[corner as usize] } else { 0 });
            let distinct = places[0] != places[1] && places[1] != places[2] && places[2] != places[0];
            self.triangles.push((there && distinct).then_some(corners));
            if there && distinct {
                places.iter().for_each(|&place| self.around[place as usize].push(index as u32));
                self.members.extend(corners.map(|corner| (self.side[corner as usize], corner)));
            }
        }
        self.members.sort_unstable();
        self.members.dedup();
        for (locked, around) in self.locked.iter_mut().zip(&self.around) {
            *locked |= around.len() > MOST_AROUND;
        }
    }

    /// Returns the number of remaining triangles.
    pub(super) fn left(&self) -> usize {
        self.triangles.iter().flatten().count()
    }

    /// Returns the places of a triangle's corners.
    pub(super) fn places(&self, corners: [u32; 3]) -> [u32; 3] {
        corners.map(|corner| self.place[corner as usize])
    }

    /// Iterates over the remaining triangles around `place`, each with its corners.
    pub(super) fn around(&self, place: u32) -> impl Iterator<Item = (u32, [u32; 3])> + '_ {
        let all = self.around[place as usize].iter();
        all.filter_map(|&triangle| Some((triangle, self.triangles[triangle as usize]?)))
    }

    /// Iterates over vertices on a side of a seam that triangles of the original use.
    pub(super) fn members(&self, side: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.members.partition_point(|member| member.0 < side);
        self.members[first..].iter().take_while(move |member| member.0 == side).map(|member| member.1)
    }

    /// Moves the remaining triangles of `from` to `onto`.
    pub(super) fn move_triangles(&mut self, from: u32, onto: u32) {
        let mut moved = std::mem::take(&mut self.around[from as usize]);
        moved.append(&mut self.around[onto as usize]);
        moved.retain(|&triangle| self.triangles[triangle as usize].is_some());
        self.around[onto as usize] = moved;
    }
}

/// Compares two vertices; equal if they are always at the same position: same position, influences and differences.
fn compare_places(primitive: &Primitive, targets: &[u32], a: usize, b: usize) -> Ordering {
    let vertices = &primitive.vertices;
    let mut order = compare(vertices.positions[a], vertices.positions[b]);
    if order.is_eq() {
        let (a, b) = (vertices.influences_of(a), vertices.influences_of(b));
        order = a.iter().map(key).cmp(b.iter().map(key));
    }
    for &target in targets {
        if order.is_ne() {
            break;
        }
        let differences = &primitive.morph_targets[target as usize].positions;
        let of = |vertex: usize| differences.get(vertex).copied().unwrap_or(Vec3::ZERO);
        order = compare(of(a), of(b));
    }
    order
}

/// Compares two vertices; equal if they have the same texture coordinates and color.
fn compare_sides(primitive: &Primitive, a: usize, b: usize) -> Ordering {
    let vertices = &primitive.vertices;
    let key = |vertex: usize| {
        let sets = vertices.texture_coordinates.each_ref().map(|set| {
            let at = set.get(vertex).copied().unwrap_or_default();
            [at.x, at.y].map(bits)
        });
        let color = vertices.colors.get(vertex).copied().unwrap_or_default();
        (sets, color.to_array().map(bits))
    };
    key(a).cmp(&key(b))
}

/// An influence without weight counts as none, whatever its joint is.
fn key(influence: &Influence) -> (u16, u32) {
    if influence.weight == 0.0 { (0, 0) } else { (influence.joint, influence.weight.to_bits()) }
}

fn compare(a: Vec3, b: Vec3) -> Ordering {
    a.to_array().map(bits).cmp(&b.to_array().map(bits))
}

/// Returns the bits of a number, with minus zero as zero.
fn bits(number: f32) -> u32 {
    (number + 0.0).to_bits()
}

/// Returns positions moved to the origin and scaled to at most 1, and the scale; those that are not finite are put at
/// the origin.
fn near_one(positions: &[Vec3]) -> (Vec<DVec3>, f64) {
    let finite =
        || positions.iter().filter(|position| position.is_finite()).map(|position| position.as_dvec3());
    let (min, max) = finite()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), point| (min.min(point), max.max(point)));
    let size = (max - min).max_element();
    let scale = if size > 0.0 && size.is_finite() { 1.0 / size } else { 1.0 };
    let middle = if size.is_finite() { (min + max) * 0.5 } else { DVec3::ZERO };
    let near = |position: &Vec3| {
        if position.is_finite() { (position.as_dvec3() - middle) * scale } else { DVec3::ZERO }
    };
    (positions.iter().map(near).collect(), scale)
}
