//! All objects of a file: frames, meshes, materials and animation sets.

use super::animation::{XSet, animation_set};
use super::check as code;
use super::header::XFile;
use super::lexer::{Lexeme, XLexer, XToken};
use super::mesh::{XMesh, mesh};
use super::names::decoded;
use super::surface::{MaterialUse, XMaterial, material};
use crate::format::{ImportContext, ImportError};
use crate::limits::{NODE_DEPTH, NODES};
use glam::{Mat4, Vec4};

/// A frame: a node of the scene.
pub(super) struct XFrame {
    /// As in the file; empty where it has none.
    pub(super) name: String,
    /// Number of the parent, which is before its children.
    pub(super) parent: Option<usize>,
    /// Transform relative to the parent.
    pub(super) matrix: Mat4,
}

/// The objects of a file that are used.
#[derive(Default)]
pub(super) struct XScene {
    pub(super) frames: Vec<XFrame>,
    pub(super) meshes: Vec<XMesh>,
    /// Meshes with the frames that contain them; `None` for one outside of all frames.
    pub(super) placed: Vec<(usize, Option<usize>)>,
    /// Materials outside of meshes.
    pub(super) materials: Vec<XMaterial>,
    pub(super) sets: Vec<XSet>,
    /// Ticks per second.
    pub(super) ticks: Option<f32>,
    /// End of the last object.
    pub(super) end: usize,
}

impl XScene {
    /// Returns the names of all textures.
    pub(super) fn textures(&self) -> impl Iterator<Item = &str> {
        let own = self.meshes.iter().flat_map(|mesh| &mesh.materials).filter_map(MaterialUse::texture);
        self.materials.iter().filter_map(XMaterial::texture).chain(own)
    }

    /// Reads a file.
    pub(super) fn parse(file: &XFile<'_>, context: &ImportContext<'_>) -> Result<Self, ImportError> {
        let lexer = file.lexer();
        let mut parser = SceneParser {
            bytes: file.bytes(),
            lexer,
            context,
            scene: Self::default(),
            open: Vec::new(),
            references: Vec::new(),
        };
        while let Some(found) = parser.lexer.next()? {
            context.work(1)?;
            parser.object(found)?;
            parser.scene.end = parser.lexer.at();
        }
        if !parser.open.is_empty() {
            let reason = format!("the file ends inside of {} frames", parser.open.len());
            return Err(parser.lexer.invalid(parser.lexer.at(), code::BRACE_INVALID, reason));
        }
        parser.place()?;
        Ok(parser.scene)
    }
}

struct SceneParser<'a, 'b> {
    bytes: &'a [u8],
    lexer: XLexer<'a>,
    context: &'b ImportContext<'b>,
    scene: XScene,
    /// Frames whose brace is open.
    open: Vec<usize>,
    /// Objects that frames refer to.
    references: Vec<(usize, String)>,
}

impl SceneParser<'_, '_> {
    /// Reads the object that starts with a token, or the end of a frame.
    fn object(&mut self, found: Lexeme<'_>) -> Result<(), ImportError> {
        match found.token {
            XToken::Word(kind) => self.named(kind, found),
            XToken::Close => match self.open.pop() {
                Some(_) => Ok(()),
                None => Err(self.lexer.invalid(found.at, code::BRACE_INVALID, "one closing brace too many")),
            },
            XToken::Open => {
                let name = self.lexer.reference(self.context)?;
                if let (Some(&frame), Some(name)) = (self.open.last(), name) {
                    self.context.charge(&self.lexer.place(found.at), 64 + 2 * name.len() as u64)?;
                    self.references.push((frame, name));
                }
                Ok(())
            }
            XToken::Number(_) | XToken::Text(_) => Err(self.lexer.unexpected(found, "an object")),
            XToken::Other => Ok(()),
        }
    }

