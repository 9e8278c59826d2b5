//! The Vulkan devices of this machine.

use std::path::PathBuf;

use toyproof::gpu::{AdapterSelector, Driver, Failure, Worker, manifests, pinned};

/// Creates a worker process on an adapter.
pub type NewWorker = dyn Fn(AdapterSelector) -> Worker;

/// A device, and how it is reached.
pub struct Device<'a> {
    /// The device.
    pub driver: Driver,
    /// The manifest of its driver; `None` if the loader finds it elsewhere.
    manifest: Option<PathBuf>,
    new_worker: &'a NewWorker,
}

impl Device<'_> {
    /// A worker process on this device, which loads no other driver.
    pub fn worker(&self) -> Worker {
        let worker = (self.new_worker)(AdapterSelector::Named(self.driver.name.clone()));
        with_manifest(worker, self.manifest.as_ref())
    }

    /// The heading of its column: the driver's version, which has the name of most, or both.
    pub fn title(&self) -> String {
        let Driver { name, version, .. } = &self.driver;
        let first = name.split_whitespace().next().unwrap_or_default();
        if version.starts_with(first) {
            version.clone()
        } else {
            format!("{name}, {version}")
        }
    }
}

fn with_manifest(worker: Worker, manifest: Option<&PathBuf>) -> Worker {
    match manifest {
        Some(manifest) => worker.with_manifest(manifest.clone()),
        None => worker,
    }
}

/// The devices, and what is missing.
#[derive(Default)]
pub struct Discovery<'a> {
    /// The devices that can be measured.
    pub devices: Vec<Device<'a>>,
    /// The drivers that do not start, and devices that cannot be told apart.
    pub notes: Vec<String>,
}

/// Finds the devices of all drivers. Each driver is loaded alone, so that one that fails takes no other with
/// it, and two versions of a driver are two devices.
pub fn discover(new_worker: &NewWorker) -> Discovery<'_> {
    let found = pinned().unwrap_or_else(manifests);
    let manifests = match found.len() {
        0 => vec![None],
        _ => found.into_iter().map(Some).collect(),
    };
    let mut discovery = Discovery::default();
    for manifest in manifests {
        let worker = with_manifest(new_worker(AdapterSelector::Auto), manifest.as_ref());
        match worker.with_all_drivers().probe() {
            Ok(drivers) => discovery.add(drivers, manifest.as_ref(), new_worker),
            // Most machines have manifests of drivers without a device.
            Err(Failure::NoDriver(_)) => {}
            Err(failure) => {
                let name = manifest.map_or_else(|| "Vulkan".to_owned(), |path| path.display().to_string());
                discovery.notes.push(format!("not measured: {name}: {failure}"));
            }
        }
    }
    discovery
}

impl<'a> Discovery<'a> {
    fn add(&mut self, drivers: Vec<Driver>, manifest: Option<&PathBuf>, new_worker: &'a NewWorker) {
        let first = self.devices.len();
        for driver in drivers {
            // A worker selects by name.
            if self.devices[first..]
                .iter()
                .any(|device| device.driver.name == driver.name)
            {
                let name = &driver.name;
                self.notes
                    .push(format!("not measured: another device of the name {name}"));
                continue;
            }
            self.devices.push(Device {
                driver,
                manifest: manifest.cloned(),
                new_worker,
            });
        }
    }

    /// Keeps the devices that `--device` names, as for other commands: `auto`, `lavapipe`, or a substring of
    /// the name or of the driver's version.
    pub fn select(&mut self, device: &str) {
        let device = device.to_lowercase();
        match &device[..] {
            "auto" => {
                let lavapipe = self.devices.iter().position(|device| device.driver.is_lavapipe());
                let chosen = lavapipe.unwrap_or(0);
                self.devices = std::mem::take(&mut self.devices)
                    .into_iter()
                    .skip(chosen)
                    .take(1)
                    .collect();
            }
            "lavapipe" => self.devices.retain(|device| device.driver.is_lavapipe()),
            name => self.devices.retain(|device| {
                let Driver {
                    name: adapter,
                    version,
                    ..
                } = &device.driver;
                [adapter, version]
                    .iter()
                    .any(|text| text.to_lowercase().contains(name))
            }),
        }
    }
}
