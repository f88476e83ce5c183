//! Everything the program can be told to do, once: menus, tooltips, keys, palette and shortcut sheet all read this table.

use egui::{Key, KeyboardShortcut, Modifiers};

/// Names a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // The table below says what each does.
pub enum Id {
    Open,
    OpenPath,
    OpenBuiltIn,
    CancelLoading,
    Quit,
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

/// Where a command stands in menus and sheets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // The titles say it.
pub enum Category {
    File,
    Playback,
    Selection,
    Camera,
    Look,
    Window,
    Help,
}

impl Category {
    /// In the order in which they are shown.
    pub const ALL: &[Self] =
        &[Self::File, Self::Playback, Self::Selection, Self::Camera, Self::Look, Self::Window, Self::Help];

    /// For sheets.
    pub fn title(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Playback => "Playback",
            Self::Selection => "Selection",
            Self::Camera => "Camera",
            Self::Look => "Look",
            Self::Window => "Window",
            Self::Help => "Help",
        }
    }
}

/// One thing the program can be told to do.
#[derive(Clone, Copy, Debug)]
pub struct Command {
    /// Its name in the code.
    pub id: Id,
    /// Its name on the screen.
    pub title: &'static str,
    /// Where it is shown.
    pub category: Category,
    /// The first is the one that tooltips name.
    pub shortcuts: &'static [KeyboardShortcut],
    /// One sentence.
    pub help: &'static str,
}

const NONE: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;
const SHIFT: Modifiers = Modifiers::SHIFT;
const ALT: Modifiers = Modifiers::ALT;

const fn key(modifiers: Modifiers, key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(modifiers, key)
}

const fn command(
    id: Id,
    category: Category,
    title: &'static str,
    shortcuts: &'static [KeyboardShortcut],
    help: &'static str,
) -> Command {
    Command { id, title, category, shortcuts, help }
}

