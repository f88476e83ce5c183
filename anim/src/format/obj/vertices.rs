//! Finds the vertices that corners share: those that agree in position, texture coordinate and normal.
//!
//! Few vertices have the same position, so they are found in a list of those at each position. Where there are many, as in
//! files made to be slow, a map takes over.

use crate::format::{ImportContext, ImportError, Place};
use std::collections::HashMap;

/// Normal of a vertex: one of the file, or computed.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum NormalKey {
    /// Number of a normal of the file.
    File(u32),
    /// Of all polygons of a smoothing group at the position.
    Smooth(u32),
    /// Of one polygon.
    Flat(u32),
}

/// Properties that are equal at corners that share a vertex.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct VertexKey {
    /// Number of the primitive.
    pub(super) primitive: u32,
    pub(super) position: u32,
    pub(super) texture: u32,
    pub(super) normal: NormalKey,
}

/// Bytes of a vertex, of its place in these lists, and of copies while lists grow.
const VERTEX_BYTES: u64 = 192;

/// Most vertices of a position that are in its list.
const NEAR: usize = 8;

/// Stands for no vertex.
const NONE: u32 = u32::MAX;

/// A vertex in the list of its position.
struct KnownVertex {
    key: VertexKey,
    /// Number in its primitive.
    number: u32,
    /// The one before it in the list, or [`NONE`].
    before: u32,
}

/// The vertices of all primitives.
pub(super) struct VertexFinder {
    /// Number in `known` of the last vertex of each position, or [`NONE`].
    last: Vec<u32>,
    known: Vec<KnownVertex>,
    /// Vertices at positions whose list is full.
    further: HashMap<VertexKey, u32>,
}

impl VertexFinder {
    /// Returns one for a file with this number of positions.
    pub(super) fn new(positions: usize, context: &ImportContext<'_>) -> Result<Self, ImportError> {
        let last = context.filled(&Place::File, positions, NONE)?;
        Ok(Self { last, known: Vec::new(), further: HashMap::new() })
    }

    /// Returns the number of the vertex with this key in its primitive. If there is none yet, it is the vertex `new`,
    /// which is charged to the budget.
    #[inline]
    pub(super) fn number(
        &mut self,
        key: VertexKey,
        new: u32,
        context: &ImportContext<'_>,
    ) -> Result<u32, ImportError> {
        let Some(last) = self.last.get_mut(key.position as usize) else { return Ok(new) };
        let (mut next, mut passed) = (*last, 0);
        while let Some(known) = self.known.get(next as usize) {
            if known.key == key {
                return Ok(known.number);
            }
            (next, passed) = (known.before, passed + 1);
        }
        if passed >= NEAR
            && let Some(&number) = self.further.get(&key)
        {
            return Ok(number);
        }
        context.charge(&Place::File, VERTEX_BYTES)?;
        if passed >= NEAR {
            self.further.insert(key, new);
        } else {
            let before = std::mem::replace(last, self.known.len() as u32);
            self.known.push(KnownVertex { key, number: new, before });
        }
        Ok(new)
    }
}
