//! The planted additions: one for each row of the table in ARCHITECTURE.md.

/// A thing that a developer adds.
pub(crate) struct Plant {
    /// Its name in the table.
    pub(crate) thing: &'static str,
    /// Path and content of its file; `None` where a row is all that it needs.
    pub(crate) file: Option<(&'static str, &'static str)>,
    /// The file with the list.
    pub(crate) list: &'static str,
    /// First line of the list, and the line after which a new entry goes.
    pub(crate) place: [&'static str; 2],
    /// The entry.
    pub(crate) entry: &'static str,
    /// The text before the name of a type, or the function, that each file of this kind contains; empty where there is none.
    pub(crate) mark: &'static str,
    /// Everything else that the table names: a path, an anchor, and the text to insert after it. Without an anchor the text is
    /// added at the end of the file, or is a new file.
    pub(crate) also: &'static [(&'static str, &'static str, &'static str)],
}

const NOTHING: Plant =
    Plant { thing: "", file: None, list: "", place: ["", ""], entry: "", mark: "", also: &[] };

/// All plants, in the order of the table.
pub(crate) const PLANTS: &[Plant] = &[
    Plant {
        thing: "file format",
        file: Some(("anim/src/format/planted.rs", include_str!("files/format.txt"))),
        list: "anim/src/format/mod.rs",
        place: ["pub const BUILTIN: &[Format] = &[", "    dfm::DFM,"],
        entry: "    planted::PLANTED,",
        mark: ": Format = Format {",
        ..NOTHING
    },
    Plant {
        thing: "rule of `check`",
        file: Some(("anim/src/check/rule/planted.rs", include_str!("files/rule.txt"))),
        list: "anim/src/check/rule/mod.rs",
        place: ["pub static RULES: &[Rule] = &[", "pub static RULES: &[Rule] = &["],
        entry: "    Rule::model(\"PLANTED\", Note, \"The name of the model is planted.\", planted::check),",
        mark: "pub(crate) fn check(",
        also: &[(
            "tests/anim/check.rs",
            "const BREAKS: &[(&str, Break)] = &[",
            "\n    (\"PLANTED\", |model| model.name = \"planted\".to_owned()),",
        )],
    },
    Plant {
        thing: "edit",
        file: Some(("editor/document/src/edit/planted.rs", include_str!("files/edit.txt"))),
        list: "editor/document/src/edit/mod.rs",
        place: ["edits! {", "    \"retime_take\" => retime_take::RetimeTake,"],
        entry: "    \"planted\" => planted::PlantedEdit,",
        mark: "impl EditKind for ",
        also: &[("tests/data/journals/edits-1.jsonl", "", "{\"edit\":\"planted\",\"take\":0}\n")],
    },
    Plant {
        thing: "command with keys",
        list: "editor/src/panels/commands/table/help.rs",
        place: ["commands! {", "commands! {"],
        entry: "    PlantedCommand => When::Always, \"Planted\", [key(CTRL.plus(ALT), Key::F9)], \"Asks the planted question\", \
                |w| { w.prompts.ask(crate::panels::dialogs::PlantedQuestion { title: \"Plant?\" }.into()); None };",
        ..NOTHING
    },
    Plant {
        thing: "preset of keys",
        file: Some(("editor/src/panels/commands/preset/planted.rs", include_str!("files/preset.txt"))),
        list: "editor/src/panels/commands/preset/mod.rs",
        place: ["presets! {", "    Maya => \"Maya\", maya;"],
        entry: "    Planted => \"Planted\", planted;",
        mark: "const TABLE: PresetKeys = ",
        ..NOTHING
    },
    Plant {
        thing: "panel",
        file: Some(("editor/src/panels/planted.rs", include_str!("files/panel.txt"))),
        list: "editor/src/panels/mod.rs",
        place: ["pub fn all() -> Vec<Box<dyn Panel>> {", "        Box::<takes::Takes>::default(),"],
        entry: "        Box::<planted::PlantedPanel>::default(),",
        mark: "impl Panel for ",
        also: &[(
            "tests/editor/pictures/panels.rs",
            "    \"takes\", [250.0, 250.0], the_takes_panel_looks_as_stored;",
            "\n    \"planted\", [250.0, 250.0], the_planted_panel_looks_as_stored;",
        )],
    },
    Plant {
        thing: "question to the user",
        file: Some(("editor/src/panels/dialogs/planted.rs", include_str!("files/question.txt"))),
        list: "editor/src/panels/dialogs/mod.rs",
        place: ["questions! {", "    Unsaved => unsaved::UnsavedQuestion,"],
        entry: "    Planted => planted::PlantedQuestion,",
        mark: "impl QuestionKind for ",
        also: &[
            (
                "tests/editor/questions.rs",
                "        (\"where\", place(false)),",
                "\n        (\"planted\", dragonfly::panels::dialogs::PlantedQuestion { title: \"Plant?\" }.into()),",
            ),
            (
                "tests/editor/pictures/questions.rs",
                "const TABLE: &[QuestionRow] = &[",
                "\n    (\"planted\", \"typical\", || dragonfly::panels::dialogs::PlantedQuestion { title: \"Plant?\" }.into()),\n    (\"planted\", \"crowded\", || dragonfly::panels::dialogs::PlantedQuestion { title: \"Plant?\" }.into()),",
            ),
        ],
    },
    Plant {
        thing: "viewport tool",
        file: Some(("editor/src/control/viewport_tools/planted.rs", include_str!("files/tool.txt"))),
        list: "editor/src/control/viewport_tools/mod.rs",
        place: ["tools! {", "    gizmo: GizmoControl,"],
        entry: "    planted: planted::PlantedControl,",
        mark: "impl ViewportTool for ",
        ..NOTHING
    },
    Plant {
        thing: "render pass",
        file: Some(("editor/picture/src/pass/planted.rs", include_str!("files/pass.txt"))),
        list: "editor/picture/src/pass/mod.rs",
        place: ["pub fn all() -> Passes {", "        shared(grid::GridPass::default()),"],
        entry: "        shared(planted::PlantedPass::default()),",
        mark: "impl Pass for ",
        also: &[
            ("shaders/planted.wgsl", "", include_str!("files/shader.txt")),
            (
                "editor/picture/src/shaders.rs",
                "    GRID = \"grid\": FRAME COLOR DISPLAY;",
                "\n    /// The planted shader.\n    PLANTED = \"planted\": FRAME;",
            ),
            ("ARCHITECTURE.md", "`surface`, `grid`, ", "`planted`, "),
            (
                "editor/src/app/graphics_sync.rs",
                "        let sender = &mut self.appearances;",
                "\n        type Planted = dragonfly_picture::pass::planted::PlantedPassAppearance;\n        \
                 sender.update(graphics, |planted: &mut Planted| planted.0 = state.settings.auto_key);",
            ),
        ],
    },
    Plant {
        thing: "viewport overlay",
        file: Some(("editor/picture/src/control/planted.rs", include_str!("files/overlay.txt"))),
        list: "editor/picture/src/control/mod.rs",
        place: [
            "fn all() -> Vec<Box<dyn GraphicComponent>> {",
            "        Box::<path::PathGraphic>::default(),",
        ],
        entry: "        Box::<planted::PlantedGraphic>::default(),",
        mark: "impl GraphicComponent for ",
        also: &[(
            "editor/src/app/graphics_sync.rs",
            "        let sender = &mut self.appearances;",
            "\n        type Overlay = dragonfly_picture::control::planted::PlantedOverlayAppearance;\n        \
             sender.update(graphics, |planted: &mut Overlay| planted.0 = None);",
        )],
    },
    Plant {
        thing: "function in number fields",
        list: "editor/src/control/expression/name.rs",
        place: ["const FUNCTIONS: &[Function] = &[", "    function!(\"pow\", Plain, libm::pow, 2),"],
        entry: "    function!(\"hypot\", Plain, libm::hypot, 2),",
        ..NOTHING
    },
    Plant {
        thing: "subcommand",
        file: Some(("editor/src/command/planted.rs", include_str!("files/subcommand.txt"))),
        list: "editor/src/command/mod.rs",
        place: ["subcommands! {", "    Demo => demo::DemoArguments,"],
        entry: "    Planted => planted::PlantedArguments,",
        mark: "impl RunCommand for ",
        ..NOTHING
    },
];

/// A panel that is declared but is in no list.
pub(crate) const FORGOTTEN: (&str, &str) = ("editor/src/panels/forgotten.rs", "editor/src/panels/mod.rs");

/// Number of planted tests.
pub(crate) const COUNT: usize = 10;

/// Tests that show that the plants work: path, content, and the list of modules.
pub(crate) const TESTS: &[(&str, &str, &str)] = &[
    ("tests/editor/planted.rs", include_str!("files/test_editor.txt"), "tests/editor/main.rs"),
    ("tests/picture/planted.rs", include_str!("files/test_picture.txt"), "tests/picture/main.rs"),
];
