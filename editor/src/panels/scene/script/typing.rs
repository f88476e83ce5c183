//! Typing as steps of the history: a word is one step.

use dragonfly_anim::stage::splice::TextSplice;
use dragonfly_document::history::Gesture;

/// Pause after which typing continues as a new step, seconds.
const PAUSE: f64 = 1.0;

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
    /// Time of the last change, seconds.
    time: f64,
}

impl TypedWord {
    /// Returns the gesture of a change: that of the word before where it continues it, otherwise the one that `new` returns. The second
    /// value is the gesture that is over.
    pub(super) fn gesture(
        &mut self,
        splice: &TextSplice,
        time: f64,
        new: impl FnOnce() -> Gesture,
    ) -> (Gesture, Option<Gesture>) {
        let deletes = splice.text.is_empty();
        let continues = self.word.is_some_and(|word| {
            let follows =
                if deletes { splice.range.end == word.at } else { splice.range == (word.at..word.at) };
            let is_one = splice.text.chars().count() <= 1 && splice.range.len() <= 4;
            word.deletes == deletes
                && follows
                && is_one
                && time - word.time < PAUSE
                && (!word.is_over || ends_word(&splice.text))
        });
        let (gesture, over) = match self.word.filter(|_| continues) {
            Some(word) => (word.gesture, None),
            None => (new(), self.word.map(|word| word.gesture)),
        };
        let at = splice.range.start + splice.text.len();
        self.word = Some(OpenWord { gesture, at, deletes, is_over: ends_word(&splice.text), time });
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

/// Returns whether a text is not part of a word.
fn ends_word(text: &str) -> bool {
    text.chars().any(|letter| !letter.is_alphanumeric() && letter != '_')
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
                word.gesture(&splice, at as f64 / 10.0, new).0.0
            })
            .collect()
    }

    #[test]
    fn each_word_with_the_blanks_after_it_is_a_step() {
        assert_eq!(typed("ab  cd=\"x"), [1, 1, 1, 1, 2, 2, 2, 2, 3]);
    }

    #[test]
    fn a_pause_and_another_place_begin_a_step() {
        let mut word = TypedWord::default();
        let splice = |at: usize| TextSplice { range: at..at, text: "a".to_owned() };
        assert_eq!(word.gesture(&splice(5), 0.0, || Gesture(1)), (Gesture(1), None));
        assert_eq!(word.gesture(&splice(6), 0.5, || Gesture(2)), (Gesture(1), None));
        assert_eq!(word.gesture(&splice(9), 0.6, || Gesture(2)), (Gesture(2), Some(Gesture(1))));
        assert_eq!(word.after_pause(1.5), None);
        assert_eq!(word.after_pause(1.7), Some(Gesture(2)));
        assert_eq!(word.end(), None);
    }

    #[test]
    fn letters_deleted_one_by_one_are_a_step_of_their_own() {
        let mut word = TypedWord::default();
        let typed = TextSplice { range: 5..5, text: "a".to_owned() };
        let deleted = |at: usize| TextSplice { range: at..at + 1, text: String::new() };
        assert_eq!(word.gesture(&typed, 0.0, || Gesture(1)).0, Gesture(1));
        assert_eq!(word.gesture(&deleted(5), 0.1, || Gesture(2)), (Gesture(2), Some(Gesture(1))));
        assert_eq!(word.gesture(&deleted(4), 0.2, || Gesture(3)).0, Gesture(2));
        assert_eq!(word.gesture(&deleted(9), 0.3, || Gesture(4)).0, Gesture(4));
    }
}
