//! Primitives compressed by Draco: `KHR_draco_mesh_compression`.
//!
//! A primitive is decoded as a whole, since its triangles and attributes share one order of vertices. What it contains becomes
//! the bytes of the accessors that the primitive names, and is read like others. Where all of them have data of their own, those
//! are read instead, and nothing is decoded.
//!
//! The decoder is the crate `draco-core`, which has no unsafe code. The counts of the accessors are its limits, and memory for
//! them is charged before it starts.

use super::accessor::{GltfDocument, invalid, unresolved};
use super::buffer::is_missing;
use super::check as code;
use crate::format::{ImportError, Place};
use crate::limits::VERTICES;
use draco_core::{DataType, DecodeLimits, DecoderBuffer, MeshDecoder, PointAttribute, PointIndex};
use gltf::json::accessor::{Accessor, ComponentType};
use gltf::json::buffer::View;
use gltf::json::mesh::{Mode, Primitive};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};
use serde_json::{Map, Value};
use std::collections::HashMap;

/// Name of the extension.
pub(super) const NAME: &str = "KHR_draco_mesh_compression";

/// Bytes that the decoder needs for a triangle and for a vertex while it works, without the attributes.
const TRIANGLE_BYTES: u64 = 160;
const VERTEX_BYTES: u64 = 96;

/// Bytes of the accessors of compressed primitives, by number; an error where the file that contains them is missing.
pub(super) type DecodedAccessors = HashMap<usize, Result<Vec<u8>, ImportError>>;

/// A primitive whose data is compressed.
struct CompressedPrimitive {
    place: Place,
    view: Index<View>,
    /// Numbers of accessors, with the numbers of their attributes in the compressed data.
    attributes: Vec<(usize, u32)>,
    /// Number of the accessor of the indices.
    indices: usize,
}

/// Decodes all primitives that have no uncompressed data.
pub(super) fn decode(document: &GltfDocument<'_>) -> Result<DecodedAccessors, ImportError> {
    let mut decoded = DecodedAccessors::new();
    // The view from which each accessor comes: primitives may share both.
    let mut views: HashMap<usize, usize> = HashMap::new();
    for (mesh_number, mesh) in document.root.meshes.iter().enumerate() {
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            document.context.work(1)?;
            let path = format!("/meshes/{mesh_number}/primitives/{number}");
            let Some(compressed) = CompressedPrimitive::of(document.root, primitive, &path)? else {
                continue;
            };
            let view = compressed.view.value();
            let sources = compressed.accessors().map(|accessor| views.get(&accessor));
            let known: Vec<Option<&usize>> = sources.collect();
            if known.iter().all(|source| *source == Some(&view)) {
                continue;
            }
            if known.iter().any(Option::is_some) {
                return Err(compressed.refuse("another primitive has other data for the same accessors"));
            }
            views.extend(compressed.accessors().map(|accessor| (accessor, view)));
            match compressed.decode(document) {
                Ok(columns) => decoded.extend(columns.into_iter().map(|(number, bytes)| (number, Ok(bytes)))),
                Err(error) if is_missing(&error) => {
                    decoded.extend(compressed.accessors().map(|accessor| (accessor, Err(error.clone()))));
                }
                Err(error) => return Err(error),
            }
        }
    }
    Ok(decoded)
}

/// Returns whether every attribute of a primitive, and its indices if it has them, have uncompressed data.
fn has_plain_data(root: &Root, primitive: &Primitive) -> bool {
    let accessors = primitive.attributes.values().chain(&primitive.indices);
    let mut accessors = accessors.map(|accessor| root.accessors.get(accessor.value()));
    accessors.all(|found| found.is_some_and(|found| found.buffer_view.is_some()))
}

