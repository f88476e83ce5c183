//! The keys as triangles, rebuilt only when something that they depend on changed.

use super::rows::{DopeRow, RowKind};
use super::sheet::{ROW, Sheet};
use crate::panels::keys::columns::Columns;
use crate::panels::keys::{Drawn, KeySelection, TimeScale, channel};
use dragonfly_anim::data::Take;
use egui::{Color32, Mesh, Painter, Pos2, Rect, Shape, pos2, vec2};
use std::collections::HashSet;
use std::sync::Arc;

/// The triangles of all visible keys.
#[derive(Debug, Default)]
pub(super) struct KeysMesh {
    made_of: Option<KeysMeshKey>,
    mesh: Arc<Mesh>,
    plain: Columns,
    chosen: Columns,
    marks: Vec<Mark>,
    /// Addresses of the columns of times that are marked in a row.
    marked: HashSet<*const [f32]>,
    /// Number of selected keys, with the selection and the take that it was counted for.
    count: Option<(KeySelection, Arc<Take>, usize)>,
}

/// Everything that the triangles depend on.
#[derive(Debug)]
struct KeysMeshKey {
    drawn: Drawn,
    rows: Arc<[DopeRow]>,
    scale: TimeScale,
    canvas: Rect,
    scroll: f32,
    pixels_per_point: f32,
    dark: bool,
    flags: u64,
}

/// A key, or several in one column of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mark {
    /// Horizontal position, points.
    pub(super) x: f32,
    /// Whether one of the keys is selected.
    pub(super) chosen: bool,
}

/// Distance below which keys are drawn as one band, points.
const DENSE: f32 = 6.0;
/// Distance from the center of a diamond to its corners, points.
const RADIUS: f32 = 4.5;

impl KeysMesh {
    /// Returns the number of selected keys.
    pub(super) fn selected(&self) -> usize {
        self.count.as_ref().map_or(0, |(_, _, count)| *count)
    }

    /// Draws the keys in sight.
    pub(super) fn paint(&mut self, painter: &Painter, sheet: &Sheet<'_>) {
        let Sheet { areas, rows, scroll, scale, drawn, context, theme } = *sheet;
        let live = context.keys.selection();
        if let Some(take) = context.shared_take()
            && !self
                .count
                .as_ref()
                .is_some_and(|(selection, of, _)| selection.same(live) && Arc::ptr_eq(of, take))
        {
            self.count = Some((live.clone(), Arc::clone(take), live.count(take)));
        }
        let made_of = KeysMeshKey {
            drawn: drawn.clone(),
            rows: Arc::clone(rows.list()),
            scale: *scale,
            canvas: areas.canvas,
            scroll,
            pixels_per_point: painter.pixels_per_point(),
            dark: theme.dark,
            flags: context.keys.flags().version(),
        };
        let same = self.made_of.as_ref().is_some_and(|old| old.same(&made_of));
        if !same {
            self.made_of = Some(made_of);
            self.rebuild(sheet, painter.pixels_per_point());
        }
        painter
            .with_clip_rect(areas.canvas.intersect(painter.clip_rect()))
            .add(Shape::Mesh(Arc::clone(&self.mesh)));
    }

    fn rebuild(&mut self, sheet: &Sheet<'_>, pixels_per_point: f32) {
        let Sheet { areas, rows, scroll, scale, drawn, context, theme } = *sheet;
        let mut mesh = Mesh::default();
        let canvas = areas.canvas;
        let pen = Pen { feather: 1.0 / pixels_per_point };
        let first = (scroll / ROW).floor().max(0.0) as usize;
        let last = ((scroll + canvas.height()) / ROW).ceil().max(0.0) as usize;
        // Wider than the canvas, so that a diamond whose middle is outside is not cut.
        let (left, right) = (canvas.left() - RADIUS, canvas.right() + RADIUS);
        for (at, row) in rows.list().iter().enumerate().take(last).skip(first) {
            self.plain.reset(*scale, left, right, pixels_per_point);
            self.chosen.reset(*scale, left, right, pixels_per_point);
            self.marked.clear();
            for &id in rows.of(row.kind) {
                let Some(times) = channel::shared_times(&drawn.take, id) else { continue };
                let selected = drawn.selection.of(id);
                // In most files many channels share a column of times.
                if selected.is_empty() && !self.marked.insert(Arc::as_ptr(times)) {
                    continue;
                }
                self.plain.mark(times, selected, false);
                self.chosen.mark(times, selected, true);
            }
            if row.kind == RowKind::Morphs {
                let selected = drawn.selection.shapes();
                for morph in &drawn.take.morphs {
                    self.plain.mark(&morph.times, selected, false);
                    self.chosen.mark(&morph.times, selected, true);
                }
            }
            let color = match row.kind {
                RowKind::Summary => theme.weak,
                RowKind::Morphs => theme.faint,
                RowKind::Bone(bone) | RowKind::Channel(bone, _) if context.keys.flags().locked(bone) => {
                    theme.faint
                }
                RowKind::Bone(_) => theme.key,
                RowKind::Channel(..) => theme.key.gamma_multiply(0.85),
            };
            let y = canvas.top() - scroll + (at as f32 + 0.5) * ROW;
            merge(&self.plain, &self.chosen, &mut self.marks);
            pen.row(&mut mesh, &self.marks, y, [color, theme.accent]);
        }
        self.mesh = Arc::new(mesh);
    }
}

