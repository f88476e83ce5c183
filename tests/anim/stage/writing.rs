//! Colors and suggestions for a text that is being written.

use super::actors::{assets, fox, fox_script, planned};
use super::{DUEL, random_scripts};
use dragonfly_anim::stage::table::PROJECTS;
use dragonfly_anim::stage::writing::{CompletionNames, TokenKind, completions, tokens};
use dragonfly_kit::random::{Random, seed};

/// Returns the suggestions at the `|` in a text.
fn suggested(text: &str, names: &CompletionNames<'_>) -> Vec<String> {
    let at = text.find('|').unwrap();
    let text = text.replacen('|', "", 1);
    completions(&text, at, names)
        .map_or(Vec::new(), |found| found.items.into_iter().map(|item| item.label).collect())
}

fn plain(text: &str) -> Vec<String> {
    suggested(text, &CompletionNames::default())
}

/// Returns the text with the first suggestion in place of what is typed, with `|` where the cursor then is.
fn taken(text: &str) -> String {
    let at = text.find('|').unwrap();
    let text = text.replacen('|', "", 1);
    let found = completions(&text, at, &CompletionNames::default()).unwrap();
    let item = &found.items[0];
    let mut text = text;
    text.replace_range(found.range.clone(), &item.insert);
    text.insert(found.range.start + item.cursor, '|');
    text
}

const CAST: &str = "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\"/><role id=\"ben\" model=\"a.glb\"/><camera id=\"wide\"/><path id=\"aisle\" points=\"0 0 0 1 0 0\"/></cast>";

#[test]
fn the_parts_of_a_text_are_found_also_where_it_is_broken() {
    let kinds = |text: &str| {
        tokens(text).into_iter().map(|token| (token.kind, text[token.range].to_owned())).collect::<Vec<_>>()
    };
    let found = kinds("<!-- a < b --><play who='anna\n  take=\"Walk\" <wait/>");
    let expected = [
        (TokenKind::Comment, "<!-- a < b -->"),
        (TokenKind::Sign, "<"),
        (TokenKind::Element, "play"),
        (TokenKind::Attribute, "who"),
        (TokenKind::Sign, "="),
        (TokenKind::Value, "'anna"),
        (TokenKind::Attribute, "take"),
        (TokenKind::Sign, "="),
        (TokenKind::Value, "\"Walk\""),
        (TokenKind::Sign, "<"),
        (TokenKind::Element, "wait"),
        (TokenKind::Sign, "/>"),
    ];
    assert_eq!(found, expected.map(|(kind, text)| (kind, text.to_owned())));
}

#[test]
fn elements_are_those_that_may_be_in_the_one_around() {
    assert_eq!(plain("|"), [""; 0]);
    assert_eq!(plain("<|"), ["script"]);
    assert_eq!(plain(&format!("{CAST}<par><pl|")), ["play", "place"]);
    assert_eq!(plain("<script version=\"1\"><cast><rol|</cast>"), ["role"]);
    assert_eq!(plain(&format!("{CAST}<play who=\"anna\" take=\"x\"><|")), ["at"]);
    assert_eq!(plain(&format!("{CAST}<par></|")), ["par"]);
    assert_eq!(plain(&format!("{CAST}<!-- <pl| -->")), [""; 0]);
    assert_eq!(taken("<script version=\"1\"><pla|"), "<script version=\"1\"><play who=\"|\" take=\"\"/>");
}

#[test]
fn attributes_are_those_that_are_not_written_yet_with_the_required_ones_first() {
    let found = plain(&format!("{CAST}<play who=\"anna\" |/>"));
    assert_eq!(found[0], "take");
    assert!(found.contains(&"fade-in".to_owned()) && !found.contains(&"who".to_owned()));
    let found = plain(&format!("{CAST}<move who=\"anna\" to=\"ben\" |/>"));
    assert!(!found.contains(&"path".to_owned()), "a move has either a path or a place to go to: {found:?}");
    assert_eq!(taken(&format!("{CAST}<wait du|/>")), format!("{CAST}<wait dur=\"|\"/>"));
}

