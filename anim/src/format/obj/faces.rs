//! The statements of an OBJ text: positions, texture coordinates, normals, and polygons with what they belong to.

use super::check as code;
use super::lines::{Statement, StatementReader, places};
use crate::data::Mesh;
use crate::format::decimal::parse_whole;
use crate::format::text::{NUMBER_INVALID, TextScanner, TextToken};
use crate::format::{AxisMap, ImportContext, ImportError, Place};
use crate::limits::VERTICES;
use glam::{Vec2, Vec3, Vec4};
use std::collections::{HashMap, HashSet};

/// Index of a corner that has no normal or texture coordinate.
pub(super) const NONE: u32 = u32::MAX;

/// A corner of a polygon: position, texture coordinate, normal.
pub(super) type Corner = [u32; 3];

/// A polygon.
pub(super) struct Polygon {
    /// First corner in [`ObjText::corners`].
    pub(super) first: u32,
    pub(super) count: u32,
    /// Mesh that it belongs to.
    pub(super) part: u32,
    /// Name of its material, as its number in [`ObjText::materials`]; `NONE` before the first one.
    pub(super) material: u32,
    /// Smoothing group; 0 for flat.
    pub(super) smoothing: u32,
    /// Offset of the statement.
    pub(super) at: usize,
}

/// A name with the offset of its statement.
pub(super) struct NameAt {
    pub(super) name: String,
    pub(super) at: usize,
}

/// The content of a text.
#[derive(Default)]
pub(super) struct ObjText {
    pub(super) positions: Vec<Vec3>,
    /// Linear RGB of each position; empty if no position has a color.
    pub(super) colors: Vec<Vec4>,
    pub(super) texture_coordinates: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    pub(super) corners: Vec<Corner>,
    pub(super) polygons: Vec<Polygon>,
    /// Names of the meshes: objects and groups.
    pub(super) parts: Vec<String>,
    pub(super) materials: Vec<NameAt>,
    /// Files of materials.
    pub(super) libraries: Vec<NameAt>,
}

/// Reads a whole text.
pub(super) fn parse(
    bytes: &[u8],
    axes: &AxisMap,
    context: &ImportContext<'_>,
) -> Result<ObjText, ImportError> {
    let places = places(bytes);
    let mut parser = FaceParser::new(&places, *axes, context);
    let mut reader = StatementReader::new(bytes);
    loop {
        if let Some(end) = parser.read_quickly(bytes, reader.at())? {
            parser.is_known = true;
            reader.go_to(end);
            continue;
        }
        let Some(statement) = reader.next(context, &places)? else { break };
        context.work(1 + statement.values.len())?;
        parser.read(&statement)?;
        if !parser.is_known && statement.keyword.at > UNKNOWN_BYTES {
            break;
        }
    }
    if !parser.is_known {
        return Err(places.invalid(0, code::NO_STATEMENT, "the text has no statement of an OBJ file"));
    }
    parser.check_corners()?;
    Ok(parser.text)
}

/// Number of bytes without any known statement after which a text is no OBJ file.
const UNKNOWN_BYTES: usize = 1 << 16;

/// Reads statements one after the other.
pub(super) struct FaceParser<'a> {
    pub(super) text: ObjText,
    places: &'a TextScanner<'a>,
    axes: AxisMap,
    context: &'a ImportContext<'a>,
    /// Names of the object and of the group.
    names: [String; 2],
    part_numbers: HashMap<[String; 2], u32>,
    part: Option<u32>,
    material_numbers: HashMap<String, u32>,
    material: u32,
    smoothing: u32,
    /// Statements that are ignored, each once.
    ignored: HashSet<Vec<u8>>,
    /// Whether any statement was known.
    is_known: bool,
}

impl<'a> FaceParser<'a> {
    fn new(places: &'a TextScanner<'a>, axes: AxisMap, context: &'a ImportContext<'a>) -> Self {
        Self {
            text: ObjText::default(),
            places,
            axes,
            context,
            names: Default::default(),
            part_numbers: HashMap::new(),
            part: None,
            material_numbers: HashMap::new(),
            material: NONE,
            smoothing: 0,
            ignored: HashSet::new(),
            is_known: false,
        }
    }

