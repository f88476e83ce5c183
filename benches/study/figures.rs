//! The tables and charts of the study, and the part of the raw data that each shows. A new one needs a line here and a
//! pair of comments in `README.md`.

use crate::chart::AxisScale;
use crate::table::TableColumn;

/// A table of the raw data in `README.md`, between `<!-- table: name -->` and `<!-- end -->`.
pub struct TableSpec {
    /// Name in the comments.
    pub name: &'static str,
    /// The rows that it shows.
    pub source: DataSource,
    /// Metric and heading of each column.
    pub columns: &'static [TableColumn],
}

/// A chart of the raw data, `results/name.svg`, shown between `<!-- chart: name -->` and `<!-- end -->`.
pub struct ChartSpec {
    /// Name in the comments and of the file.
    pub name: &'static str,
    /// Title in the picture.
    pub title: &'static str,
    /// The rows that it shows.
    pub source: DataSource,
    /// Kind of the drawing.
    pub kind: ChartKind,
}

/// A file of raw data, and the cases that are taken from it.
#[derive(Clone, Copy)]
pub struct DataSource {
    /// Name of the file `results/file.csv`, without its extension.
    pub file: &'static str,
    /// The cases. A name that ends in `*` matches all cases with this prefix. A name that starts with `?` is a case that
    /// cannot be measured on every machine; if there are only such cases and no data, nothing is shown.
    pub cases: &'static [&'static str],
}

