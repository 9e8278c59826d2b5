//! The order of passes and the textures that they read, with a renderer that records both.

use std::convert::Infallible;

use toyproof_image::{Frame, Image, Texture};

use super::*;

/// Renders the names of the pass, the frame and the inputs of the pass.
#[derive(Default)]
struct Recorder {
    drawn: Vec<String>,
}

impl Renderer for Recorder {
    type Texture = String;
    type Error = Infallible;

    fn zeros(&mut self, storage: Storage, mipmaps: bool) -> Result<String, Infallible> {
        let zeros = match storage {
            Storage::Image([width, _]) => format!("zeros{width}"),
            Storage::Cube(side) => format!("cube{side}"),
        };
        Ok(zeros + if mipmaps { "m" } else { "" })
    }

    fn draw(
        &mut self,
        pass: usize,
        over: String,
        frame: &Frame,
        channels: [Channel<'_, String>; 4],
    ) -> Result<String, Infallible> {
        let reads = channels.iter().filter_map(|channel| match channel {
            Channel::Unbound => None,
            Channel::Texture(name) => Some((*name).clone()),
            Channel::Medium(number) => Some(format!("medium{number}")),
            Channel::Moving(number) => Some(format!("moving{number}")),
            Channel::Keyboard => Some("keyboard".to_owned()),
        });
        let reads: Vec<_> = reads.collect();
        self.drawn
            .push(format!("{pass}.{} over {over}: {}", frame.frame, reads.join(" ")));
        Ok(format!("{pass}.{}", frame.frame))
    }

    fn resized(&mut self, texture: String, size: [u32; 2]) -> Result<String, Infallible> {
        Ok(format!("{texture}@{}", size[0]))
    }
}

fn pass(target: Target, reads: &[Source]) -> Pass {
    let mut inputs = [None; 4];
    for (input, source) in inputs.iter_mut().zip(reads) {
        *input = Some(*source);
    }
    Pass { target, inputs }
}

fn frame(frame: i32, width: u32) -> Frame {
    Frame {
        size: [width, 1],
        frame,
        ..Frame::default()
    }
}

/// Plays frames of these widths; Buffer B has mipmaps.
fn play(passes: Vec<Pass>, widths: &[u32]) -> Player<Recorder> {
    let mut formats: [BufferFormat; BUFFERS] = Default::default();
    formats[1].mipmaps = true;
    play_formats(passes, formats, widths)
}

fn play_formats(passes: Vec<Pass>, formats: [BufferFormat; BUFFERS], widths: &[u32]) -> Player<Recorder> {
    let mut player = Player::new(Graph::new(passes, formats), Recorder::default());
    for (number, &width) in (0..).zip(widths) {
        let Ok(()) = player.render(&frame(number, width));
    }
    player
}

#[test]
fn earlier_passes_are_read_as_of_this_frame_and_later_ones_as_of_the_previous() {
    use Source::{Buffer, Medium};
    // Buffer B is first in the file, and reads Buffer A, which comes later.
    let passes = vec![
        pass(Target::Buffer(1), &[Buffer(0), Buffer(1)]),
        pass(Target::Buffer(0), &[Buffer(1), Medium(3)]),
        pass(Target::Image, &[Buffer(0), Buffer(1), Buffer(2)]),
    ];
    let player = play(passes, &[8, 8, 8]);
    assert_eq!(
        player.renderer().drawn,
        [
            "0.0 over zeros8m: zeros8 zeros8m",
            "1.0 over zeros8: 0.0 medium3",
            "2.0 over zeros8: 1.0 0.0 zeros8",
            "0.1 over zeros8m: 1.0 0.0",
            "1.1 over zeros8: 0.1 medium3",
            "2.1 over 2.0: 1.1 0.1 zeros8",
            // A discarded pixel of a buffer keeps its value of two frames ago.
            "0.2 over 0.0: 1.1 0.1",
            "1.2 over 1.0: 0.2 medium3",
            "2.2 over 2.1: 1.2 0.2 zeros8",
        ]
    );
    let read = |pass| {
        let textures = player
            .inputs(pass)
            .into_iter()
            .filter_map(|channel| match channel {
                Channel::Texture(name) => Some(name.as_str()),
                _ => None,
            });
        textures.collect::<Vec<_>>().join(" ")
    };
    assert_eq!([0, 1, 2].map(read), ["1.1 0.1", "0.2", "1.2 0.2 zeros8"]);
    assert_eq!(player.buffer(0).unwrap(), ["1.2", "1.1"]);
    assert_eq!(player.buffer(3), None);
}

#[test]
fn a_new_size_keeps_both_textures_of_a_buffer() {
    let passes = vec![
        pass(Target::Buffer(0), &[Source::Buffer(0)]),
        pass(Target::Image, &[Source::Buffer(0)]),
    ];
    let player = play(passes, &[4, 4, 6]);
    // After two frames the first texture is completed last; after an odd number, the second.
    assert_eq!(
        player.renderer().drawn[4..],
        ["0.2 over 0.0@6: 0.1@6", "1.2 over zeros6: 0.2"]
    );
}

#[test]
fn a_cleared_buffer_is_zero_until_its_pass() {
    let mut formats: [BufferFormat; BUFFERS] = Default::default();
    formats[1].is_cleared = true;
    let passes = vec![
        pass(Target::Buffer(0), &[Source::Buffer(0), Source::Buffer(1)]),
        pass(Target::Buffer(1), &[Source::Buffer(1)]),
        pass(Target::Image, &[Source::Buffer(0), Source::Buffer(1)]),
    ];
    let player = play_formats(passes, formats, &[4, 4]);
    assert_eq!(
        player.renderer().drawn[3..],
        [
            "0.1 over zeros4: 0.0 zeros4",
            "1.1 over zeros4: zeros4",
            "2.1 over 2.0: 0.1 1.1"
        ]
    );
    // What the pass read is known afterwards.
    assert!(matches!(player.inputs(1)[0], Channel::Texture(name) if name == "zeros4"));
}

#[test]
fn a_buffer_may_have_a_size_of_its_own() {
    let mut formats: [BufferFormat; BUFFERS] = Default::default();
    let half = [
        Step::Width,
        Step::Constant(2.0),
        Step::Binary(BinaryFunction::Divide),
    ];
    let sides = [half.to_vec(), vec![Step::Constant(1.0)]].map(|steps| SizeExpr::new(steps).unwrap());
    formats[5].size = BufferSize::Computed(Box::new(sides));
    let passes = vec![
        pass(Target::Buffer(5), &[Source::Buffer(5)]),
        pass(Target::Image, &[Source::Buffer(5)]),
    ];
    let player = play_formats(passes, formats, &[8, 11]);
    assert_eq!(
        player.renderer().drawn,
        [
            "0.0 over zeros4: zeros4",
            "1.0 over zeros8: 0.0",
            "0.1 over 0.0@5: zeros4@5",
            "1.1 over zeros11: 0.1"
        ]
    );
    let (graph, target) = (player.graph(), Target::Buffer(5));
    assert_eq!(graph.frame(target, &frame(0, 11)).size, [5, 1]);
    assert_eq!(graph.texels(target, [11, 7]), 5);
    let cube = graph.frame(Target::Buffer(CUBE_A), &frame(0, 11)).into_owned();
    assert_eq!((cube.size, cube.resolution), ([1024, 6144], Some([1024, 1024])));
    assert_eq!(
        (target.to_string(), graph.size(Target::Image, [11, 7])),
        ("Buffer F".to_owned(), [11, 7])
    );
}

#[test]
fn a_buffer_that_is_rendered_twice_reads_its_own_result() {
    let passes = vec![
        pass(Target::Buffer(0), &[Source::Buffer(0)]),
        pass(Target::Buffer(0), &[Source::Buffer(0)]),
        pass(Target::Image, &[Source::Buffer(0)]),
    ];
    let player = play(passes, &[4, 4]);
    assert_eq!(
        player.renderer().drawn[3..],
        ["0.1 over 0.0: 1.0", "1.1 over 1.0: 0.1", "2.1 over 2.0: 1.1"]
    );
}

#[test]
fn a_restored_state_goes_on_as_before() {
    let passes = || {
        vec![
            pass(Target::Buffer(0), &[Source::Buffer(0)]),
            pass(Target::Image, &[Source::Buffer(0)]),
        ]
    };
    let whole = play(passes(), &[4, 4, 4, 4]);
    let half = play(passes(), &[4, 4, 4]);
    let mut resumed = Player::new(half.graph().clone(), Recorder::default());
    // The names of the textures, by way of a texture of their characters.
    let written = |name: &String| -> Result<Texture, Infallible> {
        let characters = name.chars().map(|character| [f32::from(character as u8); 4]);
        Ok(Image::new(name.len() as u32, 1, characters.collect()).into())
    };
    let state = half.state(2, written).unwrap();
    let read = |_: &mut Recorder, texture: &Texture, _: bool| -> Result<String, Infallible> {
        let image = texture.to_single().swap_remove(0);
        Ok(image
            .pixels()
            .iter()
            .map(|pixel| char::from(pixel[0] as u8))
            .collect())
    };
    let Ok(()) = resumed.restore(&state, read);
    let Ok(()) = resumed.render(&frame(3, 4));
    assert_eq!(resumed.renderer().drawn, whole.renderer().drawn[6..]);
}

#[test]
#[should_panic(expected = "the image is rendered last")]
fn the_image_is_last() {
    let _ = Graph::new(
        vec![pass(Target::Image, &[]), pass(Target::Buffer(0), &[])],
        Default::default(),
    );
}
