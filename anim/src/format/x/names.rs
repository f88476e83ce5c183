//! Names and strings of a file.

/// Returns text of a file: UTF-8, or where it is none, Latin-1.
pub(super) fn decoded(text: &[u8]) -> String {
    match std::str::from_utf8(text) {
        Ok(text) => text.split_whitespace().collect::<Vec<_>>().join(" "),
        Err(_) => text.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// Returns the name of a file in a string, in which some exporters double every backslash.
pub(super) fn file_name(text: &[u8]) -> String {
    decoded(text).replace("\\\\", "\\")
}

/// Returns a name that every program reads: letters, digits and `_`, `-`, `.`, `:`, and no digit first.
pub(super) fn possible(name: &str) -> String {
    let is_possible = |character: char| character.is_ascii_alphanumeric() || "_-.:".contains(character);
    let name: String =
        name.trim().chars().map(|character| if is_possible(character) { character } else { '_' }).collect();
    match name.as_bytes().first() {
        Some(first) if !first.is_ascii_digit() => name,
        _ => format!("_{name}"),
    }
}
