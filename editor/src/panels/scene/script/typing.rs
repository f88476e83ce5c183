//! Typing as steps of the history: a word is one step.

use dragonfly_anim::stage::splice::TextSplice;
use dragonfly_document::history::Gesture;

/// Pause after which typing continues as a new step, seconds.
const PAUSE: f64 = 1.0;

/// The way in which a text came into the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WrittenText {
    /// Letter by letter; several of them may come in one frame.
    Typed,
    /// From the clipboard.
    Pasted,
    /// From the list of suggestions.
    Suggested,
}

/// The word that is being typed.
#[derive(Debug, Default)]
pub(super) struct TypedWord {
    word: Option<OpenWord>,
}

#[derive(Clone, Copy, Debug)]
struct OpenWord {
    gesture: Gesture,
    /// Byte after the last change.
    at: usize,
    /// Whether letters are being deleted.
    deletes: bool,
    /// Whether the last letter ends a word.
    is_over: bool,
    /// Whether it was typed, so that more letters belong to it.
    is_typed: bool,
    /// Time of the last change, seconds.
    time: f64,
}

impl TypedWord {
    /// Returns the gesture of a change: that of the word before where it continues it, otherwise the one that `new` returns. The second
    /// value is the gesture that is over.
    pub(super) fn gesture(
        &mut self,
        splice: &TextSplice,
        written: WrittenText,
        time: f64,
        new: impl FnOnce() -> Gesture,
    ) -> (Gesture, Option<Gesture>) {
        let deletes = splice.text.is_empty();
        let is_typed = written == WrittenText::Typed;
        let ends_word = |letter: Option<char>| letter.is_some_and(|letter| !is_of_word(letter));
        let continues = self.word.is_some_and(|word| {
            let follows =
                if deletes { splice.range.end == word.at } else { splice.range == (word.at..word.at) };
            let is_one_less = splice.range.len() <= 4;
            is_typed
                && word.is_typed
                && word.deletes == deletes
                && follows
                && is_one_less
                && time - word.time < PAUSE
                && (!word.is_over || ends_word(splice.text.chars().next()))
        });
        let (gesture, over) = match self.word.filter(|_| continues) {
            Some(word) => (word.gesture, None),
            None => (new(), self.word.map(|word| word.gesture)),
        };
        let at = splice.range.start + splice.text.len();
        let is_over = ends_word(splice.text.chars().next_back());
        self.word = Some(OpenWord { gesture, at, deletes, is_over, is_typed, time });
        (gesture, over)
    }

    /// Returns the gesture that is over after a pause.
    pub(super) fn after_pause(&mut self, time: f64) -> Option<Gesture> {
        self.word.take_if(|word| time - word.time >= PAUSE).map(|word| word.gesture)
    }

    /// Returns the seconds until the word is over; `None` where nothing is being typed.
    pub(super) fn rest(&self, time: f64) -> Option<f64> {
        self.word.map(|word| (word.time + PAUSE - time).max(0.0))
    }

    /// Ends the word. Returns its gesture.
    pub(super) fn end(&mut self) -> Option<Gesture> {
        self.word.take().map(|word| word.gesture)
    }
}

