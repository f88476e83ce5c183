//! `dragonfly info FILE`: lists the contents of a file.

use super::Failure;
use super::choice::{File, plain};
use super::info_figure::InfoFigure;
use super::output::{print, print_json};
use super::run_command::RunCommand;
use super::table::{Side, Table, count};
use dragonfly_anim::data::{Avatar, BoneIndex, ModelData, Skeleton};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{Conversion, Handedness};
use dragonfly_document::LoadedModel;
use serde::Serialize;
use std::io::{self, Write};
use std::sync::Arc;

/// Maximum number of bones listed in the text output; the others are only counted.
const BONES_SHOWN: usize = 80;

/// List the contents of a file: bones, skins, takes, meshes, materials, size, and import warnings
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  dragonfly info Fox.glb\n  dragonfly info Fox.glb --json | jq '.takes[].name'"
)]
pub(super) struct InfoArguments {
    #[command(flatten)]
    file: File,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
}

impl RunCommand for InfoArguments {
    fn run(self) -> Result<(), Failure> {
        let info = Info::of(self.file.load_checked()?);
        if self.json { print_json(&info) } else { print(|out| info.write(out)) }
    }
}

#[derive(Serialize)]
struct Info {
    file: String,
    format: &'static str,
    conventions: InfoConventions,
    bones: Vec<InfoBone>,
    avatar: InfoAvatar,
    skins: Vec<InfoSkin>,
    takes: Vec<InfoTake>,
    meshes: Vec<InfoMesh>,
    materials: Vec<InfoMaterial>,
    bounds: InfoBounds,
    figure: InfoFigure,
    warnings: Vec<String>,
}

/// Units, axes and frame rate of the file, and where each is known from: `format`, `file`, `guessed`, `chosen`.
#[derive(Serialize)]
struct InfoConventions {
    meters_per_unit: f32,
    up: String,
    left_handed: bool,
    frame_rate: Option<f32>,
    sources: Vec<String>,
    #[serde(skip)]
    text: String,
}

impl InfoConventions {
    fn of(conversion: &Conversion) -> Self {
        let Conversion { meters_per_unit, up, handedness, frame_rate } = conversion;
        let rate = frame_rate.map(|rate| rate.source);
        let sources = [Some(meters_per_unit.source), Some(up.source), Some(handedness.source), rate];
        Self {
            meters_per_unit: meters_per_unit.value,
            up: format!("{:?}", up.value),
            left_handed: handedness.value == Handedness::Left,
            frame_rate: frame_rate.map(|rate| rate.value),
            sources: sources.into_iter().flatten().map(|source| source.to_string()).collect(),
            text: conversion.to_string(),
        }
    }
}

#[derive(Serialize)]
struct InfoBone {
    index: usize,
    name: String,
    parent: Option<BoneIndex>,
    node: Option<u32>,
}

/// Humanoid bones and facial expressions of a VRM file.
#[derive(Serialize)]
struct InfoAvatar {
    humanoid_bones: Vec<InfoHumanBone>,
    expressions: Vec<String>,
    faces_minus_z: bool,
}

#[derive(Serialize)]
struct InfoHumanBone {
    name: String,
    bone: BoneIndex,
}

impl InfoAvatar {
    fn of(avatar: &Avatar) -> Self {
        let bones = avatar.bones.iter();
        Self {
            humanoid_bones: bones.map(|it| InfoHumanBone { name: it.name.clone(), bone: it.bone }).collect(),
            expressions: avatar.expressions.iter().map(|expression| expression.name.clone()).collect(),
            faces_minus_z: avatar.faces_minus_z,
        }
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        if !self.humanoid_bones.is_empty() {
            let facing = if self.faces_minus_z { ", the figure faces -Z" } else { "" };
            let bones = count(self.humanoid_bones.len(), "humanoid bone", "humanoid bones");
            writeln!(out, "\n{bones}{facing}")?;
        }
        if !self.expressions.is_empty() {
            writeln!(out, "\n{}", count(self.expressions.len(), "expression", "expressions"))?;
            let names: Vec<String> = self.expressions.iter().map(|name| named(name)).collect();
            writeln!(out, "  {}", names.join(", "))?;
        }
        Ok(())
    }
}

#[derive(Serialize)]
struct InfoSkin {
    index: usize,
    name: String,
    bones: Vec<BoneIndex>,
}

