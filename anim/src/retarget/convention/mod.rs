//! Naming conventions of skeletons: which bone of a rig is which part of the body.
//!
//! Each convention is one file with a table of rows, and one entry in [`CONVENTIONS`]. A row is a name and a part. In names,
//! capitals and everything but letters and digits do not count, nor does a namespace (`mixamorig:`); `{side}` is `left` or `right`,
//! `{s}` is `l` or `r`, and `#` is a number. Parts that are chains of bones (spine, neck, fingers) have several rows or a `#`: their
//! order is that of the skeleton.

mod cmu;
mod common;
mod hips;
mod kaykit;
mod mixamo;
mod part;
mod quaternius;
mod rigify;
mod unreal;
mod vrm;

pub use part::{BodyPart, BoneRole};

use crate::data::{Avatar, BoneIndex, Skeleton};
use part::Convention;

/// All conventions. Where two recognize equally many parts of a skeleton, the first is taken.
const CONVENTIONS: [&Convention; 8] = [
    &mixamo::CONVENTION,
    &unreal::CONVENTION,
    &vrm::CONVENTION,
    &rigify::CONVENTION,
    &cmu::CONVENTION,
    &kaykit::CONVENTION,
    &quaternius::CONVENTION,
    &common::CONVENTION,
];

/// The parts of the body of a skeleton.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SkeletonRoles {
    /// The name of the convention; `None` where no convention recognizes hips, or too few limbs.
    pub convention: Option<&'static str>,
    /// For each bone its role, in bone order.
    pub of: Vec<Option<BoneRole>>,
}

/// Fewest parts, chains counted once, that make a figure.
const FEWEST: usize = 6;

impl SkeletonRoles {
    /// Recognizes the parts of a skeleton by the convention that recognizes most. The hips are the bone that carries the legs, too,
    /// whatever it is called.
    pub fn guess(skeleton: &Skeleton) -> Self {
        let names: Vec<String> = skeleton.bones.iter().map(|bone| simplified(&bone.name)).collect();
        let mut best = Self { convention: None, of: vec![None; skeleton.len()] };
        let mut most = FEWEST - 1;
        for convention in CONVENTIONS {
            let roles = roles(convention, &names, skeleton);
            let mut parts: Vec<BoneRole> = roles.iter().flatten().copied().collect();
            parts.sort_unstable();
            parts.dedup();
            let has_hips = parts.iter().any(|role| role.part == BodyPart::Hips);
            if has_hips && parts.len() > most {
                most = parts.len();
                best = Self { convention: Some(convention.name), of: roles };
            }
        }
        hips::carry_legs(&mut best.of, skeleton);
        best
    }

    /// Returns the parts of a skeleton that an avatar names; `None` if they are too few for a figure.
    pub fn of_avatar(skeleton: &Skeleton, avatar: &Avatar) -> Option<Self> {
        let mut names = vec![String::new(); skeleton.len()];
        for human in &avatar.bones {
            if let Some(name) = names.get_mut(human.bone as usize) {
                *name = simplified(&human.name);
            }
        }
        let of = roles(&vrm::CONVENTION, &names, skeleton);
        let found = Self { convention: Some(vrm::CONVENTION.name), of };
        let parts = found.roles();
        let has_hips = parts.iter().any(|role| role.part == BodyPart::Hips);
        (has_hips && parts.len() >= FEWEST).then_some(found)
    }

    /// Returns the bones of a role in the order of the skeleton: of a chain, from the top.
    pub fn bones(&self, role: BoneRole) -> Vec<BoneIndex> {
        let is = |(bone, of): (usize, &Option<BoneRole>)| (*of == Some(role)).then_some(bone as BoneIndex);
        self.of.iter().enumerate().filter_map(is).collect()
    }

    /// Returns all roles that bones have, each once, ascending.
    pub fn roles(&self) -> Vec<BoneRole> {
        let mut roles: Vec<BoneRole> = self.of.iter().flatten().copied().collect();
        roles.sort_unstable();
        roles.dedup();
        roles
    }
}

