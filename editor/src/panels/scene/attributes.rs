//! The attributes of what is selected in a scene, as fields: every row of the vocabulary's tables.

use super::super::context::PanelContext;
use super::super::panel::PanelSubject;
use super::super::request::Request;
use super::super::style::GRID;
use super::super::theme::Theme;
use super::super::{Panel, PanelPlace, widgets};
use super::attribute_numbers::{DraggedAttribute, NumberAttribute, reset_menu};
use super::renaming::renamed;
use super::script::cursor::with_names;
use super::script::text_choice::ShownText;
use super::thing_icon::icon;
use super::{ChangedThings, LineRequest, SceneBase, SceneRequest, ScriptChange, line_named};
use crate::panels::icons::Icon;
use crate::panels::plain_words::plain_words;
use dragonfly_anim::stage::gesture::{GestureRefusal, in_scene_texts, set_on_thing};
use dragonfly_anim::stage::script::{ScriptElement, StageScript};
use dragonfly_anim::stage::table::AttributeRow;
use dragonfly_anim::stage::writing::completions;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::history::Gesture;
use egui::{Key, RichText, ScrollArea, TextEdit, Ui};

/// The fields of the selected action or thing, and of the selected line.
#[derive(Debug, Default)]
pub struct SceneAttributes {
    /// The field that is being typed in: its owner, the attribute, and the text.
    typed: Option<(FieldOwner, &'static str, String)>,
    /// The number that is dragged.
    dragged: Option<DraggedAttribute>,
}

impl Panel for SceneAttributes {
    fn id(&self) -> &'static str {
        "scene_attributes"
    }

    fn title(&self) -> &'static str {
        "Attributes"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Right
    }

    fn subject(&self) -> PanelSubject {
        PanelSubject::Scene
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let script = context.scene().and_then(|scene| scene.script.as_deref());
        let element = script.and_then(|script| Some((script, selected(script, context)?)));
        let line = selected_line(context);
        if element.is_none() && line.is_none() {
            return widgets::empty(
                ui,
                "Nothing is selected",
                "Click a thing of the scene, an action in its timeline, or a line in the list",
            );
        }
        if let Some((script, element)) = element {
            heading(ui, &script.tree().elements()[element], script);
        }
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            if let Some((script, element)) = element {
                let own = &script.tree().elements()[element];
                let is_locked = [own.value("who"), own.value("id")]
                    .into_iter()
                    .flatten()
                    .any(|id| context.scene_editing.is_locked(id))
                    || own.is_included();
                ui.add_enabled_ui(!is_locked, |ui| {
                    // Required and written ones come first.
                    let is_first = |row: &AttributeRow| {
                        row.required
                            || own.row.one_of.contains(&row.name)
                            || own.attribute(row.name).is_some()
                    };
                    for part in [true, false] {
                        for row in own.row.rows().filter(|row| is_first(row) == part) {
                            let owner = FieldOwner::Element(element);
                            let field = AttributeField { owner, row, element: own };
                            self.field(ui, &field, context, requests);
                        }
                    }
                });
                ui.add_space(2.0 * GRID);
            }
            if let Some((name, line)) = line {
                line_heading(ui, &name, line);
                // The points are dragged in the viewport.
                for row in line.row.rows().filter(|row| row.name != "points") {
                    let field = AttributeField { owner: FieldOwner::Line(name.clone()), row, element: line };
                    self.field(ui, &field, context, requests);
                }
                ui.add_space(2.0 * GRID);
            }
        });
    }
}

/// The owner of an attribute.
#[derive(Clone, Debug, PartialEq)]
enum FieldOwner {
    /// An element of the script, by its position.
    Element(usize),
    /// A line of the project, by its name in the editor.
    Line(Box<str>),
}

/// An attribute as a field.
struct AttributeField<'a> {
    owner: FieldOwner,
    row: &'static AttributeRow,
    element: &'a ScriptElement,
}

