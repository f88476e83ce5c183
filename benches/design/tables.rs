//! The two tables of the page that are counted in the source.

/// Returns the table of the cost of the feature.
pub fn cost() -> String {
    let costs = super::costs();
    let mut text = String::from(
        "| | editor before, lines | feature: lines | types and variants | functions | places touched | files |\n|---|---|---|---|---|---|---|\n",
    );
    let rows = [
        ("the property itself and its drawing (same for all)", &costs.same, true),
        ("one short lock", &costs.locks, true),
        ("messages, edits as closures", &costs.closures, false),
        ("messages, edits as values, sent at the call", &costs.raw, false),
        ("messages, edits as values, typed handles", &costs.messages, true),
        ("– of these, the edits as values", &costs.edits, false),
    ];
    for (name, cost, whole) in rows {
        let base = if whole { cost.base.to_string() } else { "–".into() };
        let lines = cost.added + cost.changed;
        let (types, functions, places, files) = (cost.types, cost.functions, cost.places.len(), cost.files);
        text += &format!("| {name} | {base} | {lines} | {types} | {functions} | {places} | {files} |\n");
    }
    text
}

/// Returns the table of the mistakes that the compiler rejects and accepts.
pub fn mistakes() -> String {
    let mut text = String::from("| | does not compile | compiles, and fails at run time |\n|---|---|---|\n");
    for (way, refused, compiling) in super::mistakes() {
        let list = |all: Vec<String>| {
            let items: String = all.iter().map(|one| format!("<li>{one}</li>")).collect();
            format!("{}:<ul>{items}</ul>", all.len())
        };
        let lower = |text: &str| text[..1].to_lowercase() + &text[1..];
        let refused = list(refused.into_iter().map(lower).collect());
        text += &format!("| {way} | {refused} | {} |\n", list(compiling));
    }
    text
}
