//! Finds the range of every value and member of a JSON text.
//!
//! The tree is a list of values in the order of the text, parents first; each value stores where its subtree ends in
//! the list. Parsing uses no recursion.

use super::token::{number_end, string_end, unquoted};
use crate::format::gltf::whole::whole;
use crate::limits::{JSON_DEPTH, MEMORY_MAX};
use std::borrow::Cow;
use std::ops::Range;

/// Index of a value in [`Tree`].
pub(in super::super) type ValueId = usize;

/// Kind of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum JsonKind {
    Object,
    Array,
    String,
    Number,
    /// `true`, `false`, `null`.
    Word,
}

/// One value. Offsets are bytes from the start of the file.
#[derive(Clone, Copy, Debug)]
struct JsonValue {
    from: u32,
    to: u32,
    /// Name of the member with its quotes; empty for elements of arrays and for the root.
    key: (u32, u32),
    /// Index of the first value after this one and its descendants.
    end: u32,
    kind: JsonKind,
}

/// Largest number of values, so that the list stays within the memory limit of an import.
const VALUES: usize = (MEMORY_MAX as usize / size_of::<JsonValue>()) / 2;

/// The ranges of all values of a text.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct Tree {
    values: Vec<JsonValue>,
}

/// An invalid JSON text: the place, and what is wrong.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct InvalidJson {
    pub(in super::super) at: usize,
    pub(in super::super) reason: &'static str,
}

/// What may follow.
#[derive(Clone, Copy, PartialEq)]
enum ExpectedToken {
    JsonValue,
    /// A value or `]`, a name or `}`: directly after the opening bracket.
    First,
    Key,
    /// A comma or the closing bracket.
    Next,
}

impl Tree {
    /// Parses the text in `range` of the file.
    pub(in super::super) fn read(file: &[u8], range: Range<usize>) -> Result<Self, InvalidJson> {
        let text = &file[..range.end];
        let mut tree = Self::default();
        let mut open: Vec<ValueId> = Vec::new();
        let mut expected = ExpectedToken::JsonValue;
        let mut key = (0, 0);
        let mut at = range.start;
        loop {
            at = skip_space(text, at);
            let broken = |reason| InvalidJson { at, reason };
            let Some(&byte) = text.get(at) else {
                let done = open.is_empty() && !tree.values.is_empty();
                return if done { Ok(tree) } else { Err(broken("the text ends too early")) };
            };
            let Some(&inner) = open.last() else {
                if !tree.values.is_empty() {
                    return Err(broken("there is something after the end of the text"));
                }
                at = tree.value(text, at, key, &mut open)?;
                expected = if open.is_empty() { ExpectedToken::Next } else { ExpectedToken::First };
                continue;
            };
            let is_array = tree.values[inner].kind == JsonKind::Array;
            let closing = if is_array { b']' } else { b'}' };
            match expected {
                ExpectedToken::First | ExpectedToken::Next if byte == closing => {
                    at += 1;
                    tree.values[inner].to = at as u32;
                    tree.values[inner].end = tree.values.len() as u32;
                    open.pop();
                    expected = ExpectedToken::Next;
                }
                ExpectedToken::Next if byte == b',' => {
                    at += 1;
                    expected = if is_array { ExpectedToken::JsonValue } else { ExpectedToken::Key };
                }
                ExpectedToken::Next => return Err(broken("a comma or a closing bracket is missing")),
                ExpectedToken::First | ExpectedToken::Key if !is_array => {
                    let end = if byte == b'"' { string_end(text, at) } else { None };
                    let end = end.ok_or(broken("the name of a member is missing"))?;
                    key = (at as u32, end as u32);
                    at = skip_space(text, end);
                    if text.get(at) != Some(&b':') {
                        return Err(InvalidJson { at, reason: "a colon is missing" });
                    }
                    at += 1;
                    expected = ExpectedToken::JsonValue;
                }
                _ => {
                    let depth = open.len();
                    at = tree.value(text, at, std::mem::take(&mut key), &mut open)?;
                    expected = if open.len() > depth { ExpectedToken::First } else { ExpectedToken::Next };
                }
            }
        }
    }