#[test]
fn the_text_of_a_project_has_its_own_elements_attributes_and_names() {
    let names = CompletionNames {
        vocabulary: &PROJECTS,
        models: &["anna.glb"],
        scripts: &["end.xml"],
        ..CompletionNames::default()
    };
    let suggested = |text: &str| suggested(text, &names);
    assert_eq!(suggested("<|"), ["project"]);
    assert_eq!(suggested("<project version=\"1\"><mo|"), ["models", "movie"]);
    assert_eq!(suggested("<project version=\"1\"><models><|"), ["model", "edits"]);
    assert_eq!(suggested("<project version=\"1\"><cast><rol|"), ["role"]);
    assert_eq!(
        suggested("<project version=\"1\"><script |/>"),
        ["id", "src"],
        "not those of a script's root"
    );
    assert_eq!(suggested("<project version=\"1\"><script src=\"|\"/>"), ["end.xml"]);
    assert_eq!(suggested("<project version=\"1\"><scene tone=\"n|\"/>"), ["neutral", "none"]);
    let models = "<project version=\"1\"><models><model id=\"anna\" src=\"a.glb\"/><edits of=\"|";
    assert_eq!(suggested(models), ["anna"]);
    let movie = "<project version=\"1\"><script id=\"day\" src=\"day.xml\"/><movie id=\"all\" script=\"|";
    assert_eq!(suggested(movie), ["day"]);
    assert_eq!(suggested("<project version=\"1\"><models><model id=\"a\" src=\"|"), ["anna.glb"]);
}

#[test]
fn values_are_names_that_exist() {
    assert_eq!(plain(&format!("{CAST}<play who=\"|\"")), ["anna", "ben"]);
    assert_eq!(plain(&format!("{CAST}<shot who=\"w|\"/>")), ["wide"]);
    assert_eq!(plain(&format!("{CAST}<move who=\"anna\" path=\"|\"/>")), ["aisle"]);
    assert_eq!(plain(&format!("{CAST}<move who=\"anna\" ease=\"i|\"/>")), ["in", "in-out", "linear"]);
    let moments = plain(&format!(
        "{CAST}<play id=\"grab\" who=\"anna\" take=\"x\"><at name=\"touch\" time=\"1\"/></play><wait begin=\"gr|"
    ));
    assert_eq!(moments, ["grab.touch", "grab.begin", "grab.end"]);
    let names = CompletionNames {
        models: &["models/anna.glb", "models/ben.m3d"],
        lines: &["to-ben"],
        sounds: &["ben.ogg"],
        ..CompletionNames::default()
    };
    assert_eq!(suggested("<script version=\"1\"><cast><role model=\"ben|", &names), ["models/ben.m3d"]);
    assert_eq!(suggested("<script version=\"1\"><cast><path id=\"p\" line=\"|\"/>", &names), ["to-ben"]);
    assert_eq!(suggested("<script version=\"1\"><sound src=\"|\"/>", &names), ["ben.ogg"]);
}

#[test]
fn takes_and_bones_are_those_of_the_role() {
    let text = fox_script("<play who=\"anna\" take=\"Walk\"/>");
    let plan = planned(&text, &assets(&fox()));
    let names = CompletionNames { plan: Some(&plan), ..CompletionNames::default() };
    let at = |actions: &str| suggested(&fox_script(actions), &names);
    assert_eq!(at("<play who=\"anna\" take=\"|\"/>"), ["Survey", "Walk", "Run"]);
    assert_eq!(at("<play who=\"sword\" take=\"|\"/>"), [""; 0]);
    assert!(at("<look who=\"ben\" at=\"anna.|\"/>").contains(&"anna.b_Head_05".to_owned()));
    assert!(at("<play who=\"anna\" bones=\"b_Neck_04,b_He|\"/>").contains(&"b_Head_05".to_owned()));
}

#[test]
fn no_text_and_no_cursor_makes_a_suggestion_outside_of_the_text() {
    let first = seed(1);
    println!("seed {first}");
    let mut found = 0;
    for at in first..first + 60 {
        let mut random = Random::new(at);
        let mut text = if at.is_multiple_of(3) { DUEL.to_owned() } else { random_scripts::script(at) };
        // A broken text: something is missing, and something is in a wrong place.
        for _ in 0..random.below(4) {
            let cut = random.below(text.len());
            let letter = random.choice(&["<", "\"", ">", "/", "ß", " ", "="]);
            if text.is_char_boundary(cut) {
                text.insert_str(cut, letter);
            }
        }
        let mut end = 0;
        for token in tokens(&text) {
            assert!(token.range.start >= end && !token.range.is_empty(), "seed {at}");
            assert!(text.get(token.range.clone()).is_some(), "seed {at}");
            end = token.range.end;
        }
        for _ in 0..60 {
            let cursor = random.below(text.len() + 1);
            if let Some(suggested) = completions(&text, cursor, &CompletionNames::default()) {
                assert!(text.get(suggested.range.clone()).is_some(), "seed {at}");
                assert!(suggested.range.start <= cursor && cursor <= suggested.range.end, "seed {at}");
                assert!(suggested.items.iter().all(|item| item.insert.get(..item.cursor).is_some()));
                found += 1;
            }
        }
    }
    assert!(found > 300, "{found}");
}