    fn read(&mut self, statement: &Statement<'_, '_>) -> Result<(), ImportError> {
        let is_known = match statement.keyword.text {
            b"v" => self.position(statement).map(|()| true),
            b"vt" => self.texture_coordinate(statement).map(|()| true),
            b"vn" => self.normal(statement).map(|()| true),
            b"f" | b"fo" => self.polygon(statement).map(|()| true),
            b"o" | b"g" => {
                self.names[usize::from(statement.keyword.text == b"g")] = statement.name();
                self.part = None;
                Ok(true)
            }
            b"s" => {
                // A group that is no number, such as "off", is none.
                let group = statement.values.first().and_then(|value| parse_whole(value.text));
                self.smoothing = group.map_or(0, |group| group.min(u64::from(NONE)) as u32);
                Ok(true)
            }
            b"usemtl" => self.material(statement).map(|()| true),
            b"mtllib" => {
                let name = self.charged(statement)?;
                self.text.libraries.push(NameAt { name, at: statement.keyword.at });
                Ok(true)
            }
            _ => Ok(false),
        }?;
        self.is_known |= is_known;
        if !is_known && self.ignored.len() < MOST_IGNORED && self.ignored.insert(short(statement.keyword)) {
            let text = format!("the statement {} is not shown", statement.keyword.shown());
            self.context.warn(self.places.place(statement.keyword.at), code::STATEMENT_IGNORED, text);
        }
        Ok(())
    }

    /// Reads the first numbers of a statement, of which at least `least` have to be there; the others are zero.
    fn numbers<const N: usize>(
        &self,
        statement: &Statement<'_, '_>,
        least: usize,
        what: &str,
    ) -> Result<[f32; N], ImportError> {
        if statement.values.len() < least {
            let reason = format!("{} values for {what}, at least {least} are needed", statement.values.len());
            return Err(self.places.invalid(statement.keyword.at, code::VALUE_MISSING, reason));
        }
        let mut numbers = [0.0; N];
        for (number, value) in numbers.iter_mut().zip(statement.values) {
            *number = self.places.float_of(*value, what)?;
        }
        Ok(numbers)
    }

    pub(super) fn context(&self) -> &'a ImportContext<'a> {
        self.context
    }

    fn position(&mut self, statement: &Statement<'_, '_>) -> Result<(), ImportError> {
        let [x, y, z] = self.numbers(statement, 3, "a position")?;
        self.add_position(Vec3::new(x, y, z), statement.keyword.at)?;
        // Four numbers are a position with a weight, six or more one with a color.
        if statement.values.len() >= 6 {
            let [_, _, _, r, g, b] = self.numbers(statement, 6, "a position with a color")?;
            let linear = |color: f32| linear_of(color.clamp(0.0, 1.0));
            let missing = self.text.positions.len() - self.text.colors.len();
            self.context
                .charge(&self.places.place(statement.keyword.at), (missing * 2 * size_of::<Vec4>()) as u64)?;
            self.text.colors.resize(self.text.positions.len() - 1, Vec4::ONE);
            self.text.colors.push(Vec4::new(linear(r), linear(g), linear(b), 1.0));
        }
        Ok(())
    }

    /// Adds a position of the statement at `at`.
    pub(super) fn add_position(&mut self, position: Vec3, at: usize) -> Result<(), ImportError> {
        let position = self.axes.position(position);
        if !position.is_finite() {
            return Err(self.places.invalid(at, NUMBER_INVALID, "the position is too large for its unit"));
        }
        self.grown(self.text.positions.len(), size_of::<Vec3>(), at)?;
        self.text.positions.push(position);
        Ok(())
    }

