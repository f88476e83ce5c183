//! The scene around a model that is edited in it: where the other things are, and which time they show.

use super::playback;
use crate::panels::scene::{EnteredClip, EnteredThing};
use crate::panels::workspace::Workspace;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::fast::matrix::mat4;
use dragonfly_anim::stage::StageScene;
use dragonfly_anim::stage::lanes::SceneLanes;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::{LoadedModel, SceneView};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::{AroundClip, SceneAround, ThroughCamera};
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// Duration over which the speed of a take on a way is measured, seconds.
const MOMENT: f64 = 1.0 / 240.0;

/// Notes the thing whose model is about to be opened, and the scene around it.
pub(super) fn enter(workspace: &mut Workspace, thing: &str) -> Option<()> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    let plan = Arc::clone(scene.plan.as_ref()?);
    let (thing, time) = (plan.thing_called(thing)?, workspace.read().scene_time());
    let is_free = *workspace.camera.through() == ThroughCamera::Free && workspace.stage.is_framed();
    workspace.entered = Some(EnteredThing {
        clip: clip_at(workspace.scene.lanes(), &scene, thing, time),
        hidden: workspace.scene.hidden().map(Arc::from).collect(),
        camera: is_free.then(|| *workspace.camera.free()),
        scene,
        thing,
        time,
    });
    Some(())
}

/// Returns the take that a thing plays at a time, the one that began last.
fn clip_at(lanes: &SceneLanes, scene: &SceneView, thing: usize, time: StageTime) -> Option<EnteredClip> {
    let (script, plan) = (scene.script.as_ref()?, scene.plan.as_ref()?);
    let (action, after) = plan.take_at(thing, time)?;
    let take = script.element(action).value("take")?.to_owned();
    let (_, bar) = lanes.bar_of(action)?;
    let speed = match bar.clip {
        Some(clip) => clip.speed.to_f64(),
        // On a way, the take goes as fast as the feet do: measured over the next moment.
        None => {
            let later = plan.take_at(thing, time + StageTime::from_seconds(MOMENT));
            let later = later.filter(|(of, _)| *of == action).map_or(after, |(_, later)| later);
            let speed = (later - after).seconds() / MOMENT;
            if speed > 0.0 { speed } else { 1.0 }
        }
    };
    (speed != 0.0).then_some(EnteredClip { take, after: after.seconds(), speed })
}

/// Shows the take that the thing played in the scene, at the same time of it, and the scene around the model. Without such a thing, nothing is
/// around it.
pub(super) fn entered(workspace: &mut Workspace) {
    let entered = workspace.entered.take();
    let Some(view) = workspace.model.view().filter(|view| view.waiting_scene.is_some()) else {
        workspace.around = None;
        return;
    };
    // A model that is read again stays where it is.
    let Some(entered) = entered else { return };
    workspace.around = None;
    let loaded = Arc::clone(&view.loaded);
    let takes = workspace.model.takes();
    let found = entered.clip.as_ref().and_then(|clip| {
        let take = takes.iter().position(|take| take.name == clip.take)?;
        Some((take, f64::from(takes[take].start) + clip.after, clip.speed))
    });
    if let Some((take, seconds, _)) = found {
        playback::show_take(workspace, Some(take));
        playback::seek(workspace, seconds as f32);
    }
    workspace.player.set_playing(false, workspace.settings.speed, workspace.settings.repeat);
    let Some(plan) = &entered.scene.plan else { return };
    let mut scene = plan.new_scene();
    plan.scene_at(entered.time, &mut scene);
    let Some(model_from_scene) = place_in(&scene, &entered, &loaded, found) else { return };
    let own = Arc::from(&*plan.things()[entered.thing].id);
    let around = SceneAround {
        view: Arc::clone(&entered.scene),
        left_out: entered.hidden.iter().cloned().chain([own]).collect(),
        model_from_scene,
        clip: found.map(|(take, take_seconds, speed)| AroundClip {
            take,
            take_seconds,
            scene_seconds: entered.time.seconds(),
            speed,
        }),
        seconds: entered.time.seconds(),
    };
    if let Some(camera) = entered.camera {
        workspace.camera.set_free(moved(camera, model_from_scene));
    }
    workspace.around = Some(Arc::new(around));
}

/// Returns the matrix from the scene to the model, so that the model is where its thing is: with its first bone in the same place. `None` where the
/// thing has no size.
fn place_in(
    scene: &StageScene,
    entered: &EnteredThing,
    loaded: &Arc<LoadedModel>,
    take: Option<(usize, f64, f64)>,
) -> Option<Mat4> {
    let state = scene.things.get(entered.thing)?;
    let place = state.transform.to_matrix();
    let size = place.determinant().abs();
    if size.is_nan() || size <= 1e-30 {
        return None;
    }
    let model_from_scene = place.inverse();
    // The way that a take travels is part of the place in a scene, and part of the pose in the take.
    let in_scene = state.pose.as_ref().and_then(|pose| pose.to_root.matrices().next());
    let in_take = take.map(|(take, seconds, _)| {
        let mut evaluator = Evaluator::new(Arc::clone(&loaded.model));
        evaluator.pose(Some(take), seconds as f32);
        evaluator.to_root().first().copied()
    });
    let travelled = match (in_scene, in_take.flatten()) {
        (Some(own), Some(taken)) => taken.w_axis.truncate() - mat4(own).w_axis.truncate(),
        (Some(_) | None, _) => Vec3::ZERO,
    };
    Some(Mat4::from_translation(travelled) * model_from_scene)
}

/// Returns a camera that sees the same from the space of the model.
fn moved(camera: Camera, model_from_scene: Mat4) -> Camera {
    let target = model_from_scene.transform_point3(camera.target);
    let back = model_from_scene.transform_vector3(camera.back());
    let scale = back.length();
    let back = back / scale.max(f32::MIN_POSITIVE);
    let pitch = back.y.asin();
    // Seen from straight above, the direction of the view is that of its upper edge.
    let yaw = if back.with_y(0.0).length() > 1e-4 { back.x.atan2(back.z) } else { camera.yaw };
    Camera { target, distance: camera.distance * scale, yaw, pitch, ..camera }
}
