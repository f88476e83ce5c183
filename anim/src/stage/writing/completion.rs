//! Suggestions for the text at the cursor.

use super::cursor::{AfterName, CursorPlace, OpenTag, place};
use super::names::{NamedElement, named_elements};
use crate::stage::project::StageProject;
use crate::stage::splice::escaped;
use crate::stage::table::{
    ElementGroup, ElementRow, NameReference, PROPERTIES, SCRIPTS, Vocabulary, element,
};
use crate::stage::{StageModel, StagePlan};
use std::collections::HashSet;
use std::ops::Range;

/// What a suggestion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompletionKind {
    /// An element.
    Element,
    /// An attribute.
    Attribute,
    /// A word of the vocabulary.
    Word,
    /// A thing of the cast.
    Thing,
    /// A moment of an action.
    Moment,
    /// A take.
    Take,
    /// A bone.
    Bone,
    /// A file.
    File,
}

/// A suggestion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CompletionItem {
    /// What it is.
    pub kind: CompletionKind,
    /// The text in the list.
    pub label: String,
    /// The text to insert.
    pub insert: String,
    /// Bytes from the start of the inserted text to the cursor after it.
    pub cursor: usize,
    /// Its purpose, in one sentence; may be empty.
    pub help: String,
}

/// The suggestions at a cursor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completions {
    /// The bytes that a suggestion replaces.
    pub range: Range<usize>,
    /// The suggestions: those that begin with what is typed first, then those that contain it.
    pub items: Vec<CompletionItem>,
}

/// The kind of the text, and names that are not in it.
#[derive(Clone, Copy, Debug)]
pub struct CompletionNames<'a> {
    /// The kind of the text: a script or a project.
    pub vocabulary: &'static Vocabulary,
    /// The last plan that worked, for takes and bones.
    pub plan: Option<&'a StagePlan>,
    /// The project of the text, for the things that it shares.
    pub project: Option<&'a StageProject>,
    /// Names for models: files, and ids of a project.
    pub models: &'a [&'a str],
    /// Names of drawn lines.
    pub lines: &'a [&'a str],
    /// Files of sounds.
    pub sounds: &'a [&'a str],
    /// Files of other scripts.
    pub scripts: &'a [&'a str],
}

impl Default for CompletionNames<'_> {
    fn default() -> Self {
        Self {
            vocabulary: &SCRIPTS,
            plan: None,
            project: None,
            models: &[],
            lines: &[],
            sounds: &[],
            scripts: &[],
        }
    }
}

/// Returns what may be written at byte `at` of a text; `None` where nothing is suggested.
pub fn completions(text: &str, at: usize, names: &CompletionNames<'_>) -> Option<Completions> {
    let (range, items) = match place(text, at)? {
        CursorPlace::Element { name, continues, around } => {
            (name, elements(names.vocabulary, around, continues))
        }
        CursorPlace::End { name, around } => {
            (name, vec![item(CompletionKind::Element, around, format!("{around}>"), "End of the element")])
        }
        CursorPlace::Attribute { name, next, tag } => (name, attributes(names.vocabulary, &tag, next)),
        CursorPlace::Value { typed, whole, attribute, tag } => {
            let value = text.get(typed.clone())?;
            // Lists of names are completed name by name.
            let start = if attribute == "bones" { value.rfind(',').map_or(0, |comma| comma + 1) } else { 0 };
            let end = if attribute == "bones" { typed.end } else { whole.end };
            (typed.start + start..end, values(&tag, attribute, text, names))
        }
    };
    let typed = text.get(range.start..at)?.trim_start().to_lowercase();
    let starts = |item: &CompletionItem| item.label.to_lowercase().starts_with(&typed);
    let contains = |item: &CompletionItem| item.label.to_lowercase().contains(&typed);
    let (mut first, rest): (Vec<_>, Vec<_>) = items.into_iter().partition(starts);
    first.extend(rest.into_iter().filter(contains));
    // A word that is complete needs no list.
    let is_done = first.len() == 1 && text.get(range.clone()) == Some(first[0].insert.as_str());
    (!first.is_empty() && !is_done).then_some(Completions { range, items: first })
}

