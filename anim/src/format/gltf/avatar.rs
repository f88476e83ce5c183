//! The extensions about models of persons: `VRM` (0.x), `VRMC_vrm` (1.0) and, for animation files, `VRMC_vrm_animation`.
//!
//! Humanoid bones and the morph targets of expressions are read; what else the extensions contain (permissions, spring
//! bones, gaze, materials) is kept by saves and not used. What refers to something that is not there is left out, with a
//! warning.

use super::accessor::GltfDocument;
use super::check as code;
use super::scene::SceneLayout;
use crate::data::{Avatar, ExpressionBind, FaceExpression, HumanBone};
use crate::format::{ImportContext, ImportError, Place, one_line};
use gltf::json;
use serde_json::{Map, Value};
use std::collections::HashMap;

/// Names of the extension objects in the root; the first one that a file has is read.
pub(super) const VRM_1: &str = "VRMC_vrm";
pub(super) const VRM_ANIMATION: &str = "VRMC_vrm_animation";
pub(super) const VRM_0: &str = "VRM";

/// Parts of the body as the file names them: name in VRM 1.0, and number of the node.
pub(super) struct NamedNodes {
    /// The extension.
    kind: &'static str,
    bones: Vec<(String, usize)>,
    /// Nodes of the expressions of an animation file.
    expressions: Vec<(String, usize)>,
}

/// Names of the expressions of VRM 0.x, and those of VRM 1.0 for them.
const EXPRESSIONS_OF_VRM_0: [(&str, &str); 17] = [
    ("neutral", "neutral"),
    ("a", "aa"),
    ("i", "ih"),
    ("u", "ou"),
    ("e", "ee"),
    ("o", "oh"),
    ("joy", "happy"),
    ("angry", "angry"),
    ("sorrow", "sad"),
    ("fun", "relaxed"),
    ("blink", "blink"),
    ("blink_l", "blinkLeft"),
    ("blink_r", "blinkRight"),
    ("lookup", "lookUp"),
    ("lookdown", "lookDown"),
    ("lookleft", "lookLeft"),
    ("lookright", "lookRight"),
];

/// Finds the nodes that the extension names, and sets `is_bone` for each.
pub(super) fn mark_bones(
    root: &json::Root,
    is_bone: &mut [bool],
    context: &ImportContext<'_>,
) -> Result<Option<NamedNodes>, ImportError> {
    let Some((kind, object)) = extension(root) else { return Ok(None) };
    let mut named = NamedNodes { kind, bones: Vec::new(), expressions: Vec::new() };
    let path = format!("/extensions/{kind}/humanoid/humanBones");
    for (place, name, entry) in
        entries(object.get("humanoid").and_then(|humanoid| humanoid.get("humanBones")))
    {
        context.work(1)?;
        let name = match name {
            Some(name) => name.to_owned(),
            None => modern_bone(text(entry, "bone")),
        };
        let place = Place::Pointer(format!("{path}/{}", one_line(&place)));
        let Some(node) = node_of(entry, root, &place, context) else { continue };
        let is_known = named.bones.iter().any(|(other, at)| *other == name || *at == node);
        if is_known || name.is_empty() {
            context.warn(place, code::VRM_INVALID, "the humanoid bone has no name, or is there twice");
            continue;
        }
        context.charge(&place, 2 * (name.len() + size_of::<(String, usize)>()) as u64)?;
        named.bones.push((name, node));
        if named.bones.len() > MOST_BONES {
            break;
        }
    }
    if kind == VRM_ANIMATION {
        for group in ["preset", "custom"] {
            let path = format!("/extensions/{kind}/expressions/{group}");
            let list = object.get("expressions").and_then(|expressions| expressions.get(group));
            for (at, name, entry) in entries(list).into_iter().take(MOST_EXPRESSIONS) {
                context.work(1)?;
                let place = Place::Pointer(format!("{path}/{}", one_line(&at)));
                let Some(node) = node_of(entry, root, &place, context) else { continue };
                let name = name.unwrap_or_default().to_owned();
                context.charge(&place, 2 * (name.len() + size_of::<FaceExpression>()) as u64)?;
                named.expressions.push((name, node));
            }
        }
    }
    for (_, node) in named.bones.iter().chain(&named.expressions) {
        if let Some(is) = is_bone.get_mut(*node) {
            *is = true;
        }
    }
    Ok(Some(named))
}

