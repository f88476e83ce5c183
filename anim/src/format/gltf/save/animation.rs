//! Edit of one animation: which channels are removed, which samplers are rewritten, which are new.

use super::channels::{Action, ChannelEdit};
use super::document::{ChannelTarget, FileAnimation, SourceDocument};
use super::error::SaveError;
use super::extras;
use super::json::list::{ListEdit, edit};
use super::json::patch::TextPatch;
use super::json::style::{Fresh, JsonStyle};
use super::json::token::quoted;
use super::json::tree::{JsonKind, ValueId};
use super::needs::{NeedId, Needs};
use crate::data::TakeExtras;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// The key times or the values of a sampler.
#[derive(Clone, Copy, Debug)]
pub(super) enum SamplerNumbers {
    /// An existing accessor that contains them.
    Kept(usize),
    Needed(NeedId),
}

impl SamplerNumbers {
    /// Returns the accessor that contains the numbers. `accessors` contains the accessor assigned to each [`NeedId`].
    fn accessor(self, accessors: &[usize]) -> usize {
        match self {
            Self::Kept(accessor) => accessor,
            Self::Needed(need) => accessors[need],
        }
    }
}

/// A sampler to be written.
#[derive(Clone, Debug)]
pub(super) struct SamplerDraft {
    /// Number of the sampler in the animation; new ones start at the number of existing samplers.
    pub(super) number: usize,
    pub(super) input: SamplerNumbers,
    pub(super) output: SamplerNumbers,
    interpolation: &'static str,
}

/// A channel that gets a sampler.
#[derive(Clone, Debug)]
enum ChannelDraft {
    /// An existing channel, by number, that refers to another sampler now.
    Moved(usize, usize),
    New(ChannelTarget, usize),
}

/// An edited animation.
#[derive(Debug, Default)]
pub(super) struct Draft {
    /// New name, if it changes.
    pub(super) name: Option<String>,
    /// New extras, if they change.
    pub(super) extras: Option<TakeExtras>,
    removed: Vec<ValueId>,
    channels: Vec<ChannelDraft>,
    pub(super) samplers: Vec<SamplerDraft>,
}

