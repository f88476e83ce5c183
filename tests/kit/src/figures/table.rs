//! Cells and lines of tables in Markdown.

/// Formats a number with three significant digits: `0.08`, `1.33`, `12.9`, `5,532`.
pub fn digits(value: f64) -> String {
    match value.abs() {
        size if size < 9.995 => format!("{value:.2}"),
        size if size < 99.95 => format!("{value:.1}"),
        _ => grouped(value),
    }
}

/// Formats a whole number with commas: `92,773`.
pub fn grouped(value: f64) -> String {
    let whole = format!("{value:.0}");
    let groups: Vec<&str> =
        whole.as_bytes().rchunks(3).rev().map(|group| std::str::from_utf8(group).unwrap_or("")).collect();
    groups.join(",")
}

/// Returns the first two lines of a table: the names of the columns, all but the first aligned to the right.
pub fn header(columns: &[&str]) -> String {
    let lines: Vec<&str> =
        columns.iter().enumerate().map(|(at, _)| if at == 0 { "---" } else { "--:" }).collect();
    format!("| {} |\n|{}|\n", columns.join(" | "), lines.join("|"))
}

/// Returns one line of a table.
pub fn line(cells: &[String]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

/// Returns an error if a table has no row: then its results were not recorded.
pub fn filled(name: &str, table: String) -> Result<String, String> {
    if table.lines().count() > 2 { Ok(table) } else { Err(format!("the table {name} has no rows")) }
}
