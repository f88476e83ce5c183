//! The surfaces of a scene, to find what a line of sight meets: for files that are dropped, for the focus of cameras, for lines on surfaces.

use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::{SceneModel, SceneView};
use dragonfly_picture::camera::CameraRay;
use dragonfly_picture::{PosedScene, SurfaceHit};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A posed scene that is kept while the same one is asked about; nothing before it is asked for the first time.
#[derive(Default)]
pub struct SceneProbe(Option<ProbedScene>);

struct ProbedScene {
    plan: Arc<StagePlan>,
    models: Arc<BTreeMap<String, SceneModel>>,
    hidden: Vec<Arc<str>>,
    posed: PosedScene,
}

impl SceneProbe {
    /// Returns where a line of sight first meets a surface at `time`. The things with the ids `hidden` are left out.
    pub fn hit(
        &mut self,
        scene: &SceneView,
        hidden: &[Arc<str>],
        time: StageTime,
        ray: &CameraRay,
    ) -> Option<SurfaceHit> {
        let plan = scene.plan.as_ref()?;
        let is_same = |known: &ProbedScene| {
            Arc::ptr_eq(&known.plan, plan)
                && Arc::ptr_eq(&known.models, &scene.models)
                && known.hidden == hidden
        };
        let mut probed = match self.0.take() {
            Some(known) if is_same(&known) => known,
            known => ProbedScene {
                plan: Arc::clone(plan),
                models: Arc::clone(&scene.models),
                hidden: hidden.to_vec(),
                posed: PosedScene::new(scene, hidden, known.map(|known| known.posed))?,
            },
        };
        probed.posed.pose(time.seconds());
        let hit = probed.posed.hit_first(ray);
        self.0 = Some(probed);
        hit
    }

    /// Forgets the scene: its memory is free again.
    pub fn clear(&mut self) {
        self.0 = None;
    }
}
