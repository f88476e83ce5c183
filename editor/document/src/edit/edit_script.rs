//! Replaces parts of a text of the document: of the script of a scene, or of a project.

use super::kind::EditKind;
use super::map_references::MapReferences;
use super::reference_map::ReferenceMap;
use super::script_label::ScriptLabel;
use super::text_ref::TextRef;
use super::{Arbitrary, EditedBones, Example, Misfit, TakeRef};
use crate::adapter::op::Op;
use crate::adapter::plan::Transaction;
use crate::adapter::{EditError, ModelAdapter, TextEditError, TextFile, TextFiles};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::stage::script::MOST_BYTES;
use dragonfly_anim::stage::splice::{TextSplice, TextSplices};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Number of characters of a text that messages show.
const SHOWN: usize = 40;

/// Number of characters of a written text that the history shows.
const EXCERPT: usize = 24;

/// Replaces parts of a text of the document: of the script of a scene, or of a file of a project.
///
/// All places are those of the text before the edit. It is refused if the text differs from `old` at one of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EditScript {
    /// The text; the main file of the document if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<TextRef>,
    /// Whether the project gets a new text of that name, which is empty before the edit. Its file is written with the next save.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub create: bool,
    /// The replacements, which must not overlap, in any order; at least one.
    pub splices: Vec<ScriptSplice>,
    /// The name of the edit in the history, in a few words, such as `Move clip`; `Edit script` if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// Edits of other texts that belong to the same step; they come after this one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<EditScript>,
}

/// One replacement of a part of a text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScriptSplice {
    /// Byte of the text at which the old part begins, from 0. It must be the first byte of a character.
    pub at: usize,
    /// The part that is replaced, as it is now; empty if absent, for an insertion.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub old: String,
    /// The part that replaces it; empty if absent, for a deletion.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub new: String,
}

impl EditScript {
    /// Returns the edit that makes `splices` in `text`, which is the present text.
    pub fn of(text: &str, splices: &TextSplices, label: ScriptLabel) -> Self {
        Self { label: Some(label.text().to_owned()), ..Self::unnamed(text, splices) }
    }

    /// Returns the edit that makes `splices` in `text`, without a name of its own.
    fn unnamed(text: &str, splices: &TextSplices) -> Self {
        let splice = |splice: &TextSplice| ScriptSplice {
            at: splice.range.start,
            old: text.get(splice.range.clone()).unwrap_or_default().to_owned(),
            new: splice.text.clone(),
        };
        let splices = splices.list().iter().map(splice).collect();
        Self { text: None, create: false, splices, label: None, also: Vec::new() }
    }

    /// Returns the edit that leads from `old` to `new` by replacing one part, the shortest; `None` where they are the same.
    pub fn between(old: &str, new: &str, label: Option<ScriptLabel>) -> Option<Self> {
        let splices = TextSplices::new(vec![TextSplice::between(old, new)?])?;
        let label = label.map(|label| label.text().to_owned());
        Some(Self { label, ..Self::unnamed(old, &splices) })
    }

    /// Returns whether the user wrote it into the text.
    pub(crate) fn is_written(&self) -> bool {
        self.label.as_deref().and_then(ScriptLabel::of).is_some_and(ScriptLabel::is_writing)
    }

    /// Returns what was written or deleted, and the line: `“walk” in line 12`; `None` for other edits.
    fn writing(&self, adapter: &ModelAdapter) -> Option<String> {
        let splice = self.splices.first().filter(|_| self.is_written())?;
        let index = adapter.texts().find(self.text.as_ref()).ok()?;
        // The text before the first place is the same before and after the edit.
        let before = adapter.texts().list().get(index)?.text.get(..splice.at)?;
        let line = 1 + before.bytes().filter(|byte| *byte == b'\n').count();
        let text = if splice.new.is_empty() { &splice.old } else { &splice.new };
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        Some(match words.char_indices().nth(EXCERPT) {
            _ if words.is_empty() => format!("line {line}"),
            Some((end, _)) => format!("“{}…” in line {line}", &words[..end]),
            None => format!("“{words}” in line {line}"),
        })
    }

