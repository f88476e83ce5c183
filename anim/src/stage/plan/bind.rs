//! Names of a script that mean parts of models: takes, bones, lines.

use super::fade::ActiveSpan;
use super::placement::Placement;
use super::places::PlaceLane;
use super::poses::PoseMask;
use super::properties::{PropertyLane, property_value};
use super::spot::StageSpot;
use super::thing::{FocusTarget, PlannedThing};
use crate::data::{BoneIndex, Skeleton};
use crate::fast::LaneMask;
use crate::ik::Gaze;
use crate::stage::assets::StageAssets;
use crate::stage::ground::SceneGround;
use crate::stage::model::StageModel;
use crate::stage::path::StagePath;
use crate::stage::script::{ErrorList, ScriptElement, StageScript, suggestion};
use crate::stage::table::{PROPERTIES, numbers, points, vector};
use crate::stage::time::{Decimal, StageTime};
use crate::trig::rotation_about;
use glam::{DQuat, DVec3, Vec3};
use std::f64::consts::PI;
use std::sync::Arc;

/// The things and paths of a script, with what their names mean.
pub(super) struct StageBinder<'a> {
    pub(super) script: &'a StageScript,
    pub(super) things: Vec<PlannedThing>,
    pub(super) ground: Arc<SceneGround>,
}

/// Returns a number of an element, or its default.
pub(super) fn number(element: &ScriptElement, name: &str) -> Option<f64> {
    element.value(name).and_then(Decimal::parse).map(Decimal::to_f64)
}

impl<'a> StageBinder<'a> {
    pub(super) fn new(script: &'a StageScript, assets: &StageAssets, errors: &mut ErrorList) -> Self {
        let mut binder = Self { script, things: Vec::new(), ground: Arc::default() };
        for element in script.things() {
            let model = binder.model(element, assets, errors);
            let path = (element.row.name == "path").then(|| path(element, assets, errors).map(Arc::new));
            let properties =
                PROPERTIES.iter().filter(|row| row.thing == element.row.name).map(|row| PropertyLane {
                    name: row.name,
                    base: element.value(row.name).map_or([0.0; 3], |text| property_value(row.kind, text)),
                    cues: Vec::new(),
                });
            binder.things.push(PlannedThing {
                id: element.value("id").unwrap_or_default().into(),
                kind: element.row.name,
                scale: number(element, "scale").unwrap_or(1.0),
                is_missing: model.is_none() && element.value("model").is_some(),
                model,
                path: path.flatten(),
                ground: None,
                tilt: tilt(element),
                places: PlaceLane { base: base(element), cues: Vec::new() },
                poses: vec![super::poses::PoseLane::default()],
                looks: Vec::new(),
                holds: Vec::new(),
                properties: properties.collect(),
                runs: Vec::new(),
                aim: None,
                focus: FocusTarget::Everything,
            });
        }
        for (index, element) in script.things().enumerate() {
            binder.things[index].aim = binder.spot(element, "look", errors);
            binder.things[index].focus = match number(element, "focus") {
                Some(distance) => FocusTarget::Distance(distance),
                None => {
                    binder.spot(element, "focus", errors).map_or(FocusTarget::Everything, FocusTarget::Spot)
                }
            };
        }
        binder
    }

    fn model(
        &self,
        element: &ScriptElement,
        assets: &StageAssets,
        errors: &mut ErrorList,
    ) -> Option<Arc<StageModel>> {
        let source = element.value("model")?;
        let model = assets.model(source).cloned();
        if model.is_none() && !assets.allows_missing_models() {
            let help = suggestion(source, "models", assets.model_names());
            errors.add(element.value_range("model"), format!("there is no model \"{source}\""), help);
        }
        model
    }

    /// Returns the thing that acts in an action.
    pub(super) fn who(&self, action: usize) -> Option<usize> {
        self.script.element(action).value("who").and_then(|who| self.script.thing_called(who))
    }

