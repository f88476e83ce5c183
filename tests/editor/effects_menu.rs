//! View > Effects: each entry switches an effect, which is drawn with the next frame and remembered.

use crate::timeline_rig::Animator;
use dragonfly::panels::Settings;
use dragonfly_picture::EffectLook;
use egui_kittest::kittest::Queryable;

/// Returns which effects are on.
fn effects(animator: &Animator) -> EffectLook {
    animator.harness.state().state.read().settings.look.effects
}

/// Clicks an entry of View > Effects.
fn switch(animator: &mut Animator, entry: &str) {
    animator.harness.get_by_label("View").click();
    animator.steps(3);
    let menu = animator.harness.get_by_label("Effects").rect().center();
    animator.click(menu);
    animator.steps(3);
    let at = animator.harness.get_by_label_contains(entry).rect().center();
    animator.click(at);
    animator.steps(3);
}

#[test]
fn each_effect_is_switched_in_the_menu_of_effects() {
    let mut animator = Animator::with_bone(3);
    let usual = EffectLook::default();
    assert_eq!(effects(&animator), usual);
    switch(&mut animator, "Studio shadows");
    let studio = EffectLook { studio_shadows: true, ..usual };
    assert_eq!(effects(&animator), studio);
    switch(&mut animator, "Shadows");
    assert_eq!(effects(&animator), EffectLook { shadows: false, ..studio });
}

#[test]
fn effects_are_remembered_and_older_settings_have_the_usual_ones() {
    let mut settings = Settings::default();
    settings.look.effects = EffectLook { shadows: false, studio_shadows: true };
    assert_eq!(Settings::parse(&settings.to_text()).look.effects, settings.look.effects);
    assert_eq!(Settings::parse("{\"look\": {\"grid\": false}}").look.effects, EffectLook::default());
    let one = Settings::parse("{\"look\": {\"effects\": {\"shadows\": false}}}").look.effects;
    assert_eq!(one, EffectLook { shadows: false, ..EffectLook::default() });
}
