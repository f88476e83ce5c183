//! The names of all commands.

/// Names a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)] // The table below says what each does.
pub enum Id {
    Open,
    OpenPath,
    OpenBuiltIn,
    CancelLoading,
    Save,
    SaveAs,
    SaveCopy,
    Revert,
    WhatWillBeSaved,
    ToggleShowChanges,
    UnsavedWork,
    Quit,

    Undo,
    Redo,

    AutoKey,
    Key,
    KeyAllPending,
    DropPending,
    CopyPose,
    PastePose,
    PasteMirrored,
    ResetPose,
    RestTranslation,
    RestRotation,
    RestScale,
    ResetToRest,
    MirrorPairs,

    PlayPause,
    PlayBackwards,
    PreviousFrame,
    NextFrame,
    PreviousKey,
    NextKey,
    Start,
    End,
    BackOneSecond,
    ForwardOneSecond,
    CycleRepeat,
    PreviousTake,
    NextTake,
    RestPose,

    NewTake,
    DuplicateTake,
    RenameTake,
    DeleteTake,
    MoveTakeUp,
    MoveTakeDown,
    SplitTake,
    TrimTake,
    ReverseTake,

    ClearSelection,
    SelectParent,
    SelectChild,
    Find,
    FrameSelected,
    FrameAll,
    ViewFront,
    ViewBack,
    ViewRight,
    ViewLeft,
    ViewTop,
    ViewBottom,
    ToggleProjection,
    ToggleGrid,
    ToggleSkeleton,
    ToggleXRay,
    ToggleSurface,
    ShadeMaterial,
    ShadeClay,
    ShadeUnlit,
    BonesOctahedra,
    BonesSticks,
    BonesLines,
    ThemeSystem,
    ThemeDark,
    ThemeLight,
    ScaleUp,
    ScaleDown,
    ScaleReset,
    FullScreen,
    ResetLayout,
    RetryDevice,
    Palette,
    Shortcuts,
    About,
}

impl Id {
    /// Its name in settings; never changes.
    pub fn name(self) -> String {
        format!("{self:?}")
    }

    /// The command of this name.
    pub fn named(name: &str) -> Option<Self> {
        super::all().map(|command| command.id).find(|id| id.name() == name)
    }
}
