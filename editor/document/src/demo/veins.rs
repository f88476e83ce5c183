//! The wing texture: a clear, faintly tinted membrane, the net of veins, the amber cell near each tip. The veins are
//! those of a real wing: strong ones along the leading edge, rungs between them, a field of small polygonal cells
//! after them.

use super::chart::WING_SCALE;
use super::num::{curve, fractal, hash, mix, smooth};
use super::paint::sheen;
use super::wing_plan::{PICTURE, PLANS, WingPlan};
use glam::{Vec2, Vec3};

/// Lengthwise veins: (fraction of the span, fraction of the chord from the leading edge) and width in texels. The last
/// point may be on the trailing edge.
const LONG: [(&[(f32, f32)], f32); 9] = [
    (&[(0.0, 0.25), (0.03, 0.12), (0.25, 0.075), (0.42, 0.06), (0.50, 0.0)], 2.0),
    (
        &[
            (0.0, 0.42),
            (0.03, 0.22),
            (0.25, 0.145),
            (0.50, 0.115),
            (0.75, 0.095),
            (0.90, 0.10),
            (0.97, 0.14),
            (0.995, 0.3),
        ],
        2.8,
    ),
    (&[(0.12, 0.19), (0.30, 0.205), (0.50, 0.195), (0.75, 0.20), (0.92, 0.27), (0.985, 0.5)], 1.8),
    (
        &[(0.16, 0.21), (0.35, 0.29), (0.55, 0.32), (0.75, 0.40), (0.90, 0.58), (0.955, 0.85), (0.965, 1.0)],
        1.8,
    ),
    (&[(0.12, 0.21), (0.30, 0.36), (0.50, 0.46), (0.68, 0.62), (0.80, 0.84), (0.845, 1.0)], 1.7),
    (&[(0.08, 0.26), (0.22, 0.40), (0.40, 0.54), (0.55, 0.70), (0.66, 0.88), (0.70, 1.0)], 1.7),
    (&[(0.06, 0.30), (0.16, 0.44), (0.32, 0.62), (0.44, 0.80), (0.52, 1.0)], 1.7),
    (&[(0.03, 0.30), (0.08, 0.46), (0.18, 0.64), (0.28, 0.84), (0.33, 1.0)], 1.7),
    (&[(0.02, 0.34), (0.045, 0.56), (0.09, 0.78), (0.13, 1.0)], 1.6),
];
/// Start and end of the amber cell, as fractions of the span.
const AMBER: (f32, f32) = (0.815, 0.895);
/// The mean width of a cell of the field, in units.
const CELL: f32 = 0.0125;

/// How strongly each texel is vein.
struct Ink {
    width: usize,
    height: usize,
    vein: Vec<f32>,
}

impl Ink {
    /// Draws a line of `wide` texels, softened over one.
    fn line(&mut self, a: Vec2, b: Vec2, wide: f32) {
        let reach = wide * 0.5 + 1.0;
        let (low, high) = (a.min(b) - reach, a.max(b) + reach);
        let clamp = |v: f32, n: usize| v.clamp(0.0, n as f32) as usize;
        let along = b - a;
        let length2 = along.length_squared().max(1e-9);
        for y in clamp(low.y, self.height)..clamp(high.y + 1.0, self.height) {
            for x in clamp(low.x, self.width)..clamp(high.x + 1.0, self.width) {
                let p = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) - a;
                let t = (p.dot(along) / length2).clamp(0.0, 1.0);
                let cover = (wide * 0.5 + 0.5 - (p - along * t).length()).clamp(0.0, 1.0);
                let texel = &mut self.vein[y * self.width + x];
                *texel = texel.max(cover);
            }
        }
    }
}

/// A texel with nothing on it.
const CLEAR: [u8; 4] = [90, 64, 28, 0];

