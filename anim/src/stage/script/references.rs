//! References of actions: to things, to each other's moments, to properties.

use super::scope::ScriptScope;
use super::{ActionMoment, ErrorList, MomentText, StageRepeat, StageScript, suggestion};
use crate::stage::table::{NameReference, PROPERTIES, PropertyType, property, vector};
use crate::stage::time::Decimal;

/// Resolves every reference of `script`, and decides which actions are passive.
pub(super) fn resolve(script: &mut StageScript, errors: &mut ErrorList) {
    for index in 0..script.actions.len() {
        let (begin, end) = (moment(script, index, "begin", errors), moment(script, index, "end", errors));
        script.actions[index].begin = begin;
        script.actions[index].end = end;
        script.actions[index].passive = is_passive(script, index);
        check_who(script, index, errors);
        check_property(script, index, errors);
    }
    for element in 0..script.tree.elements.len() {
        check_spots(script, element, errors);
    }
}

/// Returns the moment of an attribute of an action.
fn moment(script: &StageScript, index: usize, name: &str, errors: &mut ErrorList) -> Option<ActionMoment> {
    let element = script.element(index);
    let attribute = element.attribute(name)?;
    let range = attribute.value_range.clone();
    let (action, point, offset) = match MomentText::parse(&attribute.value, script.rate_of(element))? {
        MomentText::Offset(time) => return Some(ActionMoment::Offset(time)),
        MomentText::Of { action, point, offset } => (action, point, offset),
    };
    let other = if action == "prev" {
        let own = &script.actions[index];
        let before = own.position.checked_sub(1);
        let other =
            own.parent.zip(before).and_then(|(parent, at)| script.actions[parent].children.get(at).copied());
        let Some(other) = other else {
            errors.add(range, "no action is before this one, so there is no `prev`", "");
            return None;
        };
        other
    } else {
        let scope = script.scope(element);
        let Some(other) = scope.action(&action) else {
            let (message, help) = match scope.thing(&action) {
                Some(_) => {
                    (format!("\"{action}\" is a thing of the cast; only actions have moments"), String::new())
                }
                None => (
                    format!("no action has the id \"{action}\""),
                    suggestion(&action, "ids of actions", scope.action_ids()),
                ),
            };
            errors.add(range, message, help);
            return None;
        };
        other
    };
    match &*point {
        "begin" => Some(ActionMoment::Begin(other, offset)),
        "end" => Some(ActionMoment::End(other, offset)),
        _ => {
            let points = script.points(other);
            let Some(&(_, time)) = points.iter().find(|(name, _)| *name == point) else {
                let title = format!("moments of {}", script.tree.title(script.actions[other].element));
                let names = ["begin", "end"].into_iter().chain(points.iter().map(|&(name, _)| name));
                let help = suggestion(&point, &title, names);
                errors.add(range, format!("\"{action}\" has no moment \"{point}\""), help);
                return None;
            };
            Some(ActionMoment::Point(other, time, offset))
        }
    }
}

/// Returns whether an action has no length of its own (rule 3).
fn is_passive(script: &StageScript, index: usize) -> bool {
    let action = &script.actions[index];
    if let Some(ActionMoment::End(other, _)) = action.end {
        return ancestors(script, index).any(|ancestor| ancestor == other);
    }
    if action.end.is_some() || action.dur.is_some() {
        return false;
    }
    let endless = matches!(script.element(index).row.name, "look" | "run" | "shot" | "title");
    endless || action.repeat == StageRepeat::Fill
}

/// Returns the containers around an action, the innermost first.
pub(super) fn ancestors(script: &StageScript, index: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(script.actions[index].parent, |&above| script.actions[above].parent)
}

fn thing_names<'a>(
    script: &'a StageScript,
    scope: ScriptScope<'_>,
    is_one: impl Fn(&str) -> bool,
) -> Vec<&'a str> {
    let names = script.things().filter(|thing| is_one(thing.row.name)).filter_map(|thing| thing.value("id"));
    names.filter(|name| scope.thing(name).is_some()).collect()
}

