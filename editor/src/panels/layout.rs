//! The layout of the panels: a tree of tiles that the user moves and resizes, saved between sessions.

use super::context::PanelContext;
use super::request::Request;
use super::style::{self, GRID};
use super::theme::Theme;
use super::{Panel, PanelPlace, VIEWPORT, timeline};
use egui::{Color32, Frame, Rect, Stroke, Ui, Visuals, WidgetText};
use egui_tiles::{
    Behavior, Container, Linear, LinearDir, ResizeState, SimplificationOptions, TabState, Tabs, Tile, TileId,
    Tiles, Tree, UiResponse,
};
use serde::{Deserialize, Serialize};

/// A panel in the tree, by its name.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pane(String);

/// The layout of the panels.
#[derive(Debug)]
pub struct Layout {
    tree: Tree<Pane>,
    changed: bool,
}

/// Version of the stored tree; raised when its meaning changes.
const VERSION: u32 = 2;

#[derive(Serialize, Deserialize)]
struct StoredLayout {
    version: u32,
    tree: Tree<Pane>,
}

impl Layout {
    /// Returns the default layout, as the panels define it.
    pub fn usual(panels: &[Box<dyn Panel>]) -> Self {
        let mut tiles = Tiles::default();
        let mut column = |place: PanelPlace| -> Vec<TileId> {
            let panes = panels.iter().filter(|panel| panel.place() == place);
            panes.map(|panel| tiles.insert_pane(Pane(panel.id().to_owned()))).collect()
        };
        let (left, left_below, middle, right, below, below_right) = (
            column(PanelPlace::Left),
            column(PanelPlace::LeftBelow),
            column(PanelPlace::Middle),
            column(PanelPlace::Right),
            column(PanelPlace::Below),
            column(PanelPlace::BelowRight),
        );
        let tabs = |tiles: &mut Tiles<Pane>, panes: Vec<TileId>| tiles.insert_tab_tile(panes);
        let (upper, lower) = (tabs(&mut tiles, left), tabs(&mut tiles, left_below));
        let left = tiles.insert_new(linear(LinearDir::Vertical, &[(upper, 0.6), (lower, 0.4)]));
        let middle = tabs(&mut tiles, middle);
        let right = tabs(&mut tiles, right);
        let top =
            tiles.insert_new(linear(LinearDir::Horizontal, &[(left, 0.19), (middle, 0.61), (right, 0.20)]));
        let (below, beside) = (tabs(&mut tiles, below), tabs(&mut tiles, below_right));
        let below = tiles.insert_new(linear(LinearDir::Horizontal, &[(below, 0.58), (beside, 0.42)]));
        let share = timeline::HEIGHT / 664.0;
        let root = tiles.insert_new(linear(LinearDir::Vertical, &[(top, 1.0 - share), (below, share)]));
        Self { tree: Tree::new(egui::Id::unique("panels"), root, tiles), changed: true }
    }

    /// Reads the text of a layout file; a damaged one gives the default layout. A panel that the file does not have, because it is
    /// newer than the file, becomes a tab of the panels with which it is by default.
    pub fn parse(text: &str, panels: &[Box<dyn Panel>]) -> Self {
        let stored =
            serde_json::from_str::<StoredLayout>(text).ok().filter(|stored| stored.version == VERSION);
        let Some(mut tree) = stored.map(|stored| stored.tree) else { return Self::usual(panels) };
        let mut changed = false;
        for panel in panels {
            changed |= add_newer(&mut tree, &**panel, panels);
        }
        if sound(&tree, panels) { Self { tree, changed } } else { Self::usual(panels) }
    }

    /// Returns the text of a layout file.
    pub fn to_text(&self) -> String {
        // Plain data always serializes.
        // Serialized through a value, whose keys are sorted: equal layouts give equal text.
        let stored = StoredLayout { version: VERSION, tree: self.tree.clone() };
        serde_json::to_value(stored).map(|value| value.to_string()).unwrap_or_default()
    }

    /// Whether the panel is shown.
    pub fn is_shown(&self, id: &str) -> bool {
        self.find(id).is_some_and(|tile| self.tree.is_visible(tile))
    }

    /// Shows or hides the panel.
    pub fn toggle(&mut self, id: &str) {
        if let Some(tile) = self.find(id) {
            let shown = self.tree.is_visible(tile);
            self.tree.set_visible(tile, !shown);
            self.changed = true;
        }
    }

