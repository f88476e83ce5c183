//! What requests and commands do to the state; what reaches beyond the panels comes back as effects.

use super::commands::{self, Id};
use super::dope;
use super::keys::KeysRequest;
use super::ruler;
use super::saving::Deed;
use super::settings::{IkSettings, SCALES, SPEEDS, ThemeChoice, TimelineSettings};
use super::state::{Effect, Overlay, Request, State};
use super::status::Level;
use dragonfly_document::edit::{Between, Edit, TrimTake};
use dragonfly_document::edit::{Property, ResetTo};
use dragonfly_document::{Change, Source};
use dragonfly_picture::camera::ViewSide;
use dragonfly_picture::playback::Repeat;
use dragonfly_picture::{BoneLook, Shading};

impl State {
    /// Does what a panel asked for.
    pub fn execute(&mut self, request: Request) -> Option<Effect> {
        let said = self.status.said();
        let effect = self.perform(request);
        if let Some(Effect::Change(Change::Edit(
            Edit::TrimTake(TrimTake { from, to, to_start: true, .. }),
            _,
        ))) = effect
        {
            // What played is all there is then, and lies elsewhere; so does the time that is shown.
            self.keys_request(KeysRequest::Range(None));
            self.seek(self.time().clamp(from, to) - from + self.take_bounds().0);
        }
        if matches!(effect, Some(Effect::Change(_))) {
            self.status.keep_last(self.status.said() != said);
        }
        self.bound_playback();
        self.keep_settings();
        self.unlocked(effect?)
    }

    fn perform(&mut self, request: Request) -> Option<Effect> {
        match request {
            Request::Command(id) => return self.command(id),
            Request::Select(bone) => {
                self.keys.has_hand = false;
                self.select(bone);
            }
            Request::SelectBones(bones, choice) => {
                self.keys.has_hand = false;
                self.selection.choose(&bones, choice);
            }
            Request::Hide { bones, hide } => {
                self.cycle.forget();
                self.hidden.set(&bones, hide, &mut self.selection);
            }
            Request::Timeline(request) => return self.keys_request(request),
            Request::Change(change) => return Some(Effect::Change(change)),
            Request::PastePose { text, mirrored } => return self.paste_pose(&text, mirrored),
            Request::Hover(bone) => self.hovered = Some(bone),
            Request::ShowTake(take) => self.show_take(take),
            Request::Seek(time) => self.seek(time),
            Request::Speed(speed) => self.set_speed(speed),
            Request::Repeat(repeat) => self.set_repeat(repeat),
            Request::FrameRate(rate) => self.settings.frame_rate = rate,
            Request::Scale(scale) => self.set_scale(scale),
            Request::Keys(keys) => self.settings.keys = keys,
            Request::Camera(camera) => self.camera = camera,
            Request::Viewport(rect) => self.set_viewport(rect),
            Request::Ghosts(ghosts) => self.settings.hand.ghosts = ghosts.mended(),
            Request::Shields(shields) => self.set_shields(shields),
            Request::Wheel(by) => self.wheel(by),
            Request::Point(pointer) => self.point(pointer),
            Request::Open(source) => return Some(Effect::Open(source)),
            Request::Overlay(overlay) => self.overlay = overlay,
            Request::TogglePanel(id) => return Some(Effect::TogglePanel(id)),
            Request::RenameTake(index) => self.rename_take(index),
            Request::Deed(deed) => return self.answered(deed),
            Request::Dismiss => return self.dismiss(),
            Request::PropertiesLook(look) => self.settings.properties = look,
        }
        None
    }

    /// How keys snap, what is listed and how IK works is found again at the next start.
    fn keep_settings(&mut self) {
        self.settings.hand.ik = IkSettings { on: self.ik.on, length: self.ik.length };
        let (snap, only_selected) = (self.keys.snap, self.keys.only_selected);
        self.settings.timeline = TimelineSettings { snap, only_selected };
    }

    /// A pointer that left the picture points at nothing; bones that are not drawn cannot be drawn brighter.
    fn point(&mut self, pointer: Option<egui::Pos2>) {
        self.pointer = pointer.filter(|_| self.shows_skeleton());
        if self.pointer.is_none() {
            self.pointed = None;
        }
    }