fn check_who(script: &StageScript, index: usize, errors: &mut ErrorList) {
    let element = script.element(index);
    for (name, kinds) in [("who", element.row.who), ("path", &["path"][..])] {
        let Some(attribute) = element.attribute(name) else { continue };
        let is_one = |kind: &str| kinds.contains(&kind);
        let scope = script.scope(element);
        let kind =
            scope.thing(&attribute.value).map(|thing| script.tree.elements[script.things[thing]].row.name);
        if kind.is_some_and(is_one) {
            continue;
        }
        let wanted = kinds.join(", ");
        let message = match kind {
            Some(kind) => {
                format!("\"{}\" is a {kind}; <{}> needs one of: {wanted}", attribute.value, element.row.name)
            }
            None => format!("no thing of the cast has the id \"{}\"", attribute.value),
        };
        let help =
            suggestion(&attribute.value, &format!("ids of {wanted}"), thing_names(script, scope, is_one));
        errors.add(attribute.value_range.clone(), message, help);
    }
}

/// Checks that the names in positions and directions are things.
fn check_spots(script: &StageScript, index: usize, errors: &mut ErrorList) {
    let element = &script.tree.elements[index];
    for attribute in
        element.attributes.iter().filter(|attribute| attribute.row.reference() == Some(NameReference::Spot))
    {
        let is_spot = matches!(attribute.row.value.pattern, "") && attribute.row.value.choices.is_empty();
        let value = &*attribute.value;
        // The `to` of a property is a value.
        let is_value = element.row.attribute("property").is_some() || vector(value).is_some();
        if !is_spot || is_value || Decimal::parse(value).is_some() {
            continue;
        }
        let name = value.split_once('.').map_or(value, |(name, _)| name);
        let scope = script.scope(element);
        match scope.thing(name) {
            Some(thing) if script.tree.elements[script.things[thing]].row.name == "path" => {
                errors.add(
                    attribute.value_range.clone(),
                    format!("\"{name}\" is a path, which has no position"),
                    "",
                );
            }
            Some(_) => {}
            None => {
                let help =
                    suggestion(name, "ids of things", thing_names(script, scope, |kind| kind != "path"));
                errors.add(
                    attribute.value_range.clone(),
                    format!("no thing of the cast has the id \"{name}\""),
                    help,
                );
            }
        }
    }
}

fn check_property(script: &StageScript, index: usize, errors: &mut ErrorList) {
    let element = script.element(index);
    let (Some(name), Some(to)) = (element.attribute("property"), element.attribute("to")) else { return };
    let scope = script.scope(element);
    let thing = element.value("who").and_then(|who| scope.thing(who));
    let Some(thing) = thing else { return };
    let kind = script.tree.elements[script.things[thing]].row.name;
    let Some(row) = property(kind, &name.value) else {
        let names = PROPERTIES.iter().filter(|row| row.thing == kind).map(|row| row.name);
        let help = suggestion(&name.value, "properties", names);
        errors.add(name.value_range.clone(), format!("a {kind} has no property \"{}\"", name.value), help);
        return;
    };
    let fits = match row.kind {
        PropertyType::Color => to.value.starts_with('#'),
        PropertyType::Number => Decimal::parse(&to.value).is_some_and(|number| !number.is_negative()),
        PropertyType::Lens => {
            Decimal::parse(&to.value).is_some_and(|number| (1.0..=5000.0).contains(&number.to_f64()))
        }
    };
    if !fits {
        let expected = match row.kind {
            PropertyType::Color => "a color such as #ffcc00",
            PropertyType::Number => "a number of 0 or more",
            PropertyType::Lens => "a number of millimeters from 1 to 5000",
        };
        errors.add(to.value_range.clone(), format!("to=\"{}\" is not {expected}", to.value), "");
    }
}
