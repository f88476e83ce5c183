//! Edits of a script's text: what they change, and that nothing else changes.

use super::{DUEL, listed, read};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::splice::{
    AttachedComments, ElementPlace, NewElement, RenameRefusal, TextSplices, delete, duplicate,
    elements_that_name, insert, move_all_after, move_to, remove_attribute, rename, set_attribute, unique_id,
};
use dragonfly_kit::random::{Random, seed};

/// Returns the element with this id.
fn with_id(script: &StageScript, id: &str) -> usize {
    let found = script.tree().elements().iter().position(|element| element.value("id") == Some(id));
    found.unwrap_or_else(|| panic!("no {id}"))
}

/// Returns the lines that differ: those that only `old` has, and those that only `new` has.
fn difference<'a>(old: &'a str, new: &'a str) -> (Vec<&'a str>, Vec<&'a str>) {
    let (old, new): (Vec<&str>, Vec<&str>) = (old.split('\n').collect(), new.split('\n').collect());
    let same = old.iter().zip(&new).take_while(|(old, new)| old == new).count();
    let end =
        old[same..].iter().rev().zip(new[same..].iter().rev()).take_while(|(old, new)| old == new).count();
    (old[same..old.len() - end].to_vec(), new[same..new.len() - end].to_vec())
}

/// Applies splices that a function finds for a text.
fn changed(text: &str, find: impl FnOnce(&StageScript) -> Option<TextSplices>) -> String {
    let script = read(text);
    let splices = find(&script).expect("there is such a place");
    let new = splices.apply(text);
    assert_eq!(splices.inverse(text).apply(&new), text, "the inverse leads back");
    new
}