/// Returns whether a letter is part of a word.
fn is_of_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// Returns the parts of a text that are steps of their own: each word with what is between it and the next one.
pub(super) fn words(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let mut is_in_word = true;
        let end = rest.char_indices().find_map(|(at, letter)| {
            let was_in_word = std::mem::replace(&mut is_in_word, is_of_word(letter));
            (is_in_word && !was_in_word).then_some(at)
        });
        let (word, next) = rest.split_at(end.unwrap_or(rest.len()));
        rest = next;
        (!word.is_empty()).then_some(word)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// Types letters at the end of a text, a tenth of a second apart, and returns the gesture of each.
    fn typed(letters: &str) -> Vec<u64> {
        let (mut word, next) = (TypedWord::default(), Cell::new(0));
        let new = || {
            next.set(next.get() + 1);
            Gesture(next.get())
        };
        letters
            .char_indices()
            .map(|(at, letter)| {
                let splice = TextSplice { range: at..at, text: letter.to_string() };
                word.gesture(&splice, WrittenText::Typed, at as f64 / 10.0, new).0.0
            })
            .collect()
    }

    #[test]
    fn each_word_with_the_blanks_after_it_is_a_step() {
        assert_eq!(typed("ab  cd=\"x"), [1, 1, 1, 1, 2, 2, 2, 2, 3]);
    }

    #[test]
    fn letters_that_come_together_are_the_same_steps_as_one_after_the_other() {
        let text = "ab  cd=\"x é";
        for frame in 1..=text.chars().count() {
            let (mut word, next) = (TypedWord::default(), Cell::new(0));
            let new = || {
                next.set(next.get() + 1);
                Gesture(next.get())
            };
            let (mut steps, mut at) = (Vec::new(), 0);
            let letters: Vec<char> = text.chars().collect();
            for (number, together) in letters.chunks(frame).enumerate() {
                let together: String = together.iter().collect();
                for part in words(&together) {
                    let splice = TextSplice { range: at..at, text: part.to_owned() };
                    let (gesture, _) = word.gesture(&splice, WrittenText::Typed, number as f64 / 10.0, new);
                    steps.extend(part.chars().map(|_| gesture.0));
                    at += part.len();
                }
            }
            assert_eq!(steps, typed(text), "{frame} letters in a frame");
        }
    }

    #[test]
    fn what_is_pasted_or_suggested_is_a_step_of_its_own() {
        for written in [WrittenText::Pasted, WrittenText::Suggested] {
            let mut word = TypedWord::default();
            let splice = |at: usize| TextSplice { range: at..at, text: "a".to_owned() };
            let typed = WrittenText::Typed;
            assert_eq!(word.gesture(&splice(5), typed, 0.0, || Gesture(1)), (Gesture(1), None));
            assert_eq!(word.gesture(&splice(6), written, 0.1, || Gesture(2)), (Gesture(2), Some(Gesture(1))));
            assert_eq!(word.gesture(&splice(7), typed, 0.2, || Gesture(3)), (Gesture(3), Some(Gesture(2))));
        }
    }

    #[test]
    fn a_pause_and_another_place_begin_a_step() {
        let mut word = TypedWord::default();
        let splice = |at: usize| TextSplice { range: at..at, text: "a".to_owned() };
        let mut typed = |at: usize, time: f64, new: u64| {
            word.gesture(&splice(at), WrittenText::Typed, time, || Gesture(new))
        };
        assert_eq!(typed(5, 0.0, 1), (Gesture(1), None));
        assert_eq!(typed(6, 0.5, 2), (Gesture(1), None));
        assert_eq!(typed(9, 0.6, 2), (Gesture(2), Some(Gesture(1))));
        assert_eq!(word.after_pause(1.5), None);
        assert_eq!(word.after_pause(1.7), Some(Gesture(2)));
        assert_eq!(word.end(), None);
    }

    #[test]
    fn letters_deleted_one_by_one_are_a_step_of_their_own() {
        let mut word = TypedWord::default();
        let typed = TextSplice { range: 5..5, text: "a".to_owned() };
        let deleted = |at: usize| TextSplice { range: at..at + 1, text: String::new() };
        let mut next = |splice: &TextSplice, time: f64, new: u64| {
            word.gesture(splice, WrittenText::Typed, time, || Gesture(new))
        };
        assert_eq!(next(&typed, 0.0, 1).0, Gesture(1));
        assert_eq!(next(&deleted(5), 0.1, 2), (Gesture(2), Some(Gesture(1))));
        assert_eq!(next(&deleted(4), 0.2, 3).0, Gesture(2));
        assert_eq!(next(&deleted(9), 0.3, 4).0, Gesture(4));
    }
}
