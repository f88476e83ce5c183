//! The cases: which methods are compared in which situation, and for how long; see the table in `mod.rs`.

use super::driver::Rate;
use super::frame::FrameWork;
use super::model::ModelSize;
use super::scenario::{RunDefects, Scenario, ScenarioSetup, run};
use super::script::Edits;
use super::sharing::{METHODS, SharingMethod};
use super::{cores, table};
use crate::{Study, StudyMode, Variant};
use std::time::Duration;

const HERTZ_60: Option<Duration> = Some(Duration::from_nanos(16_666_667));
const HERTZ_144: Option<Duration> = Some(Duration::from_nanos(6_944_444));

/// The methods that a case compares.
#[derive(Clone, Copy, PartialEq, Eq)]
enum MethodSelection {
    /// All methods.
    All,
    /// The best method of each kind, and the lock that is held for the frame.
    BestOfEachKind,
    /// The same as [`BestOfEachKind`](Self::BestOfEachKind), and the methods that this case is about.
    And(&'static [&'static str]),
}

impl MethodSelection {
    fn methods(self, mode: StudyMode) -> Vec<SharingMethod> {
        /// The methods of a short run.
        const FEW: [&str; 6] = [
            "messages, newest",
            "messages, batched",
            "mutex, frame",
            "mutex, poses",
            "mutex, cow",
            "arcswap, cow",
        ];
        let wanted = |method: &&SharingMethod| match self {
            _ if self == Self::All || mode == StudyMode::Check => true,
            Self::And(names) if names.contains(&method.name) => true,
            _ if mode == StudyMode::Short => FEW.contains(&method.name),
            _ => method.in_every_case,
        };
        METHODS.iter().filter(wanted).copied().collect()
    }
}

/// Measures every case.
pub fn all(study: &mut Study) {
    study.prints = false;
    let usual = ModelSize::USUAL.document();
    let draws = match study.mode {
        StudyMode::Check => 1,
        _ => FrameWork::calibrate(usual.skeleton.clone()),
    };
    if study.mode != StudyMode::Check {
        println!("# a frame draws its mesh {draws} times, which takes 3 ms when nothing disturbs it");
        println!("# times in microseconds; medians of the repeats");
    }
    let size = study.mode.pick(ModelSize::TINY, ModelSize::USUAL, ModelSize::USUAL);
    let bed = &ScenarioSetup::new(size, draws);
    let core = basis(study.mode);
    let longer = Scenario { length: core.length * study.mode.pick(1, 1, 2), ..core };

    compare(study, "drag", bed, longer, MethodSelection::All);
    let slow = Rate::Every(Duration::from_millis(16));
    let flood = Scenario { rate: Rate::FlatOut, ..core };
    let takes = Scenario { edits: Edits::Large, rate: slow, ..core };
    // A test checks results, which do not depend on the speed.
    if study.mode != StudyMode::Check {
        compare(study, "drag/60 Hz", bed, Scenario { rate: slow, ..core }, MethodSelection::BestOfEachKind);
        compare(
            study,
            "drag/frames 144 Hz",
            bed,
            Scenario { period: HERTZ_144, ..core },
            MethodSelection::BestOfEachKind,
        );
        compare(study, "takes/60 Hz", bed, takes, MethodSelection::And(&["mutex a take"]));
    }
    compare(
        study,
        "drag/frames unpaced",
        bed,
        Scenario { period: None, ..core },
        MethodSelection::BestOfEachKind,
    );
    compare(
        study,
        "flood",
        bed,
        flood,
        MethodSelection::And(&["messages", "messages, merged", "triple buffer"]),
    );
    let flood = Scenario { rate: Rate::FlatOut, ..takes };
    if study.mode != StudyMode::Short {
        compare(study, "takes/flood", bed, flood, MethodSelection::And(&["mutex a take"]));
    }
    disturbed(study, bed, core);
    questions(study, bed, core);
    large(study, draws, core);
}

fn basis(mode: StudyMode) -> Scenario {
    let milliseconds = |check, short, full| Duration::from_millis(mode.pick(check, short, full));
    Scenario {
        edits: Edits::Small,
        rate: Rate::EVERY_MILLISECOND,
        period: HERTZ_60,
        length: milliseconds(20, 60, 500),
        warm_up: milliseconds(5, 20, 100),
        graphics_stall: None,
        main_stall: None,
        busy: 0,
        questions: None,
        thorough: mode == StudyMode::Check,
    }
}