/// Largest number of humanoid bones; VRM knows 55 names.
const MOST_BONES: usize = 256;

/// Largest number of preset and of custom expressions.
const MOST_EXPRESSIONS: usize = 1024;

/// Returns the humanoid bones and the expressions of a document.
pub(super) fn avatar(
    document: &GltfDocument<'_>,
    named: Option<NamedNodes>,
    stage: &SceneLayout,
) -> Result<Avatar, ImportError> {
    let Some((named, (_, object))) = named.zip(extension(document.root)) else {
        return Ok(Avatar::default());
    };
    let bone = |node: usize| stage.bones.get(node).copied().flatten();
    let bones =
        named.bones.into_iter().filter_map(|(name, node)| Some(HumanBone { name, bone: bone(node)? }));
    let mut avatar =
        Avatar { bones: bones.collect(), expressions: Vec::new(), faces_minus_z: named.kind == VRM_0 };
    for (name, node) in named.expressions {
        let weight_bone = bone(node);
        add(&mut avatar, FaceExpression { name, binds: Vec::new(), weight_bone });
    }
    let reader = ExpressionReader { document, stage };
    match named.kind {
        VRM_0 => reader.groups(object, &mut avatar)?,
        VRM_1 => reader.expressions(object, &mut avatar)?,
        _ => {}
    }
    Ok(avatar)
}

/// Adds an expression unless there is one of this name.
fn add(avatar: &mut Avatar, expression: FaceExpression) {
    if avatar.expressions.iter().all(|other| other.name != expression.name) {
        avatar.expressions.push(expression);
    }
}

struct ExpressionReader<'a> {
    document: &'a GltfDocument<'a>,
    stage: &'a SceneLayout,
}

impl ExpressionReader<'_> {
    /// Reads the expressions of VRM 1.0.
    fn expressions(&self, object: &Map<String, Value>, avatar: &mut Avatar) -> Result<(), ImportError> {
        for group in ["preset", "custom"] {
            let list = object.get("expressions").and_then(|expressions| expressions.get(group));
            for (at, name, entry) in entries(list).into_iter().take(MOST_EXPRESSIONS) {
                let path =
                    format!("/extensions/{VRM_1}/expressions/{group}/{}/morphTargetBinds", one_line(&at));
                let mut binds = Vec::new();
                for (number, bind) in list_of(entry, "morphTargetBinds").iter().enumerate() {
                    let node = whole(bind, "node");
                    let instance = node.and_then(|node| self.stage.instance_of(node)).into_iter();
                    let weight = bind.get("weight").and_then(Value::as_f64).unwrap_or(1.0);
                    self.bind(&format!("{path}/{number}"), bind, instance, weight, &mut binds)?;
                }
                self.charge(&path, name)?;
                let name = name.unwrap_or_default().to_owned();
                add(avatar, FaceExpression { name, binds, weight_bone: None });
            }
        }
        Ok(())
    }

    /// Reads the blend shape groups of VRM 0.x.
    fn groups(&self, object: &Map<String, Value>, avatar: &mut Avatar) -> Result<(), ImportError> {
        let groups =
            object.get("blendShapeMaster").map_or(&[][..], |master| list_of(master, "blendShapeGroups"));
        let mut instances: HashMap<usize, Vec<u32>> = HashMap::new();
        for (number, instance) in (0..).zip(&self.stage.instances) {
            self.document.context.work(1)?;
            instances.entry(instance.mesh as usize).or_default().push(number);
        }
        for (number, group) in groups.iter().enumerate().take(MOST_EXPRESSIONS) {
            let path = format!("/extensions/{VRM_0}/blendShapeMaster/blendShapeGroups/{number}");
            let mut binds = Vec::new();
            for (number, bind) in list_of(group, "binds").iter().enumerate() {
                let instances =
                    whole(bind, "mesh").and_then(|mesh| instances.get(&mesh)).into_iter().flatten();
                let instances = instances.copied();
                let weight = bind.get("weight").and_then(Value::as_f64).unwrap_or(100.0) / 100.0;
                self.bind(&format!("{path}/binds/{number}"), bind, instances, weight, &mut binds)?;
            }
            let preset = text(group, "presetName");
            let modern = EXPRESSIONS_OF_VRM_0.iter().find(|(old, _)| old.eq_ignore_ascii_case(preset));
            let name = modern.map_or(text(group, "name"), |(_, name)| name);
            self.charge(&path, Some(name))?;
            add(avatar, FaceExpression { name: name.to_owned(), binds, weight_bone: None });
        }
        Ok(())
    }

    fn charge(&self, path: &str, name: Option<&str>) -> Result<(), ImportError> {
        self.document.context.work(1)?;
        let bytes = 2 * (name.map_or(0, str::len) + size_of::<FaceExpression>());
        self.document.context.charge(&Place::Pointer(path.to_owned()), bytes as u64)
    }

    /// Adds a bind for each instance of a mesh.
    fn bind(
        &self,
        path: &str,
        bind: &Value,
        instances: impl Iterator<Item = u32>,
        weight: f64,
        binds: &mut Vec<ExpressionBind>,
    ) -> Result<(), ImportError> {
        let context = self.document.context;
        let place = Place::Pointer(path.to_owned());
        let target = whole(bind, "index").and_then(|target| u32::try_from(target).ok());
        let before = binds.len();
        for instance in instances {
            context.work(1)?;
            context.charge(&place, 2 * size_of::<ExpressionBind>() as u64)?;
            let targets = self.stage.instances.get(instance as usize).map_or(0, |it| it.morph_weights.len());
            if let Some(target) = target.filter(|&target| (target as usize) < targets) {
                binds.push(ExpressionBind { instance, target, weight: weight.clamp(0.0, 1.0) as f32 });
            }
        }
        if binds.len() == before {
            let text = "the expression sets a morph target that is not shown; it is left out";
            context.warn(place, code::VRM_INVALID, text);
        }
        Ok(())
    }
}

