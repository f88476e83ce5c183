//! The scene of a script on the processor: every thing at its place and in its pose at a time, laid out for the device.
//!
//! Things with the same model share it, and their draw calls. Everything is computed into memory that is allocated when the scene is shown;
//! at a time that was computed last, nothing is computed.

mod group;
mod lens;
mod light;
mod pick;
mod placeholder;

pub use lens::camera as viewport_camera;
pub(crate) use light::bright;
pub use light::{LightKind, SceneLight};
pub use pick::{PickedThing, SurfaceHit};
pub(crate) use placeholder::made_model;
pub use placeholder::placeholder_box;

use super::batch::DrawBatch;
use super::contact::{ShadowedGround, add_spots};
use super::draw_set::{DrawSet, PaletteLayout};
use super::frustum::ViewFrustum;
use super::uniform::{LightUniform, SPOTS};
use crate::camera::Camera;
use dragonfly_anim::bounds::{AxisBox, Bounds, Sphere};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{PlannedThing, StageCamera, StagePlan, StageScene};
use dragonfly_document::{LoadedModel, SceneModel, SceneView};
use glam::{Mat4, Vec3, Vec4};
use group::CastGroup;
use placeholder::Placeholders;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

/// Largest number of matrices of one model: what a device can bind at once. Further copies are not drawn.
const MOST_MATRICES: usize = 2_000_000;

/// Largest number of bytes of the matrices, weights and items of all things. Further things are not drawn.
const MOST_BYTES: usize = 256 << 20;

/// The camera through which a scene is seen.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum ThroughCamera {
    /// The free one, which the user moves.
    #[default]
    Free,
    /// The one of the shot; the free one where the cast has no camera.
    Shot,
    /// The camera with this id; the free one where there is none.
    Of(Arc<str>),
}

/// The place of a thing among what is drawn: its group, and its copy in it.
#[derive(Clone, Copy, Debug)]
struct CastMember {
    group: usize,
    copy: usize,
    is_placeholder: bool,
}

/// A scene in the state of one time.
pub struct PosedScene {
    plan: Arc<StagePlan>,
    level: SimdLevel,
    /// Width divided by height of the image of the script.
    aspect: f32,
    state: StageScene,
    groups: Vec<CastGroup>,
    /// For each thing; `None` without anything to draw.
    members: Vec<Option<CastMember>>,
    /// For each thing: whether it is neither drawn nor picked.
    hidden: Vec<bool>,
    /// Boxes around the things in the scene; empty without anything to draw.
    boxes: Vec<AxisBox>,
    bounds: Bounds,
    lights: Vec<SceneLight>,
    spots: [Vec4; SPOTS],
    placeholders: Placeholders,
    /// Distance, group and item of each blended item, farthest first.
    back_to_front: Vec<(f32, u32, u32)>,
    /// Draw calls of blended surfaces, farthest first: a group, and a part of its draw calls.
    runs: Vec<(usize, Range<usize>)>,
    at: Option<StageTime>,
    /// Matrix from the space of the scene to that in which it is drawn.
    frame: Mat4,
}

