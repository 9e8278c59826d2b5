//! The textures of a project's inputs: from files of the project or of a folder of media, or computed in
//! place of the site's.

use std::collections::{HashMap, VecDeque};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use toyproof_diagnostic::{Code, Diagnostic, Span};
use toyproof_glsl::Filter;
use toyproof_image::{self as image, Frame, Image, Moving, Texture};
use toyproof_media::{
    Content, Film, MediaError, MediaFolder, MediumNames, Music, StandIn, read_cube, read_volume,
    sequence_files, silent_music, with_components,
};
use toyproof_player as player;

use crate::media::{Medium, WEBCAM_ID};
use crate::pass::{Input, PassKind, Source, SourceType};

/// The content of a file.
#[derive(Debug, Clone)]
pub(crate) enum Loaded {
    Picture(Image),
    Cube(Box<[Image; 6]>),
    Volume(Vec<Image>),
    Film(Arc<Film>),
    Music(Arc<Music>),
}

/// The files that inputs read, by the paths or names of their sources.
#[derive(Debug, Clone, Default)]
pub(crate) struct LoadedMedia(HashMap<String, Loaded>);

impl LoadedMedia {
    /// Reads the files of the project, whose places `file` finds, and the copies of the site's media in
    /// another folder. Others are computed, or black.
    ///
    /// # Errors
    /// Why files cannot be read, each at the first input that reads it.
    pub(crate) fn read<'a>(
        inputs: impl Iterator<Item = &'a Input>,
        file: impl Fn(&str) -> Result<Option<PathBuf>, String>,
        media: Option<&MediaFolder>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let mut loaded = HashMap::new();
        let mut errors = Vec::new();
        for input in inputs {
            let Some(key) = key(&input.source) else {
                continue;
            };
            if loaded.contains_key(&key) {
                continue;
            }
            let path = match input.source.file() {
                Some(name) => file(name),
                None => Ok(media.and_then(|media| copy(media, &input.source))),
            };
            let content = path.and_then(|path| path.map(|path| load(&path, &input.source)).transpose());
            match content {
                Ok(Some(content)) => {
                    loaded.insert(key, content);
                }
                Ok(None) => {}
                Err(reason) => {
                    let error = Diagnostic::new(Code::ProjectValue, reason);
                    errors.push(match input.span {
                        Some(span) => error.at(span),
                        None => error,
                    });
                }
            }
        }
        if errors.is_empty() {
            Ok(Self(loaded))
        } else {
            Err(errors)
        }
    }
}

/// The key of a source among the files; `None` if it has none.
fn key(source: &Source) -> Option<String> {
    match source {
        Source::Webcam => Some("webcam".to_owned()),
        Source::Medium { id, path, .. } => Some(format!("{id} {path}")),
        Source::Buffer(_) | Source::CubeA | Source::Keyboard | Source::Mic => None,
    }
}

/// The user's copy of a medium of the site.
fn copy(media: &MediaFolder, source: &Source) -> Option<PathBuf> {
    let known = source.medium();
    let names = match source {
        Source::Webcam => MediumNames {
            id: WEBCAM_ID,
            name: "webcam",
            file: "",
        },
        Source::Medium { id, path, .. } => MediumNames {
            id,
            name: known.map_or("", |medium| medium.name),
            file: known.map_or_else(
                || path.rsplit('/').next().unwrap_or_default(),
                |medium| medium.file,
            ),
        },
        _ => return None,
    };
    media.find(names).map(Path::to_owned)
}

