//! Actions of the table [`NEW_ACTIONS`](crate::stage::table::NEW_ACTIONS).

use super::draft::{ScriptDraft, keeps_prev};
use super::insert::{ActionPlace, add_action, check_who, kind_of, place_in_par, place_index};
use super::mixes::{ActionOrigins, mixed};
use super::scene::{GestureRefusal, GestureScene, NO_PLACE, refused};
use crate::stage::model::{StageModel, StageTake};
use crate::stage::splice::{ElementPlace, NewElement, insert};
use crate::stage::table::{NewActionRow, NewActionTarget, PropertyType, element, property};
use crate::stage::time::StageTime;
use crate::stage::time_text::{number_text, readable, time_text};
use std::sync::Arc;

/// Text of a title that is added.
const TITLE: &str = "Title";

/// Duration of a way without a take, seconds.
const WAY: &str = "2";

/// Adds an action of the table at `at`: one of the thing `who`, or one without a thing. `target` is the thing or property that it names.
///
/// # Errors
///
/// There is no such thing, it does no such action, or there is no such target.
pub fn add_new_action(
    scene: &GestureScene<'_>,
    row: &NewActionRow,
    who: Option<&str>,
    target: Option<&str>,
    at: StageTime,
) -> Result<String, GestureRefusal> {
    let at = at.max(StageTime::ZERO);
    let mut action = NewElement::new(row.element);
    if who.is_none() && element(row.element).is_some_and(|row| !row.who.is_empty()) {
        return refused("Select the thing that does it first");
    }
    if let Some(who) = who {
        check_who(scene, who, row.element, &format!("do <{}>", row.element))?;
        action = action.with("who", who);
    }
    action = match (row.target, who, target) {
        (NewActionTarget::Nothing, ..) => action,
        (NewActionTarget::Thing { attribute, kinds }, who, Some(target)) => {
            if who == Some(target) {
                return refused("A thing cannot do that to itself");
            }
            if !kind_of(scene, target).is_some_and(|kind| kinds.contains(&kind)) {
                return refused(format!("\"{target}\" cannot be named there"));
            }
            action.with(attribute, spot(scene, row.element, target))
        }
        (NewActionTarget::Property, Some(who), Some(target)) => {
            let value = property_text(scene, who, target, at)?;
            action.with("property", target).with("to", value)
        }
        (NewActionTarget::OwnPlace, Some(who), _) => {
            let thing = scene.plan.thing_called(who).unwrap_or_default();
            let Some(place) = scene.plan.placement(thing, at) else { return refused(NO_PLACE) };
            let position = place.position.to_array().map(number_text).join(" ");
            action.with("at", position).with("facing", number_text(place.facing.to_degrees()))
        }
        (NewActionTarget::Thing { .. } | NewActionTarget::Property | NewActionTarget::OwnPlace, ..) => {
            return refused("There is nothing that it could name");
        }
    };
    if row.walks {
        action = match who.and_then(|who| walk(scene, who)) {
            Some(take) => action.with("take", take),
            None => action.with("dur", WAY),
        };
        // Not into another figure.
        if row.element == "move" && target.is_some_and(|target| kind_of(scene, target) == Some("role")) {
            action = action.with("gap", "0.8");
        }
    }
    if let Some(who) = who.filter(|_| row.element == "look") {
        action = match looking_bone(scene, who) {
            Ok(Some(bone)) => action.with("bones", bone),
            Ok(None) => action,
            Err(()) => {
                return refused(format!(
                    "The model of {who} has no bone called head: write the action into the script, with `bones`"
                ));
            }
        };
    }
    for (name, value) in row.with {
        action = action.with(*name, *value);
    }
    if row.element == "title" {
        action = action.with("text", TITLE);
    }
    match who.filter(|_| row.continues) {
        Some(who) => add_action(scene, who, action, at),
        None => {
            let is_own = |&other: &usize| {
                let element = scene.script.element(other);
                element.value("who") == who && (who.is_some() || element.row.name == row.element)
            };
            let near = (1..scene.script.actions().len()).rfind(is_own);
            let ActionPlace { place, base } = place_in_par(scene, near);
            if at != base {
                let rate = scene.script.rate();
                action = action.with("begin", time_text(readable(at - base, rate), rate, ""));
            }
            let draft = ScriptDraft::of(scene.script).then(|tree| insert(tree, place, &action))?;
            mixed(scene, draft, &ActionOrigins::same(scene).with_new(place_index(scene, place)))?.finish()
        }
    }
}