    /// Does a command, or says why it has nothing to do.
    fn command(&mut self, id: Id) -> Option<Effect> {
        let when = commands::get(id).when;
        if !when.holds(self) {
            self.status.say(Level::Info, when.reason());
            return None;
        }
        let look = &mut self.settings.look;
        match id {
            Id::Open => return Some(Effect::OpenDialog),
            Id::OpenPath => self.overlay = Some(Overlay::OpenPath),
            Id::OpenBuiltIn => return Some(Effect::Open(Source::BuiltIn)),
            Id::CancelLoading => return Some(Effect::CancelLoading),
            Id::Save => return self.save_command(),
            Id::SaveAs => return Some(Effect::Deed(Deed::Where { copy: false, then: None })),
            Id::SaveCopy => return Some(Effect::Deed(Deed::Where { copy: true, then: None })),
            Id::Revert => return Some(Effect::Deed(Deed::Revert)),
            Id::WhatWillBeSaved => return Some(Effect::Deed(Deed::Plan(None))),
            Id::ToggleShowChanges => self.settings.show_changes = !self.settings.show_changes,
            Id::UnsavedWork => return Some(Effect::Deed(Deed::Search)),
            Id::Quit => return Some(Effect::Quit),

            Id::Undo => return Some(Effect::Change(Change::Undo)),
            Id::Redo => return Some(Effect::Change(Change::Redo)),

            Id::AutoKey => self.toggle_auto_key(),
            Id::Key => return self.key_here(),
            Id::KeyAllPending => return self.key_pending(),
            Id::DropPending => return self.drop_pending(),
            Id::Copy => return self.copy(),
            Id::CutKeys => return self.cut_keys(),
            Id::CopyKeys => return self.copy_keys(),
            Id::CopyPose => return self.copy_pose(),
            Id::PastePose => return Some(Effect::PastePose { mirrored: false }),
            Id::PasteMirrored => return Some(Effect::PastePose { mirrored: true }),
            Id::ResetPose => return self.reset_pose(&Property::ALL, ResetTo::Original),
            Id::RestTranslation => return self.reset_pose(&[Property::Translation], ResetTo::Rest),
            Id::RestRotation => return self.reset_pose(&[Property::Rotation], ResetTo::Rest),
            Id::RestScale => return self.reset_pose(&[Property::Scale], ResetTo::Rest),
            Id::ResetToRest => return self.reset_pose(&Property::ALL, ResetTo::Rest),
            Id::Pin => self.toggle_pins(),
            Id::FreePins => self.free_pins(),
            Id::BakePins => return self.bake_pins(),
            Id::ToggleIk => self.toggle_ik(),
            Id::LongerIk => self.lengthen_ik(1),
            Id::ShorterIk => self.lengthen_ik(-1),
            Id::IkPole => self.toggle_pole(),
            Id::LookAt => return self.look(),
            Id::MirrorPairs => self.toggle(Overlay::MirrorPairs),

            Id::PlayPause => self.play(1.0),
            Id::PlayBackwards => self.play(-1.0),
            Id::PreviousFrame => self.step_frame(-1),
            Id::NextFrame => self.step_frame(1),
            Id::PreviousKey => self.step_key(false),
            Id::NextKey => self.step_key(true),
            Id::Start => self.seek(self.play_bounds().0),
            Id::End => {
                let (start, length) = self.play_bounds();
                self.seek(start + length);
            }
            Id::BackOneSecond => self.stop_at(self.time() - 1.0),
            Id::ForwardOneSecond => self.stop_at(self.time() + 1.0),
            Id::CycleRepeat => self.set_repeat(match self.playback.repeat {
                Repeat::Loop => Repeat::PingPong,
                Repeat::PingPong => Repeat::Once,
                Repeat::Once => Repeat::Loop,
            }),
            Id::PreviousTake => self.step_take(-1),
            Id::NextTake => self.step_take(1),
            Id::RestPose => self.show_take(None),

            Id::DeleteKeys => return self.delete_keys(),
            Id::DuplicateKeys => return self.duplicate_keys(),
            Id::SelectAllKeys => self.select_all_keys(),
            Id::KeysEarlier => return self.nudge_keys(-1.0),
            Id::KeysLater => return self.nudge_keys(1.0),
            Id::KeysSlower => return self.scale_keys(2.0),
            Id::KeysFaster => return self.scale_keys(0.5),
            Id::KeysReverse => return self.scale_keys(-1.0),
            Id::SnapKeys => return self.snap_keys(),
            Id::ToggleSnap => self.keys.snap = !self.keys.snap,
            Id::RippleOpen => return self.ripple(1.0),
            Id::RippleClose => return self.ripple(-1.0),
            Id::InterpolateStep => return self.interpolate_keys(Between::Step),
            Id::InterpolateLinear => return self.interpolate_keys(Between::Linear),
            Id::InterpolateSpline => return self.interpolate_keys(Between::CubicSpline),
            Id::FitKeys => self.fit_keys(),
            Id::AddMarker => return self.add_marker(),
            Id::PreviousMarker => self.step_marker(false),
            Id::NextMarker => self.step_marker(true),
            Id::RangeOfKeys => self.range_of_keys(),
            Id::RangeFromHere => self.range_end_here(false),
            Id::RangeToHere => self.range_end_here(true),
            Id::RangeWhole => return self.keys_request(KeysRequest::Range(None)),

            Id::ClearSelection if self.keys.drag().is_some() => return self.cancel_keys(),
            Id::NewTake
            | Id::DuplicateTake
            | Id::RenameTake
            | Id::DeleteTake
            | Id::MoveTakeUp
            | Id::MoveTakeDown
            | Id::SplitTake
            | Id::TrimTake
            | Id::RetimeTake
            | Id::ReverseTake => return self.take_command(id),

            Id::ClearSelection => {
                if self.overlay.take().is_none() {
                    self.selection.clear();
                    // Of keys, too: what nobody sees selected is not deleted.
                    self.keys.selection = Default::default();
                }
            }
            Id::SelectParent => self.select_parent(),
            Id::SelectChild => self.select_child(),
            Id::Find => self.find = true,
            Id::SelectAll
            | Id::InvertSelection
            | Id::ExtendParent
            | Id::ExtendChild
            | Id::SelectBranch
            | Id::GrowSelection
            | Id::ShrinkSelection
            | Id::SelectMirror
            | Id::ExtendMirror
            | Id::HideSelected
            | Id::HideOthers
            | Id::MuteBones
            | Id::SoloBones
            | Id::LockBones
            | Id::ShowAll => self.selection_command(id),

            Id::ToolSelect
            | Id::ToolMove
            | Id::ToolRotate
            | Id::ToolScale
            | Id::MoveNow
            | Id::RotateNow
            | Id::ScaleNow
            | Id::NextSpace
            | Id::SpaceLocal
            | Id::SpaceParent
            | Id::SpaceWorld
            | Id::SpaceView
            | Id::PivotIndividual
            | Id::PivotMedian
            | Id::PivotActive
            | Id::ToggleCurl
            | Id::BoxSelect
            | Id::LassoSelect
            | Id::ToggleGhosts
            | Id::TogglePath => return self.tool_command(id),

            Id::FrameSelected => self.frame_selected(),
            Id::FrameAll => self.frame_shown(),
            Id::ViewFront => self.camera.look_from(ViewSide::Front),
            Id::ViewBack => self.camera.look_from(ViewSide::Back),
            Id::ViewRight => self.camera.look_from(ViewSide::Right),
            Id::ViewLeft => self.camera.look_from(ViewSide::Left),
            Id::ViewTop => self.camera.look_from(ViewSide::Top),
            Id::ViewBottom => self.camera.look_from(ViewSide::Bottom),
            Id::ToggleProjection => self.camera.toggle_projection(),

            Id::ToggleGrid => look.grid = !look.grid,
            Id::ToggleSkeleton => look.skeleton = !look.skeleton,
            Id::ToggleXRay => look.bones_in_front = !look.bones_in_front,
            Id::ToggleSurface => look.surface = !look.surface,
            Id::ShadeMaterial => look.shading = Shading::Material,
            Id::ShadeClay => look.shading = Shading::Clay,
            Id::ShadeUnlit => look.shading = Shading::Unlit,
            Id::BonesOctahedra => look.bone_look = BoneLook::Octahedra,
            Id::BonesSticks => look.bone_look = BoneLook::Sticks,
            Id::BonesLines => look.bone_look = BoneLook::Lines,

            Id::ThemeSystem => self.settings.theme = ThemeChoice::System,
            Id::ThemeDark => self.settings.theme = ThemeChoice::Dark,
            Id::ThemeLight => self.settings.theme = ThemeChoice::Light,
            Id::ScaleUp => self.set_scale(self.settings.scale + 0.1),
            Id::ScaleDown => self.set_scale(self.settings.scale - 0.1),
            Id::ScaleReset => self.set_scale(1.0),
            Id::FullScreen => return Some(Effect::FullScreen),
            Id::ResetLayout => return Some(Effect::ResetLayout),
            Id::RetryDevice => return Some(Effect::RetryDevice),

            Id::Palette => self.toggle(Overlay::Palette),
            Id::Shortcuts => self.toggle(Overlay::Shortcuts),
            Id::About => self.toggle(Overlay::About),
        }
        None
    }

