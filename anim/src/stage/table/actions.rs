//! Containers and actions.

use super::row::{AttributeRow, ElementGroup, ElementRow, optional, required};
use super::value::{
    AMOUNT, DIRECTION, EASE, FILL, HEADING, MOMENT, MOMENT_NAME, NAME, NAMES, POINT_2D, POSITIVE,
    PROPERTY_VALUE, REPEAT, SHARE, SOURCE, SPEED, SPOT, TEXT, TIME, VECTOR, ValueRow,
};

const TIMING: &[AttributeRow] = &[
    optional("id", NAME, "", "Name by which others refer to its moments."),
    optional(
        "begin",
        MOMENT,
        "",
        "A time after its usual begin, or a moment of another action in place of it.",
    ),
    optional("end", MOMENT, "", "A time after its usual begin, or a moment of another action."),
    optional("dur", TIME, "", "Duration."),
];

const FADES: &[AttributeRow] = &[
    optional("fade-in", TIME, "0", "Time over which it replaces what was before; nothing is moved in time."),
    optional("fade-out", TIME, "0", "Time before its end over which it gives way again."),
];

const REPEATED: &[AttributeRow] =
    &[optional("repeat", REPEAT, "1", "Number of times, or `fill` for as long as there is time.")];

const FILLED: &[AttributeRow] =
    &[optional("fill", FILL, "", "Whether it holds its last state after its end, or releases it.")];

const EASED: &[AttributeRow] = &[optional("ease", EASE, "linear", "Course of the speed.")];

/// Everything that has a place and moves.
const MOVABLE: &[&str] = &["role", "prop", "camera", "light", "effect"];

const WHO: &[AttributeRow] = &[required("who", NAME, "The thing that acts.")];

const fn action(
    name: &'static str,
    attributes: &'static [&'static [AttributeRow]],
    help: &'static str,
) -> ElementRow {
    ElementRow { name, group: ElementGroup::Action, attributes, one_of: &[], who: &[], parts: &[], help }
}

pub(super) const SEQ: ElementRow =
    ElementRow { group: ElementGroup::Container, ..action("seq", &[TIMING], "Actions one after the other.") };

pub(super) const PAR: ElementRow =
    ElementRow { group: ElementGroup::Container, ..action("par", &[TIMING], "Actions that begin together.") };

pub(super) const WAIT: ElementRow = action("wait", &[TIMING], "Time in which nothing begins.");

pub(super) const PLAY: ElementRow = ElementRow {
    who: &["role", "prop"],
    parts: &[&AT],
    ..action(
        "play",
        &[
            TIMING,
            REPEATED,
            FADES,
            FILLED,
            WHO,
            &[
                required("take", TEXT, "Take of the role's model."),
                optional("from", TIME, "", "Start in the take; without it, the start of the take."),
                optional("to", TIME, "", "End in the take; without it, the end of the take."),
                optional(
                    "start",
                    TIME,
                    "",
                    "Time in the take at which the first repetition begins; without it, where the others begin.",
                ),
                optional("speed", SPEED, "1", "Factor of the speed."),
                optional(
                    "layer",
                    NAME,
                    "",
                    "Layer over the other takes; without it, and without bones, the whole pose.",
                ),
                optional("bones", NAMES, "", "Bones that it moves, with those below them; without it, all."),
                optional("weight", SHARE, "1", "Share of the pose."),
            ],
        ],
        "A role plays a take.",
    )
};

pub(super) const MOVE: ElementRow = ElementRow {
    who: MOVABLE,
    one_of: &["path", "to"],
    ..action(
        "move",
        &[
            TIMING,
            REPEATED,
            FADES,
            FILLED,
            EASED,
            WHO,
            &[
                optional("path", NAME, "", "Path to follow."),
                optional("to", SPOT, "", "Where to go in a straight line: a mark, a thing, or a point."),
                optional("gap", AMOUNT, "0", "Meters before the end at which to stop, for `to`."),
                optional("take", TEXT, "", "Take to play on the way, such as a walk."),
                optional(
                    "speed",
                    POSITIVE,
                    "",
                    "Meters per second; without it, the speed of the take's own stride.",
                ),
                optional(
                    "ground",
                    ValueRow::choice(&["off", "plane", "mesh"]),
                    "off",
                    "What height the way has: its own, that of the plane at 0, or that of the props that are ground.",
                ),
                optional(
                    "feet",
                    ValueRow::choice(&["keep", "free"]),
                    "keep",
                    "Whether feet in contact stay where they are.",
                ),
                optional("turn", HEADING, "along", "Direction on the way: along it, as before, or degrees."),
            ],
        ],
        "A thing moves along a path or to a place.",
    )
};

