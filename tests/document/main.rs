//! Tests of the document crate, one module for each guarantee.

mod document_ended;
mod document_writer;
mod documents;
mod edit_cost;
mod edits;
mod image_memory;
mod images;
mod keeping;
mod many_bones;
mod old_journals;
mod save_and_open;
mod undo;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
