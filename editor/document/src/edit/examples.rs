//! An example of every edit: for the help of the command line, and for the tests, which read each.

/// An edit as JSON, and what it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// One line.
    pub json: &'static str,
    /// One sentence.
    pub says: &'static str,
}

const fn example(json: &'static str, says: &'static str) -> Example {
    Example { json, says }
}

/// One for each edit, in the order of [`super::Edit`].
pub const EXAMPLES: &[Example] = &[
    example(
        r#"{"edit":"set","take":"Walk","time":0.5,"poses":[{"bone":"Head","rotation":[0,0.2588190,0,0.9659258]}]}"#,
        "Turns the head 30° about the y axis of its parent at half a second, exactly.",
    ),
    example(
        r#"{"edit":"set_many","take":"Walk","at":[{"time":0.25,"poses":[{"bone":"Head","translation":[0,1,0]}]},{"time":0.5,"poses":[{"bone":"Head","translation":[0,1.1,0]}]}]}"#,
        "Gives the head a place at a quarter and at half a second, in one step.",
    ),
    example(
        r#"{"edit":"offset","take":0,"time":0.5,"poses":[{"bone":3,"translation":[0,0.1,0]}]}"#,
        "Lifts the fourth bone 10 cm above where it is.",
    ),
    example(
        r#"{"edit":"reset","take":"Walk","time":0.5,"bones":["Head"],"properties":["rotation"],"to":"original"}"#,
        "Takes back what was changed of the head's rotation at that key.",
    ),
    example(
        r#"{"edit":"pend","take":"Walk","time":0.5,"poses":[{"bone":"Head","rotation":[0,0.2588190,0,0.9659258]}]}"#,
        "Shows the head turned by 30° at half a second, without a key yet.",
    ),
    example(
        r#"{"edit":"paste","take":"Walk","time":1,"poses":[{"bone":"Hand.L","rotation":[0,0.2588190,0,0.9659258]}],"mirrored":true}"#,
        "Gives the right hand the pose of the left one, mirrored.",
    ),
    example(r#"{"edit":"key_pending","take":"Walk","time":0.5}"#, "Keys what is pending at half a second."),
    example(
        r#"{"edit":"drop_pending","take":"Walk","bones":["Head"]}"#,
        "Gives up all pending poses of the head.",
    ),
    example(
        r#"{"edit":"add_keys","take":"Walk","time":0.25,"bones":["Head"],"value":"current"}"#,
        "Adds keys of the head that keep the motion; \"predecessor\" copies the keys before.",
    ),
    example(
        r#"{"edit":"delete_keys","take":"Walk","keys":[{"bones":["Head"],"from":0.2,"to":0.4}]}"#,
        "Deletes the head's keys between two times.",
    ),
    example(
        r#"{"edit":"move_keys","take":"Walk","keys":[{"at":[0.5]}],"by":0.1}"#,
        "Moves all keys at half a second.",
    ),
    example(
        r#"{"edit":"scale_keys","take":"Walk","keys":[{"from":0,"to":1}],"about":0,"factor":2}"#,
        "Slows the first second down to half.",
    ),
    example(
        r#"{"edit":"duplicate_keys","take":"Walk","keys":[{"bones":["Head"],"at":[0]}],"by":1}"#,
        "Copies the head's first keys one second on.",
    ),
    example(
        r#"{"edit":"paste_keys","take":"Walk","time":1,"channels":[{"bone":"Head","property":"rotation","interpolation":"linear","keys":[{"after":0,"value":[0,0,0,1]},{"after":0.25,"value":[0,0.2588190,0,0.9659258]}]}]}"#,
        "Puts two keys of the head in, one at a second and one a quarter later.",
    ),
    example(
        r#"{"edit":"ripple","take":"Walk","from":0.5,"by":0.25}"#,
        "Makes room of a quarter of a second.",
    ),
    example(r#"{"edit":"snap_keys","take":"Walk","keys":[{}],"rate":30}"#, "Moves all keys to whole frames."),
    example(
        r#"{"edit":"set_interpolation","take":"Walk","bones":["Head"],"interpolation":"cubic_spline"}"#,
        "Lets the head run smoothly through its keys.",
    ),
    example(
        r#"{"edit":"set_tangents","take":"Walk","time":0.5,"bone":"Head","property":"translation","in":[0,1,0],"out":[0,1,0]}"#,
        "Sets the slopes of a spline's key.",
    ),
    example(r#"{"edit":"create_take","name":"Walk slowly","copy":"Walk"}"#, "Copies a take."),
    example(r#"{"edit":"delete_take","take":"Walk slowly"}"#, "Deletes a take."),
    example(r#"{"edit":"rename_take","take":0,"name":"Stroll"}"#, "Renames the first take."),
    example(r#"{"edit":"move_take","take":"Stroll","to":2}"#, "Makes it the third."),
    example(r#"{"edit":"split_take","take":"Walk","time":1,"name":"Walk, end"}"#, "Cuts a take in two."),
    example(r#"{"edit":"trim_take","take":"Walk","from":0.2,"to":0.8}"#, "Leaves six tenths of a second."),
    example(r#"{"edit":"reverse_take","take":"Walk"}"#, "Plays it from its end."),
    example(r#"{"edit":"retime_take","take":"Walk","start":0,"length":2}"#, "Makes it two seconds long."),
];
