//! Embree: a small C program, compiled here, that intersects given rays with given spheres on command.

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use toyproof::scene::{Scene, Shape};

/// A ray: origin, direction, smallest t.
pub(crate) type Ray = [f32; 7];

/// The running program.
pub(crate) struct Embree {
    child: Child,
    to: ChildStdin,
    from: ChildStdout,
    rays: usize,
    /// Seconds of processor time that building took.
    pub(crate) build: f64,
}

/// Compiles the program.
///
/// # Errors
/// Why it cannot be compiled.
pub(crate) fn compile(to: &Path) -> Result<(), String> {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/tracers/embree.c");
    let output = Command::new("cc")
        .args(["-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math"])
        .args([source, "-o"])
        .arg(to)
        .args(["-lembree3", "-lm"])
        .output()
        .map_err(|error| format!("cc: {error}"))?;
    if output.status.success() {
        Ok(())
    } else {
        Err("it needs libembree-dev (Debian)".to_owned())
    }
}

impl Embree {
    pub(crate) fn new(program: &Path, scene: &Scene, rays: &[Ray]) -> Self {
        let mut child = Command::new(program)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("it was compiled");
        let (to, from) = (child.stdin.take(), child.stdout.take());
        let (mut to, from) = (to.expect("it is piped"), from.expect("it is piped"));
        let mut bytes = Vec::new();
        for count in [scene.objects.len(), rays.len()] {
            bytes.extend((count as u32).to_ne_bytes());
        }
        for object in &scene.objects {
            if let Shape::Sphere {
                center: [x, y, z],
                radius,
            } = object.shape
            {
                bytes.extend(
                    [x, y, z, radius]
                        .iter()
                        .flat_map(|&number| (number as f32).to_ne_bytes()),
                );
            }
        }
        bytes.extend(rays.iter().flatten().flat_map(|number| number.to_ne_bytes()));
        to.write_all(&bytes).expect("it reads");
        let mut embree = Self {
            child,
            to,
            from,
            rays: rays.len(),
            build: 0.0,
        };
        embree.build = embree.seconds();
        embree
    }

    fn command(&mut self, command: u8) {
        self.to
            .write_all(&[command])
            .and_then(|()| self.to.flush())
            .expect("it reads");
    }

    fn seconds(&mut self) -> f64 {
        let mut bytes = [0; 8];
        self.from.read_exact(&mut bytes).expect("it answers");
        f64::from_ne_bytes(bytes)
    }

    /// Seconds of processor time for all rays, one by one.
    pub(crate) fn one_by_one(&mut self) -> f64 {
        self.command(b'1');
        self.seconds()
    }

    /// Eight at a time.
    pub(crate) fn by_eights(&mut self) -> f64 {
        self.command(b'8');
        self.seconds()
    }

    /// Sixteen at a time, with a user geometry; the rays are those of an image 640 pixels wide.
    pub(crate) fn by_sixteens(&mut self) -> f64 {
        self.command(b'u');
        self.seconds()
    }

    /// The number of each ray's sphere, `u32::MAX` for none.
    pub(crate) fn numbers(&mut self) -> Vec<u32> {
        self.command(b'i');
        self.ids()
    }

    /// The same as found by [`by_sixteens`](Self::by_sixteens).
    pub(crate) fn numbers_by_sixteens(&mut self) -> Vec<u32> {
        self.by_sixteens();
        self.command(b'j');
        self.ids()
    }

    fn ids(&mut self) -> Vec<u32> {
        let mut bytes = vec![0; 4 * self.rays];
        self.from.read_exact(&mut bytes).expect("it answers");
        bytes
            .chunks_exact(4)
            .map(|four| u32::from_ne_bytes([four[0], four[1], four[2], four[3]]))
            .collect()
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // It keeps no state.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
