//! Whether a device's arithmetic has the CPU's bits.

use crate::golden::golden;
use crate::shader::{Arithmetic, self_test_wgsl};

/// [`Arithmetic::Barriers`] if that is exact on this device, otherwise [`Arithmetic::Integers`].
///
/// Submits and waits: for start-up, where [`poll`](wgpu::Device::poll) may block; not on the web.
///
/// # Errors
/// [`wgpu::PollError`] if the device is lost.
pub fn choose_arithmetic(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
) -> Result<Arithmetic, wgpu::PollError> {
    let exact = is_exact(device, queue, Arithmetic::Barriers)?;
    Ok(if exact { Arithmetic::Barriers } else { Arithmetic::Integers })
}

/// Whether all [`golden`] positions come out with the CPU's bits.
///
/// # Errors
/// As [`choose_arithmetic`].
pub fn is_exact(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    arithmetic: Arithmetic,
) -> Result<bool, wgpu::PollError> {
    use wgpu::BufferUsages as Usage;
    let vectors = golden();
    let mut words: Vec<u32> = Vec::with_capacity(8 * vectors.len());
    for vector in &vectors {
        words.extend(vector.origin.iter().chain(&vector.half_edge));
        words.extend(vector.at.map(|n| n as u32));
    }
    let buffer = |size, usage| {
        let label = Some("twelvefold self-test");
        device.create_buffer(&wgpu::BufferDescriptor {
            label,
            size,
            usage,
            mapped_at_creation: false,
        })
    };
    let bytes = 8 * vectors.len() as u64;
    let given = buffer(4 * bytes, Usage::STORAGE | Usage::COPY_DST);
    let zeros = buffer(16, Usage::UNIFORM | Usage::COPY_DST);
    let results = buffer(bytes, Usage::STORAGE | Usage::COPY_SRC);
    let read = buffer(bytes, Usage::MAP_READ | Usage::COPY_DST);
    queue.write_buffer(&given, 0, bytemuck::cast_slice(&words));
    queue.write_buffer(&zeros, 0, &[0; 16]);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("twelvefold self-test"),
        source: wgpu::ShaderSource::Wgsl(self_test_wgsl().into()),
    });
    let constants = [("ARITHMETIC", f64::from(arithmetic as u32))];
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("twelvefold self-test"),
        layout: None,
        module: &module,
        entry_point: Some("self_test"),
        compilation_options: wgpu::PipelineCompilationOptions {
            constants: &constants,
            ..Default::default()
        },
        cache: None,
    });
    let resources = [&given, &zeros, &results];
    let entries = [0, 1, 2].map(|binding| wgpu::BindGroupEntry {
        binding,
        resource: resources[binding as usize].as_entire_binding(),
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups((vectors.len() as u32).div_ceil(64), 1, 1);
    }
    encoder.copy_buffer_to_buffer(&results, 0, &read, 0, bytes);
    queue.submit([encoder.finish()]);
    read.slice(..).map_async(wgpu::MapMode::Read, |_| ());
    device.poll(wgpu::PollType::wait_indefinitely())?;
    // Not mapped: as good as wrong.
    let Ok(view) = read.slice(..).get_mapped_range() else { return Ok(false) };
    let expected = vectors.iter().flat_map(|vector| vector.position);
    let found = view.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    Ok(found.eq(expected))
}
