//! Text typed into a number field evaluates to the number it expresses, or to an error with its position.

use dragonfly::control::expression::{
    DEEPEST, ExpressionError, ExpressionFault, LONGEST, Quantity, evaluate, evaluate_f32,
};
use dragonfly_kit::random::{Random, seed};
use std::f64::consts::PI;

#[test]
fn usual_expressions_are_evaluated() {
    let plain = [
        ("45", 45.0),
        ("45/2", 22.5),
        (" 1.5 * 2 ", 3.0),
        ("sqrt(2)", 2f64.sqrt()),
        ("√(2)", 2f64.sqrt()),
        ("pi/4", PI / 4.0),
        ("π", PI),
        ("1e-3", 1e-3),
        ("1E3", 1e3),
        (".5", 0.5),
        ("-.5", -0.5),
        ("5.", 5.0),
        ("1,5", 1.5),
        (",25", 0.25),
        ("0,125", 0.125),
        ("sqrt(6,25)", 2.5),
        ("max(1,5)", 5.0),
        ("max(1;5)", 5.0),
        ("max((1,5), 1)", 1.5),
        ("max(1, 2) + 1,5", 3.5),
        ("min(max(1,2),3)", 2.0),
        ("2^3^2", 512.0),
        ("2**3", 8.0),
        ("-2^2", -4.0),
        ("2^-1", 0.5),
        ("--3", 3.0),
        ("2*-3", -6.0),
        ("1+2*3-4/2", 5.0),
        ("(1+2)*3", 9.0),
        ("-1 % 3", 2.0),
        ("150%", 1.5),
        ("3 × 4 ÷ 2 − 1", 5.0),
        ("2*e", 2.0 * std::f64::consts::E),
        ("atan2(1, 1)", PI / 4.0),
        ("SIN(90deg)", 1.0),
        ("cos(0.5turn)", -1.0),
    ];
    for (text, value) in plain {
        let found = evaluate(text, Quantity::Number);
        assert!(found.is_ok_and(|found| (found - value).abs() <= 1e-15 * value.abs()), "{text}: {found:?}");
    }
}

#[test]
fn units_are_converted_to_the_unit_of_the_field() {
    let lengths = [
        ("10cm", 0.1),
        ("1m + 5cm", 1.05),
        ("2", 2.0),
        ("2 in", 0.0508),
        ("1/2 m", 0.5),
        ("10cm/2", 0.05),
        ("10cm/2cm", 5.0),
        ("(1+1)km", 2000.0),
    ];
    for (text, value) in lengths {
        let found = evaluate(text, Quantity::Length).unwrap();
        assert!((found - value).abs() < 1e-12, "{text}: {found}");
    }
    let angles = [
        ("90deg", 90.0),
        ("90°", 90.0),
        ("90", 90.0),
        ("pi rad", 180.0),
        ("1/4 turn", 90.0),
        ("pi/4 rad", 45.0),
        ("atan2(1,1)", 45.0),
        ("asin(1)", 90.0),
        ("45deg + 45", 90.0),
    ];
    for (text, value) in angles {
        let found = evaluate(text, Quantity::Angle).unwrap();
        assert!((found - value).abs() < 1e-12, "{text}: {found}");
    }
    assert_eq!(evaluate("90deg", Quantity::Length).unwrap_err().reason, ExpressionFault::Name);
    assert_eq!(evaluate("10cm", Quantity::Angle).unwrap_err().reason, ExpressionFault::Name);
    assert_eq!(evaluate("10cm", Quantity::Number).unwrap_err().reason, ExpressionFault::Name);
}

