//! Joint influences of vertices: reads any number of sets and keeps the strongest four or eight.

use super::accessor::GltfDocument;
use super::attribute::{attribute, unequal};
use super::check as code;
use crate::data::{Influence, MAX_INFLUENCES};
use crate::format::influences::{merge, normalize};
use crate::format::{ImportError, Place};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;

const JOINT_FORMATS: &[(ComponentType, Type, bool)] =
    &[(ComponentType::U8, Type::Vec4, false), (ComponentType::U16, Type::Vec4, false)];

const WEIGHT_FORMATS: &[(ComponentType, Type, bool)] = &[
    (ComponentType::F32, Type::Vec4, false),
    (ComponentType::U8, Type::Vec4, true),
    (ComponentType::U16, Type::Vec4, true),
];

/// The influences of a primitive's vertices.
#[derive(Debug, Default)]
pub(super) struct VertexInfluences {
    /// `per_vertex` influences for each vertex, strongest first.
    pub(super) list: Vec<Influence>,
    /// Number of influences per vertex: 0, 4 or 8.
    pub(super) per_vertex: usize,
    /// Largest joint number with a weight.
    pub(super) largest_joint: u16,
}

/// One pair of attributes: four joints and four weights per vertex.
struct Set {
    joints: Vec<[u32; 4]>,
    weights: Vec<[f32; 4]>,
    /// Quantization step of the weights: quantized weights cannot add up to one exactly.
    step: f32,
}

/// Number of vertices with each kind of corrected influences.
#[derive(Default)]
struct FixedVertices {
    negative: usize,
    zero: usize,
    twice: usize,
    sum: usize,
}

/// Reads every pair of JOINTS_n and WEIGHTS_n.
pub(super) fn influences(
    document: &GltfDocument<'_>,
    primitive: &Primitive,
    vertices: usize,
    path: &str,
) -> Result<VertexInfluences, ImportError> {
    let sets = sets(document, primitive, vertices, path)?;
    if sets.is_empty() {
        return Ok(VertexInfluences::default());
    }
    let context = document.context;
    let place = Place::Pointer(format!("{path}/attributes/WEIGHTS_0"));
    let mut list = context.filled(&place, vertices.saturating_mul(MAX_INFLUENCES), Influence::default())?;
    let (mut fixed, mut most, mut largest_joint) = (FixedVertices::default(), 0, 0);
    let mut found = Vec::with_capacity(sets.len() * 4);
    let coarse = sets.iter().map(|set| set.step).fold(0.0, f32::max);
    for vertex in 0..vertices {
        context.work(4 * sets.len())?;
        gather(&sets, vertex, &mut found, &mut fixed, coarse);
        found.truncate(MAX_INFLUENCES);
        share_out(&mut found, &mut fixed);
        most = most.max(found.len());
        for (slot, &influence) in list[vertex * MAX_INFLUENCES..].iter_mut().zip(&found) {
            *slot = influence;
            largest_joint = largest_joint.max(influence.joint);
        }
    }
    report(&fixed, &place, document);
    let per_vertex = if most <= 4 { 4 } else { MAX_INFLUENCES };
    if per_vertex < MAX_INFLUENCES {
        context.work(vertices)?;
        for vertex in 1..vertices {
            list.copy_within(
                vertex * MAX_INFLUENCES..vertex * MAX_INFLUENCES + per_vertex,
                vertex * per_vertex,
            );
        }
        list.truncate(vertices * per_vertex);
        list.shrink_to_fit();
    }
    Ok(VertexInfluences { list, per_vertex, largest_joint })
}

fn sets(
    document: &GltfDocument<'_>,
    primitive: &Primitive,
    vertices: usize,
    path: &str,
) -> Result<Vec<Set>, ImportError> {
    let mut sets = Vec::new();
    for semantic in primitive.attributes.keys() {
        let Checked::Valid(semantic) = semantic else { continue };
        let (number, is_joints) = match semantic {
            Semantic::Joints(number) => (*number, true),
            Semantic::Weights(number) => (*number, false),
            _ => continue,
        };
        let joints = attribute(primitive, Semantic::Joints(number));
        let weights = attribute(primitive, Semantic::Weights(number));
        match (joints, weights) {
            (Some(joints), Some(weights)) if is_joints => {
                let wrong = code::MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT;
                let from = format!("{path}/attributes/JOINTS_{number}");
                let joints = document.source(joints, &from, JOINT_FORMATS, wrong)?;
                unequal(joints.count, vertices, &from)?;
                let from = format!("{path}/attributes/WEIGHTS_{number}");
                let weights = document.source(weights, &from, WEIGHT_FORMATS, wrong)?;
                unequal(weights.count, vertices, &from)?;
                let step = match weights.format.0 {
                    ComponentType::U8 => 1.0 / 255.0,
                    ComponentType::U16 => 1.0 / 65535.0,
                    _ => 0.0,
                };
                sets.push(Set { joints: joints.integers()?, weights: weights.floats()?, step });
            }
            (Some(_), Some(_)) => {}
            _ => {
                let name = if is_joints { "JOINTS" } else { "WEIGHTS" };
                let place = Place::Pointer(format!("{path}/attributes/{name}_{number}"));
                let text = "joints and weights only have a meaning together; the attribute is left out";
                document.context.warn(place, code::MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH, text);
            }
        }
    }
    Ok(sets)
}

/// Collects the influences of one vertex that have a weight, strongest first, each joint once.
fn gather(sets: &[Set], vertex: usize, found: &mut Vec<Influence>, fixed: &mut FixedVertices, coarse: f32) {
    found.clear();
    let (mut is_negative, mut sum, mut count) = (false, 0.0_f32, 0);
    for set in sets {
        for (&joint, &weight) in set.joints[vertex].iter().zip(&set.weights[vertex]) {
            let counts = weight > 0.0 && weight.is_finite();
            if !counts {
                is_negative |= weight != 0.0;
                continue;
            }
            sum += weight;
            count += 1;
            found.push(Influence { joint: joint as u16, weight });
        }
    }
    let is_twice = merge(found);
    fixed.negative += usize::from(is_negative);
    fixed.twice += usize::from(is_twice);
    fixed.sum += usize::from(count > 0 && (sum - 1.0).abs() > 2e-7 * count as f32 + coarse);
}

/// Scales the weights so that they add up to one; a vertex without weights follows joint 0.
fn share_out(found: &mut Vec<Influence>, fixed: &mut FixedVertices) {
    if !normalize(found) {
        fixed.zero += 1;
        found.push(Influence { joint: 0, weight: 1.0 });
    }
}

fn report(fixed: &FixedVertices, place: &Place, document: &GltfDocument<'_>) {
    let warn = |count: usize, code, what: &str| {
        if count > 0 {
            document.context.warn(place.clone(), code, format!("{count} vertices {what}"));
        }
    };
    warn(
        fixed.negative,
        code::ACCESSOR_WEIGHTS_NEGATIVE,
        "had weights that are negative or not a number; those are left out",
    );
    warn(
        fixed.twice,
        code::ACCESSOR_JOINTS_INDEX_DUPLICATE,
        "had the same joint twice; its weights were added",
    );
    warn(
        fixed.sum,
        code::ACCESSOR_WEIGHTS_NON_NORMALIZED,
        "had weights that do not add up to one; they were scaled",
    );
    warn(fixed.zero, code::ACCESSOR_WEIGHTS_ZERO, "had no weight; they follow joint 0");
}
