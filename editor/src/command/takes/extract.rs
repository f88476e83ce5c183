//! `dragonfly takes extract MODEL -o OUT|DIR`.

use super::super::choice::File;
use super::super::convert::TextureChoice;
use super::super::output::print;
use super::super::{Failure, tell};
use super::chosen;
use dragonfly_document::{ExportContent, ExportOrder, LoadedModel, export_files};
use std::path::PathBuf;

/// Write takes of a model to a new file, or each to its own
#[derive(Clone, Debug, clap::Args)]
pub(super) struct ExtractTakes {
    #[command(flatten)]
    file: File,
    /// Take, by name or by index from 0; repeatable [default: all]
    #[arg(long, value_name = "TAKE", allow_hyphen_values = true)]
    take: Vec<String>,
    /// File to write, or with --each the folder, which is created where it is missing
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Write each take to a file of its own, named `Model@Take`
    #[arg(long)]
    each: bool,
    /// File name extension of the files in the folder
    #[arg(long, value_name = "EXT", requires = "each")]
    to: Option<String>,
    /// Program for which the files are written: unity, unreal, maya or blender, for .fbx
    #[arg(long, value_name = "PRESET")]
    preset: Option<String>,
    /// Place of the images, for .fbx: in the file, or in files next to it, whose names begin with its own [default: embedded]
    #[arg(long, value_name = "PLACE", value_enum)]
    textures: Option<TextureChoice>,
    /// Leave out meshes, materials and images
    #[arg(long)]
    no_mesh: bool,
    /// Leave out all takes
    #[arg(long, conflicts_with_all = ["take", "each", "no_mesh"])]
    no_takes: bool,
}

impl ExtractTakes {
    pub(super) fn run(self) -> Result<(), Failure> {
        let loaded = self.file.load()?;
        let takes = &loaded.model.animation.takes;
        let indices = match &*self.take {
            [] => None,
            wanted => Some(chosen(&loaded.title, takes, wanted)?),
        };
        let content = match (self.no_takes, self.no_mesh) {
            (true, _) => ExportContent::Model,
            (false, true) => ExportContent::Takes,
            (false, false) => ExportContent::Everything,
        };
        let order = ExportOrder {
            output: self.output_of(&loaded),
            preset: self.preset,
            textures: self.textures.map(TextureChoice::placement),
            content,
            takes: indices,
            each: self.each,
            bake: None,
            is_written: true,
        };
        let report = export_files(&loaded.model, &order).map_err(Failure::Input)?;
        for file in &report.files {
            let beside = match &*file.beside {
                [] => String::new(),
                names => format!(", with {} beside it", names.join(", ")),
            };
            tell(format_args!("wrote {} ({} bytes{beside})", file.path.display(), file.bytes));
        }
        print(|out| report.lost.iter().try_for_each(|lost| writeln!(out, "not written: {lost}")))
    }

    /// Returns the file to write; with `--each`, the one to whose name those of the takes are added.
    fn output_of(&self, loaded: &LoadedModel) -> PathBuf {
        if !self.each {
            return self.output.clone();
        }
        let own = loaded.format.filter(|format| format.export.is_some());
        let extension = self.to.as_deref().unwrap_or_else(|| own.map_or("glb", |format| format.extension()));
        let stem = loaded.title.rsplit_once('.').map_or(&*loaded.title, |(stem, _)| stem);
        self.output.join(format!("{stem}.{extension}"))
    }
}
