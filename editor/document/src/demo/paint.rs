//! Painters: color, relief and gloss of every part, as functions of a place on its chart.
//!
//! Only the left half is painted; the right half wears the same texels mirrored.

use super::body::ring_at;
use super::head::eye_direction;
use super::num::{bump, cos, fractal, hash, mix, noise, smooth};
use super::skeleton::ABDOMEN_LENGTH;
use glam::Vec3;

/// The paint at one point of a surface.
#[derive(Clone, Copy)]
pub(super) struct Paint {
    /// Color as it is stored, 0..1 (sRGB).
    pub(super) color: Vec3,
    /// Height above the smooth surface, in texels.
    pub(super) height: f32,
    pub(super) roughness: f32,
    pub(super) metallic: f32,
    /// 1 open to the sky, 0 at the bottom of a fold.
    pub(super) openness: f32,
}

const fn rgb(hex: u32) -> Vec3 {
    const fn part(byte: u32) -> f32 {
        (byte & 255) as f32 / 255.0
    }
    Vec3::new(part(hex >> 16), part(hex >> 8), part(hex))
}

const INK: Vec3 = rgb(0x14_1F_1C);
const BRONZE: Vec3 = rgb(0x2A_40_2E);
const EMERALD: Vec3 = rgb(0x1A_7E_58);
const LEAF: Vec3 = rgb(0x4E_AE_58);
const LIME: Vec3 = rgb(0xB8_CE_58);
const TURQUOISE: Vec3 = rgb(0x2A_B8_B0);
const AZURE: Vec3 = rgb(0x2C_86_D8);

fn plain(color: Vec3) -> Paint {
    Paint { color, height: 0.0, roughness: 0.42, metallic: 0.0, openness: 1.0 }
}

/// The abdomen: dark rings, each with a broad bright saddle on either side of a dark back.
pub(super) fn abdomen(a: f32, b: f32) -> Paint {
    let along = a * ABDOMEN_LENGTH;
    let (ring, part) = ring_at(along);
    let last = ring >= 8;
    let grain = fractal(a * 150.0, b * 26.0, 11);
    let cloud = fractal(a * 26.0, b * 5.0, 21);

    let mut color = BRONZE.lerp(INK, 0.35 + 0.5 * cloud);
    // Saddles: the bright field of each ring, broken by the dark back, belly and rear rim.
    let wobble = 0.05 * (fractal(a * 60.0, b * 8.0, 31) - 0.5);
    let back = match ring {
        0 | 1 => 0.07,
        7 | 8 => 0.05,
        _ => mix(0.085, 0.27, smooth(0.25, 0.95, part)),
    };
    let rear = match ring {
        7 | 8 => 0.86,
        9 => 1.4,
        _ => 0.80,
    };
    let side = smooth(back - 0.025, back + 0.035, b + wobble);
    let belly = 1.0 - smooth(0.60, 0.70, b + wobble);
    let front = smooth(0.02, 0.08, part);
    let hind = 1.0 - smooth(rear - 0.05, rear + 0.04, part + 0.9 * wobble);
    // A thin dark bar across each long ring, as though drawn with a pen.
    let bar = if (2..=6).contains(&ring) {
        1.0 - 0.85 * bump(0.30, 0.035, part) * smooth(0.12, 0.2, b)
    } else {
        1.0
    };
    let saddle = side * belly * front * hind * bar;
    let tone = match ring {
        0 => LEAF,
        1 => LEAF.lerp(TURQUOISE, 0.55),
        7 | 8 => AZURE.lerp(TURQUOISE, 0.25),
        9 => INK.lerp(AZURE, 0.25),
        _ => EMERALD.lerp(TURQUOISE, 0.72).lerp(AZURE, 0.13 * (ring as f32 - 2.0)),
    };
    // Deeper towards the belly, with a drift of hue as from thin layers.
    let film = sheen(0.22 + 0.35 * b + 0.25 * cloud + 0.02 * grain);
    let bright = tone.lerp(tone * film * 1.35, 0.32) * mix(1.0, 0.72, smooth(0.3, 0.62, b));
    color = color.lerp(bright, saddle);
    // The dark parts are not black: they shimmer bronze to violet.
    let shimmer = sheen(0.3 + 0.8 * a + 0.5 * cloud) * 0.16;
    color += shimmer * (1.0 - saddle) * (0.4 + 0.6 * cloud);
    // A pale dash on either side of the back, next to each front rim.
    if (2..=6).contains(&ring) {
        let dash = bump(0.12, 0.05, part) * bump(0.045, 0.035, b);
        color = color.lerp(LIME, 0.8 * dash);
    }
    let under = smooth(0.72, 0.9, b);
    color = color.lerp(rgb(0x3A_4A_3C), 0.6 * under);
    color *= 0.90 + 0.20 * grain;

    let fold = bump(0.0, 0.035, part) + bump(1.0, 0.02, part);
    let fold = if last && part > 0.5 { bump(0.0, 0.035, part) } else { fold.min(1.0) };
    color *= 1.0 - 0.6 * fold;
    // Fine cross ridges, a keel along the back, and the pits of short hairs.
    let pit = smooth(0.80, 0.95, noise(a * 310.0, b * 52.0, 41));
    let height = 0.45 * (grain - 0.5) - 2.4 * fold + 0.9 * bump(0.0, 0.07, b) - 0.45 * pit
        + 0.5 * bump(0.30, 0.03, part)
        + 0.8 * bump(0.90, 0.08, part)
        - 0.9 * bump(0.68, 0.025, b);
    Paint {
        color,
        height,
        roughness: mix(0.34, 0.46, grain) + 0.25 * fold,
        metallic: 0.10 + 0.14 * saddle,
        openness: 1.0 - 0.55 * fold,
    }
}

