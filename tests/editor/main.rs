//! Promises, one module each.

mod arm;
mod camera;
mod command_line;
mod commands;
mod device_loss;
mod fixture;
mod folder;
mod no_allocation;
mod panels;
mod picking;
mod picture;
mod program;
mod screen;
mod shaders;
mod studio;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
