//! `dragonfly takes add MODEL CLIP… -o OUT`.

use super::super::choice::{load, model_help, plain, source, source_as};
use super::super::edit::save;
use super::super::import_options::ImportArguments;
use super::super::output::{print, print_json};
use super::super::{Failure, tell};
use clap::ValueEnum;
use dragonfly_anim::retarget::FigureOptions;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{AddTakes, Edit};
use dragonfly_document::{BoneMap, Cancel, ClipNaming, ClipSettings, Editable, TakeNames, clip_takes};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Add the takes of other files to a model: bones are matched by name, other rest poses and proportions are retargeted
#[derive(Clone, Debug, clap::Args)]
pub(super) struct AddClips {
    #[arg(value_name = "MODEL", help = model_help())]
    model: PathBuf,
    /// Files with takes; all takes of each are added
    #[arg(value_name = "CLIP", required = true)]
    clips: Vec<PathBuf>,
    /// File to write; MODEL itself is allowed and is replaced atomically
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// File with the map of bones; guessed where absent
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// How new takes are named
    #[arg(long, value_enum, default_value_t = Names::Automatic)]
    names: Names,
    /// Let feet slide
    #[arg(long)]
    no_contacts: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
    /// Options for the clips; the model is read as it is.
    #[command(flatten)]
    import: ImportArguments,
}

/// How new takes are named.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Names {
    /// After the take, or after the file where it has a generic name
    Automatic,
    /// After the file
    File,
    /// After the take
    Take,
}

#[derive(Serialize)]
struct AddedClip {
    file: String,
    /// Names of the new takes.
    takes: Vec<String>,
    /// Number of bones of the model that move.
    bones: usize,
    /// Whether the keys are those of the file, since both skeletons are the same.
    copied: bool,
    /// Largest distance that a foot slides in a contact after retargeting, millimeters.
    slide_mm: f32,
    /// Moved bones of the file that no bone of the model follows.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unmatched: Vec<String>,
    /// Names of the map that no bone has.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    missing: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

impl AddClips {
    pub(super) fn run(self) -> Result<(), Failure> {
        let editable = Editable::open(&source(&self.model), &Cancel::default())?;
        let mut adapter = ModelAdapter::of(&editable.model);
        let (mut names, settings) = (TakeNames::of(&adapter), self.settings()?);
        let (mut takes, mut report, mut failed) = (Vec::new(), Vec::new(), 0);
        for path in &self.clips {
            let file = path.display().to_string();
            let done =
                load(&source_as(path, &self.import)).map_err(|error| failure_text(&error)).and_then(|clip| {
                    let target = &editable.model;
                    clip_takes(&clip.title, &clip.model, &|_, _| true, target, &mut names, &settings)
                        .map_err(|reason| format!("{file}: {reason}"))
                });
            match done {
                Ok(done) => {
                    report.push(AddedClip {
                        file,
                        takes: done.takes.iter().map(|take| take.name.clone()).collect(),
                        bones: done.bound,
                        copied: done.is_copied,
                        slide_mm: done.slide,
                        unmatched: done.unmatched,
                        missing: done.missing,
                        error: None,
                    });
                    takes.extend(done.takes);
                }
                // The other files are still added; the exit code is 2 then.
                Err(reason) => {
                    tell(&reason);
                    failed += 1;
                    report.push(AddedClip { error: Some(reason), ..AddedClip::failed(file) });
                }
            }
        }
        if takes.is_empty() {
            return Err(Failure::input(&editable.title, "no take was added; nothing is written"));
        }
        let edit = Edit::AddTakes(AddTakes { takes });
        adapter
            .allows(&edit)
            .and_then(|()| adapter.apply(&edit))
            .map_err(|error| Failure::input(&editable.title, error))?;
        let plan = editable.plan(&adapter).map_err(|error| Failure::input(&editable.title, error))?;
        let written = save(&editable, &plan, &self.output)?;
        if self.output != Path::new("-") {
            if self.json { print_json(&report)? } else { print(|out| write(&report, out))? }
        }
        for file in written {
            tell(format_args!("wrote {} ({} bytes)", file.path, file.bytes));
        }
        match failed {
            0 => Ok(()),
            failed => Err(Failure::Input(format!("{failed} of {} files were not added", self.clips.len()))),
        }
    }
}

impl AddedClip {
    fn failed(file: String) -> Self {
        let (takes, unmatched, missing) = (Vec::new(), Vec::new(), Vec::new());
        Self { file, takes, bones: 0, copied: false, slide_mm: 0.0, unmatched, missing, error: None }
    }
}

impl AddClips {
    fn settings(&self) -> Result<ClipSettings, Failure> {
        let map = self.map.as_deref().map(BoneMap::read).transpose().map_err(Failure::Input)?;
        let naming = match self.names {
            Names::Automatic => ClipNaming::Automatic,
            Names::File => ClipNaming::File,
            Names::Take => ClipNaming::Take,
        };
        let figure = FigureOptions { contacts: !self.no_contacts, ..FigureOptions::default() };
        Ok(ClipSettings { map, figure, naming })
    }
}

fn failure_text(failure: &Failure) -> String {
    match failure {
        Failure::Input(reason) | Failure::Machine(reason) => reason.clone(),
        Failure::Difference | Failure::OutputClosed => String::new(),
    }
}

fn write(report: &[AddedClip], out: &mut dyn std::io::Write) -> std::io::Result<()> {
    for clip in report.iter().filter(|clip| clip.error.is_none()) {
        let how = if clip.copied { "keys copied" } else { "retargeted" };
        let names = clip.takes.iter().map(|name| plain(name)).collect::<Vec<_>>().join(", ");
        writeln!(out, "{}: {names} ({} bones, {how})", plain(&clip.file), clip.bones)?;
        if !clip.unmatched.is_empty() {
            let bones = clip.unmatched.iter().map(|name| plain(name)).collect::<Vec<_>>().join(", ");
            writeln!(out, "  no bone follows: {bones}")?;
        }
        for name in &clip.missing {
            writeln!(out, "  not found: {}", plain(name))?;
        }
    }
    Ok(())
}
