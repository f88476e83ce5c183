//! The small pictures of the shots of the scene that is open: which are wanted, and those that were drawn.

use super::shot_list::shots_of;
use crate::panels::keys::TimeWindow;
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::lanes::{SceneBar, SceneLanes};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::time::StageTime;
use egui::ColorImage;
use std::collections::BTreeMap;
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
    pictures: BTreeMap<ShotKey, ShotPicture>,
}

impl ShotKey {
    /// Returns the shot of a bar; `None` for other bars.
    pub fn of(script: &StageScript, bar: &SceneBar) -> Option<Self> {
        script.actions().get(bar.action).filter(|_| bar.kind == "shot")?;
        Some(Self { camera: script.element(bar.action).value("who")?.into(), begin: bar.begin })
    }
}

impl SceneThumbnails {
    /// Returns the newest picture of a shot.
    pub fn get(&self, shot: &ShotKey) -> Option<&Arc<ColorImage>> {
        self.pictures.get(shot)?.image.as_ref()
    }

    /// Returns the first shot of a part of time without a picture of the plan.
    pub fn wanted(
        &self,
        (script, plan): (&StageScript, &Arc<StagePlan>),
        lanes: &SceneLanes,
        shown: TimeWindow,
    ) -> Option<ShotKey> {
        let [from, to] = [shown.start, shown.start + shown.length];
        let in_sight =
            shots_of(lanes).iter().filter(|shot| shot.begin.seconds() <= to && shot.end.seconds() >= from);
        let is_old =
            |shot: &ShotKey| self.pictures.get(shot).is_none_or(|known| !Arc::ptr_eq(&known.plan, plan));
        in_sight.filter_map(|bar| ShotKey::of(script, bar)).find(is_old)
    }

    /// Notes the picture of a shot.
    pub fn receive(&mut self, shot: ShotKey, plan: Arc<StagePlan>, image: Option<Arc<ColorImage>>) {
        self.pictures.insert(shot, ShotPicture { plan, image });
    }

    /// Forgets the pictures of shots that are not there any more.
    pub fn keep_shots(&mut self, script: &StageScript, lanes: &SceneLanes) {
        let mut shots: Vec<ShotKey> =
            shots_of(lanes).iter().filter_map(|bar| ShotKey::of(script, bar)).collect();
        shots.sort();
        self.pictures.retain(|shot, _| shots.binary_search(shot).is_ok());
    }
}
