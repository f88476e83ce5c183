//! The two-dimensional side of the window: input goes to egui and the panels, drawings go to the graphics thread.
//!
//! It exists before the device and before any model, so the program answers at once (T-093).

use super::accessibility_trace::AccessibilityTrace;
use super::pointer_place;
use super::reference_loader::{ReferenceAnswer, ReferenceLoader};
use super::scene_sounds::{SceneSoundAnswer, SceneSoundLoader};
use super::scene_thumbnails::ThumbnailLoader;
use super::sound_loader::{SoundAnswer, SoundLoader};
use super::sound_player::{SamplesAnswer, SoundPlayer};
use super::state_trace::StateTrace;
use super::store::{self, Store};
use crate::panels::commands;
use crate::panels::marks;
use crate::panels::prompts::{Overlay, Question};
use crate::panels::settings::{ThemeChoice, WindowSettings};
use crate::panels::status::MessageSeverity;
use crate::panels::{Desk, Effect, FileAction, Request, Settings, State, style};
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::BoneSelection;
use dragonfly_document::edit::Edit;
use dragonfly_document::{DocumentMessage, FaultInjection, FaultPoint};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::{GraphicsHandle, PanelsFrame, Thumbnail};
use dragonfly_runtime::{Address, Context, Worker};
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::event::{InnerSizeWriter, WindowEvent};
use winit::window::{Fullscreen, Window};

/// Minimum time between two drawings of the panels, however fast the mouse reports.
const FASTEST: Duration = Duration::from_millis(8);

/// Window, egui, panels and their state.
pub struct Interface {
    window: Arc<Window>,
    /// Size of the window as it was reported last, physical pixels. Not asked for: winit panics when it asks an X server
    /// for the size of a window that another program has destroyed.
    size: [u32; 2],
    /// Start of the time that egui counts.
    started: Instant,
    egui: egui_winit::State,
    desk: Desk,
    /// State of the panels.
    pub state: State,
    /// Effects that the panels asked for and that only the run-time can carry out.
    pub effects: Vec<Effect>,
    /// Whether a file dialog of the system is open; a second one is not opened.
    pub(super) asking: bool,
    /// The window's title.
    title: String,
    /// Edits that are applied once the first model is open.
    pub(super) edits: Vec<Edit>,
    graphics: Option<GraphicsHandle>,
    store: Store,
    saved: Settings,
    /// Physical pixels per point, as reported by the desktop. The scale of the window itself is late: winit on
    /// X11 reports a change, but continues to return the old scale.
    desktop_scale: f64,
    /// When the panels are to be drawn next.
    due: Option<Instant>,
    drawn: Instant,
    accepts_input: bool,
    occluded: bool,
    /// Whether the size of the window changed since the settings were stored.
    is_resized: bool,
    /// The part of the program that failed too often, so that the program ends.
    pub(super) given_up: Option<String>,
    /// Faults that a test injects.
    pub(super) faults: FaultInjection,
    state_trace: StateTrace,
    accessibility_trace: AccessibilityTrace,
    reference: ReferenceLoader,
    sound: SoundLoader,
    scene_sounds: SceneSoundLoader,
    sound_player: SoundPlayer,
    thumbnails: ThumbnailLoader,
}

impl Interface {
    /// Creates the interface for `window`, which must not be visible yet; `egui` has its accessibility bridge.
    pub(super) fn new(
        window: Arc<Window>,
        egui: egui_winit::State,
        settings: Settings,
        store: Store,
    ) -> Self {
        let now = Instant::now();
        let desk = Desk::new(&store.read(store::LAYOUT));
        style::install(egui.egui_ctx());
        let saved = settings.clone();
        let mut state = State::new(settings, now);
        state.side_files().read_marks(&store.read(marks::FILE));
        state.set_usual_pose_folder(store.poses());
        Self {
            desktop_scale: window.scale_factor(),
            size: window.inner_size().into(),
            started: now,
            window,
            egui,
            desk,
            state,
            effects: Vec::new(),
            asking: false,
            title: String::new(),
            edits: Vec::new(),
            graphics: None,
            store,
            saved,
            due: Some(now),
            drawn: now - FASTEST,
            accepts_input: true,
            occluded: false,
            is_resized: false,
            given_up: None,
            faults: FaultInjection::default(),
            state_trace: StateTrace::default(),
            accessibility_trace: AccessibilityTrace::default(),
            reference: ReferenceLoader::default(),
            sound: SoundLoader::default(),
            scene_sounds: SceneSoundLoader::default(),
            sound_player: SoundPlayer::default(),
            thumbnails: ThumbnailLoader::default(),
        }
    }