#[test]
fn a_changed_value_changes_one_line_of_the_text() {
    let new =
        changed(DUEL, |script| set_attribute(script.tree(), with_id(script, "anna-hit"), "speed", "0.75"));
    let (old, new) = difference(DUEL, &new);
    assert_eq!(old, [r#"      <play id="anna-hit" who="anna" take="Slash" speed="1.2" fade-in="6f"/>"#]);
    assert_eq!(new, [r#"      <play id="anna-hit" who="anna" take="Slash" speed="0.75" fade-in="6f"/>"#]);
}

#[test]
fn a_value_is_escaped_for_its_own_quotes_and_read_as_it_was_given() {
    let text = "<script version='1'>\n<title text='a'/><title text=\"b\"/>\n</script>";
    for value in ["it's \"so\" & <so>", "two\nlines\tand a tab\r", "ß 龍 𝄞", ""] {
        for at in [1, 2] {
            let new = changed(text, |script| set_attribute(script.tree(), at, "text", value));
            assert_eq!(read(&new).tree().elements()[at].value("text"), Some(value), "{new}");
        }
    }
}

#[test]
fn a_new_attribute_goes_where_the_last_one_is() {
    let line =
        changed(DUEL, |script| set_attribute(script.tree(), with_id(script, "ben-acts"), "begin", "1.5"));
    assert_eq!(difference(DUEL, &line).1, [r#"    <seq id="ben-acts" begin="1.5">"#]);
    let text = "<script version=\"1\">\r\n\t<wait id=\"a\"\r\n\t      dur=\"1\" />\r\n</script>";
    let own = changed(text, |script| set_attribute(script.tree(), 1, "begin", "2"));
    assert_eq!(own, text.replace("dur=\"1\" />", "dur=\"1\"\r\n\t      begin=\"2\" />"));
    let foreign = "<script version=\"1\" xmlns:x=\"u\"><wait x:note=\"a > b\"/></script>";
    let after = changed(foreign, |script| set_attribute(script.tree(), 1, "dur", "1"));
    assert_eq!(after, foreign.replace("\"/>", "\" dur=\"1\"/>"));
    let back = changed(&after, |script| remove_attribute(script.tree(), 1, "dur"));
    assert_eq!(back, foreign);
}

#[test]
fn a_new_element_has_a_line_of_its_own_with_the_indentation_of_its_siblings() {
    let wait = NewElement::new("wait").with("dur", "0.5");
    let after = changed(DUEL, |script| {
        insert(script.tree(), ElementPlace::After(with_id(script, "anna-hit")), &wait)
    });
    assert_eq!(difference(DUEL, &after), (vec![], vec![r#"      <wait dur="0.5"/>"#]));
    let first = changed(DUEL, |script| {
        insert(script.tree(), ElementPlace::First(with_id(script, "ben-acts")), &wait)
    });
    assert_eq!(difference(DUEL, &first), (vec![], vec![r#"      <wait dur="0.5"/>"#]));
    // A comment after the sibling stays there.
    let camera = NewElement::new("camera").with("id", "side");
    let commented =
        changed(DUEL, |script| insert(script.tree(), ElementPlace::After(with_id(script, "rail")), &camera));
    assert_eq!(difference(DUEL, &commented), (vec![], vec![r#"    <camera id="side"/>"#]));
    assert!(commented.contains("<!-- drawn with the line tool -->\n    <camera id=\"side\"/>"));
}

#[test]
fn an_empty_parent_is_opened_with_an_indentation_like_that_of_the_others() {
    let wait = NewElement::new("wait");
    for (text, new) in [
        (
            "<script version=\"1\">\n    <seq />\n</script>",
            "<script version=\"1\">\n    <seq>\n        <wait/>\n    </seq>\n</script>",
        ),
        (
            "<script version=\"1\">\n\t<seq></seq>\n</script>",
            "<script version=\"1\">\n\t<seq>\n\t\t<wait/>\n\t</seq>\n</script>",
        ),
        (
            "<script version=\"1\">\n\t<seq>\n\t</seq>\n</script>",
            "<script version=\"1\">\n\t<seq>\n\t\t<wait/>\n\t</seq>\n</script>",
        ),
        ("<script version=\"1\"><seq/></script>", "<script version=\"1\"><seq><wait/></seq></script>"),
        ("<script version=\"1\"><seq></seq></script>", "<script version=\"1\"><seq><wait/></seq></script>"),
        (
            "<script version=\"1\">\r\n  <seq> <!-- Anna -->\r\n  </seq>\r\n</script>",
            "<script version=\"1\">\r\n  <seq> <!-- Anna -->\r\n    <wait/>\r\n  </seq>\r\n</script>",
        ),
    ] {
        assert_eq!(changed(text, |script| insert(script.tree(), ElementPlace::First(1), &wait)), new);
    }
}

#[test]
fn a_deleted_element_takes_its_lines_and_comments_only_where_asked_for() {
    let cut = |comments| {
        let new = changed(DUEL, |script| delete(script.tree(), with_id(script, "ben-acts"), comments));
        difference(DUEL, &new).0.iter().map(|line| line.trim().to_owned()).collect::<Vec<_>>()
    };
    let stay = cut(AttachedComments::Stay);
    assert_eq!((stay.len(), stay[0].as_str()), (6, r#"<seq id="ben-acts">"#));
    let follow = cut(AttachedComments::Follow);
    assert_eq!(follow.len(), 7);
    assert!(follow[0].starts_with("<!-- Ben:"), "{follow:?}");
    let rail = |comments| changed(DUEL, |script| delete(script.tree(), with_id(script, "rail"), comments));
    assert!(rail(AttachedComments::Stay).contains("<!-- drawn with"));
    assert!(!rail(AttachedComments::Follow).contains("<!-- drawn with"));
    let cut = |above: &str| {
        let text = format!("<script version=\"1\">\n{above}<wait/>\n</script>");
        let new = changed(&text, |script| {
            delete(script.tree(), script.tree().elements().len() - 1, AttachedComments::Follow)
        });
        new["<script version=\"1\">\n".len()..new.len() - "</script>".len()].to_owned()
    };
    assert_eq!(cut("<!-- far -->\n\n<!-- near -->\n"), "<!-- far -->\n\n", "an empty line separates");
    assert_eq!(cut("<!-- two\n lines -->\n  <!-- one -->\n"), "");
    assert_eq!(cut("<!-- two\n lines --><!-- b -->\n"), "<!-- two\n lines --><!-- b -->\n", "two in a line");
    assert_eq!(cut("<par/><!-- of par -->\n"), "<par/><!-- of par -->\n");
}

#[test]
fn a_moved_element_keeps_its_spelling_and_is_indented_as_its_new_siblings() {
    let new = changed(DUEL, |script| {
        let place = ElementPlace::After(with_id(script, "ben-acts"));
        move_to(script.tree(), with_id(script, "grab"), place, AttachedComments::Stay)
    });
    let script = StageScript::read(new.as_str()).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let grab = &script.tree().elements()[with_id(&script, "grab")];
    let parent = &script.tree().elements()[grab.parent.unwrap()];
    assert_eq!(parent.value("id"), Some("scene-1"));
    assert!(new.contains(
        "    </seq>\n    <play id=\"grab\" who=\"anna\" take=\"PickUp\" fade-in=\"0.2\">\n      <at name=\"touch\" time=\"0.6\"/>\n    </play>\n"
    ), "{new}");
    assert_eq!(new.len() + 3 * 4, DUEL.len(), "four blanks less in each of three lines");
    let inside = read(DUEL);
    let (scene, grab) = (with_id(&inside, "scene-1"), with_id(&inside, "grab"));
    assert_eq!(move_to(inside.tree(), scene, ElementPlace::After(grab), AttachedComments::Stay), None);
    assert_eq!(move_to(inside.tree(), 0, ElementPlace::After(grab), AttachedComments::Stay), None);
}

#[test]
fn elements_that_are_moved_together_keep_their_order_and_comments_also_after_one_of_themselves() {
    let text = "<script version=\"1\">\n  <seq>\n    <!-- first -->\n    <wait id=\"a\" dur=\"1\"/>\n    <wait id=\"b\" dur=\"2\"/> <!-- second -->\n  \
                </seq>\n  <wait id=\"c\" dur=\"3\"/>\n  <par><wait id=\"d\" dur=\"4\"/><wait id=\"e\" dur=\"5\"/></par>\n</script>\n";
    let all = |ids: &[&str], after: &str| {
        changed(text, |script| {
            let elements: Vec<usize> = ids.iter().map(|id| with_id(script, id)).collect();
            move_all_after(script.tree(), &elements, with_id(script, after), AttachedComments::Follow)
        })
    };
    let [first, second] =
        ["<!-- first -->\n  <wait id=\"a\" dur=\"1\"/>\n  ", "<wait id=\"b\" dur=\"2\"/> <!-- second -->\n"];
    let gone = text
        .replace("    <!-- first -->\n    <wait id=\"a\" dur=\"1\"/>\n", "")
        .replace("    <wait id=\"b\" dur=\"2\"/> <!-- second -->\n", "");
    let c = "  <wait id=\"c\" dur=\"3\"/>\n";
    assert_eq!(all(&["a", "b"], "c"), gone.replace(c, &format!("{c}  {first}{second}")));
    // In place of the lines of the last of them.
    assert_eq!(all(&["a", "b", "c"], "c"), gone.replace(c, &format!("  {first}{second}{c}")));
    // In one line.
    let [d, e] = ["<wait id=\"d\" dur=\"4\"/>", "<wait id=\"e\" dur=\"5\"/>"];
    assert_eq!(all(&["d", "e"], "e"), text);
    assert_eq!(all(&["d"], "e"), text.replace(&format!("{d}{e}"), &format!("{e}{d}")));
    let script = read(text);
    let inside = |elements: &[usize]| {
        move_all_after(script.tree(), elements, with_id(&script, "a"), AttachedComments::Follow)
    };
    assert_eq!(inside(&[1]), None, "a sequence does not go into itself");
    assert_eq!(inside(&[]), Some(TextSplices::default()));
}

#[test]
fn a_new_name_is_written_wherever_the_old_one_is_used() {
    let new = changed(DUEL, |script| rename(script.tree(), with_id(script, "anna"), "eve").ok());
    assert_eq!(
        new.matches("\"eve\"").count() + new.matches("\"eve.").count(),
        DUEL.matches("\"anna\"").count() + DUEL.matches("\"anna.").count()
    );
    assert_eq!(
        new.matches("anna").count(),
        DUEL.matches("anna-").count() + DUEL.matches("/anna.glb").count()
    );
    let new = changed(DUEL, |script| rename(script.tree(), with_id(script, "grab"), "take").ok());
    assert_eq!(new.matches("take.touch").count(), 4);
    let script = read(DUEL);
    for wrong in ["", "9", "prev", "ben", "a.b"] {
        let refused = rename(script.tree(), with_id(&script, "anna"), wrong);
        assert_eq!(refused, Err(RenameRefusal::NoName(wrong.to_owned())));
    }
    assert!(
        elements_that_name(script.tree(), "sword").next().is_some()
            && elements_that_name(script.tree(), "anna-acts").next().is_none()
    );
}

#[test]
fn renaming_keeps_the_spelling_of_what_follows_the_name() {
    let text = "<script version=\"1\"><cast><role id='anna' model='a.glb'/><role id='ben' model='b.glb'/></cast>\n\
        <look who='ben' at='anna.a &gt; b&#x20;c' /><look who='&#97;nna' at='ben'/></script>";
    let new = changed(text, |script| rename(script.tree(), with_id(script, "anna"), "eve").ok());
    let expected =
        text.replace("'anna'", "'eve'").replace("'anna.a", "'eve.a").replace("'&#97;nna'", "'eve'");
    assert_eq!(new, expected);
}

#[test]
fn a_copy_has_new_names_and_its_own_references_follow() {
    let new = changed(DUEL, |script| duplicate(script.tree(), with_id(script, "anna-acts")));
    let (removed, added) = difference(DUEL, &new);
    assert_eq!((removed.len(), added.len()), (0, 13));
    let added = added.join("\n");
    assert!(
        added.contains("<seq id=\"anna-acts-2\">") && added.contains("begin=\"grab-2.touch\""),
        "{added}"
    );
    assert!(added.contains("who=\"anna\"") && added.contains("ben.Head"));
    let script = read(&new);
    assert_eq!(unique_id(script.tree(), "grab-2"), "grab-3");
    assert_eq!(unique_id(script.tree(), "Walk (fast)"), "Walk-fast");
    assert_eq!(unique_id(script.tree(), "3"), "a-3");
    assert_eq!(unique_id(script.tree(), "prev"), "a-prev");
}

/// Returns a random edit of a script, whether the new text has to be a script without errors, and whether it has to have all
/// comments.
fn random_edit(random: &mut Random, script: &StageScript) -> Option<(TextSplices, bool, bool)> {
    let tree = script.tree();
    let element = random.below(tree.elements().len());
    let place =
        if random.below(2) == 0 { ElementPlace::First(element) } else { ElementPlace::After(element) };
    let parent = match place {
        ElementPlace::First(parent) => Some(parent),
        ElementPlace::After(sibling) => tree.elements()[sibling].parent,
    };
    let takes_actions =
        parent.is_some_and(|parent| matches!(tree.elements()[parent].row.name, "script" | "seq" | "par"));
    let comments = if random.below(2) == 0 { AttachedComments::Stay } else { AttachedComments::Follow };
    Some(match random.below(7) {
        0 => {
            let time = format!("{}", random.below(100) as f64 / 10.0);
            let row = tree.elements()[element].row;
            (set_attribute(tree, element, "dur", &time)?, row.attribute("dur").is_some(), true)
        }
        1 => {
            let attributes = &tree.elements()[element].attributes;
            let name = attributes.get(random.below(attributes.len().max(1)))?.row.name;
            (remove_attribute(tree, element, name)?, false, true)
        }
        2 => (insert(tree, place, &NewElement::new("wait").with("dur", "1"))?, takes_actions, true),
        3 => (delete(tree, element, comments)?, false, false),
        4 => (move_to(tree, random.below(tree.elements().len()), place, comments)?, false, true),
        5 => (duplicate(tree, element)?, tree.elements()[element].row.name != "cast", true),
        _ => {
            let id = unique_id(tree, random.choice(&["grab", "new", "x 1"]));
            (rename(tree, element, &id).ok()?, true, true)
        }
    })
}

#[test]
fn any_sequence_of_edits_is_undone_to_the_same_text() {
    let first = seed(20_26);
    println!("DRAGONFLY_SEED={first}");
    let mut random = Random::new(first);
    let (mut edits, mut refused) = (0, 0);
    for round in 0..300 {
        let start = if round % 2 == 0 { DUEL.to_owned() } else { DUEL.replace('\n', "\r\n") };
        let (mut text, mut undo) = (start.clone(), Vec::new());
        for _ in 0..12 {
            let script = read(&text);
            let Some((splices, is_valid, keeps_comments)) = random_edit(&mut random, &script) else {
                continue;
            };
            let new = splices.apply(&text);
            let read = StageScript::read(new.as_str());
            let comments = |text: &str| text.matches("<!--").count();
            assert!(!keeps_comments || comments(&new) >= comments(&text), "round {round}: {splices:?}");
            assert!(!is_valid || read.is_ok(), "round {round}: {}\n{splices:?}", listed(&read.unwrap_err()));
            let inverse = splices.inverse(&text);
            edits += 1;
            if read.is_err() {
                refused += 1;
                continue;
            }
            undo.push(inverse);
            text = new;
        }
        for inverse in undo.iter().rev() {
            text = inverse.apply(&text);
        }
        assert!(text == start, "round {round}: undo of all");
    }
    println!("{edits} edits, {refused} of them no script");
    assert!(edits > 2_000 && refused < edits / 2, "{edits} edits, {refused} of them no script");
}
