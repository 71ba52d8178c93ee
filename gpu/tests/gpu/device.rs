//! A device, and what a frame leaves on it.

use std::sync::OnceLock;

use twelvefold_gpu::{Arithmetic, Importance, Plan, Sampler, Source, Status};

pub(crate) struct Device {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
}

/// The one device of this process, with WebGPU's default limits.
pub(crate) fn device() -> Option<&'static Device> {
    static DEVICE: OnceLock<Option<Device>> = OnceLock::new();
    let found = DEVICE.get_or_init(|| {
        let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        let instance = wgpu::Instance::new(descriptor);
        let options = wgpu::RequestAdapterOptions::default();
        let adapter = pollster::block_on(instance.request_adapter(&options)).ok()?;
        println!("on {:?}", adapter.get_info().name);
        let descriptor = wgpu::DeviceDescriptor::default();
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
        Some(Device { device, queue })
    });
    if found.is_none() {
        assert!(std::env::var_os("TWELVEFOLD_REQUIRE_GPU").is_none(), "no GPU adapter");
        println!("skipped: no GPU adapter");
    }
    found.as_ref()
}

/// A frame's output.
#[derive(Debug, PartialEq)]
pub(crate) struct Output {
    pub(crate) positions: Vec<[u32; 2]>,
    pub(crate) keys: Vec<u32>,
    pub(crate) draw: Vec<u32>,
    pub(crate) status: Status,
}

impl Device {
    pub(crate) fn sampler(&self, plan: Plan, source: Source, arithmetic: Arithmetic) -> Sampler {
        Sampler::new(&self.device, &self.queue, plan, source, arithmetic)
    }

    pub(crate) fn buffer(&self, pixels: &[f32]) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 4 * pixels.len() as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bytes: Vec<u8> = pixels.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.queue.write_buffer(&buffer, 0, &bytes);
        buffer
    }

    pub(crate) fn texture(&self, pixels: &[f32], width: u32, height: u32) -> wgpu::TextureView {
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let bytes: Vec<u8> = pixels.iter().flat_map(|v| v.to_le_bytes()).collect();
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * width),
            rows_per_image: None,
        };
        self.queue.write_texture(texture.as_image_copy(), &bytes, layout, size);
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    pub(crate) fn run(&self, sampler: &Sampler, from: Importance<'_>, density: f64) -> Output {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        sampler.record(&mut encoder, from, density).unwrap();
        self.queue.submit([encoder.finish()]);
        let counters = self.words(sampler.counters(), Status::WORDS as u64);
        let status = Status::from_words([counters[0], counters[1], counters[2], counters[3]]);
        let points = u64::from(status.points.min(sampler.plan().capacity()));
        let positions = self.words(sampler.positions(), 2 * points);
        Output {
            positions: positions.chunks_exact(2).map(|p| [p[0], p[1]]).collect(),
            keys: self.words(sampler.keys(), points),
            draw: self.words(sampler.draw_arguments(), 4),
            status,
        }
    }

    fn words(&self, buffer: &wgpu::Buffer, count: u64) -> Vec<u32> {
        if count == 0 {
            return Vec::new();
        }
        let to = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 4 * count,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &to, 0, 4 * count);
        self.queue.submit([encoder.finish()]);
        to.slice(..).map_async(wgpu::MapMode::Read, |result| result.unwrap());
        self.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        let bytes = to.slice(..).get_mapped_range().unwrap().to_vec();
        bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
    }
}