impl PosedScene {
    /// Returns the scene of `view` before its first time; `None` without a plan. What it has in common with the scene shown `before` is kept.
    /// The things with the ids `hidden` are neither drawn nor picked, and lights among them do not shine.
    pub fn new(view: &SceneView, hidden: &[Arc<str>], before: Option<Self>) -> Option<Self> {
        let plan = Arc::clone(view.plan.as_ref()?);
        let hidden: HashSet<&str> = hidden.iter().map(|id| &**id).collect();
        let is_hidden = |thing: &PlannedThing| hidden.contains(&*thing.id);
        let hidden: Vec<bool> = plan.things().iter().map(is_hidden).collect();
        let (mut old_groups, mut placeholders) =
            before.map_or_else(Default::default, |before| (before.groups, before.placeholders));
        let mut drawn = models(view, &plan, &mut placeholders);
        for (drawn, _) in drawn.iter_mut().zip(&hidden).filter(|(_, hidden)| **hidden) {
            *drawn = None;
        }
        let mut groups: Vec<(Arc<LoadedModel>, PaletteLayout, usize)> = Vec::new();
        let mut bytes = 0;
        let mut index: HashMap<*const LoadedModel, usize> = HashMap::new();
        let members: Vec<Option<CastMember>> = drawn
            .into_iter()
            .map(|drawn| {
                let (loaded, is_placeholder) = drawn?;
                let group = *index.entry(Arc::as_ptr(&loaded)).or_insert_with(|| {
                    let layout = PaletteLayout::of(&loaded.model);
                    groups.push((loaded, layout, 0));
                    groups.len() - 1
                });
                let (_, layout, copies) = &mut groups[group];
                let with_own = bytes + layout.bytes();
                if (*copies + 1) * layout.matrices > MOST_MATRICES || with_own > MOST_BYTES {
                    return None;
                }
                let member = CastMember { group, copy: *copies, is_placeholder };
                (bytes, *copies) = (with_own, *copies + 1);
                Some(member)
            })
            .collect();
        let groups: Vec<CastGroup> = groups
            .into_iter()
            .map(|(loaded, layout, copies)| {
                let same = |group: &CastGroup| group.is_of(&loaded, copies);
                match old_groups.iter().position(same) {
                    Some(old) => old_groups.swap_remove(old),
                    None => CastGroup::new(loaded, layout, copies),
                }
            })
            .collect();
        let blended = groups.iter().map(|group| group.draws().blended()).sum();
        let [width, height] = view.script.as_ref().map_or([16, 9], |script| script.size());
        Some(Self {
            level: SimdLevel::best(),
            aspect: width.max(1) as f32 / height.max(1) as f32,
            state: plan.new_scene(),
            boxes: vec![AxisBox::EMPTY; members.len()],
            members,
            groups,
            bounds: Bounds::default(),
            lights: light::of_script(view, &plan, &hidden),
            hidden,
            spots: [Vec4::ZERO; SPOTS],
            placeholders,
            back_to_front: Vec::with_capacity(blended),
            runs: Vec::with_capacity(blended),
            at: None,
            frame: Mat4::IDENTITY,
            plan,
        })
    }

    /// Returns the same scene in another space, by the matrix from its own space to that one.
    pub(super) fn seen_from(self, frame: Mat4) -> Self {
        Self { frame, at: None, ..self }
    }

    /// The plan.
    pub fn plan(&self) -> &Arc<StagePlan> {
        &self.plan
    }

    /// The state of all things at the time computed last.
    pub fn state(&self) -> &StageScene {
        &self.state
    }

    /// Width divided by height of the image of the script.
    pub fn aspect(&self) -> f32 {
        self.aspect
    }

    /// The lights at the time computed last.
    pub fn lights(&self) -> &[SceneLight] {
        &self.lights
    }

    /// The things, by their models.
    pub fn draw_sets(&self) -> impl Iterator<Item = &DrawSet> + Clone {
        self.groups.iter().map(CastGroup::draws)
    }

    /// The draw calls of blended surfaces, farthest first.
    pub(super) fn blended_runs(&self) -> impl Iterator<Item = (&DrawSet, &[DrawBatch])> {
        self.runs.iter().map(|(group, range)| {
            let set = self.groups[*group].draws();
            (set, &set.batches().blended()[range.clone()])
        })
    }

    /// Computes the scene at `seconds`. Allocates nothing; at the time computed last, it does nothing.
    pub fn pose(&mut self, seconds: f64) {
        // A clock of single precision means the frame that it is nearest to; any other time is exact.
        let time = match f64::from(seconds as f32) == seconds {
            true => self.plan.rate().time_of(seconds),
            false => StageTime::from_seconds(seconds),
        };
        if self.at == Some(time) {
            return;
        }
        self.at = Some(time);
        self.plan.scene_at(time, &mut self.state);
        let mut around = AxisBox::EMPTY;
        for (thing, member) in self.members.iter().enumerate() {
            let Some(CastMember { group, copy, is_placeholder }) = *member else { continue };
            let mut place = self.state.things[thing].transform;
            if is_placeholder {
                place.scale = Vec3::ONE;
            }
            let pose = self.state.things[thing].pose.as_ref();
            self.boxes[thing] =
                self.groups[group].pose(self.level, copy, self.frame * place.to_matrix(), pose);
            around = around.union(self.boxes[thing]);
        }
        self.bounds = bounds_of(&around);
        self.place_spots();
        light::update(&mut self.lights, &self.state);
    }

    /// Computes the spots of the contact shadow: an equal number for each thing.
    fn place_spots(&mut self) {
        self.spots = [Vec4::ZERO; SPOTS];
        let count = self.members.iter().flatten().count();
        let each = (SPOTS / count.max(1)).clamp(1, 16);
        let height = self.ground();
        let members = self.members.iter().enumerate().filter_map(|(thing, member)| Some((thing, (*member)?)));
        for (spots, (thing, member)) in self.spots.chunks_exact_mut(each).zip(members) {
            let draws = self.groups[member.group].draws();
            let ground = ShadowedGround { radius: self.boxes[thing].half().length(), height };
            add_spots(spots, draws.part_boxes(), draws.palettes_of(member.copy), ground);
        }
    }

