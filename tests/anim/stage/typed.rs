//! A suggestion that is taken leaves a tag that continues as it was.

use super::actors::{assets, fox, fox_script, fox_with, planned};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::writing::{CompletionNames, completions};

/// Returns the text with the suggestion `label` taken at `|`, with `|` where the cursor then is.
fn taken(text: &str, label: &str, names: &CompletionNames<'_>) -> String {
    let at = text.find('|').expect("a cursor");
    let mut text = text.replacen('|', "", 1);
    let found = completions(&text, at, names).expect("suggestions");
    let item = found.items.iter().find(|item| item.label == label);
    let item = item.unwrap_or_else(|| panic!("no {label} in {:?}", found.items));
    text.replace_range(found.range.clone(), &item.insert);
    text.insert(found.range.start + item.cursor, '|');
    text
}

const SCRIPT: &str = "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\"/></cast>";

#[test]
fn a_tag_that_continues_keeps_what_follows() {
    for (text, label, wanted) in [
        ("<pla| who=\"anna\"/>", "play", "<play| who=\"anna\"/>"),
        ("<pl|y who=\"anna\"/>", "play", "<play| who=\"anna\"/>"),
        ("<pla|/>", "play", "<play|/>"),
        ("<pa|><wait/></par>", "par", "<par|><wait/></par>"),
        ("<pa|\n  id=\"a\"><wait/></par>", "par", "<par|\n  id=\"a\"><wait/></par>"),
        ("<par></pa|>", "par", "<par></par>|"),
        ("<par></p|r>", "par", "<par></par>|"),
        ("<par></|", "par", "<par></par>|"),
        ("<par></pa|\n<wait/>", "par", "<par></par>|\n<wait/>"),
        ("<wait be|=\"1\"/>", "begin", "<wait begin|=\"1\"/>"),
        ("<wait be| = \"1\"/>", "begin", "<wait begin| = \"1\"/>"),
        ("<wait b|n=\"1\"/>", "begin", "<wait begin|=\"1\"/>"),
        ("<wait du|/>", "dur", "<wait dur=\"|\"/>"),
        ("<wait du| id=\"a\"/>", "dur", "<wait dur=\"|\" id=\"a\"/>"),
        ("<pla|\n<wait/>", "play", "<play who=\"|\" take=\"\"/>\n<wait/>"),
        ("<play who=\"an| take=\"Walk\"/>", "anna", "<play who=\"anna| take=\"Walk\"/>"),
        ("<play who='an| take='Walk' speed=\"2\"/>", "anna", "<play who='anna| take='Walk' speed=\"2\"/>"),
        ("<play take=\"Walk\" who=\"an|/>", "anna", "<play take=\"Walk\" who=\"anna|/>"),
        ("<play who=\"an|\" take=\"Walk\"/>", "anna", "<play who=\"anna|\" take=\"Walk\"/>"),
    ] {
        let (text, wanted) = (format!("{SCRIPT}{text}"), format!("{SCRIPT}{wanted}"));
        assert_eq!(taken(&text, label, &CompletionNames::default()), wanted);
    }
}

#[test]
fn names_with_signs_of_xml_are_written_so_that_they_are_read_as_they_are() {
    let text = fox_script("<play who=\"anna\" take=\"Walk\"/>");
    for name in ["A & B", "a<b", "say \"no\"", "it's"] {
        let assets = assets(&fox_with(name));
        let plan = planned(&text, &assets);
        let names = CompletionNames { plan: Some(&plan), ..CompletionNames::default() };
        for quote in ['"', '\''] {
            let new = taken(&fox_script(&format!("<play who=\"anna\" take={quote}|{quote}/>")), name, &names);
            let script =
                StageScript::read(new.replace('|', "")).unwrap_or_else(|errors| panic!("{}", errors[0]));
            assert_eq!(script.element(1).value("take"), Some(name));
        }
    }
}

#[test]
fn things_that_a_project_shares_are_suggested() {
    let project = "<project version=\"1\"><cast><camera id=\"crane\"/><mark id=\"gate\"/></cast></project>";
    let project = dragonfly_anim::stage::project::StageProject::read(project).expect("a project");
    let text = "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\"/></cast><shot who=\"crane\"/></script>";
    let script = StageScript::read_of(text, Some(&project)).expect("a script");
    let plan = dragonfly_anim::stage::StagePlan::new(&script, &assets(&fox())).expect("a plan");
    let names = CompletionNames { plan: Some(&plan), project: Some(&project), ..CompletionNames::default() };
    assert_eq!(
        taken("<script version=\"1\"><shot who=\"|\"/>", "crane", &names),
        "<script version=\"1\"><shot who=\"crane|\"/>"
    );
    let new = text.replace("<shot who=\"crane\"/>", "<move who=\"anna\" to=\"g|\"/>");
    assert!(taken(&new, "gate", &names).contains("to=\"gate|\""));
    // A thing of the text itself is suggested once.
    let at = new.find('|').expect("a cursor");
    let all = completions(&new.replace("g|", ""), at - 1, &names).expect("suggestions");
    assert_eq!(all.items.iter().filter(|item| item.label == "anna").count(), 1);
    // A thing of the last plan that is no longer in the text is not.
    let renamed = text.replace("id=\"anna\"", "id=\"hanna\"").replace("who=\"crane\"", "who=\"\"");
    let at = renamed.find("who=\"\"").expect("a cursor") + 5;
    let labels = completions(&renamed, at, &names).map(|found| found.items).unwrap_or_default();
    assert!(labels.iter().any(|item| item.label == "crane"));
    let new = renamed.replace("<shot who=\"\"/>", "<play who=\"\" take=\"\"/>");
    let at = new.find("who=\"\"").expect("a cursor") + 5;
    let labels: Vec<String> = completions(&new, at, &names)
        .expect("suggestions")
        .items
        .into_iter()
        .map(|item| item.label)
        .collect();
    assert_eq!(labels, ["hanna"]);
}
