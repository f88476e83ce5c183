//! The small pictures of the shots of the scene that is open: which are wanted, and those that were drawn.

use super::shot_list::shots_of;
use crate::panels::keys::TimeWindow;
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::lanes::{SceneBar, SceneLanes};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::time::StageTime;
use egui::ColorImage;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A shot by what its picture shows, so that an edit elsewhere in the script keeps the picture until there is a newer one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ShotKey {
    /// Id of the camera.
    pub camera: Arc<str>,
    /// When it begins.
    pub begin: StageTime,
}

/// A picture of a shot.
#[derive(Clone, Debug)]
struct ShotPicture {
    /// The plan that it shows.
    plan: Arc<StagePlan>,
    /// `None` where it could not be drawn.
    image: Option<Arc<ColorImage>>,
}

/// The pictures of the shots.
#[derive(Clone, Debug, Default)]
pub struct SceneThumbnails {
    /// By the ids of the cameras, and when the shots begin.
    pictures: BTreeMap<Arc<str>, BTreeMap<StageTime, ShotPicture>>,
}

impl ShotKey {
    /// Returns the shot of a bar; `None` for other bars.
    pub fn of(script: &StageScript, bar: &SceneBar) -> Option<Self> {
        Some(Self { camera: camera_of(script, bar)?.into(), begin: bar.begin })
    }
}

/// Returns the camera of the shot of a bar; `None` for other bars.
fn camera_of<'a>(script: &'a StageScript, bar: &SceneBar) -> Option<&'a str> {
    script.actions().get(bar.action).filter(|_| bar.kind == "shot")?;
    script.element(bar.action).value("who")
}

impl SceneThumbnails {
    /// Returns the newest picture of a shot.
    pub fn get(&self, shot: &ShotKey) -> Option<&Arc<ColorImage>> {
        self.picture(&shot.camera, shot.begin)?.image.as_ref()
    }

    /// Returns the newest picture of the shot of a bar. Allocates nothing.
    pub fn of_bar(&self, script: &StageScript, bar: &SceneBar) -> Option<&Arc<ColorImage>> {
        self.picture(camera_of(script, bar)?, bar.begin)?.image.as_ref()
    }

    fn picture(&self, camera: &str, begin: StageTime) -> Option<&ShotPicture> {
        self.pictures.get(camera)?.get(&begin)
    }

    /// Returns the first shot of a part of time without a picture of the plan.
    pub fn wanted(
        &self,
        (script, plan): (&StageScript, &Arc<StagePlan>),
        lanes: &SceneLanes,
        shown: TimeWindow,
    ) -> Option<ShotKey> {
        let [from, to] = [shown.start, shown.start + shown.length];
        let mut in_sight =
            shots_of(lanes).iter().filter(|shot| shot.begin.seconds() <= to && shot.end.seconds() >= from);
        let is_old = |bar: &&SceneBar| {
            let camera = camera_of(script, bar);
            let known = camera.map(|camera| self.picture(camera, bar.begin));
            known.is_some_and(|known| known.is_none_or(|known| !Arc::ptr_eq(&known.plan, plan)))
        };
        ShotKey::of(script, in_sight.find(is_old)?)
    }

    /// Notes the picture of a shot.
    pub fn receive(&mut self, shot: ShotKey, plan: Arc<StagePlan>, image: Option<Arc<ColorImage>>) {
        self.pictures.entry(shot.camera).or_default().insert(shot.begin, ShotPicture { plan, image });
    }

    /// Forgets the pictures of shots that are not there any more.
    pub fn keep_shots(&mut self, script: &StageScript, lanes: &SceneLanes) {
        let shots = shots_of(lanes).iter().filter_map(|bar| Some((camera_of(script, bar)?, bar.begin)));
        let shots: BTreeSet<(&str, StageTime)> = shots.collect();
        self.pictures.retain(|camera, pictures| {
            pictures.retain(|begin, _| shots.contains(&(&**camera, *begin)));
            !pictures.is_empty()
        });
    }
}