fn item(kind: CompletionKind, label: &str, insert: String, help: &str) -> CompletionItem {
    CompletionItem { kind, label: label.to_owned(), cursor: insert.len(), insert, help: help.to_owned() }
}

/// Returns a value as it is written between quotes of either kind.
fn word(kind: CompletionKind, word: &str, help: &str) -> CompletionItem {
    item(kind, word, escaped(word, '"').replace('\'', "&apos;"), help)
}

/// Returns the elements that may be in another one; only their names for a tag that `continues`.
fn elements(vocabulary: &Vocabulary, around: Option<&str>, continues: bool) -> Vec<CompletionItem> {
    let rows: Vec<&ElementRow> = match around {
        Some(around) => vocabulary.element(around).map_or(Vec::new(), |row| vocabulary.children_of(row)),
        None => vec![vocabulary.root],
    };
    let inserted = |row: &&ElementRow| {
        if continues {
            return item(CompletionKind::Element, row.name, row.name.to_owned(), row.help);
        }
        let required = row.rows().filter(|attribute| attribute.required);
        let attributes: String = required.map(|attribute| format!(" {}=\"\"", attribute.name)).collect();
        let is_container = match row.group {
            ElementGroup::Script | ElementGroup::Cast | ElementGroup::Container | ElementGroup::Project => {
                true
            }
            ElementGroup::Part => !row.parts.is_empty(),
            ElementGroup::Thing | ElementGroup::Action => false,
        };
        let end = if is_container { format!("></{}>", row.name) } else { "/>".to_owned() };
        let insert = format!("{}{attributes}{end}", row.name);
        // Into the first value, else between the tags.
        let cursor = insert
            .find("\"\"")
            .map(|quotes| quotes + 1)
            .or_else(|| insert.find("></").map(|close| close + 1));
        CompletionItem {
            kind: CompletionKind::Element,
            label: row.name.to_owned(),
            cursor: cursor.unwrap_or(row.name.len()),
            insert,
            help: row.help.to_owned(),
        }
    };
    rows.iter().map(inserted).collect()
}

fn attributes(vocabulary: &Vocabulary, tag: &OpenTag<'_>, next: AfterName) -> Vec<CompletionItem> {
    let Some(row) = tag.row(vocabulary) else { return Vec::new() };
    let is_excluded =
        |name: &str| row.one_of.contains(&name) && row.one_of.iter().any(|other| tag.value(other).is_some());
    let mut rows: Vec<_> = row
        .rows()
        .filter(|attribute| tag.value(attribute.name).is_none() && !is_excluded(attribute.name))
        .collect();
    rows.sort_by_key(|attribute| !(attribute.required || row.one_of.contains(&attribute.name)));
    rows.into_iter()
        .map(|attribute| {
            let name = attribute.name;
            let (insert, cursor) = match next {
                AfterName::Sign => (name.to_owned(), name.len()),
                AfterName::Name => (format!("{name}=\"\" "), name.len() + 2),
                AfterName::Gap => (format!("{name}=\"\""), name.len() + 2),
            };
            CompletionItem { cursor, ..item(CompletionKind::Attribute, name, insert, attribute.help) }
        })
        .collect()
}

fn values(
    tag: &OpenTag<'_>,
    attribute: &str,
    text: &str,
    names: &CompletionNames<'_>,
) -> Vec<CompletionItem> {
    let Some((element, row)) =
        tag.row(names.vocabulary).and_then(|row| Some((row, row.attribute(attribute)?)))
    else {
        return Vec::new();
    };
    if !row.value.choices.is_empty() {
        return row.value.choices.iter().map(|choice| word(CompletionKind::Word, choice, row.help)).collect();
    }
    let mut ids = named_elements(text);
    // Of a project the text does not have all things.
    let written: HashSet<&str> = ids.iter().map(|named| named.id).collect();
    let shared = names.project.into_iter().flat_map(StageProject::things);
    let shared = shared.filter(|(_, id)| !written.contains(id));
    ids.extend(shared.map(|(kind, id)| NamedElement { kind, id, points: Vec::new() }));
    let model = |who: Option<&str>| model_of(names.plan, who);
    match attribute {
        "who" => things(&ids, |kind| element.who.contains(&kind)),
        "path" => things(&ids, |kind| kind == "path"),
        "take" => takes(model(tag.value("who"))),
        "bones" => bones(model(tag.value("who")), ""),
        "property" => properties(&ids, tag.value("who")),
        "model" => {
            let mut found = named(&ids, "model");
            found.extend(
                files(names.models)
                    .into_iter()
                    .filter(|file| !ids.iter().any(|named| named.id == file.label)),
            );
            found
        }
        "line" => files(names.lines),
        "src" => match element.name {
            "sound" => files(names.sounds),
            "include" | "script" => files(names.scripts),
            "model" => files(names.models),
            _ => Vec::new(),
        },
        "of" => named(&ids, "model"),
        "script" => named(&ids, "script"),
        "repeat" => vec![word(CompletionKind::Word, "fill", "For as long as there is time")],
        _ => match row.reference() {
            Some(NameReference::Moment) => moments(&ids),
            // The value of a property is no position.
            Some(NameReference::Spot) if element.attribute("property").is_none() => spots(&ids, names.plan),
            Some(NameReference::Spot | NameReference::Name) | None => Vec::new(),
        },
    }
}

