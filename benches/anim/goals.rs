//! What the fast path is to reach, on the rig of the bench.
//!
//! Goals in time are ratios to another case of the same run, because nanoseconds differ from machine to machine. They come
//! from figures that were had side by side on one machine: 5 ns a bone where the sketch's sampling took 2.4; 950 ns for a
//! character where the sketch took 790, and 810 for one of a crowd. Goals in instructions are absolute; the script
//! `instructions` says whether they are reached.

use crate::measure::Measured;
use dragonfly_anim::fast::simd::SimdLevel;

/// Rows, whose takes are as they are and compressed, and how many times the sketch's time each may take.
const BOTH: [(&str, f64); 4] = [
    ("sample/pab/walk/forward", 2.1),
    ("sample/pab/atlas/forward", 2.1),
    ("pipeline/pab/1", 1.2),
    ("pipeline/pab/1000", 1.17),
];

/// Rows without takes, likewise.
const ALONE: [(&str, f64); 4] =
    [("to_root/pab", 1.0), ("skin/pab/1", 1.0), ("skin/pab/2", 1.0), ("skin/pab/4", 1.0)];

/// How many times as long as forward in time random times may take.
const RANDOM: f64 = 1.1;

/// Instructions that a unit of a row may take.
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

/// A case that is to take at most so many times as long as another.
struct Times {
    case: String,
    beside: String,
    most: f64,
}

fn times() -> Vec<Times> {
    let level = SimdLevel::best().name();
    let mut goals = Vec::new();
    let mut add = |case: String, beside: String, most| goals.push(Times { case, beside, most });
    for (row, most) in BOTH {
        for way in [level.to_owned(), format!("{level}/compressed")] {
            add(format!("{way}/{row}"), format!("sketch/{row}"), most);
            if let Some(take) = row.strip_suffix("/forward") {
                add(format!("{way}/{take}/random"), format!("{way}/{row}"), RANDOM);
            }
        }
    }
    for (row, most) in ALONE {
        add(format!("{level}/{row}"), format!("sketch/{row}"), most);
    }
    goals
}

/// Prints which goals in time are reached, of those whose cases were measured.
pub(crate) fn say(all: &[Measured]) {
    let find = |name: &str| all.iter().find(|one| one.name == name);
    let goals = times();
    let known: Vec<_> =
        goals.iter().filter_map(|goal| Some((goal, find(&goal.case)?, find(&goal.beside)?))).collect();
    if known.is_empty() {
        return;
    }
    println!("\n{:<46}{:>9}{:>9}   {:<20}beside", "goals", "here", "at most", "");
    for (goal, case, beside) in known {
        let ratio = case.ratio(beside);
        let over = ratio / goal.most - 1.0;
        let verdict =
            if over <= 0.0 { "reached".to_owned() } else { format!("missed by {:.1} %", over * 100.0) };
        println!("{:<46}{ratio:>7.3} ×{:>7.2} ×   {verdict:<20}{}", goal.case, goal.most, goal.beside);
    }
    println!("Goals in instructions: benches/anim/instructions");
}

/// Prints the goals in instructions, a line a case, for the script that counts.
pub(crate) fn print_instructions() {
    let level = SimdLevel::best().name();
    INSTRUCTIONS.iter().for_each(|(case, most)| println!("{level}/{case} {most}"));
}
