//! The accessibility tree in the log: for tests and tools that cannot read pixels.

use egui::accesskit::{Node, NodeId, Toggled};
use egui::{Context, PlatformOutput};
use serde::Serialize;
use std::collections::HashMap;
use tracing::{debug, enabled};

/// Target of the lines in the log.
const TARGET: &str = "dragonfly::reader";

/// The controls as they were logged last: only those that differ are logged again.
#[derive(Debug, Default)]
pub(super) struct AccessibilityTrace(HashMap<NodeId, ControlRecord>);

/// A control of the accessibility tree. Fields that are `None` are left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct ControlRecord {
    id: u64,
    role: String,
    name: String,
    /// Left, top, width, height in the window, physical pixels.
    place: [f64; 4],
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    number: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    on: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    about: Option<String>,
    disabled: bool,
    focused: bool,
}

impl AccessibilityTrace {
    /// Enables the accessibility tree if the log records it (`DRAGONFLY_LOG=dragonfly::reader=debug`).
    pub(super) fn listen(&self, context: &Context) {
        if enabled!(target: TARGET, tracing::Level::DEBUG) {
            context.enable_accesskit();
        }
    }

    /// Logs each control that has changed or is gone, as one line of JSON.
    pub(super) fn tell(&mut self, output: &PlatformOutput, pixels_per_point: f32) {
        let Some(update) = &output.accesskit_update else { return };
        if !enabled!(target: TARGET, tracing::Level::DEBUG) {
            return;
        }
        let mut gone = std::mem::take(&mut self.0);
        for (id, node) in &update.nodes {
            let Some(record) = record(*id, node, *id == update.focus, pixels_per_point) else { continue };
            if gone.remove(id).as_ref() != Some(&record)
                && let Ok(line) = serde_json::to_string(&record)
            {
                debug!(target: TARGET, "{line}");
            }
            self.0.insert(*id, record);
        }
        for id in gone.into_keys() {
            debug!(target: TARGET, "{{\"id\":{},\"gone\":true}}", id.0);
        }
    }
}

/// Returns the record of a control; `None` for a control without name and value.
fn record(id: NodeId, node: &Node, focused: bool, pixels_per_point: f32) -> Option<ControlRecord> {
    let [name, value] = [node.label(), node.value()].map(|text| text.filter(|text| !text.is_empty()));
    let rect = node.bounds().filter(|_| name.or(value).is_some())?;
    let place = [rect.x0, rect.y0, rect.width(), rect.height()];
    Some(ControlRecord {
        id: id.0,
        role: format!("{:?}", node.role()),
        name: name.unwrap_or_default().to_owned(),
        place: place.map(|side| side * f64::from(pixels_per_point)),
        value: value.map(str::to_owned),
        number: node.numeric_value(),
        on: node.is_selected().or(node.toggled().map(|toggled| toggled == Toggled::True)),
        about: node.description().map(str::to_owned),
        disabled: node.is_disabled() || node.is_read_only(),
        focused,
    })
}
