//! Categories of commands.

/// The category of a command in menus and sheets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // The titles say it.
pub enum Category {
    File,
    Edit,
    Pose,
    Playback,
    Keys,
    InBetween,
    Takes,
    Contacts,
    Layers,
    Scene,
    Selection,
    Tools,
    Camera,
    Look,
    Window,
    Help,
}

impl Category {
    /// All categories in the order in which they are shown.
    pub const ALL: &[Self] = &[
        Self::File,
        Self::Edit,
        Self::Pose,
        Self::Playback,
        Self::Keys,
        Self::InBetween,
        Self::Takes,
        Self::Contacts,
        Self::Layers,
        Self::Scene,
        Self::Selection,
        Self::Tools,
        Self::Camera,
        Self::Look,
        Self::Window,
        Self::Help,
    ];

    /// Returns the title of the category, for menus, the palette and the shortcut sheet.
    pub fn title(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Edit => "Edit",
            Self::Pose => "Pose",
            Self::Playback => "Playback",
            Self::Keys => "Keys",
            Self::InBetween => "In-between",
            Self::Takes => "Takes",
            Self::Contacts => "Contacts",
            Self::Layers => "Layers",
            Self::Scene => "Scene",
            Self::Selection => "Selection",
            Self::Tools => "Tools",
            Self::Camera => "Camera",
            Self::Look => "Look",
            Self::Window => "Window",
            Self::Help => "Help",
        }
    }
}
