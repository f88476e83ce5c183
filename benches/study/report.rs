//! The tables of `README.md` and its charts, all made from the files of raw data and from nothing else.

use crate::amount;
use crate::chart;
use crate::design;
use crate::figures::{CHARTS, Chart, FILES, Kind, Source, TABLES};
use crate::record::{self, Row};
use crate::summary::{Summary, summarise};
use crate::table;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What went wrong, in words.
pub type Failed = Box<dyn std::error::Error>;

/// What stands where nothing has been measured.
const NOTHING: &str = "*No full run has been kept yet.*";

/// The raw data of the last full runs.
#[derive(Default)]
pub struct Data(BTreeMap<&'static str, Vec<Row>>);

impl Data {
    /// Reads those files in `results` that are there.
    ///
    /// # Errors
    /// When one cannot be read or understood.
    pub fn read(results: &Path) -> Result<Self, Failed> {
        let mut data = Self::default();
        for file in FILES {
            let path = results.join(file).with_extension("csv");
            if path.exists() {
                let rows = record::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
                data.0.insert(file, rows);
            }
        }
        Ok(data)
    }

    /// The rows of `source`; `None` when its file is not there.
    ///
    /// # Errors
    /// When the file is there and has none: then the list of figures is wrong.
    fn rows(&self, name: &str, source: &Source) -> Result<Option<Vec<Row>>, Failed> {
        let Some(rows) = self.0.get(source.file) else { return Ok(None) };
        let wanted = |row: &&Row| source.cases.iter().any(|case| row.case.starts_with(case));
        let rows: Vec<Row> = rows.iter().filter(wanted).cloned().collect();
        if rows.is_empty() {
            return Err(format!("{name}: {}.csv has nothing of {:?}", source.file, source.cases).into());
        }
        Ok(Some(rows))
    }
}

/// Every file that is made from the data, by its path in the folder of the study: `README.md`, given as it is now;
/// the charts; and the tables of everything.
///
/// # Errors
/// When a table or chart has no data, or the README does not show it or shows one that does not exist.
pub fn render(data: &Data, readme: &str) -> Result<Vec<(PathBuf, String)>, Failed> {
    let mut blocks: BTreeMap<String, String> = BTreeMap::new();
    let mut files = Vec::new();
    for one in TABLES {
        let text = match data.rows(one.name, &one.source)? {
            None => NOTHING.to_owned(),
            Some(rows) => {
                let shown = summarise(&rows);
                let lacks = |(metric, _): &&table::Column| !shown.iter().any(|one| one.metric == *metric);
                if let Some((metric, _)) = one.columns.iter().find(lacks) {
                    return Err(format!("table {}: nothing was measured as {metric}", one.name).into());
                }
                format!("{}\n{}", table::wide(&shown, one.columns), from(&one.source, &shown))
            }
        };
        blocks.insert(format!("table: {}", one.name), text);
    }
    blocks.insert("table: design-cost".into(), design_cost());
    blocks.insert("table: design-mistakes".into(), design_mistakes());
    for one in CHARTS {
        let text = match data.rows(one.name, &one.source)? {
            None => NOTHING.to_owned(),
            Some(rows) => {
                let path = format!("results/{}.svg", one.name);
                files.push((path.clone().into(), draw(one, &rows)?));
                format!("![{}]({path})\n\n{}", one.title, from(&one.source, &summarise(&rows)))
            }
        };
        blocks.insert(format!("chart: {}", one.name), text);
    }
    for (file, rows) in &data.0 {
        let text = format!(
            "# Everything in {file}.csv\n\nWhat the page before shows a part of. `others`: cores that other programs kept \
             busy, at worst.\n\n{}",
            table::long(&summarise(rows))
        );
        files.push((format!("results/{file}.md").into(), text));
    }
    files.push(("README.md".into(), fill(readme, &blocks)?));
    Ok(files)
}

/// Makes everything of the files of raw data in `results` and writes it into `folder`; says what changed.
///
/// # Errors
/// As above, and when something cannot be read or written.
pub fn update(results: &Path, folder: &Path) -> Result<Vec<PathBuf>, Failed> {
    let data = Data::read(results)?;
    let readme = fs::read_to_string(self::folder().join("README.md"))?;
    let mut changed = Vec::new();
    for (path, text) in render(&data, &readme)? {
        let path = folder.join(path);
        if fs::read_to_string(&path).ok().as_deref() != Some(&text) {
            fs::create_dir_all(path.parent().unwrap_or(folder))?;
            fs::write(&path, text)?;
            changed.push(path);
        }
    }
    Ok(changed)
}

/// Would `rows`, as the raw data of `file`, give everything that is to be shown of it?
///
/// # Errors
/// What is missing: so a case that has another name now is found in a test, and not after an hour of measuring.
pub fn is_complete(file: &'static str, rows: &[Row]) -> Result<(), Failed> {
    let readme = fs::read_to_string(folder().join("README.md"))?;
    render(&Data([(file, rows.to_vec())].into()), &readme).map(|_| ())
}

/// The folder of the study: where `README.md` and `results` are.
pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Where the numbers come from.
fn from(source: &Source, shown: &[Summary]) -> String {
    let fewest = shown.iter().map(|one| one.repeats).min().unwrap_or(0);
    let most = shown.iter().map(|one| one.repeats).max().unwrap_or(0);
    let repeats = if fewest == most { format!("{most}") } else { format!("{fewest} to {most}") };
    let others = shown.iter().map(|one| one.others).fold(0.0, f64::max);
    let file = source.file;
    format!(
        "<sub>Raw data: [{file}.csv](results/{file}.csv), `{}`; repeats: {repeats}; load by others: at most {} cores.</sub>\n",
        source.cases.join("`, `"),
        amount::digits(others),
    )
}

fn draw(chart: &Chart, rows: &[Row]) -> Result<String, Failed> {
    let all = summarise(rows);
    let cases = table::distinct(all.iter().map(|one| one.case.as_str()));
    let has = |metric: &str| all.iter().any(|one| one.metric.starts_with(metric));
    let metric = match &chart.kind {
        Kind::Rows(columns, _) => columns.iter().map(|column| column.0).find(|metric| !has(metric)),
        Kind::Curves(metric, _) | Kind::Ratios(metric, _) => (!has(metric)).then_some(*metric),
    };
    if let Some(metric) = metric {
        return Err(format!("chart {}: nothing was measured as {metric}", chart.name).into());
    }
    Ok(match &chart.kind {
        Kind::Rows(columns, scale) => chart::rows(chart.title, &all, columns, *scale),
        Kind::Ratios(metric, ours) => chart::ratios(chart.title, rows, metric, ours),
        Kind::Curves(metric, who) => {
            let unknown = who.iter().find(|who| !all.iter().any(|one| one.variant == **who));
            if cases.len() != 1 || unknown.is_some() {
                return Err(format!("chart {}: of {cases:?}, where is {unknown:?}?", chart.name).into());
            }
            chart::curves(chart.title, &all, metric, who)
        }
    })
}

/// Puts each block between its marker and the next `<!-- end -->`.
fn fill(readme: &str, blocks: &BTreeMap<String, String>) -> Result<String, Failed> {
    let mut filled = String::new();
    let mut unused: Vec<&String> = blocks.keys().collect();
    let mut inside = None;
    for line in readme.lines() {
        let comment = line.trim().strip_prefix("<!-- ").and_then(|rest| rest.strip_suffix(" -->"));
        match (comment, inside) {
            (Some("end"), Some(_)) => inside = None,
            (Some("end"), None) => return Err("README.md: an `end` of nothing".into()),
            (Some(name), None) if name.starts_with("table: ") || name.starts_with("chart: ") => {
                let Some(block) = blocks.get(name) else {
                    return Err(format!("README.md: there is no {name}").into());
                };
                let place = unused.iter().position(|unused| *unused == name);
                unused.remove(place.ok_or_else(|| format!("README.md: {name} is there twice"))?);
                inside = Some(name);
                filled += &format!("{line}\n\n{}\n\n<!-- end -->\n", block.trim_end());
                continue;
            }
            (Some(name), Some(_)) => {
                return Err(format!("README.md: {name} before the `end` of another").into());
            }
            (_, Some(_)) => continue,
            _ => {
                filled += line;
                filled.push('\n');
            }
        }
    }
    if let Some(name) = inside {
        return Err(format!("README.md: {name} has no `end`").into());
    }
    if !unused.is_empty() {
        return Err(format!("README.md: these are not shown: {unused:?}").into());
    }
    Ok(filled)
}

fn design_cost() -> String {
    let costs = design::costs();
    let mut text = String::from(
        "| | editor before, lines | feature: lines | types and variants | functions | places touched | files |\n|---|---|---|---|---|---|---|\n",
    );
    let rows = [
        ("the property itself and its drawing (same for all)", &costs.same, true),
        ("one short lock", &costs.locks, true),
        ("messages, edits as closures", &costs.closures, false),
        ("messages, edits as values, sent at the call", &costs.raw, false),
        ("messages, edits as values, typed handles", &costs.messages, true),
        ("– of these, the edits as values", &costs.edits, false),
    ];
    for (name, cost, whole) in rows {
        let base = if whole { cost.base.to_string() } else { "–".into() };
        let lines = cost.added + cost.changed;
        let (types, functions, places, files) = (cost.types, cost.functions, cost.places.len(), cost.files);
        text += &format!("| {name} | {base} | {lines} | {types} | {functions} | {places} | {files} |\n");
    }
    text
}

fn design_mistakes() -> String {
    let mut text = String::from("| | does not compile | compiles, and goes wrong |\n|---|---|---|\n");
    for (way, refused, compiling) in design::mistakes() {
        let list = |all: Vec<String>| {
            let items: String = all.iter().map(|one| format!("<li>{one}</li>")).collect();
            format!("{}:<ul>{items}</ul>", all.len())
        };
        let lower = |text: &str| text[..1].to_lowercase() + &text[1..];
        let refused = list(refused.into_iter().map(lower).collect());
        text += &format!("| {way} | {refused} | {} |\n", list(compiling));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks() -> BTreeMap<String, String> {
        [("table: a".to_owned(), "| new |\n".to_owned()), ("chart: b".to_owned(), "![b](b.svg)".to_owned())]
            .into()
    }

    #[test]
    fn what_is_between_the_markers_is_made_anew_and_nothing_else() {
        let readme = "# One\n\n<!-- table: a -->\nold\n<!-- end -->\ntext\n<!-- a comment -->\n<!-- chart: b -->\n<!-- end -->\n";
        let expected = "# One\n\n<!-- table: a -->\n\n| new |\n\n<!-- end -->\ntext\n<!-- a comment -->\n\
            <!-- chart: b -->\n\n![b](b.svg)\n\n<!-- end -->\n";
        let filled = fill(readme, &blocks()).unwrap();
        assert_eq!(filled, expected);
        assert_eq!(fill(&filled, &blocks()).unwrap(), expected);
    }

    #[test]
    fn a_marker_that_is_wrong_or_missing_is_reported() {
        let both = "<!-- table: a -->\n<!-- end -->\n<!-- chart: b -->\n<!-- end -->\n";
        assert!(fill(both, &blocks()).is_ok());
        for wrong in [
            "<!-- table: a -->\n<!-- end -->\n".to_owned(),
            both.replace("table: a", "table: other"),
            both.to_owned() + both,
            both.replacen("<!-- end -->\n", "", 1),
            both.trim_end().trim_end_matches("<!-- end -->").to_owned(),
            both.to_owned() + "<!-- end -->\n",
        ] {
            assert!(fill(&wrong, &blocks()).is_err(), "{wrong}");
        }
    }
}