/// Cases in which a thread is delayed, or other threads compete for the CPU.
fn disturbed(study: &mut Study, bed: &ScenarioSetup, core: Scenario) {
    for milliseconds in study.mode.pick(vec![50], vec![50], vec![50, 500]) {
        let length = Duration::from_millis(study.mode.pick(milliseconds / 10, milliseconds, milliseconds));
        let at = core.length / 4;
        let lasting = Scenario { length: core.length + length, ..core };
        let stall = Scenario { graphics_stall: Some((at, length)), ..lasting };
        compare(
            study,
            &format!("graphics stall {milliseconds} ms"),
            bed,
            stall,
            MethodSelection::BestOfEachKind,
        );
        if study.mode != StudyMode::Short {
            let stall = Scenario { main_stall: Some((at, length)), ..lasting };
            compare(
                study,
                &format!("main stall {milliseconds} ms"),
                bed,
                stall,
                MethodSelection::BestOfEachKind,
            );
        }
    }
    if study.mode == StudyMode::Check {
        return;
    }
    let also = &["messages, relayed", "messages, spinning", "parking, cow"];
    compare(study, "import", bed, Scenario { busy: 1, ..core }, MethodSelection::And(also));
    let also = &["parking, poses", "parking, cow"];
    if study.mode != StudyMode::Short {
        compare(
            study,
            "more threads than cores",
            bed,
            Scenario { busy: 3, ..core },
            MethodSelection::And(also),
        );
    }
    if !study.wants("one core") {
        return;
    }
    match cores::pin("0") {
        Some(pinned) => {
            let also = &["messages, spinning", "parking, poses", "parking, cow"];
            compare(study, "one core", bed, core, MethodSelection::And(also));
            drop(pinned);
        }
        None => println!("# no taskset: nothing is measured on one core"),
    }
}

/// Cases in which the main thread needs an answer.
fn questions(study: &mut Study, bed: &ScenarioSetup, core: Scenario) {
    let idle = Scenario {
        rate: Rate::Still,
        questions: Some(Duration::from_millis(study.mode.pick(2, 3, 3))),
        ..core
    };
    let also = &["messages, read", "messages, spinning", "rwlock, frame"];
    if study.mode != StudyMode::Check {
        compare(study, "question/idle", bed, idle, MethodSelection::And(also));
    }
    let load = Scenario { rate: Rate::EVERY_MILLISECOND, period: None, ..idle };
    compare(study, "question/load", bed, load, MethodSelection::And(also));
    if study.mode != StudyMode::Short {
        let busy = Scenario { busy: 2, ..load };
        compare(study, "question/more threads than cores", bed, busy, MethodSelection::And(also));
    }
}

/// Cases with the same drag in longer takes.
fn large(study: &mut Study, draws: u32, core: Scenario) {
    if study.mode == StudyMode::Check {
        return;
    }
    for (name, size) in [("long takes", ModelSize::LONG), ("43 million keys", ModelSize::HUGE)] {
        if study.wants(name) && (study.mode == StudyMode::Full || size == ModelSize::LONG) {
            let bed = ScenarioSetup::new(size, draws);
            compare(study, name, &bed, core, MethodSelection::And(&["mutex, clone"]));
        }
    }
}

fn compare(study: &mut Study, case: &str, bed: &ScenarioSetup, scenario: Scenario, field: MethodSelection) {
    if !study.wants(case) {
        return;
    }
    let methods = field.methods(study.mode);
    let variants = methods.iter().map(|method| {
        Variant::new(method.name, move |measured| {
            let verdict = run(bed, method, &scenario, measured);
            assert_eq!(verdict, RunDefects::default(), "{case}, {}", method.name);
        })
    });
    let first = study.rows().len();
    study.compare(case, study.mode.pick(1, 1, 3), variants.collect());
    if study.mode != StudyMode::Check {
        table::print(
            case,
            &methods.iter().map(|method| method.name).collect::<Vec<_>>(),
            &study.rows()[first..],
        );
    }
}
