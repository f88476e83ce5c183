//! The second skeleton that a dialog shows in the viewport.

use dragonfly_anim::data::BoneIndex;
use glam::Vec3;

/// The second skeleton that a dialog shows in the viewport while it is open.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DialogPreview {
    /// None.
    #[default]
    Nothing,
    /// The end of the take over its start.
    LoopEnd {
        /// Distance from the end to the start: the way of the bone that travels, backwards.
        offset: Vec3,
    },
    /// The model whose takes are wanted, next to the open one.
    Source {
        /// Index of its take.
        take: usize,
        /// Factor of its size.
        scale: f32,
        /// Its distance from its place.
        offset: Vec3,
        /// The bone of it that moves the selected bone.
        marked: Option<BoneIndex>,
    },
}
