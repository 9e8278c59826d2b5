//! Films of `run` and `render`: GIF and APNG, which are decoded here, and MP4, `WebM` and Y4M, which ffmpeg
//! decodes.

use std::fs;
use std::path::Path;
use std::process::Command;

use toyproof::film::{Film, FilmError, FilmSettings, FilmWriter, Format, FrameRate, Plays};
use toyproof::image::{self, Image};

use crate::program::{Run, toyproof};
use crate::requirements::{require_ffmpeg, skip};

/// The eight 100 % color bars, each an eighth of the width, with a gray bar that moves up in the lower half,
/// in each frame by more than a pixel in the tests.
const BARS: &str = "void mainImage(out vec4 c, in vec2 p) {
    int bar = 7 - int(8.0 * p.x / iResolution.x);
    c = vec4(bvec3(bar & 2, bar & 4, bar & 1), 1.0);
    float at = fract(2.0 * iTime) * 0.5 * iResolution.y;
    if (p.y > at && p.y < at + 4.0 && p.y < 0.5 * iResolution.y) c.rgb = vec3(0.5);
}";
/// Each frame adds 1/8 to the buffer.
const SUM: &str = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0) + 0.125; }";
const SHOW: &str = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }";

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

/// Runs a command whose arguments contain no spaces, on the CPU.
fn run(folder: &Path, arguments: &str) -> Run {
    let arguments = format!("{arguments} --device cpu");
    toyproof(folder, &arguments.split_whitespace().collect::<Vec<_>>())
}

fn render_film(folder: &Path, arguments: &str) -> Run {
    let run = run(folder, arguments);
    assert_eq!(run.code, 0, "{arguments}: {}", run.stderr);
    run
}

/// Runs ffmpeg or ffprobe; returns standard output.
fn tool(folder: &Path, program: &str, arguments: &str) -> Vec<u8> {
    let mut command = Command::new(program);
    command.current_dir(folder).args(arguments.split_whitespace());
    let output = command.output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments}: {stderr}");
    output.stdout
}

/// What ffprobe states about the stream of a film, as `key=value` lines.
fn probe(folder: &Path, file: &str) -> String {
    let arguments = "-v error -count_frames -show_entries \
        stream=codec_name,width,height,pix_fmt,color_range,color_space,color_transfer,color_primaries,r_frame_rate,\
        nb_read_frames:format=duration -of default=noprint_wrappers=1";
    String::from_utf8(tool(folder, "ffprobe", &format!("{arguments} {file}"))).unwrap()
}

/// The frames of a film as ffmpeg decodes them, in RGB, top row first.
fn decode(folder: &Path, file: &str, size: usize) -> Vec<Vec<u8>> {
    let convert = "-vf scale=in_color_matrix=bt709:in_range=limited:flags=accurate_rnd+full_chroma_int";
    let convert = if file.ends_with("gif") || file.ends_with("png") {
        ""
    } else {
        convert
    };
    let bytes = tool(
        folder,
        "ffmpeg",
        &format!("-v error -i {file} {convert} -f rawvideo -pix_fmt rgb24 pipe:1"),
    );
    bytes.chunks(3 * size).map(<[u8]>::to_vec).collect()
}

