//! Description of what a save changes in takes and their lists of keys.

use super::key_rows::RowCounts;
use super::losses::{count, json_text};
use super::{ChangeReport, one_line};
use std::fmt::Write;

/// Changes of a save, for users and for programs.
#[derive(Default)]
pub(super) struct KeyChanges {
    text: String,
    json: Vec<String>,
}

impl KeyChanges {
    /// Adds a change of a take as a whole, such as `added`.
    pub(super) fn take(&mut self, name: &str, what: &str) {
        let _ = writeln!(self.text, "take \"{}\": {what}", one_line(name));
        self.json.push(format!("{{\"change\":\"{what}\",\"take\":{}}}", json_text(name)));
    }

    /// Adds changes of the keys of a property of a bone; nothing where there are none.
    pub(super) fn keys(&mut self, take: &str, bone: &str, property: &str, rows: RowCounts) {
        if rows.is_none() {
            return;
        }
        let parts = [(rows.changed, "changed"), (rows.added, "added"), (rows.removed, "removed")];
        let words: Vec<String> = parts
            .iter()
            .filter(|(number, _)| *number > 0)
            .map(|(number, what)| format!("{} {what}", count(*number, "key")))
            .collect();
        let (shown, owner) = (one_line(take), one_line(bone));
        let _ = writeln!(self.text, "take \"{shown}\", \"{owner}\", {property}: {}", words.join(", "));
        self.json.push(format!(
            "{{\"added\":{},\"bone\":{},\"changed\":{},\"path\":\"{property}\",\"removed\":{},\"take\":{}}}",
            rows.added,
            json_text(bone),
            rows.changed,
            rows.removed,
            json_text(take)
        ));
    }

    /// Returns the report.
    pub(super) fn report(self) -> ChangeReport {
        let text = if self.text.is_empty() { "nothing changes\n".to_owned() } else { self.text };
        ChangeReport { text, json: format!("{{\"changes\":[{}]}}", self.json.join(",")) }
    }
}
