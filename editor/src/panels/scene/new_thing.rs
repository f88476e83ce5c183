//! New things of a cast, and new sounds.

use dragonfly_anim::stage::gesture::GestureRefusal;
use dragonfly_anim::stage::script::{ScriptElement, ScriptTree, StageScript};
use dragonfly_anim::stage::splice::{ElementPlace, NewElement, TextSplices, insert, unique_id};
use dragonfly_anim::stage::time::{StageRate, StageTime, parse_time};
use dragonfly_document::edit::ScriptLabel;

/// A model to add to the cast.
#[derive(Clone, Debug, PartialEq)]
pub struct NewModel {
    /// Its file, relative to the folder of the script.
    pub file: String,
    /// Its place as scripts have it; without one, a free place near the origin.
    pub at: Option<String>,
    /// Factor from its lengths to meters.
    pub scale: f64,
}

impl NewModel {
    /// Returns the element of a thing with this model.
    fn element(&self, name: &str, id: &str, at: impl FnOnce() -> String) -> NewElement {
        let place = self.at.clone().unwrap_or_else(at);
        let element =
            NewElement::new(name).with("id", id).with("model", self.file.as_str()).with("at", place);
        if self.scale == 1.0 { element } else { element.with("scale", self.scale.to_string()) }
    }
}

/// A thing to add to the cast.
#[derive(Clone, Debug, PartialEq)]
pub enum NewThing {
    /// A figure with takes.
    Role(NewModel),
    /// An object.
    Prop(NewModel),
    /// A camera in front of the scene.
    Camera,
    /// A sun.
    Light,
    /// Rain.
    Effect,
    /// A way along the ground.
    Path,
    /// A way that was drawn: its points in meters as scripts have them, and whether it is smooth.
    DrawnPath(String, bool),
    /// A way along a line of the project, by its id.
    LinePath(String),
    /// A place to go to.
    Mark,
}

impl NewThing {
    /// Returns the label of the edit.
    pub fn label(&self) -> ScriptLabel {
        match self {
            Self::Role(_) => ScriptLabel::AddRole,
            Self::Prop(_) => ScriptLabel::AddProp,
            Self::Camera => ScriptLabel::AddCamera,
            Self::Light => ScriptLabel::AddLight,
            Self::Effect => ScriptLabel::AddEffect,
            Self::Path | Self::LinePath(_) => ScriptLabel::AddPath,
            Self::DrawnPath(..) => ScriptLabel::DrawPath,
            Self::Mark => ScriptLabel::AddMark,
        }
    }

    /// Returns the text from which its id is made.
    fn id_base(&self) -> &str {
        match self {
            Self::Role(model) | Self::Prop(model) => stem(&model.file),
            Self::Camera => "camera",
            Self::Light => "light",
            Self::Effect => "effect",
            Self::Path | Self::DrawnPath(..) => "path",
            Self::LinePath(line) => line,
            Self::Mark => "mark",
        }
    }

    /// Returns the element.
    fn element(&self, tree: &ScriptTree, id: &str) -> NewElement {
        let named = |name: &str| NewElement::new(name).with("id", id);
        match self {
            Self::Role(model) => model.element("role", id, || format!("{} 0 0", role_place(tree))),
            Self::Prop(model) => model.element("prop", id, || "0 0 0".to_owned()),
            Self::Camera => named("camera").with("at", "0 1.6 6").with("look", "0 1 0").with("lens", "35mm"),
            Self::Light => named("light").with("kind", "sun").with("direction", "-1 -2 -1"),
            Self::Effect => {
                named("effect").with("kind", "particles").with("preset", "rain").with("at", "0 6 0")
            }
            Self::Path => named("path").with("points", "0 0 0  2 0 0").with("curve", "smooth"),
            Self::DrawnPath(points, is_smooth) => {
                let path = named("path").with("points", points.as_str());
                if *is_smooth { path.with("curve", "smooth") } else { path }
            }
            Self::LinePath(line) => named("path").with("line", line.as_str()),
            Self::Mark => named("mark").with("at", "0 0 0"),
        }
    }
}

/// Returns where on the x axis the next role is put where nothing is known of its size, meters: next to the others, not inside of them.
pub fn role_place(tree: &ScriptTree) -> usize {
    tree.elements().iter().filter(|element| element.row.name == "role").count()
}

/// Returns the name of a file without folder and extension, in lower case.
fn stem(model: &str) -> &str {
    let name = model.rsplit('/').next().unwrap_or(model);
    name.split_once('.').map_or(name, |(stem, _)| stem)
}

