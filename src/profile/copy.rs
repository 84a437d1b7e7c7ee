//! The device's own copy speed: what its memory gives to the simplest work there is.
//!
//! A buffer is copied into another, and a texture into another, each larger than any cache where memory allows. What
//! is copied is read once and written once, so that a copy of N bytes moves 2 N: the same count as for stages.

use crate::device::Gpu;
use crate::frame::Clock;
use crate::problem::Problem;
use crate::record::quantile;
use serde::Serialize;
use std::time::Instant;
use wgpu::{BufferUsages, CommandEncoder, Extent3d, Features, TextureFormat, TextureUsages};

/// Sizes to try, the largest that the device has memory for is taken.
const SIZES: [u64; 4] = [128 << 20, 64 << 20, 32 << 20, 16 << 20];
const REPEATS: usize = 9;
/// Of the texture, and its bytes a texel.
const FORMAT: TextureFormat = TextureFormat::Rgba16Float;
const TEXEL: u64 = 8;
const WIDTH: u32 = 4096;

#[derive(Clone, Debug, Serialize)]
pub struct CopySpeeds {
    pub buffer: CopySpeed,
    pub texture: CopySpeed,
}

#[derive(Clone, Debug, Serialize)]
pub struct CopySpeed {
    /// Bytes that were copied: as many were read, and as many written.
    pub bytes: u64,
    pub clock: &'static str,
    pub samples_ms: Vec<f64>,
    /// Bytes read and written together in the median time, in 10⁹ a second.
    pub gb_per_s: Option<f64>,
}

impl CopySpeeds {
    /// Of the faster way.
    pub fn best(&self) -> Option<f64> {
        let known = [self.buffer.gb_per_s, self.texture.gb_per_s].into_iter().flatten();
        known.max_by(f64::total_cmp)
    }
}

/// 10⁹ bytes a second, if that took any time.
pub fn gb_per_s(bytes: u64, ms: f64) -> Option<f64> {
    (ms > 0.0).then(|| bytes as f64 / ms / 1e6)
}

/// Measures both ways on the queue that frames run on, with the clock that times stages.
///
/// Errors: `out-of-memory` if not even the smallest copy fits, or what the driver reports.
pub fn measure(gpu: &Gpu, clock: &Clock) -> Result<CopySpeeds, Problem> {
    let timer = Timer::new(gpu, clock);
    let buffer = largest(gpu, |bytes| {
        let make = |usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("copy"),
                size: bytes,
                usage,
                mapped_at_creation: false,
            })
        };
        let (from, to) = (make(BufferUsages::COPY_SRC), make(BufferUsages::COPY_DST));
        timer.samples(gpu, |encoder| encoder.copy_buffer_to_buffer(&from, 0, &to, 0, bytes))
    })?;
    let texture = largest(gpu, |bytes| {
        let size = Extent3d {
            width: WIDTH,
            height: (bytes / TEXEL / u64::from(WIDTH)) as u32,
            depth_or_array_layers: 1,
        };
        let make = |usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("copy"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage,
                view_formats: &[],
            })
        };
        let (from, to) = (make(TextureUsages::COPY_SRC), make(TextureUsages::COPY_DST));
        timer.samples(gpu, |encoder| {
            encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), size);
        })
    })?;
    let speed = |(bytes, samples_ms): (u64, Vec<f64>)| CopySpeed {
        bytes,
        clock: timer.name(),
        gb_per_s: quantile(&samples_ms, 0.5).and_then(|ms| gb_per_s(2 * bytes, ms)),
        samples_ms,
    };
    Ok(CopySpeeds { buffer: speed(buffer), texture: speed(texture) })
}

/// What `samples` gives for the largest size for which there is memory.
fn largest(
    gpu: &Gpu,
    samples: impl Fn(u64) -> Result<Vec<f64>, Problem>,
) -> Result<(u64, Vec<f64>), Problem> {
    let limit = gpu.device.limits().max_buffer_size;
    let mut short = None;
    for bytes in SIZES.into_iter().filter(|bytes| *bytes <= limit) {
        match samples(bytes) {
            Ok(samples) => return Ok((bytes, samples)),
            Err(problem) if problem.code == "out-of-memory" => short = Some(problem),
            Err(problem) => return Err(problem),
        }
    }
    Err(short.unwrap_or_else(|| {
        Problem::failure("out-of-memory", format!("the device makes no buffer larger than {limit} bytes"))
    }))
}

/// Timestamps around copies where the adapter can take them outside of passes, else the wall.
struct Timer {
    marks: Option<(wgpu::QuerySet, wgpu::Buffer, wgpu::Buffer)>,
    period: f64,
}

impl Timer {
    fn new(gpu: &Gpu, clock: &Clock) -> Self {
        let stamps = *clock == Clock::Timestamps && gpu.has(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);
        let marks = stamps.then(|| {
            let set = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("copy"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            });
            let buffer = |usage| {
                gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("copy"),
                    size: 16,
                    usage,
                    mapped_at_creation: false,
                })
            };
            let resolved = buffer(BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC);
            (set, resolved, buffer(BufferUsages::COPY_DST | BufferUsages::MAP_READ))
        });
        Self { marks, period: f64::from(gpu.queue.get_timestamp_period()) / 1e6 }
    }

    fn name(&self) -> &'static str {
        match self.marks {
            Some(_) => Clock::Timestamps.name(),
            None => Clock::Wall(String::new()).name(),
        }
    }

    /// Milliseconds of each repeat; a first one, in which memory is made ready, does not count.
    fn samples(&self, gpu: &Gpu, copy: impl Fn(&mut CommandEncoder)) -> Result<Vec<f64>, Problem> {
        gpu.check()?;
        let all = (0..=REPEATS).map(|_| self.sample(gpu, &copy)).collect::<Result<Vec<_>, _>>()?;
        Ok(all.into_iter().skip(1).collect())
    }

    fn sample(&self, gpu: &Gpu, copy: impl Fn(&mut CommandEncoder)) -> Result<f64, Problem> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        if let Some((set, _, _)) = &self.marks {
            encoder.write_timestamp(set, 0);
        }
        copy(&mut encoder);
        if let Some((set, resolved, read)) = &self.marks {
            encoder.write_timestamp(set, 1);
            encoder.resolve_query_set(set, 0..2, resolved, 0);
            encoder.copy_buffer_to_buffer(resolved, 0, read, 0, 16);
        }
        let commands = encoder.finish();
        let begin = Instant::now();
        gpu.queue.submit(std::iter::once(commands));
        let Some((_, _, read)) = &self.marks else {
            gpu.wait()?;
            return Ok(begin.elapsed().as_secs_f64() * 1e3);
        };
        read.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        gpu.wait()?;
        let mut ticks = [0u64; 2];
        if let Ok(bytes) = read.slice(..).get_mapped_range() {
            for (tick, bytes) in ticks.iter_mut().zip(bytes.chunks_exact(8)) {
                *tick = bytes.try_into().map_or(0, u64::from_le_bytes);
            }
        }
        read.unmap();
        Ok(ticks[1].saturating_sub(ticks[0]) as f64 * self.period)
    }
}
