//! Shortcuts as in Blender's pose mode and dope sheet.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const TABLE: PresetKeys = &[
    // Drags that a key begins at once.
    (Id::MoveNow, &[key(NONE, Key::G)]),
    (Id::RotateNow, &[key(NONE, Key::R)]),
    (Id::ScaleNow, &[key(NONE, Key::S)]),
    (Id::ToolSelect, &[key(NONE, Key::W)]),
    (Id::ToolMove, &[key(SHIFT.plus(CTRL), Key::G)]),
    (Id::ToolRotate, &[key(SHIFT.plus(CTRL), Key::R)]),
    (Id::ToolScale, &[key(ALT.plus(SHIFT), Key::S)]),
    (Id::NextSpace, &[key(NONE, Key::Comma)]),
    // Selection.
    (Id::SelectAll, &[key(NONE, Key::A)]),
    (Id::ClearSelection, &[key(ALT, Key::A), key(NONE, Key::Escape)]),
    (Id::InvertSelection, &[key(CTRL, Key::I)]),
    (Id::BoxSelect, &[key(NONE, Key::B)]),
    (Id::SelectBranch, &[key(NONE, Key::L)]),
    (Id::SelectMirror, &[key(SHIFT.plus(CTRL), Key::M)]),
    // Keys and poses.
    (Id::Key, &[key(NONE, Key::I), key(NONE, Key::K)]),
    (Id::DeleteKeys, &[key(NONE, Key::X), key(NONE, Key::Delete)]),
    (Id::DuplicateKeys, &[key(SHIFT, Key::D)]),
    (Id::PasteMirrored, &[key(SHIFT.plus(CTRL), Key::V)]),
    (Id::AddMarker, &[key(NONE, Key::M)]),
    (Id::RangeOfKeys, &[key(ALT.plus(CTRL), Key::P)]),
    // Time.
    (Id::Start, &[key(SHIFT, Key::ArrowLeft)]),
    (Id::End, &[key(SHIFT, Key::ArrowRight)]),
    (Id::PreviousFrame, &[key(NONE, Key::ArrowLeft)]),
    (Id::NextFrame, &[key(NONE, Key::ArrowRight)]),
    (Id::PreviousKey, &[key(NONE, Key::ArrowDown)]),
    (Id::NextKey, &[key(NONE, Key::ArrowUp)]),
    (Id::PlayBackwards, &[key(SHIFT.plus(CTRL), Key::Space)]),
    // The viewport.
    (Id::FrameAll, &[key(NONE, Key::Home)]),
    (Id::FrameSelected, &[key(NONE, Key::Period)]),
    (Id::ToggleXRay, &[key(ALT, Key::Z)]),
    (Id::Palette, &[key(NONE, Key::F3), key(CTRL, Key::P)]),
];

/// The dope sheet and the graph editor.
#[rustfmt::skip] // A table is read in columns.
pub(super) const OVER_KEYS: PresetKeys = &[
    (Id::BoxSelectKeys, &[key(NONE, Key::B)]),
    (Id::InterpolationMenu, &[key(NONE, Key::T)]),
    (Id::TangentMenu, &[key(NONE, Key::V)]),
    (Id::MoveKeysNow, &[key(NONE, Key::G)]),
    (Id::ScaleKeysNow, &[key(NONE, Key::S)]),
    (Id::DuplicateKeysNow, &[key(SHIFT, Key::D)]),
    (Id::SelectAllKeys, &[key(NONE, Key::A)]),
    (Id::DeselectKeys, &[key(ALT, Key::A)]),
    (Id::InvertKeys, &[key(CTRL, Key::I)]),
    (Id::CopyKeys, &[key(CTRL, Key::C)]),
    (Id::DeleteKeys, &[key(NONE, Key::X), key(NONE, Key::Delete)]),
    (Id::SnapKeys, &[key(SHIFT, Key::S)]),
    (Id::KeysReverse, &[key(CTRL, Key::M)]),
    (Id::FitKeys, &[key(NONE, Key::Home), key(NONE, Key::Period)]),
];
