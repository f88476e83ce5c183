//! Chart of distributions: a curve for each variant over its percentiles.

use super::axis::{AxisScale, ChartAxis};
use super::canvas::{self, ACCENT, Anchor, GRID, INK, OURS, PALETTE, SHAPES, SOFT, WIDTH};
use crate::summary::{Summary, is_ours};
use crate::table::distinct;

/// Recorded points of a distribution, with the share of values above them.
const POINTS: [(&str, &str); 5] =
    [("p50", "half"), ("p90", "1 in 10"), ("p99", "1 in 100"), ("p99.9", "1 in 1,000"), ("max", "longest")];

const LEFT: i32 = 86;
const RIGHT: i32 = WIDTH - 240;
const TOP: i32 = 76;
const BOTTOM: i32 = 440;

/// Draws the percentiles of the distribution `metric` in the single case of `all`, for the variants in `who`, or for all
/// if `who` is empty. The subtitle contains the number of variants that are left out.
pub fn curves(title: &str, all: &[Summary], metric: &str, who: &[&str]) -> String {
    let names = POINTS.map(|(point, _)| format!("{metric}.{point}"));
    let has: Vec<&Summary> = all.iter().filter(|one| names.contains(&one.metric)).collect();
    let wanted = |one: &&&Summary| who.is_empty() || who.contains(&one.variant.as_str());
    let shown: Vec<&Summary> = has.iter().filter(wanted).copied().collect();
    let count = |all: &[&Summary]| distinct(all.iter().map(|one| one.variant.as_str())).len();
    let left_out = match count(&has) - count(&shown) {
        0 => String::new(),
        number => format!(" {number} more are in the table."),
    };
    let unit = shown.first().map_or("ns", |one| one.unit.as_str());
    let axis =
        ChartAxis::fit(shown.iter().flat_map(|one| [one.low, one.high]), AxisScale::Log, unit, BOTTOM, TOP);
    let under = format!(
        "Lower is better. Median of the repeats; thin lines: smallest to largest; logarithmic scale.{left_out}"
    );
    let across = |point: usize| LEFT + 40 + point as i32 * (RIGHT - LEFT - 80) / 4;

    canvas::svg(BOTTOM + 60, title, &under, |canvas| {
        for (y, label) in axis.ticks() {
            if !label.is_empty() {
                canvas.line(&[(LEFT, y), (RIGHT, y)], 1, GRID);
            }
            canvas.text(&label, LEFT - 8, y, 12.0, SOFT, Anchor::End);
        }
        for (place, (point, words)) in POINTS.iter().enumerate() {
            canvas.text(point, across(place), BOTTOM + 18, 13.0, INK, Anchor::Middle);
            canvas.text(words, across(place), BOTTOM + 36, 12.0, SOFT, Anchor::Middle);
        }
        let mut variants = distinct(shown.iter().map(|one| one.variant.as_str()));
        // A variant has the same color in every chart of the same variants; ours is drawn last, on top.
        variants.sort_unstable();
        let (mut ours, mut others) = (0, 0);
        let mut styled: Vec<_> = variants
            .iter()
            .map(|variant| {
                let (colors, count) =
                    if is_ours(variant) { (&OURS[..], &mut ours) } else { (&PALETTE[..], &mut others) };
                *count += 1;
                (*variant, colors[(*count - 1) % colors.len()], SHAPES[(*count - 1) % SHAPES.len()])
            })
            .collect();
        styled.sort_by_key(|(variant, ..)| is_ours(variant));
        let mut labels = Vec::new();
        for (variant, color, shape) in styled {
            let mut points = Vec::new();
            for (place, name) in names.iter().enumerate() {
                let Some(one) = shown.iter().find(|one| one.variant == variant && one.metric == *name) else {
                    continue;
                };
                let [low, y, high] = [one.low, one.median, one.high].map(|value| axis.place(value));
                canvas.line(&[(across(place), low), (across(place), high)], 1, color);
                points.push((across(place), y));
            }
            canvas.line(&points, if is_ours(variant) { 3 } else { 2 }, color);
            for point in &points {
                canvas.mark(*point, shape, color);
            }
            labels.extend(points.last().map(|end| (end.1, *end, variant, color, shape)));
        }
        // Labels at the ends of the curves, moved apart where they would overlap.
        labels.sort_by_key(|label| label.0);
        let mut free = TOP;
        let room = labels.len() as i32 * 17;
        for (place, (wanted, end, variant, color, shape)) in labels.into_iter().enumerate() {
            let y = wanted.max(free).min(BOTTOM - room + (place as i32 + 1) * 17);
            free = y + 17;
            canvas.line(&[(end.0 + 8, end.1), (RIGHT + 8, y)], 1, GRID);
            canvas.mark((RIGHT + 16, y), shape, color);
            canvas.text(
                variant,
                RIGHT + 27,
                y,
                12.5,
                if is_ours(variant) { ACCENT } else { INK },
                Anchor::Start,
            );
        }
    })
}
