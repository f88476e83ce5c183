//! The vocabulary as tables: a row for each element, a row for each attribute.
//!
//! Checks, messages, help, completion, default values and the schema all read these rows. A new thing or action is a row here, and a
//! variant where it is evaluated.

mod actions;
mod cast;
mod new_actions;
mod project;
mod property;
mod reference;
mod row;
mod schema;
mod value;
mod vocabulary;

pub use new_actions::{NEW_ACTIONS, NewActionRow, NewActionTarget};
pub use property::{PROPERTIES, PropertyRow, PropertyType, property};
pub use reference::NameReference;
pub use row::{AttributeRow, ElementGroup, ElementRow};
pub use schema::schema;
pub use value::vector;
pub use value::{PlainNumbers, ValueRow};
pub(in crate::stage) use value::{numbers, points, size};
pub use vocabulary::{LINE_FILES, PROJECTS, SCRIPTS, Vocabulary};

/// Every element of scripts, in the order of the documentation.
pub const ELEMENTS: &[&ElementRow] = &[
    &cast::SCRIPT,
    &cast::CAST,
    &cast::ROLE,
    &cast::PROP,
    &cast::CAMERA,
    &cast::LIGHT,
    &cast::EFFECT,
    &cast::PATH,
    &cast::MARK,
    &actions::SEQ,
    &actions::PAR,
    &actions::WAIT,
    &actions::PLAY,
    &actions::MOVE,
    &actions::TURN,
    &actions::PLACE,
    &actions::LOOK,
    &actions::ATTACH,
    &actions::DETACH,
    &actions::SHOT,
    &actions::RUN,
    &actions::SET,
    &actions::CHANGE,
    &actions::SOUND,
    &actions::TITLE,
    &actions::INCLUDE,
    &actions::AT,
];

/// Returns the row of the element of scripts called `name`.
pub fn element(name: &str) -> Option<&'static ElementRow> {
    SCRIPTS.element(name)
}

/// Returns the elements that may be inside `row` in a script.
pub fn children_of(row: &ElementRow) -> Vec<&'static ElementRow> {
    SCRIPTS.children_of(row)
}
