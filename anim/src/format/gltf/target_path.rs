//! The properties of nodes that channels animate, and pointers to them.

/// Represents "no node" in the target of an animation.
pub(super) const NO_NODE: usize = u32::MAX as usize;

/// Name of the extension for channels whose target is a JSON pointer.
pub(super) const POINTER_EXTENSION: &str = "KHR_animation_pointer";

/// Animated property of a node or mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum TargetPath {
    Translation,
    Rotation,
    Scale,
    Weights,
}

impl TargetPath {
    /// Returns the name in the file.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Translation => "translation",
            Self::Rotation => "rotation",
            Self::Scale => "scale",
            Self::Weights => "weights",
        }
    }

    /// Returns the property of this name.
    pub(super) fn named(name: &str) -> Option<Self> {
        [Self::Translation, Self::Rotation, Self::Scale, Self::Weights]
            .into_iter()
            .find(|path| path.name() == name)
    }
}

/// Returns node and property of a pointer such as `/nodes/3/rotation`.
pub(super) fn node_target(pointer: &str) -> Option<(u32, TargetPath)> {
    let (node, path) = pointer.strip_prefix("/nodes/")?.split_once('/')?;
    let is_index = node == "0" || (!node.starts_with('0') && node.bytes().all(|byte| byte.is_ascii_digit()));
    let node = node.parse().ok().filter(|&node| is_index && node as usize != NO_NODE)?;
    Some((node, TargetPath::named(path)?))
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
