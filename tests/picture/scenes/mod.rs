//! The scene of a script: everything at its place and in its pose, seen through its cameras, in the light of its lamps.

mod around;
mod cameras;
mod cost;
mod drawing;
mod limits;
mod lines;
mod picking;
mod posing;
mod second_view;
mod shapes;
mod sub_frames;
mod thumbnail;

use dragonfly_anim::stage::script::{ScriptContext, StageScript};
use dragonfly_anim::stage::{StageAssets, StageModel, StagePlan, StageScene};
use dragonfly_document::{LoadedModel, SceneModel, SceneView};
use dragonfly_kit::document::arm;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::scene::Scene;
use dragonfly_picture::{Look, PictureSettings, ThroughCamera};
use glam::{Quat, Vec2, Vec3};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

/// Ratio of the sides of images in these tests: that of the scripts.
pub(crate) const SIZE: [u32; 2] = [320, 180];

/// Returns the text of a script with a cast and actions.
pub(crate) fn script(cast: &str, actions: &str) -> String {
    format!("<script version=\"1\" fps=\"24\" size=\"320x180\"><cast>{cast}</cast>{actions}</script>")
}

/// Returns two arms that bend, one of them mirrored by its direction, and two cameras.
pub(crate) fn arms() -> String {
    script(
        r#"<role id="anna" model="arm" at="-2 0 0"/><role id="ben" model="arm" at="2 0 1" facing="180" scale="0.5"/>
        <camera id="wide" at="0 1.5 9" look="0 1.2 0"/><camera id="close" at="-2 3 4" look="anna" lens="85mm"/>
        <path id="way" points="2 0 1  2 0 3"/><mark id="door" at="0 0 2"/>"#,
        r#"<play who="anna" take="bend"/><move who="ben" path="way" dur="2"/>
        <shot who="wide" begin="0"/><shot who="close" begin="1.5" blend="0.5"/>"#,
    )
}

/// Returns the view of a script whose models are all the arm. Models called "lost" are missing.
pub(crate) fn view(text: &str) -> Arc<SceneView> {
    view_of(text, &arm::loaded())
}

fn view_of(text: &str, loaded: &Arc<LoadedModel>) -> Arc<SceneView> {
    view_in(&ScriptContext::default(), text, loaded)
}

/// Returns the view of a script in the project of a context.
fn view_in(context: &ScriptContext, text: &str, loaded: &Arc<LoadedModel>) -> Arc<SceneView> {
    let script = StageScript::read_in(text, context);
    let script = script.unwrap_or_else(|errors| panic!("{}", errors[0].in_file(text)));
    let (mut assets, mut models) = (StageAssets::default(), BTreeMap::new());
    for source in script.things().filter_map(|thing| thing.value("model")) {
        let is_lost = source == "lost";
        let data = if is_lost { Arc::default() } else { Arc::clone(&loaded.model) };
        assets.add_model(source, Arc::new(StageModel::new(data)));
        let model = SceneModel::Loaded(Arc::clone(loaded));
        models
            .insert(source.to_owned(), if is_lost { SceneModel::Missing("gone".to_owned()) } else { model });
    }
    let plan =
        StagePlan::new(&script, &assets).unwrap_or_else(|errors| panic!("{}", errors[0].in_file(text)));
    Arc::new(SceneView {
        text: text.into(),
        script: Some(Arc::new(script)),
        plan: Some(Arc::new(plan)),
        models: Arc::new(models),
        ..SceneView::default()
    })
}

/// Returns the scene of a view at a time, as it is seen through its shots.
pub(crate) fn shown(view: &Arc<SceneView>, seconds: f32) -> Scene {
    let now = Instant::now();
    let mut scene = Scene::new(now);
    scene.show_scene(view);
    scene.look = Look { viewport: [0, 0, SIZE[0], SIZE[1]], through: ThroughCamera::Shot, ..Look::default() };
    let length = view.plan.as_ref().map_or(0.0, |plan| plan.length().seconds());
    scene.playback = PlaybackClock::of_scene(length, now).seek(seconds, now);
    scene.prepare(now);
    scene
}

/// Returns the scene that a plan has at a time, computed apart from what is drawn.
fn state(view: &SceneView, seconds: f64) -> StageScene {
    let plan = view.plan.as_ref().unwrap();
    let mut state = plan.new_scene();
    plan.scene_at(dragonfly_anim::stage::time::StageTime::from_seconds(seconds), &mut state);
    state
}

/// Returns where a point is in the image of a camera: right and up from -1 to 1; `None` for one that is not in front of it.
///
/// An image 36 mm wide at the distance of the focal length.
fn projected(position: Vec3, rotation: Quat, lens: f32, point: Vec3) -> Option<Vec2> {
    let seen = rotation.inverse() * (point - position);
    let depth = -seen.z;
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    (depth > 0.0).then(|| Vec2::new(seen.x, seen.y * aspect) / depth * lens / 18.0)
}

/// Returns where a point is in the image of a scene that was prepared.
fn drawn_at(scene: &Scene, point: Vec3) -> Option<Vec2> {
    let clip = scene.clip_from_world(&scene.bounds().sphere) * point.extend(1.0);
    (clip.w > 0.0).then(|| clip.truncate().truncate() / clip.w)
}

/// Returns settings of a small image of a scene over nothing.
pub(crate) fn settings(through: ThroughCamera, time: f32) -> PictureSettings {
    let look = Look { through, ..Look::default() };
    PictureSettings {
        size: SIZE,
        time,
        look,
        background: Some([0; 4]),
        grid: false,
        ..PictureSettings::default()
    }
}
