//! The report of a conversion, as text or as JSON.

use super::super::choice::plain;
use super::super::output::{print, print_json};
use super::super::{Failure, tell};
use super::plan::PlannedFile;
use dragonfly_document::ConvertedFile;
use serde::Serialize;

/// The result of a file: converted, or skipped because its output was there.
pub(super) type FileResult = Result<Option<ConvertedFile>, String>;

/// The result of one file.
pub(super) struct FileOutcome {
    pub(super) file: PlannedFile,
    pub(super) result: FileResult,
}

/// The results of all files.
#[derive(Serialize)]
pub(super) struct ConvertReport {
    converted: usize,
    skipped: usize,
    failed: usize,
    files: Vec<ReportedFile>,
}

#[derive(Serialize)]
struct ReportedFile {
    input: String,
    output: String,
    /// `converted`, `skipped` or `failed`.
    outcome: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bytes: Option<usize>,
    /// Names of the files that are written next to the output.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    beside: Vec<BesideFile>,
    #[serde(skip_serializing_if = "Option::is_none")]
    takes: Option<usize>,
    /// Units, axes and frame rate of the input, and where they are known from.
    #[serde(skip_serializing_if = "Option::is_none")]
    conventions: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    warnings: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    lost: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

/// A file that the output refers to.
#[derive(Serialize)]
struct BesideFile {
    name: String,
    bytes: usize,
}

impl ReportedFile {
    fn of(outcome: FileOutcome) -> Self {
        let mut file = Self {
            input: outcome.file.input.display().to_string(),
            output: outcome.file.output.display().to_string(),
            outcome: "skipped",
            from: None,
            bytes: None,
            beside: Vec::new(),
            takes: None,
            conventions: None,
            warnings: Vec::new(),
            lost: Vec::new(),
            error: None,
        };
        match outcome.result {
            Ok(None) => {}
            Ok(Some(converted)) => {
                file.outcome = "converted";
                file.from = Some(converted.from);
                file.bytes = Some(converted.bytes);
                file.beside =
                    converted.beside.into_iter().map(|(name, bytes)| BesideFile { name, bytes }).collect();
                file.takes = Some(converted.takes);
                file.conventions = Some(converted.conversion.to_string());
                file.warnings = converted.warnings;
                file.lost = converted.lost;
            }
            Err(reason) => {
                file.outcome = "failed";
                file.error = Some(reason);
            }
        }
        file
    }
}

impl ConvertReport {
    pub(super) fn of(outcomes: Vec<FileOutcome>) -> Self {
        let files: Vec<ReportedFile> = outcomes.into_iter().map(ReportedFile::of).collect();
        let count = |outcome| files.iter().filter(|file| file.outcome == outcome).count();
        Self { converted: count("converted"), skipped: count("skipped"), failed: count("failed"), files }
    }

    /// Prints the report. Failures were printed when they happened.
    ///
    /// # Errors
    ///
    /// Exit code 2 where a file failed.
    pub(super) fn print(&self, json: bool) -> Result<(), Failure> {
        if json {
            print_json(self)?;
        } else {
            print(|out| {
                for file in self.files.iter().filter(|file| file.outcome == "converted") {
                    let (from, bytes) = (file.from.unwrap_or_default(), file.bytes.unwrap_or_default());
                    writeln!(out, "{} → {} ({bytes} bytes)", plain(&file.input), plain(&file.output))?;
                    for BesideFile { name, bytes } in &file.beside {
                        writeln!(out, "  beside it: {} ({bytes} bytes)", plain(name))?;
                    }
                    writeln!(out, "  {from}: {}", file.conventions.as_deref().unwrap_or_default())?;
                    for warning in &file.warnings {
                        writeln!(out, "  warning: {warning}")?;
                    }
                    for lost in &file.lost {
                        writeln!(out, "  not converted: {lost}")?;
                    }
                }
                Ok(())
            })?;
        }
        let Self { converted, skipped, failed, .. } = self;
        let summary = format!("{converted} converted, {skipped} skipped, {failed} failed");
        if *failed > 0 {
            return Err(Failure::Input(summary));
        }
        if self.files.len() != 1 {
            tell(summary);
        }
        Ok(())
    }
}
