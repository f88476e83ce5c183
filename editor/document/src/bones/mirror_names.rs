//! Words for left and right in names of bones.

use super::mirror_pair::BodySide;
use std::ops::Range;

/// Words for left and right in lower case, as programs and users write them.
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

/// Number of pairs in `WORDS` that may also be part of another word, at its start or end: `leftarm`, `footr`.
const GLUED: usize = 2;

/// Maximum length of a name in bytes, and maximum number of side words in it.
const LONGEST: usize = 256;
const MOST: usize = 6;

/// A word for a side in a name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SideWord {
    pub(super) range: Range<usize>,
    pub(super) side: BodySide,
    /// Index in [`WORDS`] and case: lower case, first letter, upper case.
    pub(super) spelling: (usize, u8),
}

/// Returns the separate words for sides in `name`, in their order.
pub(super) fn side_words(name: &str) -> Vec<SideWord> {
    if name.len() > LONGEST {
        return Vec::new();
    }
    words(name).into_iter().filter_map(|range| side_word(name, range)).take(MOST).collect()
}

/// Returns the words for sides that are part of another word.
pub(super) fn glued_side_words(name: &str) -> Vec<SideWord> {
    if name.len() > LONGEST {
        return Vec::new();
    }
    let mut found = Vec::new();
    for word in words(name) {
        let text = &name[word.clone()];
        for spelled in WORDS[..GLUED].iter().flat_map(|pair| [pair.0, pair.1]) {
            // These words consist of ASCII letters, so only ASCII is compared.
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
        let is = |spelled: &str, side: BodySide| (lower == spelled).then_some((index, side));
        is(pair.0, BodySide::Left).or_else(|| is(pair.1, BodySide::Right))
    })?;
    let mut letters = text.chars();
    let begins = letters.next().is_some_and(char::is_uppercase);
    let case = match (begins, letters.next().map(char::is_uppercase)) {
        (false, _) => 0,
        (true, Some(false)) => 1,
        // A single capital letter counts as upper case.
        (true, _) => 2,
    };
    Some(SideWord { range, side, spelling: (index, case) })
}

#[derive(Clone, Copy, PartialEq)]
enum LetterKind {
    Capital,
    Small,
    Digit,
    /// A character that is a word by itself.
    Word,
    Separator,
}

fn kind(letter: char) -> LetterKind {
    match letter {
        '左' | '右' => LetterKind::Word,
        _ if letter.is_numeric() => LetterKind::Digit,
        _ if letter.is_uppercase() => LetterKind::Capital,
        _ if letter.is_alphabetic() => LetterKind::Small,
        _ => LetterKind::Separator,
    }
}

/// Returns the words of a name: between separators, at capitals (`LeftArm`, `LArm`), between letters and digits.
pub(super) fn words(name: &str) -> Vec<Range<usize>> {
    let letters: Vec<(usize, LetterKind)> =
        name.char_indices().map(|(at, letter)| (at, kind(letter))).collect();
    let mut words: Vec<Range<usize>> = Vec::new();
    for (index, &(at, now)) in letters.iter().enumerate() {
        let last = if index == 0 { LetterKind::Separator } else { letters[index - 1].1 };
        let next = letters.get(index + 1);
        let end = next.map_or(name.len(), |next| next.0);
        // `LArm`: the second capital starts the word.
        let begins_next = now == LetterKind::Capital && next.is_some_and(|next| next.1 == LetterKind::Small);
        let goes_on = match (last, now) {
            (LetterKind::Capital, LetterKind::Small) => true,
            (LetterKind::Capital, LetterKind::Capital) => !begins_next,
            (LetterKind::Word, LetterKind::Word) => false,
            (last, now) => last == now,
        };
        match words.last_mut() {
            _ if now == LetterKind::Separator => {}
            Some(word) if goes_on && word.end == at => word.end = end,
            _ => words.push(at..end),
        }
    }
    words
}