/// Returns the roles of bones by one convention. A part that is no chain belongs to its first bone; bones of a chain that are not
/// below each other are left out.
fn roles(convention: &Convention, names: &[String], skeleton: &Skeleton) -> Vec<Option<BoneRole>> {
    let mut found: Vec<Option<BoneRole>> = vec![None; names.len()];
    let mut last: Vec<(BoneRole, usize)> = Vec::new();
    for (bone, name) in names.iter().enumerate() {
        let role = convention
            .rows
            .iter()
            .find_map(|(pattern, part)| matched(pattern, name).map(|side| BoneRole { part: *part, side }));
        let Some(role) = role else { continue };
        let before = last.iter_mut().find(|(other, _)| *other == role);
        match before {
            None => last.push((role, bone)),
            Some((_, above)) if is_chain(role.part) && is_below(skeleton, bone, *above) => *above = bone,
            Some(_) => continue,
        }
        found[bone] = Some(role);
    }
    found
}

fn is_chain(part: BodyPart) -> bool {
    match part {
        BodyPart::Spine
        | BodyPart::Neck
        | BodyPart::Thumb
        | BodyPart::Index
        | BodyPart::Middle
        | BodyPart::Ring
        | BodyPart::Little => true,
        BodyPart::Root
        | BodyPart::Hips
        | BodyPart::Head
        | BodyPart::Eye
        | BodyPart::Jaw
        | BodyPart::Shoulder
        | BodyPart::UpperArm
        | BodyPart::LowerArm
        | BodyPart::Hand
        | BodyPart::UpperLeg
        | BodyPart::LowerLeg
        | BodyPart::Foot
        | BodyPart::Toes => false,
    }
}

fn is_below(skeleton: &Skeleton, bone: usize, above: usize) -> bool {
    skeleton.ancestors(bone as BoneIndex).any(|bone| bone as usize == above)
}

/// Returns the name without namespace, capitals and separators.
fn simplified(name: &str) -> String {
    let own = name.rsplit([':', '|']).find(|part| !part.is_empty()).unwrap_or(name);
    own.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Returns the side where a simplified name is that of a row; 0 for a row without a side.
fn matched(pattern: &str, name: &str) -> Option<u8> {
    let sides: &[(u8, &str, &str)] =
        if pattern.contains('{') { &[(1, "left", "l"), (2, "right", "r")] } else { &[(0, "", "")] };
    sides.iter().find_map(|(side, word, letter)| {
        let wanted = pattern.replace("{side}", word).replace("{s}", letter);
        let is = match wanted.split_once('#') {
            None => wanted == name,
            Some((before, after)) => {
                name.strip_prefix(before).and_then(|rest| rest.strip_suffix(after)).is_some_and(|number| {
                    !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit())
                })
            }
        };
        is.then_some(*side)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_match_names_of_both_sides_and_numbers() {
        assert_eq!(matched("{side}hand", &simplified("mixamorig:LeftHand")), Some(1));
        assert_eq!(matched("upperarm{s}", &simplified("upperarm_r")), Some(2));
        assert_eq!(matched("spine#", &simplified("spine_01")), Some(0));
        assert_eq!(matched("spine#", &simplified("Spine")), None);
        assert_eq!(matched("hips", &simplified("Armature|Hips")), Some(0));
    }

    #[test]
    fn every_row_is_simplified_and_occurs_once_in_its_table() {
        for convention in CONVENTIONS {
            for (at, (row, _)) in convention.rows.iter().enumerate() {
                let plain = row.replace("{side}", "left").replace("{s}", "l").replace('#', "1");
                assert_eq!(simplified(&plain), plain, "{}: {row}", convention.name);
                assert!(!convention.rows[..at].iter().any(|(other, _)| other == row), "{row}");
            }
        }
    }
}
