//! Weights of bones become influences of vertices.

use super::check as code;
use super::mesh::XMesh;
use super::skeleton::BoneList;
use crate::data::{BoneIndex, Influence, MAX_INFLUENCES, Skin};
use crate::format::influences::{merge, normalize};
use crate::format::{AxisMap, ImportContext, ImportError, Place};
use crate::limits::JOINTS_PER_SKIN;
use glam::Mat4;

/// Deviation of the sum of weights from one that is due to rounding.
const ROUNDING: f64 = 1e-3;

/// Influences of the positions of a mesh.
#[derive(Default)]
pub(super) struct XInfluences {
    /// `per_vertex` for each position, the strongest first.
    pub(super) list: Vec<Influence>,
    /// 0, 4 or 8.
    pub(super) per_vertex: usize,
}

/// Returns the skin of a mesh, and the influences of its positions; `None` for a mesh without weights. `frame` is the bone of
/// the frame that contains the mesh, which vertices without weights follow.
pub(super) fn skin(
    mesh: &XMesh,
    frame: Option<BoneIndex>,
    axes: &AxisMap,
    bones: &mut BoneList<'_>,
    context: &ImportContext<'_>,
) -> Result<Option<(Skin, XInfluences)>, ImportError> {
    if mesh.skin.is_empty() {
        return Ok(None);
    }
    let joints = mesh.skin.len() + 1;
    if joints > JOINTS_PER_SKIN {
        let (size, limit) = (joints as u64, JOINTS_PER_SKIN as u64);
        return Err(ImportError::TooLarge { place: Place::File, what: "joints", size, limit });
    }
    let mut skin = Skin {
        name: mesh.name.clone(),
        bones: context.vec(&Place::File, joints)?,
        offsets: context.vec(&Place::File, joints)?,
    };
    for weights in &mesh.skin {
        context.work(4)?;
        let offset = axes.matrix(weights.offset);
        skin.bones.push(bones.of_skin(&weights.frame, offset)?);
        skin.offsets.push(offset);
    }
    let entries = Entries::of(mesh, context)?;
    let count = mesh.positions.len();
    let mut list = context.filled(&Place::File, count * MAX_INFLUENCES, Influence::default())?;
    let (mut found, mut most, mut unweighted, mut odd) = (Vec::new(), 0, 0, 0);
    let own_joint = if frame.is_some() { mesh.skin.len() as u16 } else { 0 };
    for vertex in 0..count {
        let influences = entries.of_vertex(vertex);
        context.work(influences.len() + 1)?;
        found.clear();
        found.extend(influences.iter().filter(|influence| influence.weight > 0.0));
        let sum: f64 = found.iter().map(|influence: &Influence| f64::from(influence.weight)).sum();
        merge(&mut found);
        found.truncate(MAX_INFLUENCES);
        if normalize(&mut found) {
            odd += usize::from((sum - 1.0).abs() > ROUNDING);
        } else {
            unweighted += 1;
            found.push(Influence { joint: own_joint, weight: 1.0 });
        }
        most = most.max(found.len());
        for (slot, &influence) in list[vertex * MAX_INFLUENCES..].iter_mut().zip(&found) {
            *slot = influence;
        }
    }
    if unweighted > 0 {
        let text = match frame {
            Some(_) => "vertices have no weight; they follow the frame of the mesh",
            None => "vertices have no weight; they follow the first bone",
        };
        context.warn(Place::File, code::WEIGHTS_INVALID, format!("{unweighted} {text}"));
        if let Some(frame) = frame {
            skin.bones.push(frame);
            skin.offsets.push(Mat4::IDENTITY);
        }
    }
    if odd > 0 {
        let text = format!("{odd} vertices had weights that do not add up to one; they were scaled");
        context.warn(Place::File, code::WEIGHTS_INVALID, text);
    }
    let per_vertex = if most <= 4 { 4 } else { MAX_INFLUENCES };
    Ok(Some((skin, XInfluences { list: narrow(list, per_vertex), per_vertex })))
}

/// Returns the first `per_vertex` influences of each vertex.
fn narrow(mut list: Vec<Influence>, per_vertex: usize) -> Vec<Influence> {
    if per_vertex < MAX_INFLUENCES {
        let count = list.len() / MAX_INFLUENCES;
        for vertex in 1..count {
            let from = vertex * MAX_INFLUENCES;
            list.copy_within(from..from + per_vertex, vertex * per_vertex);
        }
        list.truncate(count * per_vertex);
    }
    list
}

/// Influences sorted by vertex.
struct Entries {
    influences: Vec<Influence>,
    /// One more than there are vertices.
    starts: Vec<u32>,
}

impl Entries {
    fn of(mesh: &XMesh, context: &ImportContext<'_>) -> Result<Self, ImportError> {
        let total: usize = mesh.skin.iter().map(|weights| weights.vertices.len()).sum();
        let mut starts = context.filled(&Place::File, mesh.positions.len() + 2, 0_u32)?;
        let mut influences = context.filled(&Place::File, total, Influence::default())?;
        context.work(2 * total)?;
        // Counted two places further on, so that after they are filled each start is where it belongs.
        for &vertex in mesh.skin.iter().flat_map(|weights| &weights.vertices) {
            starts[vertex as usize + 2] += 1;
        }
        for index in 2..starts.len() {
            starts[index] += starts[index - 1];
        }
        for (joint, weights) in mesh.skin.iter().enumerate() {
            for (&vertex, &weight) in weights.vertices.iter().zip(&weights.weights) {
                let slot = &mut starts[vertex as usize + 1];
                influences[*slot as usize] = Influence { joint: joint as u16, weight };
                *slot += 1;
            }
        }
        Ok(Self { influences, starts })
    }

    fn of_vertex(&self, vertex: usize) -> &[Influence] {
        &self.influences[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}
