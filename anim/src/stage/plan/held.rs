//! Holders of things at a time, for gestures that change how they hold.

use super::holds::{HoldKind, RigidPlace};
use super::rigid::{deciding_hold, rigid_of};
use super::spot::StageSpot;
use super::thing::PlannedThing;
use crate::stage::scene::StageScene;

/// The reason why a thing is elsewhere than its own motions move it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ThingHold {
    /// Something holds it.
    Attached {
        /// The action `attach`.
        action: usize,
        /// The place of the bone, thing or point that holds it.
        holder: RigidPlace,
        /// Its place relative to that.
        grip: RigidPlace,
        /// Whether it is still on its way there.
        is_arriving: bool,
    },
    /// The action `detach`: it stays where it was detached, or falls.
    Detached(usize),
}

pub(super) fn hold_of(things: &[PlannedThing], thing: usize, scene: &StageScene) -> Option<ThingHold> {
    let planned = things.get(thing)?;
    let hold = planned.holds.get(deciding_hold(planned, scene.time, planned.holds.len())?)?;
    Some(match hold.kind {
        HoldKind::Attach { to, grip, fade_in } => ThingHold::Attached {
            action: hold.action,
            holder: rigid_of(to, &scene.things),
            grip,
            is_arriving: scene.time - hold.begin < fade_in,
        },
        HoldKind::Detach { .. } => ThingHold::Detached(hold.action),
    })
}

pub(super) fn place_of_name(things: &[PlannedThing], name: &str, scene: &StageScene) -> Option<RigidPlace> {
    let (thing, bone) = name.split_once('.').map_or((name, None), |(thing, bone)| (thing, Some(bone)));
    let thing = things.iter().position(|planned| &*planned.id == thing)?;
    let spot = match bone {
        None => StageSpot::Thing(thing),
        Some(bone) => StageSpot::Bone(thing, things[thing].model.as_ref()?.skeleton().find(bone)?),
    };
    Some(rigid_of(spot, &scene.things))
}