/// Returns the script with a new thing after the last one of its kind, and the id of the thing, which no other element has.
///
/// # Errors
///
/// The result would be no script.
pub fn with_new_thing(
    script: &StageScript,
    thing: &NewThing,
) -> Result<(StageScript, Box<str>), GestureRefusal> {
    let is_there = script.tree().elements().iter().any(|element| is_own(element, "cast"));
    let with_cast = match is_there {
        true => None,
        false => Some(inserted(script, ElementPlace::First(0), &NewElement::new("cast"))?),
    };
    let script = with_cast.as_ref().unwrap_or(script);
    let (place, element, id) = placed(script, thing);
    Ok((inserted(script, place, &element)?, id))
}

/// Returns the replacements that add a thing to a script with a cast, as [`with_new_thing`] does, and its id.
///
/// # Errors
///
/// The script has no cast.
pub fn new_thing_splices(
    script: &StageScript,
    thing: &NewThing,
) -> Result<(TextSplices, Box<str>), GestureRefusal> {
    let (place, element, id) = placed(script, thing);
    let is_there = script.tree().elements().iter().any(|element| is_own(element, "cast"));
    let splices = insert(script.tree(), place, &element).filter(|_| is_there);
    let refused = || GestureRefusal(format!("A {} cannot be added to this script", element.name()));
    Ok((splices.ok_or_else(refused)?, id))
}

/// Returns the element of a new thing with its place and its id.
fn placed(script: &StageScript, thing: &NewThing) -> (ElementPlace, NewElement, Box<str>) {
    let tree = script.tree();
    let id = unique_id(tree, thing.id_base());
    let element = thing.element(tree, &id);
    let of_kind = |name: &str| tree.elements().iter().rposition(|element| is_own(element, name));
    let cast = of_kind("cast").unwrap_or_default();
    let last = tree.elements().iter().rposition(|element| element.parent == Some(cast));
    let place = of_kind(element.name()).or(last).map_or(ElementPlace::First(cast), ElementPlace::After);
    (place, element, id.into())
}

/// Returns the script with a sound of a file from `at` on, at its end; the name of the file is relative to the folder of the script.
///
/// # Errors
///
/// The result would be no script.
pub fn with_new_sound(
    script: &StageScript,
    source: &str,
    at: StageTime,
) -> Result<StageScript, GestureRefusal> {
    let sound = NewElement::new("sound").with("src", source);
    let sound = if at > StageTime::ZERO { sound.with("begin", begin_text(at, script.rate())) } else { sound };
    // The script is a `par`: what is in it begins at its start.
    let last = script.tree().elements().iter().rposition(|element| element.parent == Some(0));
    inserted(script, last.map_or(ElementPlace::First(0), ElementPlace::After), &sound)
}

/// Returns the script with an effect that is on from `at` on, to the end of the scene.
///
/// # Errors
///
/// The result would be no script.
pub fn with_run(script: &StageScript, effect: &str, at: StageTime) -> Result<StageScript, GestureRefusal> {
    let run = NewElement::new("run").with("who", effect);
    let run = if at > StageTime::ZERO { run.with("begin", begin_text(at, script.rate())) } else { run };
    let last = script.tree().elements().iter().rposition(|element| element.parent == Some(0));
    inserted(script, last.map_or(ElementPlace::First(0), ElementPlace::After), &run)
}

/// Returns whether an element of this name is in the text of the script itself.
fn is_own(element: &ScriptElement, name: &str) -> bool {
    element.row.name == name && element.is_own()
}

fn inserted(
    script: &StageScript,
    place: ElementPlace,
    element: &NewElement,
) -> Result<StageScript, GestureRefusal> {
    let refused = || GestureRefusal(format!("A {} cannot be added to this script", element.name()));
    let splices = insert(script.tree(), place, element).ok_or_else(refused)?;
    Ok(script.reread(splices.apply(script.tree().text()))?)
}

/// Returns a time as it is written: seconds where three decimals are enough, else frames, else whole milliseconds.
pub fn begin_text(at: StageTime, rate: StageRate) -> String {
    let (seconds, thousandths) =
        (|thousandths: f64| (thousandths / 1000.0).to_string(), at.seconds() * 1000.0);
    let texts = [seconds(thousandths.round()), format!("{}f", rate.nearest_frame(at))];
    let exact = texts.into_iter().find(|text| parse_time(text, rate) == Some(at));
    exact.unwrap_or_else(|| seconds(thousandths.floor()))
}
