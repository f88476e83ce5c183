//! Drawn lines: fitted to strokes, measured, picked, read and written.

use super::listed;
use dragonfly_anim::stage::StagePath;
use dragonfly_anim::stage::line::{DrawnLines, LineSamples, NewLine, fit, path_points};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_kit::random::{Random, seed};
use glam::DVec3;

/// Returns the point of a cubic Bézier curve by repeated interpolation, which is another way than that of the library.
fn casteljau(curve: &[DVec3], t: f64) -> DVec3 {
    let mut points = curve.to_vec();
    while points.len() > 1 {
        points = points.windows(2).map(|pair| pair[0].lerp(pair[1], t)).collect();
    }
    points[0]
}

/// Returns many points of a chain of curves.
fn points_of(control: &[DVec3]) -> Vec<DVec3> {
    let curves = control.windows(4).step_by(3);
    curves.flat_map(|curve| (0..=200).map(|at| casteljau(curve, f64::from(at) / 200.0))).collect()
}

/// Returns the smallest distance of a point from others.
fn distance(others: &[DVec3], point: DVec3) -> f64 {
    others.iter().map(|on| on.distance(point)).fold(f64::INFINITY, f64::min)
}

/// Returns the length of a chain of curves by Gauss-Legendre integration of its speed, 5 points in each of 32 parts of a curve.
fn integrated_length(control: &[DVec3]) -> f64 {
    const NODES: [(f64, f64); 5] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683, 0.478_628_670_499_366_5),
        (-0.538_469_310_105_683, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let speed = |curve: &[DVec3], t: f64| {
        let slopes: Vec<DVec3> = curve.windows(2).map(|pair| (pair[1] - pair[0]) * 3.0).collect();
        casteljau(&slopes, t).length()
    };
    let part = |curve: &[DVec3], at: usize| -> f64 {
        let of = |(node, weight): &(f64, f64)| weight * speed(curve, (at as f64 + 0.5 + 0.5 * node) / 32.0);
        NODES.iter().map(of).sum::<f64>() / 64.0
    };
    control.windows(4).step_by(3).map(|curve| (0..32).map(|at| part(curve, at)).sum::<f64>()).sum()
}

/// Returns a random stroke: a wave with corners and a hand that trembles.
fn stroke(random: &mut Random) -> Vec<DVec3> {
    let mut number = || (random.bits() >> 11) as f64 / (1_u64 << 53) as f64;
    let (wave, height, count) = (1.0 + 4.0 * number(), 2.0 * number(), 150 + (number() * 200.0) as usize);
    (0..count)
        .map(|at| {
            let x = at as f64 / count as f64 * 6.0;
            let corner = if x > 3.0 { (x - 3.0) * 1.5 } else { 0.0 };
            DVec3::new(x, 0.01 * number(), height * (wave * x).sin() + corner)
        })
        .collect()
}

#[test]
fn a_fitted_line_is_within_the_tolerance_of_every_point_of_the_stroke_and_has_fewer_points() {
    let mut random = Random::new(seed(120));
    for _ in 0..20 {
        let points = stroke(&mut random);
        let control = fit(&points, 0.03);
        assert_eq!(control.len() % 3, 1);
        assert_eq!((control[0], control[control.len() - 1]), (points[0], points[points.len() - 1]));
        let on = points_of(&control);
        for &point in &points {
            let away = distance(&on, point);
            assert!(away < 0.03 + 5e-3, "{point} is {away} m away");
        }
        assert!(control.len() < points.len(), "{} of {}", control.len(), points.len());
    }
}

#[test]
fn points_of_a_curve_give_that_curve_back_as_one() {
    let curve =
        [DVec3::ZERO, DVec3::new(1.0, 0.0, 2.0), DVec3::new(3.0, 0.5, 2.0), DVec3::new(4.0, 0.0, 0.0)];
    let points: Vec<DVec3> = (0..=60).map(|at| casteljau(&curve, f64::from(at) / 60.0)).collect();
    let control = fit(&points, 0.02);
    assert_eq!(control.len(), 4);
    let on = points_of(&control);
    for at in 0..=100 {
        assert!(distance(&on, casteljau(&curve, f64::from(at) / 100.0)) < 0.02);
    }
}

#[test]
fn strokes_without_a_length_and_with_numbers_that_are_not_finite_do_no_harm() {
    assert_eq!(fit(&[], 0.1), []);
    assert_eq!(fit(&[DVec3::ONE; 5], 0.1), [DVec3::ONE; 4]);
    let odd = [DVec3::ZERO, DVec3::NAN, DVec3::X, DVec3::splat(f64::INFINITY), DVec3::X];
    assert_eq!(fit(&odd, 0.1).len(), 4);
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let control = fit(&[DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.0, 1.0), DVec3::Z], tolerance);
        assert!(control.len() % 3 == 1 && control.iter().all(|point| point.is_finite()), "{tolerance}");
    }
    let none = LineSamples::new(&[], true);
    assert_eq!((none.length(), none.at(1.0)), (0.0, None));
    let point = LineSamples::new(&[DVec3::X; 4], false);
    assert_eq!((point.length(), point.at(9.0)), (0.0, Some(DVec3::X)));
}

