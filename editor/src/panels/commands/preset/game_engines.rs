//! Shortcuts as in Godot and Unity. Where the two differ, the shortcut is used that no other command needs.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const TABLE: PresetKeys = &[
    // Dragging; Q is the select tool in Godot, and the hand tool in Unity.
    (Id::ToolSelect, &[key(NONE, Key::Q)]),
    (Id::ToolMove, &[key(NONE, Key::W)]),
    (Id::ToolRotate, &[key(NONE, Key::E)]),
    (Id::ToolScale, &[key(NONE, Key::R)]),
    // Local axes in Godot, and the choice of axes in Unity.
    (Id::NextSpace, &[key(NONE, Key::T), key(NONE, Key::X)]),
    (Id::PivotMedian, &[key(NONE, Key::Z)]),
    (Id::ToggleXRay, &[key(ALT, Key::Z)]),
    // Keys.
    (Id::Key, &[key(NONE, Key::K), key(NONE, Key::Insert)]),
    (Id::KeyAllPending, &[key(SHIFT, Key::K)]),
    (Id::DuplicateKeys, &[key(CTRL, Key::D)]),
    (Id::DeleteKeys, &[key(NONE, Key::Delete), key(NONE, Key::Backspace)]),
    (Id::RenameTake, &[key(NONE, Key::F2)]),
    // The timeline of Unity.
    (Id::SplitActions, &[key(NONE, Key::S), key(NONE, Key::Y)]),
    // Time.
    (Id::PreviousFrame, &[key(NONE, Key::Comma), key(NONE, Key::ArrowLeft)]),
    (Id::NextFrame, &[key(NONE, Key::Period), key(NONE, Key::ArrowRight)]),
    (Id::PreviousKey, &[key(ALT, Key::Comma)]),
    (Id::NextKey, &[key(ALT, Key::Period)]),
    (Id::PlayPause, &[key(NONE, Key::Space), key(NONE, Key::D)]),
    (Id::PlayBackwards, &[key(SHIFT, Key::Space), key(NONE, Key::A)]),
    // The viewport.
    (Id::FrameSelected, &[key(NONE, Key::F)]),
    (Id::Palette, &[key(CTRL, Key::K), key(CTRL.plus(SHIFT), Key::P), key(NONE, Key::F3), key(CTRL, Key::P)]),
];

/// The animation panel of Godot and the animation window of Unity.
#[rustfmt::skip] // A table is read in columns.
pub(super) const OVER_KEYS: PresetKeys = &[
    (Id::BoxSelectKeys, &[key(NONE, Key::Q)]),
    (Id::InterpolationMenu, &[key(NONE, Key::T)]),
    (Id::TangentMenu, &[key(NONE, Key::V)]),
    (Id::MoveKeysNow, &[key(NONE, Key::W)]),
    (Id::ScaleKeysNow, &[key(NONE, Key::R)]),
    (Id::SelectAllKeys, &[key(CTRL, Key::A)]),
    (Id::CopyKeys, &[key(CTRL, Key::C)]),
    (Id::FitKeys, &[key(NONE, Key::A), key(NONE, Key::F)]),
];
