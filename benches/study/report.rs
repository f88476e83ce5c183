//! The tables of `README.md` and its charts, all made from the files of raw data and from nothing else.

use crate::amount;
use crate::chart;
use crate::design;
use crate::figures::{CHARTS, Chart, FILES, Kind, Source, TABLES, Table};
use crate::goal::{self, Spread};
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
        let matches = |case: &str, wanted: &str| match wanted.trim_start_matches('?').strip_suffix('*') {
            Some(begin) => case.starts_with(begin),
            None => case == wanted.trim_start_matches('?'),
        };
        let wanted = |row: &&Row| source.cases.iter().any(|wanted| matches(&row.case, wanted));
        let rows: Vec<Row> = rows.iter().filter(wanted).cloned().collect();
        if rows.is_empty() {
            if source.cases.iter().all(|case| case.starts_with('?')) {
                return Ok(None);
            }
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
            "# Everything in {file}.csv\n\nWhat the page before shows a part of. `others`: cores that other programs kept \
             busy, at worst.\n\n{}",
            table::long(&summarise(rows))
        );
        files.push((format!("results/{file}.md").into(), text));
    }
    files.push(("README.md".into(), fill(readme, &blocks)?));
    Ok(files)
}

/// What stands between the markers of a table.
fn table_block(data: &Data, one: &Table) -> Result<String, Failed> {
    let Some(rows) = data.rows(one.name, &one.source)? else { return Ok(NOTHING.to_owned()) };
    let shown = summarise(&rows);
    let lacks = |(metric, _): &&table::Column| !shown.iter().any(|one| one.metric == *metric);
    if let Some((metric, _)) = one.columns.iter().find(lacks) {
        return Err(format!("table {}: nothing was measured as {metric}", one.name).into());
    }
    let mut text = table::wide(&shown, one.columns);
    let lines = text.lines().count() - 2;
    // What would fill the window is folded.
    if lines > 12 {
        text = format!("<details><summary>The numbers: {lines} rows</summary>\n\n{text}\n</details>\n");
    }
    Ok(format!("{text}\n{}", from(&one.source, &shown)))
}

/// What our runtime was to reach beside its peers, and whether it did.
fn goals_block(data: &Data) -> String {
    let Some(rows) = data.0.get("runtime") else { return NOTHING.to_owned() };
    let mut text = String::from(
        "| goal | ours | beside | theirs | ratio | at most | |\n|---|--:|---|--:|--:|--:|---|\n",
    );
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
    text + "\n*From [runtime.csv](results/runtime.csv); a ratio of medians.*"
}

/// What stands between the markers of a chart, and the chart's file.
fn chart_block(data: &Data, one: &Chart) -> Result<(String, Option<(PathBuf, String)>), Failed> {
    let Some(rows) = data.rows(one.name, &one.source)? else { return Ok((NOTHING.to_owned(), None)) };
    let path = format!("results/{}.svg", one.name);
    let block = format!("![{}]({path})\n\n{}", one.title, from(&one.source, &summarise(&rows)));
    Ok((block, Some((path.into(), draw(one, &rows)?))))
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

/// What could not be shown if `rows` were the raw data of `file`; so a case that has another name now is found in a short
/// run, and not after an hour of measuring.
pub fn missing(file: &'static str, rows: &[Row]) -> Vec<String> {
    let data = Data([(file, rows.to_vec())].into());
    let tables = TABLES.iter().map(|one| table_block(&data, one).err());
    let charts = CHARTS.iter().map(|one| chart_block(&data, one).err());
    tables.chain(charts).flatten().map(|error| error.to_string()).collect()
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
        source.cases.join("`, `").replace('?', ""),
        amount::digits(others),
    )
}

