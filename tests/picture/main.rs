//! Tests of the graphics crate, one module for each guarantee.

mod accumulation;
mod between;
mod camera;
mod complaints;
mod contact_shadow;
mod device_loss;
mod draws;
mod ghost_skins;
mod graphics_thread;
mod image_loading;
mod instances;
mod no_allocation;
mod passes;
mod picking;
mod picking_many;
mod picking_scene;
mod picking_skin;
mod picture;
mod playback;
mod reference_picture;
mod samples;
mod scenes;
mod shaders;
mod shadows;
mod skin_once;
mod skinning_on_device;
mod surface_thread;
mod surfaces;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
