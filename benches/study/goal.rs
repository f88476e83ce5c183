//! Performance goals of our runtime relative to other crates: ratios of medians measured in one run.

use crate::DataRow;
use std::fmt;

/// Repeated measurements of one number: ascending, never empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread(Vec<f64>);

impl Spread {
    /// Returns the smallest value.
    pub fn low(&self) -> f64 {
        self.0[0]
    }

    /// Returns the median, which is what goals compare.
    pub fn median(&self) -> f64 {
        self.0[self.0.len() / 2]
    }

    /// Returns the largest value.
    pub fn high(&self) -> f64 {
        self.0[self.0.len() - 1]
    }
}

/// Result of a goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GoalVerdict {
    /// The ratio of the medians is within the limit.
    Reached,
    /// The ratio is over the limit, but not significantly: the repeats scatter by more.
    Scatter,
    /// The ratio is significantly over the limit.
    Missed,
}

impl GoalVerdict {
    /// Returns the text for the page.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::Scatter => "within the scatter",
            Self::Missed => "**not reached**",
        }
    }
}

/// One goal: our value must be at most `demanded` times the value of the rival. Lower is better for all of them.
#[derive(Clone, Debug)]
pub struct PerformanceGoal {
    /// Name of the goal.
    pub name: String,
    /// Unit of the values.
    pub unit: String,
    /// Our values.
    pub ours: Spread,
    /// Name of the rival.
    pub rival: String,
    /// Values of the rival.
    pub theirs: Spread,
    /// Largest allowed ratio.
    pub demanded: f64,
}

impl PerformanceGoal {
    /// Returns the ratio of our median to the rival's.
    pub fn ratio(&self) -> f64 {
        self.ours.median() / self.theirs.median()
    }

    /// Returns the result. A ratio over the limit counts as missed if it is significant at the 5 % level by the rank test
    /// of Mann and Whitney (1947).
    pub fn verdict(&self) -> GoalVerdict {
        if self.ours.median() <= self.demanded * self.theirs.median() {
            GoalVerdict::Reached
        } else if self.standard_score() < 1.645 {
            GoalVerdict::Scatter
        } else {
            GoalVerdict::Missed
        }
    }

    /// Returns the standard score of U, the statistic of the rank test, in its normal approximation: how much more often
    /// than by chance our values are over the limit. Infinite for a fixed limit, which has no scatter.
    fn standard_score(&self) -> f64 {
        let (ours, theirs) = (&self.ours.0, &self.theirs.0);
        if theirs.len() == 1 {
            return f64::INFINITY;
        }
        let over = |one: &f64, other: &f64| match one.total_cmp(&(self.demanded * other)) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => 0.5,
            std::cmp::Ordering::Greater => 1.0,
        };
        let u: f64 = ours.iter().flat_map(|one| theirs.iter().map(move |other| over(one, other))).sum();
        let (n, m) = (ours.len() as f64, theirs.len() as f64);
        (u - n * m / 2.0) / (n * m * (n + m + 1.0) / 12.0).sqrt()
    }
}

impl fmt::Display for PerformanceGoal {
    /// Writes one line of a table.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, unit, ours, rival, theirs, demanded } = self;
        let spread = |of: &Spread| {
            let digits = if of.high() < 1.0 { 5 } else { 1 };
            format!("{:.digits$} [{:.digits$} .. {:.digits$}]", of.median(), of.low(), of.high())
        };
        let verdict = match self.verdict() {
            GoalVerdict::Missed => "NOT REACHED",
            other => other.as_str(),
        };
        write!(
            f,
            "{name:<42} {unit:<6} ours {:<28} {rival:<20} {:<28} ratio {:>5.2}, limit {demanded:.2}: {verdict}",
            spread(ours),
            spread(theirs),
            self.ratio(),
        )
    }
}