impl CompressedPrimitive {
    /// Returns the compressed data of a primitive; `None` for one that is not compressed, or has uncompressed data as well.
    fn of(root: &Root, primitive: &Primitive, path: &str) -> Result<Option<Self>, ImportError> {
        let Some(value) = primitive.extensions.as_ref().and_then(|all| all.others.get(NAME)) else {
            return Ok(None);
        };
        // Uncompressed data is read where there is some, even if the extension is damaged.
        if has_plain_data(root, primitive) {
            return Ok(None);
        }
        let path = format!("{path}/extensions/{NAME}");
        let refuse =
            |reason: &str| invalid(Place::Pointer(path.clone()), code::DRACO_INVALID, reason.to_owned());
        let object = value.as_object().ok_or_else(|| refuse("the extension is no object"))?;
        let view = number_of(object, "bufferView").and_then(|number| u32::try_from(number).ok());
        let view = view.ok_or_else(|| refuse("the member bufferView is missing or no whole number"))?;
        if view as usize >= root.buffer_views.len() {
            return Err(unresolved(&format!("{path}/bufferView"), view as usize));
        }
        let named = object.get("attributes").and_then(Value::as_object);
        let named = named.ok_or_else(|| refuse("the member attributes is missing or no object"))?;
        let mut attributes = Vec::new();
        for (semantic, accessor) in &primitive.attributes {
            let Checked::Valid(semantic) = semantic else { continue };
            let name = semantic.to_string();
            let Some(id) = named.get(&name) else { continue };
            let id = id.as_u64().and_then(|id| u32::try_from(id).ok());
            let id = id.ok_or_else(|| refuse(&format!("the number of {name} is no whole number")))?;
            attributes.push((accessor.value(), id));
        }
        let Some(indices) = primitive.indices else { return Err(refuse("the primitive has no indices")) };
        let indices = indices.value();
        if primitive.mode != Checked::Valid(Mode::Triangles) {
            return Err(refuse("only lists of triangles can be compressed"));
        }
        let view = Index::new(view);
        let compressed = Self { place: Place::Pointer(path.clone()), view, attributes, indices };
        for accessor in compressed.accessors() {
            root.accessors.get(accessor).ok_or_else(|| unresolved(&path, accessor))?;
        }
        Ok(Some(compressed))
    }

    /// Returns the numbers of all accessors that get their bytes here.
    fn accessors(&self) -> impl Iterator<Item = usize> {
        self.attributes.iter().map(|&(accessor, _)| accessor).chain([self.indices])
    }

    fn refuse(&self, reason: &str) -> ImportError {
        invalid(self.place.clone(), code::DRACO_INVALID, reason.to_owned())
    }

    /// Returns the bytes of each accessor.
    fn decode(&self, document: &GltfDocument<'_>) -> Result<Vec<(usize, Vec<u8>)>, ImportError> {
        let accessors = &document.root.accessors;
        let pointer = self.place.to_string();
        let (data, _) = document.view(self.view, &format!("{pointer}/bufferView"))?;
        let corners = self.count(&accessors[self.indices], 3 * VERTICES)?;
        let points = match self.attributes.first() {
            Some(&(first, _)) => self.count(&accessors[first], VERTICES)?,
            None => return Err(self.refuse("no attribute of the primitive is compressed")),
        };
        let mut vertex = 0;
        for &(accessor, _) in &self.attributes {
            if accessors[accessor].count.0 != points as u64 {
                return Err(self.refuse("the attributes have different numbers of elements"));
            }
            vertex += self.element(&accessors[accessor])?.1;
        }
        // Numbers are decoded as whole numbers first.
        let values = points as u64 * (2 * vertex as u64 + VERTEX_BYTES);
        document.context.charge(&self.place, values + corners as u64 / 3 * TRIANGLE_BYTES)?;
        let limits = DecodeLimits::default()
            .with_max_points(points as u64)
            .with_max_faces(corners as u64 / 3)
            .with_max_decoded_bytes(values);
        let mut mesh = draco_core::Mesh::new();
        let mut buffer = DecoderBuffer::new(data).with_limits(limits);
        let damaged = |error| self.refuse(&format!("the compressed data cannot be decoded: {error}"));
        // The decoder cannot be interrupted: a cancel counts before it.
        document.context.work(data.len())?;
        MeshDecoder::new().decode(&mut buffer, &mut mesh).map_err(damaged)?;
        if mesh.num_points() != points || mesh.num_faces() != corners / 3 || !corners.is_multiple_of(3) {
            let (vertices, triangles) = (mesh.num_points(), mesh.num_faces());
            let found =
                format!("{vertices} vertices and {triangles} triangles are not those of the accessors");
            return Err(self.refuse(&found));
        }
        let mut columns = Vec::with_capacity(self.attributes.len() + 1);
        for &(accessor, id) in &self.attributes {
            let attribute = mesh.attribute_by_unique_id(id);
            let attribute =
                attribute.ok_or_else(|| self.refuse("an attribute is not in the compressed data"))?;
            columns.push((accessor, self.column(&accessors[accessor], attribute, points, document)?));
        }
        let corners = mesh.faces().iter().flatten().map(|point| f64::from(point.0));
        let (kind, size) = self.element(&accessors[self.indices])?;
        let mut bytes = document.context.vec(&self.place, mesh.num_faces() * 3 * size)?;
        for corner in corners {
            self.write(corner, kind, &mut bytes)?;
        }
        columns.push((self.indices, bytes));
        Ok(columns)
    }

