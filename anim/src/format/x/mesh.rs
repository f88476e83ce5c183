//! The object `Mesh`, and the objects in it.

use super::check as code;
use super::lexer::{XLexer, XToken};
use super::names::decoded;
use super::scene::matrix;
use super::surface::{MaterialUse, material};
use crate::format::{ImportContext, ImportError};
use crate::limits::VERTICES;
use glam::{Mat4, Vec2, Vec3, Vec4};

/// Polygons: the corners of all, and where each starts.
#[derive(Default)]
pub(super) struct XFaces {
    pub(super) corners: Vec<u32>,
    /// One more than there are polygons.
    pub(super) starts: Vec<u32>,
}

impl XFaces {
    pub(super) fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Returns the range of the corners of a polygon.
    pub(super) fn range(&self, face: usize) -> std::ops::Range<usize> {
        self.starts[face] as usize..self.starts[face + 1] as usize
    }
}

/// Weights of one bone.
pub(super) struct XWeights {
    pub(super) frame: String,
    pub(super) vertices: Vec<u32>,
    pub(super) weights: Vec<f32>,
    /// Mesh space → bone space.
    pub(super) offset: Mat4,
}

/// A mesh, as in the file.
#[derive(Default)]
pub(super) struct XMesh {
    /// Empty where it has none.
    pub(super) name: String,
    pub(super) positions: Vec<Vec3>,
    pub(super) faces: XFaces,
    pub(super) normals: Vec<Vec3>,
    /// Normals of the corners of all polygons; empty without normals.
    pub(super) normal_corners: Vec<u32>,
    /// Empty, or one for each position.
    pub(super) texture_coordinates: Vec<Vec2>,
    /// Empty, or one for each position.
    pub(super) colors: Vec<Vec4>,
    pub(super) materials: Vec<MaterialUse>,
    /// Material of each polygon; the last one is that of all further ones.
    pub(super) face_materials: Vec<u32>,
    pub(super) skin: Vec<XWeights>,
}

/// Reads a mesh after its opening brace.
pub(super) fn mesh(
    lexer: &mut XLexer<'_>,
    name: String,
    context: &ImportContext<'_>,
) -> Result<XMesh, ImportError> {
    let place = lexer.place(lexer.at());
    let count = lexer.count("the number of vertices", 3)?;
    if count > VERTICES {
        let (size, limit) = (count as u64, VERTICES as u64);
        return Err(ImportError::TooLarge { place, what: "vertices", size, limit });
    }
    let mut mesh = XMesh { name, positions: context.vec(&place, count)?, ..XMesh::default() };
    for _ in 0..count {
        context.work(3)?;
        mesh.positions.push(Vec3::from(lexer.floats::<3>("a position")?));
    }
    mesh.faces = faces(lexer, count, "the vertex of a face", context)?;
    loop {
        context.work(1)?;
        let found = lexer.need("the end of a mesh")?;
        match found.token {
            XToken::Close => return Ok(mesh),
            XToken::Word(kind) => mesh.child(kind, lexer, context)?,
            XToken::Open => _ = lexer.reference(context)?,
            XToken::Number(_) | XToken::Text(_) | XToken::Other => {
                return Err(lexer.unexpected(found, "an object of a mesh"));
            }
        }
    }
}

impl XMesh {
    /// Reads an object in the mesh.
    fn child(
        &mut self,
        kind: &[u8],
        lexer: &mut XLexer<'_>,
        context: &ImportContext<'_>,
    ) -> Result<(), ImportError> {
        lexer.open()?;
        match kind {
            b"MeshNormals" => self.read_normals(lexer, context)?,
            b"MeshTextureCoords" => self.read_texture_coordinates(lexer, context)?,
            b"MeshVertexColors" => self.read_colors(lexer, context)?,
            // This one ends with materials.
            b"MeshMaterialList" => return self.read_materials(lexer, context),
            b"SkinWeights" => self.read_weights(lexer, context)?,
            _ => {}
        }
        lexer.close(context).map(|_| ())
    }

    fn read_normals(
        &mut self,
        lexer: &mut XLexer<'_>,
        context: &ImportContext<'_>,
    ) -> Result<(), ImportError> {
        let place = lexer.place(lexer.at());
        let count = lexer.count("the number of normals", 3)?;
        let mut normals = context.vec(&place, count)?;
        for _ in 0..count {
            context.work(3)?;
            normals.push(Vec3::from(lexer.floats::<3>("a normal")?));
        }
        let faces = faces(lexer, count, "the normal of a face", context)?;
        if faces.starts == self.faces.starts {
            (self.normals, self.normal_corners) = (normals, faces.corners);
        } else {
            let text = "the normals do not fit the faces; others are computed";
            context.warn(place, code::LIST_IGNORED, text);
        }
        Ok(())
    }

