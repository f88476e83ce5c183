//! `dragonfly check FILE…`: lists all problems of models, with their paths in the file.

use super::Failure;
use super::choice::{load_checked, models_help, plain, source};
use super::output::{print, print_json};
use super::run_command::RunCommand;
use super::table::count;
use super::take_lint::{TakeDefect, defects};
use dragonfly_anim::check::{RULES, Severity, check};
use dragonfly_document::{Cancel, CheckedText, TakeThresholds, check_scene, is_project, is_scene};
use serde::Serialize;
use std::io::{self, Write};
use std::path::PathBuf;

/// Lists errors, warnings and notes of models.
#[derive(Clone, Debug, clap::Args)]
#[command(about = about(), long_about = None, after_help = "\
Findings are errors (shown wrong, or replaced by a placeholder), warnings (allowed, but probably unintended) and notes.\n\
Import warnings are listed as well. Exit code 1: at least one finding has the severity of --deny or higher, or with --takes, a take has a defect.\n\n\
A scene (.xml) or project (.meproj) is checked with the models, sounds and scripts that it names; findings have line and column.\n\n\
With --takes, motion is measured frame by frame: jitter, foot_slide, floor, pop, flip, stretch, joint_limit,\n\
loop_gap (off), spare_keys and outside. A figure of more than 20 m is taken to be in centimeters or millimeters. --thresholds FILE is a JSON object such as {\"pop\": 80, \"floor\": null, \"loop_gap\": 5, \"meters_per_unit\": 0.01,\n\
\"up\": \"y\", \"floor_height\": 0, \"rate\": 30, \"joints\": {\"Knee.L\": {\"hinge\": {\"axis\": \"x\", \"range\": [0, 150]}}}}; null switches a\n\
rule off. Without --thresholds, those of Fox.glb are read from Fox.check.json next to it, as the editor does.\n\n\
Examples:\n  dragonfly check Fox.glb\n  dragonfly check models/*.glb --deny warning --json\n  \
dragonfly check Fox.glb --takes --thresholds lint.json\n  dragonfly check duel.xml")]
pub(super) struct CheckArguments {
    #[arg(value_name = "FILE", required = true, help = models_help())]
    files: Vec<PathBuf>,
    /// Exit with code 1 on findings of this severity or higher
    #[arg(long, value_name = "SEVERITY", default_value = "error")]
    deny: Deny,
    /// Also measure defects of the motion of takes, each with bone, frame, amount and unit
    #[arg(long)]
    takes: bool,
    /// Read the thresholds of --takes from a JSON file, instead of the file next to each model
    #[arg(long, value_name = "FILE", requires = "takes")]
    thresholds: Option<PathBuf>,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
}

/// Returns the first line of the help text, with the number of rules.
fn about() -> String {
    format!("Check models against {} rules and list errors, warnings and notes", RULES.len())
}

/// The lowest severity that fails a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Deny {
    /// Errors and warnings fail.
    Warning,
    /// Only errors fail.
    Error,
}

impl Deny {
    fn denies(self, severity: Severity) -> bool {
        match severity {
            Severity::Error => true,
            Severity::Warning => self == Self::Warning,
            Severity::Note => false,
        }
    }
}

impl RunCommand for CheckArguments {
    fn run(self) -> Result<(), Failure> {
        let mut reports = Vec::with_capacity(self.files.len());
        let mut failure = None;
        let given =
            self.thresholds.as_deref().map(TakeThresholds::read).transpose().map_err(Failure::Input)?;
        for file in &self.files {
            let thresholds =
                self.takes.then(|| given.clone().map_or_else(|| TakeThresholds::of_model(file), Ok));
            let thresholds = thresholds.transpose().map_err(Failure::Input);
            match thresholds.and_then(|thresholds| CheckReport::of(file, self.deny, thresholds.as_ref())) {
                Ok(report) => reports.push(report),
                // The files after it are still checked; the last unreadable one decides the exit
                // code.
                Err(error) => {
                    if let Some(earlier) = failure.replace(error) {
                        earlier.report();
                    }
                }
            }
        }
        let denied = reports.iter().any(|report| report.denied > 0);
        if self.json {
            print_json(&reports)?;
        } else {
            print(|out| reports.iter().try_for_each(|report| report.write(out)))?;
        }
        match failure {
            Some(error) => Err(error),
            None if denied => Err(Failure::Difference),
            None => Ok(()),
        }
    }
}

/// The findings in one file.
#[derive(Default, Serialize)]
struct CheckReport {
    file: String,
    errors: usize,
    warnings: usize,
    notes: usize,
    /// Findings at or above the severity that fails the check.
    #[serde(skip)]
    denied: usize,
    findings: Vec<FindingRow>,
    /// Defects of takes; absent without `--takes`.
    #[serde(skip_serializing_if = "Option::is_none")]
    takes: Option<Vec<TakeDefect>>,
    /// Meters in one unit of length with which takes were measured; absent without `--takes`.
    #[serde(skip_serializing_if = "Option::is_none")]
    meters_per_unit: Option<f32>,
}

