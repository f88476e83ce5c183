//! Removes what earlier saves appended and nothing uses any more.

use super::buffer::TargetBuffer;
use super::columns::shape_width;
use super::document::SourceDocument;
use super::draw::Draw;
use super::error::SaveError;
use super::json::list::{ListEdit, edit};
use super::json::patch::TextPatch;
use super::json::style::Fresh;
use super::json::tree::ValueId;
use super::mark::MARK;
use super::plan::fresh_view;
use super::planned::Plan;
use super::reuse::{Granted, SavedSlot, others_past, slots};
use super::source::SourceFile;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

/// Plans a file without what earlier saves appended and nothing uses any more: bytes of the buffer, accessors, buffer
/// views. All takes stay as they are, and so does every byte that was not written by a save of this crate.
///
/// Nothing changes if another program appended to the buffer afterwards. Accessors and views are removed from their
/// lists only if they are the last ones, since the numbers of others must stay; otherwise all of them stay, and each
/// keeps only the bytes that it needs.
pub fn compact(source: &SourceFile) -> Result<Plan<'_>, SaveError> {
    let document = SourceDocument::of(source);
    let target = TargetBuffer::choose(&document);
    let mut slots = slots(&document, target.index, target.present);
    slots.sort_by_key(|slot| slot.offset);
    let mut draw = Draw::new(&document);
    let (Some(first), Some(last)) = (slots.first(), slots.last()) else { return draw.finish() };
    let is_last = last.offset + last.room == target.present;
    if !is_last || others_past(&document, target.index, first.offset, &slots) {
        return draw.finish();
    }
    let start = first.offset;
    let idle = IdleSamplers::of(&document, &slots);
    let used = idle.used_accessors(&document);
    let (accessors, views) = (document.accessors.len() - slots.len(), document.views.len() - slots.len());
    let at_end = slots.iter().all(|slot| slot.accessor >= accessors && slot.view >= views);
    let mut live: Vec<SavedSlot> =
        slots.iter().filter(|slot| !at_end || used.contains(&slot.accessor)).copied().collect();
    if live.is_empty() && (accessors == 0 || views == 0 || start == 0) {
        // glTF forbids an empty list or buffer.
        live.push(slots[0]);
    }
    let mut end = start;
    let mut moves = HashMap::new();
    let mut writes = Vec::new();
    let bytes = target.bytes(&document);
    for (number, slot) in live.iter().enumerate() {
        let to = match at_end {
            true => SavedSlot { accessor: accessors + number, view: views + number, ..*slot },
            false => *slot,
        };
        let room = needed(&document, slot);
        let granted = Granted { slot: Some(to), offset: end, room };
        if end != slot.offset {
            writes.push((end, bytes[slot.offset..slot.offset + room].to_vec()));
        }
        if to != *slot || granted.offset != slot.offset || room != slot.room {
            let fresh = moved_accessor(&document, slot.accessor, to.view);
            draw.replace(document.accessors[to.accessor], "accessors", to.accessor, &fresh);
            let fresh = fresh_view(target.index, &granted);
            draw.replace(document.views[to.view], "bufferViews", to.view, &fresh);
        }
        moves.insert(slot.accessor, to.accessor);
        end += room;
    }
    if at_end {
        cut(&mut draw, "accessors", &document.accessors, accessors + live.len())?;
        cut(&mut draw, "bufferViews", &document.views, views + live.len())?;
    }
    redirect_samplers(&mut draw, &idle, &moves);
    draw.buffer(target, &writes, end)?;
    draw.finish()
}

/// Returns the number of bytes of a slot's accessor.
fn needed(document: &SourceDocument<'_>, slot: &SavedSlot) -> usize {
    let (json, id) = (document.json, document.accessors[slot.accessor]);
    let shape = json.string_member(id, "type").unwrap_or_default();
    let size = json.index_member(id, "count").and_then(|count| count.checked_mul(shape_width(&shape) * 4));
    size.filter(|&size| size > 0 && size <= slot.room).unwrap_or(slot.room)
}

