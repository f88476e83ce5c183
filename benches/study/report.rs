//! Makes the tables of `README.md` and its charts from the files of raw data alone.

use crate::amount;
use crate::chart;
use crate::design;
use crate::figures::{CHARTS, ChartKind, ChartSpec, DataSource, FILES, TABLES, TableSpec};
use crate::goal::{self, Spread};
use crate::record::{self, DataRow};
use crate::summary::{Summary, summarize};
use crate::table;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// An error with its message.
pub type ReportError = Box<dyn std::error::Error>;

/// Text in place of a table or chart without data.
const NOTHING: &str = "*There are no results of a full run yet.*";

/// The raw data of the last full runs.
#[derive(Default)]
pub struct Data(BTreeMap<&'static str, Vec<DataRow>>);

impl Data {
    /// Reads the existing files in `results`.
    ///
    /// # Errors
    /// When a file cannot be read or parsed.
    pub fn read(results: &Path) -> Result<Self, ReportError> {
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

    /// Returns the rows of `source`; `None` when its file does not exist.
    ///
    /// # Errors
    /// When the file contains none of these cases, because then the list of figures is wrong.
    fn rows(&self, name: &str, source: &DataSource) -> Result<Option<Vec<DataRow>>, ReportError> {
        let Some(rows) = self.0.get(source.file) else { return Ok(None) };
        let matches = |case: &str, wanted: &str| match wanted.trim_start_matches('?').strip_suffix('*') {
            Some(begin) => case.starts_with(begin),
            None => case == wanted.trim_start_matches('?'),
        };
        let wanted = |row: &&DataRow| source.cases.iter().any(|wanted| matches(&row.case, wanted));
        let rows: Vec<DataRow> = rows.iter().filter(wanted).cloned().collect();
        if rows.is_empty() {
            if source.cases.iter().all(|case| case.starts_with('?')) {
                return Ok(None);
            }
            return Err(format!("{name}: {}.csv contains none of {:?}", source.file, source.cases).into());
        }
        Ok(Some(rows))
    }
}

/// Returns every file that is made from the data, with its path in the folder of the study: the page, whose current text
/// is `readme`; the charts; and the complete tables.
///
/// # Errors
/// When a table or chart has no data, or when the page lacks it or contains an unknown one.
pub fn render(data: &Data, readme: &str) -> Result<Vec<(PathBuf, String)>, ReportError> {
    let mut blocks: BTreeMap<String, String> = BTreeMap::new();
    let mut files = Vec::new();
    for one in TABLES {
        blocks.insert(format!("table: {}", one.name), table_block(data, one)?);
    }
    blocks.insert("table: goals".into(), goals_block(data));
    blocks.insert("table: design-cost".into(), design::tables::cost());
    blocks.insert("table: design-mistakes".into(), design::tables::mistakes());
    for one in CHARTS {
        let (block, chart) = chart_block(data, one)?;
        blocks.insert(format!("chart: {}", one.name), block);
        files.extend(chart);
    }
    for (file, rows) in &data.0 {
        let text = format!(
            "# All data of {file}.csv\n\nThe page of the study shows a part of it. Background load: the largest number of cores \
             that other programs used during a repeat.\n\n{}",
            table::long(&summarize(rows))
        );
        files.push((format!("results/{file}.md").into(), text));
    }
    files.push(("README.md".into(), fill(readme, &blocks)?));
    Ok(files)
}

/// Returns the text between the markers of a table.
fn table_block(data: &Data, one: &TableSpec) -> Result<String, ReportError> {
    let Some(rows) = data.rows(one.name, &one.source)? else { return Ok(NOTHING.to_owned()) };
    let shown = summarize(&rows);
    let lacks = |(metric, _): &&table::TableColumn| !shown.iter().any(|one| one.metric == *metric);
    if let Some((metric, _)) = one.columns.iter().find(lacks) {
        return Err(format!("table {}: there is no metric {metric}", one.name).into());
    }
    let mut text = table::wide(&shown, one.columns);
    let lines = text.lines().count() - 2;
    // A long table is folded.
    if lines > 12 {
        text = format!("<details><summary>The numbers: {lines} rows</summary>\n\n{text}\n</details>\n");
    }
    Ok(format!("{text}\n{}", source_line(&one.source, &shown)))
}

/// Returns the table of the goals with their results.
fn goals_block(data: &Data) -> String {
    let Some(rows) = data.0.get("runtime") else { return NOTHING.to_owned() };
    let mut text =
        String::from("| goal | ours | rival | theirs | ratio | limit | |\n|---|--:|---|--:|--:|--:|---|\n");
    for goal in goal::goals(rows) {
        let shown = |of: &Spread| amount::spread(of.median(), of.low(), of.high(), &goal.unit);
        text += &format!(
            "| {} | {} | {} | {} | {:.2} | {:.2} | {} |\n",
            goal.name.trim(),
            shown(&goal.ours),
            goal.rival,
            shown(&goal.theirs),
            goal.ratio(),
            goal.demanded,
            goal.verdict().as_str(),
        );
    }
    text + "\n*From [runtime.csv](results/runtime.csv); ratios of medians.*"
}

/// Returns the text between the markers of a chart, and the file of the chart.
fn chart_block(data: &Data, one: &ChartSpec) -> Result<(String, Option<(PathBuf, String)>), ReportError> {
    let Some(rows) = data.rows(one.name, &one.source)? else { return Ok((NOTHING.to_owned(), None)) };
    let path = format!("results/{}.svg", one.name);
    let block = format!("![{}]({path})\n\n{}", one.title, source_line(&one.source, &summarize(&rows)));
    Ok((block, Some((path.into(), draw(one, &rows)?))))
}

/// Makes all files from the raw data in `results` and writes them into `folder`. Returns the paths of those that changed.
///
/// # Errors
/// As for [`render`], and when a file cannot be read or written.
pub fn update(results: &Path, folder: &Path) -> Result<Vec<PathBuf>, ReportError> {
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

/// Returns the errors of the tables and charts if `rows` were the raw data of `file`. So a renamed case is found in a short
/// run, and not after an hour of measuring.
pub fn missing(file: &'static str, rows: &[DataRow]) -> Vec<String> {
    let data = Data([(file, rows.to_vec())].into());
    let tables = TABLES.iter().map(|one| table_block(&data, one).err());
    let charts = CHARTS.iter().map(|one| chart_block(&data, one).err());
    tables.chain(charts).flatten().map(|error| error.to_string()).collect()
}

/// Returns the folder of the study, which contains `README.md` and `results`.
pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the line with the source of the numbers.
fn source_line(source: &DataSource, shown: &[Summary]) -> String {
    let fewest = shown.iter().map(|one| one.repeats).min().unwrap_or(0);
    let most = shown.iter().map(|one| one.repeats).max().unwrap_or(0);
    let repeats = if fewest == most { format!("{most}") } else { format!("{fewest} to {most}") };
    let background = shown.iter().map(|one| one.background).fold(0.0, f64::max);
    let file = source.file;
    format!(
        "<sub>Raw data: [{file}.csv](results/{file}.csv), `{}`; repeats: {repeats}; background load: at most {} cores.</sub>\n",
        source.cases.join("`, `").replace('?', ""),
        amount::digits(background),
    )
}

fn draw(chart: &ChartSpec, rows: &[DataRow]) -> Result<String, ReportError> {
    let all = summarize(rows);
    let cases = table::distinct(all.iter().map(|one| one.case.as_str()));
    let has = |metric: &str| all.iter().any(|one| one.metric.starts_with(metric));
    let metric = match &chart.kind {
        ChartKind::Rows(columns, _) => columns.iter().map(|column| column.0).find(|metric| !has(metric)),
        ChartKind::Curves(metric, _) | ChartKind::Ratios(metric, ..) => (!has(metric)).then_some(*metric),
    };
    if let Some(metric) = metric {
        return Err(format!("chart {}: there is no metric {metric}", chart.name).into());
    }
    let named: Vec<&str> = match &chart.kind {
        ChartKind::Rows(..) => Vec::new(),
        ChartKind::Curves(_, who) => who.to_vec(),
        ChartKind::Ratios(_, ours, peers) => peers.iter().chain([ours]).copied().collect(),
    };
    if let Some(who) = named.iter().find(|who| !all.iter().any(|one| one.variant == **who)) {
        return Err(format!("chart {}: there is no variant {who}", chart.name).into());
    }
    Ok(match &chart.kind {
        ChartKind::Rows(columns, scale) => chart::rows(chart.title, &all, columns, *scale),
        ChartKind::Ratios(metric, ours, peers) => chart::ratios(chart.title, rows, metric, ours, peers),
        ChartKind::Curves(metric, who) => {
            if cases.len() != 1 {
                return Err(format!("chart {}: needs one case, there are {cases:?}", chart.name).into());
            }
            chart::curves(chart.title, &all, metric, who)
        }
    })
}

/// Inserts each block between its marker and the next `<!-- end -->`.
fn fill(readme: &str, blocks: &BTreeMap<String, String>) -> Result<String, ReportError> {
    let mut filled = String::new();
    let mut unused: Vec<&String> = blocks.keys().collect();
    let mut inside = None;
    for line in readme.lines() {
        let comment = line.trim().strip_prefix("<!-- ").and_then(|rest| rest.strip_suffix(" -->"));
        match (comment, inside) {
            (Some("end"), Some(_)) => inside = None,
            (Some("end"), None) => return Err("README.md: an `end` without a start".into()),
            (Some(name), None) if name.starts_with("table: ") || name.starts_with("chart: ") => {
                let Some(block) = blocks.get(name) else {
                    return Err(format!("README.md: unknown {name}").into());
                };
                let place = unused.iter().position(|unused| *unused == name);
                unused.remove(place.ok_or_else(|| format!("README.md: {name} occurs twice"))?);
                inside = Some(name);
                filled += &format!("{line}\n\n{}\n\n<!-- end -->\n", block.trim_end());
                continue;
            }
            (Some(name), Some(_)) => {
                return Err(format!("README.md: {name} starts before the `end` of another").into());
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
        return Err(format!("README.md: missing: {unused:?}").into());
    }
    Ok(filled)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::tests::row;

    fn blocks() -> BTreeMap<String, String> {
        [("table: a".to_owned(), "| new |\n".to_owned()), ("chart: b".to_owned(), "![b](b.svg)".to_owned())]
            .into()
    }

    #[test]
    fn only_the_text_between_the_markers_is_replaced() {
        let readme = "# One\n\n<!-- table: a -->\nold\n<!-- end -->\ntext\n<!-- a comment -->\n<!-- chart: b -->\n<!-- end -->\n";
        let expected = "# One\n\n<!-- table: a -->\n\n| new |\n\n<!-- end -->\ntext\n<!-- a comment -->\n\
            <!-- chart: b -->\n\n![b](b.svg)\n\n<!-- end -->\n";
        let filled = fill(readme, &blocks()).unwrap();
        assert_eq!(filled, expected);
        assert_eq!(fill(&filled, &blocks()).unwrap(), expected);
    }

    #[test]
    fn a_wrong_or_missing_marker_is_an_error() {
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

    /// Returns invented rows for all tables and charts: two repeats of each metric, for all named variants and one other.
    fn invented() -> Data {
        let mut data = Data::default();
        let mut add = |source: &DataSource, who: &[&str], metrics: &[String]| {
            let rows = data.0.entry(source.file).or_default();
            for case in source.cases {
                for (place, who) in who.iter().chain(&["another"]).enumerate() {
                    for metric in metrics {
                        for repeat in 0..2 {
                            let value = 1e4 * (place + 1) as f64 + f64::from(repeat);
                            rows.push(row(
                                &case.replace('?', "").replace('*', "some"),
                                who,
                                repeat,
                                metric,
                                "ns",
                                value,
                            ));
                        }
                    }
                }
            }
        };
        let names = |columns: &[table::TableColumn]| {
            columns.iter().map(|column| column.0.to_owned()).collect::<Vec<_>>()
        };
        for one in TABLES {
            add(&one.source, &[], &names(one.columns));
        }
        for one in CHARTS {
            match &one.kind {
                ChartKind::Rows(columns, _) => add(&one.source, &[], &names(columns)),
                ChartKind::Ratios(metric, ours, peers) => {
                    add(&one.source, &[&[*ours], *peers].concat(), &[(*metric).to_owned()]);
                }
                ChartKind::Curves(metric, who) => {
                    let points = ["p50", "p90", "p99", "p99.9", "max"];
                    add(&one.source, who, &points.map(|point| format!("{metric}.{point}")));
                }
            }
        }
        data
    }

    #[test]
    fn a_page_is_made_from_raw_data_and_does_not_change_when_made_again() {
        let readme = fs::read_to_string(folder().join("README.md")).unwrap();
        let data = invented();
        let files = render(&data, &readme).unwrap();
        let page = &files.iter().find(|(path, _)| path.ends_with("README.md")).unwrap().1;
        assert!(!page.contains(NOTHING), "a table or chart has no data");
        assert_eq!(&render(&data, page).unwrap().last().unwrap().1, page);
        for chart in CHARTS {
            assert!(
                files.iter().any(|(path, _)| path.ends_with(format!("{}.svg", chart.name))),
                "{}",
                chart.name
            );
        }
        // The complete tables contain all rows.
        for (file, rows) in &data.0 {
            let all = &files.iter().find(|(path, _)| path.ends_with(format!("{file}.md"))).unwrap().1;
            for row in rows {
                assert!(
                    all.contains(&format!("| {} | {} | {} |", row.case, row.variant, row.metric)),
                    "{row:?}"
                );
            }
        }
    }

    #[test]
    fn a_renamed_case_or_metric_is_reported_as_missing() {
        let all = invented();
        for (file, rows) in &all.0 {
            assert_eq!(missing(file, rows), [""; 0]);
            assert_ne!(missing(file, &rows[..rows.len() / 2]), [""; 0]);
            let mut renamed = rows.clone();
            renamed.iter_mut().for_each(|row| row.metric.insert(0, 'x'));
            assert_ne!(missing(file, &renamed), [""; 0]);
        }
    }

    #[test]
    fn a_case_matches_by_its_whole_name_unless_it_ends_in_a_star() {
        let rows = ["drag", "drag/60 Hz"].map(|case| row(case, "who", 0, "m", "ns", 1.0)).to_vec();
        let data = Data([("graphical", rows)].into());
        let count = |cases| data.rows("x", &DataSource { file: "graphical", cases }).unwrap().unwrap().len();
        assert_eq!((count(&["drag"]), count(&["drag*"]), count(&["drag/*"])), (1, 2, 1));
        assert!(data.rows("x", &DataSource { file: "graphical", cases: &["dra"] }).is_err());
        assert!(data.rows("x", &DataSource { file: "graphical", cases: &["?dra"] }).unwrap().is_none());
        assert!(data.rows("x", &DataSource { file: "runtime", cases: &["drag"] }).unwrap().is_none());
    }
}
