//! Tests of the store crate, one module for each guarantee.

mod growing;
mod journal;
mod journal_damage;
mod journal_faults;
mod journal_kill;
mod journal_scenarios;
mod journal_writer;
mod store_faults;
mod store_power;
mod store_save;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
