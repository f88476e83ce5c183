//! Projects: the models, scripts, lines and movies that belong together.
//!
//! There is no element for clips of other files: a take that is imported into a model becomes a part of it, with its own edits, and is saved
//! and retargeted there. A second list of takes, which exist in the project only, would need names, a map of bones and a way to edit them
//! of its own, and other programs would not see them.

use super::cast::CAST;
use super::row::{AttributeRow, ElementGroup, ElementRow, optional, required};
use super::value::{
    AMOUNT, HASH, LENGTH, NAME, NUMBER, POSITIVE, RATE, SEED, SIZE, SOURCE, TEXT, TIME, VERSION, ValueRow,
    WHOLE, YES_NO,
};

const ID: &[AttributeRow] = &[required("id", NAME, "Name by which others refer to it.")];

const SRC: &[AttributeRow] = &[required("src", SOURCE, "File, below the folder of the project.")];

/// How a file of a model is read where it does not say so itself.
const READ_AS: &[AttributeRow] = &[
    optional("hash", HASH, "", "Hash of the file when it was used last: a change is told."),
    optional("scale", POSITIVE, "", "Meters in one unit of the file; without it, what the file says."),
    optional(
        "up",
        ValueRow::choice(&["x", "y", "z"]),
        "",
        "Axis that points up; without it, what the file says.",
    ),
    optional(
        "handedness",
        ValueRow::choice(&["auto", "left", "right"]),
        "auto",
        "Handedness of the axes; `auto` is what the file says.",
    ),
];

const fn part(
    name: &'static str,
    attributes: &'static [&'static [AttributeRow]],
    help: &'static str,
) -> ElementRow {
    ElementRow { name, group: ElementGroup::Part, attributes, one_of: &[], who: &[], parts: &[], help }
}

pub(super) const PROJECT: ElementRow = ElementRow {
    parts: &[&MODELS, &SCENE, &CAST, &LINES, &SCRIPT_FILE, &MOVIE],
    group: ElementGroup::Project,
    ..part(
        "project",
        &[&[
            required("version", VERSION, "Version of the vocabulary."),
            optional("name", TEXT, "", "Title of the project."),
            optional("fps", RATE, "24", "Frames per second of scripts that do not say so."),
            optional(
                "size",
                SIZE,
                "1280x720",
                "Width and height of the image of scripts that do not say so.",
            ),
            optional("seed", SEED, "0", "Start of the random numbers of scripts that do not say so."),
            optional("start", TIME, "", "Start of the part that is shown; without it, that of the script."),
            optional("end", TIME, "", "End of the part that is shown; without it, that of the script."),
        ]],
        "A project: models, what their scenes share, and the scripts.",
    )
};

pub(super) const MODELS: ElementRow = ElementRow {
    parts: &[&MODEL, &EDITS],
    ..part("models", &[], "The models, which scripts name by their ids.")
};

pub(super) const MODEL: ElementRow = part("model", &[ID, SRC, READ_AS], "A model.");

pub(super) const EDITS: ElementRow = part(
    "edits",
    &[&[required("of", NAME, "Model that they change.")], SRC],
    "Edits that are not saved into the model: a file with one edit a line.",
);

pub(super) const SCENE: ElementRow = part(
    "scene",
    &[&[
        optional("sky", SOURCE, "", "Picture of the surroundings."),
        optional("sky-turn", NUMBER, "0", "Degrees by which it is turned about the vertical."),
        optional("exposure", NUMBER, "0", "Brightness of the image in stops."),
        optional("tone", ValueRow::choice(&["agx", "neutral", "none"]), "agx", "Curve from light to image."),
        optional("ground", NUMBER, "0", "Height of the ground in meters."),
        optional("mirror", ValueRow::choice(&["on", "off"]), "off", "Whether the ground reflects."),
        optional("fog", AMOUNT, "0", "Share of light that is lost over one meter."),
    ]],
    "Surroundings of all scripts.",
);

pub(super) const LINES: ElementRow =
    part("lines", &[SRC], "File of the lines that were drawn: notes, and paths that roles follow.");

pub(super) const SCRIPT_FILE: ElementRow = part("script", &[ID, SRC], "A script of this project.");

pub(super) const MOVIE: ElementRow = part(
    "movie",
    &[
        ID,
        &[
            required("script", NAME, "Script that it shows."),
            required("out", SOURCE, "File that is written."),
            optional("samples", WHOLE, "64", "Images per frame that are averaged."),
            optional("shutter", NUMBER, "180", "Part of a frame for which the shutter is open, in degrees."),
            optional("quality", WHOLE, "20", "Quantizer of the video: lower is better and larger."),
        ],
    ],
    "A movie that can be rendered.",
);

const POINTS: &[AttributeRow] = &[
    required(
        "points",
        super::value::POINTS,
        "Control points of cubic Bézier curves in meters, x y z each: 3 n + 1 of them.",
    ),
    optional("id", NAME, "", "Name by which paths refer to it."),
];

pub(super) const LINE: ElementRow = part(
    "line",
    &[
        POINTS,
        &[
            optional(
                "on",
                ValueRow::choice(&["view", "ground", "surface", "bone"]),
                "ground",
                "What it was drawn on.",
            ),
            optional("of", TEXT, "", "Thing and bone that it moves with, such as anna.Head."),
            optional("closed", YES_NO, "no", "Whether its end is its start."),
            optional("color", super::value::COLOR, "#ff4040", "Color, sRGB."),
            optional("width", LENGTH, "3", "Width in pixels."),
            optional("from", TIME, "", "Time from which it is shown; without it, always."),
            optional("to", TIME, "", "Time to which it is shown; without it, to the end."),
            optional("in-movie", YES_NO, "no", "Whether movies show it."),
        ],
    ],
    "A line: a note, or a way that roles follow.",
);

pub(super) const LINE_FILE: ElementRow = ElementRow {
    parts: &[&LINE],
    group: ElementGroup::Project,
    ..part(
        "lines",
        &[&[required("version", VERSION, "Version of the vocabulary.")]],
        "Lines that were drawn.",
    )
};
