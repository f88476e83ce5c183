//! The actions of a new script that were given ones of the script before.
//!
//! ```text
//! old  <shot A/> <shot B/> <shot A/> <shot B/>
//! new  <shot A/>           <shot A/> <shot B/>      the same text before and after the change: those there are the same
//!                ‾‾‾‾‾‾‾‾                           what was changed: by id, by its text, by all but its times, by its place
//! ```

use dragonfly_anim::stage::script::{ScriptElement, StageScript};
use std::collections::{HashMap, HashSet};
use std::hash::{Hash, Hasher};
use std::ops::Range;

/// Returns the actions of `new` that are these ones of `old`, in the same order; those that are gone are left out. Of several that are written the same, of
/// which fewer are left, none is followed. What is compared is in proportion to the texts, what is allocated to the changed actions.
pub fn follow_actions(old: &StageScript, new: &StageScript, actions: &[usize]) -> Vec<usize> {
    if actions.is_empty() {
        return Vec::new();
    }
    let follower = ActionFollower::new(OwnActions::of(old), OwnActions::of(new));
    let mut matches = None;
    let mut found = Vec::with_capacity(actions.len());
    found.extend(actions.iter().filter_map(|&action| follower.follow(action, &mut matches)));
    found
}

/// Returns the actions of `new` that none of `old` is, without what contains others.
pub(super) fn new_actions(old: &StageScript, new: &StageScript) -> Vec<usize> {
    let all: Vec<usize> = (0..old.actions().len()).collect();
    let followed: HashSet<usize> = follow_actions(old, new, &all).into_iter().collect();
    let is_new = |action: &usize| !followed.contains(action) && new.actions()[*action].children.is_empty();
    (1..new.actions().len()).filter(is_new).collect()
}

/// The actions of the text itself, in its order: without those of included files.
struct OwnActions<'a> {
    script: &'a StageScript,
    /// `None` where they are all.
    list: Option<Vec<usize>>,
}

impl<'a> OwnActions<'a> {
    fn of(script: &'a StageScript) -> Self {
        let has_files = !script.tree().included_files().is_empty();
        let own = || (0..script.actions().len()).filter(|&action| !script.element(action).is_included());
        Self { script, list: has_files.then(|| own().collect()) }
    }

    fn len(&self) -> usize {
        self.list.as_ref().map_or(self.script.actions().len(), Vec::len)
    }

    fn action(&self, at: usize) -> usize {
        self.list.as_ref().map_or(at, |list| list[at])
    }

    fn position(&self, action: usize) -> Option<usize> {
        match &self.list {
            Some(list) => list.binary_search(&action).ok(),
            None => Some(action),
        }
    }

    fn element(&self, at: usize) -> &'a ScriptElement {
        self.script.element(self.action(at))
    }

    fn text(&self) -> &'a str {
        self.script.tree().text()
    }

    /// Returns the bytes of a start tag, up to the end of its last attribute.
    fn tag(&self, at: usize) -> Range<usize> {
        let element = self.element(at);
        let end = element.attributes.last().map_or(element.name.end, |last| last.range.end);
        element.range.start..end
    }

    fn tag_text(&self, at: usize) -> &'a str {
        self.text().get(self.tag(at)).unwrap_or_default()
    }

    /// Returns the number of actions at the start of which `is_before` is true; those come first.
    fn count(&self, is_before: impl Fn(Range<usize>) -> bool) -> usize {
        let (mut low, mut high) = (0, self.len());
        while low < high {
            let middle = low.midpoint(high);
            if is_before(self.tag(middle)) { low = middle + 1 } else { high = middle }
        }
        low
    }
}

/// Two scripts, and which of their actions are in the part of the text that differs.
struct ActionFollower<'a> {
    old: OwnActions<'a>,
    new: OwnActions<'a>,
    /// Number of actions before that part.
    before: usize,
    /// Number of actions after it.
    after: usize,
}

