//! Choosing and opening a Vulkan adapter, and what is worth knowing of each.

use std::sync::{Arc, Mutex};

use serde::{Deserialize, Serialize};
use wgpu::{Adapter, Backends, DeviceType, Features, Instance, InstanceDescriptor};

use super::{Failure, INSTALL_HINT, On};

/// What is worth knowing of a Vulkan driver.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Driver {
    /// The adapter's name.
    pub name: String,
    /// The driver's name and version, as it says itself.
    pub version: String,
    /// Whether it runs on the CPU.
    pub software: bool,
    /// Whether float32 textures can be filtered linearly.
    pub float32_filterable: bool,
    /// Its float controls for 32 bits, in Vulkan's words: `DenormFlushToZero`, `RoundingModeRTE`, …
    pub float_controls: Vec<String>,
    /// Whether it ends loops by force; none where it could not be measured.
    pub loop_cap: Option<LoopCap>,
}

impl Driver {
    /// Whether it is Mesa's software driver.
    #[must_use]
    pub fn is_lavapipe(&self) -> bool {
        self.name.contains(LAVAPIPE)
    }
}

/// What lavapipe calls its adapter.
const LAVAPIPE: &str = "llvmpipe";

/// Whether a driver ends the loops of an invocation by force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LoopCap {
    /// Not within the iterations that were tried.
    NoneUpTo(u32),
    /// After so many iterations.
    After(u32),
}

/// How many iterations the cap is looked for in.
pub(super) const PROBED_ITERATIONS: u32 = 70_000;

/// An open device and what all its pipelines share.
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

/// The adapter that `on` asks for comes first; the others follow in the loader's order.
fn choose(mut adapters: Vec<Adapter>, on: &On) -> Result<Vec<Adapter>, Failure> {
    if adapters.is_empty() {
        return Err(Failure::NoDriver(format!(
            "no Vulkan driver found; {INSTALL_HINT}"
        )));
    }
    let names: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    let holds = |words: &str| {
        names
            .iter()
            .position(|name| name.to_lowercase().contains(&words.to_lowercase()))
    };
    let chosen = match on {
        On::Auto => holds(LAVAPIPE).unwrap_or(0),
        On::Lavapipe => holds(LAVAPIPE).ok_or_else(|| {
            Failure::NoDriver(format!(
                "lavapipe is not among the Vulkan drivers here; {INSTALL_HINT}"
            ))
        })?,
        On::Named(words) => holds(words).ok_or_else(|| {
            Failure::NoDriver(format!(
                "no Vulkan adapter's name holds “{words}”; there are: {}",
                names.join(", ")
            ))
        })?,
    };
    let first = adapters.remove(chosen);
    adapters.insert(0, first);
    Ok(adapters)
}

/// All drivers, the chosen one first.
pub(super) fn probe(on: &On) -> Result<Vec<Driver>, Failure> {
    Ok(choose(adapters(), on)?.into_iter().map(describe).collect())
}

fn describe(adapter: Adapter) -> Driver {
    let info = adapter.get_info();
    Driver {
        name: info.name.clone(),
        version: version(&info),
        software: info.device_type == DeviceType::Cpu,
        float32_filterable: adapter.features().contains(Features::FLOAT32_FILTERABLE),
        float_controls: float_controls(&adapter),
        loop_cap: Device::of(adapter)
            .and_then(|mut device| device.measured_cap())
            .ok(),
    }
}

fn version(info: &wgpu::AdapterInfo) -> String {
    format!("{} {}", info.driver, info.driver_info).trim().to_owned()
}

#[expect(
    unsafe_code,
    reason = "wgpu does not tell float controls; Vulkan's own query does"
)]
fn float_controls(adapter: &Adapter) -> Vec<String> {
    use ash::vk;
    let mut float = vk::PhysicalDeviceFloatControlsProperties::default();
    {
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut float);
        // SAFETY: the handles live as long as the guard, and nothing is destroyed through it.
        let Some(hal) = (unsafe { adapter.as_hal::<wgpu::hal::api::Vulkan>() }) else {
            return Vec::new();
        };
        let instance = hal.shared_instance().raw_instance();
        // SAFETY: the physical device is of this instance, and the chain holds one structure that Vulkan 1.2
        // (and wgpu's own requirements) knows.
        unsafe { instance.get_physical_device_properties2(hal.raw_physical_device(), &mut properties) };
    }
    [
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
    .collect()
}

impl Device {
    /// Opens the adapter that `on` asks for.
    pub(super) fn open(on: &On) -> Result<Self, Failure> {
        let first = choose(adapters(), on)?.into_iter().next();
        Self::of(first.ok_or_else(|| Failure::NoDriver(INSTALL_HINT.to_owned()))?)
    }

    fn of(adapter: Adapter) -> Result<Self, Failure> {
        let filterable = adapter.features() & Features::FLOAT32_FILTERABLE;
        let descriptor = wgpu::DeviceDescriptor {
            required_features: Features::PASSTHROUGH_SHADERS | filterable,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let failed = |error: wgpu::RequestDeviceError| Failure::Device(error.to_string());
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).map_err(failed)?;
        let lost = Arc::new(Mutex::new(None));
        let told = Arc::clone(&lost);
        device.set_device_lost_callback(move |reason, words| {
            if let Ok(mut lost) = told.lock() {
                *lost = Some(format!("the device was lost: {reason:?} {words}"));
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

    /// The adapter's name and its driver's, for reports.
    pub(super) fn name(&self) -> String {
        let info = self.adapter.get_info();
        format!("{}, {}", info.name, version(&info))
    }

    /// Whether this driver is of a kind that is known to end loops by force: some versions of Mesa's software rasteriser are.
    pub(super) fn may_end_loops(&self) -> bool {
        self.is_lavapipe()
    }

    pub(super) fn is_lavapipe(&self) -> bool {
        self.adapter.get_info().name.contains(LAVAPIPE)
    }

    /// After how many iterations this driver ends an invocation's loops, if it does.
    pub(super) fn loop_cap(&mut self) -> Result<Option<u32>, Failure> {
        if !self.may_end_loops() {
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
        let cap = super::draw::measure_cap(self)?;
        self.cap = Some(cap);
        Ok(cap)
    }
}