    /// Sets the graphics thread to which drawings go.
    pub(super) fn set_graphics(&mut self, graphics: GraphicsHandle) {
        graphics.resize(self.window_size());
        self.graphics = Some(graphics);
    }

    /// Returns the effects that the panels asked for. Before an effect that would cut a drag in two, inserts the
    /// one that cancels the drag.
    pub(super) fn take_effects(&mut self) -> Vec<Effect> {
        let mut passed = Vec::with_capacity(self.effects.len());
        for effect in self.effects.drain(..) {
            self.state.let_through(effect, &mut |effect| passed.push(effect));
        }
        passed
    }

    /// Reports a part of the program that failed; with `for_good` the program ends.
    pub(super) fn failed(&mut self, text: String, for_good: bool) {
        if for_good {
            self.given_up.get_or_insert_with(|| text.clone());
        }
        self.state.say(MessageSeverity::Error, format!("{text}. Nothing that you did is lost"));
        self.redraw();
    }

    /// Returns the number of steps done in the document; 0 before the first one is open.
    fn steps(&self) -> usize {
        self.state.read().view.map_or(0, |view| view.history.done)
    }

    /// Draws the panels soon.
    pub fn redraw(&mut self) {
        self.redraw_at(Instant::now());
    }

    fn redraw_at(&mut self, when: Instant) {
        self.due = Some(self.due.map_or(when, |due| due.min(when)));
    }

    /// Returns the size of the window, physical pixels.
    pub fn window_size(&self) -> [u32; 2] {
        if self.occluded { [0, 0] } else { self.size }
    }

    /// Returns the number of physical pixels per point.
    pub fn pixels_per_point(&self) -> f32 {
        egui_winit::pixels_per_point(self.egui.egui_ctx(), &self.window)
    }

    /// Returns the zoom of egui: the scale that the user chose, and the part of the desktop's scale that the window does not
    /// report yet.
    fn zoom(&self) -> f32 {
        self.state.read().settings.scale * (self.desktop_scale / self.window.scale_factor()) as f32
    }

    /// Sets the desktop's scale. If it has not changed, keeps the size of the window, which winit would enlarge a
    /// second time.
    fn set_desktop_scale(&mut self, scale: f64, size: &InnerSizeWriter) {
        if self.desktop_scale == scale {
            // Fails only when the size is already set.
            let _ = size.clone().request_inner_size(self.size.into());
        }
        self.desktop_scale = scale;
    }

    /// Returns whether the dark theme is shown.
    pub fn is_dark(&self) -> bool {
        self.egui.egui_ctx().theme() == egui::Theme::Dark
    }

    /// Sets the longest side of a texture that the device supports.
    pub fn set_max_texture_side(&mut self, side: u32) {
        self.egui.set_max_texture_side(side as usize);
    }

    /// Sets the window's title.
    pub(super) fn set_title(&mut self, title: &str) {
        if title != self.title {
            self.window.set_title(title);
            title.clone_into(&mut self.title);
        }
    }

    /// Switches between the whole screen and a window.
    pub fn toggle_full_screen(&mut self) {
        let full = self.state.window_mut().toggle_full_screen().then_some(Fullscreen::Borderless(None));
        self.window.set_fullscreen(full);
    }

    /// Puts a text into the clipboard.
    pub fn copy(&mut self, text: String) {
        self.egui.set_clipboard_text(text);
    }

    /// Returns the text in the clipboard; empty where there is none.
    pub fn clipboard(&mut self) -> String {
        self.egui.clipboard_text().unwrap_or_default()
    }

    /// Shows or hides a panel.
    pub fn toggle_panel(&mut self, id: &str) {
        self.desk.toggle_panel(id);
    }

    /// Shows a panel, in front of those in the same place.
    pub fn show_panel(&mut self, id: &str) {
        self.desk.show_panel(id);
    }

    /// Moves every panel back to its first place.
    pub fn reset_layout(&mut self) {
        self.desk.reset_layout();
    }

