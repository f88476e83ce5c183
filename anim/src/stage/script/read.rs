//! From a text to a checked tree: XML first, then the tables.

use super::error::ErrorList;
use super::origin::ElementOrigin;
use super::suggest::suggestion;
use super::tree::{ScriptAttribute, ScriptElement, ScriptTree};
use super::{LineIndex, ScriptError};
use crate::stage::table::{ElementGroup, ElementRow, Vocabulary};
use crate::stage::time::StageRate;
use roxmltree::{Document, Node, ParsingOptions};
use std::ops::Range;
use std::sync::Arc;

/// Largest script in bytes.
pub const MOST_BYTES: usize = 8 << 20;

/// Largest number of nodes of a script: elements, texts and comments.
pub const MOST_NODES: u32 = 500_000;

/// Largest depth of elements.
pub const MOST_DEPTH: usize = 64;

/// Reads the elements of a text and checks them against the tables of its vocabulary.
pub(in crate::stage) fn read_tree(
    text: &Arc<str>,
    vocabulary: &'static Vocabulary,
) -> Result<ScriptTree, Vec<ScriptError>> {
    let lines = LineIndex::new(text);
    let mut errors = ErrorList::new(&lines);
    let (mut elements, mut nodes) = (Vec::new(), 0);
    if text.len() > MOST_BYTES {
        errors.add(0..0, format!("the text has {} bytes; at most {MOST_BYTES} are read", text.len()), "");
    } else if let Some(at) = too_deep(text) {
        errors.add(at..at, format!("elements are nested more than {MOST_DEPTH} deep"), "");
    } else {
        let options =
            ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
        match Document::parse_with_options(text, options) {
            Ok(document) => {
                nodes = document.descendants().count();
                elements = checked(&document, vocabulary, &mut errors);
            }
            Err(error) => {
                let at = error.pos();
                errors.add(lines.range(at.row, at.col), xml_message(&error, vocabulary), "");
            }
        }
    }
    if errors.is_empty() {
        let (text, parts) = (Arc::clone(text), Arc::default());
        return Ok(ScriptTree { text, lines, elements, parts, nodes });
    }
    Err(errors.sorted())
}

/// Returns the byte of the first tag that is nested too deep. A rough count of tags, which is enough to keep the parser from deep
/// recursion; comments and quoted signs can only make it stop earlier by their own number of `<`.
fn too_deep(text: &str) -> Option<usize> {
    let (bytes, mut depth, mut at) = (text.as_bytes(), 0_usize, 0);
    while at < bytes.len() {
        let rest = &bytes[at..];
        if rest.starts_with(b"<!--") {
            at += find(rest, b"-->").unwrap_or(rest.len());
        } else if rest.starts_with(b"<![CDATA[") {
            at += find(rest, b"]]>").unwrap_or(rest.len());
        } else if rest.starts_with(b"</") {
            depth = depth.saturating_sub(1);
        } else if rest[0] == b'<' && rest.get(1).is_some_and(|next| !matches!(next, b'?' | b'!')) {
            let end = tag_end(rest);
            let is_empty = end > 0 && rest.get(end - 1) == Some(&b'/');
            depth += usize::from(!is_empty);
            if depth > MOST_DEPTH {
                return Some(at);
            }
            at += end;
        }
        at += 1;
    }
    None
}

fn find(bytes: &[u8], needle: &[u8]) -> Option<usize> {
    bytes.windows(needle.len()).position(|window| window == needle)
}

/// Returns the position of the `>` that ends a tag, outside quotes.
fn tag_end(tag: &[u8]) -> usize {
    let mut quote = None;
    for (at, &byte) in tag.iter().enumerate() {
        match (quote, byte) {
            (None, b'>') => return at,
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), _) if open == byte => quote = None,
            (None | Some(_), _) => {}
        }
    }
    tag.len()
}

fn xml_message(error: &roxmltree::Error, vocabulary: &Vocabulary) -> String {
    let text = match error {
        roxmltree::Error::DtdDetected => {
            "document types (<!DOCTYPE …>) and their entities are refused".to_owned()
        }
        roxmltree::Error::NodesLimitReached => {
            format!("the text has more than {MOST_NODES} elements, texts and comments")
        }
        roxmltree::Error::NoRootNode => {
            format!("there is no element; <{} version=\"1\"> is expected", vocabulary.root.name)
        }
        other => {
            // The place is in front of the message.
            let text = other.to_string();
            text.split(" at ").next().unwrap_or(&text).to_owned()
        }
    };
    format!("this is not XML: {text}")
}