/// The thorax: polished green, two bright slanting stripes edged in black, sutures between.
pub(super) fn thorax(a: f32, b: f32) -> Paint {
    let grain = fractal(a * 60.0, b * 60.0, 51);
    let cloud = fractal(a * 7.0, b * 7.0, 61);
    // Places on the flank are read along lines that lean back as the sutures do.
    let lean = a - 0.30 * (0.5 - b) + 0.02 * (cloud - 0.5);
    let flank = smooth(0.13, 0.22, b) * (1.0 - smooth(0.80, 0.88, b));
    let stripe = |center: f32, half: f32| 1.0 - smooth(half * 0.75, half, (lean - center).abs());
    let band = |center: f32, half: f32, rim: f32| {
        (
            stripe(center, half) * flank,
            stripe(center, half + rim) * smooth(0.10, 0.16, b) * (1.0 - smooth(0.83, 0.92, b)),
        )
    };
    let (first, first_rim) = band(0.475, 0.058, 0.034);
    let (second, second_rim) = band(0.735, 0.066, 0.034);
    // The short stripe before the fore wing, on the front of the back.
    let reach = smooth(0.17, 0.21, a) * (1.0 - smooth(0.37, 0.42, a));
    let shoulder = bump(0.135 + 0.18 * (a - 0.2), 0.055, b) * reach;

    let film = sheen(0.30 + 0.30 * b + 0.30 * cloud);
    let mut color = EMERALD.lerp(EMERALD * film * 1.7, 0.35) * mix(0.72, 1.05, cloud);
    color = color.lerp(INK, 0.88 * first_rim.max(second_rim));
    let bright = LIME.lerp(LEAF, smooth(0.3, 0.85, b) * 0.65);
    color = color.lerp(bright, first.max(second));
    color = color.lerp(LIME, smooth(0.2, 0.8, shoulder) * 0.9);
    // Black keel down the front, pale soft skin between the wings, dark belly and neck.
    color = color.lerp(INK, 0.85 * bump(0.0, 0.035, b) * smooth(0.1, 0.2, a) * (1.0 - smooth(0.36, 0.42, a)));
    let saddle = smooth(0.44, 0.48, a) * (1.0 - smooth(0.86, 0.91, a)) * (1.0 - smooth(0.10, 0.135, b));
    let spot = |center: f32, half: f32| {
        let (x, y) = ((a - center) / half, b / 0.085);
        1.0 - smooth(0.55, 1.1, x * x + y * y)
    };
    let plates = (spot(0.535, 0.040) + spot(0.68, 0.050) + spot(0.80, 0.032)).min(1.0);
    color = color.lerp(rgb(0x1C_30_2A), saddle);
    color = color.lerp(TURQUOISE * 0.9, 0.85 * saddle * plates);
    let belly = smooth(0.84, 0.94, b);
    color = color.lerp(rgb(0x33_3C_2C), 0.8 * belly);
    color = color.lerp(INK, 0.8 * (1.0 - smooth(0.08, 0.14, a)));
    color = color.lerp(rgb(0x9A_B8_50), 0.5 * bump(0.155, 0.02, a) * smooth(0.1, 0.3, b));
    color *= 1.0 - 0.4 * bump(0.16, 0.07, a);
    color *= 0.90 + 0.2 * grain;

    let suture =
        |center: f32| bump(center, 0.016, lean) * smooth(0.1, 0.2, b) * (1.0 - smooth(0.86, 0.95, b));
    let seams = (suture(0.385) + suture(0.60) + suture(0.845)).min(1.0);
    let collar = bump(0.195, 0.03, a) + bump(0.10, 0.03, a);
    let fuzz = hash((a * 332.0) as i32, (b * 332.0) as i32, 7) - 0.5;
    color *= 1.0 - 0.55 * seams - 0.3 * collar.min(1.0);
    let height = 0.5 * (grain - 0.5) + 0.12 * fuzz - 3.0 * seams - 2.2 * collar
        + 2.5 * bump(0.0, 0.04, b) * (1.0 - smooth(0.36, 0.44, a))
        + 2.0 * saddle * plates
        + 0.8 * first.max(second);
    Paint {
        color,
        height,
        roughness: mix(0.30, 0.44, grain) + 0.2 * seams,
        metallic: 0.22 * (1.0 - saddle),
        openness: 1.0 - 0.5 * seams - 0.35 * collar.min(1.0) - 0.3 * belly,
    }
}

