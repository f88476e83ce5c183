//! Times of the tasks between a take and the screen: `cargo bench -p dragonfly-anim`, or
//! `cargo bench -p dragonfly-anim -- part/of/a/name` for the cases whose names contain one of the parts, with the cases
//! that they are compared with. `-- --list` prints all names.
//!
//! A name is *variant/task/model/case*. The variants of a task take turns while they are measured, so that their ratios
//! hold on any machine, however busy it is:
//!
//! | variant | code |
//! |---|---|
//! | `open` | the formulas, one bone at a time |
//! | `avx512`, `avx2`, `portable` | the fast path at each SIMD level of the machine, takes with every key |
//! | `avx2/compressed`, … | the same with takes compressed to 0.1 mm at 3 cm |
//! | `sketch` | the method of a prototype, which does less; see [`sketch`] |
//! | `lockstep` | its other method for crowds, eight characters at once |
//! | `tree`, `boxes` | hits by the tree and bounds by the boxes of bones; `open` tests every triangle and vertex |
//! | `stage` | the stage, on the fast path |
//! | `ozz`, `ozz/every_key`, `ACL` | ozz-animation and ACL, if `DRAGONFLY_RIVALS` is set; see [`rivals`] |
//!
//! | task | unit |
//! |---|---|
//! | `sample` | a bone at one time: forward and backward at 60 Hz, random times; the first take and the longest |
//! | `to_root`, `final` | a bone's to-root matrix, a joint's final matrix |
//! | `blend`, `additive` | a bone of 2 or 4 layers, whole or with masks; of an added difference, with weight 1 or less |
//! | `two_bone` | one solve |
//! | `skin` | a vertex's position and normal, with 1, 2 or 4 influences |
//! | `skin_by_matrix` | the same with normals moved by the matrix and not normalized, as ozz does |
//! | `pipeline` | a character, from takes to final matrices: one, one that plays two takes, crowds of mixed takes and times |
//! | `hit` | a ray, point, sphere or pose |
//! | `frame`, `read`, `resolve` | a role of a scene of the stage ([`stage`]); a script of 10,000 actions |
//!
//! A printed line contains nanoseconds per unit (the median, the 99th percentile and the minimum of the rounds) and the
//! ratio to the sketch, or to the open path where the sketch does not have the task: the median of the ratios of single
//! rounds. Sizes of compressed takes ([`compressed`]) and the goals ([`goals`]) follow.
//!
//! `DRAGONFLY_RIVALS=FOLDER cargo bench -p dragonfly-anim -- --record` measures everything and writes `results/times.csv`,
//! `results/sizes.csv` and the tables of `anim/README.md`; `-- --report` only writes the tables. Run it on a quiet
//! machine; the load by other programs is recorded in each row.
//!
//! The script `instructions` in this folder counts instructions of the same cases. `cargo test --benches` runs each case
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
mod record;
mod report;
mod rivals;
mod sketch;
mod stage;

use arguments::{BenchArguments, BenchMode};
use case::{BenchCase, baseline_of};
use measure::CaseTimes;
use model::BenchModel;
use rivals::Rivals;
use std::path::Path;
use std::process::ExitCode;

/// Cases of one model, and the line that is printed above their results.
struct Section {
    about: Box<dyn FnOnce() -> String>,
    cases: Vec<BenchCase>,
}

/// Prefix of the names in [`compressed`], which have no cases.
const SIZES: [&str; 1] = ["size/pab"];

/// Returns the cases of one model, those of the rivals last.
fn section(model: BenchModel, rivals: Vec<BenchCase>) -> Section {
    let model: &'static BenchModel = Box::leak(Box::new(model));
    let variants = [open::cases(model), fast::cases(model), sketch::cases(model), rivals];
    Section { about: Box::new(|| model.about()), cases: variants.into_iter().flatten().collect() }
}

