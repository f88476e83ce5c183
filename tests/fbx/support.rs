//! Helpers of these tests: reading files, and positions in the space of a file.

use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{
    AssetError, AssetFs, Conventions, Conversion, ImportContext, ImportError, NoFiles, ReadOptions, Warning,
};
use dragonfly_fbx::{FbxParser, read_in_process};
use glam::{DMat4, DVec3, DVec4, Vec3};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A model that was read, and what was found on the way.
pub(crate) struct ReadFbx {
    pub(crate) model: ModelData,
    pub(crate) conversion: Conversion,
    pub(crate) warnings: Vec<Warning>,
}

/// Returns the folder of test data of the repository.
pub(crate) fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data")
}

/// Returns the bytes of a file of the repository.
pub(crate) fn file(name: &str) -> Vec<u8> {
    let path = data().join("fbx").join(name);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns the program with planted faults: without one it is the parser.
pub(crate) fn parser() -> FbxParser {
    FbxParser::new(env!("CARGO_BIN_EXE_dragonfly-fbx-faults"))
}

/// Reads a file with `read` and the usual limits.
pub(crate) fn read_with(
    read: impl FnOnce(&ImportContext<'_>) -> Result<ModelData, ImportError>,
    bytes: &[u8],
    files: &dyn AssetFs,
    conventions: Conventions,
) -> Result<ReadFbx, ImportError> {
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    options.budget.input(bytes.len());
    let context = ImportContext::new(files, &options);
    let model = read(&context)?;
    Ok(ReadFbx { model, conversion: context.conversion(), warnings: context.into_warnings() })
}

/// Reads a file in this process.
pub(crate) fn read_here(bytes: &[u8]) -> Result<ReadFbx, ImportError> {
    read_with(|context| read_in_process(bytes, context), bytes, &NoFiles, Conventions::default())
}

/// Reads a file in a child.
pub(crate) fn read_in_child(bytes: &[u8]) -> Result<ReadFbx, ImportError> {
    read_with(|context| parser().read(bytes, context), bytes, &NoFiles, Conventions::default())
}

/// A folder that gives one file.
pub(crate) struct OneFile(pub(crate) &'static str, pub(crate) Vec<u8>);

impl AssetFs for OneFile {
    fn read(&self, path: &str, _limit: u64) -> Result<Vec<u8>, AssetError> {
        if path == self.0 { Ok(self.1.clone()) } else { Err(AssetError::Missing) }
    }
}

/// A model whose poses are given in the space of its file.
pub(crate) struct InFileSpace {
    pub(crate) evaluator: Evaluator,
    to_model: DMat4,
}

impl InFileSpace {
    pub(crate) fn new(read: ReadFbx) -> Self {
        let axes = read.conversion.axes();
        let column = |axis: Vec3| axes.position(axis).as_dvec3().extend(0.0);
        let to_model = DMat4::from_cols(column(Vec3::X), column(Vec3::Y), column(Vec3::Z), DVec4::W);
        Self { evaluator: Evaluator::new(Arc::new(read.model)), to_model }
    }

    /// Returns a matrix of the model as one of the file.
    pub(crate) fn matrix(&self, matrix: glam::Mat4) -> DMat4 {
        self.to_model.inverse() * matrix.as_dmat4() * self.to_model
    }

    /// Returns the positions of all vertices of a mesh in the pose that was set last.
    pub(crate) fn positions(&self, mesh: u32) -> Vec<DVec3> {
        let model = self.evaluator.model();
        let of_mesh = model.instances.iter().enumerate().filter(|(_, instance)| instance.mesh == mesh);
        let back = self.to_model.inverse();
        let mut all = Vec::new();
        for (instance, _) in of_mesh {
            for (primitive, read) in self.evaluator.primitives(instance).iter().enumerate() {
                let mut positions = vec![Vec3::ZERO; read.vertices.len()];
                self.evaluator.positions(instance, primitive, &mut positions);
                all.extend(positions.iter().map(|position| back.transform_point3(position.as_dvec3())));
            }
        }
        all
    }
}