/// Returns the accessor with another view.
fn moved_accessor(document: &SourceDocument<'_>, accessor: usize, view: usize) -> Fresh<'static> {
    let (json, id) = (document.json, document.accessors[accessor]);
    let mut members = vec![("name", Fresh::string(MARK)), ("bufferView", Fresh::whole(view))];
    for name in ["componentType", "count", "type", "min", "max"] {
        if let Some(value) = json.member(id, name) {
            members.push((name, copied(document, value)));
        }
    }
    Fresh::Object(members)
}

/// Copies a token, or a list of tokens.
fn copied(document: &SourceDocument<'_>, id: ValueId) -> Fresh<'static> {
    let json = document.json;
    let raw = |id| Fresh::Raw(String::from_utf8_lossy(json.token(id)).into_owned());
    match json.items(id).next() {
        Some(_) => Fresh::Array(json.items(id).map(raw).collect()),
        None => raw(id),
    }
}

/// Removes the elements from `keep` on.
fn cut(draw: &mut Draw<'_, '_>, name: &str, items: &[ValueId], keep: usize) -> Result<(), SaveError> {
    let Some(list) = draw.list(name)? else { return Ok(()) };
    let change = ListEdit { removed: items[keep..].to_vec(), inserted: Vec::new() };
    let json = draw.document.json;
    let spot = draw.style.spot(json, Some(list), 2);
    draw.patches.extend(edit(json, list, &change, &draw.style, &spot, &format!("/{name}")));
    Ok(())
}

/// Samplers that no channel uses and whose accessors earlier saves wrote. They are redirected to the accessors of
/// another sampler of their animation with the same interpolation, which makes their own accessors unused. Where there
/// is none whose accessors fit, they keep their own: a file must not become less valid.
struct IdleSamplers {
    /// By animation and sampler: the sampler whose accessors it gets.
    instead: HashMap<(usize, usize), usize>,
}

impl IdleSamplers {
    fn of(document: &SourceDocument<'_>, slots: &[SavedSlot]) -> Self {
        let ours: HashSet<usize> = slots.iter().map(|slot| slot.accessor).collect();
        let mut instead = HashMap::new();
        for (index, animation) in document.animations.iter().enumerate() {
            let users: HashSet<usize> =
                animation.channels.iter().filter_map(|channel| channel.sampler).collect();
            let mut busy: Vec<usize> = users.iter().copied().collect();
            busy.sort_unstable();
            let sound = |interpolation: &str| {
                let sampler = |number: &usize| animation.samplers.get(*number).copied();
                let fits = |sampler| is_sound(document, sampler, interpolation);
                busy.iter().find(|number| sampler(number).is_some_and(fits)).copied()
            };
            // Found once for each way of interpolation, however many samplers there are.
            let sound: HashMap<&str, Option<usize>> =
                [LINEAR, "STEP", SPLINE].into_iter().map(|way| (way, sound(way))).collect();
            for (number, &sampler) in animation.samplers.iter().enumerate() {
                let is_ours =
                    |name| document.json.index_member(sampler, name).is_some_and(|a| ours.contains(&a));
                let way = interpolation(document, sampler);
                let busy = sound.get(&*way).copied().flatten();
                if !users.contains(&number) && is_ours("input") && is_ours("output") {
                    instead.extend(busy.map(|busy| ((index, number), busy)));
                }
            }
        }
        Self { instead }
    }

    /// Returns the sampler from which a sampler takes its accessors: in most cases from itself.
    fn source(&self, document: &SourceDocument<'_>, animation: usize, sampler: usize) -> ValueId {
        let number = self.instead.get(&(animation, sampler)).copied().unwrap_or(sampler);
        document.animations[animation].samplers[number]
    }

    fn used_accessors(&self, document: &SourceDocument<'_>) -> HashSet<usize> {
        let mut used = HashSet::new();
        for (index, animation) in document.animations.iter().enumerate() {
            for number in 0..animation.samplers.len() {
                let sampler = self.source(document, index, number);
                used.extend(document.json.index_member(sampler, "input"));
                used.extend(document.json.index_member(sampler, "output"));
            }
        }
        used
    }
}

const LINEAR: &str = "LINEAR";
const SPLINE: &str = "CUBICSPLINE";

/// Returns the interpolation of a sampler; linear if it has none.
fn interpolation<'a>(document: &SourceDocument<'a>, sampler: ValueId) -> Cow<'a, str> {
    document.json.string_member(sampler, "interpolation").unwrap_or(Cow::Borrowed(LINEAR))
}

/// Returns whether a sampler has the given interpolation and accessors that glTF allows for it: times with their range,
/// at least two for a spline, and a value for each, for a spline with two tangents.
fn is_sound(document: &SourceDocument<'_>, sampler: ValueId, wanted: &str) -> bool {
    let json = document.json;
    let accessor = |name| document.accessors.get(json.index_member(sampler, name)?).copied();
    let (Some(input), Some(output)) = (accessor("input"), accessor("output")) else { return false };
    let count = |id| json.whole_member(id, "count").unwrap_or(0);
    let (least, values) = if wanted == SPLINE { (2, 3) } else { (1, 1) };
    interpolation(document, sampler) == wanted
        && json.whole_member(input, "componentType") == Some(5126)
        && json.string_member(input, "type").as_deref() == Some("SCALAR")
        && ["min", "max"].iter().all(|name| json.member(input, name).is_some())
        && count(input) >= least
        && count(output) > 0
        && count(input).checked_mul(values).is_some_and(|values| count(output).is_multiple_of(values))
}

/// Writes the new numbers of accessors into the samplers.
fn redirect_samplers(draw: &mut Draw<'_, '_>, idle: &IdleSamplers, moves: &HashMap<usize, usize>) {
    let document = draw.document;
    let json = document.json;
    for (index, animation) in document.animations.iter().enumerate() {
        for (number, &sampler) in animation.samplers.iter().enumerate() {
            let source = idle.source(document, index, number);
            for name in ["input", "output"] {
                let (Some(token), Some(old)) = (json.member(sampler, name), json.index_member(sampler, name))
                else {
                    continue;
                };
                let wanted = json.index_member(source, name).unwrap_or(old);
                let new = moves.get(&wanted).copied().unwrap_or(wanted);
                if new != old {
                    let pointer = format!("/animations/{index}/samplers/{number}/{name}");
                    draw.patches.push(TextPatch::new(json.span(token), new.to_string(), pointer));
                }
            }
        }
    }
}
