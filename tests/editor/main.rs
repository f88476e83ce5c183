//! Promises, one module each.

mod arm;
mod camera;
mod command_line;
mod commands;
mod complaints;
mod device_loss;
mod documents;
mod drag;
mod edit_command;
mod edits;
mod explain;
mod faults;
mod fixture;
mod fixture_layer;
mod folder;
mod graphics_thread;
mod hover;
mod images;
mod life;
mod made;
mod made_take;
mod manager;
mod no_allocation;
mod panels;
mod picking;
mod picture;
mod playback;
mod portal;
mod program;
mod ruler;
mod screen;
mod settings;
mod shaders;
mod skinning_on_device;
mod studio;
mod surfaces;
mod viewport_control;
mod window;
mod window_dialog;
mod window_drop;
mod window_full_screen;
mod window_scale;
mod wire;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
