//! Description of what a save changes.

pub(super) use crate::format::losses::count;
use crate::format::losses::json_text;
use crate::format::{ChangeReport, one_line};
use std::fmt::Write;

/// JointProperty of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum JointProperty {
    Translation,
    Rotation,
    Scale,
}

impl JointProperty {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Translation => "translation",
            Self::Rotation => "rotation",
            Self::Scale => "scale",
        }
    }
}

/// Edited frames of a property of a joint.
pub(super) struct ChangedColumn {
    pub(super) bone: String,
    pub(super) property: JointProperty,
    pub(super) frames: usize,
}

/// All changes of a save.
#[derive(Default)]
pub(super) struct BvhChanges {
    pub(super) columns: Vec<ChangedColumn>,
    /// Number of replaced numbers.
    pub(super) numbers: usize,
    pub(super) appended: usize,
    pub(super) removed: usize,
}

impl BvhChanges {
    /// Returns the changes for users and for programs.
    pub(super) fn report(&self) -> ChangeReport {
        let mut text = String::new();
        let mut bones = Vec::new();
        for column in &self.columns {
            let (name, property) = (&column.bone, column.property.name());
            let _ = writeln!(text, "\"{}\", {property}: {}", one_line(name), count(column.frames, "frame"));
            let name = json_text(name);
            bones.push(format!("{{\"bone\":{name},\"frames\":{},\"path\":\"{property}\"}}", column.frames));
        }
        for (frames, what) in [(self.appended, "appended"), (self.removed, "removed")] {
            if frames > 0 {
                let _ = writeln!(text, "{} {what} at the end", count(frames, "frame"));
            }
        }
        let head = if text.is_empty() {
            "nothing changes".to_owned()
        } else {
            count(self.numbers, "number") + " replaced"
        };
        let json = format!(
            "{{\"channels\":[{}],\"framesAppended\":{},\"framesRemoved\":{},\"numbers\":{}}}",
            bones.join(","),
            self.appended,
            self.removed,
            self.numbers
        );
        ChangeReport { text: format!("{head}\n{text}"), json }
    }
}
