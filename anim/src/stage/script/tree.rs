//! The elements of a script with their places in the text.

use super::origin::{ElementOrigin, IncludedPart, located};
use super::{LineIndex, ScriptError, TextPlace};
use crate::stage::table::{AttributeRow, ElementRow};
use std::ops::Range;
use std::sync::Arc;

/// An attribute of an element.
#[derive(Clone, Debug)]
pub struct ScriptAttribute {
    /// Its row in the tables.
    pub row: &'static AttributeRow,
    /// The value, with references such as `&amp;` replaced.
    pub value: Box<str>,
    /// Bytes of name, `=`, quotes and value.
    pub range: Range<usize>,
    /// Bytes of the name.
    pub name: Range<usize>,
    /// Bytes of the value inside its quotes.
    pub value_range: Range<usize>,
}

/// An element of a script.
#[derive(Clone, Debug)]
pub struct ScriptElement {
    /// Its row in the tables.
    pub row: &'static ElementRow,
    /// The element around it; `None` for the script.
    pub parent: Option<usize>,
    /// Bytes from `<` to the end of its end tag.
    pub range: Range<usize>,
    /// Bytes of its name in the start tag.
    pub name: Range<usize>,
    /// The text that has it. Only those that the text itself has can be changed in it, and only their bytes are bytes of it.
    pub origin: ElementOrigin,
    /// Its attributes, in the order of the text. Those of other namespaces are left out.
    pub attributes: Vec<ScriptAttribute>,
}

impl ScriptElement {
    /// Returns whether it is in the text itself.
    pub fn is_own(&self) -> bool {
        self.origin == ElementOrigin::Text
    }

    /// Returns whether it is in a file that the text includes.
    pub fn is_included(&self) -> bool {
        match self.origin {
            ElementOrigin::Included(_) => true,
            ElementOrigin::Text | ElementOrigin::Project => false,
        }
    }

    /// Returns the attribute called `name`, if it is written.
    pub fn attribute(&self, name: &str) -> Option<&ScriptAttribute> {
        self.attributes.iter().find(|attribute| attribute.row.name == name)
    }

    /// Returns the value of `name`: as written, or the default. `None` where there is neither.
    pub fn value(&self, name: &str) -> Option<&str> {
        let written = self.attribute(name).map(|attribute| &*attribute.value);
        written
            .or_else(|| self.row.attribute(name).map(|row| row.default).filter(|default| !default.is_empty()))
    }

    /// Returns the bytes of the value of `name`, or of the element's name where the attribute is not written: the place for errors.
    pub fn value_range(&self, name: &str) -> Range<usize> {
        self.attribute(name).map_or_else(|| self.name.clone(), |attribute| attribute.value_range.clone())
    }
}

/// The text of a script and its elements, in the order of their start tags; those that it shares with its project follow, then those of the files
/// that it includes. Elements of other namespaces are left out.
#[derive(Clone, Debug)]
pub struct ScriptTree {
    pub(super) text: Arc<str>,
    pub(super) lines: LineIndex,
    pub(super) elements: Vec<ScriptElement>,
    /// The parts that the includes of the text bring, each before what it includes itself.
    pub(super) parts: Arc<[IncludedPart]>,
    /// Number of nodes of the text: elements, texts and comments.
    pub(super) nodes: usize,
}

impl ScriptTree {
    /// Reads the elements of a text and checks them against the tables; what references mean is left to
    /// [`StageScript::read`](super::StageScript::read).
    ///
    /// # Errors
    ///
    /// Everything that is wrong, in the order of the text.
    pub fn read(text: impl Into<Arc<str>>) -> Result<Self, Vec<ScriptError>> {
        super::read::read_tree(&text.into(), &crate::stage::table::SCRIPTS)
    }

    /// Returns the text.
    pub fn text(&self) -> &Arc<str> {
        &self.text
    }

    pub(in crate::stage) fn lines(&self) -> &LineIndex {
        &self.lines
    }

    /// Returns all elements; the first one is the script.
    pub fn elements(&self) -> &[ScriptElement] {
        &self.elements
    }

    /// Returns line and column of a byte of the text; in its own file, for a byte of an element that is included.
    pub fn place(&self, at: usize) -> TextPlace {
        IncludedPart::at(&self.parts, at).map_or_else(|| self.lines.place(at), |part| part.place(at))
    }

    /// Returns an error at some bytes of an element.
    pub fn error(
        &self,
        range: Range<usize>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> ScriptError {
        located(&self.lines, &self.parts, range, message.into(), help.into())
    }

    /// Returns the element of this index if the text itself has it.
    pub(in crate::stage) fn own(&self, element: usize) -> Option<&ScriptElement> {
        self.elements.get(element).filter(|element| element.is_own())
    }

    /// Returns the file of an element that is included, relative to the folder of the document; `None` for others.
    pub fn file_of(&self, element: &ScriptElement) -> Option<&str> {
        match element.origin {
            ElementOrigin::Text | ElementOrigin::Project => None,
            ElementOrigin::Included(part) => self.parts.get(part).map(|part| &*part.file),
        }
    }

    /// Returns the bytes of the text that an element comes from: its own, or those of the `include` of the text that brings it. `None` for an
    /// element of the project.
    pub fn range_in_text(&self, element: &ScriptElement) -> Option<Range<usize>> {
        match element.origin {
            ElementOrigin::Text => Some(element.range.clone()),
            ElementOrigin::Project => None,
            ElementOrigin::Included(part) => {
                Some(self.elements.get(self.parts.get(part)?.outermost)?.range.clone())
            }
        }
    }

    /// Returns the files that are included, each once, by their names relative to the folder of the document.
    pub fn included_files(&self) -> std::collections::BTreeSet<&str> {
        self.parts.iter().map(|part| &*part.file).collect()
    }

    /// Returns the innermost element of the text itself that contains the byte at `at`: the one at the caret of an editor.
    pub fn element_at(&self, at: usize) -> Option<usize> {
        // A later start tag that contains the byte is inside the earlier ones.
        self.elements.iter().rposition(|element| element.is_own() && element.range.contains(&at))
    }

    /// Returns `<NAME>` of an element, with its id, line and file: `<play id="grab"> (line 31)`, `<play> (line 4 of intro.xml)`.
    pub(in crate::stage) fn title(&self, element: usize) -> String {
        let Some(element) = self.elements.get(element) else { return String::new() };
        let line = self.place(element.range.start).line;
        let file = self.file_of(element).map_or(String::new(), |file| format!(" of {file}"));
        match element.value("id") {
            Some(id) => format!("<{} id=\"{id}\"> (line {line}{file})", element.row.name),
            None => format!("<{}> (line {line}{file})", element.row.name),
        }
    }
}