    /// Adds the value at `at` to the list and returns the position after it, or after its opening bracket.
    fn value(
        &mut self,
        text: &[u8],
        at: usize,
        key: (u32, u32),
        open: &mut Vec<ValueId>,
    ) -> Result<usize, InvalidJson> {
        let broken = |reason| InvalidJson { at, reason };
        if self.values.len() >= VALUES {
            return Err(broken("there are too many values"));
        }
        let word = |word: &[u8]| text[at..].starts_with(word).then_some(at + word.len());
        let (kind, to) = match text[at] {
            b'{' => (JsonKind::Object, Some(at + 1)),
            b'[' => (JsonKind::Array, Some(at + 1)),
            b'"' => (JsonKind::String, string_end(text, at)),
            b't' => (JsonKind::Word, word(b"true")),
            b'f' => (JsonKind::Word, word(b"false")),
            b'n' => (JsonKind::Word, word(b"null")),
            _ => (JsonKind::Number, number_end(text, at)),
        };
        let to = to.ok_or(broken("a value is invalid"))?;
        let id = self.values.len();
        if matches!(kind, JsonKind::Object | JsonKind::Array) {
            if open.len() >= JSON_DEPTH {
                return Err(broken("there are too many levels of arrays and objects"));
            }
            open.push(id);
        }
        self.values.push(JsonValue { from: at as u32, to: to as u32, key, end: id as u32 + 1, kind });
        Ok(to)
    }
}

fn skip_space(text: &[u8], at: usize) -> usize {
    let space =
        text[at.min(text.len())..].iter().take_while(|byte| matches!(byte, b' ' | b'\t' | b'\n' | b'\r'));
    at + space.count()
}

/// A tree with its file, on which all queries are made. The root is value 0.
#[derive(Clone, Copy)]
pub(in super::super) struct Json<'a> {
    pub(in super::super) file: &'a [u8],
    tree: &'a Tree,
}

impl<'a> Json<'a> {
    pub(in super::super) fn new(file: &'a [u8], tree: &'a Tree) -> Self {
        Self { file, tree }
    }

    /// Returns the number of values.
    pub(in super::super) fn len(self) -> usize {
        self.tree.values.len()
    }

    pub(in super::super) fn kind(self, id: ValueId) -> JsonKind {
        self.tree.values[id].kind
    }

    /// Returns the range of the value.
    pub(in super::super) fn span(self, id: ValueId) -> Range<usize> {
        let value = &self.tree.values[id];
        value.from as usize..value.to as usize
    }

    /// Returns the range from the name of the member to the end of its value; in an array the range of the value.
    pub(in super::super) fn item_span(self, id: ValueId) -> Range<usize> {
        let value = &self.tree.values[id];
        let from = if value.key.1 > 0 { value.key.0 } else { value.from };
        from as usize..value.to as usize
    }

