//! The skeleton as a tree, with a search field.

use super::context::PanelContext;
use super::digest::HierarchyRow;
use super::icons::Icon;
use super::request::Request;
use super::shown_skeleton::{ShownSkeleton, SkeletonChange};
use super::style::ROW;
use super::theme::Theme;
use super::{Panel, PanelPlace, search_field, widgets};
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::Choice;
use dragonfly_picture::between;
use egui::{Rect, ScrollArea, Sense, TextStyle, Ui, pos2, vec2};
use std::collections::HashSet;
use std::sync::Arc;

/// The skeleton as a tree.
#[derive(Debug, Default)]
pub struct Hierarchy {
    query: String,
    /// Bones whose children are hidden.
    collapsed: HashSet<BoneIndex>,
    /// The selection that was last scrolled to.
    followed: Option<BoneIndex>,
    /// Number of rows that were drawn last.
    drawn: usize,
    /// The skeleton that this state belongs to.
    of: ShownSkeleton,
    /// The rows that are shown, until the search or the collapsed bones change.
    listed: Option<ListedRows>,
}

/// Rows of the tree, each with whether it matches the search.
type ShownRows = Arc<[(HierarchyRow, bool)]>;

/// The rows that a search leaves.
#[derive(Debug)]
struct ListedRows {
    /// The search in lower case.
    query: String,
    rows: ShownRows,
}

impl Panel for Hierarchy {
    fn id(&self) -> &'static str {
        "hierarchy"
    }

    fn title(&self) -> &'static str {
        "Skeleton"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Left
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        match self.of.follow(context.view) {
            SkeletonChange::Same => {}
            SkeletonChange::Shifted(shift) => {
                let collapsed = std::mem::take(&mut self.collapsed).into_iter();
                self.collapsed = collapsed.filter_map(|bone| shift.bone(bone)).collect();
                self.followed = self.followed.and_then(|bone| shift.bone(bone));
                self.listed = None;
            }
            SkeletonChange::Replaced => {
                let (of, query) = (std::mem::take(&mut self.of), std::mem::take(&mut self.query));
                *self = Self { of, query, ..Self::default() };
            }
        }
        if context.view.is_none() {
            return widgets::empty(ui, "Bones appear here", "");
        }
        if context.digest.rows.is_empty() {
            return widgets::empty(ui, "No bones", "This model has no skeleton");
        }
        let entered = search_field::show(ui, &mut self.query, "Find a bone", context.find);
        super::set_chips::show(ui, context, requests);
        let rows = self.visible(context);
        if entered {
            let found = self.best(context, &rows);
            requests.extend(found.map(|bone| Request::Select(Some(bone))));
        }
        if rows.is_empty() {
            return widgets::empty(ui, "No bone matches the search", "");
        }
        self.tree(ui, context, &rows, requests);
    }
}

impl Hierarchy {
    /// Returns the bone that Enter selects: the one with exactly this name, otherwise the first match.
    fn best(&self, context: &PanelContext<'_>, rows: &[(HierarchyRow, bool)]) -> Option<BoneIndex> {
        let query = self.query.trim().to_lowercase();
        let found = || rows.iter().filter(|(_, hit)| *hit).map(|(row, _)| row.bone);
        let exact = found().find(|&bone| context.bone_name(bone).to_lowercase() == query);
        exact.or_else(|| found().next()).filter(|_| !query.is_empty())
    }

    /// Returns the rows to show: during a search those that match and their ancestors, otherwise all without a
    /// collapsed ancestor. The flag is whether a row matches.
    fn visible(&mut self, context: &PanelContext<'_>) -> ShownRows {
        let query = self.query.trim().to_lowercase();
        if query.is_empty() {
            if self.listed.as_ref().is_some_and(|listed| !listed.query.is_empty()) {
                // The search ended: the tree scrolls to the bone that was chosen in it.
                self.followed = None;
            }
            self.expand_above_selected(context);
        }
        if let Some(listed) = self.listed.as_ref().filter(|listed| listed.query == query) {
            return Arc::clone(&listed.rows);
        }
        let rows = &context.digest.rows;
        let found = if query.is_empty() {
            self.expanded(rows)
        } else {
            matching(rows, |bone| context.bone_name(bone).to_lowercase().contains(&query))
        };
        let rows = ShownRows::from(found);
        self.listed = Some(ListedRows { query, rows: Arc::clone(&rows) });
        rows
    }

    /// Expands the ancestors of a bone that was selected elsewhere.
    fn expand_above_selected(&mut self, context: &PanelContext<'_>) {
        if context.selected() != self.followed
            && let (Some(selected), Some(loaded)) = (context.selected(), context.loaded())
        {
            let bones = &loaded.model.animation.skeleton.bones;
            let mut above = bones.get(selected as usize).and_then(|bone| bone.parent);
            while let Some(bone) = above {
                if self.collapsed.remove(&bone) {
                    self.listed = None;
                }
                above = bones.get(bone as usize).and_then(|bone| bone.parent);
            }
        }
    }