fn load(path: &Path, source: &Source) -> Result<Loaded, String> {
    Ok(match source.source_type() {
        SourceType::Cubemap => Loaded::Cube(Box::new(read_cube(path).map_err(|error| error.to_string())?)),
        SourceType::Volume => Loaded::Volume(read_volume(path).map_err(|error| error.to_string())?),
        SourceType::Video | SourceType::Webcam => {
            Loaded::Film(Arc::new(film(path).map_err(|error| error.to_string())?))
        }
        SourceType::Music | SourceType::MusicStream | SourceType::Mic => {
            Loaded::Music(Arc::new(Music::open(path).map_err(|error| error.to_string())?))
        }
        _ => {
            let image = image::read(path).map_err(|error| error.to_string())?;
            Loaded::Picture(match source.medium() {
                Some(medium) => with_components(&image, medium.channels),
                None => image,
            })
        }
    })
}

/// The frames in a second of numbered images.
const SEQUENCE_RATE: f64 = 30.0;

/// A film in a file, or in numbered images, of which the file is one.
fn film(path: &Path) -> Result<Film, MediaError> {
    match sequence_files(path) {
        Ok(files) if files.len() > 1 => Film::sequence(files, SEQUENCE_RATE),
        _ => Film::open(path),
    }
}

/// An input whose medium of the site is not available, with the passes that would read it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissingMedium {
    /// The source that would be read.
    pub source: Source,
    /// What takes its place, in a few words; `None` if the channel is black.
    pub stand_in: Option<&'static str>,
    /// Where the first input that reads it stands.
    pub span: Option<Span>,
    /// The passes that read the texture, each with the number of the channel.
    pub readers: Vec<(PassKind, usize)>,
}

impl MissingMedium {
    /// The message about it.
    #[must_use]
    pub fn diagnostic(&self) -> Diagnostic {
        let code = match self.stand_in {
            Some(_) => Code::StandIn,
            None => Code::UnboundChannel,
        };
        let diagnostic = Diagnostic::new(code, self.to_string());
        match self.span {
            Some(span) => diagnostic.at(span),
            None => diagnostic,
        }
    }
}

impl fmt::Display for MissingMedium {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.source.medium() {
            Some(medium) => write!(f, "“{}” of ShaderToy", medium.name)?,
            None => write!(f, "a {} of ShaderToy", self.source.source_type().name())?,
        }
        match self.stand_in {
            Some(stand_in) => write!(f, " is replaced: {stand_in}"),
            None => f.write_str(" is not available, so that its channel is black"),
        }
    }
}

/// The textures of a graph, as they are found.
pub(crate) struct Textures<'a> {
    loaded: &'a LoadedMedia,
    /// The textures that do not change.
    pub(crate) media: Vec<Texture>,
    /// Those that change from frame to frame.
    pub(crate) moving: Vec<Arc<dyn Moving>>,
    /// The inputs whose media are not available, without repetitions.
    pub(crate) missing: Vec<MissingMedium>,
    /// The properties of the textures, and their places.
    known: Vec<(TextureKey, player::Source)>,
}

/// The properties by which textures differ.
#[derive(PartialEq)]
struct TextureKey {
    source: Source,
    has_mipmaps: bool,
    is_flipped: bool,
}

/// A texture, or the frames of one that changes.
enum Found {
    Still(Texture),
    Moving(Arc<dyn Moving>),
}

impl<'a> Textures<'a> {
    pub(crate) fn new(loaded: &'a LoadedMedia) -> Self {
        Self {
            loaded,
            media: Vec::new(),
            moving: Vec::new(),
            missing: Vec::new(),
            known: Vec::new(),
        }
    }

