//! New things of a cast.

use dragonfly_anim::stage::gesture::GestureRefusal;
use dragonfly_anim::stage::script::{ScriptTree, StageScript};
use dragonfly_anim::stage::splice::{ElementPlace, NewElement, insert, unique_id};
use std::sync::Arc;

/// A thing to add to the cast.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NewThing {
    /// A figure with takes: its model, relative to the folder of the script.
    Role(String),
    /// A figure, and its place as scripts have it.
    RoleAt(String, String),
    /// An object: its model, relative to the folder of the script.
    Prop(String),
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
    pub fn label(&self) -> &'static str {
        match self {
            Self::Role(_) | Self::RoleAt(..) => "Add role",
            Self::Prop(_) => "Add prop",
            Self::Camera => "Add camera",
            Self::Light => "Add light",
            Self::Effect => "Add effect",
            Self::Path | Self::LinePath(_) => "Add path",
            Self::DrawnPath(..) => "Draw path",
            Self::Mark => "Add mark",
        }
    }

    /// Returns the element, with an id that no other element has.
    fn element(&self, tree: &ScriptTree) -> NewElement {
        let named = |name: &str, base: &str| NewElement::new(name).with("id", unique_id(tree, base));
        match self {
            Self::Role(model) => {
                // Next to each other, not inside of each other.
                let roles = tree.elements().iter().filter(|element| element.row.name == "role").count();
                named("role", stem(model)).with("model", model.as_str()).with("at", format!("{roles} 0 0"))
            }
            Self::RoleAt(model, place) => {
                named("role", stem(model)).with("model", model.as_str()).with("at", place.as_str())
            }
            Self::Prop(model) => named("prop", stem(model)).with("model", model.as_str()).with("at", "0 0 0"),
            Self::Camera => {
                named("camera", "camera").with("at", "0 1.6 6").with("look", "0 1 0").with("lens", "35mm")
            }
            Self::Light => named("light", "light").with("kind", "sun").with("direction", "-1 -2 -1"),
            Self::Effect => {
                named("effect", "effect").with("kind", "particles").with("preset", "rain").with("at", "0 6 0")
            }
            Self::Path => named("path", "path").with("points", "0 0 0  2 0 0").with("curve", "smooth"),
            Self::DrawnPath(points, is_smooth) => {
                let path = named("path", "path").with("points", points.as_str());
                if *is_smooth { path.with("curve", "smooth") } else { path }
            }
            Self::LinePath(line) => named("path", line).with("line", line.as_str()),
            Self::Mark => named("mark", "mark").with("at", "0 0 0"),
        }
    }
}

/// Returns the name of a file without folder and extension, in lower case.
fn stem(model: &str) -> &str {
    let name = model.rsplit('/').next().unwrap_or(model);
    name.split_once('.').map_or(name, |(stem, _)| stem)
}

/// Returns the text with a new thing after the last one of its kind, and the id of the thing. `script` is the one that has the text, or from
/// which it was made.
///
/// # Errors
///
/// The result would be no script.
pub fn new_thing_text(
    script: &StageScript,
    text: &Arc<str>,
    thing: &NewThing,
) -> Result<(String, Box<str>), GestureRefusal> {
    let mut tree = ScriptTree::read(Arc::clone(text))?;
    if !tree.elements().iter().any(|element| element.row.name == "cast") {
        let with_cast = insert(&tree, ElementPlace::First(0), &NewElement::new("cast"))
            .map(|splices| splices.apply(tree.text()))
            .unwrap_or_default();
        tree = ScriptTree::read(with_cast)?;
    }
    let element = thing.element(&tree);
    let kind = element.name();
    let of_kind = |name: &str| tree.elements().iter().rposition(|element| element.row.name == name);
    let cast = of_kind("cast").unwrap_or_default();
    let last = tree.elements().iter().rposition(|element| element.parent == Some(cast));
    let place = of_kind(kind).or(last).map_or(ElementPlace::First(cast), ElementPlace::After);
    let new = insert(&tree, place, &element).map(|splices| splices.apply(tree.text())).unwrap_or_default();
    let script = script.reread(new.as_str())?;
    let ids = |script: &ScriptTree| -> Vec<Box<str>> {
        script.elements().iter().filter_map(|element| element.value("id")).map(Into::into).collect()
    };
    let old = ids(&tree);
    let id = ids(script.tree()).into_iter().find(|id| !old.contains(id)).unwrap_or_default();
    Ok((new, id))
}
