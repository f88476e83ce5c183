//! Formatting of a JSON text, so that new values are formatted the same way.
//!
//! Indentation, line ends, the space around colons and after commas are taken from the neighbors of a new value; if it
//! has none, from the rest of the document.

use super::tree::{Json, JsonKind, ValueId};

/// A value to be written.
pub(in super::super) enum Fresh<'a> {
    /// A token as it is.
    Raw(String),
    Object(Vec<(&'a str, Fresh<'a>)>),
    Array(Vec<Fresh<'a>>),
    /// An array of that many objects or arrays. Each is made when it is written, so that hundreds of thousands need no memory.
    Items(usize, Box<dyn Fn(usize) -> Fresh<'a> + 'a>),
}

impl Fresh<'_> {
    /// Returns a whole number.
    pub(in super::super) fn whole(number: usize) -> Self {
        Self::Raw(number.to_string())
    }

    /// Returns a string.
    pub(in super::super) fn string(text: &str) -> Self {
        Self::Raw(super::token::quoted(text))
    }
}

/// Line ends and indentation of a document that uses them.
#[derive(Clone, Debug, PartialEq)]
struct Lines {
    newline: String,
    unit: String,
}

/// Formatting of a document.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct JsonStyle {
    lines: Option<Lines>,
    colon: String,
    comma: String,
    numbers_on_one_line: bool,
}

/// Position of a new value: its indentation, and whether it and its content are on several lines.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct JsonSpot {
    indent: String,
    several_lines: bool,
    inner_lines: bool,
}

impl JsonSpot {
    /// Returns the same position for a value that is on several lines if the document uses lines.
    pub(in super::super) fn with_lines(self, style: &JsonStyle) -> Self {
        let several = style.lines.is_some();
        Self { several_lines: several, inner_lines: several, ..self }
    }
}

impl JsonStyle {
    /// Returns the style of a document.
    pub(in super::super) fn of(json: Json<'_>) -> Self {
        let first = json.items(0).next();
        let colon = first.and_then(|id| json.colon(id)).map_or(":".to_owned(), text);
        let lines = lead(json, 0).and_then(|lead| {
            let end = lead.rfind('\n')? + 1;
            let newline = if lead[..end].ends_with("\r\n") { "\r\n" } else { "\n" };
            Some(Lines { newline: newline.to_owned(), unit: lead[end..].to_owned() })
        });
        let mut style = Self { lines, colon, comma: String::new(), numbers_on_one_line: true };
        let gap_on_one_line = |id| gap(json, id).filter(|gap| !gap.contains('\n'));
        let spaced = || if style.colon.ends_with(' ') { " ".to_owned() } else { String::new() };
        style.comma = (0..json.len()).find_map(gap_on_one_line).unwrap_or_else(spaced);
        let numbers = (0..json.len()).find(|&id| {
            json.kind(id) == JsonKind::Array
                && json.items(id).next().is_some_and(|id| json.kind(id) == JsonKind::Number)
        });
        if let Some(lead) = numbers.and_then(|id| lead(json, id)) {
            style.numbers_on_one_line = !lead.contains('\n');
        }
        style
    }

    /// Returns the position of a new item of the array or object `list`, inside `depth` arrays and objects (the items
    /// of the root: 1).
    pub(in super::super) fn spot(&self, json: Json<'_>, list: Option<ValueId>, depth: usize) -> JsonSpot {
        let unit = self.lines.as_ref().map_or("", |lines| &lines.unit);
        let several = self.lines.is_some();
        let mut spot = JsonSpot { indent: unit.repeat(depth), several_lines: several, inner_lines: several };
        let Some(list) = list else { return spot };
        if let Some(between) = gap(json, list).or_else(|| lead(json, list))
            && let Some(end) = between.rfind('\n')
        {
            spot.indent = between[end + 1..].to_owned();
        }
        let Some(neighbor) = json.items(list).last() else { return spot };
        if let Some(lead) = lead(json, neighbor) {
            spot.several_lines = several && lead.contains('\n');
            let inner = json.items(neighbor).find(|&id| json.kind(id) == JsonKind::Object);
            let inner = inner.and_then(|id| self::lead(json, id));
            spot.inner_lines = spot.several_lines && inner.is_none_or(|lead| lead.contains('\n'));
        }
        spot
    }

