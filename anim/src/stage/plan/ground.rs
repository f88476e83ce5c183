//! The ground props of a cast, and what a script may do with them.

use super::bind::StageBinder;
use super::motions::BoundAction;
use super::thing::PlannedThing;
use crate::stage::ground::{GROUND_TRIANGLES, GroundMesh, PlacedGround, SceneGround};
use crate::stage::model::StageModel;
use crate::stage::script::ErrorList;
use std::sync::Arc;

/// Largest number of props that an error lists.
const LISTED: usize = 8;

/// Prepares the props that are ground. A model is prepared once, and not again if one of the things `before`, of an older plan, has it.
pub(super) fn find_ground(binder: &mut StageBinder<'_>, before: &[PlannedThing], errors: &mut ErrorList) {
    let mut ground = SceneGround { plane: binder.script.ground(), ..SceneGround::default() };
    for (thing, element) in binder.script.things().enumerate() {
        if element.value("ground") != Some("yes") {
            continue;
        }
        // A model that is missing is reported elsewhere, or on its way.
        let Some(model) = binder.things[thing].model.clone() else { continue };
        let known = binder.things.iter().chain(before);
        let same = |other: &Arc<StageModel>| Arc::ptr_eq(other, &model);
        let known = known.filter(|other| other.model.as_ref().is_some_and(same));
        let mesh = known.filter_map(|other| other.ground.clone()).next();
        let Some(mesh) = mesh.or_else(|| GroundMesh::new(model.data()).map(Arc::new)) else {
            let message =
                format!("a model of more than {GROUND_TRIANGLES} triangles or vertices cannot be ground");
            errors.add(element.value_range("ground"), message, "use a simpler model of the ground");
            continue;
        };
        let planned = &mut binder.things[thing];
        planned.ground = Some(Arc::clone(&mesh));
        let place = planned.places.base;
        let (position, rotation) = (place.position, place.rotation());
        ground.props.push(PlacedGround { mesh, position, rotation, scale: planned.scale });
    }
    binder.ground = Arc::new(ground);
}

/// Checks that ways over ground have one, and that nothing moves it.
pub(super) fn check_ground(binder: &StageBinder<'_>, bound: &[BoundAction], errors: &mut ErrorList) {
    let is_ground: Vec<bool> =
        binder.script.things().map(|element| element.value("ground") == Some("yes")).collect();
    let has_ground = is_ground.contains(&true);
    for (action, bound) in bound.iter().enumerate() {
        let element = binder.script.element(action);
        if element.row.name == "move" && element.value("ground") == Some("mesh") && !has_ground {
            let props = binder.things.iter().filter(|thing| thing.kind == "prop");
            let names: Vec<&str> = props.map(|thing| &*thing.id).take(LISTED).collect();
            let help = if names.is_empty() {
                "add a <prop> with ground=\"yes\" to the cast".to_owned()
            } else {
                format!("add ground=\"yes\" to a prop that is ground (props: {})", names.join(", "))
            };
            errors.add(element.value_range("ground"), "no prop of the cast is ground", help);
        }
        let Some(who) = bound.who.filter(|&who| is_ground.get(who) == Some(&true)) else { continue };
        let travels = || {
            let take = bound.take.as_ref().and_then(|(take, model)| model.takes().get(*take));
            take.is_some_and(|take| take.travels())
        };
        let moves = match element.row.name {
            "move" | "turn" | "place" | "attach" => true,
            "play" => travels(),
            _ => false,
        };
        if moves {
            let message = format!("\"{}\" is ground, and ground stands still", binder.things[who].id);
            let help = "set its place in the cast, or use another prop with ground=\"yes\"";
            errors.add(element.value_range("who"), message, help);
        }
    }
}