/// The face: dark crown, a pale shield of three plates, dark jaws and nape.
pub(super) fn head(a: f32, b: f32) -> Paint {
    let grain = fractal(a * 50.0, b * 40.0, 71);
    let mut color = INK.lerp(BRONZE, grain);
    let mut height = 0.45 * (grain - 0.5);
    // Forehead, clypeus and lip, each a swelling with a groove below it.
    let face = smooth(0.335, 0.355, a) * (1.0 - smooth(0.755, 0.775, a));
    let forehead = rgb(0x86_B8_4E).lerp(TURQUOISE, 0.30 + 0.3 * grain);
    let clypeus = LIME.lerp(rgb(0xD8_DC_90), 0.30) * 0.95;
    let lip = LIME.lerp(rgb(0x8A_8A_3A), 0.45);
    let mut tone = forehead.lerp(clypeus, smooth(0.50, 0.52, a));
    tone = tone.lerp(lip, smooth(0.615, 0.635, a));
    color = color.lerp(tone * mix(1.05, 0.8, b), face);
    // Below the dark mouth line, the lower lip is dull horn.
    let chin = smooth(0.785, 0.80, a) * (1.0 - smooth(0.88, 0.92, a));
    color = color.lerp(rgb(0x6A_70_3A), 0.8 * chin);
    // The black T on the forehead.
    let t = bump(0.365, 0.035, a) * (1.0 - smooth(0.45, 0.55, b))
        + bump(0.40, 0.06, a) * (1.0 - smooth(0.05, 0.09, b));
    color = color.lerp(INK, (1.5 * t).min(1.0));
    let grooves = bump(0.51, 0.022, a) + bump(0.622, 0.018, a) + bump(0.765, 0.02, a);
    color *= 1.0 - 0.55 * grooves;
    height -= 3.0 * grooves;
    // Three simple eyes sit on the crown.
    let ocellus = bump(0.0, 0.06, ((a - 0.29) * (a - 0.29) * 4.0 + b * b * 0.5).sqrt())
        + bump(0.0, 0.06, ((a - 0.26) * (a - 0.26) * 4.0 + (b - 0.2) * (b - 0.2) * 0.5).sqrt());
    color = color.lerp(rgb(0xE6_A8_3C), (1.6 * ocellus).min(1.0));
    height += 4.0 * ocellus;
    let pit = smooth(0.80, 0.95, noise(a * 70.0, b * 50.0, 73));
    height -= 0.4 * pit;
    color *= 0.92 + 0.16 * grain;
    Paint {
        color,
        height,
        roughness: mix(0.34, 0.5, grain),
        metallic: 0.05,
        openness: 1.0 - 0.5 * grooves.min(1.0),
    }
}

/// A thigh: pale and green near the body, black towards the knee.
pub(super) fn femur(a: f32, b: f32) -> Paint {
    let grain = fractal(a * 40.0, b * 8.0, 81);
    let pale = rgb(0xA8_8A_3A).lerp(LEAF, 0.45);
    let mut paint =
        plain(pale.lerp(INK.lerp(rgb(0x3A_2E_1C), 0.5), smooth(0.36, 0.62, a + 0.12 * (grain - 0.5))));
    paint.color *= 0.8 + 0.4 * grain;
    paint.height = 0.45 * (grain - 0.5) + 0.8 * bump(0.5, 0.06, b);
    paint
}

/// A shin: black with a thin amber line on its upper side.
pub(super) fn tibia(a: f32, b: f32) -> Paint {
    let grain = fractal(a * 46.0, b * 8.0, 91);
    let line = bump(0.5, 0.12, b) * smooth(0.03, 0.1, a) * (1.0 - smooth(0.7, 0.95, a));
    let mut paint = plain(INK.lerp(rgb(0x3A_2E_1C), 0.7).lerp(rgb(0xA8_84_3A), 0.8 * line));
    paint.color *= 0.85 + 0.4 * grain;
    paint.height = 1.0 * (grain - 0.5);
    paint
}

