//! A shader paints an importance texture, the GPU makes points of it, and draws them off screen to a PNG:
//! `cargo run --release -p twelvefold-gpu --example offscreen -- [--points N] [FILE.png]`.
//!
//! Nothing but the finished picture ever leaves the GPU.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;

use twelvefold::{Domain, Placement};
use twelvefold_gpu::{
    Arithmetic, Capacity, Importance, Order, Plan, Points, Sampler, Source, Status,
};

/// The importance's texels a side, and the picture's pixels.
const TEXELS: u32 = 512;
const PIXELS: u32 = 1024;

/// Paints rings that grow dense towards their rims; then a quad of a pixel or so for each point.
const SHADERS: &str = r"
@vertex fn whole(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn paint(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let p = at.xy / 512.0 - vec2(0.5);
    let rings = fract(8.0 * length(p) + 0.25 * sin(12.0 * p.x));
    return vec4(0.02 + rings * rings * rings, 0.0, 0.0, 1.0);
}
override RADIUS: f32;
@vertex fn quad(@builtin(vertex_index) i: u32, @location(0) point: vec2<f32>) -> @builtin(position) vec4<f32> {
    let corner = RADIUS * (vec2(f32(i & 1u), f32(i >> 1u)) * 2.0 - 1.0);
    return vec4((point + corner) * vec2(2.0, -2.0) + vec2(-1.0, 1.0), 0.0, 1.0);
}
@fragment fn ink() -> @location(0) vec4<f32> { return vec4(0.0, 0.0, 0.0, 0.7); }
";

fn main() -> Result<(), Box<dyn Error>> {
    let (mut points, mut file) = (1_000_000u32, String::from("points.png"));
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--points" => points = arguments.next().ok_or("--points needs a number")?.parse()?,
            _ => file = argument,
        }
    }
    if !(1..=15_000_000).contains(&points) {
        return Err("between 1 and 15,000,000 points".into());
    }
    pollster::block_on(run(points, &file))
}

async fn run(points: u32, file: &str) -> Result<(), Box<dyn Error>> {
    let instance =
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await?;
    let (device, queue) = adapter.request_device(&wgpu::DeviceDescriptor::default()).await?;

    // Once: room for what the mean importance, 0.27, is expected to give.
    let placement = Placement::new(Domain::UNIT, 1);
    let capacity = Capacity::points(points + points / 8 + 1000);
    let plan =
        Plan::new(&placement, (TEXELS, TEXELS), capacity, Order::Ordered, Points::Relaxed, 4)?;
    let sampler = Sampler::new(&device, &queue, plan, Source::Texture, Arithmetic::Barriers);

    let importance = target(&device, TEXELS, wgpu::TextureFormat::R16Float);
    let picture = target(&device, PIXELS, wgpu::TextureFormat::Rgba8Unorm);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(SHADERS.into()),
    });
    let radius = (0.3 / f64::from(points).sqrt()).max(0.4 / f64::from(PIXELS));
    let paint = pipeline(&device, &module, ("whole", "paint"), wgpu::TextureFormat::R16Float, None);
    let draw =
        pipeline(&device, &module, ("quad", "ink"), wgpu::TextureFormat::Rgba8Unorm, Some(radius));

    // Every frame: paint, make points, draw them, in one encoder.
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let view = importance.create_view(&wgpu::TextureViewDescriptor::default());
    {
        let mut pass = begin(&mut encoder, &view);
        pass.set_pipeline(&paint);
        pass.draw(0..3, 0..1);
    }
    let density = f64::from(points) / 0.27;
    sampler.record(&mut encoder, Importance::Texture(&view), density)?;
    {
        let view = picture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = begin(&mut encoder, &view);
        pass.set_pipeline(&draw);
        pass.set_vertex_buffer(0, sampler.positions().slice(..));
        pass.draw_indirect(sampler.draw_arguments(), 0);
    }

    // For the file.
    let bytes = u64::from(4 * PIXELS * PIXELS);
    let read = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes + Sampler::STATUS_BYTES,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    encoder.copy_texture_to_buffer(
        picture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &read,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * PIXELS),
                rows_per_image: None,
            },
        },
        picture.size(),
    );
    encoder.copy_buffer_to_buffer(sampler.counters(), 0, &read, bytes, Sampler::STATUS_BYTES);
    queue.submit([encoder.finish()]);
    read.slice(..).map_async(wgpu::MapMode::Read, |_| ());
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let data = read.slice(..).get_mapped_range()?.to_vec();
    let (pixels, counters) = data.split_at(bytes as usize);
    let word = |i: usize| {
        counters[4 * i..4 * i + 4].iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte))
    };
    let status = Status::from_words(std::array::from_fn(word));
    let Status { points, candidates, .. } = status;
    let name = adapter.get_info().name;
    println!("{points} points of {candidates} candidates on {name}");
    if !status.is_complete() {
        return Err("there was not room for all points".into());
    }
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(file)?), PIXELS, PIXELS);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(())
}

fn target(device: &wgpu::Device, side: u32, format: wgpu::TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    })
}

/// Of points as quads of a radius, or of a triangle over the whole target.
fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    (vertex, fragment): (&str, &str),
    format: wgpu::TextureFormat,
    radius: Option<f64>,
) -> wgpu::RenderPipeline {
    let constants: Vec<(&str, f64)> = radius.map(|radius| ("RADIUS", radius)).into_iter().collect();
    let point = wgpu::vertex_attr_array![0 => Float32x2];
    let points = Some(wgpu::VertexBufferLayout {
        array_stride: 8,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &point,
    });
    let buffers = if radius.is_some() { std::slice::from_ref(&points) } else { &[] };
    let blend = radius.map(|_| wgpu::BlendState::ALPHA_BLENDING);
    let options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: options.clone(),
            buffers,
        },
        primitive: wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..Default::default()
        },
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: options,
            targets: &[Some(wgpu::ColorTargetState {
                format,
                blend,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
