//! The window program: its life from the first line of main to the last (thesis §3.2.4).
//!
//! ```text
//! run ── winit's loop ── MainRuntime ─┬─ main thread, captured: Interface (panels) · InitManager → EditorRuntime
//!                                     └─ graphics thread            EditorRuntime ── document thread ── load jobs
//! ```
//!
//! [`timeline`] defines the order in which all of this starts and ends.

mod accessibility_trace;
mod base_runtime;
mod editor_runtime;
mod effects;
mod event;
mod file_actions;
mod file_dialog;
mod frame_cache;
pub mod graphics_sync;
pub mod hover;
mod init_manager;
mod interface;
mod interface_receiver;
mod main_runtime;
mod model_looker;
mod options;
mod pointer_place;
mod reference_loader;
mod replies;
pub mod scene_files;
pub mod scene_maker;
pub mod scene_sounds;
pub mod scene_thumbnails;
mod signals;
mod sound_loader;
pub mod sound_player;
mod state_trace;
pub mod store;
mod target_window;
pub mod timeline;

pub use base_runtime::{BaseRuntime, Parts};
pub use editor_runtime::EditorRuntime;
pub use init_manager::{InitManager, MakeRuntime};
pub use interface::Interface;
pub use main_runtime::MainRuntime;
pub use options::Options;
pub use signals::{end_by, on_signals};

use dragonfly_runtime::Next;
use event::UserEvent;
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use thiserror::Error;
use timeline::{Step, StepTrace};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::WindowId;

/// Reasons why the editor could not start or had to end.
#[derive(Debug, Error)]
pub enum AppError {
    /// There is no display to open a window on.
    #[error("no display: {0}")]
    Display(String),
    /// The display on which the window was shown is gone.
    #[error("the display is gone: {0}")]
    DisplayGone(String),
    /// Another program destroyed the window.
    #[error(
        "the window was destroyed by another program\n  Your work is recorded and will be offered at the next start."
    )]
    WindowGone,
    /// The display refused to open a window.
    #[error("the window could not be opened: {0}")]
    Window(String),
    /// The system refused to start a thread.
    #[error("a thread could not be started: {0}")]
    Thread(String),
    /// This signal asked the program to end, and it ended normally.
    #[error("ended by signal {0}")]
    Signal(i32),
    /// A part of the program failed repeatedly, and the program cannot run without it.
    #[error(
        "internal error, a bug of the program: {0}\n  Your work is recorded and will be offered at the next start."
    )]
    Mistake(String),
    /// No graphics device can draw into the window.
    #[error("no graphics: {0}")]
    Graphics(String),
}

/// Shows the editor until the user ends it. Must be called in the main thread, once.
pub fn run(options: Options) -> Result<(), AppError> {
    let timeline = Rc::new(RefCell::new(StepTrace::default()));
    timeline.borrow_mut().reach(Step::MainFunction);
    let event_loop = EventLoop::<UserEvent>::with_user_event()
        .build()
        .map_err(|error| AppError::Display(error.to_string()))?;
    let proxy = event_loop.create_proxy();
    signals::watch(proxy.clone());
    let mut shell = Shell {
        options,
        proxy,
        runtime: None,
        quit: Rc::default(),
        error: None,
        timeline: Rc::clone(&timeline),
    };
    let ended = event_loop.run_app(&mut shell);
    // Needed when an error of the display ended the loop, because winit then calls no handler.
    shell.destroy();
    if let Some(error) = shell.error {
        return Err(error);
    }
    if let Err(error) = ended {
        let shown = timeline.borrow().reached().contains(&Step::MainRuntime);
        let gone = if shown { AppError::DisplayGone } else { AppError::Display };
        return Err(gone(error.to_string()));
    }
    timeline.borrow_mut().reach(Step::MainFunctionEnd);
    Ok(())
}

/// Passes the events of winit to the run-time.
struct Shell {
    options: Options,
    proxy: EventLoopProxy<UserEvent>,
    runtime: Option<MainRuntime>,
    quit: Rc<Cell<bool>>,
    error: Option<AppError>,
    timeline: Rc<RefCell<StepTrace>>,
}

impl Shell {
    fn start(&mut self, event_loop: &ActiveEventLoop) -> Result<MainRuntime, AppError> {
        let store = store::Store::new(self.options.settings_folder.clone());
        let (options, quit) = (self.options.clone(), Rc::clone(&self.quit));
        let custom: MakeRuntime = Box::new(move || Box::new(EditorRuntime::new(options, quit)));
        let faults = self.options.faults.clone();
        MainRuntime::new(event_loop, &self.proxy, store, custom, Rc::clone(&self.timeline), faults)
    }

    fn destroy(&mut self) {
        if let Some(runtime) = self.runtime.take() {
            runtime.destroy();
        }
    }
}

impl ApplicationHandler<UserEvent> for Shell {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.runtime.is_some() {
            return;
        }
        match self.start(event_loop) {
            Ok(runtime) => self.runtime = Some(runtime),
            Err(error) => {
                self.error = Some(error);
                event_loop.exit();
            }
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _window: WindowId, event: WindowEvent) {
        let Some(runtime) = &mut self.runtime else { return };
        match event {
            WindowEvent::CloseRequested if runtime.may_ask_before_closing() => return,
            WindowEvent::CloseRequested => return event_loop.exit(),
            WindowEvent::Destroyed => {
                self.error.get_or_insert(AppError::WindowGone);
                return event_loop.exit();
            }
            _ => {}
        }
        runtime.window_event(&event);
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, event: UserEvent) {
        match (event, &mut self.runtime) {
            (UserEvent::Signal(signal), _) => {
                self.error.get_or_insert(AppError::Signal(signal));
                event_loop.exit();
            }
            // `about_to_wait` follows and runs the iteration.
            (UserEvent::Wake, _) | (_, None) => {}
            (UserEvent::AccessKit(event), Some(runtime)) => runtime.accesskit_event(event),
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(runtime) = &mut self.runtime else { return };
        let next = runtime.iterate();
        if let Some(error) = runtime.fatal() {
            self.error.get_or_insert(error);
            event_loop.exit();
        } else if self.quit.get() {
            event_loop.exit();
        }
        match next {
            Next::Now => event_loop.set_control_flow(ControlFlow::Poll),
            Next::At(when) => event_loop.set_control_flow(ControlFlow::WaitUntil(when)),
            Next::OnMessage => event_loop.set_control_flow(ControlFlow::Wait),
            Next::Stopped => event_loop.exit(),
        }
    }

    fn exiting(&mut self, _event_loop: &ActiveEventLoop) {
        self.destroy();
    }
}