impl<'a> ActionFollower<'a> {
    fn new(old: OwnActions<'a>, new: OwnActions<'a>) -> Self {
        let [before, after] = same_ends(old.text().as_bytes(), new.text().as_bytes());
        let ends_before = |tag: Range<usize>| tag.end <= before;
        let first = old.count(ends_before).min(new.count(ends_before));
        let rest = |own: &OwnActions<'_>| {
            let from = own.text().len() - after;
            own.len() - own.count(|tag| tag.start < from)
        };
        let last = rest(&old).min(rest(&new)).min(old.len() - first).min(new.len() - first);
        let mut follower = Self { old, new, before: first, after: last };
        // The texts do not say which one of several that are written the same was deleted.
        let deleted = follower.old.len().saturating_sub(follower.new.len());
        let is_same = |at: usize, by: usize| {
            let text = |at: usize| follower.old.tag_text(at);
            text(at) == text(at + by)
        };
        let mut start = follower.before;
        while deleted > 0
            && start > 1
            && start - 1 + deleted < follower.old.len()
            && is_same(start - 1, deleted)
        {
            start -= 1;
        }
        follower.before = start;
        follower
    }

    /// Returns the action of the new script that was an action. The changed ones are compared once, where one of them is asked for.
    fn follow(&self, action: usize, matches: &mut Option<Vec<Option<usize>>>) -> Option<usize> {
        let (old, new) = (self.old.script, self.new.script);
        let element = old.actions().get(action).map(|_| old.element(action))?;
        if element.is_included() {
            // At the same place after its `include`.
            let include = old.action_in_text(action);
            let found = self.follow(include, matches)? + (action - include);
            let other = new.actions().get(found).map(|_| new.element(found))?;
            let is_same = other.is_included() && ButTimes(element) == ButTimes(other);
            return (is_same && old.tree().file_of(element) == new.tree().file_of(other)).then_some(found);
        }
        if let Some(found) = element.value("id").and_then(|id| new.action_called(id)) {
            return Some(found);
        }
        let at = self.old.position(action)?;
        let found = if at < self.before {
            at
        } else if at >= self.old.len() - self.after {
            self.new.len() - (self.old.len() - at)
        } else {
            let matches = matches.get_or_insert_with(|| self.matches());
            matches.get(at - self.before).copied().flatten()?
        };
        (self.new.element(found).row.name == element.row.name).then(|| self.new.action(found))
    }

    /// Returns for each of the changed actions of the old script its position among those of the text of the new one.
    fn matches(&self) -> Vec<Option<usize>> {
        let [old, new] = [&self.old, &self.new].map(|own| self.before..own.len() - self.after);
        let mut found = ChangedMatches {
            of_old: vec![None; old.len()],
            is_lost: vec![false; old.len()],
            is_taken: vec![false; new.len()],
            first: self.before,
        };
        if old.len() == new.len() {
            for at in old.clone().filter(|&at| self.old.tag_text(at) == self.new.tag_text(at)) {
                found.put(at, at);
            }
        }
        found.by_key([old.clone(), new.clone()], |at| self.old.tag_text(at), |at| self.new.tag_text(at));
        let but_times = |own: &OwnActions<'a>, at: usize| ButTimes(own.element(at));
        found.by_key(
            [old.clone(), new.clone()],
            |at| but_times(&self.old, at),
            |at| but_times(&self.new, at),
        );
        // The others were changed in another way, or went to another thing.
        let left = |at: &usize| found.is_left(*at);
        let free = |at: &usize| !found.is_taken[at - self.before];
        let (rest, free): (Vec<usize>, Vec<usize>) = (old.filter(left).collect(), new.filter(free).collect());
        let pairs = || rest.iter().copied().zip(free.iter().copied());
        let is_same_kind =
            |(at, other): (usize, usize)| self.old.element(at).row.name == self.new.element(other).row.name;
        if rest.len() == free.len() && pairs().all(is_same_kind) {
            for (at, other) in pairs() {
                found.put(at, other);
            }
        }
        found.of_old
    }
}