#[test]
fn the_length_of_a_line_is_that_of_an_integral_within_a_millimeter() {
    let mut random = Random::new(seed(121));
    for _ in 0..60 {
        let control = fit(&stroke(&mut random), 0.02);
        let (own, wanted) = (LineSamples::new(&control, false).length(), integrated_length(&control));
        assert!((own - wanted).abs() < 1e-3, "{own} instead of {wanted}");
    }
}

#[test]
fn a_closed_line_ends_where_it_starts() {
    // Straight curves along three sides of a square.
    let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.0, 1.0), DVec3::Z];
    let mut control = vec![corners[0]];
    for pair in corners.windows(2) {
        control.extend([1.0, 2.0, 3.0].map(|third| pair[0].lerp(pair[1], third / 3.0)));
    }
    let samples = LineSamples::new(&control, true);
    assert!((samples.length() - 4.0).abs() < 1e-9, "{}", samples.length());
    assert_eq!(samples.at(samples.length()), Some(DVec3::ZERO));
    assert!(samples.at(0.5).expect("a point").distance(DVec3::X * 0.5) < 1e-9);
}

const FILE: &str = "<?xml version=\"1.0\"?>\n<lines version=\"1\">\n  <!-- the way to the door -->\n  \
    <line id=\"aisle\" points=\"0 0 0  1 0 0  2 0 0  3 0 0\" color=\"#ff8000\" in-movie='yes' from=\"1.5\"/>\n</lines>\n";

fn read(text: &str) -> DrawnLines {
    DrawnLines::read(text).unwrap_or_else(|errors| panic!("{}", listed(&errors)))
}

