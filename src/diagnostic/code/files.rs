//! Codes of files other than shaders, and of their translation.

macro_rules! files {
    ($($before:tt)*) => { codes! { $($before)*
    /// Shaders and scenes are UTF-8 text of at most 1 MiB, and ShaderToy's JSON of at most 8 MiB. Save the
    /// file as UTF-8.
    UnreadableFile "E0500" "A file that is not text, or too large",

    /// The file is not valid TOML, has a key that scenes do not have, or a value of the wrong type.
    ///
    /// Wrong:
    ///
    /// ```toml
    /// [camera]
    /// eye = "here"
    /// ```
    ///
    /// Right:
    ///
    /// ```toml
    /// [camera]
    /// eye = [0.0, 0.0, 0.0]
    /// [background]
    /// color = [0.2, 0.4, 0.8]
    /// ```
    SceneSyntax "E0501" "A scene file with a syntax error or an unknown key",

    /// Numbers are finite, radii and sizes are positive, colors are not negative, and an image has at least
    /// one pixel. A scene has at least one surface, figure or background.
    ///
    /// Wrong:
    ///
    /// ```toml
    /// [film]
    /// size = [0, 0]
    /// ```
    ///
    /// Right:
    ///
    /// ```toml
    /// [film]
    /// size = [640, 360]
    /// [background]
    /// color = [0.2, 0.4, 0.8]
    /// ```
    SceneValue "E0502" "A scene with an invalid value",

    /// A rubric defines the points for the checks `compiles`, `algorithm` and `precision`, what late
    /// submissions lose, and who sees the marks. The file is not valid TOML, has a key that rubrics do not
    /// have, or a value of the wrong type.
    ///
    /// Wrong:
    ///
    /// ```toml rubric
    /// [algorithm]
    /// point = 8
    /// ```
    ///
    /// Right:
    ///
    /// ```toml rubric
    /// visibility = "after_due_date"
    /// [compiles]
    /// points = 1
    /// [algorithm]
    /// points = 8
    /// partial_from = 0.5
    /// [precision]
    /// points = 1
    /// ```
    RubricSyntax "E0503" "A rubric file with a syntax error or an unknown key",

    /// Points are from 0 to 1,000,000, and at least one check has points. `partial_from` is a share of the
    /// pixels, at least 0 and less than 1.
    ///
    /// Wrong:
    ///
    /// ```toml rubric
    /// [algorithm]
    /// points = 8
    /// partial_from = 50
    /// ```
    ///
    /// Right:
    ///
    /// ```toml rubric
    /// [algorithm]
    /// points = 8
    /// partial_from = 0.5
    /// ```
    RubricValue "E0504" "A rubric with an invalid value",

    /// The same code is that of [the file of a class](submissions.md#the-class).
    ///
    /// An assignment names a scene or a reference, the frames in which shaders are compared with it, and
    /// their points. The file is not valid TOML, has a key that assignments do not have, or a value of the
    /// wrong type. [Assignments](assignments.md) lists the keys.
    ///
    /// Wrong:
    ///
    /// ```toml assignment
    /// scene = "02-sphere.toml"
    /// [[frames]]
    /// size = [320, 180]
    /// ```
    ///
    /// Right:
    ///
    /// ```toml assignment
    /// scene = "02-sphere.toml"
    /// [[frame]]
    /// size = [320, 180]
    /// ```
    AssignmentSyntax "E0505" "An assignment file with a syntax error or an unknown key",

    /// An assignment has either a scene or a reference, and the files that it names exist; their paths are
    /// relative to its own folder. Frames have finite numbers, and none is listed twice.
    ///
    /// Wrong:
    ///
    /// ```toml assignment
    /// scene = "sphere.toml"
    /// ```
    ///
    /// Right:
    ///
    /// ```toml assignment
    /// scene = "02-sphere.toml"
    /// ```
    AssignmentValue "E0506" "An assignment with an invalid value",

    /// The file is not valid JSON (or, for `project.toml`, not valid TOML), has a key twice, or is nested
    /// more than 64 levels deep.
    ///
    /// Wrong:
    ///
    /// ```toml project
    /// [[pass]
    /// tab = "image"
    /// ```
    ///
    /// Right:
    ///
    /// ```toml project
    /// [[pass]]
    /// tab = "image"
    /// ```
    ProjectSyntax "E0507" "A project file with a syntax error",

    /// The file is valid JSON or TOML, but not a project: a key is missing or has the wrong type, there are
    /// two passes for one tab, or a name or an id is unknown. [Projects](projects.md) lists the keys.
    ///
    /// Wrong:
    ///
    /// ```toml project
    /// [[pass]]
    /// tab = "buffer-e"
    /// ```
    ///
    /// Right:
    ///
    /// ```toml project
    /// [[pass]]
    /// tab = "image"
    /// inputs = [{ channel = 0, source = "RGBA Noise Medium" }]
    /// ```
    ProjectValue "E0508" "A project with an invalid value",

    /// The file of `--mouse-script` is not valid TOML, or has an unknown key or a value of another type.
    ///
    /// Wrong:
    ///
    /// ```toml script
    /// [[mouse]]
    /// frame = 10
    /// click = [100, 50]
    /// press = [100, 50]
    /// ```
    ///
    /// Right:
    ///
    /// ```toml script
    /// [[mouse]]
    /// frame = 10
    /// press = [100, 50]
    /// ```
    ScriptSyntax "E0509" "An invalid script of the mouse and the keyboard",

    /// An event does nothing, names an unknown key, or has a position that is not two numbers. [Mouse and
    /// keyboard](projects.md#mouse-and-keyboard) lists the events.
    ///
    /// Wrong:
    ///
    /// ```toml script
    /// [[key]]
    /// frame = 3
    /// press = "spcae"
    /// ```
    ///
    /// Right:
    ///
    /// ```toml script
    /// [[key]]
    /// frame = 3
    /// press = "space"
    /// ```
    ScriptValue "E0510" "A script of the mouse and the keyboard with an invalid value",

    /// The file is not valid TOML, or has a key or a value that tests do not have; or a test in a line, as in
    /// `tests` and in the comments of a shader, has another form than `f(x) == y`. [Tests of
    /// functions](function-tests.md) lists the forms and the keys.
    ///
    /// Wrong:
    ///
    /// ```toml test
    /// [[function]]
    /// name = "disk"
    /// tests = ["disk(vec2(0.0)) == -1.0"]
    /// precison = "f32"
    /// ```
    ///
    /// Right:
    ///
    /// ```toml test
    /// [[function]]
    /// name = "disk"
    /// tests = ["disk(vec2(0.0)) == -1.0"]
    /// precision = "f32"
    /// ```
    TestSyntax "E0511" "A test of a function with a syntax error",

    /// A test compares values of the same type, or a vector with a number for all of its components, and its
    /// variables take values of their types. Tolerances are at least 0. A test file has at least one test, and
    /// the shader that it names exists.
    ///
    /// Wrong:
    ///
    /// ```toml test
    /// [[function]]
    /// name = "disk"
    /// ```
    ///
    /// Right:
    ///
    /// ```toml test
    /// [[function]]
    /// name = "disk"
    /// tests = ["disk(vec2(0.0)) == -1.0"]
    /// ```
    TestValue "E0512" "A test of a function with an invalid value",

    /// The shader is correct: toyproof checked it. naga rejected toyproof's translation of it. Please report
    /// this with the shader.
    NagaParse "E0900" "An internal error: naga cannot parse the translated shader",

    /// The shader is correct: toyproof checked it. naga's validator rejected toyproof's translation of it.
    /// Please report this with the shader.
    NagaValidation "E0901" "An internal error: naga cannot validate the translated shader",

    /// The host of the chosen `--style` does not provide this input, texture or function. compute.toys has no
    /// date and only two channels, and its compute shaders have no derivatives. wgpu-shadertoy has no channel
    /// times. Only the style `plain` has cube maps and volumes. Or toyproof's writer does not support the
    /// operation, such as the quotient of a matrix and a number, which only naga's writer, for the style
    /// `plain`, has. Remove the feature, or convert with `--style plain`.
    UnsupportedByTarget "E0902" "A feature that the target of the conversion does not provide",
    } };
}