    fn read_texture_coordinates(
        &mut self,
        lexer: &mut XLexer<'_>,
        context: &ImportContext<'_>,
    ) -> Result<(), ImportError> {
        let place = lexer.place(lexer.at());
        let count = lexer.count("the number of texture coordinates", 2)?;
        if count != self.positions.len() {
            let text =
                format!("{count} texture coordinates for {} vertices are left out", self.positions.len());
            context.warn(place, code::LIST_IGNORED, text);
            return Ok(());
        }
        self.texture_coordinates = context.vec(&place, count)?;
        for _ in 0..count {
            context.work(2)?;
            self.texture_coordinates.push(Vec2::from(lexer.floats::<2>("texture coordinates")?));
        }
        Ok(())
    }

    fn read_colors(
        &mut self,
        lexer: &mut XLexer<'_>,
        context: &ImportContext<'_>,
    ) -> Result<(), ImportError> {
        let place = lexer.place(lexer.at());
        let count = lexer.count("the number of colors", 5)?;
        let mut colors = context.filled(&place, self.positions.len(), Vec4::ONE)?;
        for _ in 0..count {
            context.work(5)?;
            let vertex = lexer.whole("the vertex of a color", u32::MAX)? as usize;
            let color = Vec4::from(lexer.floats::<4>("a color")?).clamp(Vec4::ZERO, Vec4::ONE);
            if let Some(slot) = colors.get_mut(vertex) {
                *slot = color;
            } else {
                let text =
                    format!("the color of vertex {vertex} is left out, there are {}", self.positions.len());
                context.warn(place.clone(), code::LIST_IGNORED, text);
            }
        }
        self.colors = colors;
        Ok(())
    }

    fn read_materials(
        &mut self,
        lexer: &mut XLexer<'_>,
        context: &ImportContext<'_>,
    ) -> Result<(), ImportError> {
        let place = lexer.place(lexer.at());
        let announced = lexer.whole("the number of materials", u32::MAX)? as usize;
        let count = lexer.count("the number of faces with a material", 1)?;
        let mut list = context.vec(&place, count)?;
        for _ in 0..count {
            context.work(1)?;
            list.push(lexer.index("the material of a face", announced)?);
        }
        self.face_materials = list;
        loop {
            context.work(1)?;
            let found = lexer.need("the end of a list of materials")?;
            match found.token {
                XToken::Close => return Ok(()),
                XToken::Word(kind) => {
                    let name = lexer.open()?;
                    if kind == b"Material" {
                        let name = name.map_or_else(String::new, |name| decoded(lexer.text(name)));
                        let material = material(lexer, name, context)?;
                        self.materials.push(MaterialUse::Own(material));
                    } else {
                        lexer.close(context)?;
                    }
                }
                XToken::Open => {
                    let name = lexer.reference(context)?.unwrap_or_default();
                    let bytes = 4 * size_of::<MaterialUse>() + 2 * name.len();
                    context.charge(&place, bytes as u64)?;
                    self.materials.push(MaterialUse::Named(name, lexer.place(found.at)));
                }
                XToken::Number(_) | XToken::Text(_) | XToken::Other => {
                    return Err(lexer.unexpected(found, "a material"));
                }
            }
        }
    }

    fn read_weights(
        &mut self,
        lexer: &mut XLexer<'_>,
        context: &ImportContext<'_>,
    ) -> Result<(), ImportError> {
        let string = lexer.string("the name of a frame")?;
        let frame = match string.token {
            XToken::Text(text) | XToken::Word(text) => decoded(text),
            XToken::Number(_) | XToken::Open | XToken::Close | XToken::Other => String::new(),
        };
        let place = lexer.place(string.at);
        context.charge(&place, 512 + 4 * frame.len() as u64)?;
        let count = lexer.count("the number of weights", 2)?;
        let (mut vertices, mut weights) = (context.vec(&place, count)?, context.vec(&place, count)?);
        for _ in 0..count {
            context.work(2)?;
            vertices.push(lexer.index("the vertex of a weight", self.positions.len())?);
        }
        for _ in 0..count {
            weights.push(lexer.floats::<1>("a weight")?[0]);
        }
        let offset = matrix(lexer, "the offset of a bone", context)?;
        self.skin.push(XWeights { frame, vertices, weights, offset });
        Ok(())
    }
}

/// Reads polygons: their number, and for each the number of its corners and an index below `count` for each corner.
fn faces(
    lexer: &mut XLexer<'_>,
    count: usize,
    what: &str,
    context: &ImportContext<'_>,
) -> Result<XFaces, ImportError> {
    let place = lexer.place(lexer.at());
    let polygons = lexer.count("the number of faces", 2)?;
    let mut faces = XFaces { corners: Vec::new(), starts: context.vec(&place, polygons + 1)? };
    faces.starts.push(0);
    for _ in 0..polygons {
        let corners = lexer.count("the number of corners of a face", 1)?;
        context.work(corners)?;
        if faces.corners.capacity() - faces.corners.len() < corners {
            // At least as much as there is, so that the list is seldom copied.
            let more = corners.max(faces.corners.len()).max(polygons.min(1 << 16));
            context.charge(&place, more as u64 * 4)?;
            faces.corners.reserve_exact(more);
        }
        for _ in 0..corners {
            faces.corners.push(lexer.index(what, count)?);
        }
        faces.starts.push(faces.corners.len() as u32);
    }
    Ok(faces)
}
