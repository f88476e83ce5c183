//! Things that others hold: attached, held in another way, detached.

use super::angles::turn_about_axes;
use super::draft::spliced_text;
use super::insert::{check_who, place_in_par};
use super::scene::{GestureRefusal, GestureScene, NO_PLACE, refused};
use crate::stage::RigidPlace;
use crate::stage::splice::{NewElement, TextSplices, set_attribute};
use crate::stage::table::vector;
use crate::stage::time::StageTime;
use crate::stage::time_text::decimal_text;
use glam::DVec3;

/// The place of a thing relative to its holder.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeldGrip {
    /// Meters.
    pub offset: DVec3,
    /// Degrees about x, then y, then z.
    pub turn: DVec3,
}

impl HeldGrip {
    /// Returns the grip with which a holder at `holder` keeps a thing at `thing`.
    pub fn keeping(holder: &RigidPlace, thing: &RigidPlace) -> Self {
        let own = holder.inverse().then(thing);
        Self { offset: own.position, turn: turn_about_axes(own.rotation) }
    }

    /// Returns the attributes, with their values.
    fn attributes(&self) -> Result<[(&'static str, String); 2], GestureRefusal> {
        if !(self.offset.is_finite() && self.turn.is_finite() && self.offset.abs().max_element() < 1e6) {
            return refused("The position is too far away");
        }
        let text = |value: DVec3, decimals: usize| {
            value.to_array().map(|number| decimal_text(number, decimals)).join(" ")
        };
        Ok([("offset", text(self.offset, 4)), ("turn", text(self.turn, 2))])
    }
}

/// Returns the replacements after which the `attach` that is `action` holds its thing like this. Values that stay the same stay as they are written.
///
/// # Errors
///
/// There is no such action, it attaches nothing, or a number is not finite.
pub fn grip_splices(
    scene: &GestureScene<'_>,
    action: usize,
    grip: &HeldGrip,
) -> Result<TextSplices, GestureRefusal> {
    let element = scene.element(action)?;
    if element.row.name != "attach" {
        return refused(format!("<{}> attaches nothing", element.row.name));
    }
    let index = scene.script.actions()[action].element;
    let mut parts = Vec::new();
    for (name, value) in grip.attributes()? {
        let written = element.value(name).and_then(vector).unwrap_or_default();
        if vector(&value) == Some(written) {
            continue;
        }
        match set_attribute(scene.script.tree(), index, name, &value) {
            Some(splices) => parts.push(splices),
            None => return refused(NO_PLACE),
        }
    }
    TextSplices::joined(parts).ok_or_else(|| GestureRefusal(NO_PLACE.to_owned()))
}

/// Attaches a thing to another one, or to a bone of it such as `anna.RightHand`, from `at` on: it is where that is.
///
/// # Errors
///
/// One of them is not in the cast, or it would hold itself.
pub fn attach_thing(
    scene: &GestureScene<'_>,
    who: &str,
    to: &str,
    at: StageTime,
) -> Result<String, GestureRefusal> {
    check_who(scene, who, "attach", "are attached")?;
    spliced_text(scene.script, attach_splices(scene, who, to, at, None)?)
}

/// Returns the replacements of [`attach_thing`], with another grip where there is one. `who` may be a thing that other replacements add.
///
/// # Errors
///
/// What holds it is not in the cast, or is the thing itself.
pub fn attach_splices(
    scene: &GestureScene<'_>,
    who: &str,
    to: &str,
    at: StageTime,
    grip: Option<&HeldGrip>,
) -> Result<TextSplices, GestureRefusal> {
    let holder = to.split_once('.').map_or(to, |(holder, _)| holder);
    if holder == who {
        return refused("A thing cannot hold itself");
    }
    if scene.plan.thing_called(holder).is_none() {
        return refused(format!("No thing of the cast has the id \"{holder}\""));
    }
    let mut attach = NewElement::new("attach").with("who", who).with("to", to);
    for (name, value) in grip.map(HeldGrip::attributes).transpose()?.into_iter().flatten() {
        if vector(&value) != Some(DVec3::ZERO) {
            attach = attach.with(name, value);
        }
    }
    added(scene, who, attach, at)
}

/// Returns the replacements that detach a thing at `at`: it stays where it is.
///
/// # Errors
///
/// It is not in the cast, or no thing that can be held.
pub fn detach_splices(
    scene: &GestureScene<'_>,
    who: &str,
    at: StageTime,
) -> Result<TextSplices, GestureRefusal> {
    check_who(scene, who, "detach", "are detached")?;
    added(scene, who, NewElement::new("detach").with("who", who), at)
}

/// Returns the replacements that add an action of a thing at a time, near its last one.
fn added(
    scene: &GestureScene<'_>,
    who: &str,
    action: NewElement,
    at: StageTime,
) -> Result<TextSplices, GestureRefusal> {
    let own = |&action: &usize| scene.script.element(action).value("who") == Some(who);
    let near = (1..scene.script.actions().len()).rfind(own);
    place_in_par(scene, near).added(scene, action, at.max(StageTime::ZERO))
}
