//! Formats values with their units for tables and charts.

/// Returns the unit in which a value is printed, and its size in the measured unit.
fn shown_in(value: f64, unit: &str) -> (&'static str, f64) {
    let steps: &[(&'static str, f64)] = match unit {
        "ns" => &[("ns", 1.0), ("µs", 1e3), ("ms", 1e6), ("s", 1e9)],
        "bytes" => &[("bytes", 1.0), ("KiB", 1024.0), ("MiB", 1_048_576.0), ("GiB", 1_073_741_824.0)],
        "1/s" => &[("/s", 1.0), ("k/s", 1e3), ("M/s", 1e6)],
        "1/msg" => &[("per message", 1.0)],
        "1/edit" => &[("per edit", 1.0)],
        "ratio" => &[("×", 1.0)],
        "%" => &[("%", 1.0)],
        "cores" => &[("cores", 1.0)],
        _ => &[("", 1.0)],
    };
    let fits = |step: &&(&str, f64)| value.abs() >= step.1;
    *steps.iter().rev().find(fits).unwrap_or(&steps[0])
}

/// Returns the size of the unit in which `value` is printed: 1,048,576 if that is MiB.
pub fn step(value: f64, unit: &str) -> f64 {
    shown_in(value, unit).1
}

/// Formats a number with three significant digits: `0.040`, `9.12`, `34.5`, `12,300`.
pub fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if size < 0.1 => format!("{value:.3}"),
        size if size < 9.995 => format!("{value:.2}"),
        size if size < 99.95 => format!("{value:.1}"),
        _ => {
            let whole = format!("{:.0}", value.abs());
            let groups: Vec<&str> = whole
                .as_bytes()
                .rchunks(3)
                .rev()
                .map(|group| std::str::from_utf8(group).unwrap_or(""))
                .collect();
            format!("{}{}", if value < 0.0 { "-" } else { "" }, groups.join(","))
        }
    }
}

/// Formats a value with its unit: `9.12 µs`.
pub fn amount(value: f64, unit: &str) -> String {
    let (name, size) = shown_in(value, unit);
    format!("{} {name}", digits(value / size)).trim_end().to_owned()
}

/// Formats a round value on an axis: `10 µs`, not `10.0 µs`.
pub fn tick(value: f64, unit: &str) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let (name, size) = shown_in(value * (1.0 + 1e-9), unit);
    let number = value / size;
    let text =
        if number >= 1000.0 { digits(number) } else { format!("{}", (number * 1000.0).round() / 1000.0) };
    format!("{text} {name}").trim_end().to_owned()
}

/// Formats a median with its spread, all in the median's unit: `9.12 [8.90 .. 12.1] µs`. Without a spread, only the
/// value.
pub fn spread(median: f64, low: f64, high: f64, unit: &str) -> String {
    let (name, size) = shown_in(median, unit);
    let number = |value: f64| {
        if unit == "count" && value.fract() == 0.0 && value < 1000.0 {
            format!("{value}")
        } else {
            digits(value / size)
        }
    };
    let [shown, low_shown, high_shown] = [median, low, high].map(number);
    let text = if low == high { shown } else { format!("{shown} [{low_shown} .. {high_shown}]") };
    format!("{text} {name}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_formatted_with_a_readable_unit() {
        assert_eq!(amount(9123.0, "ns"), "9.12 µs");
        assert_eq!(amount(0.0, "ns"), "0 ns");
        assert_eq!(amount(12_345.6, "count"), "12,346");
        assert_eq!(amount(43_000_000.0, "bytes"), "41.0 MiB");
        assert_eq!(amount(0.04, "1/msg"), "0.040 per message");
        assert_eq!(tick(10_000.0, "ns"), "10 µs");
        assert_eq!(tick(0.5, "ratio"), "0.5 ×");
        assert_eq!(tick(1e6, "ns"), "1 ms");
        assert_eq!(spread(9123.0, 8900.0, 12_100.0, "ns"), "9.12 [8.90 .. 12.1] µs");
        assert_eq!(spread(1.0, 0.0, 1234.0, "count"), "1 [0 .. 1,234]");
        assert_eq!(spread(180.0, 180.0, 180.0, "ns"), "180 ns");
    }
}
