//! `KHR_animation_pointer`: channels whose target is a JSON pointer.
//!
//! A pointer to a transform or to the weights of a node is another way to write an ordinary channel, and becomes one. What
//! other pointers animate is not shown; their channels are listed in warnings, and a save keeps them.

use super::target_path::{TargetPath, node_target};
use gltf::json;
use gltf::json::Index;
use gltf::json::animation::Property;
use gltf::json::validation::Checked;
use std::collections::HashMap;

/// The pointers of channels, by the numbers of animation and channel.
pub(super) type ChannelPointers = HashMap<(usize, usize), String>;

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
