//! Chart with a row for each variant of each case, as marks or bars.

use super::axis::{AxisScale, ChartAxis};
use super::canvas::{self, ACCENT, Anchor, GRID, INK, MarkShape, OTHERS, SOFT, WIDTH};
use crate::amount;
use crate::summary::{Summary, is_ours};
use crate::table::{TableColumn, common_folder, distinct};

const LEFT: i32 = 210;
const RIGHT: i32 = WIDTH - 110;
const TOP: i32 = 92;
const ROW: i32 = 24;
const HEAD: i32 = 26;

/// One shape for each metric, the first filled. More shapes could not be distinguished in one row.
const MARKS: [MarkShape; 4] = [MarkShape::Disc, MarkShape::Ring, MarkShape::Triangle, MarkShape::Cross];

/// Draws the metrics of `columns`; bars from zero for one metric on a linear scale, marks otherwise.
pub fn rows(title: &str, all: &[Summary], columns: &[TableColumn], scale: AxisScale) -> String {
    let shown: Vec<&Summary> =
        all.iter().filter(|one| columns.iter().any(|column| column.0 == one.metric)).collect();
    let cases = distinct(shown.iter().map(|one| one.case.as_str()));
    let prefix = common_folder(&cases);
    let unit = shown.first().map_or("", |one| one.unit.as_str());
    let axis = ChartAxis::fit(shown.iter().flat_map(|one| [one.low, one.high]), scale, unit, LEFT, RIGHT);
    let count = |case: &str| {
        distinct(shown.iter().filter(|one| one.case == case).map(|one| one.variant.as_str())).len() as i32
    };
    let heads = if cases.len() > 1 { HEAD * cases.len() as i32 } else { 0 };
    let bottom = TOP + heads + ROW * cases.iter().map(|case| count(case)).sum::<i32>() + 6;
    let bars = scale == AxisScale::Linear && columns.len() == 1;

    canvas::svg(bottom + 34, title, &under(columns, scale), |canvas| {
        legend(canvas, columns, bars);
        for (x, label) in axis.ticks() {
            if !label.is_empty() {
                canvas.line(&[(x, TOP - 8), (x, bottom)], 1, GRID);
            }
            canvas.text(&label, x, bottom + 15, 12.0, SOFT, Anchor::Middle);
        }
        let mut y = TOP;
        for case in &cases {
            if cases.len() > 1 {
                y += HEAD;
                canvas.text(
                    &case[prefix..].replace('_', " "),
                    16,
                    y - HEAD / 2 + 2,
                    12.5,
                    SOFT,
                    Anchor::Start,
                );
                canvas.line(&[(16, y - 3), (WIDTH - 16, y - 3)], 1, GRID);
            }
            let of_case: Vec<&&Summary> = shown.iter().filter(|one| one.case == *case).collect();
            for variant in best_first(&of_case, columns) {
                y += ROW;
                let middle = y - ROW / 2;
                let color = if is_ours(variant) { ACCENT } else { OTHERS };
                let ink = if is_ours(variant) { ACCENT } else { INK };
                canvas.text(variant, LEFT - 12, middle, 13.0, ink, Anchor::End);
                let mut last = None;
                for ((metric, _), shape) in columns.iter().zip(MARKS) {
                    let Some(one) =
                        of_case.iter().find(|one| one.variant == variant && one.metric == *metric)
                    else {
                        continue;
                    };
                    let [low, median, high] = [one.low, one.median, one.high].map(|value| axis.place(value));
                    if bars {
                        canvas.bar((LEFT, middle - 7), (median, middle + 7), color);
                    }
                    let whisker = if bars { INK } else { color };
                    canvas.line(&[(low, middle), (high, middle)], 1, whisker);
                    canvas.line(&[(low, middle - 3), (low, middle + 3)], 1, whisker);
                    canvas.line(&[(high, middle - 3), (high, middle + 3)], 1, whisker);
                    if !bars {
                        canvas.mark((median, middle), shape, color);
                    }
                    last = Some((high.max(median), amount::amount(one.median, &one.unit)));
                }
                if let Some((x, value)) = last {
                    canvas.text(&value, x + 10, middle, 12.0, ink, Anchor::Start);
                }
            }
        }
    })
}

fn under(columns: &[TableColumn], scale: AxisScale) -> String {
    let scale = if scale == AxisScale::Log { "logarithmic scale" } else { "from zero" };
    let number = if columns.len() > 1 { "; the number is the value of the last mark" } else { "" };
    format!("Lower is better. Median of the repeats; thin lines: smallest to largest; {scale}{number}.")
}

fn legend(canvas: &canvas::SvgCanvas<'_>, columns: &[TableColumn], bars: bool) {
    let mut x = LEFT;
    for ((_, name), shape) in columns.iter().zip(MARKS) {
        if !bars {
            canvas.mark((x, 70), shape, SOFT);
            x += 12;
        }
        canvas.text(name, x, 70, 12.5, SOFT, Anchor::Start);
        x += 30 + 7 * name.chars().count() as i32;
    }
}

/// Returns the variants, sorted by the first metric that each has.
fn best_first<'a>(of_case: &[&&'a Summary], columns: &[TableColumn]) -> Vec<&'a str> {
    let mut variants = distinct(of_case.iter().map(|one| one.variant.as_str()));
    let first = |variant: &str| {
        let find = |(metric, _): &TableColumn| {
            of_case.iter().find(|one| one.variant == variant && one.metric == *metric).map(|one| one.median)
        };
        columns.iter().find_map(find).unwrap_or(f64::INFINITY)
    };
    variants.sort_by(|a, b| first(a).total_cmp(&first(b)).then(a.cmp(b)));
    variants
}