    pub(in super::super) fn token(self, id: ValueId) -> &'a [u8] {
        &self.file[self.span(id)]
    }

    /// Returns the name of the member; `None` in an array.
    pub(in super::super) fn key(self, id: ValueId) -> Option<Cow<'a, str>> {
        let (from, to) = self.tree.values[id].key;
        (to > 0).then(|| unquoted(&self.file[from as usize..to as usize]))
    }

    /// Returns the bytes between the name of a member and its value: a colon and space.
    pub(in super::super) fn colon(self, id: ValueId) -> Option<&'a [u8]> {
        let value = &self.tree.values[id];
        (value.key.1 > 0).then(|| &self.file[value.key.1 as usize..value.from as usize])
    }

    /// Returns the first value after this one and its descendants.
    pub(in super::super) fn end(self, id: ValueId) -> ValueId {
        self.tree.values[id].end as usize
    }

    /// Returns the elements of an array or the member values of an object, in order; nothing for other values.
    pub(in super::super) fn items(self, id: ValueId) -> impl Iterator<Item = ValueId> + 'a {
        let end = self.end(id);
        let first = Some(id + 1).filter(|&first| first < end);
        std::iter::successors(first, move |&item| Some(self.end(item)).filter(|&next| next < end))
    }

    /// Returns the value of the member `name` of an object; the last one if there are several.
    pub(in super::super) fn member(self, id: ValueId, name: &str) -> Option<ValueId> {
        if self.kind(id) != JsonKind::Object {
            return None;
        }
        self.items(id).filter(|&item| self.key(item).as_deref() == Some(name)).last()
    }

    /// Returns the elements of the array that is the member `name`; none if there is no such array.
    pub(in super::super) fn list(self, id: ValueId, name: &str) -> Vec<ValueId> {
        let list = self.member(id, name).filter(|&list| self.kind(list) == JsonKind::Array);
        list.map(|list| self.items(list).collect()).unwrap_or_default()
    }

    /// Returns the value as a non-negative whole number.
    pub(in super::super) fn whole(self, id: ValueId) -> Option<u64> {
        (self.kind(id) == JsonKind::Number).then(|| whole(std::str::from_utf8(self.token(id)).ok()?))?
    }

    /// Returns [`Self::whole`] of a member.
    pub(in super::super) fn whole_member(self, id: ValueId, name: &str) -> Option<u64> {
        self.whole(self.member(id, name)?)
    }

    /// Returns [`Self::whole_member`] as an index.
    pub(in super::super) fn index_member(self, id: ValueId, name: &str) -> Option<usize> {
        usize::try_from(self.whole_member(id, name)?).ok()
    }

    /// Returns the value as a decoded string.
    pub(in super::super) fn string(self, id: ValueId) -> Option<Cow<'a, str>> {
        (self.kind(id) == JsonKind::String).then(|| unquoted(self.token(id)))
    }

    /// Returns [`Self::string`] of a member.
    pub(in super::super) fn string_member(self, id: ValueId, name: &str) -> Option<Cow<'a, str>> {
        self.string(self.member(id, name)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Tree, InvalidJson> {
        Tree::read(text.as_bytes(), 0..text.len())
    }

    #[test]
    fn every_value_is_found_with_its_range() {
        let text = r#" {"a" : [1, {"b":"x"}, []] , "\u0061": -1e0, "c":null}  "#;
        let tree = read(text).unwrap();
        let json = Json::new(text.as_bytes(), &tree);
        assert_eq!(json.token(0), text.trim().as_bytes());
        let names: Vec<_> = json.items(0).map(|id| json.key(id).unwrap()).collect();
        assert_eq!(names, ["a", "a", "c"]);
        assert_eq!(json.token(json.member(0, "a").unwrap()), b"-1e0");
        let list = json.items(0).next().unwrap();
        let tokens: Vec<_> = json.items(list).map(|id| json.token(id)).collect();
        assert_eq!(tokens, [b"1".as_slice(), b"{\"b\":\"x\"}", b"[]"]);
        assert_eq!(json.colon(list), Some(b" : ".as_slice()));
    }

    #[test]
    fn invalid_json_is_refused_with_its_place() {
        let broken = [
            ("", 0),
            ("{", 1),
            ("[1,]", 3),
            ("{\"a\"}", 4),
            ("{\"a\":1,}", 7),
            ("[1 2]", 3),
            ("[1]x", 3),
            ("[01]", 1),
            ("[tru]", 1),
            ("{a:1}", 1),
            ("[\"\u{1}\"]", 1),
            ("[\"\\x\"]", 1),
            ("]", 0),
            ("[}", 1),
        ];
        for (text, at) in broken {
            assert_eq!(read(text).unwrap_err().at, at, "{text}");
        }
    }

    #[test]
    fn too_deep_a_text_is_refused_before_the_stack_overflows() {
        let text = |depth: usize| "[".repeat(depth) + &"]".repeat(depth);
        assert!(read(&text(JSON_DEPTH)).is_ok());
        assert_eq!(read(&text(JSON_DEPTH + 1)).unwrap_err().at, JSON_DEPTH);
        assert!(read(&"[".repeat(1 << 20)).is_err());
    }
}