    /// Returns the text of a value at a position.
    pub(in super::super) fn write(&self, value: &Fresh<'_>, spot: &JsonSpot) -> String {
        let mut out = String::new();
        self.put(value, &spot.indent, spot.several_lines, spot.inner_lines, &mut out);
        out
    }

    /// Returns the text of a member at a position.
    pub(in super::super) fn member(&self, name: &str, value: &Fresh<'_>, spot: &JsonSpot) -> String {
        format!("\"{name}\"{}{}", self.colon, self.write(value, spot))
    }

    /// Returns the text before the first of new items at a position, between them, and before the closing bracket.
    pub(in super::super) fn gaps(&self, spot: &JsonSpot) -> [String; 3] {
        match &self.lines {
            Some(lines) => {
                let outer = spot.indent.strip_suffix(&lines.unit).unwrap_or("");
                let inner = format!("{}{}", lines.newline, spot.indent);
                [inner.clone(), inner, format!("{}{outer}", lines.newline)]
            }
            None => [String::new(), self.comma.clone(), String::new()],
        }
    }

    /// Returns the text after a comma between items on one line.
    pub(in super::super) fn comma(&self) -> &str {
        &self.comma
    }

    fn put(&self, value: &Fresh<'_>, indent: &str, several: bool, inner: bool, out: &mut String) {
        let (brackets, count) = match value {
            Fresh::Raw(token) => return out.push_str(token),
            Fresh::Object(members) => (['{', '}'], members.len()),
            Fresh::Array(items) => (['[', ']'], items.len()),
            Fresh::Items(count, _) => (['[', ']'], *count),
        };
        let is_numbers =
            matches!(value, Fresh::Array(items) if items.iter().all(|i| matches!(i, Fresh::Raw(_))));
        let lines = self.lines.as_ref().filter(|_| several && !(is_numbers && self.numbers_on_one_line));
        let deeper = lines.map(|lines| format!("{indent}{}", lines.unit)).unwrap_or_default();
        out.push(brackets[0]);
        for number in 0..count {
            if number > 0 {
                out.push(',');
            }
            match lines {
                Some(lines) => out.extend([&lines.newline, &deeper].map(String::as_str)),
                None if number > 0 => out.push_str(&self.comma),
                None => {}
            }
            match value {
                Fresh::Object(members) => {
                    let (name, value) = &members[number];
                    out.push_str(&super::token::quoted(name));
                    out.push_str(&self.colon);
                    self.put(value, &deeper, inner, inner, out);
                }
                Fresh::Array(items) => self.put(&items[number], &deeper, inner, inner, out),
                Fresh::Items(_, item) => self.put(&item(number), &deeper, inner, inner, out),
                Fresh::Raw(_) => {}
            }
        }
        if let Some(lines) = lines
            && count > 0
        {
            out.extend([&lines.newline, indent]);
        }
        out.push(brackets[1]);
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Returns the space between the opening bracket and the first item; `None` if there is no item.
pub(super) fn lead(json: Json<'_>, list: ValueId) -> Option<String> {
    if !matches!(json.kind(list), JsonKind::Array | JsonKind::Object) {
        return None;
    }
    let first = json.items(list).next()?;
    Some(text(&json.file[json.span(list).start + 1..json.item_span(first).start]))
}

/// Returns the space between the last comma and the last item; `None` if there are less than two items.
pub(super) fn gap(json: Json<'_>, list: ValueId) -> Option<String> {
    if !matches!(json.kind(list), JsonKind::Array | JsonKind::Object) {
        return None;
    }
    let mut items = json.items(list);
    let mut before = items.next()?;
    let mut last = items.next()?;
    for item in items {
        (before, last) = (last, item);
    }
    let between = &json.file[json.item_span(before).end..json.item_span(last).start];
    let comma = between.iter().position(|&byte| byte == b',')?;
    Some(text(&between[comma + 1..]))
}
