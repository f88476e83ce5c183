//! Meshes: how the thesis's lists of vertices and indices are split, and the additional columns.

use super::code::{DFM_INDEX, DFM_VALUE};
use super::error::{WriteError, refuse};
use super::part::DfmPart;
use super::reader::DfmReader;
use super::record::{DfmRecord, Put, RecordFields, only_bits, or_none, some};
use super::vertex::{FIRST_INFLUENCES, InfluenceRecord, VertexRecord};
use super::writer::DfmWriter;
use crate::data::{Influence, MAX_INFLUENCES, Mesh, ModelData, Primitive, Skin, Vertices};
use crate::format::ImportError;
use crate::limits::VERTICES;

/// Bits of the columns that a primitive has.
const NORMALS: u32 = 1;
const TEXTURE_COORDINATES: [u32; 2] = [2, 4];
const TANGENTS: u32 = 8;
const COLORS: u32 = 16;

/// Number of primitives and morph targets of a mesh.
pub(super) struct MeshRecord {
    primitives: u32,
    targets: u32,
}

impl DfmRecord for MeshRecord {
    const SIZE: usize = 8;

    fn put(&self, out: &mut Vec<u8>) {
        out.u32(self.primitives);
        out.u32(self.targets);
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        Ok(Self { primitives: fields.u32(), targets: fields.u32() })
    }
}

/// Number of elements of a primitive in the parts that store columns.
pub(super) struct PrimitiveRecord {
    vertices: u32,
    indices: u32,
    material: u32,
    columns: u32,
    influences: u32,
}

impl DfmRecord for PrimitiveRecord {
    const SIZE: usize = 20;

    fn put(&self, out: &mut Vec<u8>) {
        for number in [self.vertices, self.indices, self.material, self.columns, self.influences] {
            out.u32(number);
        }
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        let (vertices, indices, material) = (fields.u32(), fields.u32(), fields.u32());
        let columns = only_bits(fields.u32(), 31)?;
        let influences = fields.u32();
        if influences as usize > MAX_INFLUENCES {
            return Err(format!("{influences} influences per vertex, at most {MAX_INFLUENCES}"));
        }
        Ok(Self { vertices, indices, material, columns, influences })
    }
}

/// Writes every mesh of `model`.
pub(super) fn write(model: &ModelData, writer: &mut DfmWriter) -> Result<(), WriteError> {
    for (number, mesh) in model.meshes.iter().enumerate() {
        let targets = mesh.morph_weights.len() as u32;
        writer.text(&mesh.name);
        writer.put(DfmPart::Meshes, &MeshRecord { primitives: mesh.primitives.len() as u32, targets });
        writer.put_all(DfmPart::Weights, &mesh.morph_weights);
        let uses = |instance: &&crate::data::MeshInstance| instance.mesh as usize == number;
        let skin = model.instances.iter().filter(uses).find_map(|instance| instance.skin);
        let skin = skin.and_then(|skin| model.skins.get(skin as usize));
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            let place = || format!("/meshes/{number}/primitives/{index}");
            columns_fit(primitive, mesh).map_err(|reason| refuse(place(), reason))?;
            write_primitive(primitive, skin, writer).map_err(|reason| refuse(place(), reason))?;
        }
    }
    Ok(())
}

/// Checks that each column is empty or has one element per vertex.
fn columns_fit(primitive: &Primitive, mesh: &Mesh) -> Result<(), String> {
    let vertices = &primitive.vertices;
    let count = vertices.len();
    let [first, second] = &vertices.texture_coordinates;
    let columns = [
        ("normals", vertices.normals.len()),
        ("tangents", vertices.tangents.len()),
        ("texture coordinates", first.len()),
        ("texture coordinates", second.len()),
        ("colors", vertices.colors.len()),
    ];
    let targets = primitive.morph_targets.iter().flat_map(|target| {
        [target.positions.len(), target.normals.len(), target.tangents.len()].map(|len| ("differences", len))
    });
    for (what, len) in columns.into_iter().chain(targets) {
        if len != 0 && len != count {
            return Err(format!("{len} {what} for {count} vertices"));
        }
    }
    let per_vertex = vertices.influences_per_vertex;
    if per_vertex > MAX_INFLUENCES || vertices.influences.len() != count * per_vertex {
        let influences = vertices.influences.len();
        return Err(format!("{influences} influences for {count} vertices with {per_vertex} each"));
    }
    if primitive.morph_targets.len() != mesh.morph_weights.len() {
        let (targets, weights) = (primitive.morph_targets.len(), mesh.morph_weights.len());
        return Err(format!("{targets} morph targets, the mesh has {weights} weights"));
    }
    Ok(())
}

