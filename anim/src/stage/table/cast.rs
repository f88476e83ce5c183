//! The script, and the things of its cast.

use super::row::{AttributeRow, ElementGroup, ElementRow, optional, required};
use super::value::{
    AMOUNT, COLOR, FOCUS, LENS, NAME, NUMBER, POINTS, POSITIVE, RATE, SEED, SIZE, SOURCE, SPOT, TEXT, TILT,
    VECTOR, VERSION, ValueRow, YES_NO,
};

const ID: &[AttributeRow] = &[required("id", NAME, "Name by which actions refer to it.")];

const PLACED: &[AttributeRow] = &[
    optional("at", VECTOR, "0 0 0", "Position in meters; y points up."),
    optional("facing", NUMBER, "0", "Degrees about the vertical: 0 looks along +z, 90 along +x."),
];

const MODEL: &[AttributeRow] = &[
    required("model", SOURCE, "File of the model."),
    optional("scale", POSITIVE, "1", "Factor from the lengths of the model to meters."),
];

const fn thing(
    name: &'static str,
    attributes: &'static [&'static [AttributeRow]],
    help: &'static str,
) -> ElementRow {
    ElementRow { name, group: ElementGroup::Thing, attributes, one_of: &[], who: &[], parts: &[], help }
}

pub(super) const SCRIPT: ElementRow = ElementRow {
    name: "script",
    group: ElementGroup::Script,
    attributes: &[&[
        required("version", VERSION, "Version of the vocabulary."),
        optional("fps", RATE, "24", "Frames per second."),
        optional("size", SIZE, "1280x720", "Width and height of the image in pixels."),
        optional("seed", SEED, "0", "Start of all random numbers of effects."),
    ]],
    one_of: &[],
    who: &[],
    parts: &[],
    help: "A scene: its cast, then actions that begin together unless they say otherwise.",
};

pub(super) const CAST: ElementRow = ElementRow {
    name: "cast",
    group: ElementGroup::Cast,
    attributes: &[],
    one_of: &[],
    who: &[],
    parts: &[],
    help: "The things of the scene.",
};

pub(super) const ROLE: ElementRow =
    thing("role", &[ID, MODEL, PLACED], "A figure with bones and takes that it can play.");

pub(super) const PROP: ElementRow = thing(
    "prop",
    &[
        ID,
        MODEL,
        PLACED,
        &[
            optional(
                "ground",
                YES_NO,
                "no",
                "Whether it is ground for `move` with `ground=\"mesh\"`; nothing may move it then.",
            ),
            optional(
                "tilt",
                TILT,
                "0 0",
                "Degrees about its own x (pitch) and z (roll), before `facing`; not while it is held.",
            ),
        ],
    ],
    "An object that stands somewhere or is carried.",
);

pub(super) const CAMERA: ElementRow = thing(
    "camera",
    &[
        ID,
        PLACED,
        &[
            optional("look", SPOT, "", "What the camera looks at; without it, the direction of `facing`."),
            optional("lens", LENS, "35mm", "Focal length for an image 36 mm wide."),
            optional("focus", FOCUS, "", "What is in focus; without it, everything."),
            optional("aperture", POSITIVE, "8", "F-number."),
        ],
    ],
    "A camera; shots choose which one is seen.",
);

pub(super) const LIGHT: ElementRow = thing(
    "light",
    &[
        ID,
        PLACED,
        &[
            required("kind", ValueRow::choice(&["sun", "point", "spot"]), "Kind of light."),
            optional("direction", VECTOR, "0 -1 0", "Direction in which a sun or spot shines."),
            optional("color", COLOR, "#ffffff", "Color, sRGB."),
            optional("strength", AMOUNT, "1", "Brightness."),
            optional("shadow", YES_NO, "yes", "Whether things cast shadows in it."),
        ],
    ],
    "A light.",
);

pub(super) const EFFECT: ElementRow = thing(
    "effect",
    &[
        ID,
        PLACED,
        &[
            required("kind", TEXT, "Kind of effect, such as particles."),
            optional("preset", TEXT, "", "Settings by name, such as rain."),
            optional("rate", AMOUNT, "100", "Particles per second."),
        ],
    ],
    "An effect; it is off unless a `run` turns it on.",
);

pub(super) const PATH: ElementRow = ElementRow {
    one_of: &["points", "line"],
    ..thing(
        "path",
        &[
            ID,
            &[
                optional("points", POINTS, "", "Points in meters, x y z each."),
                optional("line", SOURCE, "", "Line that was drawn with the line tool."),
                optional(
                    "curve",
                    ValueRow::choice(&["straight", "smooth"]),
                    "straight",
                    "Course between the points.",
                ),
            ],
        ],
        "A way for `move`.",
    )
};

pub(super) const MARK: ElementRow = thing("mark", &[ID, PLACED], "A place to go to, with a direction.");
