//! Window, captured main thread, graphics thread: the base of every program of this kind (thesis §3.2.4.1).

use super::AppError;
use super::base_runtime::Parts;
use super::editor_runtime::report_faults;
use super::event::UserEvent;
use super::init_manager::{InitManager, MakeRuntime};
use super::interface::Interface;
use super::store::{self, Store};
use super::target_window::WinitWindow;
use super::timeline::{Step, StepTrace};
use crate::panels::Settings;
use crate::panels::settings::WindowSettings;
use dragonfly_document::FaultInjection;
use dragonfly_picture::guard::caught;
use dragonfly_picture::{Connection, DeviceParameters, Graphics, GraphicsHandle, SurfaceSource};
use dragonfly_runtime::{Captured, Next, RESTART_WINDOW, RESTARTS, Thread};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::Window;

/// Time limit for the graphics thread to end.
const END: Duration = Duration::from_millis(1200);

/// The base of a program with a window: the window, the captured main thread and the graphics thread.
pub struct MainRuntime {
    main: Captured,
    window: Arc<Window>,
    interface: Rc<RefCell<Interface>>,
    init: Rc<RefCell<InitManager>>,
    graphics: GraphicsHandle,
    timeline: Rc<RefCell<StepTrace>>,
    /// Times of the latest failures of input.
    mistakes: Vec<Instant>,
}

impl MainRuntime {
    /// Creates the window, captures the main thread, prepares the custom run-time, and starts the graphics thread.
    pub(super) fn new(
        event_loop: &ActiveEventLoop,
        proxy: &EventLoopProxy<UserEvent>,
        store: Store,
        custom: MakeRuntime,
        timeline: Rc<RefCell<StepTrace>>,
        faults: FaultInjection,
    ) -> Result<Self, AppError> {
        // Invisible until the accessibility bridge exists: the bridge must be created before the window is shown.
        let settings = Settings::parse(&store.read(store::SETTINGS));
        let monitor = event_loop.primary_monitor().or_else(|| event_loop.available_monitors().next());
        let screen = monitor.map(|monitor| {
            let size = monitor.size().to_logical::<f32>(monitor.scale_factor());
            [size.width, size.height]
        });
        let attributes = Window::default_attributes()
            .with_title("Dragonfly")
            .with_visible(false)
            .with_min_inner_size(LogicalSize::<f32>::from(WindowSettings::LEAST))
            .with_inner_size(LogicalSize::<f32>::from(settings.window.size_on(screen)))
            .with_maximized(settings.window.maximized);
        let window =
            event_loop.create_window(attributes).map_err(|error| AppError::Window(error.to_string()))?;
        let window = Arc::new(window);
        let context = egui::Context::default();
        let scale = window.scale_factor() as f32;
        let mut egui = egui_winit::State::new(
            context,
            egui::ViewportId::ROOT,
            event_loop,
            Some(scale),
            window.theme(),
            None,
        );
        egui.init_accesskit(event_loop, &window, proxy.clone());
        window.set_visible(true);

        let waker = proxy.clone();
        let mut main = Thread::capture("main", move || {
            // The loop may have ended; then it need not be woken.
            let _ = waker.send_event(UserEvent::Wake);
        });
        let interface = Rc::new(RefCell::new(Interface::new(Arc::clone(&window), egui, settings, store)));
        let connection = Connection::beside(Arc::new(event_loop.owned_display_handle()));
        let target = WinitWindow(Arc::clone(&window));
        let surfaces = SurfaceSource::new(Arc::new(target), connection.clone());
        let init = Rc::new(RefCell::new(InitManager::new(custom, surfaces, Rc::clone(&timeline))));
        let (seen, kept) = (Rc::clone(&interface), Rc::clone(&init));
        let replies = main.handle().reserve_address();
        let hears = Rc::clone(&init);
        main.context().register_restartable_receiver_at(&replies, move |_| Rc::clone(&hears));
        // Drawing the panels is the first work of every iteration, and a bug in a panel must not end the program.
        main.context().register_restartable_worker(move |_| Rc::clone(&seen));
        main.context().register_restartable_worker(move |_| Rc::clone(&kept));
        timeline.borrow_mut().reach(Step::MainRuntime);

        let parameters =
            DeviceParameters { connection: Some(connection), faults, ..DeviceParameters::default() };
        let size = window.inner_size();
        let graphics = Graphics::start(parameters, [size.width, size.height], replies)
            .map_err(|error| AppError::Thread(error.to_string()))?;
        timeline.borrow_mut().reach(Step::Graphics);
        report_faults(graphics.thread(), &interface, main.context());
        let handle = main.handle().clone();
        report_faults(&handle, &interface, main.context());
        interface.borrow_mut().set_graphics(graphics.clone());
        let parts = Parts { interface: Rc::clone(&interface), graphics: graphics.clone() };
        init.borrow_mut().set_parts(parts);
        Ok(Self { main, window, interface, init, graphics, timeline, mistakes: Vec::new() })
    }

