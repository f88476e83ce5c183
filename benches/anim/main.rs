//! What a pose costs: `cargo bench -p dragonfly-anim`, or `cargo bench -p dragonfly-anim -- part/of/a/name`.
//!
//! For each work the open path, the fast path at every level of the machine, and the sketch (see [`sketch`]) in one
//! run, so that their ratios mean something on any machine. The script `instructions` beside this file counts
//! instructions of the same works.

mod case;
mod compressed;
mod fast;
mod hit;
mod model;
mod open;
mod sketch;

use case::Case;
use model::Subject;

/// Everything that is measured on one model.
fn cases(subject: &Subject) -> Vec<Case> {
    [open::cases(subject), fast::cases(subject), sketch::cases(subject)].into_iter().flatten().collect()
}

fn main() {
    let subjects = [model::bench_rig(), model::fox()];
    if case::counted(|| subjects.iter().flat_map(cases).collect()) {
        return;
    }
    for subject in &subjects {
        println!("\n{}", subject.about());
        for mut case in cases(subject) {
            case.measure();
        }
    }
    compressed::run();
    hit::run();
}