    /// Handles an event of the window. Returns whether the viewport tools used it: then its effects are flushed without waiting
    /// for the panels.
    pub(super) fn window_event(&mut self, event: &WindowEvent) -> bool {
        if !self.accepts_input {
            return false;
        }
        self.faults.reach(FaultPoint::Input(self.steps()));
        let before = self.egui.egui_input().events.len();
        let response = self.egui.on_window_event(&self.window, event);
        if let WindowEvent::DroppedFile(_) = event {
            self.find_pointer();
        }
        if let WindowEvent::ScaleFactorChanged { scale_factor, inner_size_writer } = event {
            self.set_desktop_scale(*scale_factor, inner_size_writer);
        }
        if let WindowEvent::Resized(size) = event {
            self.size = (*size).into();
            self.is_resized = true;
        }
        match event {
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => {
                self.tell_size();
                // The old drawing does not fit: draw at once, without the minimum time.
                self.drawn = Instant::now() - FASTEST;
                self.redraw();
            }
            WindowEvent::Occluded(occluded) => {
                self.occluded = *occluded;
                self.tell_size();
                self.redraw();
            }
            WindowEvent::Focused(true) => {
                self.state.scene_sounds().look_again();
                self.effects.push(Effect::File(FileAction::Send(DocumentMessage::LookAtFile)));
                self.redraw();
            }
            WindowEvent::Focused(_) | WindowEvent::ThemeChanged(_) | WindowEvent::RedrawRequested => {
                self.redraw()
            }
            _ if response.repaint => self.redraw(),
            _ => {}
        }
        let context = self.egui.egui_ctx().clone();
        let input = self.egui.egui_input_mut();
        let heard = self.state.feed(&context, input, before, &mut self.effects);
        if heard {
            self.redraw();
        }
        heard
    }

    /// Notes where files were dropped: while another program drags them, the window gets no movements of the pointer.
    fn find_pointer(&mut self) {
        // There is an event for each file.
        if self.egui.egui_input().dropped_files.len() > 1 {
            return;
        }
        let scale = self.pixels_per_point();
        let found = pointer_place::of(&self.window).map(|[x, y]| egui::pos2(x, y) / scale);
        let event = found.map_or(egui::Event::PointerGone, egui::Event::PointerMoved);
        self.egui.egui_input_mut().events.push(event);
    }

    /// Starts the jobs that the reference picture needs at the time shown.
    pub(super) fn update_reference(&mut self, answers: &Address<ReferenceAnswer>) {
        if self.state.read().reference.settings().is_chosen() {
            self.state.set_now(Instant::now());
        }
        self.reference.update(&mut self.state, answers);
    }

    /// Receives an answer of a job about the reference picture.
    pub(super) fn reference_answered(&mut self, answer: ReferenceAnswer) {
        self.reference.receive(&mut self.state, answer);
    }

    /// Starts the jobs that read the sound of a take, if another one was chosen, and those of a scene; plays them along the playhead.
    pub(super) fn update_sound(
        &mut self,
        answers: &Address<SoundAnswer>,
        scene_answers: &Address<SceneSoundAnswer>,
        samples: &Address<SamplesAnswer>,
    ) {
        self.sound.update(&mut self.state, answers);
        self.scene_sounds.update(&mut self.state, scene_answers);
        self.sound_player.update(&mut self.state, samples);
    }

    /// Asks for the next picture of a shot.
    pub(super) fn update_thumbnails(&mut self) {
        let order = self.thumbnails.update(&mut self.state);
        if let Some((graphics, order)) = self.graphics.as_ref().zip(order) {
            graphics.draw_thumbnail(order);
        }
    }

    /// Receives a picture of a shot. Returns whether there is something new to show.
    pub(super) fn thumbnail_drawn(&mut self, thumbnail: Thumbnail) -> bool {
        self.thumbnails.receive(&mut self.state, thumbnail)
    }

    /// Receives the samples of a sound.
    pub(super) fn samples_answered(&mut self, answer: SamplesAnswer) {
        self.sound_player.receive(&mut self.state, answer);
    }

    /// Receives the answer of a job about a sound of a scene.
    pub(super) fn scene_sound_answered(&mut self, answer: SceneSoundAnswer) {
        let message = self.scene_sounds.receive(&mut self.state, answer);
        self.effects.extend(message.map(|message| Effect::File(FileAction::Send(message))));
    }

