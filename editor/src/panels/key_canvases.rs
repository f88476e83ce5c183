//! The places where keys are drawn, in the memory of egui: shortcuts depend on whether the pointer is over one of them.

use super::keys::KeyPanel;
use egui::{Context, Id, Order, Pos2, Rect};

/// The places where keys were drawn in the last frames.
#[derive(Clone, Debug, Default)]
struct KeyCanvases(Vec<KeyCanvas>);

#[derive(Clone, Copy, Debug)]
struct KeyCanvas {
    panel: KeyPanel,
    rect: Rect,
    /// Number of the pass in which it was drawn.
    pass: u64,
}

/// Notes that `panel` draws keys in `rect` in this frame.
pub(super) fn note(context: &Context, panel: KeyPanel, rect: Rect) {
    let pass = context.cumulative_pass_nr();
    context.data_mut(|data| {
        let canvases = data.get_temp_mut_or_default::<KeyCanvases>(place());
        canvases.0.retain(|canvas| canvas.panel != panel && canvas.pass + 1 >= pass);
        canvases.0.push(KeyCanvas { panel, rect, pass });
    });
}

/// Returns the panel whose keys are at `at`, if nothing covers them.
pub(super) fn at(context: &Context, at: Pos2) -> Option<KeyPanel> {
    let is_covered = context.layer_id_at(at).is_some_and(|layer| layer.order != Order::Background);
    let found = shown(context).into_iter().find(|(_, rect)| rect.contains(at));
    found.filter(|_| !is_covered).map(|(panel, _)| panel)
}

/// Returns the panels whose keys are shown, and where.
pub(super) fn shown(context: &Context) -> Vec<(KeyPanel, Rect)> {
    let pass = context.cumulative_pass_nr();
    let canvases = context.data(|data| data.get_temp::<KeyCanvases>(place())).unwrap_or_default();
    let shown = canvases.0.iter().filter(|canvas| canvas.pass + 1 >= pass);
    shown.map(|canvas| (canvas.panel, canvas.rect)).collect()
}

fn place() -> Id {
    Id::unique("places of keys")
}
