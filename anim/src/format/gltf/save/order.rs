//! The list of animations: which stay, which are removed or added, and their order.

use super::draw::Draw;
use super::error::SaveError;
use super::json::list::{ListEdit, edit};
use super::json::patch::{TextPatch, patched, sort};
use super::planned::TakeDraft;
use std::collections::HashSet;

/// Writes the list. Animations that stay in order keep their position and bytes. Where the order changes, each position
/// gets the text of the animation that belongs there, and the space between positions stays.
pub(super) fn write_animations(
    draw: &mut Draw<'_, '_>,
    takes: &[TakeDraft],
    accessors: &[usize],
) -> Result<(), SaveError> {
    let document = draw.document;
    let json = document.json;
    let list = draw.list("animations")?;
    let Some(list) = list else {
        if !takes.is_empty() {
            draw.new_list("animations", takes.len(), |take| takes[take].draft.fresh(accessors));
        }
        return Ok(());
    };
    if takes.is_empty() {
        // glTF forbids an empty list.
        if !document.animations.is_empty() {
            draw.root.removed.push(list);
        }
        return Ok(());
    }
    let spot = draw.style.spot(json, Some(list), 2);
    let order: Vec<usize> = takes.iter().filter(|take| !take.is_copy).filter_map(|take| take.base).collect();
    let mut places = order.clone();
    places.sort_unstable();
    let stays: HashSet<usize> = order.iter().copied().collect();
    let gone = (0..document.animations.len()).filter(|index| !stays.contains(index));
    let mut change =
        ListEdit { removed: gone.map(|index| document.animations[index].id).collect(), inserted: Vec::new() };
    let mut filled = 0_usize;
    for take in takes {
        let pointer = take.base.map_or("/animations".to_owned(), |base| format!("/animations/{base}"));
        let patches = match take.base {
            Some(base) => {
                let animation = &document.animations[base];
                take.draft.patches(document, animation, accessors, &draw.style, &pointer)?
            }
            None => Vec::new(),
        };
        let text = |patches: Vec<TextPatch>| match take.base {
            Some(base) => text_of(draw, base, patches),
            None => Ok(draw.style.write(&take.draft.fresh(accessors), &spot)),
        };
        if take.is_copy || take.base.is_none() {
            let after = filled.checked_sub(1).map(|before| document.animations[places[before]].id);
            change.inserted.push((after, text(patches)?));
            continue;
        }
        let place = places[filled];
        filled += 1;
        if take.base == Some(place) {
            draw.patches.extend(patches);
        } else {
            let text = text(patches)?;
            let span = json.span(document.animations[place].id);
            draw.patches.push(TextPatch::new(span, text, format!("/animations/{place}")));
        }
    }
    draw.patches.extend(edit(json, list, &change, &draw.style, &spot, "/animations"));
    Ok(())
}

/// Returns the text of an animation with patches applied.
fn text_of(draw: &Draw<'_, '_>, animation: usize, mut patches: Vec<TextPatch>) -> Result<String, SaveError> {
    let json = draw.document.json;
    let broken = || SaveError::File {
        place: format!("/animations/{animation}"),
        reason: "two edits of this save would change the same bytes".to_owned(),
    };
    patches.retain(|patch| !(patch.span.is_empty() && patch.text.is_empty()));
    if !sort(&mut patches) {
        return Err(broken());
    }
    let span = json.span(draw.document.animations[animation].id);
    String::from_utf8(patched(json.file, span, &patches)).map_err(|_| broken())
}