    /// Receives the answer of a job about the sound.
    pub(super) fn sound_answered(&mut self, answer: SoundAnswer) {
        self.sound.receive(&mut self.state, answer);
    }

    /// Handles an event of the accessibility bridge.
    pub(super) fn accesskit_event(&mut self, event: accesskit_winit::WindowEvent) {
        match event {
            accesskit_winit::WindowEvent::InitialTreeRequested => self.egui.egui_ctx().enable_accesskit(),
            accesskit_winit::WindowEvent::ActionRequested(request) => {
                self.egui.on_accesskit_action_request(request)
            }
            accesskit_winit::WindowEvent::AccessibilityDeactivated => {
                self.egui.egui_ctx().disable_accesskit()
            }
        }
        self.redraw();
    }

    fn tell_size(&self) {
        if let Some(graphics) = &self.graphics {
            graphics.resize(self.window_size());
        }
    }

    /// Stops accepting input, hides the window and stores the settings.
    pub(super) fn close(&mut self) {
        self.accepts_input = false;
        self.window.set_visible(false);
        self.save();
        self.graphics = None;
    }

    /// Notes the size of the window in the settings; that of a maximized, minimized or full-screen window is no size to
    /// return to.
    fn note_size(&mut self) {
        if !std::mem::take(&mut self.is_resized) || self.state.window_mut().is_full_screen() {
            return;
        }
        let maximized = self.window.is_maximized();
        let size = self.size.map(|side| (f64::from(side) / self.desktop_scale) as f32);
        let window = &mut self.state.settings_mut().window;
        window.maximized = maximized;
        if !maximized && size[0] >= WindowSettings::LEAST[0] && size[1] >= WindowSettings::LEAST[1] {
            window.size = size;
        }
    }

    fn save(&mut self) {
        self.note_size();
        if *self.state.read().settings != self.saved {
            self.saved = self.state.read().settings.clone();
            self.keep(store::SETTINGS, &self.saved.to_text());
        }
        if let Some(layout) = self.desk.changed_layout() {
            self.keep(store::LAYOUT, &layout);
        }
        if let Some((name, text)) = self.state.side_files().unsaved_markers() {
            self.keep(&name, &text);
        }
        if let Some(text) = self.state.side_files().unsaved_marks() {
            self.keep(marks::FILE, &text);
        }
    }

    fn keep(&mut self, name: &str, text: &str) {
        if let Err(error) = self.store.write(name, text) {
            self.state.say(MessageSeverity::Warning, format!("The settings could not be saved: {error}"));
        }
    }

    /// Returns the input since the last frame, as `egui_winit` does, which however asks the window for its size.
    fn take_input(&mut self, now: Instant) -> egui::RawInput {
        let size = egui::vec2(self.size[0] as f32, self.size[1] as f32) / self.pixels_per_point();
        let native = self.window.scale_factor() as f32;
        let input = self.egui.egui_input_mut();
        input.time = Some(now.saturating_duration_since(self.started).as_secs_f64());
        // A minimized window may have no size; then the panels keep theirs.
        input.screen_rect =
            (size.min_elem() > 0.0).then(|| egui::Rect::from_min_size(egui::Pos2::ZERO, size));
        input.viewport_id = egui::ViewportId::ROOT;
        input.viewports.entry(egui::ViewportId::ROOT).or_default().native_pixels_per_point = Some(native);
        input.take()
    }