fn draw(chart: &Chart, rows: &[Row]) -> Result<String, Failed> {
    let all = summarise(rows);
    let cases = table::distinct(all.iter().map(|one| one.case.as_str()));
    let has = |metric: &str| all.iter().any(|one| one.metric.starts_with(metric));
    let metric = match &chart.kind {
        Kind::Rows(columns, _) => columns.iter().map(|column| column.0).find(|metric| !has(metric)),
        Kind::Curves(metric, _) | Kind::Ratios(metric, ..) => (!has(metric)).then_some(*metric),
    };
    if let Some(metric) = metric {
        return Err(format!("chart {}: nothing was measured as {metric}", chart.name).into());
    }
    let named: Vec<&str> = match &chart.kind {
        Kind::Rows(..) => Vec::new(),
        Kind::Curves(_, who) => who.to_vec(),
        Kind::Ratios(_, ours, peers) => peers.iter().chain([ours]).copied().collect(),
    };
    if let Some(who) = named.iter().find(|who| !all.iter().any(|one| one.variant == **who)) {
        return Err(format!("chart {}: there is no {who}", chart.name).into());
    }
    Ok(match &chart.kind {
        Kind::Rows(columns, scale) => chart::rows(chart.title, &all, columns, *scale),
        Kind::Ratios(metric, ours, peers) => chart::ratios(chart.title, rows, metric, ours, peers),
        Kind::Curves(metric, who) => {
            if cases.len() != 1 {
                return Err(format!("chart {}: one case is wanted, there are {cases:?}", chart.name).into());
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::tests::row;

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

    /// Invented rows for everything that is shown: two repeats of each metric, by all who are named and one who is not.
    fn invented() -> Data {
        let mut data = Data::default();
        let mut add = |source: &Source, who: &[&str], metrics: &[String]| {
            let rows = data.0.entry(source.file).or_default();
            for case in source.cases {
                for (place, who) in who.iter().chain(&["somebody"]).enumerate() {
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
        let names =
            |columns: &[table::Column]| columns.iter().map(|column| column.0.to_owned()).collect::<Vec<_>>();
        for one in TABLES {
            add(&one.source, &[], &names(one.columns));
        }
        for one in CHARTS {
            match &one.kind {
                Kind::Rows(columns, _) => add(&one.source, &[], &names(columns)),
                Kind::Ratios(metric, ours, peers) => {
                    add(&one.source, &[&[*ours], *peers].concat(), &[(*metric).to_owned()]);
                }
                Kind::Curves(metric, who) => {
                    let points = ["p50", "p90", "p99", "p99.9", "max"];
                    add(&one.source, who, &points.map(|point| format!("{metric}.{point}")));
                }
            }
        }
        data
    }

    #[test]
    fn a_whole_page_is_made_from_raw_data_and_made_anew_it_stays() {
        let readme = fs::read_to_string(folder().join("README.md")).unwrap();
        let data = invented();
        let files = render(&data, &readme).unwrap();
        let page = &files.iter().find(|(path, _)| path.ends_with("README.md")).unwrap().1;
        assert!(!page.contains(NOTHING), "something was not measured");
        assert_eq!(&render(&data, page).unwrap().last().unwrap().1, page);
        for chart in CHARTS {
            assert!(
                files.iter().any(|(path, _)| path.ends_with(format!("{}.svg", chart.name))),
                "{}",
                chart.name
            );
        }
        // Everything that was measured is in the tables of everything.
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
    fn a_case_or_metric_that_has_another_name_is_missed() {
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
    fn a_case_is_named_whole_unless_it_ends_in_a_star() {
        let rows = ["drag", "drag/60 Hz"].map(|case| row(case, "who", 0, "m", "ns", 1.0)).to_vec();
        let data = Data([("graphical", rows)].into());
        let count = |cases| data.rows("x", &Source { file: "graphical", cases }).unwrap().unwrap().len();
        assert_eq!((count(&["drag"]), count(&["drag*"]), count(&["drag/*"])), (1, 2, 1));
        assert!(data.rows("x", &Source { file: "graphical", cases: &["dra"] }).is_err());
        assert!(data.rows("x", &Source { file: "graphical", cases: &["?dra"] }).unwrap().is_none());
        assert!(data.rows("x", &Source { file: "runtime", cases: &["drag"] }).unwrap().is_none());
    }
}