fn main() -> ExitCode {
    match run(&BenchArguments::read()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &BenchArguments) -> Result<(), String> {
    // Instructions of the rivals are counted in their own programs.
    let rivals = match arguments.mode {
        BenchMode::Measure
        | BenchMode::Record
        | BenchMode::Check
        | BenchMode::List
        | BenchMode::Instructions => Rivals::build()?,
        BenchMode::Count | BenchMode::Goals | BenchMode::Report => None,
    };
    if arguments.mode == BenchMode::Record && (rivals.is_none() || !arguments.want_all()) {
        return Err(format!("--record measures everything: set {}, and name no case", rivals::FOLDER));
    }
    if let Some(counts) = &arguments.counts {
        return record::write_instructions(Path::new(counts), rivals.as_ref());
    }
    let theirs = rivals.as_ref().map_or(Ok(Vec::new()), Rivals::cases)?;
    let mut sections = vec![section(model::bench_rig(), theirs), section(model::fox(), Vec::new())];
    sections.extend(hit::sections());
    sections.push(stage::section());
    let unknown = arguments.unknown(sections.iter().flat_map(|section| &section.cases), &SIZES);
    if !unknown.is_empty() {
        return Err(format!(
            "no case has {} in its name; `-- --list` prints the names",
            unknown.join(" or ")
        ));
    }
    let wanted = |sections: Vec<Section>| {
        let cases = sections.into_iter().flat_map(|section| section.cases);
        cases.filter(|case| arguments.want(&case.name())).collect::<Vec<_>>()
    };
    match arguments.mode {
        BenchMode::Measure | BenchMode::Record => return measure_all(arguments, sections, rivals.as_ref()),
        BenchMode::Check => check(wanted(sections)),
        BenchMode::Count => case::count(wanted(sections)),
        BenchMode::List => wanted(sections).iter().for_each(|case| println!("{}", case.name())),
        BenchMode::Goals => goals::print_instructions(),
        BenchMode::Report | BenchMode::Instructions => return report::PAGE.update(),
    }
    Ok(())
}

/// Runs each case once.
fn check(cases: Vec<BenchCase>) {
    let count = cases.len();
    cases.into_iter().for_each(|case| drop(case.start()));
    println!("{count} cases work");
}

fn measure_all(
    arguments: &BenchArguments,
    sections: Vec<Section>,
    rivals: Option<&Rivals>,
) -> Result<(), String> {
    let mut all = Vec::new();
    for Section { about, cases } in sections {
        let groups = groups(with_baselines(arguments, cases));
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
    let mut sizes = Vec::new();
    if SIZES.iter().any(|prefix| arguments.want_prefix(prefix)) {
        sizes = compressed::sizes(&model::bench_rig(), &rivals.map_or(Ok(Vec::new()), Rivals::sizes)?);
        compressed::print(&sizes);
    }
    let goals = goals::checked(&all);
    goals::print(&goals);
    record::write(arguments.mode == BenchMode::Record, &all, &goals, sizes, rivals)
}

/// Returns the cases that are wanted, and those that they are compared with.
fn with_baselines(arguments: &BenchArguments, cases: Vec<BenchCase>) -> Vec<BenchCase> {
    let wanted = |case: &&BenchCase| arguments.want(&case.name());
    let baselines: Vec<String> =
        cases.iter().filter(wanted).filter_map(|case| baseline_of(case, cases.iter())).collect();
    cases.into_iter().filter(|case| wanted(&case) || baselines.contains(&case.name())).collect()
}

/// Returns the cases of each group, in the order of the groups' first cases.
fn groups(cases: Vec<BenchCase>) -> Vec<Vec<BenchCase>> {
    let mut groups: Vec<Vec<BenchCase>> = Vec::new();
    for case in cases {
        match groups.iter_mut().find(|group| group[0].group == case.group) {
            Some(group) => group.push(case),
            None => groups.push(vec![case]),
        }
    }
    // Within a group, sorts by task, and keeps the order of the variants of each task.
    for group in &mut groups {
        let tasks: Vec<String> = group.iter().map(|case| case.task.clone()).collect();
        group.sort_by_cached_key(|case| tasks.iter().position(|task| *task == case.task));
    }
    groups
}

fn heading() -> String {
    format!("{:<46}{:>11}{:>12}{:>11}   {:<16}{:>9}", "", "median", "p99", "min", "", "ratio")
}

fn line(one: &CaseTimes, all: &[CaseTimes]) -> String {
    let baseline = one.baseline.as_ref().and_then(|name| all.iter().find(|other| other.name() == *name));
    let ratio = baseline
        .map_or(String::new(), |baseline| format!("{:>8.3} × {}", one.ratio(baseline), baseline.variant));
    let unit = format!("ns/{}", one.unit);
    let (median, p99, min) = (one.median(), one.p99(), one.min());
    let line = format!("{:<46}{median:>11.2}{p99:>12.2}{min:>11.2}   {unit:<16}{ratio}", one.name());
    line.trim_end().to_owned()
}