impl AttributeField<'_> {
    /// Returns the request that gives the attribute a value; an empty one removes it.
    fn set(&self, context: &PanelContext<'_>, value: &str) -> SceneRequest {
        match &self.owner {
            FieldOwner::Element(element) => set(context, *element, self.row, value),
            FieldOwner::Line(line) => set_of_line(context, line, self.row, value),
        }
    }
}

/// Returns the name and the element of the selected line.
fn selected_line<'a>(context: &PanelContext<'a>) -> Option<(Box<str>, &'a ScriptElement)> {
    let lines = context.scene()?.lines.as_deref()?;
    let name = context.scene_editing.lines().selected()?;
    let element = lines.list()[line_named(lines, name)?].element;
    Some((name.into(), &lines.tree().elements()[element]))
}

/// Returns the element of the selected action, or of the active thing.
fn selected(script: &StageScript, context: &PanelContext<'_>) -> Option<usize> {
    let editing = context.scene_editing;
    if let Some(action) = editing.action().and_then(|action| script.actions().get(action)) {
        return Some(action.element);
    }
    script.thing_element(editing.things().last()?)
}

fn heading(ui: &mut Ui, element: &ScriptElement, script: &StageScript) {
    let theme = Theme::of(ui);
    ui.add_space(2.0 * GRID);
    ui.horizontal(|ui| {
        ui.add_space(2.0 * GRID);
        let (mark, _) = ui.allocate_exact_size(egui::vec2(16.0, 16.0), egui::Sense::hover());
        icon(element.row.name).paint(ui.painter(), mark, theme.accent);
        let name = element.value("id").or_else(|| element.value("who")).unwrap_or_default();
        // An action that plays a take is called a clip, except in the text of the script.
        let kind = if element.row.name == "play" { "clip" } else { element.row.name };
        let title = match name {
            "" => kind.to_owned(),
            name if name == kind => name.to_owned(),
            name => format!("{kind} {name}"),
        };
        ui.label(RichText::new(title).color(theme.text));
        ui.label(RichText::new(line_of(script, element)).small().color(theme.faint));
    });
    ui.horizontal(|ui| {
        ui.add_space(2.0 * GRID);
        let help = RichText::new(plain_words(element.row.help)).small().color(theme.weak);
        ui.add(egui::Label::new(help).wrap());
    });
    ui.add_space(GRID);
}

/// Returns the line of an element, which may be in the project or in an included file.
fn line_of(script: &StageScript, element: &ScriptElement) -> String {
    let shared = script.project().and_then(|project| {
        let own = &project.tree().elements()[project.element_of(element)?];
        Some(project.tree().place(own.range.start).line)
    });
    let line = shared.unwrap_or_else(|| script.tree().place(element.range.start).line);
    match (shared, script.tree().file_of(element)) {
        (Some(_), _) => format!("line {line} of the project"),
        (None, Some(file)) => format!("line {line} of {file}"),
        (None, None) => format!("line {line}"),
    }
}