    /// The source of an input that reads neither a buffer nor the keyboard, in the graph; `None` for black.
    pub(crate) fn source(&mut self, input: &Input, reader: (PassKind, usize)) -> Option<player::Source> {
        let content = key(&input.source).and_then(|key| self.loaded.0.get(&key));
        let stand_in = stand_in(&input.source);
        if content.is_none() {
            let mut missing = self.missing.iter_mut();
            match missing.find(|missing| missing.source == input.source) {
                Some(missing) => missing.readers.push(reader),
                None => self.missing.push(MissingMedium {
                    source: input.source.clone(),
                    stand_in: description(&input.source, stand_in),
                    span: input.span,
                    readers: vec![reader],
                }),
            }
        }
        let key = TextureKey {
            source: input.source.clone(),
            has_mipmaps: input.sampler.filter == Filter::Mipmap,
            is_flipped: input.sampler.vflip,
        };
        if let Some((_, place)) = self.known.iter().find(|(known, _)| *known == key) {
            return Some(*place);
        }
        let found = match content {
            Some(content) => of_file(content, &key),
            None => computed(&input.source, stand_in, &key)?,
        };
        let place = match found {
            Found::Still(texture) => {
                self.media.push(texture);
                player::Source::Medium(self.media.len() - 1)
            }
            Found::Moving(moving) => {
                self.moving.push(moving);
                player::Source::Moving(self.moving.len() - 1)
            }
        };
        self.known.push((key, place));
        Some(place)
    }
}

/// The stand-in for a medium of the site.
fn stand_in(source: &Source) -> Option<&'static StandIn> {
    match source {
        Source::Webcam => StandIn::find(WEBCAM_ID),
        Source::Medium { id, path, .. } => {
            StandIn::find(Medium::find(id, path).map_or(id, |medium| medium.id))
        }
        _ => None,
    }
}

