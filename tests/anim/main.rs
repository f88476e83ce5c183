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
mod chains;
mod check;
mod compressed;
mod cross_fades;
mod damage;
mod degenerate;
mod degenerate_import;
mod determinism;
mod dfm;
mod docs;
mod doors;
mod examples;
mod explain;
mod fades;
mod fast_layers;
mod fast_path;
mod fixture;
mod formats;
mod gaze;
mod hits;
mod hostile;
mod ik;
mod joint_limits;
mod levels;
mod limited_chains;
mod made;
mod masks;
mod motion;
mod poses;
mod reduce;
mod retarget;
mod rules;
mod sampling;
mod seeds;
mod simd;
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
