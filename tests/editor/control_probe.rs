//! Controls that record the events they receive, for the tests of the control framework.

use dragonfly::control::{
    Area, BaseControl, Button, ControlFramework, ControlId, ControlLookup, InputFlow, Key, Modifiers, Mouse,
};
use glam::Vec2;

/// An event that a control received.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ProbeEvent {
    Enter,
    Leave,
    Move,
    Wheel,
    Down(Button),
    Up(Button),
    KeyDown(Key, bool),
    KeyUp(Key),
    Focus,
    NoFocus,
    Lost,
}

/// Side effect of a control when a mouse button is pressed on it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum PressAction {
    #[default]
    Nothing,
    UnregisterSelf,
    Unregister(ControlId),
    Register(Area),
    Focus(ControlId),
}

pub(crate) struct Probe {
    pub(crate) id: ControlId,
    pub(crate) passes: bool,
    /// Center and radius, for a control that is a circle inside its area.
    pub(crate) circle: Option<(Vec2, f32)>,
    pub(crate) on_press: PressAction,
    /// Takes the focus whenever it loses it.
    pub(crate) greedy: bool,
    pub(crate) events: Vec<ProbeEvent>,
}

impl Probe {
    pub(crate) fn note(&mut self, event: ProbeEvent) -> InputFlow {
        self.events.push(event);
        if self.passes { InputFlow::ToParent } else { InputFlow::Stop }
    }
}

impl BaseControl for Probe {
    fn is_pos_on(&self, point: Vec2) -> bool {
        self.circle.is_none_or(|(center, radius)| center.distance(point) < radius)
    }
    fn set_focus(&mut self, _: &mut ControlFramework) {
        self.note(ProbeEvent::Focus);
    }
    fn null_focus(&mut self, framework: &mut ControlFramework) {
        self.note(ProbeEvent::NoFocus);
        if self.greedy {
            framework.set_focus(self.id);
        }
    }
    fn key_down(&mut self, key: Key, _: Modifiers, repeat: bool, _: &mut ControlFramework) -> InputFlow {
        self.note(ProbeEvent::KeyDown(key, repeat))
    }
    fn key_up(&mut self, key: Key, _: Modifiers, _: &mut ControlFramework) -> InputFlow {
        self.note(ProbeEvent::KeyUp(key))
    }
    fn mouse_enter(&mut self, _: &mut ControlFramework) {
        self.note(ProbeEvent::Enter);
    }
    fn mouse_leave(&mut self, _: &mut ControlFramework) {
        self.note(ProbeEvent::Leave);
    }
    fn mouse_move(&mut self, _: Mouse, _: &mut ControlFramework) -> InputFlow {
        self.note(ProbeEvent::Move)
    }
    fn mouse_wheel(&mut self, _: Vec2, _: Mouse, _: &mut ControlFramework) -> InputFlow {
        self.note(ProbeEvent::Wheel)
    }
    fn mouse_down(&mut self, button: Button, _: Mouse, framework: &mut ControlFramework) -> InputFlow {
        match self.on_press {
            PressAction::Nothing => {}
            PressAction::UnregisterSelf => assert!(framework.unregister_control(self.id)),
            PressAction::Unregister(other) => _ = framework.unregister_control(other),
            PressAction::Register(area) => _ = framework.register_control(area),
            PressAction::Focus(other) => framework.set_focus(other),
        }
        self.note(ProbeEvent::Down(button))
    }
    fn mouse_up(&mut self, button: Button, _: Mouse, _: &mut ControlFramework) -> InputFlow {
        self.note(ProbeEvent::Up(button))
    }
    fn input_lost(&mut self, _: &mut ControlFramework) {
        self.note(ProbeEvent::Lost);
    }
}

/// The owner of all controls.
#[derive(Default)]
pub(crate) struct Owner {
    pub(crate) probes: Vec<Probe>,
}

impl ControlLookup for Owner {
    fn control(&mut self, id: ControlId) -> Option<&mut dyn BaseControl> {
        self.probes.iter_mut().find(|probe| probe.id == id).map(|probe| probe as &mut dyn BaseControl)
    }
}

impl Owner {
    pub(crate) fn add(&mut self, framework: &mut ControlFramework, area: Area) -> ControlId {
        let id = framework.register_control(area);
        self.own(id);
        id
    }

    pub(crate) fn own(&mut self, id: ControlId) {
        let events = Vec::with_capacity(256);
        self.probes.push(Probe {
            id,
            passes: false,
            circle: None,
            on_press: PressAction::Nothing,
            greedy: false,
            events,
        });
    }

    pub(crate) fn get(&mut self, id: ControlId) -> &mut Probe {
        self.probes.iter_mut().find(|probe| probe.id == id).unwrap()
    }

    /// Returns the events that the control received since the last call.
    pub(crate) fn take_events(&mut self, id: ControlId) -> Vec<ProbeEvent> {
        std::mem::take(&mut self.get(id).events)
    }

    pub(crate) fn forget(&mut self) {
        self.probes.iter_mut().for_each(|probe| probe.events.clear());
    }
}