#[test]
fn films_have_the_length_the_rate_and_the_colors_of_their_frames() {
    if !require_ffmpeg() {
        return;
    }
    let folder = folder(&[("bars.glsl", BARS)]);
    let folder = folder.path();
    for (file, codec, pixels) in [
        ("a.mp4", "h264", "yuv420p"),
        ("a.webm", "vp9", "yuv420p"),
        ("a.y4m", "rawvideo", "yuv420p"),
        ("a.gif", "gif", "bgra"),
        ("a.apng", "apng", "rgb24"),
    ] {
        let run = render_film(
            folder,
            &format!("run bars.glsl -o {file} --duration 0.8 --fps 25 --size 64x32"),
        );
        assert!(run.stderr.contains("20 frames, 0.80 s"), "{}", run.stderr);
        let probed = probe(folder, file);
        for expected in [
            format!("codec_name={codec}"),
            "width=64".to_owned(),
            "height=32".to_owned(),
            format!("pix_fmt={pixels}"),
            "nb_read_frames=20".to_owned(),
            "r_frame_rate=25/1".to_owned(),
        ] {
            assert!(
                probed.lines().any(|line| line == expected),
                "{file}: {expected}: {probed}"
            );
        }
        if let "a.mp4" | "a.webm" = file {
            for tag in ["range=tv", "space=bt709", "transfer=bt709", "primaries=bt709"] {
                assert!(
                    probed.contains(&format!("color_{tag}")),
                    "{file}: {tag}: {probed}"
                );
            }
            let duration = probed.lines().find_map(|line| line.strip_prefix("duration="));
            let duration: f64 = duration.unwrap().parse().unwrap();
            assert!((duration - 0.8).abs() < 0.001, "{file}: {duration}");
        }
        // The middle of each bar in the upper half, where nothing moves. Limited range rounds a component by
        // up to 255/219/2 levels of luma and 255/224 of chroma, with weights up to 1.86, and coding adds a
        // little; GIF and APNG are exact.
        let most = if pixels == "yuv420p" { 6 } else { 0 };
        for (number, frame) in decode(folder, file, 64 * 32).iter().enumerate() {
            for bar in 0..8 {
                let at = 3 * (8 * 64 + 8 * bar + 4);
                let code = 7 - bar;
                let expected = [code & 2, code & 4, code & 1].map(|bit| if bit == 0 { 0_u8 } else { 255 });
                for (component, expected) in expected.into_iter().enumerate() {
                    let found = frame[at + component];
                    assert!(
                        found.abs_diff(expected) <= most,
                        "{file}, frame {number}, bar {bar}: {found} for {expected}"
                    );
                }
            }
        }
        assert_eq!(fs::read_dir(folder).unwrap().count(), 2, "{file}: what is left");
        fs::remove_file(folder.join(file)).unwrap();
    }
}

#[test]
fn an_animated_png_has_the_frames_of_a_sequence() {
    if !require_ffmpeg() {
        return;
    }
    let folder = folder(&[("sum/buffer-a.glsl", SUM), ("sum/image.glsl", SHOW)]);
    let folder = folder.path();
    render_film(folder, "run sum -o f.png --frames 2..5 --size 4x4");
    render_film(folder, "run sum -o a.apng --frames 2..5 --size 4x4");
    let film = decode(folder, "a.apng", 16);
    assert_eq!(film.len(), 4);
    for (number, frame) in film.iter().enumerate() {
        let image = image::read_shown(&folder.join(format!("f-000{}.png", number + 2))).unwrap();
        let rows = image.rows().rev().flatten().flatten().copied();
        assert!(rows.eq(frame.iter().copied()), "{number}");
    }
    // A second of a project in .png is a film.
    let run = render_film(folder, "run sum -o b.png --duration 0.1 --size 4x4 --loop 3");
    assert!(run.stderr.contains("b.png  APNG"), "{}", run.stderr);
    assert_eq!(decode(folder, "b.png", 16).len(), 6);
}

#[test]
fn scenes_are_filmed_at_their_rate_and_time() {
    if !require_ffmpeg() {
        return;
    }
    let folder = folder(&[]);
    let folder = folder.path();
    let render = |arguments: &str| {
        let arguments = format!("render 11-animation --size 32x18 {arguments}");
        let run = toyproof(folder, &arguments.split_whitespace().collect::<Vec<_>>());
        assert_eq!(run.code, 0, "{}", run.stderr);
    };
    render("-o a.apng --duration 0.5 --fps 8 --time 1");
    render("-o one.png --time 1.25");
    let film = decode(folder, "a.apng", 32 * 18);
    assert_eq!(film.len(), 4);
    let image = image::read_shown(&folder.join("one.png")).unwrap();
    let rows = image.rows().rev().flatten().flatten().copied();
    assert!(rows.eq(film[2].iter().copied()));
}

