//! Bytes, error, and time to make of compressed takes, next to those of the rivals.

use crate::model::BenchModel;
use crate::rivals::RivalSize;
use dragonfly_anim::compressed::{CompressionSettings, Exactness, compress};
use dragonfly_kit::figures::Figure;
use std::time::Instant;

/// Exactness that all codecs are given, in meters, with its name in the results.
const SETTINGS: [(&str, Exactness); 2] =
    [("0.1 mm at 3 cm", Exactness::FINE), ("1 mm at 10 cm", Exactness::COARSE)];

/// Millimeters per unit of the bench rig.
const MILLIMETERS: f64 = 1e3;

/// Returns bytes and errors of the takes of the bench rig, of this library and of the rivals.
///
/// Where ACL's error is smaller than the setting allows, this library gets ACL's error as its
/// tolerance, so that the sizes can be compared.
pub(crate) fn sizes(rig: &BenchModel, rivals: &[RivalSize]) -> Vec<Figure> {
    let mut rows = Vec::new();
    for take in &rig.model.animation.takes {
        for (setting, exactness) in SETTINGS {
            let task = format!("size/{}/{setting}", take.name);
            let of_task = || rivals.iter().filter(|size| size.take == take.name && size.setting == setting);
            let acl = of_task().find(|size| size.codec == "ACL").map_or(f64::INFINITY, |size| size.error);
            let tolerance = exactness.tolerance.min((acl / MILLIMETERS) as f32);
            let settings = CompressionSettings {
                everywhere: Exactness { tolerance, ..exactness },
                ..CompressionSettings::default()
            };
            let start = Instant::now();
            let Ok((compressed, report)) = compress(take, &rig.model.animation.skeleton, &settings) else {
                continue;
            };
            let seconds = start.elapsed().as_secs_f64();
            let ours = RivalSize {
                take: take.name.clone(),
                setting: setting.to_owned(),
                codec: "ours".to_owned(),
                bytes: report.bytes.total() as f64,
                error: f64::from(report.largest_error.distance) * MILLIMETERS,
                seconds,
            };
            let mut row =
                |codec: &str, metric, unit, value| rows.push(Figure::new(&task, codec, metric, unit, value));
            row("raw", "bytes", "bytes", report.raw_bytes as f64);
            row("ours", "in memory", "bytes", compressed.bytes_in_memory() as f64);
            for size in std::iter::once(&ours).chain(of_task()) {
                row(&size.codec, "bytes", "bytes", size.bytes);
                row(&size.codec, "error", "mm", size.error);
                row(&size.codec, "compress", "s", size.seconds);
            }
        }
    }
    rows
}

/// Prints the rows of [`sizes`].
pub(crate) fn print(rows: &[Figure]) {
    println!("\nSizes of compressed takes");
    for Figure { task, variant, metric, unit, value, .. } in rows {
        println!("{task:<34} {variant:<6} {metric:<12} {value:>12.4} {unit}");
    }
}
