//! The editor's run-time: opens models, and passes what the user does to the threads that do it (thesis §3.2.4.5).

use super::base_runtime::{BaseRuntime, Parts};
use super::file_dialog::Answer;
use super::graphics_sync::GraphicsSync;
use super::hover::{Hover, HoverPoint};
use super::interface::Interface;
use super::interface_receiver::interface_address;
use super::model_looker::{self, LookedModels};
use super::options::Options;
use super::reference_loader::ReferenceAnswer;
use super::scene_files::{self, FileJobs, SceneFilesAnswer};
use super::scene_maker::{self, SceneAnswer};
use super::scene_sounds::SceneSoundAnswer;
use super::sound_loader::SoundAnswer;
use super::sound_player::SamplesAnswer;
use super::{file_actions, replies};
use crate::panels::status::MessageSeverity;
use crate::panels::window_status::DeviceStatus;
use dragonfly_document::bones::Choice;
use dragonfly_document::{Document, DocumentHandle, DocumentReply, Setup, Source};
use dragonfly_picture::GraphicsReply;
use dragonfly_runtime::{Address, Context, Outcome, Receiver, Thread};
use dragonfly_store::{Autosave, RealFiles};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time limit for the document to end: its journal must reach the disk, and disks can be slow.
const END: Duration = Duration::from_secs(10);

/// The editor's custom run-time.
pub struct EditorRuntime {
    options: Options,
    quit: Rc<Cell<bool>>,
    running: Option<Running>,
}

/// State of the run-time between [`BaseRuntime::initialize`] and [`BaseRuntime::destroy`].
pub(super) struct Running {
    pub(super) parts: Parts,
    pub(super) document: Option<DocumentHandle>,
    /// Whether the document was asked if the program may end.
    pub(super) leaving: bool,
    replies: Address<DocumentReply>,
    pub(super) answers: Address<Answer>,
    references: Address<ReferenceAnswer>,
    sounds: Address<SoundAnswer>,
    scene_sounds: Address<SceneSoundAnswer>,
    samples: Address<SamplesAnswer>,
    pub(super) scenes: Address<SceneAnswer>,
    pub(super) looked: Address<LookedModels>,
    pub(super) scene_files: Address<SceneFilesAnswer>,
    /// The jobs that look at files for a scene or copy them. They are cancelled when the program ends.
    pub(super) file_jobs: FileJobs,
    graphics_sync: GraphicsSync,
    /// Number of questions sent to the graphics thread.
    pub(super) tickets: u64,
    /// The newest question about a click or a box.
    pub(super) asked: Option<(u64, Asked)>,
    hover: Hover,
}

/// A question about a click or a box.
#[derive(Clone, Copy, Debug)]
pub(super) enum Asked {
    Click(egui::Pos2, Choice),
    Region(Choice),
}

impl EditorRuntime {
    /// Creates a run-time that is inactive until [`BaseRuntime::initialize`]; sets `quit` when the user ends the program.
    pub fn new(options: Options, quit: Rc<Cell<bool>>) -> Self {
        Self { options, quit, running: None }
    }

    /// Opens a model: the document loads it, and the model that is open stays until then.
    pub fn open_model(&mut self, source: Source) {
        let Some(running) = &self.running else { return };
        match &running.document {
            Some(document) => document.open(source),
            None => {
                let mut interface = running.parts.interface.borrow_mut();
                interface.state.say(MessageSeverity::Error, "Internal error: there is no document thread");
            }
        }
    }

    /// Returns the setup of the document. Its journals are in the autosave folder of the options, otherwise next to the
    /// settings if these have a folder of their own.
    fn setup(&self) -> Setup {
        let beside = self.options.settings_folder.as_ref().map(|folder| folder.join("autosave"));
        let folder = self.options.autosave_folder.clone().or(beside);
        let autosave = Autosave::new(Arc::new(RealFiles), folder);
        Setup { autosave, faults: self.options.faults.clone(), ..Setup::default() }
    }

