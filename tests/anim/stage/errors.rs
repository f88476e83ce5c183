//! Messages of scripts that are wrong.

use super::{DUEL, listed, scene};
use dragonfly_anim::stage::script::{MOST_BYTES, MOST_DEPTH, MOST_ERRORS, StageScript};
use dragonfly_kit::random::Random;

/// Returns the errors of the text, one a line.
fn errors(text: &str) -> String {
    listed(&StageScript::read(text).unwrap_err())
}

#[test]
fn a_misspelt_attribute_has_a_place_and_a_suggestion() {
    let text = DUEL.replace("take=\"Slash\"", "tak=\"Slash\"");
    let found = errors(&text);
    let line = found.lines().find(|line| line.contains("tak\"")).unwrap();
    assert!(
        line.starts_with("scene.xml:34:38: \"tak\" is not an attribute of <play>; did you mean \"take\"?"),
        "{line}"
    );
    assert!(found.contains("scene.xml:34:8: <play> needs the attribute take"), "{found}");
}

#[test]
fn each_kind_of_mistake_has_a_message_with_what_was_expected() {
    let mut wrong = Vec::new();
    for (actions, expected) in [
        ("<pley who=\"anna\"/>", "3:2: <pley> is no element of <script>; did you mean \"play\"? (elements: "),
        ("<at name=\"x\" time=\"1\"/>", "3:2: <at> is no element of <script>; it belongs in <play>"),
        ("<cast><seq/></cast>", "3:8: <seq> is no element of <cast>; it belongs in <script>, <seq> or <par>"),
        (
            "<wait dur=\"soon\"/>",
            "3:12: dur=\"soon\" is not a time of 0 or more, such as 1.5, 250ms, 36f or 1:05.5",
        ),
        ("<wait dur=\"-1\"/>", "3:12: dur=\"-1\" is not a time of 0 or more"),
        ("<wait begin=\"a.b.c\"/>", "3:14: begin=\"a.b.c\" is not a time such as 1.5 or 36f, or a moment"),
        ("<wait begin=\"x.end\"/>", "3:14: no action has the id \"x\"; there are no ids of actions"),
        (
            "<wait id=\"stand\"/><wait begin=\"stan.end\"/>",
            "3:32: no action has the id \"stan\"; did you mean \"stand\"?",
        ),
        ("<wait begin=\"anna.end\"/>", "3:14: \"anna\" is a thing of the cast; only actions have moments"),
        ("<wait begin=\"prev.end\"/>", "3:14: no action is before this one, so there is no `prev`"),
        ("<wait id=\"prev\"/>", "3:11: \"prev\" means the action before"),
        ("<wait id=\"anna\"/>", "3:11: the id \"anna\" is used at 2:7 already"),
        ("<wait id=\"1st\"/>", "3:11: id=\"1st\" is not a name of letters, digits, `_` and `-`"),
        (
            "<play id=\"p\" who=\"anna\" take=\"W\"><at name=\"touch\" time=\"1\"/></play><wait begin=\"p.tuch\"/>",
            "3:81: \"p\" has no moment \"tuch\"; did you mean \"touch\"? (moments of <play id=\"p\"> (line 3): begin, end, touch)",
        ),
        (
            "<play who=\"ana\" take=\"W\"/>",
            "3:12: no thing of the cast has the id \"ana\"; did you mean \"anna\"?",
        ),
        (
            "<play who=\"sun\" take=\"W\"/>",
            "3:12: \"sun\" is a light; <play> needs one of: role, prop; ids of role, prop: anna, ben, sword",
        ),
        (
            "<move who=\"anna\" path=\"isle\"/>",
            "3:24: no thing of the cast has the id \"isle\"; did you mean \"aisle\"?",
        ),
        ("<move who=\"anna\"/>", "3:2: <move> needs the attribute path or to"),
        (
            "<move who=\"anna\" path=\"aisle\" to=\"door\"/>",
            "3:2: <move> has more than one of the attributes path or to",
        ),
        (
            "<look who=\"anna\" at=\"bean.Head\"/>",
            "3:22: no thing of the cast has the id \"bean\"; did you mean \"ben\"?",
        ),
        ("<look who=\"anna\" at=\"aisle\"/>", "3:22: \"aisle\" is a path, which has no position"),
        (
            "<set who=\"sun\" property=\"colour\" to=\"1\"/>",
            "3:26: a light has no property \"colour\"; did you mean \"color\"? (properties: strength, color)",
        ),
        ("<set who=\"sun\" property=\"color\" to=\"1\"/>", "3:37: to=\"1\" is not a color such as #ffcc00"),
        (
            "<turn who=\"anna\" to=\"90\" ease=\"slow\"/>",
            "3:32: ease=\"slow\" is not one of the listed words; values: linear, in, out, in-out",
        ),
        ("<sound src=\"../../secret\"/>", "3:13: src=\"../../secret\" is not a relative path"),
        ("<wait/>words", "3:8: <script> contains a text; only elements are expected"),
        ("<seq><wait></seq>", "3:12: this is not XML: expected 'wait' tag, not 'seq'"),
        ("<wait dur=\"1\" dur=\"2\"/>", "3:15: this is not XML: attribute 'dur'"),
        ("<wait dur=\"&nope;\"/>", "3:12: this is not XML: "),
    ] {
        let found = errors(&scene(actions));
        if !found.lines().any(|line| line["scene.xml:".len()..].starts_with(expected)) {
            wrong.push(format!("{actions}\n    {expected}\n    {found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn document_types_entities_and_bombs_are_refused_fast() {
    let bomb =
        "<!DOCTYPE script [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;\">]><script version=\"1\">&b;</script>";
    assert!(errors(bomb).contains("document types (<!DOCTYPE …>) and their entities are refused"));
    let deep =
        format!("<script version=\"1\">{}{}</script>", "<seq>".repeat(500_000), "</seq>".repeat(500_000));
    assert!(errors(&deep).contains(&format!("nested more than {MOST_DEPTH} deep")));
    let open = "<seq ".repeat(1_000_000);
    assert!(!errors(&format!("<script version=\"1\">{open}")).is_empty());
    let large = " ".repeat(MOST_BYTES + 1);
    assert!(errors(&large).contains("at most"));
    let many = format!("<script version=\"1\">{}</script>", "<wait/>".repeat(600_000));
    assert!(errors(&many).contains("more than 500000 elements, texts and comments"));
    let wrong = format!("<script version=\"1\">{}</script>", "<w/>".repeat(10_000));
    assert_eq!(StageScript::read(wrong).unwrap_err().len(), MOST_ERRORS);
}

#[test]
fn damaged_scripts_give_errors_with_places_inside_the_text_and_never_panic() {
    let mut random = Random::new(71);
    println!("seed 71");
    let signs = ["<", ">", "\"", "/", "&", "=", "-", ".", "é", "\0", " ", "9", "<!--", "]]>", "end", ":"];
    for _ in 0..3_000 {
        let mut text: Vec<char> = DUEL.chars().collect();
        for _ in 0..1 + random.below(4) {
            let at = random.below(text.len());
            match random.below(3) {
                0 => drop(text.remove(at)),
                1 => text[at] = random.choice(&signs).chars().next().unwrap(),
                _ => drop(text.splice(at..at, random.choice(&signs).chars())),
            }
        }
        let text: String = text.into_iter().collect();
        let Err(errors) = StageScript::read(text.as_str()) else { continue };
        assert!(!errors.is_empty());
        for error in errors {
            assert!(text.get(error.range.clone()).is_some(), "{error}");
            assert!(
                error.place.line as usize <= text.lines().count() + 1 && !error.message.is_empty(),
                "{error}"
            );
        }
    }
}
