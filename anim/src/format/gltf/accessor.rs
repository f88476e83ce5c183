//! Bounds checks: no byte of a buffer is read before its position has been checked in this module.

use super::buffer::BufferData;
use super::check as code;
use super::draco::DecodedAccessors;
use super::pointer::ChannelPointers;
use crate::format::{ImportContext, ImportError, Place};
use crate::limits::{CANCEL_EVERY, VERTICES, ZERO_ELEMENTS};
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::{Checked, USize64};
use gltf::json::{Index, Root, buffer};
use std::collections::HashMap;

/// A document with its buffers; every other module of the importer reads from it.
pub(super) struct GltfDocument<'a> {
    pub(super) root: &'a Root,
    pub(super) buffers: Vec<BufferData<'a>>,
    /// Bytes of the compressed views, by number.
    pub(super) decoded: HashMap<usize, Vec<u8>>,
    /// Bytes of the accessors of compressed primitives.
    pub(super) unpacked: DecodedAccessors,
    /// Targets of channels that are JSON pointers.
    pub(super) pointers: ChannelPointers,
    /// Total number of bytes read.
    pub(super) bytes: usize,
    pub(super) context: &'a ImportContext<'a>,
}

/// Format of one accessor element: component type, shape, and whether integers are normalized (0..1 or -1..1).
pub(super) type ElementFormat = (ComponentType, Type, bool);

/// Evenly spaced elements of a buffer, all inside it.
#[derive(Clone, Copy)]
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
}

impl<'a> Strided<'a> {
    fn get(&self, index: usize) -> &'a [u8] {
        &self.bytes[index * self.stride..][..self.size]
    }
}

struct Sparse<'a> {
    count: usize,
    indices: Strided<'a>,
    index_type: ComponentType,
    values: Strided<'a>,
}

/// An accessor whose bytes are all known to be inside its buffer.
pub(super) struct AccessorSource<'a> {
    /// JSON pointer to the accessor, such as `/accessors/3`.
    pub(super) place: Place,
    pub(super) count: usize,
    pub(super) format: ElementFormat,
    base: Option<Strided<'a>>,
    sparse: Option<Sparse<'a>>,
    context: &'a ImportContext<'a>,
}

impl<'a> GltfDocument<'a> {
    /// Returns the bytes of a buffer view and its stride. `from` is the JSON pointer of the reference to the view.
    pub(super) fn view(
        &self,
        index: Index<buffer::View>,
        from: &str,
    ) -> Result<(&[u8], Option<usize>), ImportError> {
        let view =
            self.root.buffer_views.get(index.value()).ok_or_else(|| unresolved(from, index.value()))?;
        let bytes = match self.decoded.get(&index.value()) {
            Some(decoded) => decoded,
            None => self.stored(view, index.value())?,
        };
        let stride = view.byte_stride.map(|stride| stride.0).filter(|&stride| stride > 0);
        if let Some(stride) = view.byte_stride
            && (!(4..=252).contains(&stride.0) || stride.0 % 4 != 0)
        {
            let text = format!("the byte stride {} should be a multiple of 4, 4..252", stride.0);
            self.context.warn(
                Place::Pointer(format!("/bufferViews/{}/byteStride", index.value())),
                code::BUFFER_VIEW_INVALID_BYTE_STRIDE,
                text,
            );
        }
        Ok((bytes, stride))
    }

    /// Returns the bytes of the view `number` as they are in its buffer.
    fn stored(&self, view: &buffer::View, number: usize) -> Result<&[u8], ImportError> {
        let place = || format!("/bufferViews/{number}");
        let buffer = self
            .buffers
            .get(view.buffer.value())
            .ok_or_else(|| unresolved(&format!("{}/buffer", place()), view.buffer.value()))?;
        if let BufferData::Missing(error) = buffer {
            return Err(error.clone());
        }
        let buffer = buffer.bytes();
        let offset = view.byte_offset.unwrap_or_default().0;
        let range = to_usize(offset).zip(offset.checked_add(view.byte_length.0).and_then(to_usize));
        let bytes = range.and_then(|(from, to)| buffer.get(from..to)).ok_or_else(|| {
            let reason = format!(
                "{} bytes from byte {offset} do not fit into a buffer of {} bytes",
                view.byte_length.0,
                buffer.len()
            );
            invalid(Place::Pointer(place()), code::BUFFER_VIEW_TOO_LONG, reason)
        })?;
        Ok(bytes)
    }