fn write_primitive(primitive: &Primitive, skin: Option<&Skin>, writer: &mut DfmWriter) -> Result<(), String> {
    let vertices = &primitive.vertices;
    let base = writer.count(DfmPart::Vertices);
    for &index in &primitive.indices {
        let global = u32::try_from(base + index as usize).ok().filter(|_| (index as usize) < vertices.len());
        let reason = || format!("index {index} is out of the range of {} vertices", vertices.len());
        writer.put(DfmPart::Indices, &global.ok_or_else(reason)?);
    }
    for index in 0..vertices.len() {
        write_vertex(primitive, index, skin, writer);
    }
    let flag = |present: bool, bit: u32| if present { bit } else { 0 };
    let [first, second] = &vertices.texture_coordinates;
    let columns = flag(!vertices.normals.is_empty(), NORMALS)
        | flag(!first.is_empty(), TEXTURE_COORDINATES[0])
        | flag(!second.is_empty(), TEXTURE_COORDINATES[1])
        | flag(!vertices.tangents.is_empty(), TANGENTS)
        | flag(!vertices.colors.is_empty(), COLORS);
    let record = PrimitiveRecord {
        vertices: vertices.len() as u32,
        indices: primitive.indices.len() as u32,
        material: or_none(primitive.material),
        columns,
        influences: vertices.influences_per_vertex as u32,
    };
    writer.put(DfmPart::Primitives, &record);
    writer.put_all(DfmPart::Tangents, &vertices.tangents);
    writer.put_all(DfmPart::Colors, &vertices.colors);
    super::morph::write_targets(&primitive.morph_targets, writer);
    Ok(())
}

/// Writes one vertex, its attribute, and its influences after the fourth.
fn write_vertex(primitive: &Primitive, index: usize, skin: Option<&Skin>, writer: &mut DfmWriter) {
    let Some(vertex) = primitive.vertex(index) else { return };
    let (mut influences, mut bones) = ([Influence::default(); FIRST_INFLUENCES], [0; FIRST_INFLUENCES]);
    for ((slot, bone), &influence) in influences.iter_mut().zip(&mut bones).zip(&vertex.influences) {
        *slot = influence;
        let named = skin.and_then(|skin| skin.bones.get(usize::from(influence.joint)));
        *bone = named.copied().unwrap_or(0);
    }
    for &influence in vertex.influences.iter().skip(FIRST_INFLUENCES) {
        writer.put(DfmPart::Influences, &InfluenceRecord(influence));
    }
    let material = or_none(primitive.material);
    writer.put(DfmPart::Attributes, &material);
    writer.put(
        DfmPart::Vertices,
        &VertexRecord {
            position: vertex.position,
            normal: vertex.normal,
            texture_coordinates: vertex.texture_coordinates,
            bones,
            material,
            influences,
        },
    );
}

/// Reads every mesh, and the largest joint that its vertices refer to.
pub(super) fn read(reader: &mut DfmReader<'_, '_>) -> Result<(Vec<Mesh>, Vec<Option<u16>>), ImportError> {
    let count = reader.count(DfmPart::Meshes);
    reader.limit("vertices", reader.count(DfmPart::Vertices), VERTICES)?;
    let mut meshes = reader.vec(DfmPart::Meshes, 0, count)?;
    let mut largest = reader.vec(DfmPart::Meshes, 0, count)?;
    for _ in 0..count {
        let name = reader.text()?;
        let record: MeshRecord = reader.get(DfmPart::Meshes)?;
        let morph_weights = reader.list(DfmPart::Weights, record.targets as usize)?;
        let mut primitives = reader.vec(DfmPart::Primitives, 0, record.primitives as usize)?;
        let mut joint = None;
        for _ in 0..record.primitives {
            let primitive = read_primitive(reader, record.targets as usize)?;
            joint = joint.max(primitive.vertices.influences.iter().map(|influence| influence.joint).max());
            primitives.push(primitive);
        }
        meshes.push(Mesh { name, primitives, morph_weights });
        largest.push(joint);
    }
    Ok((meshes, largest))
}

