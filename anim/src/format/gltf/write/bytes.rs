//! The buffer of a written file: bytes, buffer views, accessors.

use serde_json::{Map, Value, json};
use std::collections::HashMap;
use std::sync::Arc;

/// Use of a buffer view by the GPU, as numbered by glTF.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum ViewTarget {
    /// No vertices.
    None,
    /// Attributes of vertices.
    Vertices,
    /// Indices of vertices.
    Indices,
}

/// Numbers of an accessor.
pub(super) enum Components<'a> {
    /// 32-bit floats.
    Floats(&'a [f32]),
    /// Whole numbers, stored with 8, 16 or 32 bits, whichever holds the largest.
    Whole(&'a [u32]),
}

/// How an accessor is declared.
pub(super) struct AccessorShape {
    /// `SCALAR`, `VEC2` … `MAT4`.
    pub(super) kind: &'static str,
    /// Number of components of an element.
    pub(super) width: usize,
    /// Whether to declare the smallest and largest element, as positions and key times need.
    pub(super) has_range: bool,
    pub(super) target: ViewTarget,
}

impl AccessorShape {
    pub(super) const SCALAR: Self = Self::of("SCALAR", 1);
    pub(super) const VEC2: Self = Self::of("VEC2", 2);
    pub(super) const VEC3: Self = Self::of("VEC3", 3);
    pub(super) const VEC4: Self = Self::of("VEC4", 4);
    pub(super) const MAT4: Self = Self::of("MAT4", 16);

    const fn of(kind: &'static str, width: usize) -> Self {
        Self { kind, width, has_range: false, target: ViewTarget::None }
    }

    pub(super) const fn with_range(self) -> Self {
        Self { has_range: true, ..self }
    }

    pub(super) const fn of_vertices(self) -> Self {
        Self { target: ViewTarget::Vertices, ..self }
    }

    pub(super) const fn of_indices(self) -> Self {
        Self { target: ViewTarget::Indices, ..self }
    }
}

/// Collects the bytes of a buffer.
#[derive(Default)]
pub(super) struct BinaryWriter {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    /// Accessor of each column of key times, by its address.
    times: HashMap<*const f32, (Arc<[f32]>, usize)>,
    /// Number and length in bytes of the view of zeros.
    zeros: Option<(usize, usize)>,
}

impl BinaryWriter {
    /// Adds bytes as a view and returns its number.
    pub(super) fn view(&mut self, bytes: &[u8], target: ViewTarget, stride: Option<usize>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = Map::new();
        view.insert("buffer".to_owned(), json!(0));
        if !self.bytes.is_empty() {
            view.insert("byteOffset".to_owned(), json!(self.bytes.len()));
        }
        view.insert("byteLength".to_owned(), json!(bytes.len()));
        if let Some(stride) = stride {
            view.insert("byteStride".to_owned(), json!(stride));
        }
        match target {
            ViewTarget::None => {}
            ViewTarget::Vertices => drop(view.insert("target".to_owned(), json!(34962))),
            ViewTarget::Indices => drop(view.insert("target".to_owned(), json!(34963))),
        }
        self.bytes.extend(bytes);
        self.views.push(Value::Object(view));
        self.views.len() - 1
    }

    /// Adds numbers as an accessor and returns its number. Elements of vertices start at multiples of four bytes.
    pub(super) fn accessor(&mut self, components: Components<'_>, shape: &AccessorShape) -> usize {
        let mut bytes = Vec::new();
        let (component, count, size) = match components {
            Components::Floats(values) => {
                bytes.reserve_exact(4 * values.len());
                values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
                (5126, values.len(), 4)
            }
            Components::Whole(values) => match values.iter().max().copied().unwrap_or_default() {
                // A restart of primitives: the largest number of a type is no index.
                0..=0xfe => {
                    bytes.extend(values.iter().map(|&value| value as u8));
                    (5121, values.len(), 1)
                }
                0xff..=0xfffe => {
                    values.iter().for_each(|&value| bytes.extend((value as u16).to_le_bytes()));
                    (5123, values.len(), 2)
                }
                _ => {
                    values.iter().for_each(|&value| bytes.extend(value.to_le_bytes()));
                    (5125, values.len(), 4)
                }
            },
        };
        let element = size * shape.width;
        let stride = (shape.target == ViewTarget::Vertices).then_some(element);
        debug_assert!(stride.is_none_or(|stride| stride % 4 == 0), "elements of {element} bytes");
        let view = self.view(&bytes, shape.target, stride);
        let mut accessor = Map::new();
        accessor.insert("bufferView".to_owned(), json!(view));
        accessor.insert("componentType".to_owned(), json!(component));
        accessor.insert("count".to_owned(), json!(count / shape.width));
        accessor.insert("type".to_owned(), json!(shape.kind));
        if let (true, Components::Floats(values)) = (shape.has_range, components) {
            for (name, pick) in [("min", f32::min as fn(f32, f32) -> f32), ("max", f32::max)] {
                let mut range = values.get(..shape.width).unwrap_or_default().to_vec();
                for element in values.chunks_exact(shape.width) {
                    range.iter_mut().zip(element).for_each(|(range, &value)| *range = pick(*range, value));
                }
                accessor.insert(name.to_owned(), range.into_iter().map(f64::from).collect());
            }
        }
        self.accessors.push(Value::Object(accessor));
        self.accessors.len() - 1
    }

    /// Adds `count` vectors of zeros for vertices, and returns the number of the accessor. All such accessors share one view, since
    /// many programs refuse an accessor without one.
    pub(super) fn zeros(&mut self, count: usize) -> usize {
        let shape = AccessorShape::VEC3;
        let bytes = 4 * shape.width * count;
        let (view, longest) = self.zeros.unwrap_or((self.views.len(), 0));
        if self.zeros.is_none() {
            self.views.push(Value::Null);
        }
        self.zeros = Some((view, longest.max(bytes)));
        let range = [0.0; 3];
        self.accessors.push(json!({
            "bufferView": view, "componentType": 5126, "count": count, "type": shape.kind, "min": range, "max": range,
        }));
        self.accessors.len() - 1
    }

    /// Adds key times, each column once.
    pub(super) fn times(&mut self, times: &Arc<[f32]>) -> usize {
        if let Some((_, accessor)) = self.times.get(&times.as_ptr()) {
            return *accessor;
        }
        let accessor = self.accessor(Components::Floats(times), &AccessorShape::SCALAR.with_range());
        // The column is kept, so that its address stays its own.
        self.times.insert(times.as_ptr(), (Arc::clone(times), accessor));
        accessor
    }

    /// Returns the views, the accessors, and the bytes of the buffer.
    pub(super) fn finish(mut self) -> (Vec<Value>, Vec<Value>, Vec<u8>) {
        if let Some((view, bytes)) = self.zeros {
            self.view(&vec![0; bytes], ViewTarget::Vertices, Some(4 * AccessorShape::VEC3.width));
            self.views.swap_remove(view);
        }
        (self.views, self.accessors, self.bytes)
    }
}
