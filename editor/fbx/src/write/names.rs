//! Names of bones and takes.

use super::losses::FbxLosses;
use dragonfly_anim::data::ModelData;
use std::collections::HashMap;

/// Names that were given.
#[derive(Default)]
pub(super) struct UsedNames {
    /// For each name the number that the next one like it gets.
    next: HashMap<String, u32>,
    ignores_capitals: bool,
}

impl UsedNames {
    /// Returns no names, of which later two count as the same if they differ only in capitals.
    pub(super) fn without_capitals() -> Self {
        Self { ignores_capitals: true, ..Self::default() }
    }

    /// Returns `stem` and `end` together, with a number between them if an object before has that name.
    pub(super) fn unique(&mut self, stem: &str, end: &str) -> String {
        let wanted = format!("{stem}{end}");
        let key = self.key(&wanted);
        let Some(&first) = self.next.get(&key) else {
            self.next.insert(key, 2);
            return wanted;
        };
        let numbered = |number: u32| format!("{stem}_{number}{end}");
        let is_new = |number: &u32| !self.next.contains_key(&self.key(&numbered(*number)));
        let number = (first..).find(is_new).unwrap_or(u32::MAX);
        self.next.insert(key, number.saturating_add(1));
        let key = self.key(&numbered(number));
        self.next.insert(key, 2);
        numbered(number)
    }

    fn key(&self, name: &str) -> String {
        if self.ignores_capitals { name.to_lowercase() } else { name.to_owned() }
    }
}

/// Returns the name of each bone in the file.
pub(super) fn bone_names(model: &ModelData, are_unique: bool, losses: &mut FbxLosses) -> Vec<String> {
    let mut used = UsedNames::default();
    let mut names = Vec::with_capacity(model.animation.skeleton.len());
    for (index, bone) in model.animation.skeleton.bones.iter().enumerate() {
        let wanted = stored(&bone.name, "bone");
        let name = if are_unique { used.unique(&wanted, "") } else { wanted };
        renamed(format!("/animation/skeleton/bones/{index}/name"), "bone", &bone.name, &name, losses);
        names.push(name);
    }
    names
}

/// Returns the name of each take in the file; all are different.
pub(super) fn take_names(model: &ModelData, losses: &mut FbxLosses) -> Vec<String> {
    let mut used = UsedNames::default();
    let mut names = Vec::with_capacity(model.animation.takes.len());
    for (index, take) in model.animation.takes.iter().enumerate() {
        let name = used.unique(&stored(&take.name, "Take"), "");
        renamed(format!("/animation/takes/{index}/name"), "take", &take.name, &name, losses);
        names.push(name);
    }
    names
}

/// Returns a name that the format can store: not empty, and without the two characters that end a name.
fn stored(name: &str, otherwise: &str) -> String {
    let plain = |character: char| if matches!(character, '\0' | '\u{1}') { '_' } else { character };
    if name.is_empty() { otherwise.to_owned() } else { name.chars().map(plain).collect() }
}

fn renamed(place: String, what: &str, before: &str, now: &str, losses: &mut FbxLosses) {
    if before != now {
        losses.add(place, format!("the {what} \"{before}\" is called \"{now}\""));
    }
}
