//! glTF as a surgical format: implements the interface that all formats share for [`SourceFile`].

use super::source::{SourceFile, is_data};
use super::{Plan, SaveError, compact, plan_with_skeleton};
use crate::data::{ModelData, Skeleton};
use crate::format::uri::relative_path;
use crate::format::{
    ChangeReport, EditedTake, ExportError, ImportContext, ImportError, SavePlan, SurgicalFile,
};
use std::sync::Arc;

/// Opens a `.glb` or `.gltf` file for [`WriteSupport::Surgical`](crate::format::WriteSupport::Surgical).
pub(in super::super) fn open(
    name: &str,
    bytes: Arc<[u8]>,
    context: &ImportContext<'_>,
) -> Result<Box<dyn SurgicalFile>, ImportError> {
    Ok(Box::new(SourceFile::parse(name, bytes, context)?))
}

impl SurgicalFile for SourceFile {
    fn plan(
        &self,
        opened: &ModelData,
        skeleton: &Skeleton,
        takes: &[EditedTake],
    ) -> Result<SavePlan, ExportError> {
        Ok(SavePlan::from(plan_with_skeleton(self, opened, skeleton, takes)?))
    }

    fn compact(&self) -> Result<SavePlan, ExportError> {
        Ok(SavePlan::from(compact(self)?))
    }

    fn neighbors(&self) -> Vec<String> {
        self.referenced_files()
    }
}

impl SourceFile {
    /// Returns the files that this one refers to (buffers, images), as paths relative to its folder, each once. Data URIs
    /// and references that no importer follows are left out.
    pub fn referenced_files(&self) -> Vec<String> {
        let json = self.json();
        let mut found = Vec::new();
        for list in ["buffers", "images"] {
            for item in json.list(0, list) {
                let uri = json.string_member(item, "uri").filter(|uri| !is_data(uri));
                let name = uri.and_then(|uri| relative_path(&uri).ok());
                found.extend(name.filter(|name| !found.contains(name)));
            }
        }
        found
    }
}

impl From<Plan<'_>> for SavePlan {
    fn from(plan: Plan<'_>) -> Self {
        let files = plan.write();
        // The texts of the patches are in the files now.
        let Plan { changes, .. } = plan;
        let report = ChangeReport { text: changes.to_string(), json: changes.to_json() };
        Self { files, lost: Vec::new(), changes: Some(report) }
    }
}

impl From<SaveError> for ExportError {
    fn from(error: SaveError) -> Self {
        Self::new(error)
    }
}