#[derive(Serialize)]
struct InfoTake {
    index: usize,
    name: String,
    start: f32,
    end: f32,
    tracks: usize,
    keys: usize,
}

#[derive(Serialize)]
struct InfoMesh {
    index: usize,
    name: String,
    vertices: usize,
    triangles: usize,
    skin: Option<u32>,
    influences: usize,
    morph_targets: usize,
}

#[derive(Serialize)]
struct InfoMaterial {
    index: usize,
    name: String,
}

#[derive(Serialize)]
struct InfoBounds {
    min: [f32; 3],
    max: [f32; 3],
    sphere: InfoSphere,
}

#[derive(Serialize)]
struct InfoSphere {
    center: [f32; 3],
    radius: f32,
}

impl Info {
    fn of(loaded: LoadedModel) -> Self {
        let model = Arc::new(loaded.model);
        // The bounds of the rest pose.
        let bounds = Evaluator::new(Arc::clone(&model)).bounds();
        Self {
            file: loaded.title,
            format: loaded.format.map_or("", |format| format.name),
            conventions: InfoConventions::of(&loaded.conversion),
            bones: bones(&model.animation.skeleton),
            avatar: InfoAvatar::of(&model.avatar),
            skins: model
                .skins
                .iter()
                .enumerate()
                .map(|(index, skin)| InfoSkin { index, name: skin.name.clone(), bones: skin.bones.clone() })
                .collect(),
            takes: takes(&model),
            meshes: meshes(&model),
            materials: model
                .materials
                .iter()
                .enumerate()
                .map(|(index, material)| InfoMaterial { index, name: material.name.clone() })
                .collect(),
            bounds: InfoBounds {
                min: bounds.min.to_array(),
                max: bounds.max.to_array(),
                sphere: InfoSphere { center: bounds.sphere.center.to_array(), radius: bounds.sphere.radius },
            },
            figure: InfoFigure::of(&model.animation.skeleton),
            warnings: loaded.warnings.into_iter().chain(loaded.notes).collect(),
        }
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "{} ({})", plain(&self.file), self.format)?;
        writeln!(out, "{}", self.conventions.text)?;
        let size: Vec<String> =
            self.bounds.max.iter().zip(&self.bounds.min).map(|(max, min)| short(max - min)).collect();
        writeln!(out, "  size {} units, radius {}", size.join(" × "), short(self.bounds.sphere.radius))?;
        if let Some(remark) = self.figure.remark() {
            writeln!(out, "  {remark}")?;
        }
        self.write_takes(out)?;
        self.write_meshes(out)?;
        if !self.materials.is_empty() {
            writeln!(out, "\n{}", count(self.materials.len(), "material", "materials"))?;
            let names: Vec<String> = self.materials.iter().map(|material| named(&material.name)).collect();
            writeln!(out, "  {}", names.join(", "))?;
        }
        self.write_bones(out)?;
        self.avatar.write(out)?;
        if !self.warnings.is_empty() {
            writeln!(out, "\n{}", count(self.warnings.len(), "warning", "warnings"))?;
            for warning in &self.warnings {
                writeln!(out, "  {}", plain(warning))?;
            }
        }
        Ok(())
    }

    fn write_takes(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "\n{}", count(self.takes.len(), "take", "takes"))?;
        if self.takes.is_empty() {
            return Ok(());
        }
        let mut table = Table::new(&[
            ("#", Side::Right),
            ("name", Side::Left),
            ("from", Side::Right),
            ("to", Side::Right),
            ("tracks", Side::Right),
            ("keys", Side::Right),
        ]);
        for take in &self.takes {
            table.row([
                take.index.to_string(),
                named(&take.name),
                format!("{:.3} s", take.start),
                format!("{:.3} s", take.end),
                take.tracks.to_string(),
                take.keys.to_string(),
            ]);
        }
        table.write(out)
    }

    fn write_meshes(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "\n{}", count(self.meshes.len(), "mesh", "meshes"))?;
        if self.meshes.is_empty() {
            return Ok(());
        }
        let mut table = Table::new(&[
            ("#", Side::Right),
            ("name", Side::Left),
            ("vertices", Side::Right),
            ("triangles", Side::Right),
            ("skin", Side::Right),
            ("influences", Side::Right),
            ("morph targets", Side::Right),
        ]);
        for mesh in &self.meshes {
            table.row([
                mesh.index.to_string(),
                named(&mesh.name),
                mesh.vertices.to_string(),
                mesh.triangles.to_string(),
                mesh.skin.map_or_else(|| "–".to_owned(), |skin| skin.to_string()),
                mesh.influences.to_string(),
                mesh.morph_targets.to_string(),
            ]);
        }
        table.write(out)
    }

    fn write_bones(&self, out: &mut dyn Write) -> io::Result<()> {
        let skins = count(self.skins.len(), "skin", "skins");
        writeln!(out, "\n{}, {skins}", count(self.bones.len(), "bone", "bones"))?;
        let depths = depths(&self.bones);
        // In tree order, children under their parent, as an animator reads a skeleton.
        for &index in tree_order(&self.bones).iter().take(BONES_SHOWN) {
            let indent = "  ".repeat(depths[index].min(30));
            writeln!(out, "  {indent}{}", named(&self.bones[index].name))?;
        }
        if self.bones.len() > BONES_SHOWN {
            writeln!(out, "  … and {} more; --json lists them all", self.bones.len() - BONES_SHOWN)?;
        }
        Ok(())
    }
}