/// What takes the place of a medium.
fn description(source: &Source, stand_in: Option<&'static StandIn>) -> Option<&'static str> {
    match source.source_type() {
        SourceType::Music | SourceType::MusicStream | SourceType::Mic => {
            Some("the site's sound of a muted player")
        }
        _ => stand_in.map(|stand_in| stand_in.description),
    }
}

fn of_file(content: &Loaded, key: &TextureKey) -> Found {
    let texture = match content {
        Loaded::Picture(picture) => flat(picture.clone(), key.is_flipped),
        Loaded::Cube(faces) => cube(faces, key.is_flipped),
        Loaded::Volume(slices) => volume(slices),
        Loaded::Music(music) => return Found::Moving(Arc::new(MovingMusic(Arc::clone(music)))),
        Loaded::Film(film) => {
            return Found::Moving(Arc::new(MovingFilm {
                film: FilmSource::File(Arc::clone(film)),
                is_flipped: key.is_flipped,
                has_mipmaps: key.has_mipmaps,
                is_camera: key.source == Source::Webcam,
            }));
        }
    };
    Found::Still(with_mipmaps(texture, key.has_mipmaps))
}

/// The textures of stand-ins that were computed last: shaders of a folder often read the same ones.
static RECENT: Mutex<VecDeque<(&'static str, [bool; 2], Texture)>> = Mutex::new(VecDeque::new());

/// The most textures that are kept. One takes up to 22 MB.
const MAX_RECENT: usize = 8;

/// The texture of a stand-in, with its mipmaps if it shall have any, which `compute` makes.
fn recent(id: &'static str, key: &TextureKey, compute: &dyn Fn() -> Texture) -> Texture {
    let form = [key.is_flipped, key.has_mipmaps];
    let lock = || RECENT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((.., texture)) = lock().iter().find(|(known, of, _)| *known == id && *of == form) {
        return texture.clone();
    }
    let texture = with_mipmaps(compute(), key.has_mipmaps);
    let mut recent = lock();
    recent.truncate(MAX_RECENT - 1);
    recent.push_front((id, form, texture.clone()));
    texture
}

/// What takes the place of a medium; `None` if nothing does.
fn computed(source: &Source, stand_in: Option<&'static StandIn>, key: &TextureKey) -> Option<Found> {
    if let SourceType::Music | SourceType::MusicStream | SourceType::Mic = source.source_type() {
        return Some(Found::Moving(Arc::new(MutedSound)));
    }
    let StandIn { id, content, .. } = stand_in?;
    let still = |make: &dyn Fn() -> Texture| Found::Still(recent(id, key, make));
    Some(match *content {
        Content::Texture(compute) => still(&|| flat(compute(), key.is_flipped)),
        Content::Cube(compute) => still(&|| cube(&compute(), key.is_flipped)),
        Content::Volume(compute) => still(&|| volume(&compute())),
        Content::Film(compute) => Found::Moving(Arc::new(MovingFilm {
            film: FilmSource::Computed(compute),
            is_flipped: key.is_flipped,
            has_mipmaps: key.has_mipmaps,
            is_camera: key.source == Source::Webcam,
        })),
    })
}

/// The texture of an image, which stands upright if it is flipped on its way to the texture.
fn flat(image: Image, is_flipped: bool) -> Texture {
    Texture::from(if is_flipped { image } else { image.upside_down() })
}

/// The cube map of six upright images: the first row of each is that of t = 0, unless it is flipped; +Y and
/// −Y then change places.
fn cube(faces: &[Image; 6], is_flipped: bool) -> Texture {
    let order = if is_flipped {
        [0, 1, 3, 2, 4, 5]
    } else {
        [0, 1, 2, 3, 4, 5]
    };
    let rows = order.into_iter().flat_map(|face: usize| {
        let image = faces[face].clone();
        let image = if is_flipped { image } else { image.upside_down() };
        image.pixels().to_vec()
    });
    let side = faces[0].size()[0];
    Texture::cube(&Image::new(side, side * image::cube::FACES, rows.collect()))
}

fn volume(slices: &[Image]) -> Texture {
    let [width, height] = slices[0].size();
    let texels = slices.iter().flat_map(|slice| slice.pixels().iter().copied());
    let stack = Image::new(width, height * slices.len() as u32, texels.collect());
    Texture::volume(stack, height)
}

fn with_mipmaps(texture: Texture, has_mipmaps: bool) -> Texture {
    if has_mipmaps {
        texture.with_mipmaps()
    } else {
        texture
    }
}

/// A film as a texture.
#[derive(Debug)]
struct MovingFilm {
    film: FilmSource,
    is_flipped: bool,
    has_mipmaps: bool,
    /// Whether it takes the place of a camera, which has no position on the site.
    is_camera: bool,
}

#[derive(Debug)]
enum FilmSource {
    File(Arc<Film>),
    /// The image at a time in seconds.
    Computed(fn(f64) -> Image),
}

impl Moving for MovingFilm {
    fn texture(&self, frame: &Frame) -> Texture {
        let time = f64::from(frame.time);
        let image = match &self.film {
            // A frame that cannot be decoded is black: the film was decoded when it was opened.
            FilmSource::File(film) => film
                .image(film.frame_at(time))
                .unwrap_or_else(|_| Image::new(1, 1, vec![[0.0, 0.0, 0.0, 1.0]])),
            FilmSource::Computed(compute) => compute(time),
        };
        with_mipmaps(flat(image, self.is_flipped), self.has_mipmaps)
    }

    fn position(&self, frame: &Frame) -> f32 {
        match &self.film {
            _ if self.is_camera => 0.0,
            FilmSource::File(film) if film.duration() > 0.0 => {
                f64::from(frame.time).rem_euclid(film.duration()) as f32
            }
            _ => frame.time,
        }
    }
}

/// A piece of music, of which a shader reads the spectrum and the wave.
#[derive(Debug)]
struct MovingMusic(Arc<Music>);

impl Moving for MovingMusic {
    fn texture(&self, frame: &Frame) -> Texture {
        self.0.texture(frame.time.into()).into()
    }

    fn position(&self, frame: &Frame) -> f32 {
        frame.time
    }
}

/// The sound of the site's player when it is muted: it follows the time.
#[derive(Debug)]
struct MutedSound;

impl Moving for MutedSound {
    fn texture(&self, frame: &Frame) -> Texture {
        silent_music(frame.time.into()).into()
    }

    /// The site's player is then at 10 seconds.
    fn position(&self, frame: &Frame) -> f32 {
        10.0 + frame.time
    }
}