impl KeysMeshKey {
    /// Compares without reading the shared data.
    fn same(&self, other: &Self) -> bool {
        let (a, b) = (&self.drawn, &other.drawn);
        Arc::ptr_eq(&a.take, &b.take)
            && a.selection.same(&b.selection)
            && Arc::ptr_eq(&self.rows, &other.rows)
            && (self.scale, self.canvas, self.scroll) == (other.scale, other.canvas, other.scroll)
            && (self.pixels_per_point, self.dark, self.flags)
                == (other.pixels_per_point, other.dark, other.flags)
    }
}

/// Merges unselected and selected keys into one ascending list; a column with both counts as selected.
fn merge(plain: &Columns, chosen: &Columns, out: &mut Vec<Mark>) {
    out.clear();
    let mut chosen = chosen.marks().peekable();
    let mut push = |mark: Mark| match out.last_mut() {
        Some(last) if mark.x - last.x < 0.75 => last.chosen |= mark.chosen,
        _ => out.push(mark),
    };
    for x in plain.marks() {
        while let Some(x) = chosen.next_if(|&other| other <= x) {
            push(Mark { x, chosen: true });
        }
        push(Mark { x, chosen: false });
    }
    chosen.for_each(|x| push(Mark { x, chosen: true }));
}

/// Draws marks into a mesh.
#[derive(Clone, Copy, Debug)]
pub(in crate::panels) struct Pen {
    /// Width over which an edge fades, points.
    pub(in crate::panels) feather: f32,
}

impl Pen {
    fn row(self, mesh: &mut Mesh, marks: &[Mark], y: f32, colors: [Color32; 2]) {
        let color = |mark: &Mark| colors[usize::from(mark.chosen)];
        let mut at = 0;
        while at < marks.len() {
            let mut end = at + 1;
            while end < marks.len() && marks[end].x - marks[end - 1].x < DENSE {
                end += 1;
            }
            let run = &marks[at..end];
            if run.len() < 4 {
                for mark in run {
                    self.diamond(mesh, pos2(mark.x, y), RADIUS, color(mark));
                }
            } else {
                self.band(mesh, run, y, colors);
            }
            at = end;
        }
    }

    /// Draws keys that are too dense for diamonds: a band in segments of one color, with a line where a key is still
    /// visible.
    fn band(self, mesh: &mut Mesh, run: &[Mark], y: f32, colors: [Color32; 2]) {
        let mut at = 0;
        while at < run.len() {
            let chosen = run[at].chosen;
            let mut end = at + 1;
            while end < run.len() && run[end].chosen == chosen {
                end += 1;
            }
            let right = if end < run.len() { run[end].x - 1.0 } else { run[end - 1].x + 1.0 };
            let rect =
                Rect::from_min_max(pos2(run[at].x - 1.0, y - 4.0), pos2(right.max(run[at].x), y + 4.0));
            let color = colors[usize::from(chosen)];
            mesh.add_colored_rect(rect, color.gamma_multiply(0.45));
            // Lines that touch become one.
            let mut lines = run[at..end].iter().map(|mark| mark.x).peekable();
            while let Some(first) = lines.next() {
                let mut last = first;
                while let Some(next) = lines.next_if(|&next| next - last < 1.5) {
                    last = next;
                }
                let line = Rect::from_min_max(pos2(first - 0.5, y - 4.0), pos2(last + 0.5, y + 4.0));
                mesh.add_colored_rect(line, color.gamma_multiply(0.6));
            }
            at = end;
        }
    }

    /// Draws a diamond with soft edges.
    pub(in crate::panels) fn diamond(self, mesh: &mut Mesh, center: Pos2, radius: f32, color: Color32) {
        let first = mesh.vertices.len() as u32;
        let corners = [vec2(0.0, -1.0), vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(-1.0, 0.0)];
        let half = self.feather * std::f32::consts::FRAC_1_SQRT_2;
        for corner in corners {
            mesh.colored_vertex(center + corner * (radius - half), color);
        }
        for corner in corners {
            mesh.colored_vertex(center + corner * (radius + half), Color32::TRANSPARENT);
        }
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first, first + 2, first + 3);
        for side in 0..4 {
            let (a, b) = (first + side, first + (side + 1) % 4);
            mesh.add_triangle(a, b, b + 4);
            mesh.add_triangle(a, b + 4, a + 4);
        }
    }
}
