//! `dragonfly edit FILE --edits EDITS -o OUT`: applies edits without a window, and saves without changing other data.

use super::choice::{model_help, source, source_as};
use super::import_options::ImportArguments;
use super::output::{print, print_json, write_file};
use super::run_command::RunCommand;
use super::{Failure, tell};
use dragonfly_anim::format::SavePlan;
use dragonfly_document::adapter::{EditError, ModelAdapter};
use dragonfly_document::edit::{EDITS, Edit, VERSION, parse_lines};
use dragonfly_document::{
    Cancel, Editable, Rebase, Rebased, SaveFiles, UnfitEdit, check_extension, ensure_folder, make_folder,
    read_file,
};
use serde::Serialize;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Edit takes and save them; in a glTF file, all data that the edits do not concern is unchanged
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "\
Edits are JSON, one object per line; --list shows every edit with an example. If an edit fails, the command stops, reports\n\
its line, and writes nothing.\n\n\
With --rebase, the edits were made for an older version of FILE: bones, takes, layers and shape keys are found by name in\n\
FILE. What does not fit is listed on stderr, the rest is applied and written, and the exit code is 1.\n\n\
Examples:\n  dragonfly edit --list\n  \
dragonfly edit Fox.glb --edits changes.jsonl -o Fox2.glb\n  \
dragonfly edit Fox_new.glb --rebase Fox.glb --edits changes.jsonl -o Fox_new.glb\n  \
echo '{\"edit\":\"reverse_take\",\"take\":\"Run\"}' | dragonfly edit Fox.glb --edits - --dry-run")]
pub(super) struct EditArguments {
    #[arg(value_name = "FILE", help = model_help(), required_unless_present_any = ["list", "schema"])]
    file: Option<PathBuf>,
    /// File of edits, one JSON object per line; `-` is standard input
    #[arg(long, value_name = "EDITS")]
    edits: Option<PathBuf>,
    /// Older version of FILE, for which the edits were made: they are applied to FILE as far as they fit it
    #[arg(long, value_name = "OLD", requires = "edits")]
    rebase: Option<PathBuf>,
    /// File to write; FILE itself is allowed and is replaced atomically
    #[arg(short, long, value_name = "OUT", required_unless_present_any = ["list", "schema", "dry_run"])]
    output: Option<PathBuf>,
    /// Print the changes without writing them
    #[arg(long)]
    dry_run: bool,
    /// Remove data that earlier saves appended, and buffer files that they wrote, where nothing uses them any more
    #[arg(long, conflicts_with = "edits")]
    compact: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    import: ImportArguments,
    /// List every edit with an example
    #[arg(long, conflicts_with_all = ["file", "edits", "output", "dry_run", "compact", "schema"])]
    list: bool,
    /// Print the JSON schema of the edits
    #[arg(long, conflicts_with_all = ["file", "edits", "output", "dry_run", "compact"])]
    schema: bool,
}

/// Maximum size of the edits, bytes.
const EDITS_BYTES: u64 = 1 << 30;

impl RunCommand for EditArguments {
    fn run(self) -> Result<(), Failure> {
        if self.list {
            return list(self.json);
        }
        if self.schema {
            return print_json(&schemars::schema_for!(Edit));
        }
        let Some(file) = &self.file else { return Err(Failure::input("FILE", "is missing")) };
        let editable = Editable::open(&source_as(file, &self.import), &Cancel::default())?;
        let edits = self.edits.as_deref().map(read_edits).transpose()?.unwrap_or_default();
        let (adapter, unfit) = self.edited(&editable, &edits)?;
        let plan = if self.compact { editable.compact() } else { editable.plan(&adapter) };
        let plan = plan.map_err(|error| Failure::input(&editable.title, error))?;
        let written = match &self.output {
            Some(output) if !self.dry_run => save(&editable, &plan, output)?,
            _ => Vec::new(),
        };
        let removed = match &self.output {
            Some(output) if self.compact && !self.dry_run && output != Path::new("-") => unused_of(output)?,
            _ => Vec::new(),
        };
        let pending = adapter.pending_poses();
        if pending > 0 {
            tell(format_args!(
                "{pending} pending poses are not keyed and were not written; the edit \"key_pending\" keys them"
            ));
        }
        self.report(&editable.title, edits.len(), &plan, written, removed, &unfit)?;
        if unfit.is_empty() { Ok(()) } else { Err(Failure::Difference) }
    }
}

impl EditArguments {
    /// Applies the edits. Returns the takes after them, and the edits that do not fit.
    fn edited(
        &self,
        editable: &Editable,
        edits: &[(usize, Edit)],
    ) -> Result<(ModelAdapter, Vec<UnfitEdit>), Failure> {
        let failed = |line: usize, error: EditError| {
            Failure::input(self.edits_name(), format_args!("line {line}: {error}"))
        };
        let Some(old) = &self.rebase else {
            let mut adapter = editable.adapter();
            for (line, edit) in edits {
                let done = adapter.allows(edit).and_then(|()| adapter.apply(edit));
                done.map_err(|error| failed(*line, error))?;
            }
            return Ok((adapter, Vec::new()));
        };
        let old = Editable::open(&source_as(old, &self.import), &Cancel::default())?;
        let mut rebase = Rebase::new(old.adapter(), editable.adapter());
        for (line, edit) in edits {
            let done = rebase.old().allows(edit).and_then(|()| rebase.apply(*line, edit));
            done.map_err(|error| failed(*line, error))?;
        }
        let Rebased { edited, unfit } = rebase.finish();
        for unfit in &unfit {
            tell(format_args!("{}: line {}: {unfit}", self.edits_name(), unfit.number));
        }
        Ok((edited.adapter().clone(), unfit))
    }

