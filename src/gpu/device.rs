//! Vulkan drivers: discovery, selection, and open devices.

use std::env;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use serde::{Deserialize, Serialize};
use wgpu::{Adapter, Backends, DeviceType, Features, Instance, InstanceDescriptor};

use super::quirks::loop_cap::{self, LoopCap};
use super::quirks::{DriverKind, LOOP_CAP, Quirk};
use super::{AdapterSelector, Failure};

/// Properties of a Vulkan driver.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Driver {
    /// The adapter's name.
    pub name: String,
    /// The driver's name and version, as it reports them.
    pub version: String,
    /// The version of Vulkan that the device supports; `None` if it is not known.
    pub api_version: Option<String>,
    /// Whether the device runs on the CPU.
    pub software: bool,
    /// Whether float32 textures can be filtered linearly.
    pub float32_filterable: bool,
    /// The float controls for 32 bits, by their Vulkan names: `DenormFlushToZero`, `RoundingModeRTE`, …
    pub float_controls: Vec<String>,
    /// Whether the device truncates long loops; `None` if that could not be measured.
    pub loop_cap: Option<LoopCap>,
}

impl Driver {
    /// Returns whether it is Mesa's software driver.
    pub fn is_lavapipe(&self) -> bool {
        DriverKind::Lavapipe.matches(&self.name)
    }
}

/// An open device with the state that all its pipelines share.
#[derive(Debug)]
pub(super) struct Device {
    pub(super) gpu: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) filterable: bool,
    pub(super) lost: Arc<Mutex<Option<String>>>,
    adapter: Adapter,
    cap: Option<LoopCap>,
}

fn adapters() -> Vec<Adapter> {
    let mut descriptor = InstanceDescriptor::new_without_display_handle();
    descriptor.backends = Backends::VULKAN;
    pollster::block_on(Instance::new(descriptor).enumerate_adapters(Backends::VULKAN))
}

/// Moves the selected adapter to the front. The others stay in the loader's order.
fn choose(mut adapters: Vec<Adapter>, selector: &AdapterSelector) -> Result<Vec<Adapter>, Failure> {
    if adapters.is_empty() {
        return Err(Failure::NoDriver(match selector {
            AdapterSelector::Auto => "no Vulkan driver found".to_owned(),
            _ => format!("no Vulkan driver found; {INSTALL_HINT}"),
        }));
    }
    let names: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    let find_by_name = |substring: &str| {
        names
            .iter()
            .position(|name| name.to_lowercase().contains(&substring.to_lowercase()))
    };
    let chosen = match selector {
        AdapterSelector::Auto => find_by_name(DriverKind::Lavapipe.adapter_name()).unwrap_or(0),
        AdapterSelector::Lavapipe => find_by_name(DriverKind::Lavapipe.adapter_name()).ok_or_else(|| {
            Failure::NoDriver(format!(
                "lavapipe not found among the Vulkan drivers; {INSTALL_HINT}"
            ))
        })?,
        AdapterSelector::Named(substring) => find_by_name(substring).ok_or_else(|| {
            Failure::NoDriver(format!(
                "no Vulkan adapter with “{substring}” in its name; available: {}",
                names.join(", ")
            ))
        })?,
    };
    let first = adapters.remove(chosen);
    adapters.insert(0, first);
    Ok(adapters)
}

/// Lists all drivers, the selected one first.
pub(super) fn probe(selector: &AdapterSelector) -> Result<Vec<Driver>, Failure> {
    Ok(choose(adapters(), selector)?.into_iter().map(describe).collect())
}

fn describe(adapter: Adapter) -> Driver {
    let info = adapter.get_info();
    let (api_version, float_controls) = vulkan_properties(&adapter).unzip();
    Driver {
        name: info.name.clone(),
        version: version(&info),
        api_version,
        software: info.device_type == DeviceType::Cpu,
        float32_filterable: adapter.features().contains(Features::FLOAT32_FILTERABLE),
        float_controls: float_controls.unwrap_or_default(),
        loop_cap: Device::from_adapter(adapter)
            .and_then(|mut device| device.measured_cap())
            .ok(),
    }
}

fn version(info: &wgpu::AdapterInfo) -> String {
    format!("{} {}", info.driver, info.driver_info).trim().to_owned()
}

/// Metal has no such query.
#[cfg(target_vendor = "apple")]
fn vulkan_properties(_: &Adapter) -> Option<(String, Vec<String>)> {
    None
}

