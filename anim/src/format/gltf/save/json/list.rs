//! Adds and removes elements of arrays and members of objects, with their commas.

use super::patch::TextPatch;
use super::style::{JsonSpot, JsonStyle, gap, lead};
use super::tree::{Json, JsonKind, ValueId};

/// An edit of an array or object.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct ListEdit {
    /// Removed items, ascending.
    pub(in super::super) removed: Vec<ValueId>,
    /// New items with their texts, in order, each with the remaining item that it follows (`None`: at the start).
    pub(in super::super) inserted: Vec<(Option<ValueId>, String)>,
}

/// Returns the patches of the edit. Items that stay, and the space between them, keep their bytes.
pub(in super::super) fn edit(
    json: Json<'_>,
    list: ValueId,
    edit: &ListEdit,
    style: &JsonStyle,
    spot: &JsonSpot,
    pointer: &str,
) -> Vec<TextPatch> {
    let items: Vec<ValueId> = json.items(list).collect();
    let stays: Vec<bool> = items.iter().map(|item| edit.removed.binary_search(item).is_err()).collect();
    let fresh = style.gaps(spot);
    if !stays.contains(&true) {
        let inner = json.span(list).start + 1..json.span(list).end - 1;
        if edit.inserted.is_empty() && items.is_empty() {
            return Vec::new();
        }
        let between = gap(json, list).map_or_else(|| format!(",{}", fresh[1]), |gap| format!(",{gap}"));
        let texts: Vec<&str> = edit.inserted.iter().map(|(_, text)| text.as_str()).collect();
        let mut text = texts.join(&between);
        let span = match (items.first(), items.last()) {
            (Some(&first), Some(&last)) if !texts.is_empty() => {
                json.item_span(first).start..json.item_span(last).end
            }
            _ => {
                if !texts.is_empty() {
                    text = format!("{}{text}{}", fresh[0], fresh[2]);
                }
                inner
            }
        };
        return vec![TextPatch::new(span, text, pointer)];
    }
    let mut patches = removals(json, &items, &stays, pointer);
    let between = gap(json, list).unwrap_or_else(|| match lead(json, list) {
        Some(lead) if !lead.is_empty() => lead,
        _ => style.comma().to_owned(),
    });
    let first = items.iter().zip(&stays).find(|(_, stays)| **stays).map(|(item, _)| *item);
    // Elements that follow the same one become one patch. Each member of an object has its own, by which users see its name.
    let is_array = json.kind(list) == JsonKind::Array;
    for new in edit.inserted.chunk_by(|a, b| is_array && a.0 == b.0) {
        let at = match (new[0].0, first) {
            (None, Some(first)) => json.item_span(first).start,
            (Some(item), _) => json.item_span(item).end,
            (None, None) => continue,
        };
        let length = new.iter().map(|(_, text)| text.len() + between.len() + 1).sum();
        let mut text = String::with_capacity(length);
        for (after, item) in new {
            let parts = match after {
                Some(_) => [",", &between, item],
                None => [item, ",", &between],
            };
            text.extend(parts);
        }
        patches.push(TextPatch::new(at..at, text, pointer));
    }
    patches
}

/// Removes runs of items, each with its comma and space. At least one item stays.
fn removals(json: Json<'_>, items: &[ValueId], stays: &[bool], pointer: &str) -> Vec<TextPatch> {
    let mut patches = Vec::new();
    let mut at = 0;
    while at < items.len() {
        if stays[at] {
            at += 1;
            continue;
        }
        let end = (at..items.len()).find(|&other| stays[other]).unwrap_or(items.len());
        let span = match items.get(end) {
            Some(&next) => json.item_span(items[at]).start..json.item_span(next).start,
            None => json.item_span(items[at - 1]).end..json.item_span(items[end - 1]).end,
        };
        patches.push(TextPatch::new(span, "", pointer));
        at = end;
    }
    patches
}

#[cfg(test)]
mod tests {
    use super::super::patch::{patched, sort};
    use super::super::style::Fresh;
    use super::super::tree::Tree;
    use super::*;