/// The crates that run actors as async tasks, in the variant with a thread for each actor.
const ASYNC: [&str; 3] = ["actix", "kameo", "ractor"];
/// The crate that gives each actor an OS thread.
const ONE_THREAD_EACH: &str = "tonari-actor";
/// The fastest crate: all actors on one thread.
const INLINE: &str = "stakker";
const OURS: &str = "dragonfly";
const SPINNING: &str = "dragonfly, spinning";
/// Limit for "not slower": medians of equal code differ by this factor between runs.
const EQUAL: f64 = 1.05;
/// Limit for "no allocation". Not zero, because the queue allocates memory at the start, which is divided among
/// all messages.
const NONE: f64 = 0.001;

/// Returns the goals for which `rows` contains both sides.
///
/// Round trips are compared with both threads bound to cores. Otherwise the system puts two threads on one core or on two,
/// unpredictably, and tokio with two workers runs two actors that answer each other on one of them.
pub fn goals(rows: &[DataRow]) -> Vec<PerformanceGoal> {
    let mut all = Vec::new();
    let crates = [ASYNC[0], ASYNC[1], ASYNC[2], ONE_THREAD_EACH, INLINE];
    let duel = |name: &str, case: &str, metric: &str, ours: &str, rivals: &[&str], demanded: f64| {
        let (ours, unit) = spread(rows, case, ours, metric)?;
        let found = rivals.iter().filter_map(|rival| Some((*rival, spread(rows, case, rival, metric)?.0)));
        let (rival, theirs) = found.min_by(|one, other| one.1.median().total_cmp(&other.1.median()))?;
        Some(PerformanceGoal { name: name.to_owned(), unit, ours, rival: rival.to_owned(), theirs, demanded })
    };
    let limit = |name: &str, case: &str, metric: &str, ours: &str, most: f64, limit_text: &str| {
        let (ours, unit) = spread(rows, case, ours, metric)?;
        let theirs = Spread(vec![most]);
        Some(PerformanceGoal {
            name: name.to_owned(),
            unit,
            ours,
            rival: limit_text.to_owned(),
            theirs,
            demanded: 1.0,
        })
    };
    for (name, case) in [
        ("two cores", "two_cores"),
        ("two cores, after a rest", "two_cores_rested"),
        ("one core", "one_core"),
    ] {
        let (name, case) = (format!("round trip, parked, {name}"), format!("actor/round_trip_bound/{case}"));
        all.extend(duel(&name, &case, "trip.p50", OURS, &crates, EQUAL));
    }
    let spin = ("own/spin/two_cores", "own/spin/one_core");
    all.extend(limit("round trip, spinning, two cores", spin.0, "trip.p50", SPINNING, 1_000.0, "1 µs"));
    all.extend(duel("round trip, spinning, one core", spin.1, "trip.p50", SPINNING, &[OURS], 1.1));
    for case in ["1_producer/8_bytes", "1_producer/64_bytes", "2_producers/8_bytes", "2_producers/64_bytes"] {
        let name = format!("one way, {}", case.replace(['_', '/'], " "));
        let case = format!("actor/one_way/{case}");
        for (rivals, demanded) in [(&[ONE_THREAD_EACH][..], 0.5), (&ASYNC, 0.5), (&[INLINE], EQUAL)] {
            all.extend(duel(&name, &case, "per_message", OURS, rivals, demanded));
        }
        all.extend(limit("  its allocations", &case, "allocations", OURS, NONE, "none"));
    }
    for size in ["8", "64"] {
        let (name, case) = (format!("on one thread, {size} bytes"), format!("actor/chain/{size}_bytes"));
        all.extend(duel(&name, &case, "per_message", OURS, &[INLINE], EQUAL));
    }
    all
}

