//! Which tables and charts the study shows, and what of the raw data is in each: a line here and a pair of comments in
//! `README.md` are all that a new one takes.

use crate::chart::Scale;
use crate::table::Column;

/// A table of the raw data in `README.md`, between `<!-- table: name -->` and `<!-- end -->`.
pub struct Table {
    /// Its name there.
    pub name: &'static str,
    /// Which rows it shows.
    pub source: Source,
    /// What its columns show, and what they are called.
    pub columns: &'static [Column],
}

/// A chart of the raw data, `results/name.svg`, shown between `<!-- chart: name -->` and `<!-- end -->`.
pub struct Chart {
    /// Its name there.
    pub name: &'static str,
    /// The question that it answers.
    pub title: &'static str,
    /// Which rows it shows.
    pub source: Source,
    /// How.
    pub kind: Kind,
}

/// A file of raw data, and the cases that are taken from it.
#[derive(Clone, Copy)]
pub struct Source {
    /// `results/file.csv`.
    pub file: &'static str,
    /// Any of these; one that ends in `*` stands for all that begin so. One that begins with `?` cannot be measured on
    /// every machine; if there is nothing else, nothing is shown.
    pub cases: &'static [&'static str],
}

/// How a chart is drawn.
pub enum Kind {
    /// See [`rows`](crate::chart::rows).
    Rows(&'static [Column], Scale),
    /// See [`curves`](crate::chart::curves): the percentiles of this distribution, by these; one case.
    Curves(&'static str, &'static [&'static str]),
    /// See [`ratios`](crate::chart::ratios): this metric, in times this variant's, of these.
    Ratios(&'static str, &'static str, &'static [&'static str]),
}

/// The files of raw data: two are written by the benches of their names; the third is two runs of the first, before and
/// after what it found was mended.
pub const FILES: [&str; 3] = ["runtime", "graphical", "mended"];

const fn runtime(cases: &'static [&'static str]) -> Source {
    Source { file: "runtime", cases }
}

const fn graphical(cases: &'static [&'static str]) -> Source {
    Source { file: "graphical", cases }
}

// The cases of `graphical`.
const DRAG: &[&str] = &["drag"];
const RATES: &[&str] = &["drag/*"];
const FLOODS: &[&str] = &["flood", "takes/flood"];
const TAKES: &[&str] = &["takes/60 Hz"];
const SIZES: &[&str] = &["drag", "long takes", "43 million keys"];
const STALLS: &[&str] = &["graphics stall*", "main stall*"];
const THREADS: &[&str] = &["drag", "import", "more threads than cores", "one core"];
const QUESTIONS: &[&str] = &["question/*"];

/// The ways that are drawn: the others of each kind lie near them, and are in the tables.
const TELLING: &[&str] = &[
    "messages",
    "messages, newest",
    "messages, batched",
    "mutex, frame",
    "mutex, poses",
    "mutex, cow",
    "arcswap, cow",
    "triple buffer",
];

// The cases that queues and actors are compared in.
const ONE_WAY: &[&str] = &[
    "queue/one_way/1_producer/64*",
    "queue/one_way/2_producers/64*",
    "actor/one_way/1_producer/64*",
    "actor/one_way/2_producers/64*",
];

const TRIP: &[Column] =
    &[("trip.p50", "p50"), ("trip.p99", "p99"), ("trip.p99.9", "p99.9"), ("trip.max", "longest")];
const TRIP_MARKS: &[Column] = &[("trip.p50", "p50"), ("trip.p99", "p99"), ("trip.p99.9", "p99.9")];
const MACHINE: &[Column] = &[
    ("cores", "cores"),
    ("clock.cost", "looking at the clock"),
    ("clock.step", "step of the clock"),
    ("two_wake_ups.p50", "two wake-ups, p50"),
    ("two_wake_ups.p99", "p99"),
    ("overshoot_1ms.p50", "sleep of 1 ms too long by, p50"),
    ("overshoot_1ms.p99", "p99"),
];
/// What every case of `graphical` has.
const EDITING: &[Column] = &[
    ("blocked.p50", "blocked, p50"),
    ("blocked.p99", "blocked, p99"),
    ("blocked.max", "blocked, longest"),
    ("visible.p50", "visible after, p50"),
    ("visible.p99", "visible after, p99"),
    ("jitter.p99", "frame late by, p99"),
    ("shown", "frames"),
];

