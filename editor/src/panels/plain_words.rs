//! Descriptions of the tables of scripts as panels show them.

use std::borrow::Cow;

/// Returns a description without the backticks that mark words of scripts in their documentation.
pub(super) fn plain_words(text: &str) -> Cow<'_, str> {
    if text.contains('`') { Cow::Owned(text.replace('`', "")) } else { Cow::Borrowed(text) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_scripts_are_shown_without_backticks() {
        assert_eq!(plain_words("A way for `move`."), "A way for move.");
        assert_eq!(plain_words("A mark."), "A mark.");
    }
}
