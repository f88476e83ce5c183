//! What the tiny editor edits, and what is seen of it: a chain of bones, each a line that begins where the one before
//! it ends. It knows no thread; both ways use it as it is.

/// A place in the picture.
pub type Point = [f32; 2];

// feature: begin
/// Red, green and blue.
pub type Color = [u8; 3];

/// The color of a bone for which nobody has chosen one.
pub const WHITE: Color = [255, 255, 255];
// feature: end

/// One bone.
#[derive(Clone, Debug, PartialEq)]
pub struct Bone {
    /// What the panel calls it.
    pub name: String,
    /// Against the bone before it, in radians.
    pub angle: f32,
    // feature: begin
    /// Of its line in the picture.
    pub color: Color,
    /// A hidden bone is not drawn and cannot be picked; those behind it stay where they are.
    pub visible: bool,
    // feature: end
}

impl Bone {
    /// A bone as it is at first.
    pub fn new(name: &str, angle: f32) -> Self {
        Self {
            name: name.to_owned(),
            angle,
            // feature: begin
            color: WHITE,
            visible: true,
            // feature: end
        }
    }
}

/// A bone in the picture, one unit long.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Which bone it is.
    pub bone: usize,
    /// Where it begins.
    pub from: Point,
    /// Where it ends.
    pub to: Point,
    /// In which color it is drawn.
    pub color: Color, // feature
}

/// The picture of the whole chain.
pub fn draw(bones: &[Bone]) -> Vec<Line> {
    let mut lines = Vec::new();
    let (mut from, mut angle) = ([0.0, 0.0], 0.0_f32);
    for (number, bone) in bones.iter().enumerate() {
        angle += bone.angle;
        let to = [from[0] + angle.cos(), from[1] + angle.sin()];
        let line = Line {
            bone: number,
            from,
            to,
            color: bone.color, // feature
        };
        lines.extend(bone.visible.then_some(line)); // feature, before: lines.push(line);
        from = to;
    }
    lines
}

/// The bone whose line has its middle nearest to `point`, and not more than half a unit away.
pub fn pick(lines: &[Line], point: Point) -> Option<usize> {
    let distance = |line: &Line| {
        let middle = [0, 1].map(|axis| f32::midpoint(line.from[axis], line.to[axis]) - point[axis]);
        middle[0].hypot(middle[1])
    };
    let nearest = lines.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    (distance(nearest) <= 0.5).then_some(nearest.bone)
}

/// A bone's row in the panel.
pub fn describe(bone: &Bone) -> String {
    let mut text = format!("{} {:.2}", bone.name, bone.angle);
    // feature: begin
    let [red, green, blue] = bone.color;
    text += &format!(" #{red:02x}{green:02x}{blue:02x}");
    if !bone.visible {
        text += " hidden";
    }
    // feature: end
    text
}