/// Inserts a `wait` of a second after an action of a `seq`: what follows begins later.
///
/// # Errors
///
/// There is no such action, or it is in no `seq`.
pub fn wait_after(scene: &GestureScene<'_>, action: usize) -> Result<String, GestureRefusal> {
    scene.element(action)?;
    if !scene.script.is_in_seq(action) {
        return refused("Only in a sequence something can wait");
    }
    keeps_prev(scene.script, scene.script.next_sibling(action))?;
    let place = ElementPlace::After(scene.script.actions()[action].element);
    let wait = NewElement::new("wait").with("dur", "1");
    let draft = ScriptDraft::of(scene.script).then(|tree| insert(tree, place, &wait))?;
    mixed(scene, draft, &ActionOrigins::same(scene).with_new(place_index(scene, place)))?.finish()
}

/// Returns how an action names a thing: to look at a figure is to look at its head.
fn spot(scene: &GestureScene<'_>, action: &str, target: &str) -> String {
    let thing = scene.plan.thing_called(target).and_then(|thing| scene.plan.things().get(thing));
    let model = thing.filter(|_| action == "look").and_then(|thing| thing.model.as_ref());
    match model.and_then(head_of) {
        Some(bone) => format!("{target}.{bone}"),
        None => target.to_owned(),
    }
}

/// Returns the name of the bone of the head: the one that models are searched for, otherwise the first one whose name contains the word.
fn head_of(model: &Arc<StageModel>) -> Option<&str> {
    let bones = &model.skeleton().bones;
    let known = model.head().and_then(|head| bones.get(head as usize));
    let named = || bones.iter().find(|bone| bone.name.to_lowercase().contains("head"));
    known.or_else(named).map(|bone| &*bone.name).filter(|name| !name.is_empty())
}

/// Returns the bone that a `look` of a thing has to name: none for a camera, and for a figure whose head is known.
fn looking_bone<'a>(scene: &GestureScene<'a>, who: &str) -> Result<Option<&'a str>, ()> {
    let thing = scene.plan.thing_called(who).and_then(|thing| scene.plan.things().get(thing));
    match thing.and_then(|thing| thing.model.as_ref()) {
        Some(model) if model.head().is_none() => head_of(model).map(Some).ok_or(()),
        Some(_) | None => Ok(None),
    }
}

/// Returns the take with which a thing walks.
fn walk<'a>(scene: &GestureScene<'a>, who: &str) -> Option<&'a str> {
    let thing = scene.plan.things().get(scene.plan.thing_called(who)?)?;
    let takes = thing.model.as_ref()?.takes();
    let is_walk =
        |take: &&StageTake| take.stride_speed().is_some() && take.name().to_lowercase().contains("walk");
    takes.iter().find(is_walk).map(StageTake::name)
}

/// Returns the value that a property of a thing has at a time, as it is written.
fn property_text(
    scene: &GestureScene<'_>,
    who: &str,
    name: &str,
    at: StageTime,
) -> Result<String, GestureRefusal> {
    let row = kind_of(scene, who).and_then(|kind| property(kind, name));
    let thing = scene.plan.thing_called(who).and_then(|thing| scene.plan.things().get(thing));
    let (Some(row), Some(thing)) = (row, thing) else {
        return refused(format!("\"{who}\" has no property \"{name}\""));
    };
    // The last change before that time, otherwise the cast.
    let own = (1..scene.script.actions().len()).filter(|&action| {
        let element = scene.script.element(action);
        matches!(element.row.name, "set" | "change")
            && element.value("who") == Some(who)
            && element.value("property") == Some(name)
            && scene.times(action).begin <= at
    });
    let last = own.max_by_key(|&action| (scene.times(action).begin, action));
    let written = match last {
        Some(action) => scene.script.element(action).value("to"),
        None => {
            let element = scene.script.thing_element(&thing.id);
            element.and_then(|element| scene.script.tree().elements()[element].value(name))
        }
    };
    let default = match row.kind {
        PropertyType::Number => "1",
        PropertyType::Color => "#ffffff",
        PropertyType::Lens => "35mm",
    };
    let written = written.filter(|written| !written.is_empty()).unwrap_or(default);
    // Actions have focal lengths without their unit.
    Ok(written.strip_suffix("mm").unwrap_or(written).to_owned())
}
