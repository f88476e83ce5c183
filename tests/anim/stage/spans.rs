//! Byte ranges: an edit of a script replaces a range and leaves everything else.

use super::{DUEL, read};
use dragonfly_anim::stage::script::StageScript;

#[test]
fn every_range_of_the_tree_is_what_it_says() {
    let script = read(DUEL);
    let mut attributes = 0;
    for element in script.tree().elements() {
        assert!(DUEL[element.range.clone()].starts_with(&format!("<{}", element.row.name)));
        assert!(DUEL[element.range.clone()].ends_with('>'));
        assert_eq!(&DUEL[element.name.clone()], element.row.name);
        for attribute in &element.attributes {
            assert_eq!(&DUEL[attribute.name.clone()], attribute.row.name);
            assert_eq!(&DUEL[attribute.value_range.clone()], &*attribute.value);
            let whole = &DUEL[attribute.range.clone()];
            assert_eq!(whole, format!("{}=\"{}\"", attribute.row.name, attribute.value));
            attributes += 1;
        }
    }
    assert_eq!((script.tree().elements().len(), attributes), (37, 132));
}

#[test]
fn replacing_a_value_keeps_every_other_byte() {
    let script = read(DUEL);
    let hit = script.element(script.action_called("anna-hit").unwrap());
    let range = hit.attribute("take").unwrap().value_range.clone();
    let mut text = DUEL.to_owned();
    text.replace_range(range.clone(), "Stab &amp; turn");
    assert_eq!((&text[..range.start], &text[range.start + 15..]), (&DUEL[..range.start], &DUEL[range.end..]));
    let script = StageScript::read(text).unwrap();
    assert_eq!(script.element(script.action_called("anna-hit").unwrap()).value("take"), Some("Stab & turn"));
}

#[test]
fn the_element_at_a_byte_is_the_innermost_one() {
    let script = read(DUEL);
    let at = DUEL.find("touch\" time").unwrap();
    let element = script.tree().element_at(at).unwrap();
    assert_eq!(script.tree().elements()[element].row.name, "at");
    assert_eq!(script.tree().place(at).to_string(), "29:21");
    assert_eq!(script.tree().element_at(0), None);
}

#[test]
fn other_namespaces_and_comments_are_kept_and_ignored() {
    let text = "<script version=\"1\" xmlns:x=\"urn:x\" x:y=\"1\"><!-- note --><x:data a=\"b\"><play/>text</x:data>\
                <wait x:color=\"red\" dur=\"1\"/></script>";
    let script = read(text);
    assert_eq!(script.actions().len(), 2);
    assert_eq!(&**script.tree().text(), text);
}