fn files(names: &[&str]) -> Vec<CompletionItem> {
    names.iter().map(|file| word(CompletionKind::File, file, "")).collect()
}

/// Returns the ids of the elements of one name.
fn named(ids: &[NamedElement<'_>], kind: &str) -> Vec<CompletionItem> {
    let of_kind = ids.iter().filter(|named| named.kind == kind);
    of_kind.map(|named| word(CompletionKind::Word, named.id, kind)).collect()
}

fn is_thing(kind: &str) -> bool {
    element(kind).is_some_and(|row| row.group == ElementGroup::Thing)
}

fn things(ids: &[NamedElement<'_>], is_one: impl Fn(&str) -> bool) -> Vec<CompletionItem> {
    ids.iter()
        .filter(|named| is_thing(named.kind) && is_one(named.kind))
        .map(|named| word(CompletionKind::Thing, named.id, named.kind))
        .collect()
}

fn moments(ids: &[NamedElement<'_>]) -> Vec<CompletionItem> {
    let actions = ids.iter().filter(|named| !is_thing(named.kind));
    let before =
        ["prev.begin", "prev.end"].map(|moment| word(CompletionKind::Moment, moment, "Of the action before"));
    actions
        .flat_map(|named| {
            let points = named.points.iter().copied().chain(["begin", "end"]);
            points.map(|point| word(CompletionKind::Moment, &format!("{}.{point}", named.id), named.kind))
        })
        .chain(before)
        .collect()
}

fn spots(ids: &[NamedElement<'_>], plan: Option<&StagePlan>) -> Vec<CompletionItem> {
    let mut found = things(ids, |kind| kind != "path");
    for named in ids.iter().filter(|named| matches!(named.kind, "role" | "prop")) {
        found.extend(bones(model_of(plan, Some(named.id)), &format!("{}.", named.id)));
    }
    found
}

fn properties(ids: &[NamedElement<'_>], who: Option<&str>) -> Vec<CompletionItem> {
    let kind = ids.iter().find(|named| Some(named.id) == who).map(|named| named.kind);
    let rows = PROPERTIES.iter().filter(|row| kind.is_none_or(|kind| row.thing == kind));
    rows.map(|row| word(CompletionKind::Word, row.name, &format!("Of a {}", row.thing))).collect()
}

fn model_of<'a>(plan: Option<&'a StagePlan>, who: Option<&str>) -> Option<&'a StageModel> {
    let plan = plan?;
    plan.things().get(plan.thing_called(who?)?)?.model.as_deref()
}

fn takes(model: Option<&StageModel>) -> Vec<CompletionItem> {
    let takes = model.map_or(&[][..], StageModel::takes);
    let help = |seconds: f64| format!("{seconds:.2} s");
    takes.iter().map(|take| word(CompletionKind::Take, take.name(), &help(take.length().seconds()))).collect()
}

fn bones(model: Option<&StageModel>, prefix: &str) -> Vec<CompletionItem> {
    let bones = model.map_or(&[][..], |model| &model.skeleton().bones);
    let named = bones.iter().filter(|bone| !bone.name.is_empty());
    named.map(|bone| word(CompletionKind::Bone, &format!("{prefix}{}", bone.name), "")).collect()
}
