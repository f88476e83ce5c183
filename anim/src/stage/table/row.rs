//! Rows of the tables.

use super::value::ValueRow;

/// The place of an element in a script.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ElementGroup {
    /// The element around everything.
    Script,
    /// The list of things.
    Cast,
    /// A thing of the cast.
    Thing,
    /// An action that contains actions.
    Container,
    /// An action.
    Action,
    /// A part of one element.
    Part,
    /// The element around everything of a project, or of a file of lines.
    Project,
}

/// An attribute of an element.
#[derive(Clone, Copy, Debug)]
pub struct AttributeRow {
    /// The name.
    pub name: &'static str,
    /// The kind of its value.
    pub value: ValueRow,
    /// Whether it has to be present.
    pub required: bool,
    /// The value that counts where it is absent; empty where there is none.
    pub default: &'static str,
    /// Its meaning, in one sentence.
    pub help: &'static str,
}

/// An element.
#[derive(Clone, Copy, Debug)]
pub struct ElementRow {
    /// The name.
    pub name: &'static str,
    /// Where it may be.
    pub group: ElementGroup,
    /// Its attributes, in lists that elements share.
    pub attributes: &'static [&'static [AttributeRow]],
    /// Attributes of which exactly one has to be present; empty where there is no such choice.
    pub one_of: &'static [&'static str],
    /// Names of the elements of things that may do it: the kinds that `who` accepts; empty where it has no `who`.
    pub who: &'static [&'static str],
    /// The parts that it may contain.
    pub parts: &'static [&'static ElementRow],
    /// Its purpose, in one sentence.
    pub help: &'static str,
}

impl ElementRow {
    /// Returns the attribute called `name`.
    pub fn attribute(&self, name: &str) -> Option<&'static AttributeRow> {
        self.rows().find(|row| row.name == name)
    }

    /// Returns all attributes.
    pub fn rows(&self) -> impl Iterator<Item = &'static AttributeRow> + use<> {
        self.attributes.iter().flat_map(|list| list.iter())
    }
}

pub(super) const fn required(name: &'static str, value: ValueRow, help: &'static str) -> AttributeRow {
    AttributeRow { name, value, required: true, default: "", help }
}

pub(super) const fn optional(
    name: &'static str,
    value: ValueRow,
    default: &'static str,
    help: &'static str,
) -> AttributeRow {
    AttributeRow { name, value, required: false, default, help }
}
