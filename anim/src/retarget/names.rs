//! Normalization of bone names from different programs.

/// Prefixes that a program or a file adds to every name, in lower case and without separators.
const PREFIXES: [&str; 4] = ["mixamorig", "bip", "def", "b"];

/// Words for sides, and their normal form.
const SIDES: [(&str, &str); 4] = [("left", "l"), ("l", "l"), ("right", "r"), ("r", "r")];

/// Returns `name` without the differences between programs, for comparison only.
///
/// The namespace, everything up to the last `:` or `|`, is removed; the rest is split into words at separators (space,
/// `.`, `_`, `-`), between a small and a capital letter, and between letters and digits; words are in lower case,
/// numbers without leading zeros; a first word that is a program's prefix (`mixamorig`, `Bip01`, `DEF`, `b`) is removed
/// unless it is the only one; a side (`L`, `Left`, `l_`, `_R` …) is moved to the end.
///
/// ```
/// use dragonfly_anim::retarget::normalized_name;
/// assert_eq!(normalized_name("mixamorig:LeftUpLeg"), "upleg.l");
/// assert_eq!(normalized_name("UpLeg_L"), "upleg.l");
/// assert_eq!(normalized_name("Spine_01"), normalized_name("spine1"));
/// ```
pub fn normalized_name(name: &str) -> String {
    let own = name.rsplit([':', '|']).find(|part| !part.is_empty()).unwrap_or(name);
    let mut words = words(own);
    strip_prefix(&mut words);
    let side = (words.len() > 1).then(|| take_side(&mut words)).flatten();
    let mut joined = words.concat();
    if let Some(side) = side {
        joined.push('.');
        joined.push_str(side);
    }
    joined
}

/// Class of a character for splitting.
#[derive(Clone, Copy, PartialEq)]
enum CharClass {
    Capital,
    Small,
    Digit,
    Separator,
}

fn char_class(letter: char) -> CharClass {
    if letter.is_numeric() {
        CharClass::Digit
    } else if letter.is_uppercase() {
        CharClass::Capital
    } else if letter.is_alphabetic() {
        CharClass::Small
    } else {
        CharClass::Separator
    }
}

/// Returns the lower-case words and numbers.
fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut last = CharClass::Separator;
    for letter in name.chars() {
        let now = char_class(letter);
        if now != CharClass::Separator {
            let goes_on = last == now || (last == CharClass::Capital && now == CharClass::Small);
            if !goes_on {
                words.push(String::new());
            }
            if let Some(word) = words.last_mut() {
                word.extend(letter.to_lowercase());
            }
        }
        last = now;
    }
    for word in &mut words {
        let number = word.trim_start_matches('0');
        if number.len() < word.len() && word.chars().all(char::is_numeric) {
            *word = if number.is_empty() { "0".to_owned() } else { number.to_owned() };
        }
    }
    words
}

/// Removes a program's prefix: one word, or a word and a number (`Bip 01`, `mixamorig1`).
fn strip_prefix(words: &mut Vec<String>) {
    let is = |text: &str| PREFIXES.contains(&text);
    let number = words.get(1).is_some_and(|word| word.chars().all(char::is_numeric));
    let counted = words.first().is_some_and(|first| first == "bip" || first == "mixamorig") && number;
    if counted && words.len() > 2 {
        words.drain(..2);
    } else if words.len() > 1 && !number && words.first().is_some_and(|first| is(first)) {
        words.remove(0);
    }
}

/// Removes and returns the first word that is a side. A single letter counts anywhere, since words are whole.
fn take_side(words: &mut Vec<String>) -> Option<&'static str> {
    let side = |word: &str| SIDES.iter().find(|(spelled, _)| *spelled == word).map(|(_, side)| *side);
    let found = words.iter().enumerate().find_map(|(index, word)| Some((index, side(word)?)));
    let (index, side) = found?;
    words.remove(index);
    Some(side)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_spellings_of_a_bone_name_have_the_same_normalized_name() {
        let same: [&[&str]; 6] = [
            &["mixamorig:LeftArm", "Arm.L", "arm_l", "L_Arm", "Left Arm", "DEF-arm.L", "mixamorig1:LeftArm"],
            &["mixamorig:Hips", "hips", "HIPS", "Armature|Hips", "b_Hips", "mixamorig_Hips"],
            &["Bip01 L Thigh", "thigh.L", "Bip001 L Thigh", "ThighLeft", "LeftThigh"],
            &["Spine1", "spine_01", "Spine.001", "SPINE 1"],
            &["RightHandIndex2", "HandIndex2.R", "hand_index_02_r"],
            &["Bip01", "bip 1"],
        ];
        for names in same {
            for name in names {
                assert_eq!(normalized_name(name), normalized_name(names[0]), "{name}");
            }
        }
        let all: Vec<String> = same.iter().map(|names| normalized_name(names[0])).collect();
        for (index, name) in all.iter().enumerate() {
            assert!(!all[..index].contains(name), "{name}");
        }
    }

    #[test]
    fn a_name_that_is_only_a_prefix_or_a_side_is_kept_and_different_bones_keep_different_names() {
        assert_eq!(normalized_name("L"), "l");
        assert_eq!(normalized_name("b"), "b");
        assert_eq!(normalized_name(""), "");
        assert_eq!(normalized_name(":::"), "");
        assert_eq!(normalized_name("Bone_00"), "bone0");
        assert_ne!(normalized_name("Spine"), normalized_name("Spine1"));
        assert_ne!(normalized_name("Leg.L"), normalized_name("Leg.R"));
        assert_eq!(normalized_name("Ärmel_L"), "ärmel.l");
    }
}
