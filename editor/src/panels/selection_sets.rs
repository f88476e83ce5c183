//! Selection sets: named, colored sets of bones, remembered with the other marks of a file.

use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::root_bone::BoneShift;

/// Largest number of sets of a file.
pub const MOST: usize = 200;
/// Longest name, characters.
const LONGEST: usize = 100;

/// Colors of sets.
pub const COLORS: [[u8; 3]; 8] = [
    [224, 108, 117],
    [229, 160, 84],
    [214, 196, 92],
    [126, 190, 110],
    [86, 182, 194],
    [97, 155, 232],
    [164, 132, 226],
    [212, 124, 188],
];

/// A named set of bones.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SelectionSet {
    /// Its name.
    pub name: String,
    /// Its color.
    pub color: [u8; 3],
    /// Its bones, each once.
    pub bones: Vec<BoneIndex>,
}

/// A change of the sets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SetAction {
    /// Selects the bones of a set.
    Select(usize),
    /// Adds the bones of a set to the selection.
    Extend(usize),
    /// Removes the bones of a set from the selection.
    Subtract(usize),
    /// Saves the selected bones as a new set.
    Save,
    /// Adds the selected bones to a set.
    AddBones(usize),
    /// Removes the selected bones from a set; a set without bones is removed.
    RemoveBones(usize),
    /// Renames a set.
    Rename(usize, String),
    /// Gives a set a color.
    Color(usize, [u8; 3]),
    /// Removes a set.
    Remove(usize),
}

/// The sets of the model that is open.
#[derive(Clone, Debug, Default)]
pub struct SelectionSets {
    list: Vec<SelectionSet>,
    /// The set that was selected last.
    last: Option<usize>,
    /// Grows with every change.
    version: u64,
}

impl SelectionSets {
    /// Returns the sets in their order.
    pub fn list(&self) -> &[SelectionSet] {
        &self.list
    }

    /// Returns a number that grows with every change.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Returns the set that was selected last.
    pub fn last(&self) -> Option<usize> {
        self.last
    }

    pub(super) fn set_last(&mut self, last: usize) {
        self.last = Some(last).filter(|&last| last < self.list.len());
    }

    /// Replaces all sets: those of a model that was just opened.
    pub(super) fn replace(&mut self, list: Vec<SelectionSet>) {
        (self.list, self.last) = (list, None);
        self.list.truncate(MOST);
        self.version += 1;
    }

    /// Follows the bones to another skeleton. A set without bones is removed.
    pub(super) fn shift(&mut self, shift: BoneShift) {
        for set in &mut self.list {
            set.bones = shift.bones(&set.bones);
        }
        for at in (0..self.list.len()).rev() {
            if self.list[at].bones.is_empty() {
                self.remove(at);
            }
        }
        self.version += 1;
    }

    /// Changes the sets; `selected` are the selected bones. Returns whether anything changed.
    pub(super) fn change(&mut self, action: &SetAction, selected: &[BoneIndex]) -> bool {
        let before = self.list.clone();
        match action {
            SetAction::Select(_) | SetAction::Extend(_) | SetAction::Subtract(_) => {}
            SetAction::Save if selected.is_empty() || self.list.len() >= MOST => {}
            SetAction::Save => {
                let numbered = (1..=self.list.len() + 1).map(|number| format!("Set {number}"));
                let unused = |name: &String| !self.list.iter().any(|set| set.name == *name);
                let name = numbered.into_iter().find(unused).unwrap_or_default();
                let color = COLORS[self.list.len() % COLORS.len()];
                self.last = Some(self.list.len());
                self.list.push(SelectionSet { name, color, bones: selected.to_vec() });
            }
            SetAction::AddBones(set) => {
                if let Some(set) = self.list.get_mut(*set) {
                    set.bones.extend(selected);
                    set.bones.sort_unstable();
                    set.bones.dedup();
                }
            }
            SetAction::RemoveBones(at) => {
                if let Some(set) = self.list.get_mut(*at) {
                    set.bones.retain(|bone| !selected.contains(bone));
                    if set.bones.is_empty() {
                        self.remove(*at);
                    }
                }
            }
            SetAction::Rename(set, name) => {
                let name: String = name.trim().chars().take(LONGEST).collect();
                if let Some(set) = self.list.get_mut(*set).filter(|_| !name.is_empty()) {
                    set.name = name;
                }
            }
            SetAction::Color(set, color) => {
                if let Some(set) = self.list.get_mut(*set) {
                    set.color = *color;
                }
            }
            SetAction::Remove(at) => self.remove(*at),
        }
        let changed = self.list != before;
        self.version += u64::from(changed);
        changed
    }

    fn remove(&mut self, at: usize) {
        if at < self.list.len() {
            self.list.remove(at);
            self.last = self.last.filter(|&last| last != at).map(|last| last - usize::from(last > at));
        }
    }
}