#[cfg(not(target_vendor = "apple"))]
#[expect(
    unsafe_code,
    reason = "wgpu does not expose the version and the float controls; Vulkan's own query does"
)]
fn vulkan_properties(adapter: &Adapter) -> Option<(String, Vec<String>)> {
    use ash::vk;
    let mut float = vk::PhysicalDeviceFloatControlsProperties::default();
    let api_version = {
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut float);
        // SAFETY: the handles outlive the guard's scope, and nothing is destroyed through it.
        let hal = unsafe { adapter.as_hal::<wgpu::hal::api::Vulkan>() }?;
        let instance = hal.shared_instance().raw_instance();
        // SAFETY: the physical device belongs to this instance, and the chain holds one structure of Vulkan
        // 1.2, which wgpu requires anyway.
        unsafe { instance.get_physical_device_properties2(hal.raw_physical_device(), &mut properties) };
        properties.properties.api_version
    };
    let [major, minor, patch] = [
        vk::api_version_major(api_version),
        vk::api_version_minor(api_version),
        vk::api_version_patch(api_version),
    ];
    let controls = [
        (float.shader_denorm_preserve_float32, "DenormPreserve"),
        (float.shader_denorm_flush_to_zero_float32, "DenormFlushToZero"),
        (float.shader_rounding_mode_rte_float32, "RoundingModeRTE"),
        (float.shader_rounding_mode_rtz_float32, "RoundingModeRTZ"),
        (
            float.shader_signed_zero_inf_nan_preserve_float32,
            "SignedZeroInfNanPreserve",
        ),
    ]
    .into_iter()
    .filter(|&(has, _)| has == vk::TRUE)
    .map(|(_, name)| name.to_owned())
    .collect();
    Some((format!("{major}.{minor}.{patch}"), controls))
}

impl Device {
    /// Opens the selected adapter.
    pub(super) fn open(selector: &AdapterSelector) -> Result<Self, Failure> {
        let first = choose(adapters(), selector)?.into_iter().next();
        Self::from_adapter(first.ok_or_else(|| Failure::NoDriver(INSTALL_HINT.to_owned()))?)
    }

    fn from_adapter(adapter: Adapter) -> Result<Self, Failure> {
        let filterable = adapter.features() & Features::FLOAT32_FILTERABLE;
        let blendable = adapter.features() & Features::FLOAT32_BLENDABLE;
        let halves = adapter.features() & Features::SHADER_F16;
        let descriptor = wgpu::DeviceDescriptor {
            required_features: Features::PASSTHROUGH_SHADERS | filterable | blendable | halves,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let failed = |error: wgpu::RequestDeviceError| Failure::Device(error.to_string());
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).map_err(failed)?;
        let lost = Arc::new(Mutex::new(None));
        let lost_reason = Arc::clone(&lost);
        device.set_device_lost_callback(move |reason, message| {
            if let Ok(mut lost) = lost_reason.lock() {
                *lost = Some(format!("the device was lost: {reason:?} {message}"));
            }
        });
        let filterable = !filterable.is_empty();
        Ok(Self {
            gpu: device,
            queue,
            filterable,
            lost,
            adapter,
            cap: None,
        })
    }

    /// Returns the names of the adapter and its driver, for reports.
    pub(super) fn name(&self) -> String {
        let info = self.adapter.get_info();
        format!("{}, {}", info.name, version(&info))
    }

    /// Returns the name of the adapter, without versions.
    pub(super) fn adapter_name(&self) -> String {
        self.adapter.get_info().name
    }

    /// Returns whether shaders may compute in floats of 16 bits.
    pub(super) fn has_halves(&self) -> bool {
        self.gpu.features().contains(Features::SHADER_F16)
    }

    /// Returns whether a workaround is applied on this device.
    pub(super) fn has(&self, quirk: &Quirk) -> bool {
        quirk.applies_to(&self.adapter_name())
    }

    /// Returns the number of iterations after which this driver terminates the loops of an invocation, if it
    /// does.
    pub(super) fn loop_cap(&mut self) -> Result<Option<u32>, Failure> {
        if !self.has(&LOOP_CAP) {
            return Ok(None);
        }
        Ok(match self.measured_cap()? {
            LoopCap::NoneUpTo(_) => None,
            LoopCap::After(iterations) => Some(iterations),
        })
    }

    fn measured_cap(&mut self) -> Result<LoopCap, Failure> {
        if let Some(cap) = self.cap {
            return Ok(cap);
        }
        let cap = loop_cap::measure(self)?;
        self.cap = Some(cap);
        Ok(cap)
    }
}

// Installed drivers, found before any is loaded.

/// Installation instructions for the driver used for all measurements.
pub const INSTALL_HINT: &str = "install Mesa's lavapipe: apt-get install mesa-vulkan-drivers libvulkan1 \
                                (Fedora: dnf install mesa-vulkan-drivers vulkan-loader; \
                                Arch: pacman -S vulkan-swrast vulkan-icd-loader)";

