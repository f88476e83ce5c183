//! The order of collapses: a mesh of any number of triangles, from the original to the coarsest (Hoppe 1996).

use crate::data::Primitive;

/// One vertex that moves onto another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Move {
    /// The collapse that it is part of; several vertices at one place move together.
    pub step: u32,
    /// Which vertex; it moves once.
    pub vertex: u32,
    /// Where it goes; still there at this step.
    pub onto: u32,
}

/// All collapses of a primitive, in order; plain data.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Progression {
    /// Ascending by step.
    pub moves: Vec<Move>,
    /// Of each triangle of the original: after how many steps it is gone; `u32::MAX` for one that stays.
    pub gone_after: Vec<u32>,
    /// Triangles that are left after each number of steps; the first is the original's.
    pub left: Vec<u32>,
}

impl Progression {
    /// Number of collapses.
    pub fn steps(&self) -> usize {
        self.left.len().saturating_sub(1)
    }

    /// The fewest steps after which at most `triangles` are left; all steps where there are more even then.
    pub fn steps_to(&self, triangles: usize) -> usize {
        self.left.partition_point(|&left| left as usize > triangles).min(self.steps())
    }

    /// Writes the indices of `primitive` after `steps` collapses to `out`, in the order of the original; after none
    /// they are the original's.
    ///
    /// `room` is worked in; with both kept between calls nothing is allocated. O(vertices + triangles). A vertex or a
    /// triangle that `primitive` does not have is left out.
    pub fn indices_after(
        &self,
        primitive: &Primitive,
        steps: usize,
        room: &mut Vec<u32>,
        out: &mut Vec<u32>,
    ) {
        out.clear();
        if steps == 0 {
            out.extend_from_slice(&primitive.indices);
            return;
        }
        room.clear();
        room.extend(0..primitive.vertices.len() as u32);
        let done = self.moves.partition_point(|one| (one.step as usize) < steps);
        // What a vertex moves onto moves later, if at all: from the last to the first each is known when asked for.
        for one in self.moves[..done].iter().rev() {
            let onto = room.get(one.onto as usize).copied();
            if let (Some(onto), Some(place)) = (onto, room.get_mut(one.vertex as usize)) {
                *place = onto;
            }
        }
        for (triangle, corners) in primitive.indices.chunks_exact(3).enumerate() {
            let gone = self.gone_after.get(triangle).is_some_and(|&after| after as usize <= steps);
            let there = corners.iter().all(|&corner| (corner as usize) < room.len());
            if there && !gone {
                out.extend(corners.iter().map(|&corner| room[corner as usize]));
            }
        }
    }
}
