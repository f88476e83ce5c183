//! Mirror pairs: left and right bones, guessed from names.
//!
//! Each guess is a pair with its reason. Guesses are made in this order, and a paired bone stays paired: the same name with one word for a side exchanged (`Arm.L`, `mixamorig:LeftArm`, `Bip01 L Arm`, `左腕`); the same
//! but for capitals; the same words in another spelling (`LeftArm` and `arm_r`); the same but for a number that ends the name,
//! as some exporters count all bones (`b_LeftArm_09` and `b_RightArm_06`); a side glued to another word (`leftarm`,
//! `rfoot`). A name that belongs to several bones pairs the first with the first, where there are as many on either side.
//!
//! Names can be wrong: some models count the bones of one arm from the shoulder and those of the other from the hand. So the
//! positions of bones decide: a pair that is clearly not symmetric is split if other bones are its mirror images.

use super::mirror_names::{SideWord, glued_side_words, side_words};
use super::mirror_pair::{BodySide, MirrorGuess, MirrorPair};
use super::mirror_place::Stance;
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_anim::retarget::normalized_name;
use std::collections::HashMap;

/// Maximum number of pairs of bones whose positions are compared.
const MOST_COMPARED: usize = 1 << 20;

/// A bone without a mirror bone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unpaired {
    /// The bone.
    pub bone: BoneIndex,
    /// `None` for a bone on the mirror plane, which is its own mirror bone; the side of its name where its mirror bone is missing.
    pub side: Option<BodySide>,
}

/// All mirror pairs of a skeleton.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MirrorPairs {
    /// The pairs, in the order of their left bones.
    pub pairs: Vec<MirrorPair>,
    /// All other bones, in the order of the skeleton.
    pub unpaired: Vec<Unpaired>,
    partners: Vec<Option<BoneIndex>>,
    middle: Vec<bool>,
}

impl MirrorPairs {
    /// Guesses the pairs of a skeleton.
    pub fn of(skeleton: &Skeleton) -> Self {
        let names: Vec<&str> = skeleton.bones.iter().map(|bone| bone.name.as_str()).collect();
        let mut found = Self::of_names(&names);
        if !found.pairs.is_empty() {
            let stance = Stance::of(skeleton, &found.pairs);
            if stance.is_sure(found.pairs.len()) {
                found.split_asymmetric(&stance);
            }
        }
        found
    }

    /// Guesses the pairs of bones with these names. Takes time in proportion to their number.
    pub fn of_names(names: &[&str]) -> Self {
        let mut pairs = Vec::new();
        let mut partners = vec![None; names.len()];
        let words: Vec<Vec<SideWord>> = names.iter().map(|name| side_words(name)).collect();
        for guess in MirrorGuess::NAMES {
            let key = |bone: usize| keys(names[bone], &words[bone], guess);
            pair_up(names.len(), guess, key, &mut partners, &mut pairs);
        }
        pairs.sort_unstable_by_key(|pair: &MirrorPair| pair.left);
        let side = |bone: usize| words[bone].first().map(|word| word.side);
        let alone = |bone: &usize| partners[*bone].is_none();
        let unpaired = (0..names.len())
            .filter(alone)
            .map(|bone| Unpaired { bone: bone as BoneIndex, side: side(bone) })
            .collect();
        let middle = (0..names.len()).map(|bone| alone(&bone) && side(bone).is_none()).collect();
        Self { pairs, unpaired, partners, middle }
    }