/// Environment variables by which a user pins drivers: the loader's current one and its deprecated one.
pub(super) const PIN_VARIABLES: [&str; 2] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];

/// Returns whether the user pins drivers by the loader's environment variables, which then take precedence.
pub fn is_pinned_by_user() -> bool {
    PIN_VARIABLES.iter().any(|name| env::var_os(name).is_some())
}

/// Returns the manifests that these variables list, or `None` if they are not set.
pub fn pinned() -> Option<Vec<PathBuf>> {
    let list = PIN_VARIABLES.iter().find_map(env::var_os)?;
    Some(env::split_paths(&list).collect())
}

/// Returns the manifests of all installed drivers, in the loader's search order.
pub fn manifests() -> Vec<PathBuf> {
    let home = env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
    let list = |name: &str, default: &str| -> Vec<PathBuf> {
        let value = env::var_os(name).filter(|value| !value.is_empty());
        env::split_paths(&value.unwrap_or_else(|| default.into())).collect()
    };
    let mut roots = vec![home.join(".config")];
    roots.extend(list("XDG_CONFIG_DIRS", "/etc/xdg"));
    roots.push("/etc".into());
    roots.push(home.join(".local/share"));
    roots.extend(list("XDG_DATA_DIRS", "/usr/local/share:/usr/share"));
    let mut found: Vec<PathBuf> = Vec::new();
    for folder in roots.iter().map(|root| root.join("vulkan/icd.d")) {
        let mut in_folder: Vec<_> = folder
            .read_dir()
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
            .filter(|path| !found.contains(path))
            .collect();
        in_folder.sort();
        found.extend(in_folder);
    }
    found
}

/// Returns lavapipe's manifest, preferring this machine's architecture.
pub fn lavapipe_manifest() -> Option<PathBuf> {
    choose_lavapipe(manifests())
}

/// Returns whether [`AdapterSelector::Auto`] selects a driver that runs on the CPU, by the names of the
/// manifests, without loading a driver.
pub fn is_automatic_driver_software() -> bool {
    is_software_selected(&pinned().unwrap_or_else(manifests))
}

fn is_software_selected(manifests: &[PathBuf]) -> bool {
    let begins = |path: &PathBuf, prefix: &str| {
        let name = path.file_name().unwrap_or_default();
        name.to_string_lossy().starts_with(prefix)
    };
    let has_lavapipe = manifests.iter().any(|path| begins(path, LAVAPIPE_MANIFEST));
    let is_swiftshader = |path| begins(path, "vk_swiftshader_icd.");
    has_lavapipe || !manifests.is_empty() && manifests.iter().all(is_swiftshader)
}

/// The start of the name of lavapipe's manifest.
const LAVAPIPE_MANIFEST: &str = "lvp_icd.";

fn choose_lavapipe(manifests: Vec<PathBuf>) -> Option<PathBuf> {
    let name = |path: &Path| {
        path.file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    let mut lavapipe: Vec<_> = manifests
        .into_iter()
        .filter(|path| name(path).starts_with(LAVAPIPE_MANIFEST))
        .collect();
    lavapipe.sort_by_key(|path| !name(path).contains(env::consts::ARCH));
    lavapipe.into_iter().next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lavapipe_of_this_architecture_is_preferred() {
        let paths = |names: &[&str]| names.iter().map(PathBuf::from).collect::<Vec<_>>();
        let lavapipe = format!("/b/lvp_icd.{}.json", env::consts::ARCH);
        let all = paths(&["/a/radeon_icd.x86_64.json", "/b/lvp_icd.other.json", &lavapipe]);
        assert_eq!(choose_lavapipe(all), Some(PathBuf::from(lavapipe)));
        let one = paths(&["/b/lvp_icd.json"]);
        assert_eq!(choose_lavapipe(one.clone()), Some(one[0].clone()));
        assert_eq!(choose_lavapipe(paths(&["/a/intel_icd.json"])), None);
    }

    #[test]
    fn lavapipe_is_selected_beside_other_drivers_and_swiftshader_only_alone() {
        let selected =
            |names: &[&str]| is_software_selected(&names.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert!(selected(&["/a/nvidia_icd.json", "/b/lvp_icd.x86_64.json"]));
        assert!(selected(&["/c/vk_swiftshader_icd.json"]));
        assert!(!selected(&["/a/nvidia_icd.json", "/c/vk_swiftshader_icd.json"]));
        assert!(!selected(&[]), "a loader may find drivers elsewhere");
    }
}
