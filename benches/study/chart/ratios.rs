//! Chart of ratios: a row for each case, and a mark for each other variant with its time relative to ours.

use super::axis::{AxisScale, ChartAxis};
use super::canvas::{self, ACCENT, Anchor, GRID, INK, PALETTE, SHAPES, SOFT, WIDTH};
use crate::DataRow;
use crate::summary::spread;
use crate::table::{common_folder, distinct};

const LEFT: i32 = 210;
const RIGHT: i32 = WIDTH - 40;
const TOP: i32 = 112;
const ROW: i32 = 30;

/// Draws `metric` of `peers` relative to ours, from the values of the same repeat, which were measured one after another.
pub fn ratios(title: &str, rows: &[DataRow], metric: &str, ours: &str, peers: &[&str]) -> String {
    let of_metric = || rows.iter().filter(|row| row.metric == metric);
    let cases = distinct(of_metric().map(|row| row.case.as_str()));
    let prefix = common_folder(&cases);
    let mut points = Vec::new();
    for (line, case) in cases.iter().enumerate() {
        for (number, peer) in peers.iter().enumerate() {
            let of = |variant: &str, repeat: u32| {
                let same =
                    |row: &&DataRow| row.case == *case && row.variant == variant && row.repeat == repeat;
                of_metric().find(same).map(|row| row.value)
            };
            let theirs = of_metric().filter(|row| row.case == *case && row.variant == *peer);
            let times: Vec<f64> = theirs.filter_map(|row| Some(row.value / of(ours, row.repeat)?)).collect();
            if !times.is_empty() {
                points.push((line as i32, number, spread(times.into_iter())));
            }
        }
    }
    let values = points.iter().flat_map(|(.., [low, _, high])| [*low, *high]);
    let axis = ChartAxis::fit(values.chain([1.0]), AxisScale::Log, "ratio", LEFT, RIGHT);
    let bottom = TOP + ROW * cases.len() as i32;
    let under = format!(
        "Time relative to {ours} in the same repeat. Median of the repeats; thin lines: smallest to largest; logarithmic scale."
    );

    canvas::svg(bottom + 34, title, &under, |canvas| {
        let mut x = LEFT;
        for (number, peer) in peers.iter().enumerate() {
            canvas.mark((x, 72), SHAPES[number % SHAPES.len()], PALETTE[number % PALETTE.len()]);
            canvas.text(peer, x + 11, 72, 12.5, INK, Anchor::Start);
            x += 34 + 7 * peer.chars().count() as i32;
        }
        for (x, label) in axis.ticks() {
            if !label.is_empty() {
                canvas.line(&[(x, TOP - 4), (x, bottom)], 1, GRID);
            }
            canvas.text(&label, x, bottom + 15, 12.0, SOFT, Anchor::Middle);
        }
        let one = axis.place(1.0);
        canvas.line(&[(one, TOP - 4), (one, bottom)], 2, ACCENT);
        canvas.text(&format!("{ours} is faster →"), one + 8, TOP - 14, 12.0, ACCENT, Anchor::Start);
        canvas.text(&format!("← {ours} is slower"), one - 8, TOP - 14, 12.0, ACCENT, Anchor::End);
        for (line, case) in cases.iter().enumerate() {
            let y = TOP + line as i32 * ROW;
            canvas.text(&case[prefix..].replace('_', " "), LEFT - 12, y + ROW / 2, 13.0, INK, Anchor::End);
            canvas.line(&[(16, y), (RIGHT, y)], 1, GRID);
        }
        for (line, number, times) in points {
            let [low, median, high] = times.map(|value| axis.place(value));
            // The marks are spread over the height of the row, so that equal ones do not cover each other.
            let count = peers.len().max(2) as i32 - 1;
            let y = TOP + line * ROW + 7 + number as i32 * (ROW - 14) / count;
            let color = PALETTE[number % PALETTE.len()];
            canvas.line(&[(low, y), (high, y)], 1, color);
            canvas.mark((median, y), SHAPES[number % SHAPES.len()], color);
        }
    })
}