/// Every command. Adding one: a line here, its name in [`Id`], its deed in [`super::execute`].
#[rustfmt::skip] // A table is read in columns.
pub const ALL: &[Command] = {
    use Category as C;
    &[
        command(Id::Open, C::File, "Open…", &[key(CTRL, Key::O)], "Opens a model (glTF 2.0: .glb, .gltf; Dragonfly: .dfm)"),
        command(Id::OpenPath, C::File, "Open by path…", &[key(CTRL.plus(SHIFT), Key::O)], "Opens a model whose path is typed or pasted"),
        command(Id::OpenBuiltIn, C::File, "Built-in dragonfly", &[], "Opens the model that is part of the program"),
        command(Id::CancelLoading, C::File, "Stop loading", &[], "Keeps what is open and forgets what is being loaded"),
        command(Id::Quit, C::File, "Quit", &[key(CTRL, Key::Q)], "Ends the program"),

        command(Id::PlayPause, C::Playback, "Play / pause", &[key(NONE, Key::Space), key(ALT, Key::V)], "Starts or stops time"),
        command(Id::PlayBackwards, C::Playback, "Play backwards", &[key(SHIFT, Key::Space)], "Lets time run backwards"),
        command(Id::PreviousFrame, C::Playback, "Previous frame", &[key(NONE, Key::ArrowLeft), key(NONE, Key::Comma)], "One frame back"),
        command(Id::NextFrame, C::Playback, "Next frame", &[key(NONE, Key::ArrowRight), key(NONE, Key::Period)], "One frame on"),
        command(Id::PreviousKey, C::Playback, "Previous key", &[key(NONE, Key::ArrowUp), key(ALT, Key::Comma)], "To the key before, of the selected bone or of all"),
        command(Id::NextKey, C::Playback, "Next key", &[key(NONE, Key::ArrowDown), key(ALT, Key::Period)], "To the next key, of the selected bone or of all"),
        command(Id::Start, C::Playback, "To the start", &[key(NONE, Key::Home), key(SHIFT, Key::ArrowLeft)], "To the first frame of the take"),
        command(Id::End, C::Playback, "To the end", &[key(NONE, Key::End), key(SHIFT, Key::ArrowRight)], "To the last frame of the take"),
        command(Id::BackOneSecond, C::Playback, "One second back", &[key(CTRL, Key::ArrowLeft)], "One second back"),
        command(Id::ForwardOneSecond, C::Playback, "One second on", &[key(CTRL, Key::ArrowRight)], "One second on"),
        command(Id::CycleRepeat, C::Playback, "Loop, back and forth, once", &[key(NONE, Key::L)], "What happens at the end of the take"),
        command(Id::PreviousTake, C::Playback, "Previous take", &[key(NONE, Key::PageUp)], "Shows the take before"),
        command(Id::NextTake, C::Playback, "Next take", &[key(NONE, Key::PageDown)], "Shows the take after"),
        command(Id::RestPose, C::Playback, "Rest pose", &[key(NONE, Key::Num0)], "Shows the model as it stands when nothing animates it"),

        command(Id::ClearSelection, C::Selection, "Select nothing", &[key(NONE, Key::Escape)], "Clears the selection"),
        command(Id::SelectParent, C::Selection, "Parent bone", &[key(NONE, Key::OpenBracket)], "Selects the parent of the selected bone"),
        command(Id::SelectChild, C::Selection, "Child bone", &[key(NONE, Key::CloseBracket)], "Selects the first child of the selected bone"),
        command(Id::Find, C::Selection, "Find a bone", &[key(CTRL, Key::F)], "Puts the cursor into the search field of the skeleton"),

        command(Id::FrameSelected, C::Camera, "Frame selected", &[key(NONE, Key::F)], "Moves the eye to what is selected"),
        command(Id::FrameAll, C::Camera, "Frame all", &[key(SHIFT, Key::F)], "Moves the eye so that everything is seen"),
        command(Id::ViewFront, C::Camera, "Front", &[key(NONE, Key::Num1)], "Looks from the front"),
        command(Id::ViewBack, C::Camera, "Back", &[key(CTRL, Key::Num1)], "Looks from behind"),
        command(Id::ViewRight, C::Camera, "Right", &[key(NONE, Key::Num3)], "Looks from the right"),
        command(Id::ViewLeft, C::Camera, "Left", &[key(CTRL, Key::Num3)], "Looks from the left"),
        command(Id::ViewTop, C::Camera, "Top", &[key(NONE, Key::Num7)], "Looks from above"),
        command(Id::ViewBottom, C::Camera, "Bottom", &[key(CTRL, Key::Num7)], "Looks from below"),
        command(Id::ToggleProjection, C::Camera, "Perspective / parallel", &[key(NONE, Key::Num5)], "Far things smaller, or parallel lines parallel"),

        command(Id::ToggleGrid, C::Look, "Ground grid", &[key(NONE, Key::G)], "Shows the ground"),
        command(Id::ToggleSkeleton, C::Look, "Skeleton", &[key(NONE, Key::B)], "Shows the bones"),
        command(Id::ToggleXRay, C::Look, "Bones in front", &[key(NONE, Key::X)], "Shows bones through the surface"),
        command(Id::ToggleSurface, C::Look, "Surface", &[key(NONE, Key::M)], "Shows the model's surface"),
        command(Id::ShadeMaterial, C::Look, "Materials", &[key(SHIFT, Key::Num1)], "Surfaces as the materials say"),
        command(Id::ShadeClay, C::Look, "Clay", &[key(SHIFT, Key::Num2)], "Grey clay, to judge the form"),
        command(Id::ShadeUnlit, C::Look, "Unlit", &[key(SHIFT, Key::Num3)], "Base colours without light"),
        command(Id::BonesOctahedra, C::Look, "Bones as octahedra", &[], "Slim octahedra from joint to joint"),
        command(Id::BonesSticks, C::Look, "Bones as sticks", &[], "Thin sticks with a ball at the joint"),
        command(Id::BonesLines, C::Look, "Bones as lines", &[], "Lines of one pixel"),

        command(Id::ThemeSystem, C::Window, "Theme of the system", &[], "Light or dark, as the desktop says"),
        command(Id::ThemeDark, C::Window, "Dark theme", &[], "For dim rooms"),
        command(Id::ThemeLight, C::Window, "Light theme", &[], "For bright rooms"),
        command(Id::ScaleUp, C::Window, "Larger", &[key(CTRL, Key::Plus), key(CTRL, Key::Equals), key(CTRL.plus(SHIFT), Key::Plus), key(CTRL.plus(SHIFT), Key::Equals)], "Everything in the window larger"),
        command(Id::ScaleDown, C::Window, "Smaller", &[key(CTRL, Key::Minus)], "Everything in the window smaller"),
        command(Id::ScaleReset, C::Window, "Usual size", &[key(CTRL, Key::Num0)], "Everything in the window as large as usual"),
        command(Id::FullScreen, C::Window, "Full screen", &[key(NONE, Key::F11)], "Uses the whole screen, or a window again"),
        command(Id::ResetLayout, C::Window, "Usual panels", &[], "Puts every panel where it was at first"),
        command(Id::RetryDevice, C::Window, "Try the viewport again", &[], "Draws again after the graphics device failed several times"),

        command(Id::Palette, C::Help, "Find a command", &[key(NONE, Key::F3), key(CTRL, Key::P)], "Searches everything the program can do"),
        command(Id::Shortcuts, C::Help, "Keys and mouse", &[key(NONE, Key::F1), key(SHIFT, Key::Slash), key(SHIFT, Key::Questionmark)], "Shows every shortcut"),
        command(Id::About, C::Help, "About Dragonfly", &[], "Version and licences"),
    ]
};