    /// Returns the take that an action plays.
    pub(super) fn take(&self, action: usize, errors: &mut ErrorList) -> Option<(usize, Arc<StageModel>)> {
        let element = self.script.element(action);
        let name = element.value("take").filter(|_| element.row.attribute("take").is_some())?;
        let model = self.things.get(self.who(action)?)?.model.clone();
        let found = model.as_ref().and_then(|model| model.take_called(name));
        if let (Some(model), None) = (&model, found) {
            let names = model.takes().iter().map(|take| take.name());
            let message = format!("\"{}\" has no take \"{name}\"", element.value("who").unwrap_or_default());
            errors.add(element.value_range("take"), message, suggestion(name, "takes", names));
        } else if model.is_none() {
            // A role without its model was reported; a thing that never has one is not.
            let who = self.who(action).map_or("", |who| self.things[who].kind);
            if !matches!(who, "role" | "prop") {
                errors.add(element.value_range("take"), format!("a {who} has no takes"), "");
            }
        }
        Some((found?, model?))
    }

    /// Returns the position that an attribute names; `None` where it is absent or wrong.
    pub(super) fn spot(
        &self,
        element: &ScriptElement,
        name: &str,
        errors: &mut ErrorList,
    ) -> Option<StageSpot> {
        let text = element.value(name)?;
        if let Some(point) = vector(text) {
            return Some(StageSpot::Point(point));
        }
        let (thing, bone) = text.split_once('.').map_or((text, None), |(thing, bone)| (thing, Some(bone)));
        let thing = self.script.thing_called(thing)?;
        let Some(bone) = bone else { return Some(StageSpot::Thing(thing)) };
        match &self.things[thing].model {
            Some(model) => {
                let found = self.bone(model, bone, &self.things[thing].id, element, name, errors);
                found.map(|bone| StageSpot::Bone(thing, bone))
            }
            None if self.things[thing].is_missing => Some(StageSpot::Thing(thing)),
            None => {
                if !matches!(self.things[thing].kind, "role" | "prop") {
                    let message = format!("a {} has no bones", self.things[thing].kind);
                    errors.add(element.value_range(name), message, "");
                }
                None
            }
        }
    }

    /// Returns the position that an attribute names, without a report of errors.
    pub(super) fn spot_of(&self, element: &ScriptElement, name: &str) -> Option<StageSpot> {
        self.script.with_errors(|errors| self.spot(element, name, errors)).ok().flatten()
    }

    fn bone(
        &self,
        model: &StageModel,
        bone: &str,
        thing: &str,
        element: &ScriptElement,
        attribute: &str,
        errors: &mut ErrorList,
    ) -> Option<BoneIndex> {
        let found = model.skeleton().find(bone);
        if found.is_none() {
            let names = model.skeleton().bones.iter().map(|bone| &*bone.name);
            let help = suggestion(bone, "bones", names);
            errors.add(element.value_range(attribute), format!("\"{thing}\" has no bone \"{bone}\""), help);
        }
        found
    }

    /// Returns the bones that the attribute `bones` of an action lists; `None` where it is absent or wrong.
    fn bones(&self, action: usize, errors: &mut ErrorList) -> Option<Vec<BoneIndex>> {
        let element = self.script.element(action);
        let names = element.value("bones")?;
        let thing = &self.things[self.who(action)?];
        let model = thing.model.as_ref()?;
        let find = |name: &str| self.bone(model, name.trim(), &thing.id, element, "bones", &mut *errors);
        names.split(',').map(find).collect()
    }

    /// Returns the mask of an action: the bones that it lists, with those below them, and the shape keys that belong to them.
    pub(super) fn mask(&self, action: usize, errors: &mut ErrorList) -> Option<PoseMask> {
        let bones = self.bones(action, errors)?;
        let model = self.things[self.who(action)?].model.as_ref()?;
        let is_in = branches(model.skeleton(), &bones);
        let moves =
            |bone: &Option<BoneIndex>| bone.is_some_and(|bone| is_in.get(bone as usize) == Some(&true));
        Some(PoseMask {
            shapes: model.shapes().bones().iter().map(moves).collect(),
            bones: LaneMask::new(is_in.iter().map(|&is_in| f32::from(u8::from(is_in)))),
        })
    }

