//! Icons as strokes on a grid of sixteen, so that no font can lack them and they follow the text's colour.

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

/// What can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // The names say it.
pub enum Icon {
    Play,
    Pause,
    Reverse,
    First,
    Last,
    FrameBack,
    FrameForward,
    KeyBack,
    KeyForward,
    Once,
    Loop,
    PingPong,
    Search,
    Close,
    Bone,
    Take,
    Grid,
    Material,
    Clay,
    Unlit,
    XRay,
    Surface,
    Frame,
    Perspective,
    Orthographic,
    View,
    Open,
    Warning,
    Error,
    Info,
    Octahedra,
    Sticks,
    Lines,
    Snap,
    Fit,
    Step,
    Linear,
    Spline,
    AutoKey,
    Key,
    KeyHere,
    KeyElsewhere,
    KeyNever,
    Revert,
    RestPose,
    Sliders,
    Add,
    Duplicate,
    Split,
    Trash,
    Rename,
    Clock,
    Dot,
    Down,
    Right,
    Select,
    Move,
    Rotate,
    Scale,
    AxesLocal,
    AxesParent,
    AxesWorld,
    AxesView,
    PivotIndividual,
    PivotMedian,
    PivotActive,
    Redo,
    Saved,
    Flip,
    Hidden,
    Shown,
    Ghosts,
    Path,
    Ik,
    Pin,
}

impl Icon {
    /// Every icon.
    pub const ALL: &[Self] = &[
        Self::Play,
        Self::Pause,
        Self::Reverse,
        Self::First,
        Self::Last,
        Self::FrameBack,
        Self::FrameForward,
        Self::KeyBack,
        Self::KeyForward,
        Self::Once,
        Self::Loop,
        Self::PingPong,
        Self::Search,
        Self::Close,
        Self::Bone,
        Self::Take,
        Self::Grid,
        Self::Material,
        Self::Clay,
        Self::Unlit,
        Self::XRay,
        Self::Surface,
        Self::Frame,
        Self::Perspective,
        Self::Orthographic,
        Self::View,
        Self::Open,
        Self::Warning,
        Self::Error,
        Self::Info,
        Self::Octahedra,
        Self::Sticks,
        Self::Lines,
        Self::Snap,
        Self::Fit,
        Self::Step,
        Self::Linear,
        Self::Spline,
        Self::AutoKey,
        Self::Key,
        Self::KeyHere,
        Self::KeyElsewhere,
        Self::KeyNever,
        Self::Revert,
        Self::RestPose,
        Self::Sliders,
        Self::Add,
        Self::Duplicate,
        Self::Split,
        Self::Trash,
        Self::Rename,
        Self::Clock,
        Self::Dot,
        Self::Down,
        Self::Right,
        Self::Select,
        Self::Move,
        Self::Rotate,
        Self::Scale,
        Self::AxesLocal,
        Self::AxesParent,
        Self::AxesWorld,
        Self::AxesView,
        Self::PivotIndividual,
        Self::PivotMedian,
        Self::PivotActive,
        Self::Redo,
        Self::Saved,
        Self::Flip,
        Self::Hidden,
        Self::Shown,
        Self::Ghosts,
        Self::Path,
        Self::Ik,
        Self::Pin,
    ];