    /// Returns the accessor `index`, referred to at `from`, if its format is one of `allowed`; otherwise an error with
    /// the code `wrong`.
    pub(super) fn source(
        &'a self,
        index: Index<Accessor>,
        from: &str,
        allowed: &[ElementFormat],
        wrong: &'static str,
    ) -> Result<AccessorSource<'a>, ImportError> {
        let number = index.value();
        let accessor = self.root.accessors.get(number).ok_or_else(|| unresolved(from, number))?;
        let path = format!("/accessors/{number}");
        let format = self.format_of(accessor, &path)?;
        if !allowed.contains(&format) {
            let reason = format!("{} is {}, which is not allowed here", path, describe(format));
            return Err(invalid(Place::Pointer(from.to_owned()), wrong, reason));
        }
        let size = format.0.size() * format.1.multiplicity();
        let count = self.count_of(accessor, number, &path)?;
        let base = match (self.unpacked.get(&number), accessor.buffer_view) {
            (Some(unpacked), _) => {
                let bytes = unpacked.as_ref().map_err(Clone::clone)?;
                Some(strided(bytes, USize64(0), None, size, count, &path)?)
            }
            (None, Some(view)) => {
                let (bytes, stride) = self.view(view, &format!("{path}/bufferView"))?;
                let offset = accessor.byte_offset.unwrap_or_default();
                self.check_alignment(offset, format.0, &path);
                Some(strided(bytes, offset, stride, size, count, &path)?)
            }
            (None, None) => None,
        };
        let sparse = match &accessor.sparse {
            Some(_) => Some(self.sparse_of(accessor, count, size, &path)?),
            None => None,
        };
        Ok(AccessorSource { place: Place::Pointer(path), count, format, base, sparse, context: self.context })
    }

    fn format_of(&self, accessor: &Accessor, path: &str) -> Result<ElementFormat, ImportError> {
        let not_in_list = |member: &str| {
            let reason = "the value is not one of those allowed".to_owned();
            invalid(Place::Pointer(format!("{path}/{member}")), code::VALUE_NOT_IN_LIST, reason)
        };
        let Checked::Valid(component) = &accessor.component_type else {
            return Err(not_in_list("componentType"));
        };
        let Checked::Valid(shape) = accessor.type_ else { return Err(not_in_list("type")) };
        let mut normalized = accessor.normalized;
        if normalized && matches!(component.0, ComponentType::F32 | ComponentType::U32) {
            let place = Place::Pointer(format!("{path}/normalized"));
            self.context.warn(
                place,
                code::ACCESSOR_NORMALIZED_INVALID,
                "floats and 32-bit integers are not normalized",
            );
            normalized = false;
        }
        Ok((component.0, shape, normalized))
    }

    /// Returns the number of elements. Without a buffer view the number is limited by the size of the input.
    fn count_of(&self, accessor: &Accessor, number: usize, path: &str) -> Result<usize, ImportError> {
        let limit = match accessor.buffer_view {
            Some(_) => usize::MAX,
            None if self.unpacked.contains_key(&number) => usize::MAX,
            None => self.bytes.clamp(ZERO_ELEMENTS, VERTICES),
        };
        to_usize(accessor.count.0).filter(|&count| count <= limit).ok_or_else(|| ImportError::TooLarge {
            place: Place::Pointer(format!("{path}/count")),
            what: "elements without a buffer view",
            size: accessor.count.0,
            limit: limit as u64,
        })
    }

    fn check_alignment(&self, offset: USize64, component: ComponentType, path: &str) {
        if !offset.0.is_multiple_of(component.size() as u64) {
            let text = format!("the offset {} is not a multiple of {}", offset.0, component.size());
            let place = Place::Pointer(format!("{path}/byteOffset"));
            self.context.warn(place, code::ACCESSOR_OFFSET_ALIGNMENT, text);
        }
    }

    fn sparse_of(
        &self,
        accessor: &Accessor,
        total: usize,
        size: usize,
        path: &str,
    ) -> Result<Sparse<'_>, ImportError> {
        let sparse = accessor.sparse.as_ref().expect("the caller checks that the accessor is sparse");
        let path = format!("{path}/sparse");
        let count = to_usize(sparse.count.0).filter(|&count| count <= total).ok_or_else(|| {
            let reason = format!("{} of {total} elements are replaced", sparse.count.0);
            invalid(Place::Pointer(format!("{path}/count")), code::ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE, reason)
        })?;
        let Checked::Valid(index_type) = &sparse.indices.component_type else {
            let place = Place::Pointer(format!("{path}/indices/componentType"));
            return Err(invalid(
                place,
                code::VALUE_NOT_IN_LIST,
                "the value is not one of those allowed".to_owned(),
            ));
        };
        let part = |view, offset, size, name: &str| {
            let path = format!("{path}/{name}");
            let (bytes, _) = self.view(view, &format!("{path}/bufferView"))?;
            strided(bytes, offset, None, size, count, &path)
        };
        let index_size = index_type.0.size();
        Ok(Sparse {
            count,
            indices: part(sparse.indices.buffer_view, sparse.indices.byte_offset, index_size, "indices")?,
            index_type: index_type.0,
            values: part(sparse.values.buffer_view, sparse.values.byte_offset, size, "values")?,
        })
    }
}

