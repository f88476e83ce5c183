//! Texts of the user interface.

/// Returns a message with a capital first letter: errors start with a small one, so that they can follow a colon.
pub fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_begins_with_a_capital_letter() {
        assert_eq!(sentence("a take keeps at least one key"), "A take keeps at least one key");
        assert_eq!(sentence("élan"), "Élan");
        assert_eq!(sentence("12 keys"), "12 keys");
        assert_eq!(sentence(""), "");
    }
}