fn extension(root: &json::Root) -> Option<(&'static str, &Map<String, Value>)> {
    let others = &root.extensions.as_ref()?.others;
    [VRM_1, VRM_ANIMATION, VRM_0].into_iter().find_map(|name| Some((name, others.get(name)?.as_object()?)))
}

/// Returns the entries of an object, or of a list, with their places: name or number; the name for an object only.
fn entries(value: Option<&Value>) -> Vec<(String, Option<&str>, &Value)> {
    match value {
        Some(Value::Object(object)) => {
            object.iter().map(|(name, value)| (name.clone(), Some(name.as_str()), value)).collect()
        }
        Some(Value::Array(list)) => {
            list.iter().enumerate().map(|(number, value)| (number.to_string(), None, value)).collect()
        }
        _ => Vec::new(),
    }
}

fn list_of<'v>(value: &'v Value, name: &str) -> &'v [Value] {
    value.get(name).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

fn text<'v>(value: &'v Value, name: &str) -> &'v str {
    value.get(name).and_then(Value::as_str).unwrap_or_default()
}

fn whole(value: &Value, name: &str) -> Option<usize> {
    value.get(name).and_then(Value::as_u64).and_then(|number| usize::try_from(number).ok())
}

/// Returns the node of an entry; `None`, with a warning, if there is none.
fn node_of(entry: &Value, root: &json::Root, place: &Place, context: &ImportContext<'_>) -> Option<usize> {
    // Some exporters write -1 for bones that the model lacks.
    let node = whole(entry, "node").filter(|&node| node < root.nodes.len());
    if node.is_none() {
        context.warn(place.clone(), code::VRM_INVALID, "the node does not exist; it is left out");
    }
    node
}

/// Returns the name in VRM 1.0 of a bone of VRM 0.x, where the joints of a thumb have the names of the next ones.
fn modern_bone(name: &str) -> String {
    for (old, new) in [("ThumbProximal", "ThumbMetacarpal"), ("ThumbIntermediate", "ThumbProximal")] {
        if let Some(side) = name.strip_suffix(old) {
            return format!("{side}{new}");
        }
    }
    name.to_owned()
}
