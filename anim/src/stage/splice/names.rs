//! Names: new ones, and what refers to them.

use super::{TextSplice, TextSplices, escaped};
use crate::stage::script::{ScriptAttribute, ScriptElement, ScriptTree, is_name};
use crate::stage::table::{ElementGroup, NameReference};
use std::collections::HashMap;
use std::fmt;

/// Returns a name that no element has: `base`, without what cannot be in a name, and with a number where it is taken.
pub fn unique_id(tree: &ScriptTree, base: &str) -> String {
    unique_among(base, |name| tree.elements().iter().any(|element| element.value("id") == Some(name)))
}

/// Returns a name that is not taken: `base`, without what cannot be in a name, and with a number if it is.
pub(in crate::stage) fn unique_among(base: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let plain = |letter: char| if letter.is_ascii_alphanumeric() || letter == '_' { letter } else { '-' };
    let base: String = base.chars().map(plain).collect();
    let parts: Vec<&str> = base.split('-').filter(|part| !part.is_empty()).collect();
    let mut base = parts.join("-");
    // A name begins with a letter, and "prev" means the action before.
    if !is_name(&base) || base == "prev" {
        base = format!("a-{base}").trim_end_matches('-').to_owned();
    }
    // A number at the end is counted on.
    let stem = base.rsplit_once('-').filter(|(_, number)| number.bytes().all(|byte| byte.is_ascii_digit()));
    let stem = stem.map_or(base.as_str(), |(stem, _)| stem).to_owned();
    let numbered = (2_u64..).map(|number| format!("{stem}-{number}"));
    std::iter::once(base.clone()).chain(numbered).find(|name| !is_taken(name)).unwrap_or(base)
}

/// Returns the elements that name the one called `id`, by their positions. Those of included files are left out: they have a cast of their own.
pub fn elements_that_name<'a>(tree: &'a ScriptTree, id: &'a str) -> impl Iterator<Item = usize> + 'a {
    let names = move |element: &ScriptElement| {
        !element.is_included() && element.attributes.iter().any(|attribute| named(attribute) == Some(id))
    };
    tree.elements().iter().enumerate().filter(move |(_, element)| names(element)).map(|(index, _)| index)
}

/// The reason why an element gets no other id.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RenameRefusal {
    /// There is no such element in the text, or it has no id.
    Nothing,
    /// This id is no name, or another element has it.
    NoName(String),
    /// The thing with this id is also in the cast of this included file, or of the project for `None`: there it would keep its name, and be another thing.
    Shared(String, Option<String>),
}

impl fmt::Display for RenameRefusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => out.write_str("There is no name to change"),
            Self::NoName(id) => write!(
                out,
                "\"{id}\" cannot be a name here: it is used already, or has other characters than letters, digits, _ and -"
            ),
            Self::Shared(id, Some(file)) => {
                write!(out, "\"{id}\" is also in the cast of {file}, and would be another thing there")
            }
            Self::Shared(id, None) => {
                write!(out, "\"{id}\" is also in the cast of the project, and would be another thing there")
            }
        }
    }
}

impl std::error::Error for RenameRefusal {}

/// Gives an element another id, and changes all references to it.
///
/// # Errors
///
/// There is no such element in the text, it has no id, the new one is no name or another element has it, or the thing is also one of another text: of
/// an included file or of the project.
pub fn rename(tree: &ScriptTree, element: usize, id: &str) -> Result<TextSplices, RenameRefusal> {
    let named = tree.own(element).and_then(|element| Some((element.row.group, element.attribute("id")?)));
    let Some((group, own)) = named else { return Err(RenameRefusal::Nothing) };
    if &*own.value == id {
        return Ok(TextSplices::default());
    }
    let is_thing = |element: &ScriptElement| element.row.group == ElementGroup::Thing;
    let shares = |other: &&ScriptElement| {
        group == ElementGroup::Thing
            && !other.is_own()
            && is_thing(other)
            && other.value("id") == Some(&*own.value)
    };
    if let Some(other) = tree.elements().iter().find(shares) {
        let file = tree.file_of(other).map(str::to_owned);
        return Err(RenameRefusal::Shared(own.value.to_string(), file));
    }
    if is_taken(tree, id) || id == "prev" || !is_name(id) {
        return Err(RenameRefusal::NoName(id.to_owned()));
    }
    let names = HashMap::from([(&*own.value, id.to_owned())]);
    let written = tree.elements().iter().filter(|element| element.is_own());
    let attributes = written.flat_map(|element| &element.attributes);
    let text = tree.text();
    Ok(TextSplices::of(attributes.filter_map(|attribute| renamed(text, attribute, &names)).collect()))
}