/// Returns the elements of our vocabulary, and reports everything that does not fit the tables.
fn checked(
    document: &Document,
    vocabulary: &'static Vocabulary,
    errors: &mut ErrorList,
) -> Vec<ScriptElement> {
    let root = document.root_element();
    let wanted = vocabulary.root.name;
    let mut elements = Vec::new();
    if root.tag_name().namespace().is_some() || root.tag_name().name() != wanted {
        let (name, title) = (root.tag_name().name(), vocabulary.title);
        let message = format!("<{name}> is not {title}; <{wanted} version=\"1\"> is expected");
        errors.add(name_range(&root), message, "");
        return elements;
    }
    let rate = root.attribute("fps").and_then(StageRate::parse).unwrap_or_default();
    // The stack is our own, so that no depth overflows that of the thread. The last entry is the next one.
    let mut open: Vec<(Node, Option<usize>)> = vec![(root, None)];
    while let Some((node, parent)) = open.pop() {
        let row = match parent {
            None => Some(vocabulary.root),
            Some(parent) => allowed(&node, vocabulary, &elements, parent, errors),
        };
        let Some(row) = row else { continue };
        let attributes = attributes(&node, row, rate, errors);
        let index = elements.len();
        elements.push(ScriptElement {
            row,
            parent,
            range: node.range(),
            name: name_range(&node),
            attributes,
            origin: ElementOrigin::Text,
        });
        for child in node.children() {
            if child.is_text() && child.text().is_some_and(|text| !text.trim().is_empty()) {
                errors.add(
                    child.range(),
                    format!("<{}> contains a text; only elements are expected", row.name),
                    "",
                );
            }
        }
        let first = open.len();
        open.extend(
            node.children()
                .filter(|child| child.is_element() && child.tag_name().namespace().is_none())
                .map(|child| (child, Some(index))),
        );
        open[first..].reverse();
    }
    elements
}

/// Returns the row of an element if it may be in its parent.
fn allowed(
    node: &Node,
    vocabulary: &Vocabulary,
    elements: &[ScriptElement],
    parent: usize,
    errors: &mut ErrorList,
) -> Option<&'static ElementRow> {
    let (name, above) = (node.tag_name().name(), elements.get(parent)?.row);
    let inside = vocabulary.children_of(above);
    if let Some(row) = inside.iter().find(|row| row.name == name) {
        return Some(row);
    }
    let names = || inside.iter().map(|row| row.name);
    let help = match (vocabulary.element(name), inside.is_empty()) {
        (Some(row), _) => format!("it belongs in {}", parents_of(row, vocabulary)),
        (None, true) => String::new(),
        (None, false) => suggestion(name, "elements", names()),
    };
    let message = match inside.is_empty() {
        true => format!("<{}> contains <{name}>; nothing is expected in it", above.name),
        false => format!("<{name}> is no element of <{}>", above.name),
    };
    errors.add(name_range(node), message, help);
    None
}

fn parents_of(row: &ElementRow, vocabulary: &Vocabulary) -> String {
    match row.group {
        ElementGroup::Script | ElementGroup::Project => "no other element".to_owned(),
        ElementGroup::Cast => format!("<{}>", vocabulary.root.name),
        ElementGroup::Thing => "<cast>".to_owned(),
        ElementGroup::Container | ElementGroup::Action => "<script>, <seq> or <par>".to_owned(),
        ElementGroup::Part => {
            let has = |above: &&&ElementRow| above.parts.iter().any(|part| part.name == row.name);
            let names: Vec<String> =
                vocabulary.elements.iter().filter(has).map(|above| format!("<{}>", above.name)).collect();
            names.join(", ")
        }
    }
}

/// Returns the attributes of an element that fit its row.
fn attributes(
    node: &Node,
    row: &'static ElementRow,
    rate: StageRate,
    errors: &mut ErrorList,
) -> Vec<ScriptAttribute> {
    let mut found = Vec::new();
    for attribute in node.attributes().filter(|attribute| attribute.namespace().is_none()) {
        let (name, value) = (attribute.name(), attribute.value());
        let Some(known) = row.attribute(name) else {
            let help = suggestion(name, "attributes", row.rows().map(|row| row.name));
            errors.add(
                attribute.range_qname(),
                format!("\"{name}\" is not an attribute of <{}>", row.name),
                help,
            );
            continue;
        };
        if !known.value.accepts(value, rate) {
            let help = match known.value.choices {
                [] => String::new(),
                choices => suggestion(value, "values", choices.iter().copied()),
            };
            let message = format!("{name}=\"{}\" is not {}", shortened(value), known.value.expected);
            errors.add(attribute.range_value(), message, help);
            continue;
        }
        found.push(ScriptAttribute {
            row: known,
            value: value.into(),
            range: attribute.range(),
            name: attribute.range_qname(),
            value_range: attribute.range_value(),
        });
    }
    let is_written = |name: &str| node.attribute(name).is_some();
    for missing in row.rows().filter(|row| row.required && !is_written(row.name)) {
        let message =
            format!("<{}> needs the attribute {}: {}", row.name, missing.name, missing.value.expected);
        errors.add(name_range(node), message, missing.help);
    }
    let given = row.one_of.iter().filter(|name| is_written(name)).count();
    if !row.one_of.is_empty() && given != 1 {
        let names = row.one_of.join(" or ");
        let message = match given {
            0 => format!("<{}> needs the attribute {names}", row.name),
            _ => format!("<{}> has more than one of the attributes {names}", row.name),
        };
        errors.add(name_range(node), message, "");
    }
    found
}

/// Returns the bytes of the name in the start tag.
fn name_range(node: &Node) -> Range<usize> {
    let start = node.range().start + 1;
    start..start + node.tag_name().name().len()
}

/// Returns a value that fits in a message.
fn shortened(value: &str) -> String {
    let mut letters = value.chars();
    let start: String = letters.by_ref().take(60).collect();
    if letters.next().is_some() { format!("{start}…") } else { start }
}
