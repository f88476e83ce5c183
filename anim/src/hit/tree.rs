//! The hierarchy: what is kept with a model, how it is stored and taken back (thesis §2.1.7.2: functions to create and
//! to store it).

use super::build;
use crate::bounds::reach::Reaches;
use crate::bounds::reach_builder::{ReachBuilder, moving_targets};
use crate::data::{ModelData, Primitive};

/// Most triangles of a leaf; a tree that is made has far fewer.
pub const LEAF_TRIANGLES: usize = 64;

/// Most triangles of a tree, those of every instance counted; a tree takes a few hundred bytes for each.
pub const TREE_TRIANGLES: u64 = 1 << 24;

/// Most nodes on a way down; a tree that is made has fewer than 70.
pub const TREE_DEPTH: usize = 128;

/// No part: of a node above several primitives.
pub(super) const MIXED: u32 = u32::MAX;

/// A place in the hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitNode {
    /// Two nodes below, by position in [`HitTreeParts::nodes`]; both after this one.
    Inner([u32; 2]),
    /// A handful of triangles, by position in [`HitTreeParts::leaves`].
    Leaf(u32),
}

/// A handful of triangles that lie near each other and are moved by much the same bones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HitLeaf {
    /// Position in [`ModelData::instances`].
    pub instance: u32,
    /// Position in the primitives of the instance's mesh.
    pub primitive: u32,
    /// The first of [`HitTreeParts::triangles`]; leaves follow each other without a gap.
    pub first: u32,
    /// How many; 1..=[`LEAF_TRIANGLES`].
    pub count: u32,
}

/// A hierarchy as plain lists: all that has to be stored.
///
/// The boxes are not among it: [`HitTree::from_parts`] makes them from the model anew, in one pass, so stored boxes
/// can neither be too small nor belong to an older version of the model.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HitTreeParts {
    /// A tree; the first is the root. Empty without triangles.
    pub nodes: Vec<HitNode>,
    /// Each belongs to one node.
    pub leaves: Vec<HitLeaf>,
    /// Triangles of the primitives, grouped by leaf; every triangle of every instance once.
    pub triangles: Vec<u32>,
}

/// Why lists are no hierarchy of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HitTreeError {
    /// More triangles than fit, those of every instance counted.
    #[error("{triangles} triangles in all instances; at most {TREE_TRIANGLES}")]
    TooLarge {
        /// Counted in the model.
        triangles: u64,
    },
    /// A node that names what is not there or lies before it, or that no other node or several name.
    #[error("node {node} of the hierarchy is not part of a tree")]
    Node {
        /// Position in [`HitTreeParts::nodes`].
        node: usize,
    },
    /// A leaf that names what is not there, or that does not begin where the one before ends, or that no node or
    /// several name.
    #[error("leaf {leaf} of the hierarchy does not fit the model")]
    Leaf {
        /// Position in [`HitTreeParts::leaves`].
        leaf: usize,
    },
    /// A triangle that the primitive does not have, or that came before.
    #[error("triangle {position} of leaf {leaf} of the hierarchy does not fit the model")]
    Triangle {
        /// Position in [`HitTreeParts::leaves`].
        leaf: usize,
        /// Position in [`HitTreeParts::triangles`].
        position: usize,
    },
    /// A way down that is longer than that of any tree that is made.
    #[error("the hierarchy is {depth} nodes deep; at most {TREE_DEPTH}")]
    Deep {
        /// Nodes on the longest way down.
        depth: usize,
    },
    /// Triangles of the model that no leaf names.
    #[error("the hierarchy holds {found} triangles of {expected}")]
    Missing {
        /// Named by leaves.
        found: usize,
        /// Of the model.
        expected: usize,
    },
}

/// A hierarchy of boxes over the triangles of a model, for any pose (thesis §2.1.7.2).
///
/// Made once, or taken from stored [`HitTreeParts`]; nobody changes it, so it is shared as an `Arc`. A [`super::HitPose`]
/// puts it in a pose and answers.
#[derive(Clone, Debug)]
pub struct HitTree {
    parts: HitTreeParts,
    /// One part a node, but for those that are mixed.
    pub(super) reaches: Reaches,
    /// Of each node: its part or [`MIXED`], and the instance and primitive.
    pub(super) parts_of: Vec<(u32, u32, u32)>,
    /// Of each leaf: the first of its vertices in `vertices`; one more at the end.
    pub(super) first_vertex: Vec<u32>,
    /// Vertices of the primitives, grouped by leaf, each once a leaf.
    pub(super) vertices: Vec<u32>,
    /// Beside the triangles: their corners among the vertices of the leaf.
    pub(super) corners: Vec<[u8; 3]>,
}

