//! Texts that users and programs really put into fields, and that break programs which do not expect them.

use dragonfly_kit::random::Random;

/// Returns the fixed list of such texts.
pub(crate) fn texts() -> Vec<String> {
    let mut texts: Vec<String> = [
        " ",
        "\u{a0}",
        "a",
        "Ünïcödé",
        "שלום עולם",
        "مرحبا",
        "\u{202e}right to left\u{202c}",
        "👩‍👩‍👧‍👦🦊🏳️‍🌈",
        "e\u{301}\u{302}\u{303}\u{304}",
        "日本語のテイク",
        "नमस्ते",
        "a\u{0}b",
        "a\tb",
        "a\nb\r\nc",
        "\u{feff}bom",
        "\u{200b}",
        "../../etc/passwd",
        "CON",
        "<script>alert(1)</script>",
        "'; DROP TABLE takes; --",
        "{\"edit\": \"delete_take\"}",
        "%s%n%x",
        "NaN",
        "inf",
        "-0",
        "1e308*10",
        "0x10",
        "٣",
        "½",
        "\u{10ffff}",
        "((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((",
        "2^2^2^2^2^2",
        "sqrt(-1)",
        "1/0",
    ]
    .map(str::to_owned)
    .into();
    texts.push("é".repeat(10_000));
    texts.push("🦊 ".repeat(3_333));
    texts.push("1+".repeat(5_000));
    texts.push("9".repeat(5_000));
    texts
}

/// Returns a random text: pieces of numbers and formulas, letters of many scripts, unusual characters; sometimes a very
/// long one.
pub(crate) fn any(random: &mut Random) -> String {
    const PIECES: &[&str] = &[
        "1",
        "0",
        "9",
        ".",
        ",",
        "e",
        "E",
        "-",
        "+",
        "*",
        "/",
        "%",
        "^",
        "(",
        ")",
        ";",
        " ",
        "sqrt",
        "pi",
        "1e999",
        "nan",
        "inf",
        "°",
        "m",
        "a",
        "Z",
        "_",
        "\"",
        "\\",
        "/",
        "\0",
        "\t",
        "\n",
        "\r",
        "\u{1b}",
        "\u{7f}",
        "\u{200b}",
        "\u{202e}",
        "\u{feff}",
        "\u{301}",
        "é",
        "ß",
        "ﷺ",
        "ש",
        "م",
        "左",
        "の",
        "न",
        "😀",
        "🏳️‍🌈",
        "\u{10ffff}",
    ];
    let pieces = match random.below(200) {
        0 => random.below(5_000),
        _ => random.below(24),
    };
    (0..pieces).map(|_| random.choice(PIECES)).collect()
}