#[test]
fn standard_output_takes_frames() {
    let folder = folder(&[(
        "s.glsl",
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(iFrame == 1, 0, 1, 0.2); }",
    )]);
    let arguments = "run s.glsl -o - --to rgba --frames 0..1 --size 2x1 --device cpu";
    let output = |arguments: &str| {
        let mut command = crate::program::command(folder.path());
        let output = command.args(arguments.split_whitespace()).output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{stderr}");
        output.stdout
    };
    let frames = [[[0, 0, 255, 255]; 2], [[255, 0, 255, 255]; 2]];
    assert_eq!(output(arguments), frames.as_flattened().as_flattened());
    let kept = output(&format!("{arguments} --transparent"));
    assert_eq!(kept[..4], [0, 0, 255, 51]);
    let y4m = output("run s.glsl -o - --to y4m --frames 0..1 --size 2x1 --device cpu --fps 24");
    let header = b"YUV4MPEG2 W2 H1 F24:1 Ip A1:1 C420mpeg2 XCOLORRANGE=LIMITED\nFRAME\n";
    assert!(y4m.starts_with(header));
    assert_eq!(y4m.len(), header.len() + 4 + 6 + 4);
}

#[test]
fn an_interrupted_film_goes_on() {
    let text = "void mainImage(out vec4 c, in vec2 p) {
        // The third frame has too many iterations for the time limit.
        float x = 0.0;
        for (int i = 0; i < (iFrame == 2 ? 2000000000 : 1); i++) x = sin(x + 0.1);
        c = vec4(float(iFrame) / 4.0, 0, x * 1e-9, 1);
    }";
    let folder = folder(&[("s.glsl", text)]);
    let folder = folder.path();
    let arguments = "run s.glsl -o a.gif --frames 0..3 --fps 10 --size 8x8 --timeout";
    let stopped = run(folder, &format!("{arguments} 0.5s"));
    assert_eq!(stopped.code, 1, "{}", stopped.stderr);
    assert!(!folder.join("a.gif").exists() && folder.join("a.gif.frames").exists());
    // The same flags find the two frames. What a frame may take is one of them.
    let again = run(folder, &format!("{arguments} 0.5s"));
    assert!(
        again.stderr.contains("resuming: 2 of 4 frames exist already"),
        "{}",
        again.stderr
    );
    fs::write(folder.join("s.glsl"), text.replace("iFrame == 2", "iFrame == 9")).unwrap();
    let other = render_film(folder, &format!("{arguments} 60s"));
    assert!(!other.stderr.contains("resuming"), "{}", other.stderr);
    assert!(folder.join("a.gif").exists() && !folder.join("a.gif.frames").exists());
}

#[test]
fn a_repeated_film_warns_of_a_visible_seam() {
    let ring = "void mainImage(out vec4 c, in vec2 p) {
        c = vec4(0.5 + 0.5 * cos(6.2831853 * (p.x / iResolution.x - 0.5 * iTime)));
    }";
    let folder = folder(&[("ring.glsl", ring)]);
    let film = |duration: &str, plays: &str| {
        let arguments = format!("run ring.glsl -o a.gif --fps 20 --size 32x8 --duration {duration} {plays}");
        render_film(folder.path(), &arguments).stderr
    };
    let warning = "the last frame does not lead into the first";
    assert!(!film("2", "--loop forever").contains(warning), "a whole period");
    assert!(
        film("1.5", "--loop forever").contains(warning),
        "three quarters of one"
    );
    assert!(film("1.5", "--loop 2").contains(warning));
    assert!(
        !film("1.5", "").contains(warning),
        "no one wants it to be repeated"
    );
    assert!(!film("1.5", "--loop 1").contains(warning));
}