    fn named(&mut self, kind: &[u8], found: Lexeme<'_>) -> Result<(), ImportError> {
        let frame = self.open.last().copied();
        match kind {
            b"Frame" => self.frame(found, frame),
            b"FrameTransformMatrix" => {
                self.lexer.open()?;
                let matrix = matrix(&mut self.lexer, "the transform of a frame", self.context)?;
                self.lexer.close(self.context)?;
                if let Some(frame) = frame {
                    self.scene.frames[frame].matrix = matrix;
                }
                Ok(())
            }
            b"Mesh" => {
                let name = self.open_named()?;
                let mesh = mesh(&mut self.lexer, name, self.context)?;
                self.context.charge(&self.lexer.place(found.at), 4 * size_of::<XMesh>() as u64)?;
                self.scene.placed.push((self.scene.meshes.len(), frame));
                self.scene.meshes.push(mesh);
                Ok(())
            }
            b"Material" => {
                let name = self.open_named()?;
                let material = material(&mut self.lexer, name, self.context)?;
                self.scene.materials.push(material);
                Ok(())
            }
            b"AnimationSet" => {
                let set = animation_set(&mut self.lexer, found.at, self.context)?;
                self.scene.sets.push(set);
                Ok(())
            }
            b"AnimTicksPerSecond" => {
                self.lexer.open()?;
                let at = self.lexer.at();
                let rate = self.lexer.number("the number of ticks per second")? as f32;
                self.lexer.close(self.context)?;
                if rate.is_finite() && rate > 0.0 {
                    self.scene.ticks.get_or_insert(rate);
                } else {
                    let text = format!("{rate} ticks per second are not possible");
                    self.context.warn(self.lexer.place(at), code::TICKS_GUESSED, text);
                }
                Ok(())
            }
            _ => {
                self.lexer.open()?;
                self.lexer.close(self.context).map(|_| ())
            }
        }
    }

    /// Skips the name and the opening brace of an object. Returns the name, or an empty one.
    fn open_named(&mut self) -> Result<String, ImportError> {
        let name = self.lexer.open()?;
        Ok(name.map_or_else(String::new, |name| decoded(&self.bytes[name])))
    }

    fn frame(&mut self, found: Lexeme<'_>, parent: Option<usize>) -> Result<(), ImportError> {
        let too_large = |what, size: usize, limit: usize| {
            let (place, size, limit) = (self.lexer.place(found.at), size as u64, limit as u64);
            Err(ImportError::TooLarge { place, what, size, limit })
        };
        if self.scene.frames.len() >= NODES {
            return too_large("frames", self.scene.frames.len() + 1, NODES);
        }
        if self.open.len() >= NODE_DEPTH {
            return too_large("frames inside each other", self.open.len() + 1, NODE_DEPTH);
        }
        let name = self.open_named()?;
        // Charged for the list while it grows, the bone, and the copies of the name.
        let bytes = 3 * size_of::<XFrame>() + 2 * size_of::<crate::data::Bone>() + 6 * (name.len() + 24);
        self.context.charge(&self.lexer.place(found.at), bytes as u64)?;
        self.open.push(self.scene.frames.len());
        self.scene.frames.push(XFrame { name, parent, matrix: Mat4::IDENTITY });
        Ok(())
    }

    /// Puts meshes outside of all frames into the frames that refer to them.
    fn place(&mut self) -> Result<(), ImportError> {
        for (frame, name) in &self.references {
            self.context.work(self.scene.meshes.len())?;
            let found = self.scene.meshes.iter().position(|mesh| mesh.name == *name);
            let Some(mesh) = found else { continue };
            let free =
                self.scene.placed.iter_mut().find(|(placed, frame)| *placed == mesh && frame.is_none());
            match free {
                Some((_, place)) => *place = Some(*frame),
                None => {
                    self.context.charge(&crate::format::Place::File, 512)?;
                    self.scene.placed.push((mesh, Some(*frame)));
                }
            }
        }
        Ok(())
    }
}

/// Reads a matrix: 16 numbers, in the order of the columns of a matrix for column vectors.
pub(super) fn matrix(
    lexer: &mut XLexer<'_>,
    what: &str,
    context: &ImportContext<'_>,
) -> Result<Mat4, ImportError> {
    let at = lexer.at();
    let matrix = Mat4::from_cols_array(&lexer.floats::<16>(what)?);
    Ok(affine(matrix, || {
        context.warn(
            lexer.place(at),
            code::MATRIX_INVALID,
            "the last column should be 0 0 0 1 and was replaced by that",
        );
    }))
}

/// Returns a matrix with the last row 0 0 0 1, and calls `odd` if it has another one.
pub(super) fn affine(mut matrix: Mat4, odd: impl FnOnce()) -> Mat4 {
    if !matrix.row(3).abs_diff_eq(Vec4::W, 1e-5) {
        odd();
    }
    (matrix.x_axis.w, matrix.y_axis.w, matrix.z_axis.w, matrix.w_axis.w) = (0.0, 0.0, 0.0, 1.0);
    matrix
}