/// Paints both wings; four bytes a texel, color then coverage.
pub(super) fn paint(width: usize, height: usize) -> Vec<u8> {
    // Clear texels keep the veins' color, or filtering would bring a pale fringe.
    let mut bytes: Vec<u8> = CLEAR.repeat(width * height);
    for (pair, plan) in PLANS.iter().enumerate() {
        let mut ink = Ink { width, height, vein: vec![0.0; width * height] };
        draw_veins(plan, pair as u32, &mut ink);
        let (x0, y0) = (plan.chart.x as usize, plan.chart.y as usize);
        for y in y0..y0 + plan.chart.h as usize {
            for x in x0..x0 + plan.chart.w as usize {
                let span = PICTURE.0 + (x as f32 + 0.5 - plan.chart.x) / WING_SCALE;
                let chord = PICTURE.1 - (y as f32 + 0.5 - plan.chart.y) / WING_SCALE;
                let at = (y * width + x) * 4;
                let texel = texel(plan, pair as u32, span, chord, ink.vein[y * width + x]);
                bytes[at..at + 4].copy_from_slice(&texel);
            }
        }
    }
    bytes
}

fn draw_veins(plan: &WingPlan, seed: u32, ink: &mut Ink) {
    let texel = |span: f32, chord: f32| {
        Vec2::new(
            plan.chart.x + (span - PICTURE.0) * WING_SCALE,
            plan.chart.y + (PICTURE.1 - chord) * WING_SCALE,
        )
    };
    let point = |s: f32, f: f32| {
        let span = s * plan.length;
        texel(span, mix(plan.lead(span), plan.trail(span), f))
    };
    let mut stroke = |from: f32, to: f32, wide: f32, at: &dyn Fn(f32) -> f32| {
        let steps = 160;
        let s = |k: usize| mix(from, to, k as f32 / steps as f32);
        for k in 0..steps {
            ink.line(point(s(k), at(s(k))), point(s(k + 1), at(s(k + 1))), wide);
        }
    };
    // The rim: a strong costa in front, a thin one at the back.
    stroke(-0.01, 0.93, 3.4, &|_| 0.02);
    stroke(0.93, 1.0, 2.4, &|_| 0.02);
    stroke(-0.01, 1.0, 1.5, &|_| 0.99);
    for (points, wide) in LONG {
        let (from, to) = (points[0].0, points[points.len() - 1].0);
        stroke(from, to, wide * 1.25, &|s| curve(points, s));
    }
    let vein = |i: usize, s: f32| curve(LONG[i].0, s);
    let mut rungs =
        |from: f32, to: f32, step: f32, wide: f32, upper: &dyn Fn(f32) -> f32, lower: &dyn Fn(f32) -> f32| {
            let count = ((to - from) / step) as i32;
            for k in 0..=count {
                let s = from + step * (k as f32 + 0.35 * (hash(k, (from * 97.0) as i32, seed) - 0.5));
                ink.line(point(s, upper(s)), point(s + 0.002, lower(s)), wide);
            }
        };
    // Rungs before the notch cross two cells, those after it one; the amber cell has none.
    rungs(0.03, 0.495, 0.026, 1.4, &|_| 0.0, &|s| vein(1, s));
    rungs(0.52, 0.80, 0.024, 1.2, &|_| 0.0, &|s| vein(1, s));
    rungs(0.905, 0.975, 0.02, 1.0, &|_| 0.0, &|s| vein(1, s));
    rungs(0.13, 0.965, 0.021, 1.1, &|s| vein(1, s), &|s| vein(2, s));
    rungs(0.18, 0.93, 0.019, 1.1, &|s| vein(2, s), &|s| vein(3, s));
    let notch = 0.50;
    ink.line(point(notch, 0.0), point(notch + 0.004, vein(1, notch)), 3.0);
    for s in [AMBER.0, AMBER.1] {
        ink.line(point(s + 0.004, 0.0), point(s - 0.004, vein(1, s)), 1.8);
    }
}