/// One finding.
#[derive(Serialize)]
struct FindingRow {
    severity: &'static str,
    rule: &'static str,
    /// The text of a project, or the included script, that has it; absent for the file of the report.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    place: String,
    text: String,
}

impl FindingRow {
    /// Returns whether both say the same about the same place.
    fn is_of(&self, other: &Self) -> bool {
        let key = |row: &Self| (row.rule, row.file.clone(), row.place.clone(), row.text.clone());
        key(self) == key(other)
    }
}

impl CheckReport {
    fn of(file: &std::path::Path, deny: Deny, thresholds: Option<&TakeThresholds>) -> Result<Self, Failure> {
        if is_scene(file) {
            return Self::of_scene(file, deny);
        }
        let loaded = load_checked(&source(file))?;
        let takes = thresholds.map(|thresholds| defects(&loaded.model.animation, thresholds)).transpose()?;
        let unknown = thresholds.and_then(|own| own.unknown_joints(&loaded.model.animation.skeleton));
        let mut report = Self {
            file: loaded.title,
            errors: 0,
            warnings: 0,
            notes: 0,
            denied: takes.as_ref().map_or(0, Vec::len),
            findings: Vec::new(),
            takes,
            meters_per_unit: thresholds
                .map(|thresholds| thresholds.unit_of(&loaded.model.animation.skeleton)),
        };
        if let Some(text) = unknown {
            let row = FindingRow { severity: "", rule: "JOINTS", file: None, place: String::new(), text };
            report.add(deny, Severity::Warning, row);
        }
        let imported = loaded.warnings.into_iter().chain(loaded.notes);
        for text in imported {
            report.add(
                deny,
                Severity::Warning,
                FindingRow { severity: "", rule: "IMPORT", file: None, place: String::new(), text },
            );
        }
        for finding in check(&loaded.model) {
            let row = FindingRow {
                severity: "",
                rule: finding.rule,
                file: None,
                place: finding.path.to_string(),
                text: finding.text,
            };
            report.add(deny, finding.severity, row);
        }
        Ok(report)
    }

    /// Checks all texts of a scene with the models and sounds that they name. What is wrong are findings with line and column; those of a
    /// project and of included scripts name their file.
    fn of_scene(file: &std::path::Path, deny: Deny) -> Result<Self, Failure> {
        let checked = check_scene(file, &Cancel::default())?;
        let title = checked.first().map(|text| text.name.to_string()).unwrap_or_default();
        let mut report = Self { file: title, ..Self::default() };
        for CheckedText { name, errors, unfit, notes } in checked {
            let lists = [
                (Severity::Error, "SCRIPT", errors),
                (Severity::Warning, "EDITS", unfit),
                (Severity::Note, "SCRIPT", notes),
            ];
            for (severity, rule, list) in lists {
                for error in list {
                    let text = error.sentence();
                    let own = || is_project(file).then(|| name.to_string());
                    let (file, place) = match &error.inside {
                        Some(inside) => (Some(inside.file.to_string()), inside.place.to_string()),
                        None => (own(), error.place.to_string()),
                    };
                    let row = FindingRow { severity: "", rule, file, place, text };
                    // Each script that includes a file finds its errors.
                    if error.inside.is_none() || !report.findings.iter().any(|other| other.is_of(&row)) {
                        report.add(deny, severity, row);
                    }
                }
            }
        }
        Ok(report)
    }

    fn add(&mut self, deny: Deny, severity: Severity, row: FindingRow) {
        let (number, name) = match severity {
            Severity::Error => (&mut self.errors, "error"),
            Severity::Warning => (&mut self.warnings, "warning"),
            Severity::Note => (&mut self.notes, "note"),
        };
        *number += 1;
        self.denied += usize::from(deny.denies(severity));
        self.findings.push(FindingRow { severity: name, ..row });
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let errors = count(self.errors, "error", "errors");
        let warnings = count(self.warnings, "warning", "warnings");
        let notes = count(self.notes, "note", "notes");
        write!(out, "{}: {errors}, {warnings}, {notes}", plain(&self.file))?;
        if let Some(takes) = &self.takes {
            write!(out, ", {} of takes", count(takes.len(), "defect", "defects"))?;
        }
        writeln!(out)?;
        if let Some(meters) = self.meters_per_unit.filter(|meters| *meters != 1.0) {
            writeln!(out, "  motion is measured with 1 unit = {meters} m")?;
        }
        for FindingRow { severity, rule, file, place, text } in &self.findings {
            let file = file.as_ref().map(|file| format!("{}:", plain(file))).unwrap_or_default();
            let place = if place.is_empty() { String::new() } else { format!("{file}{}: ", plain(place)) };
            writeln!(out, "  {severity}: {place}{} ({rule})", plain(text))?;
        }
        self.takes.iter().flatten().try_for_each(|defect| defect.write(out))
    }
}