    fn texture_coordinate(&mut self, statement: &Statement<'_, '_>) -> Result<(), ImportError> {
        let [u, v] = self.numbers(statement, 1, "a texture coordinate")?;
        self.add_texture_coordinate(Vec2::new(u, v), statement.keyword.at)
    }

    /// Adds a texture coordinate of the statement at `at`.
    pub(super) fn add_texture_coordinate(&mut self, uv: Vec2, at: usize) -> Result<(), ImportError> {
        self.grown(self.text.texture_coordinates.len(), size_of::<Vec2>(), at)?;
        // The origin is at the bottom of an image, in this library at its top.
        self.text.texture_coordinates.push(Vec2::new(uv.x, 1.0 - uv.y));
        Ok(())
    }

    fn normal(&mut self, statement: &Statement<'_, '_>) -> Result<(), ImportError> {
        let [x, y, z] = self.numbers(statement, 3, "a normal")?;
        self.add_normal(Vec3::new(x, y, z), statement.keyword.at)
    }

    /// Adds a normal of the statement at `at`.
    pub(super) fn add_normal(&mut self, normal: Vec3, at: usize) -> Result<(), ImportError> {
        self.grown(self.text.normals.len(), size_of::<Vec3>(), at)?;
        self.text.normals.push(self.axes.direction(normal));
        Ok(())
    }

    fn polygon(&mut self, statement: &Statement<'_, '_>) -> Result<(), ImportError> {
        let at = statement.keyword.at;
        let first = self.begin_polygon(at)?;
        for &value in statement.values {
            let corner = self.corner(value)?;
            self.add_corner(corner, at)?;
        }
        self.end_polygon(first, at);
        Ok(())
    }

    /// Prepares the lists for a polygon of the statement at `at`. Returns its first corner.
    pub(super) fn begin_polygon(&mut self, at: usize) -> Result<usize, ImportError> {
        self.part()?;
        self.grown(self.text.polygons.len(), size_of::<Polygon>(), at)?;
        Ok(self.text.corners.len())
    }

    /// Adds a corner of the current polygon.
    pub(super) fn add_corner(&mut self, corner: Corner, at: usize) -> Result<(), ImportError> {
        self.grown(self.text.corners.len(), size_of::<Corner>(), at)?;
        self.text.corners.push(corner);
        Ok(())
    }

    /// Adds the polygon of the corners from `first` on.
    pub(super) fn end_polygon(&mut self, first: usize, at: usize) {
        let count = self.text.corners.len() - first;
        if count < 3 {
            let text = format!("a polygon with {count} corners is left out");
            self.context.warn(self.places.place(at), code::POLYGON_DEGENERATE, text);
            self.text.corners.truncate(first);
            return;
        }
        self.text.polygons.push(Polygon {
            first: first as u32,
            count: count as u32,
            part: self.part.unwrap_or(0),
            material: self.material,
            smoothing: self.smoothing,
            at,
        });
    }

    /// Reads `1`, `1/2`, `1//3` or `1/2/3`; numbers below zero count from the end.
    fn corner(&self, value: TextToken<'_>) -> Result<Corner, ImportError> {
        let counts =
            [self.text.positions.len(), self.text.texture_coordinates.len(), self.text.normals.len()];
        let mut corner = [NONE; 3];
        for (slot, part) in value.text.split(|&byte| byte == b'/').enumerate() {
            if slot >= 3 || (part.is_empty() && slot == 0) {
                return Err(self.places.unexpected(value, "a corner such as 1/2/3"));
            }
            if part.is_empty() {
                continue;
            }
            let (is_back, digits) = match part {
                [b'-', digits @ ..] => (true, digits),
                digits => (false, digits),
            };
            let index = parse_whole(digits).filter(|&index| index > 0);
            let index = index.and_then(|index| match is_back {
                true => (counts[slot] as u64).checked_sub(index),
                false => Some(index - 1),
            });
            match index.filter(|&index| index < VERTICES as u64) {
                Some(index) => corner[slot] = index as u32,
                None => {
                    let reason = format!("{} refers to nothing in the file", value.shown());
                    return Err(self.places.invalid(value.at, code::INDEX_INVALID, reason));
                }
            }
        }
        Ok(corner)
    }

