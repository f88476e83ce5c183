//! What the runtime promises, one module a promise.

mod cast;

mod addresses;
mod alarms_and_sleep;
mod iteration;
mod jobs;
mod messages_at_rest;
mod no_locks;
mod overload;
mod panics;
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
