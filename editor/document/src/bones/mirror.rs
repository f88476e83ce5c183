//! Which bone is the other side of which, guessed from names.
//!
//! Every guess is a pair that can be shown, with how sure it is. Guesses are made in this order, and what is paired is
//! paired: the same name with one word for a side exchanged (`Arm.L`, `mixamorig:LeftArm`, `Bip01 L Arm`, `左腕`); the same
//! but for capitals; the same words written otherwise (`LeftArm` and `arm_r`); the same but for a number that ends the name,
//! as some exporters count all bones (`b_LeftArm_09` and `b_RightArm_06`); a side glued to another word (`leftarm`,
//! `rfoot`). A name that belongs to several bones pairs the first with the first, where there are as many on either side.
//!
//! Names can be wrong: some count the bones of one arm from the shoulder and those of the other from the hand. So where the
//! bones stand has the last word: a pair that plainly does not lie opposite to each other is parted where others do.

use super::mirror_names::{SideWord, glued_side_words, side_words};
use super::mirror_place::Stance;
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_anim::retarget::normalized_name;
use std::collections::HashMap;

/// Most pairs of bones whose places are compared.
const MOST_COMPARED: usize = 1 << 20;

/// Which side a name speaks of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Of the character, as a rule.
    Left,
    /// The other.
    Right,
}

/// What speaks for a pair, the surest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MirrorGuess {
    /// The same name with the side exchanged.
    Name,
    /// The same but for capitals.
    Capitals,
    /// The same words, written otherwise.
    Words,
    /// The same but for a number at the end.
    Numbers,
    /// A side without anything between it and another word.
    Glued,
    /// They lie opposite to each other; the names say otherwise, or nothing but the side.
    Place,
}

impl MirrorGuess {
    /// Those from names, the surest first.
    pub const NAMES: [Self; 5] = [Self::Name, Self::Capitals, Self::Words, Self::Numbers, Self::Glued];

    /// What speaks for the pair, for lists.
    pub fn title(self) -> &'static str {
        match self {
            Self::Name => "same name",
            Self::Capitals => "same but for capitals",
            Self::Words => "same words",
            Self::Numbers => "same but for a number",
            Self::Glued => "same with the side glued on",
            Self::Place => "opposite places",
        }
    }
}

/// Two bones that mirror each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MirrorPair {
    /// The one whose name says left.
    pub left: BoneIndex,
    /// The one whose name says right.
    pub right: BoneIndex,
    /// What speaks for it.
    pub guess: MirrorGuess,
}

/// A bone without partner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unpaired {
    /// Which.
    pub bone: BoneIndex,
    /// `None` for a bone of the middle, which mirrors itself; a side where the name speaks of one and no bone is the other.
    pub side: Option<Side>,
}

/// All guesses for a skeleton.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MirrorPairs {
    /// In the order of their left bones.
    pub pairs: Vec<MirrorPair>,
    /// All others, in the order of the skeleton.
    pub unpaired: Vec<Unpaired>,
    partners: Vec<Option<BoneIndex>>,
    middle: Vec<bool>,
}

impl MirrorPairs {
    /// Guesses for `skeleton`.
    pub fn of(skeleton: &Skeleton) -> Self {
        let names: Vec<&str> = skeleton.bones.iter().map(|bone| bone.name.as_str()).collect();
        let mut found = Self::of_names(&names);
        if !found.pairs.is_empty() {
            let stance = Stance::of(skeleton, &found.pairs);
            if stance.is_sure(found.pairs.len()) {
                found.mend(&stance);
            }
        }
        found
    }

    /// Guesses for bones of these names. Takes time in proportion to their number.
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

    /// Parts pairs that do not lie opposite to each other, where bones of the same sides do.
    fn mend(&mut self, stance: &Stance) {
        let wrong: Vec<MirrorPair> =
            self.pairs.iter().filter(|pair| stance.contradicts(pair.left, pair.right)).copied().collect();
        let alone = |side: Side| {
            let of_side = self.unpaired.iter().filter(move |alone| alone.side == Some(side));
            of_side.map(|alone| alone.bone)
        };
        let mut lefts: Vec<BoneIndex> = wrong.iter().map(|pair| pair.left).chain(alone(Side::Left)).collect();
        let mut rights: Vec<BoneIndex> =
            wrong.iter().map(|pair| pair.right).chain(alone(Side::Right)).collect();
        lefts.sort_unstable();
        rights.sort_unstable();
        let opposite = |&left: &BoneIndex| {
            let right = stance.opposite(left, &rights)?;
            (stance.opposite(right, &lefts) == Some(left)).then_some((left, right))
        };
        // Those are many only in a file made to be slow, and then names are all there is.
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
        // Who lost a partner and found none is alone, and of a side.
        let sided = wrong.iter().flat_map(|pair| [(pair.left, Side::Left), (pair.right, Side::Right)]);
        let lost = sided.filter(|(bone, _)| partners[*bone as usize].is_none());
        self.unpaired.extend(lost.map(|(bone, side)| Unpaired { bone, side: Some(side) }));
        self.unpaired.sort_unstable_by_key(|alone| alone.bone);
    }

    /// The bone that mirrors this one, of a pair.
    pub fn partner(&self, bone: BoneIndex) -> Option<BoneIndex> {
        self.partners.get(bone as usize).copied().flatten()
    }

    /// Where the mirrored pose of this bone belongs: to its partner; a bone of the middle to itself; nowhere for one whose
    /// other side is missing.
    pub fn mirror_of(&self, bone: BoneIndex) -> Option<BoneIndex> {
        let is_middle = self.middle.get(bone as usize) == Some(&true);
        self.partner(bone).or(is_middle.then_some(bone))
    }
}

/// The name without its side, and which that was. Bones with the same key and opposite sides are a pair.
fn keys(name: &str, words: &[SideWord], guess: MirrorGuess) -> Vec<(String, Side)> {
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
            // The key without what follows the name proper.
            let cut = |(key, word): (String, &SideWord)| {
                let rest = name[counted.len()..].to_lowercase();
                (key.strip_suffix(&rest).unwrap_or(&key).to_owned(), word.side)
            };
            keys.map(cut).collect()
        }
        MirrorGuess::Place => Vec::new(),
        MirrorGuess::Glued => {
            let glued = glued_side_words(name);
            words.iter().chain(&glued).map(|word| (without(word, true), word.side)).collect()
        }
    }
}

/// The name without a number at its end that is set off from the rest.
fn uncounted(name: &str) -> &str {
    let separator = |letter: char| !letter.is_alphanumeric();
    let end = name.trim_end_matches(separator);
    let number = end.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let stem = number.trim_end_matches(separator);
    let is_counted = number.len() < end.len() && stem.len() < number.len() && !stem.is_empty();
    if is_counted { stem } else { name }
}

/// One key for each word; and where all speak of one side, first of all one without any of them (`L_eye_L`).
fn with_all(name: &str, words: &[SideWord], without: impl Fn(&SideWord) -> String) -> Vec<(String, Side)> {
    let mut keys: Vec<(String, Side)> = Vec::new();
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

/// Pairs what is not paired yet and has the same key.
fn pair_up(
    count: usize,
    guess: MirrorGuess,
    keys: impl Fn(usize) -> Vec<(String, Side)>,
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