/// Distance to the nearest wall between cells of the field, in units.
fn wall(span: f32, chord: f32, edge: f32, seed: u32) -> f32 {
    // A hem of smaller cells runs along the trailing edge.
    let size = if edge < 0.025 { CELL * 0.8 } else { CELL };
    let (gx, gy) = (span / size, chord / size * 1.12);
    let (cx, cy) = (gx.floor() as i32, gy.floor() as i32);
    let mut cells = [(f32::MAX, Vec2::ZERO); 2];
    for j in cy - 2..=cy + 2 {
        for i in cx - 2..=cx + 2 {
            let stagger = if j.rem_euclid(2) == 0 { 0.0 } else { 0.5 };
            let at = Vec2::new(
                i as f32 + stagger + 0.5 + 0.5 * (hash(i, j, seed) - 0.5),
                j as f32 + 0.5 + 0.5 * (hash(i, j, seed + 9) - 0.5),
            );
            let d = (at - Vec2::new(gx, gy)).length();
            if d < cells[0].0 {
                cells = [(d, at), cells[0]];
            } else if d < cells[1].0 {
                cells[1] = (d, at);
            }
        }
    }
    let between = cells[1].1 - cells[0].1;
    let middle = (cells[0].1 + cells[1].1) * 0.5;
    (middle - Vec2::new(gx, gy)).dot(between.normalize()) * size
}

fn texel(plan: &WingPlan, seed: u32, span: f32, chord: f32, mut vein: f32) -> [u8; 4] {
    let (lead, trail) = (plan.lead(span), plan.trail(span));
    let s = span / plan.length;
    let f = (lead - chord) / (lead - trail).max(1e-4);
    // A soft rim of one texel, except where the rim's own vein carries it.
    let inside = ((lead - chord).min(chord - trail) * WING_SCALE + 0.5).clamp(0.0, 1.0);
    let inside = if s > 1.0 || span < PICTURE.0 + 0.002 { 0.0 } else { inside };
    let strong = vein > 0.0;
    // The field starts after the third lengthwise vein; nearer the base, after the second.
    let field = curve(LONG[3].0, s).min(if s < 0.16 { 0.22 } else { 1.0 });
    if f > field && s > 0.02 {
        let d = wall(span, chord, chord - trail, seed + 40) * WING_SCALE;
        vein = vein.max((1.05 - d).clamp(0.0, 1.0) * 0.92);
    }
    let amber = if s > AMBER.0 - 0.004 * (1.0 - f) && s < AMBER.1 && f > 0.0 && f < curve(LONG[1].0, s) {
        1.0
    } else {
        0.0
    };
    // The membrane's color is kept not much lighter than the veins', or veins would turn pale where
    // filtering blends the two. It is warm at the root and along the front, elsewhere a breath of
    // green and rose.
    let warm = (0.9 * (1.0 - smooth(0.0, 0.20, s)) + 0.4 * (1.0 - smooth(0.04, 0.2, f))).min(1.0);
    let film = sheen(1.5 * s + 0.8 * f + 0.4 * fractal(s * 5.0, f * 3.0, seed + 60));
    let cool = Vec3::new(0.46, 0.62, 0.60).lerp(film * 0.85, 0.25);
    let clear = cool.lerp(Vec3::new(0.66, 0.45, 0.13), warm);
    let clear = clear.lerp(Vec3::new(0.48, 0.22, 0.05), amber);
    let thin = mix(0.12 + 0.12 * warm, 0.95, amber);
    // The costa is straw yellow, as on many hawkers; the strong veins are gold brown, which reads
    // before dark and light alike, and the net of cells between them is darker.
    let root = 1.0 - smooth(0.0, 0.25, s);
    let net = Vec3::new(0.22, 0.17, 0.10).lerp(Vec3::new(0.40, 0.26, 0.10), 0.7 * root);
    let dark = if strong { Vec3::new(0.52, 0.38, 0.17) } else { net };
    let costa = (lead - chord) * WING_SCALE < 3.0 && s < 0.93;
    let dark = if costa { Vec3::new(0.72, 0.56, 0.22) } else { dark };
    // A texel that a vein touches keeps its color, and only its coverage changes: that compresses far better, and
    // filtering blends them anyway.
    let cover = vein * 0.97 + thin * (1.0 - vein * 0.97);
    let color = if vein > 0.0 { dark } else { clear };
    if inside <= 0.0 && vein <= 0.0 {
        return CLEAR;
    }
    let cover = cover * inside.max(if s <= 1.0 { vein } else { 0.0 });
    let level =
        |x: f32, step: f32| (((x.clamp(0.0, 1.0) * 255.0) / step + 0.5).floor() * step).min(255.0) as u8;
    [level(color.x, 10.0), level(color.y, 10.0), level(color.z, 10.0), level(cover, 17.0)]
}
