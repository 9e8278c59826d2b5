//! The versions of the shader, the images that the tabs show, and the events for them.
//!
//! A save starts a build, and the images that the tabs show are rendered of it. The tabs hear of the version
//! once the burst of changes is over: until then another change replaces it. A check of the version follows,
//! which the next change stops. Tabs have moments of their own, so each requests its images.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, SyncSender, TryRecvError, TrySendError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant, SystemTime};

use serde_json::{Value, json};
use toyproof_image::{BLOCK_BYTES, Rgb8Image};

use crate::follow::{Burst, Follower};
use crate::view::View;

/// Reads, compiles and checks the shader that is followed.
pub trait Studio: Send + Sync + 'static {
    /// Reads the files as they are now, and compiles the shader.
    fn build(&self) -> Build;

    /// Checks the shader as it is now; ends early if the flag is set. Returns what the page shows of the
    /// result, `None` without one.
    fn check(&self, stop: &AtomicBool) -> Option<Value>;
}

/// A version of the shader.
pub struct Build {
    /// The shader, if it compiles.
    pub shader: Option<Box<dyn WatchedShader>>,
    /// What the page shows of it besides images.
    pub status: Value,
    /// The files that were read, and those that were looked for and do not exist.
    pub files: Vec<PathBuf>,
}

/// A shader that compiles.
pub trait WatchedShader: Send + Sync {
    /// Renders the pass of a view.
    ///
    /// # Errors
    /// If the shader does not end in time, or the flag was set.
    fn render(&self, view: &View, stop: &AtomicBool) -> Result<Rendered, Failure>;

    /// Renders the reference in a view; `None` if there is none for this view.
    ///
    /// # Errors
    /// If it cannot be rendered, or the flag was set.
    fn reference(&self, view: &View, stop: &AtomicBool) -> Result<Option<Rgb8Image>, Failure>;

    /// The values of expressions in a pixel of the pass of a view: from the left and from the bottom.
    ///
    /// # Errors
    /// If there is no such pixel, or the shader does not end in time.
    fn pixel(&self, view: &View, pixel: [u32; 2], stop: &AtomicBool) -> Result<Value, Failure>;

    /// The job with which the page renders the pass of a view in WebGL 2, without frames.
    ///
    /// # Errors
    /// If WebGL 2 cannot render the shader.
    fn browser_job(&self, view: &View) -> Result<Value, Failure>;
}

/// An image of a shader.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// The image.
    pub image: Rgb8Image,
    /// The uniform block of the frame.
    pub block: [u8; BLOCK_BYTES],
    /// The number of the first frame on which the image depends; that of the frame for an image without
    /// buffers.
    pub first_frame: i32,
}

/// Why there is no image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Failure {
    /// The flag was set.
    Stopped,
    /// For another reason, in a sentence.
    Failed(String),
}

/// The time between two looks at the files.
const POLL_INTERVAL: Duration = Duration::from_millis(8);
/// The largest number of images of a version that are kept: those of the tabs that show the same.
const MAX_IMAGES: usize = 4;
/// The largest number of tabs.
const MAX_TABS: usize = 16;
/// The events that a tab can be behind before it is dropped, and connects again.
const MAX_WAITING_EVENTS: usize = 64;

/// The number of no tab: that of work for all.
const NO_TAB: u64 = 0;

/// An event for the page: its name, and its data.
pub(crate) type Event = (&'static str, Arc<str>);

/// The image of a view, or why there is none.
type ImageResult = Result<Arc<Rendered>, Failure>;

/// A version that compiles, with its images.
pub(crate) struct Version {
    number: u64,
    shader: Box<dyn WatchedShader>,
    images: Mutex<Vec<(View, ImageResult)>>,
}

/// A tab of the page.
struct Tab {
    events: SyncSender<Event>,
    /// What it requested last.
    view: Option<View>,
}

/// The kinds of work for a tab.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Work {
    Frame,
    Reference,
    Pixel,
    BrowserJob,
}

#[derive(Default)]
struct State {
    /// The last version that compiles.
    version: Option<Arc<Version>>,
    /// The events that a new tab gets: on the last version, and on its check.
    status: Option<Arc<str>>,
    check: Option<Event>,
    /// Whether a newer version is in progress.
    is_pending: bool,
    tabs: BTreeMap<u64, Tab>,
    last_tab: u64,
    /// The work in progress, or waiting: the tab, its kind, and the flag that stops it.
    in_progress: Vec<(u64, Work, Arc<AtomicBool>)>,
}

/// What all connections share.
pub(crate) struct Session {
    studio: Arc<dyn Studio>,
    state: Mutex<State>,
    /// Images are rendered one after the other, each by all threads.
    rendering: Mutex<()>,
    /// References are rendered one after the other. The tracer cannot be stopped, and the shader does not wait
    /// for it.
    references: Mutex<()>,
    /// Pixels are traced one after the other, which cannot be stopped either.
    pixels: Mutex<()>,
    version_count: AtomicU64,
}

