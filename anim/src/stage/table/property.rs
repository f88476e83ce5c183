//! Properties of things that `set` and `change` alter.

/// The type of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PropertyType {
    /// A number of 0 or more.
    Number,
    /// A color, sRGB.
    Color,
    /// A focal length in millimeters.
    Lens,
}

/// A property of a kind of thing. Its value before any change is the attribute of the same name.
#[derive(Clone, Copy, Debug)]
pub struct PropertyRow {
    /// Name of the element of the thing.
    pub thing: &'static str,
    /// Name of the property and of the attribute.
    pub name: &'static str,
    /// Its type.
    pub kind: PropertyType,
}

const fn row(thing: &'static str, name: &'static str, kind: PropertyType) -> PropertyRow {
    PropertyRow { thing, name, kind }
}

/// Every property.
pub const PROPERTIES: &[PropertyRow] = &[
    row("camera", "lens", PropertyType::Lens),
    row("camera", "aperture", PropertyType::Number),
    row("light", "strength", PropertyType::Number),
    row("light", "color", PropertyType::Color),
    row("effect", "rate", PropertyType::Number),
];

/// Returns the property called `name` of things with the element `thing`.
pub fn property(thing: &str, name: &str) -> Option<&'static PropertyRow> {
    PROPERTIES.iter().find(|row| row.thing == thing && row.name == name)
}
