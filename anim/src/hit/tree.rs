//! The tree: its data, and how it is stored and restored (thesis §2.1.7.2: functions to create and to store it).

use super::build;
use crate::bounds::reach::Reaches;
use crate::bounds::reach_builder::{ReachBuilder, moving_targets};
use crate::data::{ModelData, Primitive};

/// Largest number of triangles of a leaf; a tree built here has far fewer.
pub const LEAF_TRIANGLES: usize = 64;

/// Largest number of triangles of a tree, summed over instances; a tree takes a few hundred bytes for each.
pub const TREE_TRIANGLES: u64 = 1 << 24;

/// Largest depth in nodes; a tree built here has fewer than 70.
pub const TREE_DEPTH: usize = 128;

/// Marks a node above several primitives, which has no part.
pub(super) const MIXED: u32 = u32::MAX;

/// A node of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitNode {
    /// Two children, by position in [`HitTreeParts::nodes`]; both after this one.
    Inner([u32; 2]),
    /// A leaf, by position in [`HitTreeParts::leaves`].
    Leaf(u32),
}

/// A few neighboring triangles that are moved by mostly the same bones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HitLeaf {
    /// Position in [`ModelData::instances`].
    pub instance: u32,
    /// Position in the primitives of the instance's mesh.
    pub primitive: u32,
    /// The first of [`HitTreeParts::triangles`]; leaves follow each other without a gap.
    pub first: u32,
    /// Number of triangles; 1..=[`LEAF_TRIANGLES`].
    pub count: u32,
}

/// A tree as plain lists: all that has to be stored.
///
/// The boxes are not included: [`HitTree::from_parts`] computes them from the model, in one pass, so stored boxes can
/// neither be too small nor belong to an older version of the model.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HitTreeParts {
    /// The nodes of the tree; the first is the root. Empty without triangles.
    pub nodes: Vec<HitNode>,
    /// The leaves; each belongs to one node.
    pub leaves: Vec<HitLeaf>,
    /// Triangles of the primitives, grouped by leaf; every triangle of every instance once.
    pub triangles: Vec<u32>,
}

/// Reasons why lists are not a tree of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HitTreeError {
    /// More triangles than [`TREE_TRIANGLES`], summed over instances.
    #[error("{triangles} triangles in all instances are too many; at most {TREE_TRIANGLES} are possible")]
    TooLarge {
        /// Number of triangles in the model.
        triangles: u64,
    },
    /// A node whose child is missing or does not come after it, or a node with no parent or several.
    #[error("node {node} of the hit tree is not part of a tree")]
    Node {
        /// Position in [`HitTreeParts::nodes`].
        node: usize,
    },
    /// A leaf whose primitive is missing, that does not begin at the end of the one before, or that belongs to no node
    /// or several.
    #[error("leaf {leaf} of the hit tree does not fit the model")]
    Leaf {
        /// Position in [`HitTreeParts::leaves`].
        leaf: usize,
    },
    /// A triangle that the primitive does not have, or a duplicate.
    #[error("triangle {position} of leaf {leaf} of the hit tree does not fit the model")]
    Triangle {
        /// Position in [`HitTreeParts::leaves`].
        leaf: usize,
        /// Position in [`HitTreeParts::triangles`].
        position: usize,
    },
    /// The tree is deeper than any that is built here.
    #[error("the hit tree is {depth} nodes deep; at most {TREE_DEPTH} are possible")]
    Deep {
        /// Number of nodes on the longest path.
        depth: usize,
    },
    /// Triangles of the model that are in no leaf.
    #[error("the hit tree contains {found} of {expected} triangles")]
    Missing {
        /// Number of triangles in leaves.
        found: usize,
        /// Number of triangles of the model.
        expected: usize,
    },
}

/// A hierarchy of boxes (BVH) over the triangles of a model, for any pose (thesis §2.1.7.2).
///
/// Built once, or restored from stored [`HitTreeParts`]; it never changes, so it is shared as an `Arc`. A
/// [`super::HitPose`] fits it to a pose and answers queries.
#[derive(Clone, Debug)]
#[doc(alias = "BVH")]
pub struct HitTree {
    parts: HitTreeParts,
    /// One part per node, except for mixed ones.
    pub(super) reaches: Reaches,
    /// For each node: its part or [`MIXED`], and the instance and primitive.
    pub(super) parts_of: Vec<(u32, u32, u32)>,
    /// For each leaf: the first of its vertices in `vertices`; one more at the end.
    pub(super) first_vertex: Vec<u32>,
    /// Vertices of the primitives, grouped by leaf, each once per leaf.
    pub(super) vertices: Vec<u32>,
    /// For each triangle: its corners among the vertices of the leaf.
    pub(super) corners: Vec<[u8; 3]>,
}