/// Returns `count` elements of `size` bytes, the first one at `offset`, all inside `bytes`.
fn strided<'a>(
    bytes: &'a [u8],
    offset: USize64,
    stride: Option<usize>,
    size: usize,
    count: usize,
    path: &str,
) -> Result<Strided<'a>, ImportError> {
    let stride = stride.unwrap_or(size);
    if stride < size {
        let reason = format!("the stride {stride} is less than the element's {size} bytes");
        return Err(invalid(Place::Pointer(path.to_owned()), code::ACCESSOR_SMALL_BYTESTRIDE, reason));
    }
    let length = match count {
        0 => Some(0),
        _ => (count - 1).checked_mul(stride).and_then(|length| length.checked_add(size)),
    };
    let range =
        to_usize(offset.0).zip(length).and_then(|(from, length)| Some(from..from.checked_add(length)?));
    let bytes_of = range.and_then(|range| bytes.get(range)).ok_or_else(|| {
        let reason = format!(
            "{count} elements of {size} bytes, {stride} apart from byte {}, do not fit into {} bytes",
            offset.0,
            bytes.len()
        );
        invalid(Place::Pointer(path.to_owned()), code::ACCESSOR_TOO_LONG, reason)
    })?;
    Ok(Strided { bytes: bytes_of, stride, size })
}