/// A version in progress.
struct Pending {
    built: Receiver<(Option<Arc<Version>>, Value, Vec<PathBuf>)>,
    ready: Option<(Option<Arc<Version>>, Value)>,
    started: SystemTime,
}

/// A check in progress.
struct Check {
    stop: Arc<AtomicBool>,
    thread: JoinHandle<()>,
}

/// A poisoned lock's data is as good as any: a panic in a rendering leaves it unchanged.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Waits for its turn; fails if the flag is set by then.
fn turn<'a>(mutex: &'a Mutex<()>, stop: &AtomicBool) -> Result<MutexGuard<'a, ()>, Failure> {
    let turn = lock(mutex);
    if stop.load(Ordering::Relaxed) {
        return Err(Failure::Stopped);
    }
    Ok(turn)
}

impl Session {
    pub(crate) fn new(studio: Arc<dyn Studio>) -> Self {
        Self {
            studio,
            state: Mutex::default(),
            rendering: Mutex::default(),
            references: Mutex::default(),
            pixels: Mutex::default(),
            version_count: AtomicU64::new(0),
        }
    }

    // The versions.

    /// Follows the files until the flag is set.
    pub(crate) fn follow(self: &Arc<Self>, stop: &AtomicBool) {
        let mut follower = Follower::default();
        let mut pending = Some(self.start_build());
        let mut burst: Option<Burst> = None;
        let mut check: Option<Check> = None;
        while !stop.load(Ordering::Relaxed) {
            thread::sleep(POLL_INTERVAL);
            let now = Instant::now();
            if follower.poll() {
                burst = Some(burst.map_or(Burst::new(now), |burst| burst.with(now)));
                if let Some(check) = check.take() {
                    check.stop.store(true, Ordering::Relaxed);
                }
                self.stop_work();
                pending = Some(self.start_build());
            }
            let Some(build) = &mut pending else {
                continue;
            };
            match build.built.try_recv() {
                Ok((version, status, files)) => {
                    follower.follow(files, build.started);
                    build.ready = Some((version, status));
                }
                // The thread panicked, which the program has reported.
                Err(TryRecvError::Disconnected) if build.ready.is_none() => {
                    build.ready = Some((
                        None,
                        json!({"failure": "toyproof failed while it compiled the shader"}),
                    ));
                }
                Err(_) => {}
            }
            if burst.is_none_or(|burst| burst.is_over(now))
                && let Some((version, status)) = pending.as_mut().and_then(|build| build.ready.take())
            {
                (pending, burst) = (None, None);
                check = self.publish(version, status);
            }
        }
        self.stop_work();
        if let Some(check) = check {
            // It removes what it has written.
            check.stop.store(true, Ordering::Relaxed);
            let _ = check.thread.join();
        }
    }

    /// Builds a version in a thread, which then renders what the tabs show.
    fn start_build(self: &Arc<Self>) -> Pending {
        let (sender, built) = mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        {
            let mut state = lock(&self.state);
            state.is_pending = true;
            state.in_progress.push((NO_TAB, Work::Frame, Arc::clone(&stop)));
        }
        let session = Arc::clone(self);
        let started = SystemTime::now();
        thread::spawn(move || {
            let Build {
                shader,
                status,
                files,
            } = session.studio.build();
            let version = shader.map(|shader| {
                Arc::new(Version {
                    number: session.version_count.fetch_add(1, Ordering::Relaxed) + 1,
                    shader,
                    images: Mutex::default(),
                })
            });
            // The receiver is gone if a newer version is in progress.
            if sender.send((version.clone(), status, files)).is_ok()
                && let Some(version) = version
            {
                session.render_for_tabs(&version, &stop);
            }
            session.finish(&stop);
        });
        Pending {
            built,
            ready: None,
            started,
        }
    }

    fn render_for_tabs(&self, version: &Version, stop: &AtomicBool) {
        let views = || {
            let state = lock(&self.state);
            let views = state.tabs.values().filter_map(|tab| tab.view.clone());
            views.collect::<Vec<_>>()
        };
        for view in views() {
            // A failure is that of the request that follows.
            let _ = self.image(version, &view, stop);
        }
    }

    /// Shows a version to the tabs, and starts its check.
    fn publish(self: &Arc<Self>, version: Option<Arc<Version>>, mut status: Value) -> Option<Check> {
        let compiles = version.is_some();
        let mut state = lock(&self.state);
        if let Some(version) = version {
            state.version = Some(version);
        }
        status["version"] = state.version.as_ref().map(|version| version.number).into();
        status["compiles"] = compiles.into();
        let status: Arc<str> = status.to_string().into();
        state.status = Some(Arc::clone(&status));
        state.check = None;
        state.is_pending = false;
        state.broadcast(&("version", status));
        drop(state);
        compiles.then(|| {
            let stop = Arc::new(AtomicBool::new(false));
            let (session, stopped) = (Arc::clone(self), Arc::clone(&stop));
            let thread = thread::spawn(move || {
                let result = session.studio.check(&stopped);
                let mut state = lock(&session.state);
                if let Some(result) = result.filter(|_| !stopped.load(Ordering::Relaxed)) {
                    let event: Event = ("check", result.to_string().into());
                    state.broadcast(&event);
                    state.check = Some(event);
                }
            });
            Check { stop, thread }
        })
    }

