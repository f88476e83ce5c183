//! The words of an option that has the arguments of another program. No shell reads them.

/// Splits a text into words at blanks. Blanks between single or double quotes are part of a word; there are no other signs with a meaning.
pub(super) fn words(text: &str) -> Result<Vec<String>, String> {
    let mut words = Vec::new();
    let (mut word, mut quote): (Option<String>, Option<char>) = (None, None);
    for sign in text.chars() {
        match quote {
            Some(open) if sign == open => quote = None,
            Some(_) => word.get_or_insert_default().push(sign),
            None if sign == '"' || sign == '\'' => {
                quote = Some(sign);
                word.get_or_insert_default();
            }
            None if sign.is_whitespace() => words.extend(word.take()),
            None => word.get_or_insert_default().push(sign),
        }
    }
    if let Some(open) = quote {
        return Err(format!("a quote {open} has no end"));
    }
    words.extend(word);
    Ok(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blanks_separate_words_unless_they_are_between_quotes() {
        let found = |text| words(text).expect("words");
        assert_eq!(
            found("-c:v  libx264 -vf 'scale=2 * iw, crop' "),
            ["-c:v", "libx264", "-vf", "scale=2 * iw, crop"]
        );
        assert_eq!(found(r#"a"b c"d '' $HOME `x` \n"#), ["ab cd", "", "$HOME", "`x`", "\\n"]);
        assert_eq!(found(" \t"), [""; 0]);
        assert!(words("a 'b").is_err());
    }
}