    /// Returns the number of the mesh of the current object and group.
    fn part(&mut self) -> Result<u32, ImportError> {
        if let Some(part) = self.part {
            return Ok(part);
        }
        let next = self.text.parts.len() as u32;
        let bytes = size_of::<Mesh>() + 4 * (self.names[0].len() + self.names[1].len() + 64);
        self.context.charge(&Place::File, bytes as u64)?;
        let part = *self.part_numbers.entry(self.names.clone()).or_insert(next);
        if part == next {
            let [object, group] = &self.names;
            let name = match (object.is_empty(), group.is_empty() || group == "default") {
                (true, _) => group.clone(),
                (false, true) => object.clone(),
                (false, false) => format!("{object} {group}"),
            };
            self.text.parts.push(name);
        }
        self.part = Some(part);
        Ok(part)
    }

    fn material(&mut self, statement: &Statement<'_, '_>) -> Result<(), ImportError> {
        let name = self.charged(statement)?;
        let next = self.text.materials.len() as u32;
        self.material = *self.material_numbers.entry(name.clone()).or_insert(next);
        if self.material == next {
            self.text.materials.push(NameAt { name, at: statement.keyword.at });
        }
        Ok(())
    }

    /// Returns the name in a statement, charged with what is made of it.
    fn charged(&self, statement: &Statement<'_, '_>) -> Result<String, ImportError> {
        let name = statement.name();
        let bytes = size_of::<crate::data::Material>() + 8 * (name.len() + 32);
        self.context.charge(&self.places.place(statement.keyword.at), bytes as u64)?;
        Ok(name)
    }

    /// Charges a list before it grows.
    #[inline]
    fn grown(&self, length: usize, size: usize, at: usize) -> Result<(), ImportError> {
        let place = || self.places.place(at);
        if length >= VERTICES {
            let (size, limit) = (length as u64 + 1, VERTICES as u64);
            return Err(ImportError::TooLarge { place: place(), what: "elements", size, limit });
        }
        // A list doubles when it is full, and is copied then.
        if length.is_power_of_two() || length == 0 {
            self.context.charge_at(place, (length.max(4) * 2 * size) as u64)?;
        }
        Ok(())
    }

    /// Refuses positions that do not exist, and leaves out other attributes that do not.
    fn check_corners(&mut self) -> Result<(), ImportError> {
        let text = &mut self.text;
        let counts = [text.positions.len(), text.texture_coordinates.len(), text.normals.len()];
        self.context.work(text.corners.len())?;
        for polygon in &text.polygons {
            for corner in &mut text.corners[polygon.first as usize..][..polygon.count as usize] {
                if corner[0] as usize >= counts[0] {
                    let reason = format!("there is no vertex {}, the file has {}", corner[0] + 1, counts[0]);
                    return Err(self.places.invalid(polygon.at, code::INDEX_INVALID, reason));
                }
                for slot in [1, 2] {
                    if corner[slot] != NONE && corner[slot] as usize >= counts[slot] {
                        let what = ["position", "texture coordinate", "normal"][slot];
                        let text = format!("there is no {what} {}; it is left out", corner[slot] + 1);
                        self.context.warn(self.places.place(polygon.at), code::ATTRIBUTE_INVALID, text);
                        corner[slot] = NONE;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Largest number of unknown statements that are warned of.
const MOST_IGNORED: usize = 16;

/// Returns a keyword, shortened.
fn short(keyword: TextToken<'_>) -> Vec<u8> {
    keyword.text[..keyword.text.len().min(32)].to_vec()
}

/// Returns the linear value of a color in sRGB (IEC 61966-2-1).
pub(super) fn linear_of(color: f32) -> f32 {
    if color <= 0.04045 { color / 12.92 } else { libm::powf((color + 0.055) / 1.055, 2.4) }
}
