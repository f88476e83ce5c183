//! The selected, hidden and pinned bones, and the one under the pointer.

use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_document::bones::{BoneSelection, Choice, HiddenBones, MirrorPairs};
use dragonfly_picture::pick::ClickCycle;
use egui::Pos2;
use glam::Vec2;

/// A command that changes the selection or the hidden bones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SelectionCommand {
    /// Selects all bones that are shown.
    All,
    /// Selects the bones that are not selected.
    Invert,
    /// Adds the parents.
    ExtendParent,
    /// Adds the children.
    ExtendChild,
    /// Adds everything below.
    Branch,
    /// Adds parents and children.
    Grow,
    /// Removes the bones with a parent or child that is not selected.
    Shrink,
    /// Hides the selected bones.
    Hide,
    /// Hides all other bones.
    HideOthers,
    /// Shows all bones and selects those that were hidden.
    ShowAll,
}

/// Selection, hidden bones, pins and the bone under the pointer.
#[derive(Debug, Default)]
pub(super) struct SelectedBones {
    selection: BoneSelection,
    hidden: HiddenBones,
    /// Bones that keep position and rotation while others are moved.
    pins: Vec<BoneIndex>,
    /// The bone whose row is under the pointer.
    hovered: Option<BoneIndex>,
    /// Position of the pointer over the viewport, points.
    pointer: Option<Pos2>,
    /// The bone under the pointer in the viewport, as far as the answer is known.
    pointed: Option<BoneIndex>,
    /// Cycles through overlapping bones on repeated clicks at one position.
    cycle: ClickCycle,
}

impl SelectedBones {
    /// Forgets everything, for a model with `bones` bones.
    pub(super) fn reset(&mut self, bones: usize) {
        *self = Self { selection: BoneSelection::new(bones), pointer: self.pointer, ..Self::default() };
    }

    /// Follows the bones to another skeleton with `bones` bones.
    pub(super) fn shift(&mut self, shift: BoneShift, bones: usize) {
        self.cycle.forget();
        self.selection.shift(shift, bones);
        self.hidden.shift(shift);
        self.pins = shift.bones(&self.pins);
        let bone = |bone: Option<BoneIndex>| bone.and_then(|bone| shift.bone(bone));
        (self.hovered, self.pointed) = (bone(self.hovered), bone(self.pointed));
    }

    /// Returns the selection; the active bone is the one selected last.
    pub(super) fn selection(&self) -> &BoneSelection {
        &self.selection
    }

    /// Returns the selected bones in the order of selection.
    pub(super) fn bones(&self) -> &[BoneIndex] {
        self.selection.bones()
    }

    /// Returns the active bone.
    pub(super) fn active(&self) -> Option<BoneIndex> {
        self.selection.active()
    }

    /// Returns the hidden bones.
    pub(super) fn hidden(&self) -> &HiddenBones {
        &self.hidden
    }

    /// Selects this bone alone, or none.
    pub(super) fn select(&mut self, bone: Option<BoneIndex>) {
        self.selection.click(bone, Choice::Replace);
    }

    /// Changes the selection by these bones: replaces, adds or toggles them.
    pub(super) fn choose(&mut self, bones: &[BoneIndex], choice: Choice) {
        self.selection.choose(bones, choice);
    }

    /// Deselects all bones.
    pub(super) fn clear(&mut self) {
        self.selection.clear();
    }

    /// Hides bones, or shows them again.
    pub(super) fn hide(&mut self, bones: &[BoneIndex], hide: bool) {
        self.cycle.forget();
        self.hidden.set(bones, hide, &mut self.selection);
    }

    /// Selects the parent of the active bone; the first bone if none is selected.
    pub(super) fn select_parent(&mut self, skeleton: &Skeleton) {
        match self.active() {
            Some(bone) => {
                if let Some(parent) = skeleton.bones.get(bone as usize).and_then(|bone| bone.parent) {
                    self.select(Some(parent));
                }
            }
            None => self.select((!skeleton.bones.is_empty()).then_some(0)),
        }
    }