#[test]
fn every_error_reports_its_position() {
    let mistakes = [
        ("", 0, ExpressionFault::Empty),
        ("   ", 3, ExpressionFault::Empty),
        ("45/", 3, ExpressionFault::Unfinished),
        ("(1", 2, ExpressionFault::Unfinished),
        ("1)", 1, ExpressionFault::Unexpected(')')),
        ("1 2", 2, ExpressionFault::Number),
        ("1.2.3", 3, ExpressionFault::Number),
        ("1,2,3", 3, ExpressionFault::Number),
        ("1,234", 1, ExpressionFault::Comma),
        ("1,234.5", 1, ExpressionFault::Comma),
        ("äpfel", 0, ExpressionFault::Name),
        ("2 äpfel", 2, ExpressionFault::Name),
        ("é+$", 0, ExpressionFault::Name),
        ("1+$", 2, ExpressionFault::Unexpected('$')),
        ("1/0", 1, ExpressionFault::NotFinite),
        ("sqrt(-1)", 0, ExpressionFault::NotFinite),
        ("1e999", 0, ExpressionFault::NotFinite),
        ("10^999", 2, ExpressionFault::NotFinite),
        ("nan", 0, ExpressionFault::Name),
        ("inf", 0, ExpressionFault::Name),
        ("max(1)", 5, ExpressionFault::Parts(2)),
        ("max(1,2,3)", 7, ExpressionFault::Parts(2)),
        ("sqrt(1;2)", 6, ExpressionFault::Parts(1)),
        ("sqrt 2", 5, ExpressionFault::Number),
    ];
    for (text, at, reason) in mistakes {
        assert_eq!(evaluate(text, Quantity::Number), Err(ExpressionError { at, reason }), "{text:?}");
    }
    let said = evaluate("1+$", Quantity::Number).unwrap_err().to_string();
    assert_eq!(said, "at character 3: `$` has no meaning here");
    assert!(evaluate_f32("1e39", Quantity::Number).is_err(), "larger than a field holds");
}

#[test]
fn the_depth_and_length_of_an_expression_are_limited() {
    let deep = |depth: usize| format!("{}1{}", "(".repeat(depth), ")".repeat(depth));
    assert_eq!(evaluate(&deep(DEEPEST as usize), Quantity::Number), Ok(1.0));
    for text in [deep(DEEPEST as usize + 1), "-".repeat(4000) + "1", "2^".repeat(2000) + "1"] {
        let fault = evaluate(&text, Quantity::Number).unwrap_err().reason;
        assert_eq!(fault, ExpressionFault::TooDeep);
    }
    // A long expression is not a deep one: brackets that are closed do not count towards the depth.
    assert_eq!(evaluate(&("(1)+".repeat(900) + "sqrt(4)"), Quantity::Number), Ok(902.0));
    let long = "1".repeat(LONGEST + 1);
    assert_eq!(evaluate(&long, Quantity::Number).unwrap_err().reason, ExpressionFault::TooLong);
    assert!(evaluate(&"9".repeat(1 << 20), Quantity::Angle).is_err());
}

#[test]
fn any_text_gives_a_number_or_an_error() {
    let seed = seed(31);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let pieces = [
        "1", "0", "9", ".", ",", "e", "E", "-", "+", "*", "/", "%", "^", "(", ")", ";", " ", "sqrt", "max",
        "atan2", "pi", "deg", "cm", "°", "√", "−", "×", "\0", "\u{202e}", "😀", "é", "nan", "1e308", "\n",
        "左",
    ];
    let mut numbers = 0;
    for _ in 0..30_000 {
        let text: String = (0..random.below(16)).map(|_| random.choice(&pieces)).collect();
        for quantity in [Quantity::Number, Quantity::Length, Quantity::Angle] {
            match evaluate(&text, quantity) {
                Ok(value) => {
                    numbers += 1;
                    assert!(value.is_finite(), "{text:?}: {value}");
                }
                Err(error) => assert!(error.at <= text.chars().count(), "{text:?}: {error}"),
            }
        }
    }
    assert!(numbers > 1_000, "some of the texts are numbers: {numbers}");
}

#[test]
fn a_random_sum_matches_direct_evaluation() {
    let seed = seed(32);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    for _ in 0..2_000 {
        let (mut text, mut value) = (String::from("0"), 0.0);
        for _ in 0..random.below(6) {
            let [a, b] = std::array::from_fn(|_| f64::from((random.unit() * 100.0).round()) + 1.0);
            match random.below(4) {
                0 => (text, value) = (format!("{text}+{a}*{b}"), value + a * b),
                1 => (text, value) = (format!("{text}-{a}/{b}"), value - a / b),
                2 => (text, value) = (format!("({text})*{a}"), value * a),
                _ => (text, value) = (format!("{a} - ({text})"), a - value),
            }
        }
        assert_eq!(evaluate(&text, Quantity::Number), Ok(value), "{text}");
    }
}
