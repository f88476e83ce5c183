//! Charts in SVG, drawn from summaries.
//!
//! All have a white background, so that they are readable on a dark page too. Our variants have the accent color; nothing
//! is distinguished by color alone, but also by shapes and labels. A thin line through a mark spans the repeats from the
//! smallest to the largest.

mod axis;
mod canvas;
mod curves;
mod ratios;
mod rows;

pub use axis::AxisScale;
pub use curves::curves;
pub use ratios::ratios;
pub use rows::rows;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DataRow;
    use crate::summary::{summarize, tests::row};

    /// Returns three repeats of a distribution around `nanoseconds`.
    fn distribution(case: &str, variant: &str, metric: &str, nanoseconds: f64) -> Vec<DataRow> {
        let points = [("p50", 1.0), ("p90", 1.6), ("p99", 7.0), ("p99.9", 60.0), ("max", 900.0)];
        let repeats = (0..3).flat_map(|repeat| points.map(|(point, times)| (repeat, point, times)));
        repeats
            .map(|(repeat, point, times)| {
                let value = nanoseconds * times * (1.0 + 0.2 * f64::from(repeat));
                row(case, variant, repeat, &format!("{metric}.{point}"), "ns", value)
            })
            .collect()
    }

    fn draw_all() -> Vec<(&'static str, String)> {
        let who =
            [("dragonfly", 9e3), ("flume", 11e3), ("std, parked", 9.5e3), ("dragonfly, spinning", 700.0)];
        let trips: Vec<DataRow> = ["queue/trip/at_once", "queue/trip/rested"]
            .iter()
            .flat_map(|case| who.iter().flat_map(|(who, time)| distribution(case, who, "trip", *time)))
            .collect();
        let trips = summarize(&trips);
        let columns = [("trip.p50", "p50"), ("trip.p99", "p99"), ("trip.p99.9", "p99.9")];
        let ways = [
            "messages",
            "messages, newest",
            "mutex, frame",
            "mutex, extract",
            "rwlock",
            "arc swap",
            "per take",
        ];
        let blocked: Vec<DataRow> = ways
            .iter()
            .zip([7e3, 3e5, 9e4, 1.2e4, 1.3e4, 1.4e4, 2e4])
            .flat_map(|(way, time)| distribution("graphical/60_hz", way, "blocked", time))
            .collect();
        let mut suite = Vec::new();
        for (case, times) in
            [("ping_pong", 1.3), ("big", 0.7), ("thread_ring", 4.0), ("dining_philosophers", 30.0)]
        {
            for repeat in 0..3 {
                let own = 1e6 * (1.0 + 0.1 * f64::from(repeat));
                let case = format!("savina/{case}");
                suite.push(row(&case, "dragonfly", repeat, "took", "ns", own));
                for (who, more) in [("actix", 1.0), ("kameo", 1.2), ("ractor", 1.25), ("stakker", 0.4)] {
                    let time = 1e6 * times * more * (1.0 + 0.05 * f64::from(repeat));
                    suite.push(row(&case, who, repeat, "took", "ns", time));
                }
            }
        }
        vec![
            ("rows", rows("Round trip", &trips, &columns, AxisScale::Log)),
            ("bars", rows("Cost of one", &trips, &columns[..1], AxisScale::Linear)),
            ("curves", curves("Blocked main thread", &summarize(&blocked), "blocked", &ways[..6])),
            (
                "ratios",
                ratios("Actors", &suite, "took", "dragonfly", &["actix", "kameo", "ractor", "stakker"]),
            ),
        ]
    }

    #[test]
    fn all_texts_of_a_chart_are_within_its_bounds() {
        for (name, svg) in draw_all() {
            let number = |text: &str, key: &str| -> f64 {
                let rest = text.split(&format!("{key}=\"")).nth(1).expect(key);
                rest.split('"').next().unwrap_or("").parse().expect(key)
            };
            let (width, height) = (number(&svg, "width"), number(&svg, "height"));
            let mut texts = 0;
            for text in svg.split("<text ").skip(1) {
                let (x, y, size) = (number(text, "x"), number(text, "y"), number(text, "font-size"));
                let words = text.split_once('>').and_then(|(_, rest)| rest.split("</text>").next());
                // A letter is about half as wide as the font size.
                let long = words.expect("some").trim().chars().count() as f64 * size * 0.52;
                let (from, to) =
                    match text.split("text-anchor=\"").nth(1).and_then(|rest| rest.split('"').next()) {
                        Some("start") => (x, x + long),
                        Some("end") => (x - long, x),
                        _ => (x - long / 2.0, x + long / 2.0),
                    };
                assert!(from >= 0.0 && to <= width, "{name}: {words:?} from {from} to {to} of {width}");
                assert!(y >= 10.0 && y <= height - 8.0, "{name}: {words:?} at {y} of {height}");
                texts += 1;
            }
            assert!(texts > 10, "{name} has {texts} texts");
            for word in ["edian", "fill=\"#FFFFFF\"", "#D55E00", "repeat"] {
                assert!(svg.contains(word), "{name} lacks {word}");
            }
        }
    }

    #[test]
    fn the_same_data_gives_the_same_chart() {
        assert_eq!(draw_all(), draw_all());
    }
}