    /// Selects the first child of the active bone.
    pub(super) fn select_child(&mut self, skeleton: &Skeleton) {
        let child = skeleton.children(self.active()).next();
        self.select(child.or(self.active()));
    }

    /// Applies a command to the selection and the hidden bones.
    pub(super) fn command(&mut self, command: SelectionCommand, skeleton: &Skeleton) {
        self.cycle.forget();
        let (selection, hidden) = (&mut self.selection, &mut self.hidden);
        match command {
            SelectionCommand::All => selection.all(hidden),
            SelectionCommand::Invert => selection.invert(hidden),
            SelectionCommand::ExtendParent => selection.parents(skeleton, hidden, true),
            SelectionCommand::ExtendChild => selection.children(skeleton, hidden, true),
            SelectionCommand::Branch => selection.descendants(skeleton, hidden),
            SelectionCommand::Grow => selection.grow(skeleton, hidden),
            SelectionCommand::Shrink => selection.shrink(skeleton, hidden),
            SelectionCommand::Hide => hidden.hide(selection),
            SelectionCommand::HideOthers => hidden.hide_others(selection),
            SelectionCommand::ShowAll => hidden.show_all(selection),
        }
    }

    /// Selects the bones on the other side of the body; with `extend`, adds them to the selection. Returns whether the
    /// selection changed.
    pub(super) fn mirror(&mut self, skeleton: &Skeleton, extend: bool) -> bool {
        self.cycle.forget();
        let before = self.selection.clone();
        self.selection.mirror(&MirrorPairs::of(skeleton), &self.hidden, extend);
        self.selection != before
    }

    /// Selects one of the bones under a click at `at`, sorted by depth. A repeated click selects the next one.
    pub(super) fn clicked(&mut self, at: Pos2, bones: &[BoneIndex], choice: Choice) {
        let bone = if choice == Choice::Replace {
            self.cycle.click(Vec2::new(at.x, at.y), bones)
        } else {
            self.cycle.forget();
            bones.first().copied()
        };
        self.selection.click(bone, choice);
    }

    /// Changes the selection by the bones inside a box or lasso.
    pub(super) fn caught(&mut self, bones: &[BoneIndex], choice: Choice) {
        self.cycle.forget();
        self.selection.choose(bones, choice);
    }

    /// Returns the pinned bones.
    pub(super) fn pins(&self) -> &[BoneIndex] {
        &self.pins
    }

    /// Replaces the pinned bones.
    pub(super) fn set_pins(&mut self, pins: Vec<BoneIndex>) {
        self.pins = pins;
    }

    /// Pins the selected bones, or unpins them if all of them are pinned. Returns whether they are pinned now.
    pub(super) fn toggle_pins(&mut self) -> bool {
        let bones = self.selection.bones();
        let all = bones.iter().all(|bone| self.pins.contains(bone));
        self.pins.retain(|pin| !bones.contains(pin));
        if !all {
            self.pins.extend(bones);
        }
        !all
    }

    /// Returns the bone whose row is under the pointer.
    pub(super) fn hovered(&self) -> Option<BoneIndex> {
        self.hovered
    }

    /// Sets the bone whose row is under the pointer.
    pub(super) fn hover(&mut self, bone: Option<BoneIndex>) {
        self.hovered = bone;
    }

    /// Returns the position of the pointer over the viewport, points.
    pub(super) fn pointer(&self) -> Option<Pos2> {
        self.pointer
    }

    /// Sets the position of the pointer over the viewport; a pointer that left it is over no bone.
    pub(super) fn set_pointer(&mut self, pointer: Option<Pos2>) {
        self.pointer = pointer;
        if pointer.is_none() {
            self.pointed = None;
        }
    }

    /// Returns the bone under the pointer in the viewport.
    pub(super) fn pointed(&self) -> Option<BoneIndex> {
        self.pointed
    }

    /// Sets the bone under the pointer in the viewport. Returns whether it changed while the pointer is over the viewport.
    pub(super) fn set_pointed(&mut self, bone: Option<BoneIndex>) -> bool {
        if self.pointed == bone || self.pointer.is_none() {
            return false;
        }
        self.pointed = bone;
        true
    }
}