/// All tables.
pub const TABLES: &[Table] = &[
    Table { name: "machine-runtime", source: runtime(&["machine"]), columns: MACHINE },
    Table { name: "machine-graphical", source: graphical(&["machine"]), columns: MACHINE },
    Table { name: "round-trip-queues", source: runtime(&["queue/round_trip/*"]), columns: TRIP },
    Table { name: "round-trip-actors", source: runtime(&["actor/round_trip/*"]), columns: TRIP },
    Table { name: "round-trip-bound", source: runtime(&["?actor/round_trip_bound/*"]), columns: TRIP },
    Table {
        name: "one-way",
        source: runtime(ONE_WAY),
        columns: &[
            ("per_message", "a message"),
            ("send", "of it the sender"),
            ("allocations", "allocations"),
        ],
    },
    Table {
        name: "mended",
        source: Source { file: "mended", cases: &["*"] },
        columns: &[
            ("per_message", "a message"),
            ("allocations", "allocations"),
            ("send", "to send one"),
            ("drain", "to take one"),
            ("trip.p50", "there and back, p50"),
        ],
    },
    Table {
        name: "burst",
        source: runtime(&["queue/burst", "actor/burst"]),
        columns: &[("send", "to send one"), ("drain", "to take one")],
    },
    Table {
        name: "late",
        source: runtime(&["queue/late/*", "actor/late/*"]),
        columns: &[
            ("delay.p50", "late by, p50"),
            ("delay.p99", "p99"),
            ("delay.p99.9", "p99.9"),
            ("sender_late.p99", "the sender itself, p99"),
        ],
    },
    Table {
        name: "chain",
        source: runtime(&["actor/chain/*"]),
        columns: &[("per_message", "a message"), ("allocations", "allocations")],
    },
    Table {
        name: "creation",
        source: runtime(&["actor/creation"]),
        columns: &[
            ("make", "to make one"),
            ("first_message", "its first message"),
            ("end_with_all", "its end"),
            ("memory", "memory"),
        ],
    },
    Table { name: "spin", source: runtime(&["?own/spin/*"]), columns: TRIP },
    Table {
        name: "addresses",
        source: runtime(&["own/addresses/*"]),
        columns: &[
            ("send", "to send one"),
            ("all_delivered", "until all are there, each"),
            ("longest_queue", "longest queue"),
            ("replaced", "replaced"),
            ("refused", "refused"),
            ("allocations", "allocations"),
        ],
    },
    Table {
        name: "registers",
        source: runtime(&["own/registers"]),
        columns: &[("register", "to register one"), ("remove", "to remove it")],
    },
    Table {
        name: "observed",
        source: runtime(&["own/observed"]),
        columns: &[("per_message", "a message"), ("allocations", "allocations")],
    },
    Table {
        name: "idle",
        source: runtime(&["own/idle_iteration"]),
        columns: &[("iteration", "an iteration")],
    },
    Table {
        name: "savina",
        source: runtime(&["savina/*"]),
        columns: &[("total", "time"), ("per_message", "a message")],
    },
    Table {
        name: "blocked",
        source: graphical(DRAG),
        columns: &[
            ("blocked.p50", "blocked, p50"),
            ("blocked.p90", "p90"),
            ("blocked.p99", "p99"),
            ("blocked.p99.9", "p99.9"),
            ("blocked.max", "longest"),
        ],
    },
    Table {
        name: "visible",
        source: graphical(DRAG),
        columns: &[
            ("visible.p50", "visible after, p50"),
            ("visible.p99", "p99"),
            ("visible.max", "longest"),
            ("frame.p50", "frame, p50"),
            ("frame.p99", "p99"),
            ("jitter.p99", "frame late by, p99"),
            ("missed", "frames missed"),
        ],
    },
    Table {
        name: "means",
        source: graphical(DRAG),
        columns: &[
            ("memory", "memory at most"),
            ("cores", "cores in use"),
            ("backlog", "edits waiting at most"),
        ],
    },
    Table {
        name: "flat-out",
        source: graphical(FLOODS),
        columns: &[
            ("posted", "edits"),
            ("visible.p50", "visible after, p50"),
            ("visible.p99", "p99"),
            ("backlog", "edits waiting at most"),
            ("blocked.p99", "blocked, p99"),
        ],
    },
    Table { name: "rates", source: graphical(RATES), columns: EDITING },
    Table { name: "takes", source: graphical(TAKES), columns: EDITING },
    Table { name: "sizes", source: graphical(SIZES), columns: EDITING },
    Table { name: "stalls", source: graphical(STALLS), columns: EDITING },
    Table { name: "threads", source: graphical(THREADS), columns: EDITING },
    Table {
        name: "questions",
        source: graphical(QUESTIONS),
        columns: &[
            ("answer.p50", "answer after, p50"),
            ("answer.p99", "p99"),
            ("answer.max", "longest"),
            ("asking.p50", "blocked by asking, p50"),
            ("asking.p99", "p99"),
        ],
    },
];