impl HitTree {
    /// The hierarchy of `model`. O(n log n) in the triangles of all instances; the same model gives the same tree.
    ///
    /// A triangle that names a vertex which is not there is left out. Fails where a model has more than
    /// [`TREE_TRIANGLES`].
    pub fn of(model: &ModelData) -> Result<Self, HitTreeError> {
        let triangles = count(model);
        if triangles > TREE_TRIANGLES {
            return Err(HitTreeError::TooLarge { triangles });
        }
        Ok(Self::bind(build::parts(model), model))
    }

    /// The hierarchy from stored `parts`, which must be of `model` or of one with the same triangles.
    ///
    /// Everything is checked, so that a hierarchy taken from a file answers as one just made would: it misses nothing,
    /// and comes to an end. O(triangles).
    pub fn from_parts(parts: HitTreeParts, model: &ModelData) -> Result<Self, HitTreeError> {
        check_nodes(&parts)?;
        let depth = depth(&parts);
        if depth > TREE_DEPTH {
            return Err(HitTreeError::Deep { depth });
        }
        check_leaves(&parts, model)?;
        Ok(Self::bind(parts, model))
    }

    /// What has to be stored to have the tree again.
    pub fn parts(&self) -> &HitTreeParts {
        &self.parts
    }

    /// Takes the lists out.
    pub fn into_parts(self) -> HitTreeParts {
        self.parts
    }

    /// Makes what follows from sound parts and the model.
    fn bind(parts: HitTreeParts, model: &ModelData) -> Self {
        let mut builder = ReachBuilder::new();
        let mut tree = Self {
            reaches: Reaches::default(),
            first_vertex: Vec::with_capacity(parts.leaves.len() + 1),
            vertices: Vec::new(),
            corners: Vec::with_capacity(parts.triangles.len()),
            parts_of: Vec::new(),
            parts,
        };
        let mut targets: Option<((u32, u32), Vec<u32>)> = None;
        for leaf in &tree.parts.leaves {
            let instance = &model.instances[leaf.instance as usize];
            let primitive = &model.meshes[instance.mesh as usize].primitives[leaf.primitive as usize];
            let first = tree.vertices.len();
            tree.first_vertex.push(first as u32);
            for &triangle in &tree.parts.triangles[leaf.first as usize..(leaf.first + leaf.count) as usize] {
                let at = triangle as usize * 3;
                tree.corners.push([0, 1, 2].map(|corner| {
                    let vertex = primitive.indices[at + corner];
                    let known = tree.vertices[first..].iter().position(|&other| other == vertex);
                    known.unwrap_or_else(|| {
                        tree.vertices.push(vertex);
                        tree.vertices.len() - 1 - first
                    }) as u8
                }));
            }
            // Leaves of a primitive mostly follow each other, so one list is remembered.
            let key = (instance.mesh, leaf.primitive);
            if targets.as_ref().is_none_or(|(other, _)| *other != key) {
                targets = Some((key, moving_targets(primitive)));
            }
            let targets = targets.as_ref().map_or(&[][..], |(_, targets)| targets);
            let skinned = instance.skin.is_some() && primitive.vertices.influences_per_vertex > 0;
            let vertices = tree.vertices[first..].iter().map(|&vertex| vertex as usize);
            builder.add(primitive, skinned, None, targets, vertices);
        }
        tree.first_vertex.push(tree.vertices.len() as u32);
        tree.add_inner(&mut builder);
        tree.reaches = builder.finish();
        tree
    }

    /// Adds the parts of the nodes; those of the leaves are there.
    fn add_inner(&mut self, builder: &mut ReachBuilder) {
        self.parts_of = vec![(MIXED, 0, 0); self.parts.nodes.len()];
        // Children come after their parents.
        for (index, node) in self.parts.nodes.iter().enumerate().rev() {
            self.parts_of[index] = match *node {
                HitNode::Leaf(leaf) => {
                    let of = self.parts.leaves[leaf as usize];
                    (leaf, of.instance, of.primitive)
                }
                HitNode::Inner([left, right]) => {
                    let (left, right) = (self.parts_of[left as usize], self.parts_of[right as usize]);
                    let one = left.0 != MIXED && right.0 != MIXED && (left.1, left.2) == (right.1, right.2);
                    if one {
                        builder.join(left.0 as usize, right.0 as usize);
                        (builder.len() as u32 - 1, left.1, left.2)
                    } else {
                        (MIXED, 0, 0)
                    }
                }
            };
        }
    }
}