impl HitTree {
    /// Builds the tree of `model`. O(n log n) in the triangles of all instances; the same model gives the same tree.
    ///
    /// A triangle with a missing vertex is left out. Fails where a model has more than [`TREE_TRIANGLES`].
    pub fn of(model: &ModelData) -> Result<Self, HitTreeError> {
        let triangles = count(model);
        if triangles > TREE_TRIANGLES {
            return Err(HitTreeError::TooLarge { triangles });
        }
        Ok(Self::bind(build::parts(model), model))
    }

    /// Restores the tree from stored `parts`, which must be of `model` or of one with the same triangles.
    ///
    /// Everything is checked, so that a tree from a file gives the same results as a new one: it misses nothing, and
    /// every query ends. O(triangles).
    pub fn from_parts(parts: HitTreeParts, model: &ModelData) -> Result<Self, HitTreeError> {
        check_nodes(&parts)?;
        let depth = depth(&parts);
        if depth > TREE_DEPTH {
            return Err(HitTreeError::Deep { depth });
        }
        check_leaves(&parts, model)?;
        Ok(Self::bind(parts, model))
    }

    /// Returns the lists that have to be stored to restore the tree.
    pub fn parts(&self) -> &HitTreeParts {
        &self.parts
    }

    /// Returns the lists and drops the rest.
    pub fn into_parts(self) -> HitTreeParts {
        self.parts
    }

    /// Computes the derived data from valid parts and the model.
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
            // Leaves of a primitive mostly follow each other, so one list is cached.
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

    /// Adds the parts of the inner nodes; the parts of the leaves exist already.
    fn add_inner(&mut self, builder: &mut ReachBuilder) {
        self.parts_of = vec![(MIXED, 0, 0); self.parts.nodes.len()];
        // In reverse, because children come after their parents.
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

/// Returns the number of triangles of all instances.
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

/// Returns whether all three corners of the triangle exist.
pub(super) fn is_valid(primitive: &Primitive, triangle: usize) -> bool {
    let corners = primitive.indices.get(triangle * 3..triangle * 3 + 3);
    corners.is_some_and(|corners| corners.iter().all(|&corner| (corner as usize) < primitive.vertices.len()))
}

/// Returns the largest depth in nodes. Children come after their parents.
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

/// Checks that each node but the first has one parent, which precedes it, and each leaf belongs to one node.
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
                    let seen =
                        named.get_mut(child as usize).filter(|_| child as usize > index).ok_or(wrong)?;
                    if std::mem::replace(seen, true) {
                        return Err(HitTreeError::Node { node: child as usize });
                    }
                }
            }
            HitNode::Leaf(leaf) => {
                let seen = leaves.get_mut(*leaf as usize).ok_or(wrong)?;
                if std::mem::replace(seen, true) {
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

/// Checks that the leaves contain every valid triangle of every instance once.
fn check_leaves(parts: &HitTreeParts, model: &ModelData) -> Result<(), HitTreeError> {
    let triangles = count(model);
    if triangles > TREE_TRIANGLES {
        return Err(HitTreeError::TooLarge { triangles });
    }
    // For each instance and primitive, the position of its first triangle among all.
    let (mut starts, mut expected, mut all) = (Vec::new(), 0, 0);
    for instance in &model.instances {
        let mesh = model.meshes.get(instance.mesh as usize);
        let primitives = mesh.map_or(&[][..], |mesh| &mesh.primitives);
        let mut of_instance = Vec::with_capacity(primitives.len());
        for primitive in primitives {
            of_instance.push((primitive, all));
            let count = primitive.indices.len() / 3;
            expected += (0..count).filter(|&triangle| is_valid(primitive, triangle)).count();
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
            let fits = is_valid(primitive, triangle as usize);
            if !fits || std::mem::replace(&mut seen[start + triangle as usize], true) {
                return Err(HitTreeError::Triangle { leaf: index, position: next + at });
            }
        }
        next += count;
    }
    let missing = HitTreeError::Missing { found: next.min(parts.triangles.len()), expected };
    if next == expected && parts.triangles.len() == expected { Ok(()) } else { Err(missing) }
}