    /// Draws it into the middle of `rect`, 16 points large.
    pub fn paint(self, painter: &Painter, rect: Rect, color: Color32) {
        let pen = Pen { painter, origin: rect.center() - vec2(8.0, 8.0), color };
        match self {
            Self::Play => pen.solid(&[(5.0, 3.0), (13.0, 8.0), (5.0, 13.0)]),
            Self::Reverse => pen.solid(&[(11.0, 3.0), (3.0, 8.0), (11.0, 13.0)]),
            Self::Pause => {
                pen.bar(4.0, 3.0, 3.0, 10.0);
                pen.bar(9.0, 3.0, 3.0, 10.0);
            }
            Self::First => {
                pen.bar(3.0, 3.5, 1.6, 9.0);
                pen.solid(&[(13.0, 3.5), (6.0, 8.0), (13.0, 12.5)]);
            }
            Self::Last => {
                pen.bar(11.4, 3.5, 1.6, 9.0);
                pen.solid(&[(3.0, 3.5), (10.0, 8.0), (3.0, 12.5)]);
            }
            Self::FrameBack => pen.line(&[(9.5, 4.0), (5.5, 8.0), (9.5, 12.0)]),
            Self::FrameForward => pen.line(&[(6.5, 4.0), (10.5, 8.0), (6.5, 12.0)]),
            Self::KeyBack => {
                pen.line(&[(6.0, 4.5), (2.5, 8.0), (6.0, 11.5)]);
                pen.diamond(10.5, 8.0, 3.4);
            }
            Self::KeyForward => {
                pen.line(&[(10.0, 4.5), (13.5, 8.0), (10.0, 11.5)]);
                pen.diamond(5.5, 8.0, 3.4);
            }
            Self::AutoKey => {
                pen.ring(8.0, 8.0, 5.6);
                pen.dot(8.0, 8.0, 3.0);
            }
            Self::Key => {
                pen.diamond(6.2, 8.0, 3.8);
                pen.line(&[(12.0, 4.6), (12.0, 9.0)]);
                pen.line(&[(9.8, 6.8), (14.2, 6.8)]);
            }
            Self::Once => {
                pen.line(&[(2.5, 8.0), (11.0, 8.0)]);
                pen.line(&[(8.0, 5.0), (11.0, 8.0), (8.0, 11.0)]);
                pen.line(&[(13.5, 4.0), (13.5, 12.0)]);
            }
            Self::Loop => {
                pen.line(&[(3.0, 9.0), (3.0, 5.0), (12.0, 5.0)]);
                pen.line(&[(10.0, 3.0), (12.3, 5.0), (10.0, 7.0)]);
                pen.line(&[(13.0, 7.0), (13.0, 11.0), (4.0, 11.0)]);
                pen.line(&[(6.0, 9.0), (3.7, 11.0), (6.0, 13.0)]);
            }
            Self::PingPong => {
                pen.line(&[(2.5, 8.0), (13.5, 8.0)]);
                pen.line(&[(5.0, 5.0), (2.2, 8.0), (5.0, 11.0)]);
                pen.line(&[(11.0, 5.0), (13.8, 8.0), (11.0, 11.0)]);
            }
            Self::Snap => {
                pen.line(&[
                    (4.0, 3.0),
                    (4.0, 9.0),
                    (5.5, 11.8),
                    (8.0, 12.8),
                    (10.5, 11.8),
                    (12.0, 9.0),
                    (12.0, 3.0),
                ]);
                pen.bar(2.8, 2.6, 2.6, 2.2);
                pen.bar(10.7, 2.6, 2.6, 2.2);
            }
            Self::Fit => {
                pen.line(&[(2.5, 4.0), (2.5, 12.0)]);
                pen.line(&[(13.5, 4.0), (13.5, 12.0)]);
                pen.line(&[(4.5, 8.0), (11.5, 8.0)]);
                pen.line(&[(6.5, 6.0), (4.5, 8.0), (6.5, 10.0)]);
                pen.line(&[(9.5, 6.0), (11.5, 8.0), (9.5, 10.0)]);
            }
            Self::Step => pen.line(&[(2.5, 12.0), (8.0, 12.0), (8.0, 4.0), (13.5, 4.0)]),
            Self::Linear => pen.line(&[(2.5, 12.0), (13.5, 4.0)]),
            Self::Spline => pen.line(&[
                (2.5, 12.0),
                (4.5, 11.7),
                (6.4, 10.4),
                (8.0, 8.0),
                (9.6, 5.6),
                (11.5, 4.3),
                (13.5, 4.0),
            ]),
            Self::Ik => {
                pen.dot(3.4, 12.4, 1.7);
                pen.line(&[(3.4, 12.4), (5.4, 5.0), (10.6, 7.6)]);
                pen.dot(5.4, 5.0, 1.7);
                pen.ring(12.2, 8.6, 2.2);
            }
            Self::Pin => {
                pen.line(&[(5.0, 2.8), (11.0, 2.8)]);
                pen.outline(&[(6.2, 2.8), (9.8, 2.8), (9.8, 7.0), (11.8, 9.4), (4.2, 9.4), (6.2, 7.0)]);
                pen.line(&[(8.0, 9.4), (8.0, 13.8)]);
            }
            Self::Search => {
                pen.ring(7.0, 7.0, 4.0);
                pen.line(&[(10.0, 10.0), (13.5, 13.5)]);
            }
            Self::Close => {
                pen.line(&[(4.5, 4.5), (11.5, 11.5)]);
                pen.line(&[(11.5, 4.5), (4.5, 11.5)]);
            }
            Self::Bone => {
                pen.ring(8.0, 3.8, 1.9);
                pen.line(&[(8.0, 5.8), (8.0, 9.8)]);
                pen.line(&[(3.6, 7.4), (12.4, 7.4)]);
                pen.line(&[(5.0, 13.8), (8.0, 9.8), (11.0, 13.8)]);
            }
            Self::Octahedra => {
                pen.outline(&[(3.0, 13.0), (4.0, 8.0), (13.0, 3.0), (8.0, 12.0)]);
                pen.line(&[(4.0, 8.0), (8.0, 12.0)]);
            }
            Self::Sticks => {
                pen.ring(4.2, 11.8, 2.0);
                pen.ring(11.8, 4.2, 2.0);
                pen.line(&[(5.7, 10.3), (10.3, 5.7)]);
            }
            Self::Lines => pen.line(&[(3.0, 13.0), (8.0, 9.0), (9.5, 5.0), (13.0, 3.0)]),
            Self::Take => {
                pen.outline(&[(2.5, 4.0), (13.5, 4.0), (13.5, 12.0), (2.5, 12.0)]);
                pen.solid(&[(6.5, 6.0), (10.5, 8.0), (6.5, 10.0)]);
            }
            Self::Grid => {
                for at in [3.5, 8.0, 12.5] {
                    pen.line(&[(at, 2.5), (at, 13.5)]);
                    pen.line(&[(2.5, at), (13.5, at)]);
                }
            }
            Self::Material => {
                pen.ring(8.0, 8.0, 5.2);
                pen.dot(6.2, 6.2, 1.7);
            }
            Self::Clay => pen.dot(8.0, 8.0, 5.2),
            Self::Unlit => pen.ring(8.0, 8.0, 5.2),
            Self::XRay => {
                pen.outline(&[(2.5, 2.5), (10.5, 2.5), (10.5, 10.5), (2.5, 10.5)]);
                pen.outline(&[(5.5, 5.5), (13.5, 5.5), (13.5, 13.5), (5.5, 13.5)]);
            }
            Self::Surface => {
                pen.outline(&[(8.0, 2.0), (13.5, 5.0), (13.5, 11.0), (8.0, 14.0), (2.5, 11.0), (2.5, 5.0)]);
                pen.line(&[(2.5, 5.0), (8.0, 8.0), (13.5, 5.0)]);
                pen.line(&[(8.0, 8.0), (8.0, 14.0)]);
            }
            Self::Frame => {
                pen.line(&[(2.5, 5.5), (2.5, 2.5), (5.5, 2.5)]);
                pen.line(&[(10.5, 2.5), (13.5, 2.5), (13.5, 5.5)]);
                pen.line(&[(13.5, 10.5), (13.5, 13.5), (10.5, 13.5)]);
                pen.line(&[(5.5, 13.5), (2.5, 13.5), (2.5, 10.5)]);
                pen.dot(8.0, 8.0, 1.8);
            }
            Self::Perspective => {
                pen.outline(&[(5.0, 4.0), (11.0, 4.0), (14.0, 12.5), (2.0, 12.5)]);
                pen.line(&[(8.0, 4.0), (8.0, 12.5)]);
                pen.line(&[(3.8, 7.5), (12.2, 7.5)]);
            }
            Self::Orthographic => {
                pen.outline(&[(3.0, 3.0), (13.0, 3.0), (13.0, 13.0), (3.0, 13.0)]);
                pen.line(&[(8.0, 3.0), (8.0, 13.0)]);
                pen.line(&[(3.0, 8.0), (13.0, 8.0)]);
            }
            Self::View => {
                pen.line(&[(8.0, 8.5), (8.0, 2.5)]);
                pen.line(&[(8.0, 8.5), (2.8, 12.0)]);
                pen.line(&[(8.0, 8.5), (13.2, 12.0)]);
                pen.dot(8.0, 2.8, 1.5);
                pen.dot(3.0, 12.0, 1.5);
                pen.dot(13.0, 12.0, 1.5);
            }
            Self::Select => {
                pen.outline(&[(4.0, 2.5), (12.5, 8.5), (8.6, 9.2), (6.6, 13.0)]);
            }
            Self::Move => {
                pen.line(&[(8.0, 2.5), (8.0, 13.5)]);
                pen.line(&[(2.5, 8.0), (13.5, 8.0)]);
                pen.line(&[(6.2, 4.3), (8.0, 2.5), (9.8, 4.3)]);
                pen.line(&[(6.2, 11.7), (8.0, 13.5), (9.8, 11.7)]);
                pen.line(&[(4.3, 6.2), (2.5, 8.0), (4.3, 9.8)]);
                pen.line(&[(11.7, 6.2), (13.5, 8.0), (11.7, 9.8)]);
            }
            Self::Rotate => {
                pen.line(&[
                    (12.2, 5.2),
                    (10.4, 3.6),
                    (8.0, 3.0),
                    (5.4, 3.7),
                    (3.6, 5.6),
                    (3.0, 8.0),
                    (3.6, 10.4),
                ]);
                pen.line(&[(3.6, 10.4), (5.4, 12.3), (8.0, 13.0), (10.5, 12.4), (12.3, 10.6), (13.0, 8.4)]);
                pen.line(&[(12.6, 2.4), (12.4, 5.4), (9.4, 5.4)]);
            }
            Self::Scale => {
                pen.outline(&[(2.5, 8.5), (7.5, 8.5), (7.5, 13.5), (2.5, 13.5)]);
                pen.line(&[(9.0, 7.0), (13.5, 2.5)]);
                pen.line(&[(10.0, 2.5), (13.5, 2.5), (13.5, 6.0)]);
            }
            Self::AxesLocal => {
                pen.line(&[(5.0, 11.5), (2.8, 3.6)]);
                pen.line(&[(5.0, 11.5), (13.0, 9.4)]);
                pen.line(&[(8.8, 3.0), (12.4, 6.0)]);
                pen.dot(5.0, 11.5, 1.8);
            }
            Self::AxesParent => {
                pen.ring(4.4, 4.4, 2.0);
                pen.line(&[(6.0, 6.0), (8.2, 8.2)]);
                pen.line(&[(8.2, 8.2), (8.2, 13.5)]);
                pen.line(&[(8.2, 8.2), (13.5, 8.2)]);
                pen.dot(8.2, 8.2, 1.6);
            }
            Self::AxesWorld => {
                pen.ring(8.0, 8.0, 5.5);
                pen.line(&[(2.5, 8.0), (13.5, 8.0)]);
                pen.line(&[(8.0, 2.5), (6.0, 5.2), (5.6, 8.0), (6.0, 10.8), (8.0, 13.5)]);
                pen.line(&[(8.0, 2.5), (10.0, 5.2), (10.4, 8.0), (10.0, 10.8), (8.0, 13.5)]);
            }
            Self::AxesView => {
                pen.outline(&[(2.5, 3.5), (13.5, 3.5), (13.5, 12.5), (2.5, 12.5)]);
                pen.line(&[(5.5, 5.8), (5.5, 10.2), (10.5, 10.2)]);
            }
            Self::PivotIndividual => {
                pen.ring(4.6, 10.8, 2.6);
                pen.ring(11.0, 5.2, 2.6);
                pen.dot(4.6, 10.8, 0.9);
                pen.dot(11.0, 5.2, 0.9);
            }
            Self::PivotMedian => {
                pen.ring(4.0, 11.6, 2.0);
                pen.ring(12.0, 4.4, 2.0);
                pen.dot(8.0, 8.0, 1.7);
            }
            Self::PivotActive => {
                pen.ring(4.2, 11.4, 2.0);
                pen.dot(11.2, 5.0, 3.0);
            }
            Self::Hidden => {
                pen.line(&[(2.5, 7.0), (5.0, 9.5), (8.0, 10.3), (11.0, 9.5), (13.5, 7.0)]);
                pen.line(&[(5.0, 9.5), (4.0, 11.6)]);
                pen.line(&[(8.0, 10.3), (8.0, 12.6)]);
                pen.line(&[(11.0, 9.5), (12.0, 11.6)]);
            }
            Self::Shown => {
                let lid = [(2.2, 8.0), (4.6, 5.6), (8.0, 4.6), (11.4, 5.6), (13.8, 8.0)];
                pen.line(&lid);
                pen.line(&lid.map(|(x, y)| (x, 16.0 - y)));
                pen.dot(8.0, 8.0, 1.9);
            }
            Self::Ghosts => {
                pen.ring(4.6, 8.0, 2.4);
                pen.ring(8.0, 8.0, 2.4);
                pen.ring(11.4, 8.0, 2.4);
            }
            Self::Path => {
                pen.line(&[(3.0, 12.5), (5.0, 7.0), (8.0, 5.0), (11.0, 6.6), (13.0, 3.4)]);
                pen.dot(3.0, 12.5, 1.6);
                pen.dot(8.0, 5.0, 1.6);
                pen.dot(13.0, 3.4, 1.6);
            }
            Self::Open => {
                pen.outline(&[(2.0, 12.5), (2.0, 3.5), (6.0, 3.5), (7.5, 5.5), (14.0, 5.5), (14.0, 12.5)]);
            }
            Self::Warning => {
                pen.outline(&[(8.0, 2.5), (14.0, 13.0), (2.0, 13.0)]);
                pen.line(&[(8.0, 6.5), (8.0, 9.5)]);
                pen.dot(8.0, 11.3, 0.8);
            }
            Self::Error => {
                pen.ring(8.0, 8.0, 5.5);
                pen.line(&[(8.0, 5.0), (8.0, 8.8)]);
                pen.dot(8.0, 10.8, 0.8);
            }
            Self::Info => {
                pen.ring(8.0, 8.0, 5.5);
                pen.dot(8.0, 5.2, 0.8);
                pen.line(&[(8.0, 7.4), (8.0, 11.0)]);
            }
            Self::KeyHere => pen.diamond(8.0, 8.0, 5.0),
            Self::KeyElsewhere => pen.outline(&[(8.0, 3.5), (12.5, 8.0), (8.0, 12.5), (3.5, 8.0)]),
            Self::KeyNever => pen.dot(8.0, 8.0, 1.6),
            Self::Revert => {
                pen.line(&[(6.0, 2.5), (3.0, 5.5), (6.0, 8.5)]);
                pen.line(&[
                    (3.0, 5.5),
                    (9.5, 5.5),
                    (11.8, 6.3),
                    (13.0, 8.5),
                    (12.6, 11.0),
                    (10.6, 12.7),
                    (6.0, 13.0),
                ]);
            }
            Self::Redo => {
                pen.line(&[(10.0, 2.5), (13.0, 5.5), (10.0, 8.5)]);
                pen.line(&[
                    (13.0, 5.5),
                    (6.5, 5.5),
                    (4.2, 6.3),
                    (3.0, 8.5),
                    (3.4, 11.0),
                    (5.4, 12.7),
                    (10.0, 13.0),
                ]);
            }
            Self::Flip => {
                pen.line(&[(2.5, 5.0), (13.0, 5.0)]);
                pen.line(&[(5.5, 2.2), (2.5, 5.0), (5.5, 7.8)]);
                pen.line(&[(3.0, 11.0), (13.5, 11.0)]);
                pen.line(&[(10.5, 8.2), (13.5, 11.0), (10.5, 13.8)]);
            }
            Self::Saved => pen.line(&[(3.5, 8.5), (6.5, 11.5), (12.5, 4.5)]),
            Self::RestPose => {
                pen.ring(8.0, 3.6, 1.7);
                pen.line(&[(2.5, 6.8), (13.5, 6.8)]);
                pen.line(&[(8.0, 5.3), (8.0, 9.8)]);
                pen.line(&[(6.0, 14.0), (6.0, 9.8), (10.0, 9.8), (10.0, 14.0)]);
            }
            Self::Sliders => {
                pen.line(&[(2.5, 5.0), (13.5, 5.0)]);
                pen.line(&[(2.5, 11.0), (13.5, 11.0)]);
                pen.dot(10.0, 5.0, 2.2);
                pen.dot(5.5, 11.0, 2.2);
            }
            Self::Add => {
                pen.line(&[(8.0, 3.0), (8.0, 13.0)]);
                pen.line(&[(3.0, 8.0), (13.0, 8.0)]);
            }
            Self::Duplicate => {
                pen.outline(&[(5.5, 5.5), (13.5, 5.5), (13.5, 13.5), (5.5, 13.5)]);
                pen.line(&[(10.5, 2.5), (2.5, 2.5), (2.5, 10.5)]);
            }
            Self::Split => {
                pen.line(&[(8.0, 2.0), (8.0, 14.0)]);
                pen.line(&[(5.5, 4.5), (2.0, 4.5), (2.0, 11.5), (5.5, 11.5)]);
                pen.line(&[(10.5, 4.5), (14.0, 4.5), (14.0, 11.5), (10.5, 11.5)]);
            }
            Self::Trash => {
                pen.line(&[(2.5, 4.5), (13.5, 4.5)]);
                pen.line(&[(6.0, 4.5), (6.0, 2.5), (10.0, 2.5), (10.0, 4.5)]);
                pen.line(&[(4.0, 4.5), (4.8, 13.5), (11.2, 13.5), (12.0, 4.5)]);
            }
            Self::Rename => {
                pen.outline(&[(3.0, 13.0), (3.8, 10.0), (10.5, 3.2), (12.8, 5.5), (6.0, 12.2)]);
            }
            Self::Clock => {
                pen.ring(8.0, 8.0, 5.5);
                pen.line(&[(8.0, 4.8), (8.0, 8.0), (10.4, 9.6)]);
            }
            Self::Dot => pen.dot(8.0, 8.0, 2.6),
            Self::Down => pen.solid(&[(4.5, 6.0), (11.5, 6.0), (8.0, 10.5)]),
            Self::Right => pen.solid(&[(6.0, 4.5), (10.5, 8.0), (6.0, 11.5)]),
        }
    }
}

