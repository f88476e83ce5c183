//! A drag of the selected keys that follows the pointer without a button, until it is confirmed or cancelled.
//!
//! A command begins it. An overlay, which covers the window until the end, assigns it to the timeline or to the curves, and
//! adds the typed text; that panel computes the operation from the pointer, as for a drag with the button.

use egui::Pos2;

/// The part of the keys that a drag without a button changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ButtonlessKind {
    /// Moves the selected keys.
    Move,
    /// Scales the selected keys in time about the playhead.
    Scale,
    /// Moves copies of the selected keys.
    Duplicate,
}

/// A panel in which keys can be dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyPanel {
    /// The timeline.
    Timeline,
    /// The curves.
    Curves,
}

/// The direction in which keys are dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyAxis {
    /// In time, to the left and right.
    Time,
    /// In value, up and down.
    Value,
}

/// The panel in which keys are dragged, and the position of the pointer when the drag began there, points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ButtonlessStart {
    /// The panel.
    pub panel: KeyPanel,
    /// Position of the pointer, points.
    pub at: Pos2,
}

/// A drag of keys without a button.
#[derive(Clone, Debug, PartialEq)]
pub struct ButtonlessDrag {
    kind: ButtonlessKind,
    /// `None` until the overlay is drawn for the first time.
    start: Option<ButtonlessStart>,
    axis: Option<KeyAxis>,
    typed: String,
}

/// A change of a drag without a button.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ButtonlessStep {
    /// Assigns the drag to a panel.
    Start(ButtonlessStart),
    /// Locks it to an axis; the same axis again unlocks it.
    Axis(KeyAxis),
    /// Types a digit, a decimal point or a minus sign.
    Typed(char),
    /// Removes what was typed last.
    Backspace,
}

/// Largest number of characters that are typed.
const LONGEST: usize = 12;

impl ButtonlessDrag {
    /// Begins a drag.
    pub fn new(kind: ButtonlessKind) -> Self {
        Self { kind, start: None, axis: None, typed: String::new() }
    }

    /// Returns what the drag changes.
    pub fn kind(&self) -> ButtonlessKind {
        self.kind
    }

    /// Returns the panel and the position where it began; `None` before it is assigned to a panel.
    pub fn start(&self) -> Option<ButtonlessStart> {
        self.start
    }

    /// Returns the position where it began, if that is in `panel`.
    pub fn start_in(&self, panel: KeyPanel) -> Option<Pos2> {
        self.start.filter(|start| start.panel == panel).map(|start| start.at)
    }

    /// Returns the axis that it is locked to.
    pub fn axis(&self) -> Option<KeyAxis> {
        self.axis
    }

    /// Returns the text that was typed.
    pub fn typed(&self) -> &str {
        &self.typed
    }

    /// Returns the number that was typed: frames, a value or a factor; `None` if nothing was, or no number yet.
    pub fn amount(&self) -> Option<f32> {
        self.typed.parse().ok().filter(|amount: &f32| amount.is_finite())
    }

    /// Carries out a step.
    pub fn step(&mut self, step: ButtonlessStep) {
        match step {
            ButtonlessStep::Start(start) => self.start = Some(start),
            ButtonlessStep::Axis(axis) => {
                self.axis = (self.axis != Some(axis)).then_some(axis);
            }
            ButtonlessStep::Backspace => {
                self.typed.pop();
            }
            // As in Blender, a minus sign typed at any time changes the sign.
            ButtonlessStep::Typed('-') => {
                if self.typed.starts_with('-') {
                    self.typed.remove(0);
                } else {
                    self.typed.insert(0, '-');
                }
            }
            ButtonlessStep::Typed('.' | ',') => {
                if !self.typed.contains('.') && self.typed.len() < LONGEST {
                    self.typed.push('.');
                }
            }
            ButtonlessStep::Typed(typed) => {
                if typed.is_ascii_digit() && self.typed.len() < LONGEST {
                    self.typed.push(typed);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(text: &str) -> ButtonlessDrag {
        let mut drag = ButtonlessDrag::new(ButtonlessKind::Move);
        for typed in text.chars() {
            drag.step(if typed == '<' { ButtonlessStep::Backspace } else { ButtonlessStep::Typed(typed) });
        }
        drag
    }

    #[test]
    fn typed_characters_are_a_number_with_the_sign_last_typed() {
        for (text, amount) in [
            ("", None),
            ("12", Some(12.0)),
            ("1,5", Some(1.5)),
            ("1.5.5", Some(1.55)),
            ("3-", Some(-3.0)),
            ("-3-", Some(3.0)),
            ("-", None),
            ("12<", Some(1.0)),
            ("1<<4", Some(4.0)),
            ("a1b", Some(1.0)),
        ] {
            assert_eq!(typed(text).amount(), amount, "{text}");
        }
        assert_eq!(typed(&"9".repeat(99)).typed().len(), LONGEST);
    }

    #[test]
    fn an_axis_chosen_again_is_unlocked() {
        let mut drag = ButtonlessDrag::new(ButtonlessKind::Move);
        drag.step(ButtonlessStep::Axis(KeyAxis::Value));
        assert_eq!(drag.axis(), Some(KeyAxis::Value));
        drag.step(ButtonlessStep::Axis(KeyAxis::Time));
        drag.step(ButtonlessStep::Axis(KeyAxis::Time));
        assert_eq!(drag.axis(), None);
    }
}