/// Returns the repeats of one metric, and its unit.
fn spread(rows: &[DataRow], case: &str, variant: &str, metric: &str) -> Option<(Spread, String)> {
    let of = |row: &&DataRow| row.case == case && row.variant == variant && row.metric == metric;
    let mut values: Vec<f64> = rows.iter().filter(of).map(|row| row.value).collect();
    values.sort_by(f64::total_cmp);
    let unit = rows.iter().find(of)?.unit.clone();
    Some((Spread(values), unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(case: &str, metric: &str, of: &[(&str, [f64; 3])]) -> Vec<DataRow> {
        let row = |variant: &str, repeat: usize, value| DataRow {
            case: case.to_owned(),
            variant: variant.to_owned(),
            repeat: repeat as u32,
            metric: metric.to_owned(),
            unit: "ns".into(),
            value,
            background: 0.0,
        };
        let of = of.iter();
        of.flat_map(|(name, values)| values.iter().enumerate().map(|(i, v)| row(name, i, *v))).collect()
    }

    #[test]
    fn the_median_is_compared_with_the_best_rival_of_each_kind() {
        let all = goals(&rows(
            "actor/one_way/1_producer/8_bytes",
            "per_message",
            &[
                ("dragonfly", [90.0, 50.0, 10.0]),
                ("actix", [120.0, 110.0, 400.0]),
                ("kameo", [500.0, 500.0, 500.0]),
                ("kameo, 2 workers", [1.0, 1.0, 1.0]),
                ("tonari-actor", [90.0, 95.0, 99.0]),
                ("stakker", [48.0, 49.0, 50.0]),
            ],
        ));
        let seen: Vec<(&str, GoalVerdict)> =
            all.iter().map(|goal| (goal.rival.as_str(), goal.verdict())).collect();
        let (reached, scatter) = (GoalVerdict::Reached, GoalVerdict::Scatter);
        assert_eq!(seen, [("tonari-actor", scatter), ("actix", reached), ("stakker", reached)]);
        assert_eq!(all[0].ours, Spread(vec![10.0, 50.0, 90.0]));
        assert!(all[0].to_string().contains("within the scatter"), "{}", all[0]);
    }

    #[test]
    fn a_slower_median_misses_the_goal_unless_the_repeats_scatter_more() {
        let verdict = |ours: &[f64], theirs: &[f64]| {
            let (ours, theirs) = (Spread(ours.to_vec()), Spread(theirs.to_vec()));
            PerformanceGoal {
                name: "".into(),
                unit: "".into(),
                ours,
                rival: "".into(),
                theirs,
                demanded: 1.0,
            }
            .verdict()
        };
        // The critical U of 7 against 7, one-sided, at 5 %: at least 38 of 49 pairs.
        let theirs = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0];
        assert_eq!(verdict(&[31.0, 41.0, 51.0, 61.0, 62.0, 71.0, 72.0], &theirs), GoalVerdict::Missed);
        assert_eq!(verdict(&[21.0, 31.0, 41.0, 51.0, 61.0, 71.0, 72.0], &theirs), GoalVerdict::Scatter);
        assert_eq!(verdict(&theirs, &theirs), GoalVerdict::Reached);
        // Slower by 1 %, but in every repeat.
        assert_eq!(verdict(&[10.1; 7], &[10.0; 7]), GoalVerdict::Missed);
        // A single repeat is never a significant difference between two variants, but it can miss a fixed limit.
        assert_eq!(verdict(&[11.0], &[10.0, 10.0]), GoalVerdict::Scatter);
        assert_eq!(verdict(&[11.0], &[10.0]), GoalVerdict::Missed);
    }

    #[test]
    fn a_fixed_limit_needs_no_rival_and_a_case_without_data_is_no_goal() {
        let spinning = |time| {
            let all = rows("own/spin/two_cores", "trip.p50", &[("dragonfly, spinning", [time; 3])]);
            goals(&all).iter().map(PerformanceGoal::verdict).collect::<Vec<_>>()
        };
        assert_eq!(
            (spinning(999.0), spinning(1_001.0)),
            (vec![GoalVerdict::Reached], vec![GoalVerdict::Missed])
        );
        assert!(goals(&[]).is_empty());
    }
}