/// A foot: black, in three joints.
pub(super) fn tarsus(a: f32, b: f32) -> Paint {
    let mut paint = dark(a, b);
    paint.height -= 2.0 * (bump(0.32, 0.03, a) + bump(0.62, 0.03, a));
    paint
}

/// The hip: green like the flank, darker at its rim.
pub(super) fn coxa(a: f32, b: f32) -> Paint {
    let grain = fractal(a * 20.0, b * 12.0, 101);
    let mut paint = plain(EMERALD.lerp(LEAF, 0.4 * grain).lerp(INK, smooth(0.6, 0.95, a)));
    paint.color *= mix(0.4, 0.65, grain);
    paint.height = 0.45 * (grain - 0.5);
    paint
}

/// The socket of a wing: dark green horn with an amber edge.
pub(super) fn socket(a: f32, b: f32) -> Paint {
    let grain = fractal(a * 20.0, b * 14.0, 111);
    let rim = smooth(0.55, 0.95, a);
    let mut paint = plain((EMERALD * 0.45).lerp(rgb(0x8A_6C_30), rim * 0.8));
    paint.color *= 0.9 + 0.2 * grain;
    paint.height = 0.6 * (grain - 0.5);
    paint
}

/// Plain dark horn: feelers, claspers, spines.
pub(super) fn dark(a: f32, b: f32) -> Paint {
    let grain = fractal(a * 40.0, b * 8.0, 121);
    let mut paint = plain(INK.lerp(BRONZE, 0.5 * grain));
    paint.height = 0.8 * (grain - 0.5);
    paint
}

/// Width and half the double row of the facets, in texels: whole numbers, so that the relief
/// repeats exactly and packs to almost nothing.
const FACET: (f32, f32) = (8.0, 7.0);

/// The compound eye: blue above, through green to gold below, under a net of facets.
pub(super) fn eye(a: f32, b: f32) -> Paint {
    let (x, y) = (a * 508.0 + 1.5, b * 508.0 + 1.5);
    let row = (y / FACET.1).floor();
    let mut near = [f32::MAX; 2];
    for j in [row - 1.0, row, row + 1.0, row + 2.0] {
        let shift = if (j as i32).rem_euclid(2) == 0 { 0.0 } else { 0.5 };
        let column = (x / FACET.0 - shift).floor();
        for i in [column, column + 1.0] {
            let (dx, dy) = (x - (i + shift) * FACET.0, y - j * FACET.1);
            let d = (dx * dx + dy * dy).sqrt();
            if d < near[0] {
                near = [d, near[0]];
            } else if d < near[1] {
                near[1] = d;
            }
        }
    }
    let rim = 1.0 - smooth(0.0, 1.8, near[1] - near[0]);
    let dome = 1.0 - near[0] * near[0] / 22.0;

    let d = eye_direction(a, b);
    let cloud = fractal(a * 6.0, b * 6.0, 131);
    let level = d.y + 0.06 * (cloud - 0.5);
    let crown = rgb(0x17_52_88);
    let teal = rgb(0x18_92_92);
    let green = rgb(0x44_A4_58);
    let gold = rgb(0xB4_BC_4A);
    let mut color = gold.lerp(green, smooth(-0.65, -0.2, level));
    color = color.lerp(teal, smooth(-0.15, 0.35, level));
    color = color.lerp(crown, smooth(0.40, 0.85, level));
    // Faint level bands, and the dark false pupils that seem to look back.
    let band = bump(0.12, 0.06, level) + 0.6 * bump(-0.12, 0.05, level) + 0.5 * bump(-0.34, 0.05, level);
    color *= 1.0 - 0.15 * band;
    let look = |p: Vec3, size: f32| smooth(1.0 - size, 1.0 - size * 0.3, d.dot(p.normalize()));
    let pupil = look(Vec3::new(0.62, -0.02, 0.78), 0.022)
        + 0.45 * look(Vec3::new(0.48, -0.27, 0.85), 0.010)
        + 0.45 * look(Vec3::new(0.84, -0.10, 0.50), 0.010);
    color = color.lerp(rgb(0x06_1E_26), (0.62 * pupil).min(0.8));
    color *= 0.92 + 0.16 * cloud;
    Paint {
        color,
        height: 1.9 * dome,
        roughness: mix(0.20, 0.60, rim),
        metallic: 0.0,
        openness: 1.0 - 0.6 * rim,
    }
}

/// A color that drifts through green, teal and violet as `turn` (0..1) goes round once: the
/// sheen of thin layers, baked in because it must show without reflections.
pub(super) fn sheen(turn: f32) -> Vec3 {
    let wave = |shift: f32| 0.5 + 0.5 * cos(std::f32::consts::TAU * (turn + shift));
    Vec3::new(wave(0.0), wave(-0.36), wave(-0.66))
}
