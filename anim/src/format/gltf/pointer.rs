//! `KHR_animation_pointer`: channels whose target is a JSON pointer.
//!
//! A pointer to a transform or to the weights of a node is another way to write an ordinary channel, and becomes one. What
//! other pointers animate is not shown; their channels are listed in warnings, and a save keeps them.

use super::document::NO_NODE;
use super::save::TargetPath;
use gltf::json;
use gltf::json::Index;
use gltf::json::animation::Property;
use gltf::json::validation::Checked;
use std::collections::HashMap;

/// Name of the extension.
pub(super) const EXTENSION: &str = "KHR_animation_pointer";

/// The pointers of channels, by the numbers of animation and channel.
pub(super) type ChannelPointers = HashMap<(usize, usize), String>;

/// Returns node and property of a pointer such as `/nodes/3/rotation`.
pub(super) fn node_target(pointer: &str) -> Option<(u32, TargetPath)> {
    let (node, path) = pointer.strip_prefix("/nodes/")?.split_once('/')?;
    let is_index = node == "0" || (!node.starts_with('0') && node.bytes().all(|byte| byte.is_ascii_digit()));
    let node = node.parse().ok().filter(|&node| is_index && node as usize != NO_NODE)?;
    Some((node, TargetPath::named(path)?))
}

/// Turns channels with pointers to nodes of the document into ordinary ones.
pub(super) fn resolve(root: &mut json::Root, pointers: &ChannelPointers) {
    let nodes = root.nodes.len();
    for ((animation, channel), pointer) in pointers {
        let animation = root.animations.get_mut(*animation);
        let Some(channel) = animation.and_then(|animation| animation.channels.get_mut(*channel)) else {
            continue;
        };
        let target = node_target(pointer).filter(|(node, _)| (*node as usize) < nodes);
        let (Checked::Invalid, Some((node, path))) = (channel.target.path, target) else { continue };
        channel.target.node = Index::new(node);
        channel.target.path = Checked::Valid(match path {
            TargetPath::Translation => Property::Translation,
            TargetPath::Rotation => Property::Rotation,
            TargetPath::Scale => Property::Scale,
            TargetPath::Weights => Property::MorphTargetWeights,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_pointers_to_transforms_and_weights_of_nodes_are_targets_of_nodes() {
        assert_eq!(node_target("/nodes/0/rotation"), Some((0, TargetPath::Rotation)));
        assert_eq!(node_target("/nodes/12/weights"), Some((12, TargetPath::Weights)));
        for other in [
            "",
            "/nodes/0",
            "/nodes/00/scale",
            "/nodes/+1/scale",
            "/nodes/-1/scale",
            "/nodes/4294967295/scale",
            "/nodes/99999999999/scale",
            "/nodes/0/weights/1",
            "/nodes/0/extensions/KHR_node_visibility/visible",
            "/materials/0/alphaCutoff",
            "nodes/0/scale",
        ] {
            assert_eq!(node_target(other), None, "{other}");
        }
    }
}
