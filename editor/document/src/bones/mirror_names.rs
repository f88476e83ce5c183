//! Words for sides in names.

use super::mirror::Side;
use std::ops::Range;

/// Left and right, as programs and people write them, in lower case.
const WORDS: &[(&str, &str)] = &[
    ("left", "right"),
    ("l", "r"),
    ("lft", "rgt"),
    ("lt", "rt"),
    ("左", "右"),
    ("ひだり", "みぎ"),
    ("links", "rechts"),
    ("gauche", "droite"),
    ("izquierda", "derecha"),
];

/// Words that stand at the beginning or end of another without anything between them: `leftarm`, `footr`.
const GLUED: usize = 2;

/// Longest name that is looked at, bytes, and most words for sides in it.
const LONGEST: usize = 256;
const MOST: usize = 6;

/// A word for a side in a name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SideWord {
    pub(super) range: Range<usize>,
    pub(super) side: Side,
    /// Which pair of [`WORDS`], and how it is written: small, capital, capitals.
    pub(super) spelling: (usize, u8),
}

/// The words for sides in `name`, that stand alone, in their order.
pub(super) fn side_words(name: &str) -> Vec<SideWord> {
    if name.len() > LONGEST {
        return Vec::new();
    }
    words(name).into_iter().filter_map(|range| side_word(name, range)).take(MOST).collect()
}

/// The ones that are glued to another word.
pub(super) fn glued_side_words(name: &str) -> Vec<SideWord> {
    if name.len() > LONGEST {
        return Vec::new();
    }
    let mut found = Vec::new();
    for word in words(name) {
        let text = &name[word.clone()];
        for spelled in WORDS[..GLUED].iter().flat_map(|pair| [pair.0, pair.1]) {
            // Words for sides are of ASCII letters, and so is what is compared with them.
            let (long, short) = (text.len(), spelled.len());
            if long > short && text.is_ascii() {
                let ends = [word.start..word.start + short, word.end - short..word.end];
                let ends = ends.into_iter().filter(|end| name[end.clone()].eq_ignore_ascii_case(spelled));
                found.extend(ends.filter_map(|end| side_word(name, end)));
            }
        }
    }
    found.truncate(MOST);
    found
}

fn side_word(name: &str, range: Range<usize>) -> Option<SideWord> {
    let text = &name[range.clone()];
    let lower = text.to_lowercase();
    let (index, side) = WORDS.iter().enumerate().find_map(|(index, pair)| {
        let is = |spelled: &str, side: Side| (lower == spelled).then_some((index, side));
        is(pair.0, Side::Left).or_else(|| is(pair.1, Side::Right))
    })?;
    let mut letters = text.chars();
    let begins = letters.next().is_some_and(char::is_uppercase);
    let case = match (begins, letters.next().map(char::is_uppercase)) {
        (false, _) => 0,
        (true, Some(false)) => 1,
        // A single capital letter is as good as a word of capitals.
        (true, _) => 2,
    };
    Some(SideWord { range, side, spelling: (index, case) })
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Capital,
    Small,
    Digit,
    /// A letter that is a word by itself.
    Word,
    Separator,
}

fn kind(letter: char) -> Kind {
    match letter {
        '左' | '右' => Kind::Word,
        _ if letter.is_numeric() => Kind::Digit,
        _ if letter.is_uppercase() => Kind::Capital,
        _ if letter.is_alphabetic() => Kind::Small,
        _ => Kind::Separator,
    }
}

/// The words of a name: between separators, at capitals (`LeftArm`, `LArm`), between letters and digits.
pub(super) fn words(name: &str) -> Vec<Range<usize>> {
    let letters: Vec<(usize, Kind)> = name.char_indices().map(|(at, letter)| (at, kind(letter))).collect();
    let mut words: Vec<Range<usize>> = Vec::new();
    for (index, &(at, now)) in letters.iter().enumerate() {
        let last = if index == 0 { Kind::Separator } else { letters[index - 1].1 };
        let next = letters.get(index + 1);
        let end = next.map_or(name.len(), |next| next.0);
        // `LArm`: the second capital begins the word.
        let begins_next = now == Kind::Capital && next.is_some_and(|next| next.1 == Kind::Small);
        let goes_on = match (last, now) {
            (Kind::Capital, Kind::Small) => true,
            (Kind::Capital, Kind::Capital) => !begins_next,
            (Kind::Word, Kind::Word) => false,
            (last, now) => last == now,
        };
        match words.last_mut() {
            _ if now == Kind::Separator => {}
            Some(word) if goes_on && word.end == at => word.end = end,
            _ => words.push(at..end),
        }
    }
    words
}
