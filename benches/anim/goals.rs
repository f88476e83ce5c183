//! Goals of the fast path, on the bench rig.
//!
//! A goal in time is a ratio to another case of the same run, because nanoseconds differ from machine to machine. The
//! ratios are based on a prototype: sampling may take slightly more than twice the sketch's time, and a whole character
//! about a fifth more. A goal in instructions is absolute; the script `instructions` checks it.

use crate::measure::CaseTimes;
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_kit::figures::{Figure, GOAL};

/// Tasks with takes, both with every key and compressed, and the largest ratio to the sketch.
const WITH_TAKES: [(&str, f64); 4] = [
    ("sample/pab/walk/forward", 2.1),
    ("sample/pab/atlas/forward", 2.1),
    ("pipeline/pab/1", 1.2),
    ("pipeline/pab/1000", 1.17),
];

/// Tasks without takes, and the largest ratio to the sketch.
const WITHOUT_TAKES: [(&str, f64); 4] =
    [("to_root/pab", 1.0), ("skin/pab/1", 1.0), ("skin/pab/2", 1.0), ("skin/pab/4", 1.0)];

/// Largest ratio of sampling at random times to sampling forward in time.
const RANDOM: f64 = 1.1;

/// Largest numbers of instructions per unit.
const INSTRUCTIONS: [(&str, f64); 10] = [
    ("sample/pab/walk/forward", 30.0),
    ("compressed/sample/pab/walk/forward", 30.0),
    ("compressed/sample/pab/atlas/forward", 30.0),
    ("final/pab", 40.0),
    ("blend/pab/2/whole", 16.0),
    ("blend/pab/4/whole", 29.0),
    ("two_bone/pab", 500.0),
    ("skin/pab/4", 50.0),
    ("pipeline/pab/1", 6_500.0),
    ("compressed/pipeline/pab/1", 6_500.0),
];

/// A case, the case that it is compared with, and the largest ratio of their times.
struct RatioGoal {
    case: String,
    reference: String,
    /// Short name of the reference in the tables.
    name: &'static str,
    max: f64,
}

fn ratio_goals() -> Vec<RatioGoal> {
    let level = SimdLevel::best().name();
    let mut goals = Vec::new();
    let mut add = |case: String, reference: String, name, max| {
        goals.push(RatioGoal { case, reference, name, max });
    };
    for (task, max) in WITH_TAKES {
        for variant in [level.to_owned(), format!("{level}/compressed")] {
            add(format!("{variant}/{task}"), format!("sketch/{task}"), "sketch", max);
            if let Some(take) = task.strip_suffix("/forward") {
                add(format!("{variant}/{take}/random"), format!("{variant}/{task}"), "forward", RANDOM);
            }
        }
    }
    for (task, max) in WITHOUT_TAKES {
        add(format!("{level}/{task}"), format!("sketch/{task}"), "sketch", max);
    }
    goals
}

/// A goal in time whose cases were measured.
pub(crate) struct CheckedGoal<'a> {
    goal: RatioGoal,
    case: &'a CaseTimes,
    ratio: f64,
}

impl CheckedGoal<'_> {
    /// Returns the ratio and the goal, as rows of the results.
    pub(crate) fn rows(&self) -> [Figure; 2] {
        let row =
            |metric: String, value| Figure::new(&self.case.task, &self.case.variant, &metric, "ratio", value);
        let ratio = format!("ratio to {}", self.goal.name);
        let rows = [row(format!("{GOAL}{ratio}"), self.goal.max), row(ratio, self.ratio)];
        rows.map(|row| Figure { others: self.case.others, ..row })
    }
}

/// Returns the goals in time whose cases are in `all`.
pub(crate) fn checked(all: &[CaseTimes]) -> Vec<CheckedGoal<'_>> {
    let find = |name: &str| all.iter().find(|one| one.name() == name);
    let check = |goal: RatioGoal| {
        let (case, reference) = (find(&goal.case)?, find(&goal.reference)?);
        Some(CheckedGoal { goal, case, ratio: case.ratio(reference) })
    };
    ratio_goals().into_iter().filter_map(check).collect()
}

/// Prints which goals in time are reached.
pub(crate) fn print(goals: &[CheckedGoal]) {
    if goals.is_empty() {
        return;
    }
    println!("\n{:<46}{:>9}{:>9}   {:<20}compared with", "goals", "here", "at most", "");
    for CheckedGoal { goal, ratio, .. } in goals {
        let over = ratio / goal.max - 1.0;
        let verdict =
            if over <= 0.0 { "reached".to_owned() } else { format!("missed by {:.1} %", over * 100.0) };
        println!("{:<46}{ratio:>7.3} ×{:>7.2} ×   {verdict:<20}{}", goal.case, goal.max, goal.reference);
    }
    println!("Goals in instructions: benches/anim/instructions");
}

/// Prints the goals in instructions, a line for each case, for the script that counts.
pub(crate) fn print_instructions() {
    instructions().iter().for_each(|(case, max)| println!("{case} {max}"));
}

/// Returns the name of the fastest level of which instructions can be counted: valgrind has no AVX-512.
pub(crate) fn counted_level() -> &'static str {
    let known = SimdLevel::all().into_iter().map(SimdLevel::name).find(|name| *name != "avx512");
    known.unwrap_or(SimdLevel::PORTABLE.name())
}

/// Returns the goals in instructions, with the names of the cases.
pub(crate) fn instructions() -> Vec<(String, f64)> {
    let level = counted_level();
    INSTRUCTIONS.iter().map(|(case, max)| (format!("{level}/{case}"), *max)).collect()
}
