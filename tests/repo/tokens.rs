//! Words and signs of a Rust source file, without comments, text in quotes, and code that exists only in tests.

/// Returns the names, numbers and signs of a source file in order; `::` is one sign, any other sign is one character.
pub(crate) fn tokens(source: &str) -> Vec<String> {
    let characters: Vec<char> = source.chars().collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < characters.len() {
        let rest = &characters[at..];
        match rest {
            ['/', '/', ..] => at += until(rest, |rest| rest[0] == '\n'),
            ['/', '*', ..] => at += block_comment(rest),
            ['"', ..] => at += quoted(rest),
            ['r' | 'b' | 'c', '"' | '#' | 'r', ..] if raw_text(rest).is_some() => {
                at += raw_text(rest).unwrap_or(1);
            }
            ['\'', '\\', ..] => at += 4 + until(&rest[3..], |rest| rest[0] == '\''),
            ['\'', _, '\'', ..] => at += 3,
            [':', ':', ..] => {
                found.push("::".to_owned());
                at += 2;
            }
            [first, ..] if first.is_alphanumeric() || *first == '_' => {
                let length = until(rest, |rest| !(rest[0].is_alphanumeric() || rest[0] == '_'));
                found.push(rest[..length].iter().collect());
                at += length;
            }
            [first, ..] => {
                if !first.is_whitespace() {
                    found.push(first.to_string());
                }
                at += 1;
            }
            [] => break,
        }
    }
    without_tests(&found)
}

/// Returns how many characters precede the first position that meets a condition.
fn until(characters: &[char], condition: impl Fn(&[char]) -> bool) -> usize {
    (0..characters.len()).find(|at| condition(&characters[*at..])).unwrap_or(characters.len())
}

fn block_comment(rest: &[char]) -> usize {
    let mut depth = 0_usize;
    let mut at = 0;
    while at < rest.len() {
        match &rest[at..] {
            ['/', '*', ..] => {
                depth += 1;
                at += 2;
            }
            ['*', '/', ..] => {
                depth -= 1;
                at += 2;
            }
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

/// Returns the length of a text in quotes that may contain escaped characters.
fn quoted(rest: &[char]) -> usize {
    let mut at = 1;
    while at < rest.len() && rest[at] != '"' {
        at += if rest[at] == '\\' { 2 } else { 1 };
    }
    at + 1
}

/// Returns the length of `r#"..."#`, `b"..."` and the like; `None` for an ordinary name.
fn raw_text(rest: &[char]) -> Option<usize> {
    let letters = until(rest, |rest| !matches!(rest[0], 'r' | 'b' | 'c'));
    let raw = rest[..letters].contains(&'r');
    let signs = until(&rest[letters..], |rest| rest[0] != '#');
    let start = letters + signs;
    if letters > 2 || rest.get(start) != Some(&'"') || (signs > 0 && !raw) {
        return None;
    }
    if !raw {
        return Some(letters + quoted(&rest[letters..]));
    }
    let ends = |rest: &[char]| {
        rest[0] == '"' && rest[1..].iter().take(signs).filter(|c| **c == '#').count() == signs
    };
    Some(start + 1 + until(&rest[start + 1..], ends) + 1 + signs)
}

/// Returns the position after the bracket that closes the one at `open`.
pub(crate) fn after_group(tokens: &[String], open: usize) -> usize {
    let mut depth = 0_usize;
    for (at, token) in tokens.iter().enumerate().skip(open) {
        match token.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return at + 1;
        }
    }
    tokens.len()
}

/// Leaves out every item with the attribute `#[cfg(test)]`.
fn without_tests(tokens: &[String]) -> Vec<String> {
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let attribute = ["#", "[", "cfg", "(", "test", ")", "]"];
        if tokens[at..].iter().map(String::as_str).take(attribute.len()).eq(attribute) {
            at += attribute.len();
            // Further attributes of the same item.
            while tokens.get(at).is_some_and(|token| token == "#") {
                at = after_group(tokens, at + 1);
            }
            while at < tokens.len() && tokens[at] != ";" {
                let group = matches!(tokens[at].as_str(), "{" | "(" | "[");
                let block = tokens[at] == "{";
                at = if group { after_group(tokens, at) } else { at + 1 };
                if block {
                    break;
                }
            }
            if tokens.get(at).is_some_and(|token| token == ";") {
                at += 1;
            }
        } else {
            kept.push(tokens[at].clone());
            at += 1;
        }
    }
    kept
}

#[test]
fn tokens_leave_out_comments_string_literals_and_test_code() {
    let source = r###"
        // one
        /* two /* three */ */
        use a::b; let text = "c \" d"; let raw = r#"e " f"#; let bytes = b"g"; let sign = '"'; let line = '\n';
        fn keep<'life>(r: &'life str) {}
        #[cfg(test)]
        #[allow(lint)]
        mod tests { use h; }
        #[cfg(test)]
        use i;
        fn last() {}
    "###;
    let found = tokens(source).join(" ");
    assert_eq!(
        found,
        "use a :: b ; let text = ; let raw = ; let bytes = ; let sign = ; let line = ; \
         fn keep < ' life > ( r : & ' life str ) { } fn last ( ) { }"
    );
}