    fn edited(text: &str, removed: &[usize], inserted: &[(Option<usize>, &str)]) -> String {
        let tree = Tree::read(text.as_bytes(), 0..text.len()).unwrap();
        let json = Json::new(text.as_bytes(), &tree);
        let items: Vec<ValueId> = json.items(0).collect();
        let change = ListEdit {
            removed: removed.iter().map(|&number| items[number]).collect(),
            inserted: inserted
                .iter()
                .map(|(at, text)| (at.map(|at| items[at]), (*text).to_owned()))
                .collect(),
        };
        let style = JsonStyle::of(json);
        let spot = style.spot(json, Some(0), 1);
        let mut patches = edit(json, 0, &change, &style, &spot, "");
        assert!(sort(&mut patches));
        String::from_utf8(patched(text.as_bytes(), 0..text.len(), &patches)).unwrap()
    }

    #[test]
    fn removed_items_take_their_commas_with_them() {
        let list = "[ 1 , 2,3\n]";
        assert_eq!(edited(list, &[0], &[]), "[ 2,3\n]");
        assert_eq!(edited(list, &[1], &[]), "[ 1 , 3\n]");
        assert_eq!(edited(list, &[2], &[]), "[ 1 , 2\n]");
        assert_eq!(edited(list, &[0, 1], &[]), "[ 3\n]");
        assert_eq!(edited(list, &[1, 2], &[]), "[ 1\n]");
        assert_eq!(edited(list, &[0, 1, 2], &[]), "[]");
        assert_eq!(edited("{\"a\":1, \"b\":2}", &[0], &[]), "{\"b\":2}");
    }

    #[test]
    fn new_items_have_the_spacing_of_their_neighbors() {
        assert_eq!(edited("[]", &[], &[(None, "1"), (None, "2")]), "[1,2]");
        assert_eq!(edited("[1]", &[], &[(Some(0), "2"), (Some(0), "3")]), "[1,2,3]");
        assert_eq!(edited("[1, 2]", &[], &[(Some(1), "3")]), "[1, 2, 3]");
        assert_eq!(edited("[1, 2]", &[], &[(None, "0")]), "[0, 1, 2]");
        assert_eq!(edited("[\n\t1\n]", &[], &[(Some(0), "2")]), "[\n\t1,\n\t2\n]");
        assert_eq!(edited("[1,2,3]", &[2], &[(Some(1), "4")]), "[1,2,4]");
        assert_eq!(edited("[1,2,3]", &[0], &[(None, "0")]), "[0,2,3]");
        assert_eq!(edited("[1, 2]", &[0, 1], &[(None, "3"), (None, "4")]), "[3, 4]");
        assert_eq!(
            edited("{\r\n  \"a\": 1\r\n}", &[], &[(Some(0), "\"b\": 2")]),
            "{\r\n  \"a\": 1,\r\n  \"b\": 2\r\n}"
        );
    }

    #[test]
    fn a_new_value_has_the_formatting_of_its_neighbors() {
        let written = |text: &str| {
            let tree = Tree::read(text.as_bytes(), 0..text.len()).unwrap();
            let json = Json::new(text.as_bytes(), &tree);
            let list = json.member(0, "list");
            let style = JsonStyle::of(json);
            let spot = style.spot(json, list, 2);
            let inner = Fresh::Object(vec![("d", Fresh::whole(3))]);
            let numbers = Fresh::Array(vec![Fresh::whole(1), Fresh::whole(2)]);
            style.write(&Fresh::Object(vec![("b", inner), ("c", numbers)]), &spot)
        };
        assert_eq!(written("{\"list\":[{\"a\":1}]}"), "{\"b\":{\"d\":3},\"c\":[1,2]}");
        assert_eq!(written("{\"list\": [{\"a\": 1, \"b\": 2}]}"), "{\"b\": {\"d\": 3}, \"c\": [1, 2]}");
        assert_eq!(
            written("{\n\t\"list\" : [\n\t\t{\n\t\t\t\"a\" : [1, 2]\n\t\t}\n\t]\n}"),
            "{\n\t\t\t\"b\" : {\n\t\t\t\t\"d\" : 3\n\t\t\t},\n\t\t\t\"c\" : [1, 2]\n\t\t}"
        );
        assert_eq!(
            written("{\r\n \"list\": [\r\n  {\"a\": 1}\r\n ]\r\n}"),
            "{\"b\": {\"d\": 3}, \"c\": [1, 2]}"
        );
        assert_eq!(
            written("{\n \"list\": []\n}"),
            "{\n   \"b\": {\n    \"d\": 3\n   },\n   \"c\": [1, 2]\n  }"
        );
    }
}
