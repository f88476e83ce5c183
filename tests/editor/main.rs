//! Promises, one module each.

mod arm;
mod camera;
mod device_loss;
mod no_allocation;
mod picking;
mod picture;
mod shaders;
mod studio;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