    fn toggle(&mut self, overlay: Overlay) {
        self.overlay = if self.overlay == Some(overlay) { None } else { Some(overlay) };
    }

    /// Starts in `direction`, or stops when time already runs that way.
    fn play(&mut self, direction: f32) {
        let speed = self.settings.speed * direction;
        let (now, repeat) = (self.now, self.playback.repeat);
        if self.playback.playing && self.playback.speed == speed {
            // Keys will be made where it stops, and they may want to go to whole frames.
            let time = self.time();
            return self.stop_at(if self.keys.snap { dope::to_frame(time, self) } else { time });
        }
        let (start, length) = self.play_bounds();
        if length <= 0.0 {
            return self.status.say(Level::Info, "All keys are at one time: there is nothing to play");
        }
        let beside = !(start..=start + length).contains(&self.time());
        (self.playback.start, self.playback.length) = (start, length);
        self.playback = self.playback.with(true, speed, repeat, now);
        // What stands beside the take, or arrived at its end, starts again.
        if beside || (repeat == Repeat::Once && self.playback.at_end(now)) {
            let begin = self.playback.start + if direction < 0.0 { self.playback.length } else { 0.0 };
            self.playback = self.playback.seek(begin, now);
        }
    }

    fn seek(&mut self, time: f32) {
        self.playback = self.playback.seek(time, self.now);
        self.bring_into_sight();
    }