    fn draw(&mut self, now: Instant) {
        let context = self.egui.egui_ctx().clone();
        let zoom = self.zoom();
        if context.zoom_factor() != zoom {
            context.set_zoom_factor(zoom);
        }
        context.set_theme(match self.state.read().settings.theme {
            ThemeChoice::System => egui::ThemePreference::System,
            ThemeChoice::Dark => egui::ThemePreference::Dark,
            ThemeChoice::Light => egui::ThemePreference::Light,
        });
        let mut input = self.take_input(now);
        let tells_more = self.state.prepend_events(&context, &mut input);
        let dropped: Vec<_> = input.dropped_files.iter().map(|file| file.path().to_owned()).collect();
        self.accessibility_trace.listen(&context);
        let mut requests = Vec::new();
        if let Some(name) = self.state.side_files().wanted_markers() {
            let text = self.store.read(&name);
            self.state.side_files().read_markers(&text);
        }
        self.state.begin_frame(now);
        self.effects.extend(self.state.wanted_check());
        let (steps, faults) = (self.steps(), &self.faults);
        let mut passes = 0;
        let (desk, state) = (&mut self.desk, self.state.read());
        let mut mistake = None;
        let output = context.run_ui(input, |ui| {
            // Caught here, so that egui finishes its frame.
            let drawn = catch_unwind(AssertUnwindSafe(|| {
                // egui may run a frame twice; the requests of both runs are carried out. Commands get no keys
                // while a question is shown or something is dragged.
                if state.takes_shortcuts() {
                    requests.extend(commands::pressed(ui.ctx()).into_iter().map(Request::Command));
                }
                desk.show(ui, &state, &mut requests);
                // Reached once per frame, even if egui runs it twice.
                passes += 1;
                if passes == 1 {
                    faults.reach(FaultPoint::Panels(steps));
                }
            }));
            if let Err(panic) = drawn {
                mistake.get_or_insert(panic);
            }
        });
        // Sent before anything else can fail: egui aborts when textures are lost.
        let jobs = context.tessellate(output.shapes, output.pixels_per_point);
        let frame = PanelsFrame {
            size: self.size,
            pixels_per_point: output.pixels_per_point,
            jobs,
            textures: output.textures_delta,
        };
        if let Some(graphics) = &self.graphics {
            graphics.show_panels(frame);
        }
        if let Some(mistake) = mistake {
            // Requests made before the failure are dropped: they may be incomplete.
            self.redraw();
            resume_unwind(mistake);
        }
        self.accessibility_trace.tell(&output.platform_output, output.pixels_per_point);
        self.egui.handle_platform_output(&self.window, output.platform_output);

        let before = Redrawn::of(&self.state);
        self.state.end_frame();
        if !dropped.is_empty() {
            requests.push(Request::Dropped(dropped));
        }
        for request in requests {
            let effect = self.state.execute(request);
            self.effects.extend(effect);
        }
        let open = self.state.read().dragging.open();
        let is_typing = self.state.read().scene_editing.is_typing(open);
        if open.is_some() && !is_typing && !context.input(|input| input.pointer.any_down()) {
            self.effects.push(Effect::ReleaseDrag);
        }
        // The next drawing shows what the requests have changed.
        let changed = tells_more || before != Redrawn::of(&self.state);

        self.state_trace.tell(&self.state.read());
        self.drawn = now;
        self.due = None;
        let egui_wants =
            output.viewport_output.get(&egui::ViewportId::ROOT).map(|output| output.repaint_delay);
        let wanted = [changed.then_some(Duration::ZERO), egui_wants, self.state.next_display()];
        if let Some(when) = wanted.into_iter().flatten().min().and_then(|delay| now.checked_add(delay)) {
            self.redraw_at(when);
        }
    }
}

/// The part of the state that requires another drawing if a request has changed it.
#[derive(PartialEq)]
struct Redrawn {
    playback: PlaybackClock,
    selection: BoneSelection,
    highlighted: Option<BoneIndex>,
    settings: Settings,
    overlay: Option<Overlay>,
    viewport: egui::Rect,
    camera: Camera,
    things: Vec<Box<str>>,
    questions: VecDeque<(u64, Question)>,
}

impl Redrawn {
    fn of(state: &State) -> Self {
        let panels = state.read();
        Self {
            playback: panels.playback,
            selection: panels.selection.clone(),
            highlighted: panels.highlighted(),
            settings: panels.settings.clone(),
            overlay: panels.overlay,
            viewport: panels.viewport,
            camera: panels.camera,
            things: panels.scene_editing.things().to_vec(),
            questions: panels.prompts.questions().clone(),
        }
    }
}

impl Worker for Interface {
    /// Draws the panels when they are due.
    fn update(&mut self, main: &mut Context) -> bool {
        if !self.accepts_input || self.graphics.is_none() {
            return true;
        }
        if self.occluded {
            self.due = None;
            return true;
        }
        if let Some(due) = self.due {
            let now = Instant::now();
            let due = due.max(self.drawn + FASTEST);
            if due <= now {
                self.draw(now);
                if self.due.is_none() {
                    self.save();
                }
            }
        }
        if let Some(due) = self.due {
            main.wake_at(due.max(self.drawn + FASTEST));
        }
        true
    }
}
