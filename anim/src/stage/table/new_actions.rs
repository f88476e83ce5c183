//! Actions that menus add: one row for each entry.

/// The thing or property that an added action names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewActionTarget {
    /// Nothing.
    Nothing,
    /// A thing of one of these kinds, in this attribute.
    Thing {
        /// The attribute.
        attribute: &'static str,
        /// Names of the elements of the things.
        kinds: &'static [&'static str],
    },
    /// A property of the thing that acts; its value at that time is the one that is written.
    Property,
    /// The place and the direction that the thing has at that time.
    OwnPlace,
}

/// An action that a menu adds.
#[derive(Clone, Copy, Debug)]
pub struct NewActionRow {
    /// Title of the entry.
    pub title: &'static str,
    /// Name of the element.
    pub element: &'static str,
    /// The thing or property that it names.
    pub target: NewActionTarget,
    /// Its other attributes.
    pub with: &'static [(&'static str, &'static str)],
    /// Whether it plays the take of the thing for walking, if that has one; otherwise it gets a `dur`.
    pub walks: bool,
    /// Whether it continues the sequence of the thing; otherwise it begins independently of it.
    pub continues: bool,
}

const fn row(title: &'static str, element: &'static str, target: NewActionTarget) -> NewActionRow {
    NewActionRow { title, element, target, with: &[], walks: false, continues: false }
}

const fn thing(attribute: &'static str, kinds: &'static [&'static str]) -> NewActionTarget {
    NewActionTarget::Thing { attribute, kinds }
}

/// Everything that has a place.
const PLACED: &[&str] = &["role", "prop", "mark", "camera", "light", "effect"];

/// Every action that menus add, in their order. Takes, shots and attachments to bones have entries of their own.
pub const NEW_ACTIONS: &[NewActionRow] = &[
    NewActionRow {
        with: &[("dur", "2"), ("fade-in", "0.3"), ("fade-out", "0.3")],
        ..row("Look at", "look", thing("at", PLACED))
    },
    NewActionRow { with: &[("dur", "0.5")], continues: true, ..row("Turn to", "turn", thing("to", PLACED)) },
    NewActionRow {
        walks: true,
        continues: true,
        ..row("Move to", "move", thing("to", &["mark", "role", "prop"]))
    },
    NewActionRow { walks: true, continues: true, ..row("Walk along", "move", thing("path", &["path"])) },
    row("Place here", "place", NewActionTarget::OwnPlace),
    row("Detach", "detach", NewActionTarget::Nothing),
    row("Set", "set", NewActionTarget::Property),
    NewActionRow { with: &[("dur", "1")], ..row("Change", "change", NewActionTarget::Property) },
    row("Run", "run", NewActionTarget::Nothing),
    NewActionRow { with: &[("dur", "2")], ..row("Title", "title", NewActionTarget::Nothing) },
];