fn read_primitive(reader: &mut DfmReader<'_, '_>, targets: usize) -> Result<Primitive, ImportError> {
    let record: PrimitiveRecord = reader.get(DfmPart::Primitives)?;
    let material = some(record.material);
    if material.is_some_and(|material| material as usize >= reader.count(DfmPart::Materials)) {
        let reason = format!("there is no material {}", record.material);
        return Err(reader.wrong(DFM_INDEX, reason));
    }
    if !record.indices.is_multiple_of(3) {
        let reason = format!("{} indices are not a whole number of triangles", record.indices);
        return Err(reader.wrong(DFM_VALUE, reason));
    }
    let base = reader.count(DfmPart::Vertices) - reader.left(DfmPart::Vertices);
    let mut vertices = read_vertices(reader, &record)?;
    let count = vertices.len();
    if record.columns & TANGENTS != 0 {
        vertices.tangents = reader.list(DfmPart::Tangents, count)?;
    }
    if record.columns & COLORS != 0 {
        vertices.colors = reader.list(DfmPart::Colors, count)?;
    }
    let mut indices = reader.vec(DfmPart::Indices, 0, record.indices as usize)?;
    for _ in 0..record.indices {
        let global: u32 = reader.get(DfmPart::Indices)?;
        match (global as usize).checked_sub(base).filter(|&index| index < count) {
            Some(index) => indices.push(index as u32),
            None => {
                let reason =
                    format!("index {global} is out of the range of vertices {base}..{}", base + count);
                return Err(reader.wrong(DFM_INDEX, reason));
            }
        }
    }
    let morph_targets = super::morph::read_targets(reader, targets, count)?;
    Ok(Primitive { vertices, indices, material, morph_targets })
}

/// Reads the columns of the thesis's part.
fn read_vertices(reader: &mut DfmReader<'_, '_>, record: &PrimitiveRecord) -> Result<Vertices, ImportError> {
    let count = record.vertices as usize;
    let (columns, per_vertex) = (record.columns, record.influences as usize);
    let bones = reader.count(DfmPart::Bones);
    let room = |present: bool| if present { count } else { 0 };
    let mut vertices = Vertices {
        positions: reader.vec(DfmPart::Vertices, 0, count)?,
        normals: reader.vec(DfmPart::Vertices, 0, room(columns & NORMALS != 0))?,
        tangents: Vec::new(),
        texture_coordinates: [
            reader.vec(DfmPart::Vertices, 0, room(columns & TEXTURE_COORDINATES[0] != 0))?,
            reader.vec(DfmPart::Vertices, 0, room(columns & TEXTURE_COORDINATES[1] != 0))?,
        ],
        colors: Vec::new(),
        influences: reader.context.vec(&reader.place(), count * per_vertex)?,
        influences_per_vertex: per_vertex,
    };
    for _ in 0..count {
        let vertex: VertexRecord = reader.get(DfmPart::Vertices)?;
        repeats(reader, vertex.material, record.material)?;
        if let Some(bone) = vertex.bones.iter().find(|&&bone| bone != 0 && bone as usize >= bones) {
            return Err(reader.wrong(DFM_INDEX, format!("there is no bone {bone}")));
        }
        vertices.positions.push(vertex.position);
        if columns & NORMALS != 0 {
            vertices.normals.push(vertex.normal);
        }
        for (set, bit) in TEXTURE_COORDINATES.into_iter().enumerate() {
            if columns & bit != 0 {
                vertices.texture_coordinates[set].push(vertex.texture_coordinates[set]);
            }
        }
        vertices.influences.extend(vertex.influences.iter().take(per_vertex));
        for _ in FIRST_INFLUENCES..per_vertex {
            vertices.influences.push(reader.get::<InfluenceRecord>(DfmPart::Influences)?.0);
        }
        let attribute = reader.get(DfmPart::Attributes)?;
        repeats(reader, attribute, record.material)?;
    }
    Ok(vertices)
}

/// Checks that the material stored with a vertex, for readers that do not read `PRIM`, is that of its primitive.
fn repeats(reader: &DfmReader<'_, '_>, stored: u32, material: u32) -> Result<(), ImportError> {
    if stored == material {
        return Ok(());
    }
    let name = |index| some(index).map_or("none".to_owned(), |index| index.to_string());
    let reason = format!("a vertex has material {}, its primitive {}", name(stored), name(material));
    Err(reader.wrong(DFM_INDEX, reason))
}