impl AccessorSource<'_> {
    /// Returns all elements as floats, with integers normalized if the accessor is. May contain NaN and infinity.
    pub(super) fn floats<const N: usize>(&self) -> Result<Vec<[f32; N]>, ImportError> {
        match (self.format.0, self.format.2) {
            (ComponentType::F32, _) => self.gather(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            (ComponentType::U32, _) => self.gather(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32),
            (ComponentType::I8, false) => self.gather(|b| f32::from(b[0].cast_signed())),
            (ComponentType::U8, false) => self.gather(|b| f32::from(b[0])),
            (ComponentType::I16, false) => self.gather(|b| f32::from(i16::from_le_bytes([b[0], b[1]]))),
            (ComponentType::U16, false) => self.gather(|b| f32::from(u16::from_le_bytes([b[0], b[1]]))),
            // glTF 2.0 §3.11, signed: max(c / 127, -1)
            (ComponentType::I8, true) => self.gather(|b| (f32::from(b[0].cast_signed()) / 127.0).max(-1.0)),
            (ComponentType::U8, true) => self.gather(|b| f32::from(b[0]) / 255.0),
            (ComponentType::I16, true) => {
                self.gather(|b| (f32::from(i16::from_le_bytes([b[0], b[1]])) / 32767.0).max(-1.0))
            }
            (ComponentType::U16, true) => {
                self.gather(|b| f32::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0)
            }
        }
    }

    /// Returns [`Self::floats`], or an error if one is not finite.
    pub(super) fn finite<const N: usize>(&self) -> Result<Vec<[f32; N]>, ImportError> {
        let values = self.floats::<N>()?;
        let odd = values.iter().position(|value| !value.iter().all(|number| number.is_finite()));
        match odd {
            None => Ok(values),
            Some(index) => {
                let reason = format!("element {index} is not finite");
                Err(invalid(self.place.clone(), code::ACCESSOR_INVALID_FLOAT, reason))
            }
        }
    }

    /// Returns all elements as unsigned integers; the format must be one of unsigned integers.
    pub(super) fn integers<const N: usize>(&self) -> Result<Vec<[u32; N]>, ImportError> {
        match self.format.0 {
            ComponentType::U8 => self.gather(|b| u32::from(b[0])),
            ComponentType::U16 => self.gather(|b| u32::from(u16::from_le_bytes([b[0], b[1]]))),
            _ => self.gather(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        }
    }

    /// Decodes every element with `number`, which gets at least the bytes of one component.
    fn gather<T: Copy + Default, const N: usize>(
        &self,
        number: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<[T; N]>, ImportError> {
        debug_assert_eq!(self.format.1.multiplicity(), N);
        let component = self.format.0.size();
        let element =
            |bytes: &[u8]| std::array::from_fn::<T, N, _>(|i| number(&bytes[i * component..][..component]));
        let Some(base) = self.base else {
            let mut values = self.context.filled(&self.place, self.count, [T::default(); N])?;
            self.replace(&mut values, element)?;
            return Ok(values);
        };
        let mut values = self.context.vec(&self.place, self.count)?;
        while values.len() < self.count {
            let piece = CANCEL_EVERY.min(self.count - values.len());
            self.context.work(piece)?;
            values.extend((values.len()..values.len() + piece).map(|index| element(base.get(index))));
        }
        self.replace(&mut values, element)?;
        Ok(values)
    }

    /// Replaces the elements that the sparse part of the accessor lists.
    fn replace<T>(&self, values: &mut [T], element: impl Fn(&[u8]) -> T) -> Result<(), ImportError> {
        let Some(sparse) = &self.sparse else { return Ok(()) };
        let mut last = None;
        let mut rises = true;
        for number in 0..sparse.count {
            self.context.work(1)?;
            let index = little_endian(sparse.indices.get(number), sparse.index_type);
            rises &= last.is_none_or(|last| last < index);
            last = Some(index);
            *values.get_mut(index).ok_or_else(|| {
                let reason = format!("sparse index {number} is {index}, there are {} elements", self.count);
                invalid(self.place.clone(), code::ACCESSOR_SPARSE_INDEX_OOB, reason)
            })? = element(sparse.values.get(number));
        }
        if !rises {
            let text = "the sparse indices do not increase; the last value of an index is used";
            self.context.warn(self.place.clone(), code::ACCESSOR_SPARSE_INDICES_NON_INCREASING, text);
        }
        Ok(())
    }
}

fn little_endian(bytes: &[u8], kind: ComponentType) -> usize {
    match kind {
        ComponentType::U8 => usize::from(bytes[0]),
        ComponentType::U16 => usize::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as usize,
    }
}

/// Describes a format: `VEC3 of normalized U8`.
fn describe((component, shape, normalized): ElementFormat) -> String {
    let normalized = if normalized { "normalized " } else { "" };
    format!("{shape:?} of {normalized}{component:?}").to_uppercase()
}

fn to_usize(number: u64) -> Option<usize> {
    usize::try_from(number).ok()
}

pub(super) fn invalid(place: Place, code: &'static str, reason: String) -> ImportError {
    ImportError::Invalid { place, code, reason }
}

/// Returns the error of the index at `from`, which is out of range.
pub(super) fn unresolved(from: &str, index: usize) -> ImportError {
    let reason = format!("the index {index} is out of range");
    invalid(Place::Pointer(from.to_owned()), code::UNRESOLVED_REFERENCE, reason)
}
