//! The order of collapses: a mesh of any number of triangles, from the original to the coarsest (Hoppe 1996).

use crate::data::Primitive;

/// One vertex that moves onto another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Move {
    /// The collapse that it belongs to; several vertices at one place move together.
    pub step: u32,
    /// The vertex that moves; each moves once.
    pub vertex: u32,
    /// The vertex that it moves onto, which still exists at this step.
    pub onto: u32,
}

/// All collapses of a primitive, in order; plain data.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Progression {
    /// All moves, ascending by step.
    pub moves: Vec<Move>,
    /// For each triangle of the original, the number of steps after which it is removed; `u32::MAX` for one that stays.
    pub gone_after: Vec<u32>,
    /// Number of triangles left after each number of steps; the first is the original's.
    pub left: Vec<u32>,
}

impl Progression {
    /// Returns the number of collapses.
    pub fn steps(&self) -> usize {
        self.left.len().saturating_sub(1)
    }

    /// Returns the fewest steps after which at most `triangles` are left; the number of all steps if more are left even
    /// then.
    pub fn steps_to(&self, triangles: usize) -> usize {
        self.left.partition_point(|&left| left as usize > triangles).min(self.steps())
    }

    /// Writes the indices of `primitive` after `steps` collapses to `out`, in the order of the original; after 0 steps
    /// they are those of the original.
    ///
    /// `scratch` is working memory. If `out` and `scratch` are kept between calls, nothing is allocated. O(vertices +
    /// triangles).
    /// Vertices and triangles that `primitive` does not have are left out.
    pub fn indices_after(
        &self,
        primitive: &Primitive,
        steps: usize,
        scratch: &mut Vec<u32>,
        out: &mut Vec<u32>,
    ) {
        out.clear();
        if steps == 0 {
            out.extend_from_slice(&primitive.indices);
            return;
        }
        scratch.clear();
        scratch.extend(0..primitive.vertices.len() as u32);
        let done = self.moves.partition_point(|one| (one.step as usize) < steps);
        // A target moves later, if at all: from the last move to the first, each target is final when it is read.
        for one in self.moves[..done].iter().rev() {
            let onto = scratch.get(one.onto as usize).copied();
            if let (Some(onto), Some(place)) = (onto, scratch.get_mut(one.vertex as usize)) {
                *place = onto;
            }
        }
        for (triangle, corners) in primitive.indices.chunks_exact(3).enumerate() {
            let gone = self.gone_after.get(triangle).is_some_and(|&after| after as usize <= steps);
            let there = corners.iter().all(|&corner| (corner as usize) < scratch.len());
            if there && !gone {
                out.extend(corners.iter().map(|&corner| scratch[corner as usize]));
            }
        }
    }
}