impl SceneAttributes {
    fn field(
        &mut self,
        ui: &mut Ui,
        field: &AttributeField<'_>,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let (theme, row) = (Theme::of(ui), field.row);
        let written = field.element.attribute(row.name).map(|attribute| &*attribute.value);
        // By its name: a field keeps the focus where another one is written before it.
        ui.push_id(row.name, |ui| {
            ui.horizontal(|ui| {
                ui.add_space(2.0 * GRID);
                let color = if written.is_some() { theme.text } else { theme.weak };
                let (rect, label) = ui.allocate_exact_size(egui::vec2(82.0, 24.0), egui::Sense::CLICK);
                widgets::text_in(ui, rect, row.name, &egui::TextStyle::Body, color);
                if written.is_some() && !row.required && reset_menu(&label) {
                    requests.push(Request::Scene(field.set(context, "")));
                }
                label.on_hover_text(plain_words(&format!("{}\n{}", row.help, row.value.expected)));
                let numbers = match field.owner {
                    FieldOwner::Element(element) => NumberAttribute::of(element, row, written),
                    FieldOwner::Line(_) => None,
                };
                if let Some(numbers) = numbers {
                    if numbers.show(ui, context, &mut self.dragged, requests) {
                        requests.push(Request::Scene(field.set(context, "")));
                    }
                    return;
                }
                let is_typed =
                    self.typed.as_ref().is_some_and(|(of, name, _)| (of, *name) == (&field.owner, row.name));
                if !is_typed && !row.value.choices.is_empty() {
                    return choices(ui, field, context, requests);
                }
                let mut text = match &self.typed {
                    Some((_, _, text)) if is_typed => text.clone(),
                    Some(_) | None => written.unwrap_or_default().to_owned(),
                };
                let has_names = matches!(field.owner, FieldOwner::Element(_))
                    && NAMED.contains(&row.name)
                    && field.element.is_own()
                    && field.element.attribute(row.name).is_some();
                let beside = if has_names { NAMES } else { 0.0 };
                let width = (ui.available_width() - 2.0 * GRID - beside).max(24.0);
                let edit = TextEdit::singleline(&mut text)
                    .hint_text(row.default)
                    .align(egui::Align2::LEFT_CENTER)
                    .desired_width(width);
                let name = match &field.owner {
                    FieldOwner::Element(_) => row.name.to_owned(),
                    FieldOwner::Line(_) => format!("line {}", row.name),
                };
                let response = ui.add(edit).accessible_name(name);
                let escape = ui.input(|input| input.key_pressed(Key::Escape));
                if response.lost_focus() && is_typed {
                    self.typed = None;
                    if !escape && text != written.unwrap_or_default() {
                        requests.push(Request::Scene(field.set(context, &text)));
                    }
                } else if response.has_focus() {
                    self.typed = Some((field.owner.clone(), row.name, text));
                }
                if has_names {
                    named_values(ui, field, context, requests);
                }
            })
        });
    }
}

/// Attributes whose values are names that are offered in a list.
const NAMED: [&str; 6] = ["who", "take", "path", "model", "line", "src"];
/// Width of the button that opens the list, points.
const NAMES: f32 = 26.0;

/// Draws the button that offers the names that an attribute may have: those that the text of the script would suggest.
fn named_values(
    ui: &mut Ui,
    field: &AttributeField<'_>,
    context: &PanelContext<'_>,
    requests: &mut Vec<Request>,
) {
    let name = format!("Choose {}", field.row.name);
    let button = widgets::quiet_button(ui, Icon::Down, true, "", &name);
    egui::Popup::menu(&button).show(|ui| {
        let Some(scene) = context.scene() else { return };
        let (Some(script), Some(written)) = (&scene.script, field.element.attribute(field.row.name)) else {
            return;
        };
        let at = written.value_range.start;
        let found =
            with_names(scene, ShownText::Script, |names| completions(script.tree().text(), at, names));
        if found.is_none() {
            ui.label(RichText::new("There is no other name").color(Theme::of(ui).weak));
        }
        ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
            for item in found.iter().flat_map(|found| &found.items) {
                if ui.selectable_label(*item.label == *written.value, &item.label).clicked() {
                    requests.push(Request::Scene(field.set(context, &item.label)));
                    ui.close();
                }
            }
        });
    });
}

/// Draws the choice between the words that an attribute may have.
fn choices(ui: &mut Ui, field: &AttributeField<'_>, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let row = field.row;
    let now = field.element.value(row.name).unwrap_or_default();
    let button = widgets::choice_button(ui, if now.is_empty() { "—" } else { now });
    button.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::ComboBox, true, row.name));
    egui::Popup::menu(&button).show(|ui| {
        for choice in row.value.choices {
            if ui.selectable_label(*choice == now, *choice).clicked() {
                requests.push(Request::Scene(field.set(context, choice)));
                ui.close();
            }
        }
    });
}

