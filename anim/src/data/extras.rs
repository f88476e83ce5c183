//! Data that a program keeps with a take in its file.

use std::collections::BTreeMap;
use std::sync::Arc;

/// Named texts in JSON that a file keeps with a take: layers, contacts, events. Shared by copies.
///
/// In glTF they are the members of the object `dragonfly` in the `extras` of the animation. Other members of the `extras`
/// belong to other programs: they are not read, and a save keeps their bytes. A format without room for them loses
/// them, and its save says so.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TakeExtras(Option<Arc<BTreeMap<String, Arc<str>>>>);

impl TakeExtras {
    /// Returns the text of this name.
    pub fn get(&self, name: &str) -> Option<&Arc<str>> {
        self.0.as_ref()?.get(name)
    }

    /// Replaces the text of this name, `None` removes it. Returns the previous one. The text must be one JSON value:
    /// a save writes it as it is.
    pub fn set(&mut self, name: &str, text: Option<Arc<str>>) -> Option<Arc<str>> {
        let mut texts = self.0.take();
        let before = match text {
            Some(text) => Arc::make_mut(texts.get_or_insert_default()).insert(name.to_owned(), text),
            None => texts.as_mut().and_then(|texts| match texts.contains_key(name) {
                true => Arc::make_mut(texts).remove(name),
                false => None,
            }),
        };
        self.0 = texts.filter(|texts| !texts.is_empty());
        before
    }

    /// Returns all names with their texts, in the order of the names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Arc<str>)> {
        self.0.iter().flat_map(|texts| texts.iter()).map(|(name, text)| (name.as_str(), text))
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_none()
    }
}