    fn edits_name(&self) -> String {
        match &self.edits {
            Some(path) if path != Path::new("-") => path.display().to_string(),
            _ => "edits".to_owned(),
        }
    }

    fn report(
        &self,
        title: &str,
        edits: usize,
        plan: &SavePlan,
        written: Vec<Written>,
        removed: Vec<String>,
        unfit: &[UnfitEdit],
    ) -> Result<(), Failure> {
        // If the model is written to stdout, nothing else is.
        let to_stdout = !self.dry_run && self.output.as_deref() == Some(Path::new("-"));
        if self.json && !to_stdout {
            let changes = plan.changes.as_ref().and_then(|changes| serde_json::from_str(&changes.json).ok());
            let unfit = unfit.iter().map(|edit| UnfitLine { line: edit.number, edit }).collect();
            let lost = plan.lost.iter().map(ToString::to_string).collect();
            let file = title.to_owned();
            return print_json(&EditReport { file, edits, changes, lost, written, removed, unfit });
        }
        if self.dry_run {
            return print(|out| write!(out, "{plan}"));
        }
        for file in written {
            tell(format_args!("wrote {} ({} bytes)", file.path, file.bytes));
        }
        for path in removed {
            tell(format_args!("removed {path}"));
        }
        Ok(())
    }
}

#[derive(Serialize)]
struct EditReport<'a> {
    file: String,
    edits: usize,
    /// Null if the whole file is written.
    changes: Option<serde_json::Value>,
    /// Content of the model that the format does not store.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    lost: Vec<String>,
    written: Vec<Written>,
    /// Buffer files of earlier saves that nothing used any more.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    removed: Vec<String>,
    /// The edits for another version that do not fit.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unfit: Vec<UnfitLine<'a>>,
}

#[derive(Serialize)]
struct UnfitLine<'a> {
    line: usize,
    #[serde(flatten)]
    edit: &'a UnfitEdit,
}

#[derive(Serialize)]
pub(super) struct Written {
    pub(super) path: String,
    pub(super) bytes: usize,
}

fn list(json: bool) -> Result<(), Failure> {
    #[derive(Serialize)]
    struct Entry {
        example: serde_json::Value,
        #[serde(rename = "says")]
        description: &'static str,
    }
    #[derive(Serialize)]
    struct List {
        version: u32,
        edits: Vec<Entry>,
    }
    if !json {
        return print(|out| {
            EDITS
                .iter()
                .try_for_each(|kind| writeln!(out, "# {}\n{}\n", kind.example.description, kind.example.json))
        });
    }
    let value = |text| serde_json::from_str(text).unwrap_or_default();
    let edits = EDITS
        .iter()
        .map(|kind| Entry { example: value(kind.example.json), description: kind.example.description })
        .collect();
    print_json(&List { version: VERSION, edits })
}

pub(super) fn read_edits(path: &Path) -> Result<Vec<(usize, Edit)>, Failure> {
    let name = if path == Path::new("-") { "edits".to_owned() } else { path.display().to_string() };
    let bytes = if path == Path::new("-") {
        let mut bytes = Vec::new();
        let read = std::io::stdin().lock().take(EDITS_BYTES).read_to_end(&mut bytes);
        read.map_err(|error| Failure::input(&name, error))?;
        bytes
    } else {
        read_file(path, EDITS_BYTES).map_err(|error| Failure::input(&name, error))?
    };
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Failure::input(&name, format_args!("byte {at}: this is not UTF-8 text"))
    })?;
    parse_lines(&text).map_err(|error| Failure::input(&name, error))
}

/// Removes the buffer files of earlier saves next to the written model that nothing uses any more. Returns their paths.
fn unused_of(output: &Path) -> Result<Vec<String>, Failure> {
    let written = Editable::open(&source(output), &Cancel::default())?;
    Ok(written.remove_unused().iter().map(|path| path.display().to_string()).collect())
}

/// Writes the files of the plan, and reports what of the model the format does not store. Returns their paths and sizes.
pub(super) fn save(editable: &Editable, plan: &SavePlan, output: &Path) -> Result<Vec<Written>, Failure> {
    if output == Path::new("-") && editable.needs_others(plan) {
        return Err(Failure::input("-", "the model consists of several files; give -o the path of a file"));
    }
    check_extension(output, &editable.ending()).map_err(Failure::Input)?;
    // A mistyped name makes no folder. Only folders of the files next to the model are created.
    ensure_folder(output).map_err(Failure::Input)?;
    let mut written = Vec::new();
    let cancel = Cancel::default();
    let SaveFiles { copied, written: files, .. } =
        editable.files(plan, output, &cancel, &|_| {}).map_err(Failure::Input)?;
    copied.notices().for_each(|notice| tell(format_args!("{notice}")));
    let copy = |path: &Path, bytes, _| written.push(Written { path: path.display().to_string(), bytes });
    copied.write(None, &cancel, copy).map_err(Failure::Input)?;
    for (at, (path, bytes)) in files.iter().enumerate() {
        // The folder of the model, the last file, exists; folders of the files that it refers to are created.
        if at + 1 < files.len() {
            make_folder(path).map_err(Failure::Input)?;
        }
        write_file(path, bytes)?;
        written.push(Written { path: path.display().to_string(), bytes: bytes.len() });
    }
    plan.lost.iter().for_each(|lost| tell(format_args!("not saved: {lost}")));
    Ok(written)
}
