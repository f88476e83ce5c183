//! Names of edits of a script, in a few words, for the history and the undo command.

/// Declares [`ScriptLabel`] from a list of `Name = "text"` lines.
macro_rules! script_labels {
    ($($Name:ident = $text:literal,)*) => {
        /// The name of an edit of a script in the history. Journals have its words.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum ScriptLabel {
            $(#[doc = $text] $Name,)*
        }

        impl ScriptLabel {
            /// All labels.
            pub const ALL: &[Self] = &[$(Self::$Name),*];

            /// Returns its words.
            pub const fn text(self) -> &'static str {
                match self {
                    $(Self::$Name => $text,)*
                }
            }
        }
    };
}

script_labels! {
    EditScript = "Edit script",
    Type = "Type",
    PasteText = "Paste text",
    DeleteText = "Delete text",
    ReplaceText = "Replace text",
    MoveClip = "Move clip",
    MoveClips = "Move clips",
    MoveAction = "Move action",
    MoveActions = "Move actions",
    TrimStart = "Trim start",
    TrimEnd = "Trim end",
    ChangeFade = "Change fade",
    ChangeSpeed = "Change speed",
    ChangeRepeat = "Change repeat",
    ChangeValue = "Change value",
    ChangeFrameRate = "Change frame rate",
    AddClip = "Add clip",
    AddShot = "Add shot",
    AddRole = "Add role",
    AddProp = "Add prop",
    AddCamera = "Add camera",
    AddLight = "Add light",
    AddEffect = "Add effect",
    AddPath = "Add path",
    AddMark = "Add mark",
    AddSound = "Add sound",
    AddFiles = "Add files",
    AddAction = "Add action",
    AddTitle = "Add title",
    AddLook = "Add look",
    AddTurn = "Add turn",
    AddMove = "Add move",
    AddPlace = "Add place",
    AddSet = "Add set",
    AddChange = "Add change",
    AddRun = "Add run",
    AddWait = "Add wait",
    Split = "Split",
    Duplicate = "Duplicate",
    Paste = "Paste",
    Delete = "Delete",
    Rename = "Rename",
    MoveThing = "Move thing",
    MovePoint = "Move point",
    AddPoint = "Add point",
    RemovePoint = "Remove point",
    DropToGround = "Drop to the ground",
    TurnThing = "Turn thing",
    ScaleThing = "Scale thing",
    MoveCamera = "Move camera",
    Attach = "Attach",
    Detach = "Detach",
    Focus = "Focus",
    DrawPath = "Draw path",
    DrawLine = "Draw line",
    EraseLine = "Erase line",
    EditModel = "Edit model",
    FindFiles = "Find files",
    ApplyEdits = "Apply edits again",
    RemoveEdits = "Remove edits",
}

impl ScriptLabel {
    /// Returns the label with these words; `None` for those of another version of the program.
    pub fn of(text: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|label| label.text() == text)
    }

    /// Returns the label of a step that adds an action, by the name of its element. It has the words of the menus, or those of
    /// the script if menus have none.
    pub fn adding(element: &str) -> Self {
        match element {
            "play" => Self::AddClip,
            "shot" => Self::AddShot,
            "sound" => Self::AddSound,
            "title" => Self::AddTitle,
            "look" => Self::AddLook,
            "turn" => Self::AddTurn,
            "move" => Self::AddMove,
            "place" => Self::AddPlace,
            "attach" => Self::Attach,
            "detach" => Self::Detach,
            "set" => Self::AddSet,
            "change" => Self::AddChange,
            "run" => Self::AddRun,
            "wait" => Self::AddWait,
            _ => Self::AddAction,
        }
    }

    /// Returns whether the user writes into the text itself.
    pub fn is_writing(self) -> bool {
        matches!(self, Self::Type | Self::PasteText | Self::DeleteText | Self::ReplaceText)
    }
}