    /// Collects the draw calls of what is inside `frustum`, blended surfaces by their distance from `eye`. Allocates nothing.
    pub fn batch(&mut self, eye: Vec3, back: Vec3, frustum: &ViewFrustum) {
        self.back_to_front.clear();
        for (group, draws) in (0..).zip(&mut self.groups) {
            draws.draws_mut().batch_solid(frustum);
            let order = &mut self.back_to_front;
            draws.draws().for_each_blended(eye, back, |distance, item| order.push((distance, group, item)));
        }
        self.back_to_front.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        self.runs.clear();
        for &(_, group, item) in &self.back_to_front {
            let group = group as usize;
            let draws = self.groups[group].draws_mut();
            let before = draws.batches().blended().len();
            let is_first = self.runs.last().is_none_or(|run| run.0 != group);
            draws.add_blended(item, frustum, is_first);
            let after = draws.batches().blended().len();
            match self.runs.last_mut() {
                Some(run) if !is_first => run.1.end = after,
                _ if after > before => self.runs.push((group, before..after)),
                _ => {}
            }
        }
    }

    /// Collects the draw calls of what casts shadows in each of some maps, as [`DrawSet::batch_casters`] does.
    pub(super) fn batch_casters(&mut self, maps: impl Iterator<Item = ViewFrustum> + Clone) {
        for group in &mut self.groups {
            group.draws_mut().batch_casters(maps.clone());
        }
    }

    /// Returns the height of the ground, meters.
    pub(super) fn ground(&self) -> f32 {
        self.plan.ground_plane() as f32
    }

    /// The spots of the contact shadow at the time computed last.
    pub(super) fn spots(&self) -> &[Vec4; SPOTS] {
        &self.spots
    }

    /// Writes the lights for the device. Returns their number.
    pub(super) fn write_lights(&self, out: &mut [LightUniform]) -> usize {
        light::write(&self.lights, out)
    }

    /// Bounds of everything that is drawn at the time computed last.
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The box around a thing at the time computed last; empty without anything to draw, and past the end.
    pub fn box_of(&self, thing: usize) -> AxisBox {
        self.boxes.get(thing).copied().unwrap_or(AxisBox::EMPTY)
    }

    /// Returns whether a thing is hidden: neither drawn nor picked.
    pub fn is_hidden(&self, thing: usize) -> bool {
        self.hidden.get(thing).copied().unwrap_or(false)
    }

    /// The camera of the script through which `through` looks; `None` for the free one.
    pub fn stage_camera(&self, through: &ThroughCamera) -> Option<StageCamera> {
        match through {
            ThroughCamera::Free => None,
            ThroughCamera::Shot => self.state.camera,
            ThroughCamera::Of(id) => self.plan.camera_of(self.plan.thing_called(id)?, &self.state),
        }
    }

    /// The same as a camera of a viewport with this ratio of width to height.
    pub(super) fn camera(&self, through: &ThroughCamera, aspect: f32) -> Option<Camera> {
        let camera = self.stage_camera(through)?;
        Some(lens::camera(&camera, self.aspect, aspect, &self.bounds.sphere))
    }
}

/// Returns the model of each thing that has one, and whether it is a placeholder.
fn models(
    view: &SceneView,
    plan: &StagePlan,
    placeholders: &mut Placeholders,
) -> Vec<Option<(Arc<LoadedModel>, bool)>> {
    let elements = view.script.iter().flat_map(|script| script.things());
    let sources: HashMap<&str, &str> =
        elements.filter_map(|element| Some((element.value("id")?, element.value("model")?))).collect();
    let model = |thing: &PlannedThing| {
        if !matches!(thing.kind, "role" | "prop") {
            return None;
        }
        let source = sources.get(&*thing.id).and_then(|source| view.models.get(*source));
        Some(match source {
            Some(SceneModel::Loaded(loaded)) => (Arc::clone(loaded), false),
            Some(SceneModel::Loading | SceneModel::Missing(_)) | None => {
                (placeholders.of(&thing.id, thing.kind == "role"), true)
            }
        })
    };
    plan.things().iter().map(model).collect()
}

fn bounds_of(around: &AxisBox) -> Bounds {
    if around.is_empty() {
        return Bounds::default();
    }
    let sphere = Sphere { center: around.center(), radius: around.half().length() };
    Bounds { min: around.min, max: around.max, sphere }
}