    /// Carries out the effects of the panels, and sends the graphics thread what changed.
    fn carry_out(&mut self) {
        let effects = match &self.running {
            Some(running) => running.parts.interface.borrow_mut().take_effects(),
            None => return,
        };
        for effect in effects {
            if let Some(running) = &mut self.running
                && running.effect(effect)
            {
                self.quit.set(true);
            }
        }
        if let Some(running) = &mut self.running {
            {
                let mut interface = running.parts.interface.borrow_mut();
                interface.update_reference(&running.references);
                interface.update_thumbnails();
                interface.update_sound(&running.sounds, &running.scene_sounds, &running.samples);
            }
            let interface = running.parts.interface.borrow();
            let (state, scale) = (interface.state.read(), interface.pixels_per_point());
            running.graphics_sync.update(&running.parts.graphics, &state, scale, interface.is_dark());
        }
    }
}

impl BaseRuntime for EditorRuntime {
    fn initialize(&mut self, parts: Parts, main: &mut Context) {
        {
            let mut interface = parts.interface.borrow_mut();
            interface.state.pass_over(self.options.passed_over);
            interface.edits = std::mem::take(&mut self.options.edits);
            interface.faults = self.options.faults.clone();
        }
        let shown = &parts.interface;
        let replies = interface_address(main, shown, replies::show);
        let answers = interface_address(main, shown, file_actions::chosen);
        let references = interface_address(main, shown, Interface::reference_answered);
        let sounds = interface_address(main, shown, Interface::sound_answered);
        let scene_sounds = interface_address(main, shown, Interface::scene_sound_answered);
        let samples = interface_address(main, shown, Interface::samples_answered);
        let scenes = interface_address(main, shown, scene_maker::made);
        let looked = interface_address(main, shown, model_looker::added);
        let scene_files = interface_address(main, shown, scene_files::answered);
        let setup = self.setup();
        let document = match Document::start_with(setup, replies.clone(), parts.graphics.views().clone()) {
            Ok(document) => {
                report_faults(document.thread(), &parts.interface, main);
                Some(document)
            }
            Err(error) => {
                let mut interface = parts.interface.borrow_mut();
                interface
                    .state
                    .say(MessageSeverity::Error, format!("No document thread could be started: {error}"));
                None
            }
        };
        self.running = Some(Running {
            parts,
            document,
            replies,
            answers,
            references,
            sounds,
            scene_sounds,
            samples,
            scenes,
            looked,
            scene_files,
            file_jobs: FileJobs::default(),
            leaving: false,
            graphics_sync: GraphicsSync::default(),
            tickets: 0,
            asked: None,
            hover: Hover::default(),
        });
        self.open_model(self.options.source.clone());
    }

