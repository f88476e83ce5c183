//! Texts that people and programs really put into fields, and that break programs that did not think of them.

/// Each once into every field.
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