    /// Splits pairs that are not symmetric, and pairs their bones with those that are their mirror images.
    fn split_asymmetric(&mut self, stance: &Stance) {
        let wrong: Vec<MirrorPair> =
            self.pairs.iter().filter(|pair| stance.contradicts(pair.left, pair.right)).copied().collect();
        let alone = |side: BodySide| {
            let of_side = self.unpaired.iter().filter(move |alone| alone.side == Some(side));
            of_side.map(|alone| alone.bone)
        };
        let mut lefts: Vec<BoneIndex> =
            wrong.iter().map(|pair| pair.left).chain(alone(BodySide::Left)).collect();
        let mut rights: Vec<BoneIndex> =
            wrong.iter().map(|pair| pair.right).chain(alone(BodySide::Right)).collect();
        lefts.sort_unstable();
        rights.sort_unstable();
        let opposite = |&left: &BoneIndex| {
            let right = stance.opposite(left, &rights)?;
            (stance.opposite(right, &lefts) == Some(left)).then_some((left, right))
        };
        // Only a file that is made to be slow has more of them than this; its pairs by name stay.
        if lefts.len().saturating_mul(rights.len()) > MOST_COMPARED {
            return;
        }
        let found: Vec<(BoneIndex, BoneIndex)> = lefts.iter().filter_map(opposite).collect();
        let is_new = |left, right| self.partner(left) != Some(right);
        let found: Vec<_> = found.into_iter().filter(|&(left, right)| is_new(left, right)).collect();
        for (left, right) in found {
            for bone in [left, right] {
                if let Some(old) = self.partner(bone) {
                    self.partners[old as usize] = None;
                    self.partners[bone as usize] = None;
                }
            }
            self.partners[left as usize] = Some(right);
            self.partners[right as usize] = Some(left);
            self.pairs.push(MirrorPair { left, right, guess: MirrorGuess::Place });
        }
        let partners = &self.partners;
        self.pairs.retain(|pair| partners[pair.left as usize] == Some(pair.right));
        self.pairs.sort_unstable_by_key(|pair| pair.left);
        self.unpaired.retain(|alone| partners[alone.bone as usize].is_none());
        // A bone that lost its partner and got no other one is now unpaired, with the side that it had in its pair.
        let sided =
            wrong.iter().flat_map(|pair| [(pair.left, BodySide::Left), (pair.right, BodySide::Right)]);
        let lost = sided.filter(|(bone, _)| partners[*bone as usize].is_none());
        self.unpaired.extend(lost.map(|(bone, side)| Unpaired { bone, side: Some(side) }));
        self.unpaired.sort_unstable_by_key(|alone| alone.bone);
    }

    /// Returns the pairs with corrections: each left and right bone, in the order of the corrections, is a pair instead of what it
    /// was before. A bone that is paired with itself is in the middle. Bones that do not exist are left out.
    pub fn corrected(mut self, corrections: &[[BoneIndex; 2]]) -> Self {
        let exists = |bone: &BoneIndex| (*bone as usize) < self.partners.len();
        let corrections: Vec<[BoneIndex; 2]> =
            corrections.iter().filter(|pair| pair.iter().all(exists)).copied().collect();
        for &[left, right] in &corrections {
            for bone in [left, right] {
                if let Some(old) = self.partner(bone) {
                    self.partners[old as usize] = None;
                }
                self.partners[bone as usize] = None;
                self.middle[bone as usize] = left == right;
            }
            if left != right {
                self.partners[left as usize] = Some(right);
                self.partners[right as usize] = Some(left);
                self.pairs
                    .retain(|pair| ![pair.left, pair.right].iter().any(|bone| [left, right].contains(bone)));
                self.pairs.push(MirrorPair { left, right, guess: MirrorGuess::Chosen });
            }
        }
        if corrections.is_empty() {
            return self;
        }
        let sides: HashMap<BoneIndex, BodySide> = (self.pairs.iter())
            .flat_map(|pair| [(pair.left, BodySide::Left), (pair.right, BodySide::Right)])
            .chain(self.unpaired.iter().filter_map(|alone| Some((alone.bone, alone.side?))))
            .collect();
        let partners = &self.partners;
        self.pairs.retain(|pair| partners[pair.left as usize] == Some(pair.right));
        self.pairs.sort_unstable_by_key(|pair| pair.left);
        let alone = (0..partners.len()).filter(|&bone| partners[bone].is_none());
        self.unpaired = alone
            .map(|bone| Unpaired {
                bone: bone as BoneIndex,
                side: sides.get(&(bone as BoneIndex)).copied().filter(|_| !self.middle[bone]),
            })
            .collect();
        self
    }

    /// Returns the other bone of the pair; `None` for an unpaired bone.
    pub fn partner(&self, bone: BoneIndex) -> Option<BoneIndex> {
        self.partners.get(bone as usize).copied().flatten()
    }

    /// Returns the bone that gets the mirrored pose of this one: its partner, or itself on the mirror plane; `None` where the other side is
    /// missing.
    pub fn mirror_of(&self, bone: BoneIndex) -> Option<BoneIndex> {
        let is_middle = self.middle.get(bone as usize) == Some(&true);
        self.partner(bone).or(is_middle.then_some(bone))
    }
}

