//! What a pose costs: `cargo bench -p dragonfly-anim`, or `cargo bench -p dragonfly-anim -- part/of/a/name` for the cases
//! whose names hold one of the parts, with those that they stand beside. `-- --list` prints all names.
//!
//! A name is *way/task/model/case*. The same task is done in several ways, which take turns while they are measured, so
//! that their ratios mean something on any machine, however busy it is:
//!
//! | way | what |
//! |---|---|
//! | `open` | the formulas, one bone at a time |
//! | `avx2`, `portable` | the fast path, at each level of the machine, with keys as they are |
//! | `avx2/compressed`, … | the same with compressed takes, 0.1 mm at 3 cm |
//! | `sketch` | a prototype's method, with fewer duties; see [`sketch`] |
//! | `lockstep` | its other way for crowds, eight characters at once |
//! | `tree`, `boxes` | hits and bounds by the tree and by the boxes of bones, beside `open`: every triangle and vertex |
//!
//! | work | one unit |
//! |---|---|
//! | `sample` | a bone at one time: forward and backward at 60 Hz, random times; the first take and the longest |
//! | `to_root`, `final` | a bone's to-root matrix, a joint's final matrix |
//! | `blend`, `additive` | a bone of 2 or 4 layers, whole or with masks; of a difference that is added, wholly or in part |
//! | `two_bone` | one solve |
//! | `skin` | a vertex's position and normal, with 1, 2 or 4 influences |
//! | `pipeline` | a character, from takes to final matrices: one, one that plays two takes, crowds of mixed takes and times |
//! | `hit` | a ray, point, sphere or pose |
//!
//! A line holds nanoseconds a unit (the median, the 99th percentile and the least of the rounds) and how many times as
//! long the case takes as the sketch, or where the sketch does not do it as the open path: the median of the ratios of
//! single rounds. At the end stand the goals and whether they are reached ([`goals`]), and before them what compressed takes
//! weigh ([`compressed`]).
//!
//! The script `instructions` beside this file counts instructions of the same cases. `cargo test --benches` does each
//! once.

mod arguments;
mod case;
mod compressed;
mod fast;
mod goals;
mod hit;
mod inputs;
mod measure;
mod model;
mod open;
mod play;
mod sketch;

use arguments::{Arguments, Mode};
use case::{Case, rival_of};
use measure::Measured;
use model::Subject;
use std::process::ExitCode;

/// Cases that belong together, and a line to stand over them.
struct Section {
    about: Box<dyn FnOnce() -> String>,
    cases: Vec<Case>,
}

/// With what the names in [`compressed`] begin; it measures on its own.
const WEIGHTS: [&str; 2] = ["anim/compressed/pab", "anim/compressed/fox"];

/// Everything that is measured on one model.
fn section(subject: Subject) -> Section {
    let subject: &'static Subject = Box::leak(Box::new(subject));
    let ways = [open::cases(subject), fast::cases(subject), sketch::cases(subject)];
    Section { about: Box::new(|| subject.about()), cases: ways.into_iter().flatten().collect() }
}

fn main() -> ExitCode {
    let arguments = Arguments::read();
    let mut sections = vec![section(model::bench_rig()), section(model::fox())];
    sections.extend(hit::sections());
    let unknown = arguments.unknown(sections.iter().flat_map(|section| &section.cases), &WEIGHTS);
    if !unknown.is_empty() {
        eprintln!("no case has {} in its name; `-- --list` prints the names", unknown.join(" or "));
        return ExitCode::FAILURE;
    }
    let wanted = |sections: Vec<Section>| {
        let cases = sections.into_iter().flat_map(|section| section.cases);
        cases.filter(|case| arguments.want(&case.name())).collect::<Vec<_>>()
    };
    match arguments.mode {
        Mode::Measure => measure_all(&arguments, sections),
        Mode::Check => check(wanted(sections)),
        Mode::Count => case::count(wanted(sections)),
        Mode::List => wanted(sections).iter().for_each(|case| println!("{}", case.name())),
        Mode::Goals => goals::print_instructions(),
    }
    ExitCode::SUCCESS
}

/// Does each case once.
fn check(cases: Vec<Case>) {
    let count = cases.len();
    cases.into_iter().for_each(|case| drop(case.start()));
    println!("{count} cases work");
}

fn measure_all(arguments: &Arguments, sections: Vec<Section>) {
    let mut all = Vec::new();
    for Section { about, cases } in sections {
        let groups = groups(with_rivals(arguments, cases));
        if groups.is_empty() {
            continue;
        }
        println!("\n{}\n{}", about(), heading());
        for group in groups {
            let measured = measure::measure(group);
            println!();
            measured.iter().for_each(|one| println!("{}", line(one, &measured)));
            all.extend(measured);
        }
    }
    if WEIGHTS.iter().any(|beginning| arguments.want_beginning(beginning)) {
        println!("\nWhat compressed takes weigh; nanoseconds for 100 poses");
        compressed::run();
    }
    goals::say(&all);
}

/// The cases that are asked for, and those that they stand beside.
fn with_rivals(arguments: &Arguments, cases: Vec<Case>) -> Vec<Case> {
    let wanted = |case: &&Case| arguments.want(&case.name());
    let rivals: Vec<String> =
        cases.iter().filter(wanted).filter_map(|case| rival_of(case, cases.iter())).collect();
    cases.into_iter().filter(|case| wanted(&case) || rivals.contains(&case.name())).collect()
}

/// The cases of each group, in the order of the groups' first cases.
fn groups(cases: Vec<Case>) -> Vec<Vec<Case>> {
    let mut groups: Vec<Vec<Case>> = Vec::new();
    for case in cases {
        match groups.iter_mut().find(|group| group[0].group == case.group) {
            Some(group) => group.push(case),
            None => groups.push(vec![case]),
        }
    }
    // Rows of a group one after the other, the ways of each in their order.
    for group in &mut groups {
        let rows: Vec<String> = group.iter().map(|case| case.row.clone()).collect();
        group.sort_by_cached_key(|case| rows.iter().position(|row| *row == case.row));
    }
    groups
}

fn heading() -> String {
    format!("{:<46}{:>11}{:>12}{:>11}   {:<16}{:>9}", "", "median", "p99", "least", "", "ratio")
}

fn line(one: &Measured, all: &[Measured]) -> String {
    let rival = one.rival.as_ref().and_then(|rival| all.iter().find(|other| other.name == *rival));
    let beside = rival.map_or(String::new(), |rival| {
        let way = rival.name.split('/').next().unwrap_or_default();
        format!("{:>8.3} × {way}", one.ratio(rival))
    });
    let unit = format!("ns a {}", one.unit);
    let (median, p99, least) = (one.median(), one.p99(), one.least());
    let line = format!("{:<46}{median:>11.2}{p99:>12.2}{least:>11.2}   {unit:<16}{beside}", one.name);
    line.trim_end().to_owned()
}