    fn graphics_said(&mut self, reply: GraphicsReply, _main: &mut Context) {
        let Some(running) = &mut self.running else { return };
        let mut interface = running.parts.interface.borrow_mut();
        match reply {
            // The manager that called this has answered.
            GraphicsReply::NeedsSurface(_) => return,
            GraphicsReply::Ready { adapter, max_texture_side, smooth } => {
                if !smooth {
                    let text =
                        format!("{adapter} has no multisampling: edges in the viewport are not smooth");
                    interface.state.say(MessageSeverity::Info, text);
                }
                interface.set_max_texture_side(max_texture_side);
                interface.state.window_mut().set_device(DeviceStatus::Ready { adapter });
            }
            GraphicsReply::Picked { bone, thing, ticket } => {
                // A pointer that stays where it is changes nothing, so nothing is drawn.
                if running.hover.answered(ticket) {
                    let thing = interface.state.set_pointed_thing(thing.map(|thing| thing.thing));
                    if !interface.state.set_pointed(bone) && !thing {
                        return;
                    }
                }
            }
            GraphicsReply::PickedAll { bones, things, ticket } => {
                let is_scene = interface.state.read().scene().is_some();
                let things: Vec<Arc<str>> = things.into_iter().map(|thing| thing.thing).collect();
                // An answer to an older question is not about the newest click.
                match running.asked.take_if(|asked| asked.0 == ticket) {
                    Some((_, Asked::Click(at, choice))) if is_scene => {
                        interface.state.thing_picked(at, &things, choice);
                    }
                    Some((_, Asked::Region(choice))) if is_scene => {
                        interface.state.things_caught(&things, choice)
                    }
                    Some((_, Asked::Click(at, choice))) => interface.state.picked(at, &bones, choice),
                    Some((_, Asked::Region(choice))) => interface.state.caught(&bones, choice),
                    None => return,
                }
            }
            GraphicsReply::Thumbnail(thumbnail) => {
                if !interface.thumbnail_drawn(thumbnail) {
                    return;
                }
            }
            GraphicsReply::Statistics { milliseconds, .. } => {
                interface.state.window_mut().set_frame_time(milliseconds);
            }
            GraphicsReply::Recovered { reason, losses } => {
                let text = format!(
                    "The graphics device was lost and recovered (loss {losses} of this run): {reason}"
                );
                interface.state.say(MessageSeverity::Info, text);
            }
            GraphicsReply::Paused { reason } => {
                interface.state.say(MessageSeverity::Warning, format!("The viewport is paused: {reason}"));
                interface.state.window_mut().set_device(DeviceStatus::Paused { reason });
            }
            GraphicsReply::Images { title, warnings } => {
                for warning in warnings {
                    interface.state.say(MessageSeverity::Warning, format!("{title}: {warning}"));
                }
            }
            GraphicsReply::Captured(Ok(path)) => {
                interface.state.say(MessageSeverity::Info, format!("Wrote {}", path.display()));
            }
            GraphicsReply::Captured(Err(reason)) => {
                interface.state.say(MessageSeverity::Error, format!("No image was written: {reason}"));
            }
            GraphicsReply::Fatal(reason) => {
                interface.state.say(MessageSeverity::Error, format!("Drawing has stopped: {reason}"));
            }
        }
        interface.redraw();
    }

    fn flush_effects(&mut self) {
        self.carry_out();
    }

    fn update(&mut self, _main: &mut Context) {
        self.carry_out();
        if let Some(running) = &mut self.running {
            running.ask_under_pointer();
        }
    }

    fn destroy(&mut self, main: &mut Context) {
        let Some(running) = self.running.take() else { return };
        main.unregister_receiver(&running.answers);
        main.unregister_receiver(&running.references);
        main.unregister_receiver(&running.sounds);
        main.unregister_receiver(&running.scenes);
        if let Some(document) = running.document {
            document.stop();
            if let Err(late) = Thread::wait_for(&[document.thread().clone()], Instant::now() + END) {
                tracing::warn!(?late, "did not end in time");
            }
        }
        main.unregister_receiver(&running.replies);
    }
}

impl Running {
    /// Asks which bone is under the pointer, if that may have changed and no answer is pending.
    fn ask_under_pointer(&mut self) {
        let interface = self.parts.interface.borrow();
        let (state, scale) = (interface.state.read(), interface.pixels_per_point());
        let place = state.pointer.zip(state.view).map(|(pointer, view)| HoverPoint {
            position: [pointer.x * scale, pointer.y * scale],
            camera: state.camera,
            generation: view.generation,
        });
        let asks = self.hover.asks(place, self.tickets + 1);
        if let Some(asked) = place.filter(|_| asks) {
            self.tickets += 1;
            self.parts.graphics.pick(asked.position, self.tickets);
        }
    }
}

/// Shows panics of another thread in the status line.
pub(super) fn report_faults(
    thread: &dragonfly_runtime::ThreadHandle,
    interface: &Rc<RefCell<Interface>>,
    main: &mut Context,
) {
    let address = main.handle().reserve_address();
    let shown = Rc::clone(interface);
    main.register_restartable_receiver_at(&address, move |_| Faults(Rc::clone(&shown)));
    thread.observe(move |fault| {
        let text = format!("{} in thread {} failed: {}", fault.object, fault.thread, fault.reason);
        // If nothing receives the message, the log still contains the failure.
        let _ = address.send((text, fault.outcome == Outcome::GivenUp));
    });
}

struct Faults(Rc<RefCell<Interface>>);

impl Receiver for Faults {
    /// The text of the failure, and whether the object was removed for good.
    type Message = (String, bool);

    fn receive(&mut self, (text, for_good): (String, bool), _main: &mut Context) {
        self.0.borrow_mut().failed(text, for_good);
    }
}