/// All charts.
pub const CHARTS: &[Chart] = &[
    Chart {
        name: "round-trip-queues",
        title: "How long does it take to ask another thread and have the answer, by queue?",
        source: runtime(&["queue/round_trip/*"]),
        kind: Kind::Rows(TRIP_MARKS, Scale::Log),
    },
    Chart {
        name: "round-trip-actors",
        title: "How long does it take to ask an actor and have the answer?",
        source: runtime(&["actor/round_trip/*"]),
        kind: Kind::Rows(TRIP_MARKS, Scale::Log),
    },
    Chart {
        name: "one-way",
        title: "What does a message of 64 bytes cost when nobody waits for an answer?",
        source: runtime(ONE_WAY),
        kind: Kind::Rows(&[("per_message", "time a message")], Scale::Linear),
    },
    Chart {
        name: "chain",
        title: "What does a message cost between actors that share a thread?",
        source: runtime(&["actor/chain/*"]),
        kind: Kind::Rows(&[("per_message", "time a message")], Scale::Linear),
    },
    Chart {
        name: "spin",
        title: "What does looking before sleeping gain, and what does it cost where there is one core?",
        source: runtime(&["?own/spin/*"]),
        kind: Kind::Rows(TRIP_MARKS, Scale::Log),
    },
    Chart {
        name: "savina-1-thread",
        title: "How do actor systems compare over the Savina suite, on one thread?",
        source: runtime(&["savina/*"]),
        kind: Kind::Ratios(
            "total",
            "dragonfly 1 thread",
            &["actix 1 thread", "kameo 1 thread", "ractor 1 thread", "stakker"],
        ),
    },
    Chart {
        name: "savina-2-threads",
        title: "How do actor systems compare over the Savina suite, on two threads or one for each actor?",
        source: runtime(&["savina/*"]),
        kind: Kind::Ratios(
            "total",
            "dragonfly 2 threads",
            &["actix 2 threads", "kameo 2 threads", "ractor 2 threads", "tonari-actor"],
        ),
    },
    Chart {
        name: "blocked",
        title: "How long does an edit keep the main thread from its window?",
        source: graphical(DRAG),
        kind: Kind::Curves("blocked", TELLING),
    },
    Chart {
        name: "visible",
        title: "How long does an edit take until a frame shows it?",
        source: graphical(DRAG),
        kind: Kind::Curves("visible", TELLING),
    },
    Chart {
        name: "jitter",
        title: "How much too late is a frame?",
        source: graphical(DRAG),
        kind: Kind::Curves("jitter", TELLING),
    },
    Chart {
        name: "missed",
        title: "How many frames are missed?",
        source: graphical(DRAG),
        kind: Kind::Rows(&[("missed", "frames missed in a run")], Scale::Linear),
    },
    Chart {
        name: "questions",
        title: "How long does it take to ask the document something and have the answer?",
        source: graphical(QUESTIONS),
        kind: Kind::Rows(
            &[("answer.p50", "p50"), ("answer.p99", "p99"), ("answer.p99.9", "p99.9")],
            Scale::Log,
        ),
    },
    Chart {
        name: "memory",
        title: "How much memory does each way take at most?",
        source: graphical(DRAG),
        kind: Kind::Rows(&[("memory", "memory")], Scale::Linear),
    },
    Chart {
        name: "cores",
        title: "How much of the processor does each way take?",
        source: graphical(DRAG),
        kind: Kind::Rows(&[("cores", "cores in use, on average")], Scale::Linear),
    },
];
