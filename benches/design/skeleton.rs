//! The data of the tiny editor and its drawing: a chain of bones, each a line that begins at the end of the previous
//! one. It uses no threads; both designs use it unchanged.

/// A point in the image.
pub type Point = [f32; 2];

// feature: begin
/// Red, green and blue.
pub type Color = [u8; 3];

/// Color of a bone without a chosen color.
pub const WHITE: Color = [255, 255, 255];
// feature: end

/// One bone.
#[derive(Clone, Debug, PartialEq)]
pub struct Bone {
    /// Name in the panel.
    pub name: String,
    /// Angle relative to the previous bone, in radians.
    pub angle: f32,
    // feature: begin
    /// Color of the line in the image.
    pub color: Color,
    /// Whether the bone is drawn and can be picked. The bones after a hidden one keep their positions.
    pub visible: bool,
    // feature: end
}

impl Bone {
    /// Returns a bone with the default color, visible.
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

/// A bone in the image, one unit long.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Index of the bone.
    pub bone: usize,
    /// Start of the line.
    pub from: Point,
    /// End of the line.
    pub to: Point,
    /// Color of the line.
    pub color: Color, // feature
}

/// Returns the image of the whole chain.
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

/// Returns the bone whose line has its middle nearest to `point`, at most half a unit away.
pub fn pick(lines: &[Line], point: Point) -> Option<usize> {
    let distance = |line: &Line| {
        let middle = [0, 1].map(|axis| f32::midpoint(line.from[axis], line.to[axis]) - point[axis]);
        middle[0].hypot(middle[1])
    };
    let nearest = lines.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    (distance(nearest) <= 0.5).then_some(nearest.bone)
}

/// Returns a bone's row in the panel.
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
