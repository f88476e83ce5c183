//! The guarantees of the runtime, one module for each.

mod helpers;

mod addresses;
mod alarms_and_sleep;
mod iteration;
mod jobs;
mod no_locks;
mod overload;
mod panics;
mod queue_memory;
mod registers;
mod shutdown;
mod size;
mod stage;
mod stop_and_pause;
mod stress;
mod timer;
mod trace;
mod waking;
mod watchdog;
