//! Drawing with one device for all pictures: that of the processor where there is one, which is the same everywhere.

use crate::workbench::{Window, Workbench};
use dragonfly::panels::{style, theme as style_theme};
use dragonfly_kit::picture::studio::studio;
use dragonfly_kit::skip::{TestNeed, skip};
use dragonfly_picture::DeviceParameters;
use egui::emath::GuiRounding;
use egui::{Pos2, Rect, Theme, Ui, UiBuilder, vec2};
use egui_kittest::Harness;
use egui_kittest::wgpu::default_wgpu_setup;
use egui_wgpu::{RenderState, RendererOptions, WgpuConfiguration, WgpuSetup, WgpuSetupExisting};
use image::RgbaImage;
use std::sync::OnceLock;

/// The device that the pictures of panels are drawn with.
struct PictureDevice {
    setup: WgpuSetupExisting,
    /// Whether the program itself would draw with the processor on this machine.
    program_draws_on_processor: bool,
}

/// Returns the device, the same for all tests; skips the test where there is none.
fn shared() -> Option<&'static PictureDevice> {
    static DEVICE: OnceLock<Option<PictureDevice>> = OnceLock::new();
    let device = DEVICE.get_or_init(create).as_ref();
    if device.is_none() {
        skip(TestNeed::Adapter, "there is no device for pictures");
    }
    device
}

/// Returns the device; skips the test where there is none.
pub(super) fn device() -> Option<WgpuSetup> {
    shared().map(|device| WgpuSetup::Existing(device.setup.clone()))
}

/// Returns whether the program draws with the processor on this machine; skips the test where it cannot draw.
pub(super) fn program_draws_on_processor() -> Option<bool> {
    shared().map(|device| device.program_draws_on_processor)
}

fn create() -> Option<PictureDevice> {
    // The device of the program gives the reason if there is none.
    let program_draws_on_processor = studio()?.stage().device().is_software();
    let mut setup = default_wgpu_setup();
    if let WgpuSetup::CreateNew(new) = &mut setup {
        // The APIs of the program. OpenGL is none of them, and its adapters cannot be dropped in two threads at a time.
        new.instance_descriptor.backends = DeviceParameters::default().backends;
    }
    let instance = pollster::block_on(setup.new_instance());
    let configuration = WgpuConfiguration { wgpu_setup: setup, ..Default::default() };
    let state = RenderState::create(&configuration, &instance, None, RendererOptions::PREDICTABLE);
    let RenderState { adapter, device, queue, .. } =
        pollster::block_on(state).expect("the program has a device");
    let setup = WgpuSetupExisting { instance, adapter, device, queue };
    Some(PictureDevice { setup, program_draws_on_processor })
}

/// Returns the window of a workbench, drawn with the device.
pub(super) fn window(
    bench: Workbench,
    size: egui::Vec2,
    scale: f32,
    theme: Theme,
    device: WgpuSetup,
) -> Window {
    let mut window = Harness::builder()
        .with_size(size)
        .with_pixels_per_point(scale)
        .with_theme(theme)
        .with_max_steps(20)
        .with_render_cursor(false)
        .with_context_setup(style::install)
        .wgpu_setup(device)
        .build_ui_state(over_sky, bench);
    window.run_steps(4);
    window
}

/// Draws the panels in the whole window, as the program does, over the upper color of the background in place of the scene.
/// The harness would leave a margin.
fn over_sky(ui: &mut Ui, bench: &mut Workbench) {
    let whole = ui.ctx().content_rect();
    ui.scope_builder(UiBuilder::new().max_rect(whole), |ui| {
        ui.set_clip_rect(whole);
        ui.painter().rect_filled(whole, 0.0, style_theme::Theme::of(ui).sky[0]);
        bench.frame(ui);
    });
}

/// Draws a part of the window, given in points.
pub(super) fn picture(window: &mut Window, part: Rect) -> RgbaImage {
    let scale = window.ctx.pixels_per_point();
    let mut picture = window.render().unwrap();
    let whole = Rect::from_min_size(Pos2::ZERO, vec2(picture.width() as f32, picture.height() as f32));
    let part = (part * scale).round_to_pixels(1.0).intersect(whole);
    let [x, y, width, height] =
        [part.left(), part.top(), part.width(), part.height()].map(|side| side as u32);
    assert!(width > 0 && height > 0, "an empty part of the window: {part:?}");
    image::imageops::crop(&mut picture, x, y, width, height).to_image()
}
