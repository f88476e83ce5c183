//! Tests of the document crate, one module for each guarantee.

mod beside;
mod compared_file;
mod contacts;
mod document_ended;
mod document_writer;
mod documents;
mod edit_cost;
mod edits;
mod events;
mod export;
mod fox_edits;
mod held_feet;
mod image_memory;
mod images;
mod import_options;
mod import_takes;
mod import_vrma;
mod inbetween;
mod journal_later;
mod keeping;
mod layers;
mod limits;
mod many_bones;
mod merged_keys;
mod offset_keys;
mod old_journals;
mod pose_library;
mod rebase;
mod reference_source;
mod reload;
mod root_bone;
mod savable;
mod save_and_open;
mod save_in_background;
mod shape_key_edits;
mod shape_keys;
mod sound;
mod stretch;
mod take_check;
mod take_tools;
mod tangents;
mod travel;
mod turns_and_cycles;
mod undo;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