    /// Returns the number of elements of an accessor.
    fn count(&self, accessor: &Accessor, limit: usize) -> Result<usize, ImportError> {
        let count = usize::try_from(accessor.count.0).ok().filter(|&count| count <= limit);
        count.ok_or_else(|| ImportError::TooLarge {
            place: self.place.clone(),
            what: "compressed elements",
            size: accessor.count.0,
            limit: limit as u64,
        })
    }

    /// Returns the type of the components of an accessor, and the size of an element in bytes.
    fn element(&self, accessor: &Accessor) -> Result<(ComponentType, usize), ImportError> {
        match (&accessor.component_type, &accessor.type_) {
            (Checked::Valid(kind), Checked::Valid(shape)) => {
                Ok((kind.0, kind.0.size() * shape.multiplicity()))
            }
            _ => Err(self.refuse("an accessor is of no known type")),
        }
    }

    /// Returns the bytes of an accessor from a decoded attribute.
    fn column(
        &self,
        accessor: &Accessor,
        attribute: &PointAttribute,
        points: usize,
        document: &GltfDocument<'_>,
    ) -> Result<Vec<u8>, ImportError> {
        let (kind, size) = self.element(accessor)?;
        let components = size / kind.size();
        if usize::from(attribute.num_components()) != components {
            return Err(self.refuse("an attribute has another number of components than its accessor"));
        }
        let width = attribute.data_type().byte_length();
        let stride = usize::try_from(attribute.byte_stride()).unwrap_or_default();
        let data = attribute.buffer().data();
        let mut bytes = document.context.vec(&self.place, points * size)?;
        document.context.work(points * components)?;
        for point in 0..points as u32 {
            let start = attribute.mapped_index(PointIndex(point)).0 as usize * stride;
            let element = data.get(start..).and_then(|rest| rest.get(..width * components));
            let element = element.ok_or_else(|| self.refuse("an attribute has too few values"))?;
            for component in element.chunks_exact(width.max(1)) {
                let number = number(attribute.data_type(), component);
                let number =
                    number.ok_or_else(|| self.refuse("an attribute is of a type that glTF has not"))?;
                self.write(number, kind, &mut bytes)?;
            }
        }
        Ok(bytes)
    }

    /// Adds a number in the type of an accessor.
    fn write(&self, number: f64, kind: ComponentType, bytes: &mut Vec<u8>) -> Result<(), ImportError> {
        let is_inside = |low: f64, high: f64| number.fract() == 0.0 && (low..=high).contains(&number);
        let misfit = || self.refuse("a number does not fit into the type of its accessor");
        match kind {
            ComponentType::F32 => bytes.extend((number as f32).to_le_bytes()),
            ComponentType::U32 if is_inside(0.0, f64::from(u32::MAX)) => {
                bytes.extend((number as u32).to_le_bytes())
            }
            ComponentType::U16 if is_inside(0.0, 65535.0) => bytes.extend((number as u16).to_le_bytes()),
            ComponentType::U8 if is_inside(0.0, 255.0) => bytes.push(number as u8),
            ComponentType::I16 if is_inside(-32768.0, 32767.0) => bytes.extend((number as i16).to_le_bytes()),
            ComponentType::I8 if is_inside(-128.0, 127.0) => bytes.extend((number as i8).to_le_bytes()),
            ComponentType::U32
            | ComponentType::U16
            | ComponentType::U8
            | ComponentType::I16
            | ComponentType::I8 => return Err(misfit()),
        }
        Ok(())
    }
}

/// Returns a component of a decoded attribute. Every type that glTF has is exact as a double.
fn number(kind: DataType, bytes: &[u8]) -> Option<f64> {
    let four = || <[u8; 4]>::try_from(bytes).ok();
    let two = || <[u8; 2]>::try_from(bytes).ok();
    Some(match kind {
        DataType::Float32 => f64::from(f32::from_le_bytes(four()?)),
        DataType::Uint32 => f64::from(u32::from_le_bytes(four()?)),
        DataType::Int32 => f64::from(i32::from_le_bytes(four()?)),
        DataType::Uint16 => f64::from(u16::from_le_bytes(two()?)),
        DataType::Int16 => f64::from(i16::from_le_bytes(two()?)),
        DataType::Uint8 => f64::from(*bytes.first()?),
        DataType::Int8 => f64::from(bytes.first()?.cast_signed()),
        _ => return None,
    })
}

fn number_of(object: &Map<String, Value>, name: &str) -> Option<u64> {
    object.get(name).and_then(Value::as_u64)
}
