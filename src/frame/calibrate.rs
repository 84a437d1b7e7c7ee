//! Which clock to trust: known compute and raster work is timed by timestamps and by the wall, and the two compared.
//!
//! Some drivers give timestamps that are wrong once raster work is on the queue. So no timestamp is believed
//! before the sum of the passes' times is between [`LEAST`] and [`MOST`] of the wall time of the same submission.

use super::timer::Clock;
use crate::device::Gpu;
use crate::problem::Problem;
use std::time::Instant;
use wgpu::Features;

/// Shares of the wall time that the sum of timestamps must lie between: the wall also sees submission and waiting.
const LEAST: f64 = 0.6;
const MOST: f64 = 1.05;
/// Work is repeated until it takes about this long, so that submission does not count.
const LONG_ENOUGH_MS: f64 = 8.0;
const TRIES: usize = 4;

const WORK: &str = "
@group(0) @binding(0) var<storage, read_write> data: array<u32>;
@compute @workgroup_size(64) fn burn(@builtin(global_invocation_id) id: vec3u) {
    var x = id.x;
    for (var i = 0u; i < 512u; i++) { x = x * 1664525u + 1013904223u; }
    data[id.x % arrayLength(&data)] = x;
}
@vertex fn cover(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn shade(@builtin(position) at: vec4f) -> @location(0) vec4f {
    var x = at.x;
    for (var i = 0; i < 64; i++) { x = x * 0.5 + at.y; }
    return vec4f(x, 0.0, 0.0, 1.0);
}";

/// Picks the clock for this device, with the reason where it is not the timestamps.
pub fn choose(gpu: &Gpu) -> Result<Clock, Problem> {
    if !gpu.has(Features::TIMESTAMP_QUERY) {
        return Ok(Clock::Wall("the adapter has no timestamps".to_owned()));
    }
    let work = Work::new(gpu);
    work.run(gpu, 1)?;
    let mut rounds = 1;
    let mut share = 0.0;
    for _ in 0..TRIES {
        let (stamps, wall) = work.run(gpu, rounds)?;
        share = stamps / wall;
        if wall < LONG_ENOUGH_MS && rounds < 64 {
            rounds *= 4;
        } else if (LEAST..=MOST).contains(&share) {
            break;
        }
    }
    Ok(if (LEAST..=MOST).contains(&share) {
        Clock::Timestamps
    } else {
        Clock::Wall(format!("the timestamps of known work add up to {:.0} % of its wall time", 100.0 * share))
    })
}

struct Work {
    compute: wgpu::ComputePipeline,
    raster: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    target: wgpu::TextureView,
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    read: wgpu::Buffer,
}

/// Queries: begin and end of a compute and of a raster pass.
const QUERIES: u32 = 4;

impl Work {
    fn new(gpu: &Gpu) -> Self {
        let device = &gpu.device;
        let source = wgpu::ShaderSource::Wgsl(WORK.into());
        let module =
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("calibration"), source });
        let compute = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("calibration"),
            layout: None,
            module: &module,
            entry_point: Some("burn"),
            compilation_options: Default::default(),
            cache: None,
        });
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let raster = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("calibration"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("cover"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("shade"),
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let buffer = |size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("calibration"),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        use wgpu::BufferUsages as U;
        let data = buffer(4096, U::STORAGE);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("calibration"),
            layout: &compute.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: data.as_entire_binding() }],
        });
        let target = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("calibration"),
            size: wgpu::Extent3d { width: 256, height: 256, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        Self {
            compute,
            raster,
            group,
            target: target.create_view(&Default::default()),
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("calibration"),
                ty: wgpu::QueryType::Timestamp,
                count: QUERIES,
            }),
            resolved: buffer(256, U::QUERY_RESOLVE | U::COPY_SRC),
            read: buffer(256, U::COPY_DST | U::MAP_READ),
        }
    }

    /// Milliseconds by timestamps (sum of both passes) and by the wall.
    fn run(&self, gpu: &Gpu, rounds: u32) -> Result<(f64, f64), Problem> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("calibration"),
                timestamp_writes: Some(wgpu::ComputePassTimestampWrites {
                    query_set: &self.queries,
                    beginning_of_pass_write_index: Some(0),
                    end_of_pass_write_index: Some(1),
                }),
            });
            pass.set_pipeline(&self.compute);
            pass.set_bind_group(0, &self.group, &[]);
            (0..rounds).for_each(|_| pass.dispatch_workgroups(512, 1, 1));
        }
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("calibration"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: Default::default(),
                })],
                timestamp_writes: Some(wgpu::RenderPassTimestampWrites {
                    query_set: &self.queries,
                    beginning_of_pass_write_index: Some(2),
                    end_of_pass_write_index: Some(3),
                }),
                ..Default::default()
            });
            pass.set_pipeline(&self.raster);
            (0..rounds).for_each(|_| pass.draw(0..3, 0..1));
        }
        let begin = Instant::now();
        gpu.queue.submit(std::iter::once(encoder.finish()));
        gpu.wait()?;
        let wall = begin.elapsed().as_secs_f64() * 1e3;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.resolve_query_set(&self.queries, 0..QUERIES, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.read, 0, 256);
        gpu.queue.submit(std::iter::once(encoder.finish()));
        self.read.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        gpu.wait()?;
        let mut ticks = [0u64; QUERIES as usize];
        if let Ok(bytes) = self.read.slice(..).get_mapped_range() {
            for (tick, bytes) in ticks.iter_mut().zip(bytes.chunks_exact(8)) {
                *tick = bytes.try_into().map_or(0, u64::from_le_bytes);
            }
        }
        self.read.unmap();
        let period = f64::from(gpu.queue.get_timestamp_period()) / 1e6;
        let span = |i: usize| ticks[i + 1].saturating_sub(ticks[i]) as f64 * period;
        Ok((span(0) + span(2), wall))
    }
}
