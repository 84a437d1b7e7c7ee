//! The GPU: which adapters there are, opening one, and making every error of the driver an error of ours.

use crate::problem::{Problem, Result};
use std::sync::{Arc, Mutex};
use wgpu::{Adapter, AdapterInfo, Backends, Device, DeviceType, Features, Instance, Limits, Queue};

/// Features that voxgi uses where the adapter has them; pipelines may need more of what the adapter offers.
const WANTED: [Features; 7] = [
    Features::TIMESTAMP_QUERY,
    Features::TIMESTAMP_QUERY_INSIDE_ENCODERS,
    Features::TIMESTAMP_QUERY_INSIDE_PASSES,
    Features::CLEAR_TEXTURE,
    Features::FLOAT32_FILTERABLE,
    Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES,
    Features::VERTEX_WRITABLE_STORAGE,
];

/// An open device and what is known of it.
pub struct Gpu {
    pub device: Device,
    pub queue: Queue,
    pub adapter: Adapter,
    pub info: AdapterInfo,
    errors: Arc<Mutex<Vec<String>>>,
}

/// Which limits the device is asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum LimitSet {
    /// All that the adapter has.
    #[default]
    Adapter,
    /// What WebGPU guarantees everywhere.
    Webgpu,
}

fn instance() -> Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = Backends::PRIMARY;
    Instance::new(descriptor)
}

/// All adapters of this machine, the best first: discrete, integrated, virtual, software.
pub fn adapters() -> Vec<Adapter> {
    let mut adapters = pollster::block_on(instance().enumerate_adapters(Backends::PRIMARY));
    adapters.sort_by_key(|adapter| match adapter.get_info().device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    });
    adapters
}

/// The best adapter, or the best whose name contains `wanted` (case does not matter).
pub fn choose(wanted: Option<&str>) -> Result<Adapter> {
    let adapters = adapters();
    let names: Vec<String> = adapters.iter().map(|a| a.get_info().name).collect();
    let found = adapters.into_iter().find(|adapter| {
        wanted.is_none_or(|w| adapter.get_info().name.to_lowercase().contains(&w.to_lowercase()))
    });
    Ok(found.ok_or_else(|| match wanted {
        Some(wanted) if !names.is_empty() => {
            Problem::failure("no-adapter", format!("no adapter's name contains `{wanted}`"))
                .help(format!("there are: {}", names.join(", ")))
        }
        _ => no_adapter(),
    })?)
}

impl Gpu {
    /// Opens the adapter that [`choose`] chooses.
    pub fn open(wanted: Option<&str>, limits: &LimitSet) -> Result<Self> {
        Self::from_adapter(choose(wanted)?, limits)
    }

    fn from_adapter(adapter: Adapter, limits: &LimitSet) -> Result<Self> {
        let info = adapter.get_info();
        let features = WANTED.iter().fold(Features::empty(), |all, f| all | (*f & adapter.features()));
        let required_limits = match limits {
            LimitSet::Adapter => adapter.limits(),
            LimitSet::Webgpu => Limits::default(),
        };
        let request = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("voxgi"),
            required_features: features,
            required_limits,
            ..Default::default()
        });
        let (device, queue) = pollster::block_on(request).map_err(|error| {
            Problem::failure("no-device", format!("the adapter `{}` gives no device: {error}", info.name))
                .help("another one may: `voxgi devices` lists them, `--adapter NAME` chooses")
        })?;
        let errors = Arc::new(Mutex::new(Vec::new()));
        let put = |errors: &Arc<Mutex<Vec<String>>>, text: String| {
            if let Ok(mut errors) = errors.lock() {
                errors.push(text);
            }
        };
        let uncaptured = errors.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| put(&uncaptured, error.to_string())));
        let lost = errors.clone();
        device.set_device_lost_callback(move |reason, message| {
            if reason != wgpu::DeviceLostReason::Destroyed {
                put(&lost, format!("the device was lost: {message}"));
            }
        });
        Ok(Self { device, queue, adapter, info, errors })
    }

    pub fn has(&self, feature: Features) -> bool {
        self.device.features().contains(feature)
    }

    /// What textures of a format can do on this device.
    pub fn format_features(&self, format: wgpu::TextureFormat) -> wgpu::TextureFormatFeatures {
        if !self.has(format.required_features()) {
            return wgpu::TextureFormatFeatures {
                allowed_usages: wgpu::TextureUsages::empty(),
                flags: wgpu::TextureFormatFeatureFlags::empty(),
            };
        }
        let mut can = match self.has(Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES) {
            true => self.adapter.get_texture_format_features(format),
            false => format.guaranteed_format_features(self.device.features()),
        };
        if format == wgpu::TextureFormat::Bgra8Unorm && !self.has(Features::BGRA8UNORM_STORAGE) {
            can.allowed_usages.remove(wgpu::TextureUsages::STORAGE_BINDING);
        }
        can
    }

    /// The first error that the driver has reported since the last call. wgpu names the stage in it: passes, pipelines
    /// and resources bear the names of stages and resources as labels.
    pub fn check(&self) -> Result<(), Problem> {
        let Ok(mut errors) = self.errors.lock() else { return Ok(()) };
        let first = errors.drain(..).next();
        match first {
            None => Ok(()),
            Some(text) => Err(fault(&text)),
        }
    }

    /// Waits for all submitted work.
    pub fn wait(&self) -> Result<(), Problem> {
        if let Err(error) = self.device.poll(wgpu::PollType::wait_indefinitely()) {
            return Err(fault(&format!("waiting for the device failed: {error}")));
        }
        self.check()
    }
}

/// There is nothing to run on.
pub fn no_adapter() -> Problem {
    Problem::failure("no-adapter", "this machine shows no Vulkan, Metal or DirectX 12 adapter").help(
        "install the graphics driver; without a GPU, `sh scripts/setup.sh` installs a software driver (Mesa's lavapipe)",
    )
}

/// A driver's error text as a problem.
pub fn fault(text: &str) -> Problem {
    let lower = text.to_lowercase();
    if lower.contains("out of memory") || lower.contains("not enough memory") {
        Problem::failure("out-of-memory", format!("the device has too little memory: {text}"))
            .help("choose a smaller size or resolution; `voxgi check` lists what each resource takes")
    } else {
        Problem::failure("device", format!("the device refused the work: {text}"))
    }
}