/// How a chart is drawn.
pub enum ChartKind {
    /// A row for each variant: [`rows`](crate::chart::rows).
    Rows(&'static [TableColumn], AxisScale),
    /// Percentiles of a distribution in one case, for the given variants: [`curves`](crate::chart::curves).
    Curves(&'static str, &'static [&'static str]),
    /// A metric, the variant that it is divided by, and the other variants: [`ratios`](crate::chart::ratios).
    Ratios(&'static str, &'static str, &'static [&'static str]),
}

/// The files of raw data. The first two are written by the benches with these names; the third contains two runs of the
/// first, before and after the changes that its results led to.
pub const FILES: [&str; 3] = ["runtime", "graphical", "optimized"];

const fn runtime(cases: &'static [&'static str]) -> DataSource {
    DataSource { file: "runtime", cases }
}

const fn graphical(cases: &'static [&'static str]) -> DataSource {
    DataSource { file: "graphical", cases }
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

/// The variants that are drawn. The others of each kind have similar values and are in the tables.
const DRAWN: &[&str] = &[
    "messages",
    "messages, newest",
    "messages, batched",
    "mutex, frame",
    "mutex, poses",
    "mutex, cow",
    "arcswap, cow",
    "triple buffer",
];

// The cases in which queues and actors are compared.
const ONE_WAY: &[&str] = &[
    "queue/one_way/1_producer/64*",
    "queue/one_way/2_producers/64*",
    "actor/one_way/1_producer/64*",
    "actor/one_way/2_producers/64*",
];

const TRIP: &[TableColumn] =
    &[("trip.p50", "p50"), ("trip.p99", "p99"), ("trip.p99.9", "p99.9"), ("trip.max", "longest")];
const TRIP_MARKS: &[TableColumn] = &[("trip.p50", "p50"), ("trip.p99", "p99"), ("trip.p99.9", "p99.9")];
const MACHINE: &[TableColumn] = &[
    ("cores", "cores"),
    ("clock.cost", "reading the clock"),
    ("clock.step", "step of the clock"),
    ("two_wake_ups.p50", "two wake-ups, p50"),
    ("two_wake_ups.p99", "p99"),
    ("overshoot_1ms.p50", "lateness of a sleep of 1 ms, p50"),
    ("overshoot_1ms.p99", "p99"),
];
/// Columns for metrics that every case of `graphical` has.
const EDITING: &[TableColumn] = &[
    ("blocked.p50", "blocked, p50"),
    ("blocked.p99", "blocked, p99"),
    ("blocked.max", "blocked, longest"),
    ("visible.p50", "visible after, p50"),
    ("visible.p99", "visible after, p99"),
    ("jitter.p99", "frame lateness, p99"),
    ("shown", "frames"),
];

/// All tables.
pub const TABLES: &[TableSpec] = &[
    TableSpec { name: "machine-runtime", source: runtime(&["machine"]), columns: MACHINE },
    TableSpec { name: "machine-graphical", source: graphical(&["machine"]), columns: MACHINE },
    TableSpec { name: "round-trip-queues", source: runtime(&["queue/round_trip/*"]), columns: TRIP },
    TableSpec { name: "round-trip-actors", source: runtime(&["actor/round_trip/*"]), columns: TRIP },
    TableSpec { name: "round-trip-bound", source: runtime(&["?actor/round_trip_bound/*"]), columns: TRIP },
    TableSpec {
        name: "one-way",
        source: runtime(ONE_WAY),
        columns: &[("per_message", "per message"), ("send", "of that, send"), ("allocations", "allocations")],
    },
    TableSpec {
        name: "optimized",
        source: DataSource { file: "optimized", cases: &["*"] },
        columns: &[
            ("per_message", "per message"),
            ("allocations", "allocations"),
            ("send", "send"),
            ("drain", "receive"),
            ("trip.p50", "round trip, p50"),
        ],
    },
    TableSpec {
        name: "burst",
        source: runtime(&["queue/burst", "actor/burst"]),
        columns: &[("send", "send"), ("drain", "receive")],
    },
    TableSpec {
        name: "late",
        source: runtime(&["queue/late/*", "actor/late/*"]),
        columns: &[
            ("delay.p50", "delay, p50"),
            ("delay.p99", "p99"),
            ("delay.p99.9", "p99.9"),
            ("sender_late.p99", "lateness of the sender, p99"),
        ],
    },
    TableSpec {
        name: "chain",
        source: runtime(&["actor/chain/*"]),
        columns: &[("per_message", "per message"), ("allocations", "allocations")],
    },
    TableSpec {
        name: "creation",
        source: runtime(&["actor/creation"]),
        columns: &[
            ("make", "create"),
            ("first_message", "first message"),
            ("end_with_all", "destroy"),
            ("memory", "memory"),
        ],
    },
    TableSpec { name: "spin", source: runtime(&["?own/spin/*"]), columns: TRIP },
    TableSpec {
        name: "addresses",
        source: runtime(&["own/addresses/*"]),
        columns: &[
            ("send", "send"),
            ("all_delivered", "until all are delivered, per message"),
            ("longest_queue", "longest queue"),
            ("replaced", "replaced"),
            ("refused", "refused"),
            ("allocations", "allocations"),
        ],
    },
    TableSpec {
        name: "registers",
        source: runtime(&["own/registers"]),
        columns: &[("register", "register"), ("remove", "remove")],
    },
    TableSpec {
        name: "observed",
        source: runtime(&["own/observed"]),
        columns: &[("per_message", "per message"), ("allocations", "allocations")],
    },
    TableSpec {
        name: "idle",
        source: runtime(&["own/idle_iteration"]),
        columns: &[("iteration", "per iteration")],
    },
    TableSpec {
        name: "savina",
        source: runtime(&["savina/*"]),
        columns: &[("total", "time"), ("per_message", "per message")],
    },
    TableSpec {
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
    TableSpec {
        name: "visible",
        source: graphical(DRAG),
        columns: &[
            ("visible.p50", "visible after, p50"),
            ("visible.p99", "p99"),
            ("visible.max", "longest"),
            ("frame.p50", "frame, p50"),
            ("frame.p99", "p99"),
            ("jitter.p99", "frame lateness, p99"),
            ("missed", "frames missed"),
        ],
    },
    TableSpec {
        name: "means",
        source: graphical(DRAG),
        columns: &[
            ("memory", "peak memory"),
            ("cores", "cores in use"),
            ("backlog", "queued edits, maximum"),
        ],
    },
    TableSpec {
        name: "flat-out",
        source: graphical(FLOODS),
        columns: &[
            ("posted", "edits"),
            ("visible.p50", "visible after, p50"),
            ("visible.p99", "p99"),
            ("backlog", "queued edits, maximum"),
            ("blocked.p99", "blocked, p99"),
        ],
    },
    TableSpec { name: "rates", source: graphical(RATES), columns: EDITING },
    TableSpec { name: "takes", source: graphical(TAKES), columns: EDITING },
    TableSpec { name: "sizes", source: graphical(SIZES), columns: EDITING },
    TableSpec { name: "stalls", source: graphical(STALLS), columns: EDITING },
    TableSpec { name: "threads", source: graphical(THREADS), columns: EDITING },
    TableSpec {
        name: "questions",
        source: graphical(QUESTIONS),
        columns: &[
            ("answer.p50", "answer after, p50"),
            ("answer.p99", "p99"),
            ("answer.max", "longest"),
            ("asking.p50", "blocked by the question, p50"),
            ("asking.p99", "p99"),
        ],
    },
];

/// All charts.
pub const CHARTS: &[ChartSpec] = &[
    ChartSpec {
        name: "round-trip-queues",
        title: "Round trip to another thread, by queue",
        source: runtime(&["queue/round_trip/*"]),
        kind: ChartKind::Rows(TRIP_MARKS, AxisScale::Log),
    },
    ChartSpec {
        name: "round-trip-actors",
        title: "Round trip to an actor",
        source: runtime(&["actor/round_trip/*"]),
        kind: ChartKind::Rows(TRIP_MARKS, AxisScale::Log),
    },
    ChartSpec {
        name: "one-way",
        title: "Cost of a message of 64 bytes without an answer",
        source: runtime(ONE_WAY),
        kind: ChartKind::Rows(&[("per_message", "time per message")], AxisScale::Linear),
    },
    ChartSpec {
        name: "chain",
        title: "Cost of a message between actors in one thread",
        source: runtime(&["actor/chain/*"]),
        kind: ChartKind::Rows(&[("per_message", "time per message")], AxisScale::Linear),
    },
    ChartSpec {
        name: "spin",
        title: "Round trip with spinning before sleeping, on two cores and on one",
        source: runtime(&["?own/spin/*"]),
        kind: ChartKind::Rows(TRIP_MARKS, AxisScale::Log),
    },
    ChartSpec {
        name: "savina-1-thread",
        title: "Savina suite, actor systems on one thread",
        source: runtime(&["savina/*"]),
        kind: ChartKind::Ratios(
            "total",
            "dragonfly 1 thread",
            &["actix 1 thread", "kameo 1 thread", "ractor 1 thread", "stakker"],
        ),
    },
    ChartSpec {
        name: "savina-2-threads",
        title: "Savina suite, actor systems on two threads or one for each actor",
        source: runtime(&["savina/*"]),
        kind: ChartKind::Ratios(
            "total",
            "dragonfly 2 threads",
            &["actix 2 threads", "kameo 2 threads", "ractor 2 threads", "tonari-actor"],
        ),
    },
    ChartSpec {
        name: "blocked",
        title: "Time for which an edit blocks the main thread",
        source: graphical(DRAG),
        kind: ChartKind::Curves("blocked", DRAWN),
    },
    ChartSpec {
        name: "visible",
        title: "Time from an edit to the frame that shows it",
        source: graphical(DRAG),
        kind: ChartKind::Curves("visible", DRAWN),
    },
    ChartSpec {
        name: "jitter",
        title: "Lateness of frames",
        source: graphical(DRAG),
        kind: ChartKind::Curves("jitter", DRAWN),
    },
    ChartSpec {
        name: "missed",
        title: "Missed frames",
        source: graphical(DRAG),
        kind: ChartKind::Rows(&[("missed", "missed frames per run")], AxisScale::Linear),
    },
    ChartSpec {
        name: "questions",
        title: "Round trip of a question to the document",
        source: graphical(QUESTIONS),
        kind: ChartKind::Rows(
            &[("answer.p50", "p50"), ("answer.p99", "p99"), ("answer.p99.9", "p99.9")],
            AxisScale::Log,
        ),
    },
    ChartSpec {
        name: "memory",
        title: "Peak memory",
        source: graphical(DRAG),
        kind: ChartKind::Rows(&[("memory", "memory")], AxisScale::Linear),
    },
    ChartSpec {
        name: "cores",
        title: "CPU cores in use",
        source: graphical(DRAG),
        kind: ChartKind::Rows(&[("cores", "cores in use, on average")], AxisScale::Linear),
    },
];
