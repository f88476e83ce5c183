//! Settings survive any damage to their files.

use dragonfly::app::store::{self, Store};
use dragonfly::panels::settings::{GhostSettings, RECENT, ThemeChoice};
use dragonfly::panels::{Layout, Settings, VIEWPORT, all};
use std::path::Path;

#[test]
fn settings_survive_a_round_trip() {
    let mut settings = Settings { theme: ThemeChoice::Light, scale: 1.5, ..Settings::default() };
    settings.remember(Path::new("/models/fox.glb"));
    assert_eq!(Settings::parse(&settings.to_text()), settings);
}

#[test]
fn a_damaged_settings_file_gives_the_defaults() {
    let whole = Settings { scale: 1.5, ..Settings::default() }.to_text();
    for text in ["", "{", "[]", "null", "{\"scale\": \"large\"}", "\u{0}\u{1}", &whole[..whole.len() / 2]] {
        assert_eq!(Settings::parse(text), Settings::default(), "{text:?}");
    }
}

#[test]
fn an_invalid_number_becomes_the_nearest_valid_one() {
    let settings = Settings::parse("{\"scale\": 1000.0, \"speed\": -3.0}");
    assert_eq!((settings.scale, settings.speed), (2.0, 0.05));
    assert_eq!(
        Settings::parse("{\"unknown\": 1, \"scale\": 1.25}").scale,
        1.25,
        "what is unknown is left alone"
    );
}

#[test]
fn recent_files_are_listed_once_with_the_newest_first() {
    let mut settings = Settings::default();
    for index in 0..30 {
        settings.remember(Path::new(&format!("/models/{index}.glb")));
    }
    settings.remember(Path::new("/models/25.glb"));
    assert_eq!(settings.recent.len(), RECENT);
    assert_eq!(settings.recent[0], Path::new("/models/25.glb"));
    assert_eq!(settings.recent.iter().filter(|path| path.ends_with("25.glb")).count(), 1);
}

#[test]
fn the_panel_layout_is_restored_unless_it_is_damaged() {
    let panels = all();
    let usual = Layout::usual(&panels);
    let text = usual.to_text();
    assert_eq!(Layout::parse(&text, &panels).to_text(), text);
    let mut hidden = Layout::usual(&panels);
    hidden.toggle("takes");
    assert!(!Layout::parse(&hidden.to_text(), &panels).is_shown("takes"));
    let foreign = text.replace("\"takes\"", "\"unknown\"");
    let newer = text.replace("\"version\":2", "\"version\":9");
    for text in ["", "{}", "{\"version\":1}", &text[..text.len() / 3], &foreign, &newer] {
        let layout = Layout::parse(text, &panels);
        assert_eq!(layout.to_text(), usual.to_text());
        assert!(layout.is_shown(VIEWPORT));
    }
}

#[test]
fn the_store_replaces_files_and_tolerates_missing_ones() {
    let folder = std::env::temp_dir().join(format!("dragonfly-store-{}", std::process::id()));
    let store = Store::new(Some(folder.clone()));
    assert_eq!(store.read(store::SETTINGS), "");
    store.write(store::SETTINGS, "one").unwrap();
    store.write(store::SETTINGS, "two").unwrap();
    assert_eq!(store.read(store::SETTINGS), "two");
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1, "no partly written file stays");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn the_ghost_style_is_remembered_and_defaults_to_skeletons() {
    assert!(!GhostSettings::default().skin);
    let text = "{\"hand\":{\"ghosts\":{\"skin\":true,\"step\":3}}}";
    let ghosts = Settings::parse(text).tools.ghosts;
    assert_eq!((ghosts.skin, ghosts.step, ghosts.count), (true, 3, [3, 3]));
}

#[test]
fn a_layout_that_is_older_than_a_panel_stays_as_it_is_and_gets_the_panel_as_a_tab() {
    let panels = dragonfly::panels::all();
    let older: Vec<_> = dragonfly::panels::all().into_iter().filter(|panel| panel.id() != "layers").collect();
    let mut layout = Layout::parse("", &older);
    layout.toggle("takes");
    let text = layout.to_text();
    let mut read = Layout::parse(&text, &panels);
    assert!(read.is_shown("layers") && !read.is_shown("takes"), "the arrangement of the file is kept");
    assert!(read.take_changed(), "it is stored with the new panel");
    assert_eq!(Layout::parse(&read.to_text(), &panels).to_text(), read.to_text());
    // A panel that this program does not have makes the file one of another program.
    assert!(Layout::parse(&text, &older[1..]).is_shown("takes"));
}