/// Pairs of changed actions.
struct ChangedMatches {
    of_old: Vec<Option<usize>>,
    /// Those that were deleted, or of which it is not known.
    is_lost: Vec<bool>,
    is_taken: Vec<bool>,
    /// The position of the first one.
    first: usize,
}

impl ChangedMatches {
    fn put(&mut self, old: usize, new: usize) {
        self.of_old[old - self.first] = Some(new);
        self.is_taken[new - self.first] = true;
    }

    fn is_left(&self, old: usize) -> bool {
        self.of_old[old - self.first].is_none() && !self.is_lost[old - self.first]
    }

    /// Pairs those that are left and have the same key, in their order.
    fn by_key<Key: Eq + Hash>(
        &mut self,
        [old, new]: [Range<usize>; 2],
        key_of_old: impl Fn(usize) -> Key,
        key_of_new: impl Fn(usize) -> Key,
    ) {
        let has_fewer = new.len() < old.len();
        let mut groups: HashMap<Key, [Vec<usize>; 2]> = HashMap::new();
        for at in old.filter(|&at| self.is_left(at)) {
            groups.entry(key_of_old(at)).or_default()[0].push(at);
        }
        for at in new.filter(|at| !self.is_taken[at - self.first]) {
            if let Some([_, others]) = groups.get_mut(&key_of_new(at)) {
                others.push(at);
            }
        }
        for [own, others] in groups.into_values().filter(|[_, others]| !others.is_empty()) {
            if has_fewer && others.len() < own.len() {
                own.iter().for_each(|at| self.is_lost[at - self.first] = true);
                others.iter().for_each(|at| self.is_taken[at - self.first] = true);
                continue;
            }
            for (at, other) in own.into_iter().zip(others) {
                self.put(at, other);
            }
        }
    }
}

/// An element without its times and its id, to compare it.
struct ButTimes<'a>(&'a ScriptElement);

impl<'a> ButTimes<'a> {
    fn values(&self) -> impl Iterator<Item = (&'static str, &'a str)> + use<'a> {
        const LEFT_OUT: [&str; 5] = ["begin", "end", "dur", "fade-in", "id"];
        let attributes = self.0.attributes.iter().map(|attribute| (attribute.row.name, &*attribute.value));
        attributes.filter(|(name, _)| !LEFT_OUT.contains(name))
    }
}

impl PartialEq for ButTimes<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.0.row.name == other.0.row.name && self.values().eq(other.values())
    }
}

impl Eq for ButTimes<'_> {}

impl Hash for ButTimes<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.row.name.hash(state);
        self.values().for_each(|value| value.hash(state));
    }
}

/// Returns how many bytes two texts have in common at their starts, and at their ends after that.
fn same_ends(old: &[u8], new: &[u8]) -> [usize; 2] {
    /// Bytes that are compared at once.
    const BLOCK: usize = 256;
    let most = old.len().min(new.len());
    let mut before = 0;
    while before + BLOCK <= most && old[before..before + BLOCK] == new[before..before + BLOCK] {
        before += BLOCK;
    }
    before += old[before..].iter().zip(&new[before..]).take_while(|(one, other)| one == other).count();
    let (old, new, most) = (&old[before..], &new[before..], most - before);
    let mut after = 0;
    while after + BLOCK <= most
        && old[old.len() - after - BLOCK..old.len() - after]
            == new[new.len() - after - BLOCK..new.len() - after]
    {
        after += BLOCK;
    }
    let rest = |text: &'_ [u8]| text.len() - after;
    let (old, new) = (&old[..rest(old)], &new[..rest(new)]);
    after += old.iter().rev().zip(new.iter().rev()).take_while(|(one, other)| one == other).count();
    [before, after]
}