/// Draws the name of a line above its fields.
fn line_heading(ui: &mut Ui, name: &str, line: &ScriptElement) {
    let theme = Theme::of(ui);
    ui.add_space(GRID);
    ui.horizontal(|ui| {
        ui.add_space(2.0 * GRID);
        let (mark, _) = ui.allocate_exact_size(egui::vec2(16.0, 16.0), egui::Sense::hover());
        Icon::Pencil.paint(ui.painter(), mark, theme.accent);
        ui.label(RichText::new(format!("line {name}")).color(theme.text));
    });
    ui.horizontal(|ui| {
        ui.add_space(2.0 * GRID);
        ui.add(egui::Label::new(RichText::new(plain_words(line.row.help)).small().color(theme.weak)).wrap());
    });
    ui.add_space(GRID);
}

/// Returns the request that gives an attribute of a line a value; an empty one removes it.
fn set_of_line(
    context: &PanelContext<'_>,
    line: &str,
    row: &'static AttributeRow,
    value: &str,
) -> SceneRequest {
    let rate = context.scene_rate().unwrap_or_default();
    if !value.is_empty() && !row.value.accepts(value, rate) {
        let expected = plain_words(row.value.expected);
        return SceneRequest::Refused(format!("{}=\"{value}\" is not {expected}", row.name));
    }
    let value = (!value.is_empty()).then(|| value.to_owned());
    SceneRequest::Line(LineRequest::Set(line.into(), row.name, value))
}

/// Returns the request that gives an attribute of an element a value; an empty one removes it.
fn set(context: &PanelContext<'_>, element: usize, row: &AttributeRow, value: &str) -> SceneRequest {
    let done = || -> Result<SceneRequest, GestureRefusal> {
        let refused = |reason: String| GestureRefusal(reason);
        let scene = context.scene().ok_or_else(|| refused("No scene is open".to_owned()))?;
        let base = SceneBase::of(scene, context.scene_editing.text(scene))?;
        let tree = base.script.tree();
        let is_name =
            row.name == "id" && tree.elements().get(element).is_some_and(|own| own.attribute("id").is_some());
        if is_name && !value.is_empty() {
            checked(&base, element, row, value)?;
            return Ok(SceneRequest::Text(renamed(scene, &base, element, value)?));
        }
        let written = Some(value).filter(|value| !value.is_empty());
        Ok(SceneRequest::Text(value_change(&base, element, row, written, None)?))
    };
    done().unwrap_or_else(|refusal| SceneRequest::Refused(refusal.to_string()))
}

/// Returns the change that gives an attribute of an element a value, or removes it.
///
/// # Errors
///
/// The element is in an included file, or the attribute does not accept the value.
pub(super) fn value_change(
    base: &SceneBase,
    element: usize,
    row: &AttributeRow,
    value: Option<&str>,
    gesture: Option<Gesture>,
) -> Result<ScriptChange, GestureRefusal> {
    let (tree, text) = (base.script.tree(), value.unwrap_or_default());
    checked(base, element, row, text)?;
    let splices = set_on_thing(&base.script, element, row.name, value);
    let splices =
        splices.ok_or_else(|| GestureRefusal(format!("{}=\"{text}\" is not possible here", row.name)))?;
    let label = ScriptLabel::ChangeValue;
    // An included file is not read yet.
    if tree.elements().get(element).is_some_and(|own| own.row.name == "include" && row.name == "src") {
        return Ok(base.step(splices.apply(tree.text()), label, ChangedThings::None));
    }
    // A reference to something that does not exist is refused with its reason.
    base.spliced(&splices, label, gesture, ChangedThings::Element(element))
}

/// Refuses a value that an attribute does not accept, and an element of an included file.
fn checked(base: &SceneBase, element: usize, row: &AttributeRow, value: &str) -> Result<(), GestureRefusal> {
    in_scene_texts(base.script.tree(), element)?;
    match value.is_empty() || row.value.accepts(value, base.script.rate()) {
        true => Ok(()),
        false => Err(GestureRefusal(format!("{}=\"{value}\" is not {}", row.name, row.value.expected))),
    }
}