/// What the mouse does in the viewport, for the shortcut sheet.
pub const MOUSE: &[(&str, &str)] = &[
    ("Middle drag, Alt + left drag", "Orbit"),
    ("Shift + middle drag, Alt + middle drag", "Pan"),
    ("Wheel, Alt + right drag", "Zoom"),
    ("Click", "Select the bone under the pointer"),
    ("Drag the axes", "Orbit"),
    ("Alt + wheel over the timeline", "Frame by frame"),
];

/// The entry of `id`.
pub fn get(id: Id) -> &'static Command {
    // A test proves that every name has a line.
    ALL.iter().find(|command| command.id == id).unwrap_or(&ALL[0])
}

/// The first shortcut as text, `Ctrl+O`; empty when there is none.
pub fn shortcut_text(id: Id) -> String {
    get(id).shortcuts.first().map(text).unwrap_or_default()
}

/// What a tooltip says: title and shortcut, then the help.
pub fn tooltip(id: Id) -> String {
    let command = get(id);
    let shortcut = shortcut_text(id);
    let title = if shortcut.is_empty() {
        command.title.to_owned()
    } else {
        format!("{} ({shortcut})", command.title)
    };
    if command.help == command.title { title } else { format!("{title}\n{}", command.help) }
}

/// `Ctrl+Shift+O`, with arrows and brackets as signs on keys.
pub fn text(shortcut: &KeyboardShortcut) -> String {
    let mut out = String::new();
    let modifiers = shortcut.modifiers;
    for (held, name) in [(modifiers.command, "Ctrl+"), (modifiers.alt, "Alt+"), (modifiers.shift, "Shift+")] {
        if held {
            out.push_str(name);
        }
    }
    out.push_str(match shortcut.logical_key {
        Key::ArrowLeft => "Left",
        Key::ArrowRight => "Right",
        Key::ArrowUp => "Up",
        Key::ArrowDown => "Down",
        Key::Escape => "Esc",
        Key::PageUp => "Page up",
        Key::PageDown => "Page down",
        Key::OpenBracket => "[",
        Key::CloseBracket => "]",
        Key::Comma => ",",
        Key::Period => ".",
        Key::Plus => "+",
        Key::Minus => "-",
        Key::Equals => "=",
        Key::Slash => "/",
        Key::Questionmark => "?",
        other => other.name(),
    });
    out
}

/// Commands whose keys were pressed in this frame, in order; what text fields need is left to them.
///
/// Held keys repeat only where that is wanted: stepping through time.
pub fn pressed(context: &egui::Context) -> Vec<Id> {
    // Escape closes what is open first.
    let open = context.any_popup_open();
    let typing = context.text_edit_focused();
    let focused = context.memory(|memory| memory.focused().is_some());
    let mut found = Vec::new();
    context.input_mut(|input| {
        input.events.retain(|event| {
            let egui::Event::Key { key, pressed: true, repeat, modifiers, .. } = event else { return true };
            // Keys that move or type inside a field, or press the button that has the focus, are not ours.
            let plain = !modifiers.command && !modifiers.alt;
            let function = matches!(key, Key::F1 | Key::F3 | Key::F11);
            if (typing
                && !(function || modifiers.command && matches!(key, Key::O | Key::P | Key::Q | Key::F)))
                || (focused && plain && matches!(key, Key::Space | Key::Enter | Key::Tab | Key::Escape))
            {
                return true;
            }
            if open && *key == Key::Escape {
                return true;
            }
            let hit = ALL.iter().find(|command| {
                command.shortcuts.iter().any(|shortcut| {
                    shortcut.logical_key == *key && modifiers.matches_exact(shortcut.modifiers)
                })
            });
            match hit {
                Some(command) if !*repeat || repeats(command.id) => {
                    found.push(command.id);
                    false
                }
                Some(_) => false,
                None => true,
            }
        });
    });
    found
}

fn repeats(id: Id) -> bool {
    matches!(
        id,
        Id::PreviousFrame
            | Id::NextFrame
            | Id::PreviousKey
            | Id::NextKey
            | Id::BackOneSecond
            | Id::ForwardOneSecond
            | Id::SelectParent
            | Id::SelectChild
            | Id::ScaleUp
            | Id::ScaleDown
    )
}
