//! The page `README.md` in this folder shows what the tests measure: each algorithm, compared with an independent result.

use crate::{contact_labels, inbetween, reduce, retarget_blender, tangents, turns};
use dragonfly_anim::data::Interpolation;
use dragonfly_anim::tangents::TangentKind;
use std::path::{Path, PathBuf};

/// Writes the tables of the page, instead of comparing them, where it is set.
const UPDATE: &str = "DRAGONFLY_UPDATE_MEASURED";

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/anim/README.md")
}

/// Returns a number with two digits.
fn two_digits(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        value if value.abs() < 0.01 => format!("{value:.1e}"),
        value => format!("{value:.2}"),
    }
}

fn table(columns: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let mut text = line(&columns.iter().map(|&column| column.to_owned()).collect::<Vec<_>>());
    text += &format!("|---|{}\n", "--:|".repeat(columns.len() - 1));
    text + &rows.iter().map(|row| line(row)).collect::<String>()
}

/// Returns the table of differences from other programs.
fn differences() -> String {
    let auto = tangents::tangents_beside_scipy(TangentKind::Auto, "auto");
    let clamped = tangents::tangents_beside_scipy(TangentKind::Clamped, "clamped");
    let linear = turns::full_turns_beside_scipy(Interpolation::Linear);
    let spline = turns::full_turns_beside_scipy(Interpolation::CubicSpline);
    let (gaussian, butterworth) = (inbetween::gaussian_beside_scipy(), inbetween::butterworth_beside_scipy());
    let rows = [
        ("Gaussian", "SciPy `gaussian_filter1d`", gaussian, "", 1e-12),
        ("Butterworth, forward and backward", "SciPy `butter`, `filtfilt`", butterworth, "", 1e-9),
        ("median of peaks", "SciPy `medfilt`", inbetween::median_beside_scipy(), "", 1e-5),
        ("auto tangents", "NumPy `gradient`", auto, " of the steepest line", 1e-4),
        ("clamped tangents", "SciPy `PchipInterpolator`", clamped, " of the steepest line", 1e-4),
        ("shortest way between keys", "SciPy `Slerp`", turns::slerps_beside_scipy(), "°", 1e-3),
        ("full turns, linear", "SciPy `Rotation`", linear, "°", 1e-3),
        ("full turns, spline", "SciPy `Rotation`", spline, "°", 0.05),
        ("rotation some cycles later", "SciPy `Rotation`", turns::powers_beside_scipy(), "°", 1e-3),
        (
            "retargeting to other bone axes",
            "Blender, Copy Rotation constraints",
            retarget_blender::compared_with_blender(),
            "°",
            0.01,
        ),
    ];
    let rows = rows.map(|(what, reference, (count, worst), unit, limit)| {
        assert!(worst <= limit, "{what}: {worst}, at most {limit}");
        let [worst, limit] = [worst, limit].map(|value| format!("{}{unit}", two_digits(value)));
        vec![what.to_owned(), reference.to_owned(), count.to_string(), worst, limit]
    });
    table(&["algorithm", "compared with", "values", "largest difference", "the test allows"], &rows)
}

/// Returns the table of the reduction of keys, with its bound.
fn reduction() -> String {
    let cases = [
        ("Fox, Survey", "gltf/Fox.glb", "Survey", 10.0, 1.0),
        ("Fox, Walk", "gltf/Fox.glb", "Walk", 10.0, 1.0),
        ("Fox, Run", "gltf/Fox.glb", "Run", 10.0, 5.0),
    ];
    let rows = cases.map(|(name, file, take, unit, tolerance)| {
        let ([before, after], worst) = reduce::reduced_take(file, take, unit, tolerance);
        assert!(worst <= f64::from(tolerance) * (1.0 + 1e-6), "{name}: {worst}");
        vec![
            name.to_owned(),
            before.to_string(),
            after.to_string(),
            format!("{worst:.3} mm"),
            format!("{tolerance} mm"),
        ]
    });
    let (fewest, ours) = reduce::fewest_and_ours(34);
    let mut text = table(&["take", "keys", "keys left", "largest error", "bound"], &rows);
    text += &format!(
        "\nOf 60 random channels with 60 keys each, {ours} keys are left in all; the fewest possible, found by trying every \
         path, are {fewest}.\n"
    );
    text
}

/// Returns the table of contacts, with the labels.
fn contacts() -> String {
    let rows = contact_labels::labelled_feet().into_iter().map(|(name, found, allowed)| {
        let labelled = found.both + found.missed;
        vec![
            name,
            found.spans[0].to_string(),
            found.spans[1].to_string(),
            labelled.to_string(),
            format!("{} of {}", found.missed, allowed[0]),
            format!("{} of {}", found.extra, allowed[1]),
        ]
    });
    let columns = [
        "foot",
        "contacts labeled",
        "contacts found",
        "frames labeled",
        "frames missed, of allowed",
        "frames extra, of allowed",
    ];
    table(&columns, &rows.collect::<Vec<_>>())
}

#[test]
fn the_tables_of_the_page_are_what_the_tests_measure_now() {
    let old = std::fs::read_to_string(page()).expect("the page");
    let mut new = old.clone();
    for (name, table) in
        [("differences", differences()), ("reduction", reduction()), ("contacts", contacts())]
    {
        let marker = format!("<!-- measured: {name} -->\n");
        let (before, after) = new.split_once(&marker).unwrap_or_else(|| panic!("no {marker}"));
        let (_, after) = after.split_once("<!-- end -->").expect("an end");
        new = format!("{before}{marker}{table}<!-- end -->{after}");
    }
    if std::env::var_os(UPDATE).is_some() {
        std::fs::write(page(), &new).expect("the page");
    } else {
        assert!(old == new, "run `{UPDATE}=1 cargo test -p dragonfly-anim --test anim measured`\n{new}");
    }
}