/// Returns whether another element of a script cannot have the id any more.
fn is_taken(tree: &ScriptTree, id: &str) -> bool {
    // The actions of included files have names of their own.
    let counts =
        |element: &&ScriptElement| !element.is_included() || element.row.group == ElementGroup::Thing;
    tree.elements().iter().filter(counts).any(|element| element.value("id") == Some(id))
}

/// Changes all references of a text to something that another text calls `id` now, and `old` before. The same text where there are none.
///
/// `None` for an id that is no name or that an element has.
pub fn rename_references(tree: &ScriptTree, old: &str, id: &str) -> Option<TextSplices> {
    if is_taken(tree, id) || id == "prev" || !is_name(id) {
        return None;
    }
    let names = HashMap::from([(old, id.to_owned())]);
    let written = tree.elements().iter().filter(|element| element.is_own());
    let attributes = written.flat_map(|element| &element.attributes).filter(|own| own.row.name != "id");
    let text = tree.text();
    Some(TextSplices::of(attributes.filter_map(|attribute| renamed(text, attribute, &names)).collect()))
}

/// Returns the text of an element in which every id is a new one.
pub(super) fn with_new_ids(tree: &ScriptTree, element: usize) -> Option<String> {
    let range = tree.elements().get(element)?.range.clone();
    let inside = || tree.elements().iter().skip(element).take_while(|inner| inner.range.start < range.end);
    let mut taken: Vec<String> =
        tree.elements().iter().filter_map(|element| element.value("id")).map(str::to_owned).collect();
    let mut names = HashMap::new();
    for id in inside().filter_map(|element| element.value("id")) {
        let new = unique_among(id, |name| taken.iter().any(|taken| taken == name));
        taken.push(new.clone());
        names.insert(id, new);
    }
    let attributes = inside().flat_map(|element| &element.attributes);
    let splices = attributes.filter_map(|attribute| renamed(tree.text(), attribute, &names));
    let moved = |splice: TextSplice| TextSplice {
        range: splice.range.start - range.start..splice.range.end - range.start,
        ..splice
    };
    let splices = TextSplices::of(splices.map(moved).collect());
    Some(splices.apply(tree.text().get(range.clone())?))
}

/// Returns the name of an element that an attribute refers to.
pub(in crate::stage) fn named(attribute: &ScriptAttribute) -> Option<&str> {
    let value = &*attribute.value;
    let name = match attribute.row.reference()? {
        NameReference::Name => value,
        // A moment of an action, or a thing or one of its bones: the name is in front of the first point.
        NameReference::Moment => value.split_once('.')?.0,
        NameReference::Spot => value.split_once('.').map_or(value, |(name, _)| name),
    };
    is_name(name).then_some(name)
}

/// Returns the splice that gives an id, or a reference to one, its new name. What follows the name keeps its spelling.
fn renamed(text: &str, attribute: &ScriptAttribute, names: &HashMap<&str, String>) -> Option<TextSplice> {
    let old = if attribute.row.name == "id" { &*attribute.value } else { named(attribute)? };
    let (new, range) = (names.get(old)?, attribute.value_range.clone());
    if text.get(range.clone())?.starts_with(old) {
        return Some(TextSplice { range: range.start..range.start + old.len(), text: new.clone() });
    }
    // The name itself is written with references to letters.
    let value = format!("{new}{}", attribute.value.get(old.len()..)?);
    let text = escaped(&value, '"').replace('\'', "&apos;");
    Some(TextSplice { range, text })
}