    /// Shows the panel, in front of those in the same place.
    pub fn bring_to_front(&mut self, id: &str) {
        if let Some(wanted) = self.find(id) {
            self.tree.set_visible(wanted, true);
            self.tree.make_active(|tile, _| tile == wanted);
            self.changed = true;
        }
    }

    /// Whether anything changed since the last call.
    pub fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    fn find(&self, id: &str) -> Option<TileId> {
        self.tree.tiles.find_pane(&Pane(id.to_owned()))
    }

    /// Draws every panel in its tile.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        panels: &mut [Box<dyn Panel>],
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let viewport = self.find(VIEWPORT);
        let unfit = self.hide_unfit(panels, context.scene().is_some());
        let mut drag =
            LayoutDrag { panels, context, requests, viewport, draws_viewport: false, changed: false };
        self.tree.ui(&mut drag, ui);
        let draws_viewport = drag.draws_viewport;
        self.changed |= drag.changed;
        if !draws_viewport {
            // Behind another tab, or closed: what is over it covers it whole, so that its tools leave the mouse to the panels there.
            requests.push(Request::Shields(vec![Rect::EVERYTHING]));
        }
        for tile in unfit {
            self.tree.set_visible(tile, true);
        }
    }

    /// Hides the panels that are for something else than what is open. Returns those that were visible before.
    fn hide_unfit(&mut self, panels: &[Box<dyn Panel>], is_scene: bool) -> Vec<TileId> {
        let unfit = panels.iter().filter(|panel| !panel.subject().fits(is_scene));
        let mut tiles: Vec<TileId> = unfit
            .filter_map(|panel| self.find(panel.id()))
            .filter(|&tile| self.tree.is_visible(tile))
            .collect();
        for &tile in &tiles {
            self.tree.set_visible(tile, false);
        }
        // A bar without tabs takes no room.
        let empty = |tile: &Tile<Pane>| match tile {
            Tile::Container(Container::Tabs(tabs)) => {
                !tabs.children.is_empty() && tabs.children.iter().all(|&child| !self.tree.is_visible(child))
            }
            Tile::Container(_) | Tile::Pane(_) => false,
        };
        let bars = self.tree.tiles.iter().filter(|(_, tile)| empty(tile)).map(|(&id, _)| id);
        let bars: Vec<TileId> = bars.filter(|&id| self.tree.is_visible(id)).collect();
        for &tile in &bars {
            self.tree.set_visible(tile, false);
        }
        tiles.extend(bars);
        tiles
    }
}

fn linear(direction: LinearDir, shares: &[(TileId, f32)]) -> Tile<Pane> {
    let mut linear = Linear::new(direction, shares.iter().map(|&(tile, _)| tile).collect());
    for &(tile, share) in shares {
        linear.shares.set_share(tile, share);
    }
    Tile::Container(Container::Linear(linear))
}

/// Adds a panel that the tree does not have as a tab next to one of its neighbors in the default layout. Returns whether it was
/// added.
fn add_newer(tree: &mut Tree<Pane>, panel: &dyn Panel, panels: &[Box<dyn Panel>]) -> bool {
    if tree.tiles.find_pane(&Pane(panel.id().to_owned())).is_some() {
        return false;
    }
    let neighbors = panels.iter().filter(|other| other.place() == panel.place());
    let parents = neighbors.filter_map(|other| {
        let tile = tree.tiles.find_pane(&Pane(other.id().to_owned()))?;
        tree.tiles.parent_of(tile)
    });
    let tabs = parents
        .into_iter()
        .find(|parent| matches!(tree.tiles.get(*parent), Some(Tile::Container(Container::Tabs(_)))));
    let Some(tabs) = tabs else { return false };
    let pane = tree.tiles.insert_pane(Pane(panel.id().to_owned()));
    if let Some(Tile::Container(container)) = tree.tiles.get_mut(tabs) {
        container.add_child(pane);
    }
    true
}