#[test]
fn what_a_format_lacks_is_reported() {
    let folder = folder(&[("bars.glsl", BARS)]);
    let refused = |arguments: &str, reason: &str, help: &str| {
        let run = run(folder.path(), &format!("run bars.glsl --size 15x9 {arguments}"));
        assert_eq!(run.code, 2, "{arguments}: {}", run.stderr);
        assert!(run.stderr.contains(reason), "{arguments}: {}", run.stderr);
        assert!(run.stderr.contains(help), "{arguments}: {}", run.stderr);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{arguments}");
    };
    refused("-o a.gif", "GIF is a film", "--duration 4");
    refused(
        "-o a.gif --duration 1 --transparent",
        "GIF has no partial transparency",
        ".webm or .apng",
    );
    refused("-o - --duration 1 --to mp4", "standard output takes", "-o");
    refused("-o a.png --loop 2", "--loop is for films", "--duration");
    let run = render_film(
        folder.path(),
        "run bars.glsl -o a.gif --duration 1 --fps 60 --size 64x64",
    );
    assert!(run.stderr.contains("shows 40 of the frames"), "{}", run.stderr);
}

#[test]
fn a_missing_ffmpeg_is_reported_before_anything_is_rendered() {
    let folder = folder(&[("bars.glsl", BARS)]);
    let mut command = crate::program::command(folder.path());
    command.env("PATH", folder.path()).args([
        "run",
        "bars.glsl",
        "-o",
        "a.mp4",
        "--duration",
        "1000",
        "--device",
        "cpu",
    ]);
    let run = crate::program::run(&mut command);
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(
        run.stderr.contains("ffmpeg is not installed") && run.stderr.contains("help: install it"),
        "{}",
        run.stderr
    );
    assert!(!folder.path().join("a.mp4.frames").exists());
}

#[test]
fn an_mp4_of_odd_sides_repeats_its_edges() {
    if !require_ffmpeg() {
        return;
    }
    let folder = folder(&[("bars.glsl", BARS)]);
    let folder = folder.path();
    let run = render_film(folder, "run bars.glsl -o a.mp4 --frames 0..2 --size 33x17");
    assert!(
        run.stderr.contains("34×18") && run.stderr.contains("even sides"),
        "{}",
        run.stderr
    );
    assert!(probe(folder, "a.mp4").contains("width=34\nheight=18"));
    render_film(folder, "run bars.glsl -o a.webm --frames 0..2 --size 33x17");
    assert!(probe(folder, "a.webm").contains("width=33\nheight=17"));
}

#[test]
fn a_transparent_webm_has_the_alpha_of_its_frames() {
    if !require_ffmpeg() {
        return;
    }
    let encoders = tool(Path::new("."), "ffmpeg", "-v error -decoders");
    if !String::from_utf8_lossy(&encoders).contains("libvpx-vp9") {
        skip("no libvpx-vp9, which decodes alpha");
        return;
    }
    let half = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1, 0.5, 0, p.x / iResolution.x); }";
    let folder = folder(&[("half.glsl", half)]);
    let folder = folder.path();
    render_film(
        folder,
        "run half.glsl -o a.webm --frames 0..2 --size 64x32 --transparent",
    );
    let bytes = tool(
        folder,
        "ffmpeg",
        "-v error -c:v libvpx-vp9 -i a.webm -vf alphaextract -f rawvideo -pix_fmt gray pipe:1",
    );
    assert_eq!(bytes.len(), 3 * 64 * 32);
    for x in 0..64 {
        let expected = 255.0 * (x as f64 + 0.5) / 64.0;
        // Alpha is coded in full range, at a quality that errs by few levels on a ramp.
        assert!(
            (f64::from(bytes[64 * 16 + x]) - expected).abs() < 6.0,
            "{x}: {}",
            bytes[64 * 16 + x]
        );
    }
}

