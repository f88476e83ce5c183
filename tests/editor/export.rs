//! The dialog for exports: what will be lost is shown before, and files are written as chosen.

use crate::panels::{Bench, harness};
use dragonfly::panels::commands::Id;
use dragonfly::panels::prompts::Overlay;
use dragonfly::panels::{Effect, FileAction, Request};
use dragonfly_document::{DocumentMessage, ExportContent, ExportOrder, ExportReport, ExportedFile};
use dragonfly_fbx::TexturePlacement;
use dragonfly_kit::document::fixture;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

type Window = Harness<'static, Bench>;

/// Returns the orders that the dialog sent since the last call.
fn orders(window: &mut Window) -> Vec<ExportOrder> {
    let effects = std::mem::take(&mut window.state_mut().effects);
    let order = |effect| match effect {
        Effect::File(FileAction::Send(DocumentMessage::Export(order))) => Some(order),
        _ => None,
    };
    effects.into_iter().filter_map(order).collect()
}

fn open() -> Window {
    let mut window = harness(Bench::new(Some(fixture::full())));
    window.run_steps(4);
    window.state_mut().state.execute(Request::Command(Id::Export));
    window.run_steps(4);
    window
}

fn press(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).click();
    window.run_steps(4);
}

fn choose(window: &mut Window, list: &str, entry: &str) {
    window.get_by_role_and_label(Role::ComboBox, list).click();
    window.run_steps(4);
    window.query_all_by_label(entry).last().expect(entry).click();
    window.run_steps(4);
}

fn answer(window: &mut Window, order: &ExportOrder, replaces: bool, lost: &[&str]) {
    let beside = vec!["Full_skin.png".to_owned()];
    let file = ExportedFile { path: order.output.clone(), bytes: 1234, beside, replaces };
    let lost = lost.iter().map(|&text| text.to_owned()).collect();
    window.state_mut().state.exported(order.clone(), Ok(ExportReport { files: vec![file], lost }));
    window.run_steps(4);
}

#[test]
fn the_dialog_shows_what_is_lost_and_sends_the_order_that_was_chosen() {
    let mut window = open();
    // It asks once, and again for each choice.
    assert_eq!(orders(&mut window).len(), 1);
    window.run_steps(4);
    assert_eq!(orders(&mut window), []);
    choose(&mut window, "Format", "BVH motion capture");
    choose(&mut window, "Content", "Skeleton and takes only");
    window.get_by_label("Each a file").click();
    window.run_steps(4);
    choose(&mut window, "Keys", "One at each frame");
    let order = orders(&mut window).pop().expect("an order");
    let rate = window.state().state.read().frame_rate;
    assert_eq!(order.bake, Some(rate));
    assert_eq!(order.output.extension().and_then(|extension| extension.to_str()), Some("bvh"));
    assert_eq!((order.content, order.each, order.is_written), (ExportContent::Takes, true, false));
    // The answer to another order is not taken for this one.
    let other = ExportOrder { each: false, ..order.clone() };
    answer(&mut window, &other, false, &["an older answer"]);
    assert!(window.query_by_label("an older answer").is_none());
    press(&mut window, "Export");
    assert_eq!(orders(&mut window), [], "the answer is not there");
    answer(&mut window, &order, false, &["take \"Walk\": a BVH file has one take"]);
    assert!(window.query_by_label("take \"Walk\": a BVH file has one take").is_some());
    press(&mut window, "Export");
    let written = orders(&mut window);
    assert_eq!(written[0], ExportOrder { is_written: true, ..order.clone() });
    window.state_mut().state.exported(written[0].clone(), Err("no space left".to_owned()));
    window.run_steps(4);
    assert_eq!(window.state().state.read().overlay, Some(Overlay::Export), "another path can be chosen");
    window.state_mut().state.exported(written[0].clone(), Ok(ExportReport::default()));
    assert_eq!(window.state().state.read().overlay, None);
}

#[test]
fn a_preset_and_a_place_of_textures_belong_to_their_format_and_an_existing_file_is_replaced_knowingly() {
    let mut window = open();
    choose(&mut window, "Format", "Autodesk FBX");
    choose(&mut window, "Preset", "Unity");
    let order = orders(&mut window).pop().expect("an order");
    assert_eq!((order.preset.as_deref(), order.textures), (Some("unity"), Some(TexturePlacement::Embedded)));
    choose(&mut window, "Textures", "Files beside it");
    let order = orders(&mut window).pop().expect("an order");
    assert_eq!((order.preset.as_deref(), order.textures), (Some("unity"), Some(TexturePlacement::Beside)));
    answer(&mut window, &order, true, &[]);
    assert!(window.query_by_label("Replace").is_some() && window.query_by_label("Nothing is lost").is_some());
    assert!(window.query_by_label("With Full_skin.png beside it").is_some());
    choose(&mut window, "Format", "Dragonfly model");
    let order = orders(&mut window).pop().expect("an order");
    assert_eq!((order.preset, order.textures), (None, None));
}
