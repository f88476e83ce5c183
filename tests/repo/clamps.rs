//! Code of the window calls `clamp` with constants only, because it panics if computed bounds are in the wrong order.

use crate::tokens::{after_group, tokens};
use crate::tree::{File, files, none, one};

/// Folders with code that runs for every frame or input of the window.
const WITHIN: &[&str] = &["editor/src/", "editor/picture/src/"];

/// Returns whether a word is a number, a constant, a type, or takes the end of a constant range.
fn is_constant(word: &str) -> bool {
    let first = word.chars().next().unwrap_or(' ');
    let is_name = first.is_alphabetic() || first == '_';
    !is_name || !word.chars().any(char::is_lowercase) || ["Self", "start", "end"].contains(&word)
}

fn computed_clamps(files: &[File]) -> Vec<String> {
    let mut complaints = Vec::new();
    let inside = |file: &&File| file.is_rust() && WITHIN.iter().any(|part| file.path.starts_with(part));
    for file in files.iter().filter(inside) {
        let tokens = tokens(&file.text);
        for at in 0..tokens.len().saturating_sub(2) {
            if [".", "clamp", "("] != [0, 1, 2].map(|next| tokens[at + next].as_str()) {
                continue;
            }
            let bounds = &tokens[at + 3..after_group(&tokens, at + 2) - 1];
            // With one argument it is another function of this name.
            if bounds.iter().any(|sign| sign == ",") && !bounds.iter().all(|word| is_constant(word)) {
                complaints.push(format!(
                    "{}: clamp({}): use dragonfly_picture::between, which does not panic",
                    file.path,
                    bounds.join(" ")
                ));
            }
        }
    }
    complaints
}

#[test]
fn code_of_the_window_clamps_to_constants_only() {
    none(computed_clamps(&files()));
    let planted = |code| computed_clamps(&[File::planted("editor/src/panels/readout.rs", code)]);
    one(planted("let at = wanted.clamp(rect.min, most);"));
    one(planted("let x = x.clamp(0.0, width - size);"));
    one(planted("let x = x.clamp(0.0, (width - size).max(0.0));"));
    none(planted("let x = x.clamp(-1e6, 1e6) as f32; let y = y.clamp(*SCALES.start(), Self::MOST[1]);"));
    none(planted("let x = self.clamp(value + step); // not x.clamp(low, high)"));
}