    /// Returns the bones that look, the head last.
    pub(super) fn gazes(&self, action: usize, errors: &mut ErrorList) -> Option<Vec<Gaze>> {
        let thing = &self.things[self.who(action)?];
        let Some(model) = &thing.model else { return (thing.kind == "camera").then(Vec::new) };
        let element = self.script.element(action);
        let bones = match element.value("bones") {
            Some(_) => self.bones(action, errors)?,
            None => {
                let Some(head) = model.head() else {
                    let names = model.skeleton().bones.iter().map(|bone| &*bone.name);
                    let message = format!("\"{}\" has no bone called head; `bones` is needed", thing.id);
                    errors.add(element.name.clone(), message, suggestion("head", "bones", names));
                    return None;
                };
                vec![head]
            }
        };
        let is_chain = bones.windows(2).all(|pair| is_below(model.skeleton(), pair[1], pair[0]));
        if !is_chain {
            errors.add(element.value_range("bones"), "each bone has to be below the one before it", "");
            return None;
        }
        let count = bones.len();
        let gaze = |(index, &bone): (usize, &BoneIndex)| Gaze {
            up: model.bone_axis(bone, Vec3::Y),
            share: 1.0 / (count - index) as f32,
            limit: MOST_TURN,
            ..Gaze::new(bone, model.bone_axis(bone, Vec3::Z))
        };
        Some(bones.iter().enumerate().map(gaze).collect())
    }

    /// Returns the span of an action.
    pub(super) fn span(&self, action: usize, times: [StageTime; 2], releases: bool) -> ActiveSpan {
        ActiveSpan::new(action, self.script, times, releases)
    }
}

/// Largest turn of one bone that looks: 80 degrees.
const MOST_TURN: f32 = 1.396_263_4;

/// Returns where a thing is at first.
fn base(element: &ScriptElement) -> Placement {
    let facing = number(element, "facing").unwrap_or(0.0) * PI / 180.0;
    Placement { position: element.value("at").and_then(vector).unwrap_or(DVec3::ZERO), facing }
}

/// Returns how a thing is pitched and rolled.
fn tilt(element: &ScriptElement) -> DQuat {
    let angles = element.value("tilt").and_then(numbers).unwrap_or_default();
    let about = |axis: DVec3, index: usize| {
        rotation_about(axis, angles.get(index).copied().unwrap_or(0.0) * PI / 180.0)
    };
    about(DVec3::X, 0) * about(DVec3::Z, 1)
}

fn path(element: &ScriptElement, assets: &StageAssets, errors: &mut ErrorList) -> Option<StagePath> {
    let is_smooth = element.value("curve") == Some("smooth");
    if let Some(points) = element.value("points").and_then(points) {
        return Some(StagePath::new(&points, is_smooth));
    }
    let source = element.value("line")?;
    let Some(line) = assets.line(source) else {
        let help = suggestion(source, "lines", assets.line_names());
        errors.add(element.value_range("line"), format!("there is no line \"{source}\""), help);
        return None;
    };
    Some(StagePath::new(line, is_smooth))
}

/// Returns for each bone whether it is one of `bones` or below one.
fn branches(skeleton: &Skeleton, bones: &[BoneIndex]) -> Vec<bool> {
    let mut is_in = vec![false; skeleton.len()];
    for (index, bone) in skeleton.bones.iter().enumerate() {
        // A parent comes before its children.
        let above = bone.parent.is_some_and(|parent| is_in.get(parent as usize) == Some(&true));
        is_in[index] = above || bones.contains(&(index as BoneIndex));
    }
    is_in
}

fn is_below(skeleton: &Skeleton, bone: BoneIndex, above: BoneIndex) -> bool {
    skeleton.ancestors(bone).any(|one| one == above)
}