pub(super) const TURN: ElementRow = ElementRow {
    who: MOVABLE,
    ..action(
        "turn",
        &[
            TIMING,
            FILLED,
            EASED,
            WHO,
            &[required("to", DIRECTION, "What to face: a thing, a point, or degrees.")],
        ],
        "A thing turns on the spot.",
    )
};

pub(super) const PLACE: ElementRow = ElementRow {
    who: MOVABLE,
    ..action(
        "place",
        &[
            TIMING,
            WHO,
            &[
                optional(
                    "at",
                    SPOT,
                    "",
                    "New position: a mark, a thing, or a point; without it, the old one.",
                ),
                optional(
                    "facing",
                    DIRECTION,
                    "",
                    "New direction; without it, that of a mark, else the old one.",
                ),
            ],
        ],
        "A thing is elsewhere at once.",
    )
};

pub(super) const LOOK: ElementRow = ElementRow {
    who: &["role", "camera"],
    ..action(
        "look",
        &[
            TIMING,
            FADES,
            FILLED,
            WHO,
            &[
                required("at", SPOT, "What to look at: a thing, a bone, or a point."),
                optional(
                    "bones",
                    NAMES,
                    "",
                    "Bones that turn, from the chest to the head; without it, the head.",
                ),
                optional("weight", SHARE, "1", "Share of the turn."),
            ],
        ],
        "A role looks at something.",
    )
};

pub(super) const ATTACH: ElementRow = ElementRow {
    who: MOVABLE,
    ..action(
        "attach",
        &[
            TIMING,
            &[optional("fade-in", TIME, "0", "Time over which it moves there.")],
            WHO,
            &[
                required("to", SPOT, "What holds it: a thing, or a bone such as anna.RightHand."),
                optional("offset", VECTOR, "0 0 0", "Position relative to the bone, meters."),
                optional(
                    "turn",
                    VECTOR,
                    "0 0 0",
                    "Rotation relative to the bone, degrees about x, then y, then z.",
                ),
            ],
        ],
        "A thing is held by another one from now on.",
    )
};

pub(super) const DETACH: ElementRow = ElementRow {
    who: MOVABLE,
    ..action(
        "detach",
        &[
            TIMING,
            WHO,
            &[optional(
                "drop",
                ValueRow::choice(&["keep", "ground"]),
                "keep",
                "Whether it stays there or falls to the ground.",
            )],
        ],
        "A thing is no longer held.",
    )
};

pub(super) const SHOT: ElementRow = ElementRow {
    who: &["camera"],
    ..action(
        "shot",
        &[
            TIMING,
            WHO,
            &[optional("blend", TIME, "0", "Time over which the image moves from the camera before.")],
        ],
        "A camera is seen, until the next shot.",
    )
};

pub(super) const RUN: ElementRow =
    ElementRow { who: &["effect"], ..action("run", &[TIMING, FADES, WHO], "An effect is on.") };

const PROPERTY: &[AttributeRow] =
    &[required("property", NAME, "Property of the thing."), required("to", PROPERTY_VALUE, "New value.")];

pub(super) const SET: ElementRow = ElementRow {
    who: &["camera", "light", "effect"],
    ..action("set", &[TIMING, WHO, PROPERTY], "A property has another value from now on.")
};

pub(super) const CHANGE: ElementRow = ElementRow {
    who: &["camera", "light", "effect"],
    ..action("change", &[TIMING, FILLED, EASED, WHO, PROPERTY], "A property moves to another value.")
};

pub(super) const SOUND: ElementRow = action(
    "sound",
    &[
        TIMING,
        REPEATED,
        FADES,
        &[
            required("src", SOURCE, "File of the sound."),
            optional("gain", AMOUNT, "1", "Factor of the loudness."),
        ],
    ],
    "A sound; it delays nothing.",
);

pub(super) const TITLE: ElementRow = action(
    "title",
    &[
        TIMING,
        FADES,
        &[
            required("text", TEXT, "The text."),
            optional(
                "at",
                POINT_2D,
                "0.5 0.5",
                "Position in the image: 0 0 is the upper left corner, 1 1 the lower right one.",
            ),
        ],
    ],
    "A text over the image.",
);

pub(super) const INCLUDE: ElementRow = action(
    "include",
    &[TIMING, &[required("src", SOURCE, "File of the other script, relative to this one.")]],
    "Another script, as a `par` of its actions.",
);

pub(super) const AT: ElementRow = ElementRow {
    group: ElementGroup::Part,
    ..action(
        "at",
        &[&[
            required("name", MOMENT_NAME, "Name of the moment."),
            required("time", TIME, "Time in the take."),
        ]],
        "A moment of a take, to which other actions can refer.",
    )
};