impl Draft {
    /// Returns the targets of the new channels.
    pub(super) fn new_targets(&self) -> impl Iterator<Item = ChannelTarget> + '_ {
        self.channels.iter().filter_map(|channel| match channel {
            ChannelDraft::New(target, _) => Some(*target),
            ChannelDraft::Moved(..) => None,
        })
    }

    /// Returns the samplers of the animation that are overwritten.
    pub(super) fn rewritten(&self) -> HashSet<usize> {
        self.samplers.iter().map(|sampler| sampler.number).collect()
    }

    /// Returns the draft that applies `edits` to `animation`, or to an empty one. `is_ours` returns whether an earlier
    /// save wrote an accessor.
    pub(super) fn of(
        document: &SourceDocument<'_>,
        animation: Option<&FileAnimation>,
        edits: &[ChannelEdit],
        name: Option<String>,
        is_ours: &dyn Fn(usize) -> bool,
        needs: &mut Needs,
    ) -> Self {
        let mut draft = Self { name, ..Self::default() };
        let Some(animation) = animation else {
            for (number, channel) in edits.iter().enumerate() {
                let Action::Set(keys) = &channel.action else { continue };
                let input = SamplerNumbers::Needed(needs.input(&keys.times, None));
                let output = SamplerNumbers::Needed(needs.output(keys, None));
                draft.samplers.push(SamplerDraft {
                    number,
                    input,
                    output,
                    interpolation: keys.interpolation,
                });
                draft.channels.push(ChannelDraft::New(channel.target, number));
            }
            return draft;
        };
        let removed: HashSet<ChannelTarget> =
            edits.iter().filter(|e| matches!(e.action, Action::Remove)).map(|e| e.target).collect();
        let goes = |target: Option<ChannelTarget>| target.is_some_and(|target| removed.contains(&target));
        draft.removed = animation.channels.iter().filter(|c| goes(c.target)).map(|c| c.id).collect();
        let mut pool = Pool::of(document, animation, &draft.removed, is_ours);
        for channel in edits {
            let Action::Set(keys) = &channel.action else { continue };
            let there = animation.channel(channel.target);
            let old = there.and_then(|there| animation.channels[there].sampler);
            let before = |name| old.and_then(|old| pool.accessor(document, animation, old, name));
            let kept = before("input").filter(|&input| document.holds_times(input, &keys.times));
            // If only the times or the interpolation change, the file keeps its own values.
            let in_order =
                |times: &Arc<[f32]>| before("input").is_some_and(|old| document.holds_times(old, times));
            let values = before("output").filter(|_| channel.values_of.as_ref().is_some_and(in_order));
            let number = match old.filter(|&old| pool.is_alone(old)) {
                Some(own) => own,
                None => {
                    if let Some(old) = old {
                        pool.leave(old);
                    }
                    pool.another()
                }
            };
            let before = |name| pool.accessor(document, animation, number, name);
            let input = match kept {
                Some(kept) => SamplerNumbers::Kept(kept),
                None => SamplerNumbers::Needed(needs.input(&keys.times, before("input"))),
            };
            let output = match values {
                Some(values) => SamplerNumbers::Kept(values),
                None => SamplerNumbers::Needed(needs.output(keys, before("output"))),
            };
            draft.samplers.push(SamplerDraft { number, input, output, interpolation: keys.interpolation });
            match there {
                Some(there) if old != Some(number) => draft.channels.push(ChannelDraft::Moved(there, number)),
                Some(_) => {}
                None => draft.channels.push(ChannelDraft::New(channel.target, number)),
            }
        }
        draft
    }

    /// Returns the patches to the text of `animation`. `accessors` contains the accessor assigned to each [`NeedId`].
    pub(super) fn patches(
        &self,
        document: &SourceDocument<'_>,
        animation: &FileAnimation,
        accessors: &[usize],
        style: &JsonStyle,
        pointer: &str,
    ) -> Result<Vec<TextPatch>, SaveError> {
        let json = document.json;
        let mut patches = Vec::new();
        let list = |name: &str| match json.member(animation.id, name) {
            Some(list) if json.kind(list) == JsonKind::Array => Ok(list),
            _ => Err(SaveError::File {
                place: format!("{pointer}/{name}"),
                reason: "the animation has no such list".to_owned(),
            }),
        };
        // Collects the new members of the animation object itself, such as its name.
        let mut members = ListEdit::default();
        let spot = style.spot(json, Some(animation.id), 3);
        if let Some(name) = &self.name {
            match json.member(animation.id, "name") {
                Some(old) => {
                    patches.push(TextPatch::new(json.span(old), quoted(name), format!("{pointer}/name")))
                }
                None => members.inserted.push((None, style.member("name", &Fresh::string(name), &spot))),
            }
        }
        if let Some(new) = &self.extras {
            patches.extend(extras::patch(document, animation.id, new, &mut members, style, pointer));
        }
        patches.extend(edit(json, animation.id, &members, style, &spot, &format!("{pointer}/name")));
        if !self.removed.is_empty() || !self.channels.is_empty() {
            let id = list("channels")?;
            let spot = style.spot(json, Some(id), 4);
            let mut change = ListEdit { removed: self.removed.clone(), inserted: Vec::new() };
            let last = json.items(id).filter(|item| self.removed.binary_search(item).is_err()).last();
            for channel in &self.channels {
                match channel {
                    ChannelDraft::Moved(number, sampler) => {
                        let pointer = format!("{pointer}/channels/{number}/sampler");
                        let id = animation.channels[*number].id;
                        let token = json.member(id, "sampler").ok_or_else(|| SaveError::File {
                            place: pointer.clone(),
                            reason: "the channel has no sampler".to_owned(),
                        })?;
                        patches.push(TextPatch::new(json.span(token), sampler.to_string(), pointer));
                    }
                    ChannelDraft::New(target, sampler) => {
                        let fresh = fresh_channel(*target, *sampler);
                        change.inserted.push((last, style.write(&fresh, &spot)));
                    }
                }
            }
            patches.extend(edit(json, id, &change, style, &spot, &format!("{pointer}/channels")));
        }
        if !self.samplers.is_empty() {
            let id = list("samplers")?;
            let spot = style.spot(json, Some(id), 4);
            let mut change = ListEdit::default();
            let last = animation.samplers.last().copied();
            for sampler in &self.samplers {
                let (input, output) = sampler.accessors(accessors);
                match animation.samplers.get(sampler.number) {
                    Some(&old) => {
                        let pointer = format!("{pointer}/samplers/{}", sampler.number);
                        patches.extend(sampler.rewritten(document, old, input, output, style, &pointer));
                    }
                    None => {
                        let fresh = sampler.fresh(input, output);
                        change.inserted.push((last, style.write(&fresh, &spot)));
                    }
                }
            }
            patches.extend(edit(json, id, &change, style, &spot, &format!("{pointer}/samplers")));
        }
        Ok(patches)
    }

    /// Returns the JSON value of a new animation.
    pub(super) fn fresh<'f>(&'f self, accessors: &'f [usize]) -> Fresh<'f> {
        let mut members = Vec::new();
        if let Some(name) = self.name.as_ref().filter(|name| !name.is_empty()) {
            members.push(("name", Fresh::string(name)));
        }
        if let Some(extras) = self.extras.as_ref().filter(|extras| !extras.is_empty()) {
            members.push(("extras", extras::fresh(extras)));
        }
        let new = self.channels.iter().filter_map(|channel| match channel {
            ChannelDraft::New(target, sampler) => Some((*target, *sampler)),
            ChannelDraft::Moved(..) => None,
        });
        let new: Vec<(ChannelTarget, usize)> = new.collect();
        let count = new.len();
        let channel = move |number: usize| fresh_channel(new[number].0, new[number].1);
        members.push(("channels", Fresh::Items(count, Box::new(channel))));
        let sampler = move |number: usize| {
            let sampler = &self.samplers[number];
            let (input, output) = sampler.accessors(accessors);
            sampler.fresh(input, output)
        };
        members.push(("samplers", Fresh::Items(self.samplers.len(), Box::new(sampler))));
        Fresh::Object(members)
    }
}