    /// Returns the rows without a collapsed ancestor.
    fn expanded(&self, rows: &[HierarchyRow]) -> Vec<(HierarchyRow, bool)> {
        let mut out = Vec::with_capacity(rows.len());
        let mut index = 0;
        while let Some(&row) = rows.get(index) {
            out.push((row, true));
            index += 1;
            if self.collapsed.contains(&row.bone) {
                index += row.below as usize;
            }
        }
        out
    }

    fn tree(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        rows: &[(HierarchyRow, bool)],
        requests: &mut Vec<Request>,
    ) {
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut area = ScrollArea::vertical().auto_shrink(false);
        // egui pulls a position back that is beyond the rows of the last frame, so new rows are drawn first.
        let is_new = std::mem::replace(&mut self.drawn, rows.len()) != rows.len();
        if context.selected() != self.followed && is_new {
            ui.ctx().request_repaint();
        } else if context.selected() != self.followed {
            self.followed = context.selected();
            let place = rows.iter().position(|(row, _)| Some(row.bone) == context.selected());
            if let Some(place) = place {
                let middle = place as f32 * ROW - ui.available_height() / 2.0 + ROW / 2.0;
                let tall = rows.len() as f32 * ROW - ui.available_height();
                area = area.vertical_scroll_offset(between(middle, 0.0, tall.max(0.0)));
            }
        }
        area.show_rows(ui, ROW, rows.len(), |ui, range| {
            for &(row, hit) in &rows[range] {
                if self.row(ui, context, row, hit, requests) {
                    choose(ui, context, rows, row.bone, requests);
                }
            }
        });
    }

    /// Draws a row. Returns whether it was clicked.
    fn row(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        row: HierarchyRow,
        hit: bool,
        requests: &mut Vec<Request>,
    ) -> bool {
        let theme = Theme::of(ui);
        let hidden = context.hidden.is_hidden(row.bone);
        let name = context.bone_name(row.bone);
        let selected = context.selection.contains(row.bone);
        let (rect, response) = widgets::row(ui, &name, selected, context.highlighted() == Some(row.bone));
        let indent = indent_of(row.depth, rect.width());
        let color = match (selected, hit) {
            (true, _) => theme.accent,
            (false, _) if hidden => theme.faint,
            (false, true) => theme.text,
            (false, false) => theme.faint,
        };
        let left = rect.left() + indent;
        if row.parent && self.query.trim().is_empty() {
            let mark = Rect::from_center_size(pos2(left + 6.0, rect.center().y), vec2(16.0, ROW));
            let toggle = ui.interact(mark, response.id.with("fold"), Sense::click());
            let folded = self.collapsed.contains(&row.bone);
            let verb = if folded { "Expand" } else { "Collapse" };
            toggle.widget_info(|| {
                egui::WidgetInfo::labeled(egui::accesskit::Role::Button, true, format!("{verb} {name}"))
            });
            let tone = if toggle.hovered() { theme.text } else { theme.weak };
            fold_mark(ui, mark.center(), folded, tone);
            if toggle.clicked() {
                self.fold(row, context, ui.input(|input| input.modifiers.shift || input.modifiers.alt));
            }
        }
        let text =
            Rect::from_min_max(pos2(left + 18.0, rect.top()), pos2(rect.right() - 34.0, rect.bottom()));
        for depth in 1..=row.depth {
            let x =
                ui.painter().round_to_pixel_center(rect.left() + indent_of(depth - 1, rect.width()) + 6.0);
            ui.painter().vline(x, rect.y_range(), egui::Stroke::new(1.0, theme.line.gamma_multiply(0.5)));
        }
        let shown = widgets::cut_in_middle(ui, &name, text.width(), &TextStyle::Body);
        widgets::text_in(ui, text, &shown, &TextStyle::Body, color);
        let response =
            if shown == *name { response } else { response.on_hover_text(widgets::shortened(&name)) };
        eye(ui, context, row, &name, rect, response.id.with("eye"), requests);
        if response.hovered() {
            requests.push(Request::Hover(row.bone));
        }
        super::bone_menu::show(&response, context, Some(row.bone), requests);
        // The list does not scroll to a row that was clicked or whose menu was opened.
        if response.clicked() || (response.secondary_clicked() && !selected) {
            self.followed = Some(row.bone);
        }
        if response.double_clicked() {
            requests.push(Request::Command(super::commands::Id::FrameSelected));
        }
        response.clicked()
    }

    /// Folds or unfolds one bone; with `all`, everything below it too.
    fn fold(&mut self, row: HierarchyRow, context: &PanelContext<'_>, all: bool) {
        self.listed = None;
        let fold = !self.collapsed.contains(&row.bone);
        let count = if all { row.below as usize } else { 0 };
        let start = context.digest.rows.iter().position(|other| other.bone == row.bone).unwrap_or(0);
        for row in context.digest.rows.iter().skip(start).take(count + 1).filter(|row| row.parent) {
            if fold {
                self.collapsed.insert(row.bone);
            } else {
                self.collapsed.remove(&row.bone);
            }
        }
    }
}