    /// Returns the edit as edits of one text each, in their order.
    pub(crate) fn parts(&self) -> impl Iterator<Item = Self> + '_ {
        std::iter::once(Self { also: Vec::new(), ..self.clone() }).chain(self.also.iter().cloned())
    }

    /// Applies it to texts to which it was applied before.
    pub(crate) fn apply_to(&self, texts: &mut TextFiles) {
        if let (true, Ok(created)) = (self.create, self.created_in(texts)) {
            *texts = created;
        } else if let Ok(index) = texts.find(self.text.as_ref())
            && let Some(Ok(splices)) = texts.list().get(index).map(|file| self.splices_in(file))
        {
            texts.splice(index, &splices);
        }
        self.also.iter().for_each(|other| other.apply_to(texts));
    }

    /// Returns the texts of a project with the new one.
    ///
    /// # Errors
    ///
    /// The reason why the document cannot get it.
    pub(crate) fn created_in(&self, texts: &TextFiles) -> Result<TextFiles, TextEditError> {
        let Some(TextRef::Name(name)) = &self.text else { return Err(TextEditError::NoName) };
        let reason = match crate::folder::checked(name) {
            Err(error) => Some(error.to_string()),
            Ok(_) if texts.is_empty() => Some("the document has no texts".to_owned()),
            Ok(_) if texts.called(name).is_some() => Some("the document has this text already".to_owned()),
            Ok(_) => None,
        };
        if let Some(reason) = reason {
            return Err(TextEditError::NotCreated { name: name.clone(), reason });
        }
        let empty = TextFile { name: name.as_str().into(), text: "".into() };
        let text = self.splices_in(&empty)?.apply("").into();
        Ok(texts.list().iter().cloned().chain([TextFile { text, ..empty }]).collect())
    }

    /// Returns the replacements, checked against the text.
    ///
    /// # Errors
    ///
    /// The reason why they do not fit it.
    pub fn splices_in(&self, file: &TextFile) -> Result<TextSplices, TextEditError> {
        let text = &file.text;
        let mut size = text.len();
        for splice in &self.splices {
            let fits = text.get(splice.at..).is_some_and(|rest| rest.starts_with(&splice.old));
            if !fits {
                let old = splice.old.chars().take(SHOWN).collect();
                return Err(TextEditError::OtherText { name: file.name.clone(), at: splice.at, old });
            }
            size += splice.new.len();
        }
        if self.splices.iter().all(|splice| splice.old == splice.new) {
            return Err(TextEditError::Nothing);
        }
        let splice = |splice: &ScriptSplice| TextSplice {
            range: splice.at..splice.at + splice.old.len(),
            text: splice.new.clone(),
        };
        let splices = TextSplices::new(self.splices.iter().map(splice).collect());
        let splices = splices.ok_or(TextEditError::Overlap)?;
        let size = size - self.splices.iter().map(|splice| splice.old.len()).sum::<usize>();
        // A text that was too large when it was opened may become smaller.
        if size > MOST_BYTES && size > text.len() { Err(TextEditError::TooLarge(size)) } else { Ok(splices) }
    }
}

impl MapReferences for EditScript {
    /// Places in a text are mapped by what merges the texts.
    fn mapped(&self, _map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        Ok(self.clone())
    }
}

impl EditKind for EditScript {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"script","splices":[{"at":212,"old":"Walk","new":"Run"}],"label":"Change value"}"#,
        description: "Replaces \"Walk\" at byte 212 of a scene's script by \"Run\"; \"text\" names another file of a project.",
    };

    fn label(&self) -> &'static str {
        self.label.as_deref().and_then(ScriptLabel::of).unwrap_or(ScriptLabel::EditScript).text()
    }

    fn take(&self) -> Option<&TakeRef> {
        None
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::Named(BTreeSet::new())
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let texts = work.adapter().texts();
        if self.create {
            let texts = self.created_in(texts)?;
            work.perform(Op::Texts(texts));
        } else {
            let index = texts.find(self.text.as_ref())?;
            let splices = self.splices_in(&texts.list()[index])?;
            work.perform(Op::Text(index, splices));
        }
        if self.also.iter().any(|other| !other.also.is_empty()) {
            return Err(TextEditError::Nested.into());
        }
        self.also.iter().try_for_each(|other| other.plan(work))
    }

    fn detail(&self, adapter: &ModelAdapter) -> Option<String> {
        // A label of another version of the program is still shown.
        let own = self.label.as_deref().filter(|own| ScriptLabel::of(own).is_none());
        let texts = adapter.texts().list();
        let file = adapter.texts().find(self.text.as_ref()).ok().filter(|_| texts.len() > 1);
        let file = file.and_then(|index| texts.get(index)).map(|file| &*file.name);
        let writing = self.writing(adapter);
        let parts: Vec<&str> = own.into_iter().chain(writing.as_deref()).chain(file).collect();
        (!parts.is_empty()).then(|| parts.join("  ·  ").chars().take(SHOWN).collect())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let splice = |from: &mut Arbitrary<'_>| ScriptSplice {
            at: from.below(12),
            old: String::new(),
            new: from.choice(["", "x", " speed=\"2\"", "<wait dur=\"1\"/>", "é"]).to_owned(),
        };
        let splices = (0..1 + from.below(3)).map(|_| splice(from)).collect();
        let text = from.optional(|from| TextRef::Index(from.below(2)));
        let label = from.optional(|from| from.choice(["Move clip", "Fly"]).to_owned());
        let create = from.below(4) == 0;
        let text = if create { Some(TextRef::Name(format!("new-{}.xml", from.below(3)))) } else { text };
        let first = Self { text, create, splices, label, also: Vec::new() };
        match from.below(4) {
            0 => Self { also: vec![first.clone()], ..first },
            _ => first,
        }
    }
}