    // The tabs.

    /// Adds a tab; returns its number and its events. `None` if there are too many.
    pub(crate) fn add_tab(&self) -> Option<(u64, Receiver<Event>)> {
        let mut state = lock(&self.state);
        if state.tabs.len() >= MAX_TABS {
            return None;
        }
        state.last_tab += 1;
        let tab = state.last_tab;
        let (events, received) = mpsc::sync_channel(MAX_WAITING_EVENTS);
        let number: Event = ("tab", tab.to_string().into());
        let status = state.status.clone().map(|status| ("version", status));
        for event in [Some(number), status, state.check.clone()].into_iter().flatten() {
            // The channel is empty, and has room for them.
            let _ = events.try_send(event);
        }
        state.tabs.insert(tab, Tab { events, view: None });
        Some((tab, received))
    }

    /// Removes a tab that has been closed.
    pub(crate) fn remove_tab(&self, tab: u64) {
        lock(&self.state).tabs.remove(&tab);
    }

    // The images.

    /// Stops all work in progress.
    fn stop_work(&self) {
        for (_, _, stop) in &lock(&self.state).in_progress {
            stop.store(true, Ordering::Relaxed);
        }
    }

    /// Works on the last version for a tab. Earlier work of the same kind for it stops: the tab has moved on.
    fn for_tab<T>(
        &self,
        view: &View,
        kind: Work,
        work: impl FnOnce(&Version, &AtomicBool) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let stop = Arc::new(AtomicBool::new(false));
        let version = {
            let mut state = lock(&self.state);
            let own = |(tab, work, _): &&(u64, Work, _)| (*tab, *work) == (view.tab, kind);
            for (_, _, earlier) in state.in_progress.iter().filter(own) {
                earlier.store(true, Ordering::Relaxed);
            }
            let version = state.version.clone().filter(|_| !state.is_pending);
            let version = version.ok_or(Failure::Stopped)?;
            if let Some(tab) = state.tabs.get_mut(&view.tab) {
                tab.view = Some(view.clone());
            }
            state.in_progress.push((view.tab, kind, Arc::clone(&stop)));
            version
        };
        let done = work(&version, &stop);
        self.finish(&stop);
        done
    }

    /// Removes the work with this flag.
    fn finish(&self, stop: &Arc<AtomicBool>) {
        let mut state = lock(&self.state);
        state.in_progress.retain(|(_, _, flag)| !Arc::ptr_eq(flag, stop));
    }

    /// The image of a version in a view, rendered once, whether it succeeds or not.
    fn image(&self, version: &Version, view: &View, stop: &AtomicBool) -> ImageResult {
        let _turn = lock(&self.rendering);
        if let Some((_, image)) = lock(&version.images).iter().find(|(known, _)| known == view) {
            return image.clone();
        }
        if stop.load(Ordering::Relaxed) {
            return Err(Failure::Stopped);
        }
        let image = version.shader.render(view, stop).map(Arc::new);
        if image != Err(Failure::Stopped) {
            let mut images = lock(&version.images);
            images.truncate(MAX_IMAGES - 1);
            images.insert(0, (view.clone(), image.clone()));
        }
        image
    }

    /// The image of the last version in a view, with its number.
    pub(crate) fn frame(&self, view: &View) -> Result<(u64, Arc<Rendered>), Failure> {
        self.for_tab(view, Work::Frame, |version, stop| {
            Ok((version.number, self.image(version, view, stop)?))
        })
    }

    /// The reference in a view.
    pub(crate) fn reference(&self, view: &View) -> Result<Option<Rgb8Image>, Failure> {
        self.for_tab(view, Work::Reference, |version, stop| {
            let _turn = turn(&self.references, stop)?;
            version.shader.reference(view, stop)
        })
    }

    /// The values in a pixel.
    pub(crate) fn pixel(&self, view: &View, pixel: [u32; 2]) -> Result<Value, Failure> {
        self.for_tab(view, Work::Pixel, |version, stop| {
            let _turn = turn(&self.pixels, stop)?;
            version.shader.pixel(view, pixel, stop)
        })
    }

    /// The job for WebGL 2, with the number of the version.
    pub(crate) fn browser_job(&self, view: &View) -> Result<Value, Failure> {
        self.for_tab(view, Work::BrowserJob, |version, _| {
            let job = version.shader.browser_job(view)?;
            Ok(json!({"version": version.number, "job": job}))
        })
    }
}

impl State {
    /// Sends an event to all tabs. One that does not read its events is dropped, and connects again.
    fn broadcast(&mut self, event: &Event) {
        self.tabs
            .retain(|_, tab| match tab.events.try_send(event.clone()) {
                Ok(()) => true,
                Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) => false,
            });
    }
}
