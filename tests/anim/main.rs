//! Promises of the crate, one module each.

mod additional_turns;
mod additive;
mod agreement;
mod attachments;
mod bad_files;
mod blending;
mod bombs;
mod bone_bounds;
mod bounds;
mod budget;
mod check;
mod cross_fades;
mod chains;
mod damage;
mod degenerate;
mod degenerate_import;
mod determinism;
mod dfm;
mod doors;
mod examples;
mod fixture;
mod formats;
mod gaze;
mod hostile;
mod joint_limits;
mod masks;
mod ik;
mod motion;
mod hits;
mod hostile;
mod levels;
mod made;
mod poses;
mod retarget;
mod rules;
mod sampling;
mod seeds;
mod skinning;
mod soundness;
mod support;
mod textures;
mod trial;
mod two_takes;
mod uris;

/// Counts what each thread allocates, for the promises that playing allocates nothing.
#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