/// Returns the distance of a row's content from the left edge. Bones below the fourth level are indented less, and the
/// indentation is limited, so that the names of a very deep skeleton stay readable.
fn indent_of(depth: u32, width: f32) -> f32 {
    let (wide, narrow) = (depth.min(4) as f32, depth.saturating_sub(4) as f32);
    10.0 + (wide * 12.0 + narrow * 5.0).min(width * 0.35)
}

/// Draws the eye icon at the right end of a row. A click hides the bone or shows it again; with Shift or Alt also all
/// bones below it. The icon of a visible bone is drawn only while the row is under the pointer or the icon has the
/// focus.
fn eye(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    row: HierarchyRow,
    name: &str,
    rect: Rect,
    id: egui::Id,
    requests: &mut Vec<Request>,
) {
    let theme = Theme::of(ui);
    let hidden = context.hidden.is_hidden(row.bone);
    let place = Rect::from_center_size(pos2(rect.right() - 20.0, rect.center().y), vec2(20.0, ROW));
    let over = ui.rect_contains_pointer(rect);
    let response = ui.interact(place, id, Sense::click());
    let verb = if hidden { "Show" } else { "Hide" };
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::accesskit::Role::Button, true, format!("{verb} {name}"))
    });
    if hidden || over || response.has_focus() {
        let icon = if hidden { Icon::Hidden } else { Icon::Shown };
        let tone = if response.hovered() { theme.text } else { theme.faint };
        icon.paint(ui.painter(), place, tone);
        widgets::focus_ring(ui, &response, place);
    }
    if response.clicked() {
        let all = ui.input(|input| input.modifiers.shift || input.modifiers.alt);
        let count = if all { row.below as usize } else { 0 };
        let rows = &context.digest.rows;
        let start = rows.iter().position(|other| other.bone == row.bone).unwrap_or(0);
        let bones = rows.iter().skip(start).take(count + 1).map(|row| row.bone).collect();
        requests.push(Request::Hide { bones, hide: !hidden });
    }
    let below = if row.parent { "\nShift: also all bones below it" } else { "" };
    response.on_hover_text(format!("{verb} {}{below}", widgets::shortened(name)));
}

/// Selects by a click on a row: with Ctrl it toggles, with Shift it adds all rows from the active bone to this one.
fn choose(
    ui: &Ui,
    context: &PanelContext<'_>,
    rows: &[(HierarchyRow, bool)],
    bone: BoneIndex,
    requests: &mut Vec<Request>,
) {
    let modifiers = ui.input(|input| input.modifiers);
    let place = |bone: BoneIndex| rows.iter().position(|(row, _)| row.bone == bone);
    let from = context.selected().and_then(place).zip(place(bone)).filter(|_| modifiers.shift);
    requests.push(match from {
        _ if modifiers.command => Request::SelectBones(vec![bone], Choice::Toggle),
        Some((from, to)) => {
            let between = rows[from.min(to)..=from.max(to)].iter().map(|(row, _)| row.bone);
            // The one that was clicked becomes the active one.
            let mut bones: Vec<BoneIndex> = between.filter(|&other| other != bone).collect();
            bones.push(bone);
            Request::SelectBones(bones, Choice::Add)
        }
        None if modifiers.shift => Request::SelectBones(vec![bone], Choice::Add),
        None => Request::Select(Some(bone)),
    });
}

/// Draws a small triangle that points right when the row is folded, and down when it is not.
fn fold_mark(ui: &Ui, center: egui::Pos2, folded: bool, color: egui::Color32) {
    let points = if folded {
        vec![center + vec2(-2.0, -4.0), center + vec2(3.0, 0.0), center + vec2(-2.0, 4.0)]
    } else {
        vec![center + vec2(-4.0, -2.0), center + vec2(4.0, -2.0), center + vec2(0.0, 3.0)]
    };
    ui.painter().add(egui::Shape::convex_polygon(points, color, egui::Stroke::NONE));
}

/// Returns the rows whose bone satisfies `hit` (flag true) and all their ancestors (flag false), in order.
fn matching(rows: &[HierarchyRow], hit: impl Fn(BoneIndex) -> bool) -> Vec<(HierarchyRow, bool)> {
    let hits: Vec<bool> = rows.iter().map(|row| hit(row.bone)).collect();
    let mut kept = hits.clone();
    // From the last row to the first: a row that is kept also keeps its ancestors, which are the rows before it with
    // less depth.
    let mut wanted: Option<u32> = None;
    for index in (0..rows.len()).rev() {
        let depth = rows[index].depth;
        if wanted.is_some_and(|below| depth < below) {
            kept[index] = true;
        }
        if kept[index] {
            // Rows between a kept row and its ancestor are below that ancestor, so the ancestors of this row are enough.
            wanted = (depth > 0).then_some(depth);
        }
    }
    rows.iter().zip(hits).zip(kept).filter(|(_, kept)| *kept).map(|((row, hit), _)| (*row, hit)).collect()
}