    /// Goes to `time` and stays there: who steps wants to look.
    pub(super) fn stop_at(&mut self, time: f32) {
        let (speed, repeat) = (self.playback.speed, self.playback.repeat);
        self.playback = self.playback.with(false, speed, repeat, self.now).seek(time, self.now);
        self.bring_into_sight();
    }

    fn step_frame(&mut self, direction: i64) {
        self.stop_at(ruler::step_frame(self.time(), direction, self.settings.frame_rate));
    }

    fn step_key(&mut self, forward: bool) {
        if let Some(time) = self.key_beside(forward) {
            self.stop_at(time);
        }
    }

    fn step_take(&mut self, direction: isize) {
        let count = self.digest.takes.len() as isize;
        if count > 0 {
            let current =
                self.playback.take.map_or(if direction > 0 { -1 } else { count }, |take| take as isize);
            self.show_take(Some((current + direction).rem_euclid(count) as usize));
        }
    }

    fn set_speed(&mut self, speed: f32) {
        if !speed.is_finite() {
            return;
        }
        self.settings.speed = speed.clamp(*SPEEDS.start(), *SPEEDS.end());
        let signed = self.settings.speed * if self.playback.speed < 0.0 { -1.0 } else { 1.0 };
        let (playing, repeat) = (self.playback.playing, self.playback.repeat);
        self.playback = self.playback.with(playing, signed, repeat, self.now);
    }

    fn set_repeat(&mut self, repeat: Repeat) {
        self.settings.repeat = repeat;
        let (playing, speed) = (self.playback.playing, self.playback.speed);
        self.playback = self.playback.with(playing, speed, repeat, self.now);
    }

    fn set_scale(&mut self, scale: f32) {
        let steps = (scale * 20.0).round() / 20.0;
        self.settings.scale = steps.clamp(*SCALES.start(), *SCALES.end());
    }

    fn set_viewport(&mut self, rect: egui::Rect) {
        if self.viewport != rect {
            self.viewport = rect;
            self.place_hands();
        }
        // The first model may arrive before the first layout; it is placed when its place is known.
        if !self.framed && self.view.is_some() {
            self.frame_model();
            self.framed = true;
        }
    }

    fn set_shields(&mut self, shields: Vec<egui::Rect>) {
        if self.shields != shields {
            self.shields = shields;
            self.place_hands();
        }
    }

    fn select_parent(&mut self) {
        let Some(loaded) = self.loaded() else { return };
        let bones = &loaded.model.animation.skeleton.bones;
        match self.selected() {
            Some(bone) => {
                if let Some(parent) = bones.get(bone as usize).and_then(|bone| bone.parent) {
                    self.select(Some(parent));
                }
            }
            None => {
                let first = (!bones.is_empty()).then_some(0);
                self.select(first);
            }
        }
    }

    fn select_child(&mut self) {
        let Some(loaded) = self.loaded() else { return };
        let child = loaded.model.animation.skeleton.children(self.selected()).next();
        self.select(child.or(self.selected()));
    }
}
