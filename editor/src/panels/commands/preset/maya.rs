//! Shortcuts as in Maya.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const TABLE: PresetKeys = &[
    // Dragging.
    (Id::ToolSelect, &[key(NONE, Key::Q)]),
    (Id::ToolMove, &[key(NONE, Key::W)]),
    (Id::ToolRotate, &[key(NONE, Key::E)]),
    (Id::ToolScale, &[key(NONE, Key::R)]),
    // Keys.
    (Id::Key, &[key(NONE, Key::S), key(NONE, Key::I)]),
    (Id::SnapKeys, &[key(ALT.plus(SHIFT), Key::S)]),
    (Id::DuplicateKeys, &[key(CTRL, Key::D)]),
    // Time.
    (Id::PlayPause, &[key(ALT, Key::V), key(NONE, Key::Space)]),
    (Id::Start, &[key(ALT.plus(SHIFT), Key::V), key(NONE, Key::Home)]),
    (Id::PreviousFrame, &[key(ALT, Key::Comma), key(NONE, Key::ArrowLeft)]),
    (Id::NextFrame, &[key(ALT, Key::Period), key(NONE, Key::ArrowRight)]),
    (Id::PreviousKey, &[key(NONE, Key::Comma)]),
    (Id::NextKey, &[key(NONE, Key::Period)]),
    // Selection.
    (Id::SelectParent, &[key(NONE, Key::ArrowUp), key(NONE, Key::OpenBracket)]),
    (Id::SelectChild, &[key(NONE, Key::ArrowDown), key(NONE, Key::CloseBracket)]),
    (Id::InvertSelection, &[key(CTRL.plus(SHIFT), Key::I), key(CTRL, Key::I)]),
    (Id::HideSelected, &[key(CTRL, Key::H)]),
    (Id::HideOthers, &[key(ALT, Key::H)]),
    (Id::ShowAll, &[key(CTRL.plus(SHIFT), Key::H)]),
    (Id::Undo, &[key(CTRL, Key::Z), key(NONE, Key::Z)]),
    (Id::Redo, &[key(CTRL, Key::Y), key(SHIFT, Key::Z), key(CTRL.plus(SHIFT), Key::Z)]),
    // The viewport.
    (Id::FrameAll, &[key(NONE, Key::A)]),
    (Id::FrameSelected, &[key(NONE, Key::F)]),
    (Id::ShadeUnlit, &[key(NONE, Key::Num4)]),
    (Id::ShadeClay, &[key(NONE, Key::Num5)]),
    (Id::ShadeMaterial, &[key(NONE, Key::Num6)]),
    (Id::ToggleProjection, &[]),
];

/// The graph editor and the dope sheet.
#[rustfmt::skip] // A table is read in columns.
pub(super) const OVER_KEYS: PresetKeys = &[
    (Id::BoxSelectKeys, &[key(NONE, Key::Q)]),
    (Id::InterpolationMenu, &[key(NONE, Key::T)]),
    (Id::TangentMenu, &[key(NONE, Key::V)]),
    (Id::MoveKeysNow, &[key(NONE, Key::W)]),
    (Id::ScaleKeysNow, &[key(NONE, Key::R)]),
    (Id::SelectAllKeys, &[key(CTRL, Key::A)]),
    (Id::CopyKeys, &[key(CTRL, Key::C)]),
    (Id::DeleteKeys, &[key(NONE, Key::Delete)]),
    (Id::FitKeys, &[key(NONE, Key::A), key(NONE, Key::F)]),
];