fn fresh_channel<'f>((node, path): ChannelTarget, sampler: usize) -> Fresh<'f> {
    let target = vec![("node", Fresh::whole(node as usize)), ("path", Fresh::string(path.name()))];
    Fresh::Object(vec![("sampler", Fresh::whole(sampler)), ("target", Fresh::Object(target))])
}

impl SamplerDraft {
    /// Returns the input and the output accessor. `accessors` contains the accessor assigned to each [`NeedId`].
    fn accessors(&self, accessors: &[usize]) -> (usize, usize) {
        (self.input.accessor(accessors), self.output.accessor(accessors))
    }

    fn fresh<'f>(&self, input: usize, output: usize) -> Fresh<'f> {
        let mut members = vec![("input", Fresh::whole(input)), ("output", Fresh::whole(output))];
        if self.interpolation != "LINEAR" {
            members.insert(1, ("interpolation", Fresh::string(self.interpolation)));
        }
        Fresh::Object(members)
    }

    /// Returns the patches of the changed tokens of the sampler `old`.
    fn rewritten(
        &self,
        document: &SourceDocument<'_>,
        old: ValueId,
        input: usize,
        output: usize,
        style: &JsonStyle,
        pointer: &str,
    ) -> Vec<TextPatch> {
        let json = document.json;
        let mut patches = Vec::new();
        let mut members = ListEdit::default();
        let last = json.items(old).last();
        let spot = style.spot(json, Some(old), 5);
        for (name, token, is_default) in [
            ("input", input.to_string(), false),
            ("output", output.to_string(), false),
            ("interpolation", quoted(self.interpolation), self.interpolation == "LINEAR"),
        ] {
            match json.member(old, name) {
                Some(id) if same_value(document, id, &token) => {}
                Some(id) => patches.push(TextPatch::new(json.span(id), token, format!("{pointer}/{name}"))),
                None if is_default => {}
                None => members.inserted.push((last, style.member(name, &Fresh::Raw(token), &spot))),
            }
        }
        patches.extend(edit(json, old, &members, style, &spot, pointer));
        patches
    }
}

/// Returns whether the value equals the one that `token` spells, in whatever notation.
fn same_value(document: &SourceDocument<'_>, id: ValueId, token: &str) -> bool {
    let json = document.json;
    match json.string(id) {
        Some(text) => quoted(&text) == token,
        None => json.whole(id).is_some_and(|number| number.to_string() == token),
    }
}

/// The samplers of an animation while channels are reassigned.
struct Pool {
    /// Number of channels that use each sampler.
    users: HashMap<usize, usize>,
    /// Samplers that no channel uses and that an earlier save wrote.
    idle: Vec<usize>,
    /// Number of the next new sampler.
    next: usize,
}

impl Pool {
    fn of(
        document: &SourceDocument<'_>,
        animation: &FileAnimation,
        removed: &[ValueId],
        is_ours: &dyn Fn(usize) -> bool,
    ) -> Self {
        let mut users: HashMap<usize, usize> = HashMap::new();
        for channel in &animation.channels {
            if let Some(sampler) = channel.sampler.filter(|_| removed.binary_search(&channel.id).is_err()) {
                *users.entry(sampler).or_default() += 1;
            }
        }
        let mut pool = Self { users, idle: Vec::new(), next: animation.samplers.len() };
        let idle = (0..animation.samplers.len()).rev().filter(|&number| {
            let ours = |name| pool.accessor(document, animation, number, name).is_some_and(is_ours);
            !pool.users.contains_key(&number) && ours("input") && ours("output")
        });
        pool.idle = idle.collect();
        pool
    }

    fn is_alone(&self, sampler: usize) -> bool {
        self.users.get(&sampler) == Some(&1)
    }

    /// Removes one channel from the users of a sampler.
    fn leave(&mut self, sampler: usize) {
        if let Some(users) = self.users.get_mut(&sampler) {
            *users = users.saturating_sub(1);
        }
    }

    /// Returns a sampler that no channel uses.
    fn another(&mut self) -> usize {
        self.idle.pop().unwrap_or_else(|| {
            self.next += 1;
            self.next - 1
        })
    }

    /// Returns the accessor that a sampler of the file refers to.
    fn accessor(
        &self,
        document: &SourceDocument<'_>,
        animation: &FileAnimation,
        sampler: usize,
        name: &str,
    ) -> Option<usize> {
        document.json.index_member(*animation.samplers.get(sampler)?, name)
    }
}