/// Returns the keys of a name: each is the name without one word for a side, together with that side. Bones with the
/// same key and opposite sides are a pair.
fn keys(name: &str, words: &[SideWord], guess: MirrorGuess) -> Vec<(String, BodySide)> {
    let without = |word: &SideWord, lower: bool| {
        let (before, after) = (&name[..word.range.start], &name[word.range.end..]);
        let (pair, case) = word.spelling;
        if lower {
            format!("{}\u{1}{pair}\u{1}{}", before.to_lowercase(), after.to_lowercase())
        } else {
            format!("{before}\u{1}{pair}{case}\u{1}{after}")
        }
    };
    match guess {
        MirrorGuess::Name => with_all(name, words, |word| without(word, false)),
        MirrorGuess::Capitals => with_all(name, words, |word| without(word, true)),
        MirrorGuess::Words => {
            let normal = |word: &SideWord| {
                let stem = format!("{} {}", &name[..word.range.start], &name[word.range.end..]);
                (normalized_name(&stem), word.side)
            };
            words.iter().map(normal).filter(|(stem, _)| !stem.is_empty()).collect()
        }
        MirrorGuess::Numbers => {
            let counted = uncounted(name);
            let inside = |word: &&SideWord| word.range.end <= counted.len();
            let words = words.iter().filter(inside);
            let keys = words.map(|word| (without(word, true), word));
            // Removes the number and everything after it from the key.
            let cut = |(key, word): (String, &SideWord)| {
                let rest = name[counted.len()..].to_lowercase();
                (key.strip_suffix(&rest).unwrap_or(&key).to_owned(), word.side)
            };
            keys.map(cut).collect()
        }
        MirrorGuess::Place | MirrorGuess::Chosen => Vec::new(),
        MirrorGuess::Glued => {
            let glued = glued_side_words(name);
            words.iter().chain(&glued).map(|word| (without(word, true), word.side)).collect()
        }
    }
}

/// Returns the name without a number at its end that a separator precedes.
fn uncounted(name: &str) -> &str {
    let separator = |letter: char| !letter.is_alphanumeric();
    let end = name.trim_end_matches(separator);
    let number = end.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let stem = number.trim_end_matches(separator);
    let is_counted = number.len() < end.len() && stem.len() < number.len() && !stem.is_empty();
    if is_counted { stem } else { name }
}

/// Returns one key per word. Where all words are of one side, the first key is without any of them (`L_eye_L`).
fn with_all(
    name: &str,
    words: &[SideWord],
    without: impl Fn(&SideWord) -> String,
) -> Vec<(String, BodySide)> {
    let mut keys: Vec<(String, BodySide)> = Vec::new();
    if let [first, _, ..] = words
        && words.iter().all(|word| word.side == first.side)
    {
        let (mut key, mut end) = (String::new(), 0);
        for word in words {
            let (pair, case) = word.spelling;
            key.push_str(&name[end..word.range.start]);
            key.push_str(&format!("\u{2}{pair}{case}\u{2}"));
            end = word.range.end;
        }
        key.push_str(&name[end..]);
        keys.push((key, first.side));
    }
    keys.extend(words.iter().map(|word| (without(word), word.side)));
    keys
}

/// Pairs unpaired bones with the same key.
fn pair_up(
    count: usize,
    guess: MirrorGuess,
    keys: impl Fn(usize) -> Vec<(String, BodySide)>,
    partners: &mut [Option<BoneIndex>],
    pairs: &mut Vec<MirrorPair>,
) {
    let mut found: HashMap<String, [Vec<usize>; 2]> = HashMap::new();
    let mut order: Vec<String> = Vec::new();
    for bone in (0..count).filter(|&bone| partners[bone].is_none()) {
        for (key, side) in keys(bone) {
            let both = found.entry(key).or_insert_with_key(|key| {
                order.push(key.clone());
                Default::default()
            });
            if both[side as usize].last() != Some(&bone) {
                both[side as usize].push(bone);
            }
        }
    }
    for key in order {
        let [lefts, rights] = &found[&key];
        if lefts.len() != rights.len() {
            continue;
        }
        for (&left, &right) in lefts.iter().zip(rights) {
            if left != right && partners[left].is_none() && partners[right].is_none() {
                partners[left] = Some(right as BoneIndex);
                partners[right] = Some(left as BoneIndex);
                pairs.push(MirrorPair { left: left as BoneIndex, right: right as BoneIndex, guess });
            }
        }
    }
}
