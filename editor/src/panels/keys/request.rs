//! Requests of panels about keys.

use super::ChannelId;
use super::aim::KeyAim;
use super::buttonless::ButtonlessStep;
use super::flags::BoneFlag;
use super::markers::MarkerAction;
use super::op::KeyDragOp;
use super::window::TimeWindow;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::Choice;
use std::sync::Arc;

/// A request about keys.
#[derive(Clone, Debug, PartialEq)]
pub enum KeysRequest {
    /// Selects the keys of channels between two times, ends included.
    Select {
        /// The channels.
        channels: Arc<[ChannelId]>,
        /// Whether keys of morph targets are meant as well.
        shapes: bool,
        /// Start and end, seconds.
        stretch: [f32; 2],
        /// Whether they replace, extend or toggle the selection.
        choice: Choice,
    },
    /// Selects single keys of channels and of shape keys.
    SelectKeys {
        /// Stretches of time of each channel, seconds.
        parts: Vec<(ChannelId, Vec<[f32; 2]>)>,
        /// Stretches of time of shape keys, seconds.
        shapes: Vec<[f32; 2]>,
        /// Whether they replace, extend or toggle the selection.
        choice: Choice,
    },
    /// Selects a bone by its row, and keeps the rows that are listed.
    SelectRow(BoneIndex, Choice),
    /// Deselects all keys.
    Deselect,
    /// Shows this part of time, or the whole take.
    Window(Option<TimeWindow>),
    /// Begins or continues a drag.
    Drag(KeyDragOp),
    /// Changes the drag that follows the pointer without a button.
    Buttonless(ButtonlessStep),
    /// Prepares what the next press over keys does, or nothing.
    Aim(Option<KeyAim>),
    /// Ends the drag; its edits stay.
    Release,
    /// Cancels the drag; its edits are undone.
    Cancel,
    /// Sets or clears a flag of a bone.
    Flag(BoneFlag, BoneIndex, bool),
    /// Sets whether moved keys go to whole frames.
    Snap(bool),
    /// Sets whether only the selected bones are listed.
    OnlySelected(bool),
    /// Sets the part of the names of the bones that are listed.
    Filter(String),
    /// Changes the markers of the take.
    Marker(MarkerAction),
    /// Plays this part of the take, seconds, or the whole take.
    Range(Option<[f32; 2]>),
}