#[test]
fn samples_are_the_mean_of_a_larger_image() {
    let edge = "void mainImage(out vec4 c, in vec2 p) {
        c = vec4(step(0.4 * p.x + 1.3, p.y), iResolution.x / 64.0, length(p) < 9.0 ? 5.0 : 0.0, 1.0);
    }";
    let folder = folder(&[
        ("edge.glsl", edge),
        ("sum/buffer-a.glsl", SUM),
        ("sum/image.glsl", edge),
    ]);
    let folder = folder.path();
    let image = |arguments: &str| {
        let run = render_film(folder, &format!("run {arguments} -o a.exr"));
        (image::read(&folder.join("a.exr")).unwrap(), run.stderr)
    };
    let (samples, stderr) = image("edge.glsl --size 16x16 --samples 256");
    assert!(stderr.contains("256 samples per pixel"), "{stderr}");
    // With iResolution.x in place of a number, the larger image would be another.
    let larger = edge
        .replace("in vec2 p) {", "in vec2 q) { vec2 p = q / 16.0;")
        .replace("iResolution.x", "16.0");
    fs::write(folder.join("larger.glsl"), larger).unwrap();
    let (larger, _) = image("larger.glsl --size 256x256");
    for y in 0..16 {
        for x in 0..16 {
            let mut mean = [0.0; 3];
            for at in 0..256 {
                let color = larger.get(16 * x + at % 16, 16 * y + at / 16);
                (0..3).for_each(|component| mean[component] += f64::from(color[component]) / 256.0);
            }
            // Both are quadratures with 256 points of a pixel that an edge divides: one row of a grid is
            // 1/16.
            for (component, scale) in [1.0, 1.0, 5.0].into_iter().enumerate() {
                let found = f64::from(samples.get(x, y)[component]);
                assert!(
                    (found - mean[component]).abs() <= scale / 16.0,
                    "{x}, {y}: {found} {mean:?}"
                );
            }
        }
    }
    let (of_project, _) = image("sum --size 16x16 --samples 256 --frame 3");
    assert!(of_project == samples, "the image of a project");
    let refused = run(folder, "run edge.glsl -o a.png --samples 4 --float fast");
    assert_eq!(refused.code, 2);
    assert!(
        refused.stderr.contains("--samples needs the evaluator"),
        "{}",
        refused.stderr
    );
}

#[test]
fn alpha_is_kept_only_if_it_is_wanted() {
    let half = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1, 0, 0, 0.6); }";
    let folder = folder(&[("half.glsl", half), ("p/image.glsl", half)]);
    let folder = folder.path();
    for input in ["half.glsl", "p"] {
        for file in ["a.png", "a.exr"] {
            render_film(folder, &format!("run {input} -o {file} --size 4x4"));
            assert_eq!(image::read(&folder.join(file)).unwrap().get(1, 1)[3], 1.0);
            render_film(folder, &format!("run {input} -o {file} --size 4x4 --transparent"));
            let kept = image::read(&folder.join(file)).unwrap().get(1, 1);
            assert_eq!(kept, [1.0, 0.0, 0.0, 0.6], "{input}, {file}");
        }
    }
}

#[test]
fn an_image_in_bands_is_the_same_and_may_be_wider_than_drivers_render() {
    let folder = folder(&[
        ("bars.glsl", BARS),
        ("sum/buffer-a.glsl", SUM),
        ("sum/image.glsl", SHOW),
    ]);
    let folder = folder.path();
    render_film(folder, "run bars.glsl -o a.png --size 130x77");
    let run_tiled = render_film(folder, "run bars.glsl -o b.png --size 130x77 --tile");
    assert!(run_tiled.stderr.contains("in bands"), "{}", run_tiled.stderr);
    let read = |name: &str| image::read_shown(&folder.join(name)).unwrap();
    assert_eq!(read("a.png"), read("b.png"));
    render_film(folder, "run bars.glsl -o wide.png --size 20000x3");
    let bytes = fs::read(folder.join("wide.png")).unwrap();
    assert_eq!(bytes[16..24], [0, 0, 0x4e, 0x20, 0, 0, 0, 3]);
    for (arguments, reason) in [
        ("run sum -o c.png --size 20000x3", "buffers of 20000×3 pixels"),
        ("run bars.glsl -o c.exr --size 20000x3", "only PNG"),
        ("run bars.glsl -o c.gif --duration 1 --size 20000x3", "too large"),
        (
            "run bars.glsl -o c.png --size 300000x3",
            "262,144 pixels per side",
        ),
    ] {
        let run = run(folder, arguments);
        assert_eq!(run.code, 2, "{arguments}: {}", run.stderr);
        assert!(run.stderr.contains(reason), "{arguments}: {}", run.stderr);
    }
}

