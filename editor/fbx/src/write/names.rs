//! Names of bones and takes.

use super::losses::FbxLosses;
use dragonfly_anim::data::ModelData;
use std::collections::HashMap;

/// Names that were given.
#[derive(Default)]
pub(super) struct UsedNames(HashMap<String, u32>);

impl UsedNames {
    /// Returns `stem` and `end` together, with a number between them if an object before has that name.
    pub(super) fn unique(&mut self, stem: &str, end: &str) -> String {
        let wanted = format!("{stem}{end}");
        let Some(&first) = self.0.get(&wanted) else {
            self.0.insert(wanted.clone(), 2);
            return wanted;
        };
        let numbered = |number: u32| format!("{stem}_{number}{end}");
        let number = (first..).find(|&number| !self.0.contains_key(&numbered(number))).unwrap_or(u32::MAX);
        self.0.insert(wanted, number.saturating_add(1));
        self.0.insert(numbered(number), 2);
        numbered(number)
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