/// Draws on the icon's own grid.
struct Pen<'a> {
    painter: &'a Painter,
    origin: Pos2,
    color: Color32,
}

impl Pen<'_> {
    fn at(&self, x: f32, y: f32) -> Pos2 {
        self.origin + vec2(x, y)
    }

    fn points(&self, points: &[(f32, f32)]) -> Vec<Pos2> {
        points.iter().map(|&(x, y)| self.at(x, y)).collect()
    }

    fn stroke(&self) -> Stroke {
        Stroke::new(1.3, self.color)
    }

    fn line(&self, points: &[(f32, f32)]) {
        self.painter.add(Shape::line(self.points(points), self.stroke()));
    }

    fn outline(&self, points: &[(f32, f32)]) {
        self.painter.add(Shape::closed_line(self.points(points), self.stroke()));
    }

    fn solid(&self, points: &[(f32, f32)]) {
        self.painter.add(Shape::convex_polygon(self.points(points), self.color, Stroke::NONE));
    }

    fn bar(&self, x: f32, y: f32, width: f32, height: f32) {
        let rect = Rect::from_min_size(pos2(self.origin.x + x, self.origin.y + y), vec2(width, height));
        self.painter.rect_filled(rect, 0.5, self.color);
    }

    fn ring(&self, x: f32, y: f32, radius: f32) {
        self.painter.circle_stroke(self.at(x, y), radius, self.stroke());
    }

    fn dot(&self, x: f32, y: f32, radius: f32) {
        self.painter.circle_filled(self.at(x, y), radius, self.color);
    }

    fn diamond(&self, x: f32, y: f32, radius: f32) {
        self.solid(&[(x, y - radius), (x + radius, y), (x, y + radius), (x - radius, y)]);
    }
}