#[test]
fn a_file_of_lines_is_read_and_a_new_line_is_one_line_of_text_with_tenths_of_millimeters() {
    let lines = read(FILE);
    let aisle = lines.called("aisle").expect("the line");
    assert_eq!((aisle.points.len(), aisle.color, aisle.width), (4, [255, 128, 0], 3.0));
    assert!(aisle.is_in_movie && !aisle.is_closed && &*aisle.on == "ground");
    assert_eq!(aisle.shown.map(|time| time.map(|time| time.seconds())), [Some(1.5), None]);
    let new = NewLine {
        id: Some("note".to_owned()),
        points: vec![DVec3::new(0.123_456, -0.000_01, 1.0), DVec3::X, DVec3::Y, DVec3::new(1e3, 0.5, 0.25)],
        attributes: vec![("on".to_owned(), "view".to_owned())],
    };
    let text = lines.added(&new).expect("a place").apply(FILE);
    let line = "  <line id=\"note\" on=\"view\" points=\"0.1235 0 1  1 0 0  0 1 0  1000 0.5 0.25\"/>\n";
    assert_eq!(text, FILE.replace("</lines>", &format!("{line}</lines>")));
    let lines = read(&text);
    assert_eq!(lines.removed(1).expect("a line").apply(&text), FILE);
    let moved = lines.reshaped(0, &[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).expect("a line").apply(&text);
    assert_eq!(moved, text.replace("0 0 0  1 0 0  2 0 0  3 0 0", "0 0 0  1 0 0  0 1 0  0 0 1"));
    assert!(lines.added(&NewLine { points: vec![DVec3::ZERO; 3], ..new }).is_none());
}

#[test]
fn errors_of_a_file_of_lines_have_places() {
    for (from, to, wanted) in [
        ("3 0 0\"", "3 0 0  4 0 0\"", "4:28: a line needs 3 n + 1 points, such as 4 or 7, not 5"),
        ("color=\"#ff8000\"", "colour=\"#ff8000\"", "4:56: \"colour\" is not an attribute of <line>"),
        ("<line id", "<lin id", "4:4: <lin> is no element of <lines>"),
        ("<lines version", "<script version", "2:2: <script> is not a file of lines"),
    ] {
        let text = FILE
            .replacen(from, to, 1)
            .replace("</lines>", if from.contains("lines") { "</script>" } else { "</lines>" });
        let errors = DrawnLines::read(text).expect_err(wanted);
        assert!(errors[0].in_file("l").starts_with(&format!("l:{wanted}")), "{}", errors[0].in_file("l"));
    }
    let twice = FILE.replace("</lines>", "<line id=\"aisle\" points=\"0 0 0 1 0 0 2 0 0 3 0 0\"/></lines>");
    assert_eq!(DrawnLines::read(twice).expect_err("twice")[0].message, "the id is used at 4:3 already");
}

#[test]
fn a_path_of_few_points_follows_a_line_within_the_tolerance() {
    let seed = seed(20);
    let mut random = Random::new(seed);
    println!("seed {seed}");
    let mut checked = 0;
    for round in 0..60 {
        // A walk whose direction changes gently.
        let (mut place, mut angle) = (DVec3::ZERO, 0.0_f64);
        let stroke: Vec<DVec3> = (0..60)
            .map(|_| {
                angle += (f64::from(random.unit()) - 0.5) * 0.4;
                place += DVec3::new(angle.cos(), 0.0, angle.sin()) * 0.1;
                place
            })
            .collect();
        let control = fit(&stroke, 0.02);
        let points = path_points(&control, 0.03);
        assert!((2..=64).contains(&points.len()), "round {round}: {} points", points.len());
        if points.len() == 64 {
            continue;
        }
        checked += 1;
        let path = StagePath::new(&points, true);
        // No place of the path is far from the line, by another way of measuring than that of the library.
        let on = points_of(&control);
        for step in 0..=50 {
            let on_path = path.at(path.length() * f64::from(step) / 50.0).position;
            assert!(distance(&on, on_path) <= 0.035, "round {round}: {on_path} is beside the line");
        }
    }
    assert!(checked > 40, "only {checked} of 60 need fewer than 64 points");
    // One bend between two straight ways costs points at the bend alone.
    let bend: Vec<DVec3> = (0..=100)
        .map(|at| match at {
            0..=45 => DVec3::X * f64::from(at) * 0.1,
            55.. => DVec3::new(5.0, 0.0, f64::from(at - 50) * 0.1),
            _ => {
                let turn = f64::from(at - 45) * std::f64::consts::FRAC_PI_2 / 10.0;
                DVec3::new(4.5 + 0.5 * turn.sin(), 0.0, 0.5 - 0.5 * turn.cos())
            }
        })
        .collect();
    let control = fit(&bend, 0.01);
    let points = path_points(&control, 0.02);
    assert!(points.len() <= 14, "{} points: {points:?}", points.len());
    let (path, on) = (StagePath::new(&points, true), points_of(&control));
    for step in 0..=200 {
        let on_path = path.at(path.length() * f64::from(step) / 200.0).position;
        assert!(distance(&on, on_path) <= 0.025, "{on_path} is off the line");
    }
    let length = LineSamples::new(&control, false).length();
    assert!(
        (path.length() - length).abs() < 0.05,
        "it goes back and forth: {} m, not {length}",
        path.length()
    );
    let straight = fit(&[DVec3::ZERO, DVec3::X], 0.01);
    assert_eq!(path_points(&straight, 0.001), [DVec3::ZERO, DVec3::X]);
    assert!(path_points(&[], 0.1).is_empty() && path_points(&[DVec3::X; 4], 0.1).is_empty());
}

#[test]
fn an_attribute_of_a_line_is_set_and_removed_by_a_change_of_its_own_line() {
    let text = "<lines version=\"1\">\n  <line id=\"a\" points=\"0 0 0  1 0 0  2 0 0  3 0 0\"/>\n  <!-- kept -->\n  <line id=\"b\" points=\"0 0 0  1 0 0  2 0 0  3 0 0\"/>\n</lines>\n";
    let lines = DrawnLines::read(text).unwrap_or_else(|errors| panic!("{}", errors[0].in_file(text)));
    let blue = lines.set(1, "color", Some("#0000ff")).expect("a line").apply(text);
    let expected = text.replace("<line id=\"b\"", "<line id=\"b\" color=\"#0000ff\"");
    let changed =
        DrawnLines::read(blue.as_str()).unwrap_or_else(|errors| panic!("{}", errors[0].in_file(&blue)));
    assert_eq!((changed.list()[1].color, blue.lines().count()), ([0, 0, 255], expected.lines().count()));
    let differing = text.lines().zip(blue.lines()).filter(|(old, new)| old != new).count();
    assert_eq!(differing, 1, "{blue}");
    assert_eq!(changed.set(1, "color", None).expect("a line").apply(&blue), text);
    assert!(lines.set(2, "color", None).is_none());
}

#[test]
fn frames_in_a_file_of_lines_are_those_of_its_project() {
    let text = FILE.replace("from=\"1.5\"", "from=\"36f\" to=\"90f\"");
    let shown = |project: &str| {
        let project = StageProject::read(project).expect("a project");
        let lines = DrawnLines::read_of(text.as_str(), Some(&project)).expect("lines");
        lines.list()[0].shown.map(|time| time.expect("a time").seconds())
    };
    assert_eq!(shown("<project version=\"1\" fps=\"30\"/>"), [1.2, 3.0]);
    assert_eq!(shown("<project version=\"1\"/>"), [1.5, 3.75]);
}
