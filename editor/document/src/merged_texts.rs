//! Edits of the texts of an old version of a document, moved to the texts of a new one.

use super::adapter::TextFiles;
use super::edit::{EditScript, Misfit, ScriptSplice, TextRef};
use super::text_merge::TextMerge;
use dragonfly_anim::stage::splice::{TextSplice, TextSplices};

/// For each text of the old version where it differs from that of the new one, and which one that is.
#[derive(Clone, Debug, Default)]
pub(super) struct MergedTexts(Vec<Option<(usize, TextMerge)>>);

impl MergedTexts {
    /// Pairs the main texts, and the others by their names.
    pub(super) fn between(old: &TextFiles, new: &TextFiles) -> Self {
        let pair = |(index, file): (usize, &super::adapter::TextFile)| {
            let other = match index {
                0 => 0,
                _ => new.list().iter().position(|other| other.name == file.name)?,
            };
            let merge = TextMerge::between(&file.text, &new.list().get(other)?.text);
            Some((other, merge))
        };
        Self(old.list().iter().enumerate().map(pair).collect())
    }

    /// Returns the part of an edit for the new texts; `None` where they have the same change already. `after` are the old texts after it.
    /// The new texts must get what is returned, or be merged by [`Self::lost`] instead.
    ///
    /// # Errors
    ///
    /// The reason why it does not fit.
    pub(super) fn mapped(
        &mut self,
        edit: &EditScript,
        before: &TextFiles,
        after: &TextFiles,
        new: &TextFiles,
    ) -> Result<Option<EditScript>, Misfit> {
        if edit.create {
            let is_there = after.list().last().is_some_and(|file| new.called(&file.name).is_some());
            if is_there {
                // It has other contents, so that later edits of it do not fit either.
                self.0.push(None);
                return Err(Misfit::TextIsThere);
            }
            self.0.push(Some((new.list().len(), TextMerge::default())));
            return Ok(Some(edit.clone()));
        }
        let (index, splices) = place_of(edit, before)?;
        let file = &before.list()[index];
        let missing = || Misfit::NoText(file.name.to_string());
        let (other, merge) = self.0.get_mut(index).and_then(Option::as_mut).ok_or_else(missing)?;
        let (Some(old_after), Some(new)) = (after.list().get(index), new.list().get(*other)) else {
            return Err(missing());
        };
        match merge.mapped(&splices) {
            Ok(mapped) => {
                merge.follow(&splices);
                let text = (*other > 0).then_some(TextRef::Index(*other));
                // The edit keeps its own old text: if the new text differs there, the edit is refused.
                let moved = |(old, new): (&TextSplice, &TextSplice)| ScriptSplice {
                    at: new.range.start,
                    old: file.text[old.range.clone()].to_owned(),
                    new: new.text.clone(),
                };
                let splices = splices.list().iter().zip(mapped.list()).map(moved).collect();
                let label = edit.label.clone();
                Ok(Some(EditScript { text, create: false, splices, label, also: Vec::new() }))
            }
            Err(at) => {
                let line = file.text[..at].lines().count().max(1);
                let is_there = merge.diverge(&splices, &old_after.text, &new.text);
                if is_there { Ok(None) } else { Err(Misfit::OtherText { text: file.name.to_string(), line }) }
            }
        }
    }

    /// Follows a part of an edit that the new texts do not get; `after` are the old texts after it.
    pub(super) fn lost(&mut self, edit: &EditScript, before: &TextFiles, after: &TextFiles, new: &TextFiles) {
        if edit.create {
            return self.0.push(None);
        }
        let Ok((index, splices)) = place_of(edit, before) else { return };
        let Some((other, merge)) = self.0.get_mut(index).and_then(Option::as_mut) else { return };
        if let (Some(old_after), Some(new)) = (after.list().get(index), new.list().get(*other)) {
            merge.diverge(&splices, &old_after.text, &new.text);
        }
    }
}

/// Returns the text that a part of an edit changes, and its replacements there.
fn place_of(edit: &EditScript, texts: &TextFiles) -> Result<(usize, TextSplices), Misfit> {
    let refused = |error| Misfit::Refused(super::adapter::EditError::Text(error));
    let index = texts.find(edit.text.as_ref()).map_err(refused)?;
    let splices = edit.splices_in(&texts.list()[index]).map_err(refused)?;
    Ok((index, splices))
}
