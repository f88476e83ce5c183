//! What a save of texts changes, for the user and for programs.

use super::adapter::TextFiles;
use dragonfly_anim::format::ChangeReport;
use serde_json::json;

/// Returns the lines that a save replaces, a line of text for each file that changes.
pub(super) fn text_changes(old: &TextFiles, new: &TextFiles) -> ChangeReport {
    let (mut text, mut rows) = (String::new(), Vec::new());
    for file in new.list() {
        let before = old.called(&file.name).map_or("", |old| &old.text);
        if before == &*file.text {
            continue;
        }
        let (first, removed, added) = changed_lines(before, &file.text);
        text += &format!("{}: from line {first}, {removed} lines become {added}\n", file.name);
        rows.push(json!({"name": &*file.name, "line": first, "removed": removed, "added": added}));
    }
    if rows.is_empty() {
        text += "nothing changes\n";
    }
    ChangeReport { text, json: json!({"texts": rows}).to_string() }
}

/// Returns the first line that differs, from 1, and how many lines from there on differ in each text up to their common end.
fn changed_lines(old: &str, new: &str) -> (usize, usize, usize) {
    let [old, new] = [old, new].map(|text| text.split_inclusive('\n').collect::<Vec<_>>());
    let same = old.iter().zip(&new).take_while(|(old, new)| old == new).count();
    let ends = old[same..].iter().rev().zip(new[same..].iter().rev());
    let tail = ends.take_while(|(old, new)| old == new).count();
    (same + 1, old.len() - same - tail, new.len() - same - tail)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_changed_lines_are_those_between_the_common_start_and_the_common_end() {
        assert_eq!(changed_lines("a\nb\nc\n", "a\nx\ny\nc\n"), (2, 1, 2));
        assert_eq!(changed_lines("a\na\n", "a\na\na\n"), (3, 0, 1));
        assert_eq!(changed_lines("a\n", ""), (1, 1, 0));
        let files = |text: &str| TextFiles::one("scene.xml", text);
        let report = text_changes(&files("a\nb\n"), &files("a\n"));
        assert_eq!(report.text, "scene.xml: from line 2, 1 lines become 0\n");
        assert_eq!(text_changes(&files("a"), &files("a")).text, "nothing changes\n");
    }
}
