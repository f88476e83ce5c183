//! The node tree: checked to be a tree, and walked without recursion.

use super::accessor::{invalid, unresolved};
use super::check as code;
use crate::format::{ImportContext, ImportError, Place};
use crate::limits::{NODE_DEPTH, NODES};
use gltf::json;

/// The parent of each node, and the order in which to visit the nodes.
#[derive(Debug, Default)]
pub(super) struct Graph {
    /// Parent of each node; `None` for a root.
    pub(super) parents: Vec<Option<u32>>,
    /// Every node once, parents first: depth first from the roots, roots by number, children in the order of the file.
    pub(super) order: Vec<u32>,
}

/// Checks that the nodes of `root` form trees: every child exists and has one parent, and no node is its own ancestor.
pub(super) fn graph(root: &json::Root, context: &ImportContext<'_>) -> Result<Graph, ImportError> {
    let count = root.nodes.len();
    let place = Place::Pointer("/nodes".to_owned());
    if count > NODES {
        let (size, limit) = (count as u64, NODES as u64);
        return Err(ImportError::TooLarge { place, what: "nodes", size, limit });
    }
    let parents = parents(root, context, &place)?;
    let mut order = context.vec(&place, count)?;
    let mut open: Vec<(u32, u32)> = context.vec(&place, count)?;
    open.extend(
        (0..count as u32).rev().filter(|&node| parents[node as usize].is_none()).map(|node| (node, 1)),
    );
    while let Some((node, depth)) = open.pop() {
        context.work(1)?;
        if depth as usize > NODE_DEPTH {
            let place = Place::Pointer(format!("/nodes/{node}"));
            let (size, limit) = (u64::from(depth), NODE_DEPTH as u64);
            return Err(ImportError::TooLarge { place, what: "levels of nodes", size, limit });
        }
        order.push(node);
        open.extend(
            children(root, node as usize).iter().rev().map(|child| (child.value() as u32, depth + 1)),
        );
    }
    if order.len() < count {
        return Err(loop_error(&parents, &order));
    }
    Ok(Graph { parents, order })
}

fn children(root: &json::Root, node: usize) -> &[json::Index<json::Node>] {
    root.nodes[node].children.as_deref().unwrap_or(&[])
}

fn parents(
    root: &json::Root,
    context: &ImportContext<'_>,
    place: &Place,
) -> Result<Vec<Option<u32>>, ImportError> {
    let mut parents = context.filled(place, root.nodes.len(), None)?;
    for node in 0..root.nodes.len() {
        for (number, child) in children(root, node).iter().enumerate() {
            context.work(1)?;
            let from = || format!("/nodes/{node}/children/{number}");
            let parent: &mut Option<u32> =
                parents.get_mut(child.value()).ok_or_else(|| unresolved(&from(), child.value()))?;
            if child.value() == node {
                let reason = format!("node {node} is its own child");
                return Err(invalid(Place::Pointer(from()), code::NODE_LOOP, reason));
            }
            if let Some(other) = *parent {
                let reason = format!("node {} is a child of node {other} already", child.value());
                return Err(invalid(Place::Pointer(from()), code::NODE_PARENT_OVERRIDE, reason));
            }
            *parent = Some(node as u32);
        }
    }
    Ok(parents)
}

/// Returns the error of a node in a loop: one that the walk from the roots did not reach.
fn loop_error(parents: &[Option<u32>], order: &[u32]) -> ImportError {
    let mut reached = vec![false; parents.len()];
    for &node in order {
        reached[node as usize] = true;
    }
    let node = reached.iter().position(|reached| !reached).unwrap_or(0);
    let reason = format!("node {node} is its own ancestor, or a descendant of such a node");
    invalid(Place::Pointer(format!("/nodes/{node}")), code::NODE_LOOP, reason)
}