fn bones(skeleton: &Skeleton) -> Vec<InfoBone> {
    let bone = |(index, bone): (usize, &dragonfly_anim::data::Bone)| InfoBone {
        index,
        name: bone.name.clone(),
        parent: bone.parent,
        node: bone.node,
    };
    skeleton.bones.iter().enumerate().map(bone).collect()
}

fn takes(model: &ModelData) -> Vec<InfoTake> {
    let take = |(index, take): (usize, &Arc<dragonfly_anim::data::Take>)| InfoTake {
        index,
        name: take.name.clone(),
        start: take.start,
        end: take.end(),
        tracks: take.moving_tracks(),
        keys: take.keys(),
    };
    model.animation.takes.iter().enumerate().map(take).collect()
}

fn meshes(model: &ModelData) -> Vec<InfoMesh> {
    let skin_of = |mesh: usize| {
        model
            .instances
            .iter()
            .find(|instance| instance.mesh as usize == mesh)
            .and_then(|instance| instance.skin)
    };
    let mesh = |(index, mesh): (usize, &dragonfly_anim::data::Mesh)| {
        let primitives = &mesh.primitives;
        InfoMesh {
            index,
            name: mesh.name.clone(),
            vertices: primitives.iter().map(|primitive| primitive.vertices.len()).sum(),
            triangles: primitives.iter().map(|primitive| primitive.indices.len() / 3).sum(),
            skin: skin_of(index),
            influences: primitives.iter().map(|it| it.vertices.influences_per_vertex).max().unwrap_or(0),
            morph_targets: primitives.iter().map(|it| it.morph_targets.len()).max().unwrap_or(0),
        }
    };
    model.meshes.iter().enumerate().map(mesh).collect()
}

/// Returns the depth of each bone in the hierarchy; parents come first, so one pass suffices.
fn depths(bones: &[InfoBone]) -> Vec<usize> {
    let mut depths: Vec<usize> = Vec::with_capacity(bones.len());
    for bone in bones {
        let depth = bone.parent.and_then(|parent| depths.get(parent as usize)).map_or(0, |depth| depth + 1);
        depths.push(depth);
    }
    depths
}

/// Returns the indices of all bones, each followed by its children; without recursion, as skeletons may be deep.
fn tree_order(bones: &[InfoBone]) -> Vec<usize> {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); bones.len()];
    let mut stack = Vec::new();
    for (index, bone) in bones.iter().enumerate().rev() {
        match bone.parent {
            Some(parent) => children[parent as usize].push(index),
            None => stack.push(index),
        }
    }
    let mut order = Vec::with_capacity(bones.len());
    while let Some(index) = stack.pop() {
        order.push(index);
        stack.append(&mut children[index]);
    }
    order
}

/// Returns the name, or a placeholder if it is empty.
pub(super) fn named(name: &str) -> String {
    if name.is_empty() { "(unnamed)".to_owned() } else { plain(name) }
}

/// Formats a length with at most three decimals.
fn short(number: f32) -> String {
    let text = format!("{number:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