/// Whether the tree has a root, every panel exactly once, and no unknown panel.
fn sound(tree: &Tree<Pane>, panels: &[Box<dyn Panel>]) -> bool {
    let root = tree.root().and_then(|root| tree.tiles.get(root));
    let panes: Vec<&str> = tree
        .tiles
        .tiles()
        .filter_map(|tile| if let Tile::Pane(pane) = tile { Some(pane.0.as_str()) } else { None })
        .collect();
    root.is_some()
        && panes.len() == panels.len()
        && panels.iter().all(|panel| panes.iter().filter(|id| **id == panel.id()).count() == 1)
}

/// Draws the tiles and follows their drags for egui_tiles.
struct LayoutDrag<'a> {
    panels: &'a mut [Box<dyn Panel>],
    context: &'a PanelContext<'a>,
    requests: &'a mut Vec<Request>,
    viewport: Option<TileId>,
    /// Whether the viewport was drawn in this frame.
    draws_viewport: bool,
    changed: bool,
}

impl Behavior<Pane> for LayoutDrag<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut Pane) -> UiResponse {
        let Some(panel) = self.panels.iter_mut().find(|panel| panel.id() == pane.0) else {
            return UiResponse::None;
        };
        ui.set_clip_rect(ui.max_rect().intersect(ui.clip_rect()));
        if pane.0 == VIEWPORT {
            self.draws_viewport = true;
            panel.show(ui, self.context, self.requests);
        } else {
            let fill = Theme::of(ui).panel;
            ui.painter().rect_filled(ui.max_rect(), 0.0, fill);
            Frame::NONE.show(ui, |ui| panel.show(ui, self.context, self.requests));
        }
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        self.panels.iter().find(|panel| panel.id() == pane.0).map_or("", |panel| panel.title()).into()
    }

    fn is_tab_bar_visible(&self, _tile: TileId, tabs: &Tabs) -> bool {
        // A viewport alone in its tile needs no title; one that shares its tile with other panels does.
        !(tabs.children.len() == 1 && self.viewport == Some(tabs.children[0]))
    }

    fn on_edit(&mut self, _action: egui_tiles::EditAction) {
        self.changed = true;
    }

    fn tab_bar_height(&self, _style: &egui::Style) -> f32 {
        style::BAR
    }

    fn gap_width(&self, _style: &egui::Style) -> f32 {
        2.0
    }

    fn min_size(&self) -> f32 {
        96.0
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }

    fn resize_stroke(&self, style: &egui::Style, context: ResizeState) -> Stroke {
        let theme = Theme::get(style.visuals.dark_mode);
        match context {
            ResizeState::Idle => Stroke::new(2.0, theme.gap),
            ResizeState::Hovering | ResizeState::Dragging => Stroke::new(2.0, theme.accent),
        }
    }

    fn tab_title_spacing(&self, _visuals: &Visuals) -> f32 {
        3.0 * GRID
    }

    fn tab_bar_color(&self, visuals: &Visuals) -> Color32 {
        Theme::get(visuals.dark_mode).bar
    }

    fn tab_bg_color(
        &self,
        visuals: &Visuals,
        _tiles: &Tiles<Pane>,
        _tile: TileId,
        context: &TabState,
    ) -> Color32 {
        if context.active { Theme::get(visuals.dark_mode).panel } else { Color32::TRANSPARENT }
    }

    fn tab_outline_stroke(&self, _: &Visuals, _: &Tiles<Pane>, _: TileId, _: &TabState) -> Stroke {
        Stroke::NONE
    }

    fn tab_bar_hline_stroke(&self, visuals: &Visuals) -> Stroke {
        Stroke::new(1.0, Theme::get(visuals.dark_mode).panel)
    }

    fn tab_text_color(&self, visuals: &Visuals, _: &Tiles<Pane>, _: TileId, context: &TabState) -> Color32 {
        let theme = Theme::get(visuals.dark_mode);
        if context.active { theme.text } else { theme.weak }
    }

    fn drag_preview_stroke(&self, visuals: &Visuals) -> Stroke {
        Stroke::new(1.0, Theme::get(visuals.dark_mode).accent)
    }

    fn drag_preview_color(&self, visuals: &Visuals) -> Color32 {
        Theme::get(visuals.dark_mode).accent.gamma_multiply(0.2)
    }

    fn drag_ui(&mut self, tiles: &Tiles<Pane>, ui: &mut Ui, tile: TileId) {
        let title = self.tab_title_for_tile(tiles, tile);
        Frame::popup(ui.style()).show(ui, |ui| ui.label(title.color(Theme::of(ui).text)));
    }
}