    /// Runs one iteration of the main thread: messages, panels, custom run-time. Returns when the next one is due.
    pub(super) fn iterate(&mut self) -> Next {
        self.main.iterate()
    }

    /// Handles an event of the window.
    pub(super) fn window_event(&mut self, event: &WindowEvent) {
        // Caught here, because a panic must not unwind through the window system.
        let taken = caught(|| {
            let heard = self.interface.borrow_mut().window_event(event);
            if heard {
                self.init.borrow_mut().flush_effects();
            }
        });
        if let Err(reason) = taken {
            self.mistake(&reason);
        }
    }

    /// Handles a request to close the window. Returns whether the custom run-time is running; if so, it asks about
    /// unsaved changes and decides.
    pub(super) fn may_ask_before_closing(&mut self) -> bool {
        let asks = self.init.borrow().is_running();
        if asks {
            self.interface.borrow_mut().effects.push(crate::panels::Effect::File(
                crate::panels::FileAction::Leave(dragonfly_document::Then::Quit),
            ));
        }
        asks
    }

    /// Handles an event of the accessibility bridge.
    pub(super) fn accesskit_event(&mut self, event: accesskit_winit::Event) {
        self.interface.borrow_mut().accesskit_event(event.window_event);
    }

    /// Returns the error that ends the program, if there is one.
    pub(super) fn fatal(&self) -> Option<AppError> {
        let mistake = self.interface.borrow().given_up.clone().map(AppError::Mistake);
        mistake.or_else(|| self.init.borrow().fatal().map(|reason| AppError::Graphics(reason.to_owned())))
    }

    /// Handles a failure of input: only that input is lost. After several in a short time the program ends.
    fn mistake(&mut self, reason: &str) {
        let now = Instant::now();
        self.mistakes.retain(|then| now.saturating_duration_since(*then) < RESTART_WINDOW);
        self.mistakes.push(now);
        tracing::error!(reason, "handling input failed");
        let text = format!("Handling input failed in the main thread: {reason}");
        self.interface.borrow_mut().failed(text, self.mistakes.len() > RESTARTS);
    }

    /// Destroys users before what they use: input, custom run-time, graphics, window (T-095, T-096).
    pub(super) fn destroy(self) {
        let Self { mut main, window, interface, init, graphics, timeline, mistakes: _ } = self;
        interface.borrow_mut().close();
        init.borrow_mut().destroy(main.context());
        graphics.stop();
        match Thread::wait_for(std::slice::from_ref(graphics.thread()), Instant::now() + END) {
            Ok(()) => timeline.borrow_mut().reach(Step::GraphicsDestruction),
            // The driver blocks the thread. The process ends without it; the user's work is not in that thread.
            Err(late) => tracing::warn!(?late, "did not end in time"),
        }
        drop(graphics);
        main.context().stop();
        main.iterate();
        drop(main);
        drop(init);
        drop(interface);
        drop(window);
        timeline.borrow_mut().reach(Step::MainRuntimeDestruction);
    }
}