/// Ten gray frames, in a second.
fn gray_film(format: Format) -> FilmSettings {
    FilmSettings::new(format, [16, 8], FrameRate::nearest(10.0), 10)
}

fn write_gray(path: &Path, settings: &FilmSettings) -> Result<Film, FilmError> {
    let mut film = FilmWriter::open(path, settings.clone(), "a")?;
    for number in film.existing()..settings.frames {
        let level = number as f32 / 10.0;
        film.add(&Image::new(16, 8, vec![[level, level, level, 1.0]; 128]))?;
    }
    film.finish(&mut |_| true)
}

/// A WAV file of silence: 16 bits, mono, 8 kHz.
fn silence(seconds: u32) -> Vec<u8> {
    let bytes = 16_000 * seconds;
    let mut wav = Vec::new();
    wav.extend(b"RIFF");
    wav.extend((36 + bytes).to_le_bytes());
    wav.extend(b"WAVEfmt \x10\0\0\0\x01\0\x01\0");
    wav.extend(8_000_u32.to_le_bytes());
    wav.extend(16_000_u32.to_le_bytes());
    wav.extend(b"\x02\0\x10\0data");
    wav.extend(bytes.to_le_bytes());
    wav.resize(wav.len() + bytes as usize, 0);
    wav
}

#[test]
fn sound_is_cut_at_the_end_of_the_film() {
    if !require_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a sound.wav");
    std::fs::write(&sound, silence(5)).unwrap();
    for (format, codec) in [(Format::Mp4, "aac"), (Format::Webm, "opus")] {
        let path = folder.path().join("a_film");
        let mut settings = gray_film(format);
        settings.sound = Some(sound.clone());
        write_gray(&path, &settings).unwrap();
        let found = probe(folder.path(), "a_film");
        assert!(found.contains(&format!("codec_name={codec}\n")), "{found}");
        let duration = found.lines().find_map(|line| line.strip_prefix("duration="));
        let duration: f64 = duration.unwrap().parse().unwrap();
        // A block of AAC or Opus is at most 1024 samples at 8 kHz, or 60 ms.
        assert!((1.0..1.0 + 0.129).contains(&duration), "{format}: {duration}");
    }
}

#[test]
fn a_film_without_a_count_has_its_frames_several_times() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    if !require_ffmpeg() {
        return;
    }
    let mut settings = gray_film(Format::Mp4);
    settings.plays = Plays::Count(3);
    let film = write_gray(&path, &settings).unwrap();
    assert_eq!(film.shown, 30);
    assert!(probe(folder.path(), "a.mp4").contains("nb_read_frames=30\n"));
}

#[test]
fn ffmpeg_states_why_it_fails_and_the_frames_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    if !require_ffmpeg() {
        return;
    }
    let mut settings = gray_film(Format::Mp4);
    settings.sound = Some(folder.path().join("none.wav"));
    let error = write_gray(&path, &settings).unwrap_err();
    assert!(
        matches!(&error, FilmError::Ffmpeg(message) if message.contains("none.wav")),
        "{error}"
    );
    let left: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(left, ["a.mp4.frames"]);
    settings.sound = None;
    let film = FilmWriter::open(&path, settings, "a").unwrap();
    assert_eq!(film.existing(), 10);
}

/// A folder of films is an output folder like any other: no link in it leads out.
#[cfg(unix)]
#[test]
fn a_film_follows_no_link_out_of_its_folder() {
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(iTime); }";
    let folder = folder(&[("in/a/s.glsl", text), ("in/b/s.glsl", text), ("away/keep", "")]);
    let folder = folder.path();
    fs::create_dir(folder.join("out")).unwrap();
    std::os::unix::fs::symlink("../away", folder.join("out/a")).unwrap();
    let run = run(folder, "run in -o out --to gif --duration 0.1 --size 4x4");
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(run.stderr.contains("is a symbolic link"), "{}", run.stderr);
    assert_eq!(fs::read_dir(folder.join("away")).unwrap().count(), 1);
    assert!(folder.join("out/b/s.gif").is_file(), "{}", run.stderr);
}