/// Triangles of all instances.
fn count(model: &ModelData) -> u64 {
    let of_mesh: Vec<u64> = model
        .meshes
        .iter()
        .map(|mesh| mesh.primitives.iter().map(|primitive| primitive.indices.len() as u64 / 3).sum())
        .collect();
    let instances = model.instances.iter();
    instances
        .filter_map(|instance| of_mesh.get(instance.mesh as usize))
        .fold(0, |sum, n| sum.saturating_add(*n))
}

/// Are all three corners of the triangle there?
pub(super) fn is_sound(primitive: &Primitive, triangle: usize) -> bool {
    let corners = primitive.indices.get(triangle * 3..triangle * 3 + 3);
    corners.is_some_and(|corners| corners.iter().all(|&corner| (corner as usize) < primitive.vertices.len()))
}

/// Most nodes on a way down. Children come after their parents.
fn depth(parts: &HitTreeParts) -> usize {
    let mut depths = vec![1_u32; parts.nodes.len()];
    for (index, node) in parts.nodes.iter().enumerate() {
        if let HitNode::Inner(children) = node {
            for &child in children {
                depths[child as usize] = depths[index] + 1;
            }
        }
    }
    depths.into_iter().max().unwrap_or(0) as usize
}

/// Is each node but the first named once, by one before it, and each leaf once?
fn check_nodes(parts: &HitTreeParts) -> Result<(), HitTreeError> {
    let mut named = vec![false; parts.nodes.len()];
    let mut leaves = vec![false; parts.leaves.len()];
    if let Some(root) = named.first_mut() {
        *root = true;
    }
    for (index, node) in parts.nodes.iter().enumerate() {
        let wrong = HitTreeError::Node { node: index };
        match node {
            HitNode::Inner(children) => {
                for &child in children {
                    let place =
                        named.get_mut(child as usize).filter(|_| child as usize > index).ok_or(wrong)?;
                    if std::mem::replace(place, true) {
                        return Err(HitTreeError::Node { node: child as usize });
                    }
                }
            }
            HitNode::Leaf(leaf) => {
                let place = leaves.get_mut(*leaf as usize).ok_or(wrong)?;
                if std::mem::replace(place, true) {
                    return Err(HitTreeError::Leaf { leaf: *leaf as usize });
                }
            }
        }
    }
    if let Some(node) = named.iter().position(|named| !named) {
        return Err(HitTreeError::Node { node });
    }
    leaves.iter().position(|named| !named).map_or(Ok(()), |leaf| Err(HitTreeError::Leaf { leaf }))
}

/// Do the leaves name every sound triangle of every instance once?
fn check_leaves(parts: &HitTreeParts, model: &ModelData) -> Result<(), HitTreeError> {
    let triangles = count(model);
    if triangles > TREE_TRIANGLES {
        return Err(HitTreeError::TooLarge { triangles });
    }
    // Of each instance and primitive: where its triangles begin among all.
    let (mut starts, mut expected, mut all) = (Vec::new(), 0, 0);
    for instance in &model.instances {
        let mesh = model.meshes.get(instance.mesh as usize);
        let primitives = mesh.map_or(&[][..], |mesh| &mesh.primitives);
        let mut of_instance = Vec::with_capacity(primitives.len());
        for primitive in primitives {
            of_instance.push((primitive, all));
            let count = primitive.indices.len() / 3;
            expected += (0..count).filter(|&triangle| is_sound(primitive, triangle)).count();
            all += count;
        }
        starts.push(of_instance);
    }
    let (mut seen, mut next) = (vec![false; all], 0_usize);
    for (index, leaf) in parts.leaves.iter().enumerate() {
        let wrong = HitTreeError::Leaf { leaf: index };
        let primitives = starts.get(leaf.instance as usize).ok_or(wrong)?;
        let (primitive, start) = *primitives.get(leaf.primitive as usize).ok_or(wrong)?;
        let count = leaf.count as usize;
        if leaf.first as usize != next || !(1..=LEAF_TRIANGLES).contains(&count) {
            return Err(wrong);
        }
        for (at, &triangle) in parts.triangles.get(next..next + count).ok_or(wrong)?.iter().enumerate() {
            let fits = is_sound(primitive, triangle as usize);
            if !fits || std::mem::replace(&mut seen[start + triangle as usize], true) {
                return Err(HitTreeError::Triangle { leaf: index, position: next + at });
            }
        }
        next += count;
    }
    let missing = HitTreeError::Missing { found: next.min(parts.triangles.len()), expected };
    if next == expected && parts.triangles.len() == expected { Ok(()) } else { Err(missing) }
}
