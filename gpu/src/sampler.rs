//! The plan on wgpu: pipelines, buffers, and the passes in the caller's encoder.

use wgpu::BufferUsages as Usage;

use crate::error::GpuError;
use crate::pass::{Binding, Groups};
use crate::plan::Plan;
use crate::shader::{Arithmetic, Source, wgsl};
use crate::status::Status;

/// Everything that makes points of one [`Plan`] on a device.
pub struct Sampler {
    device: wgpu::Device,
    plan: Plan,
    source: Source,
    steps: Vec<Step>,
    buffers: Vec<(Binding, wgpu::Buffer)>,
}

struct Step {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    bindings: &'static [Binding],
    groups: Groups,
}

/// Importance that is on the device already.
#[derive(Clone, Copy, Debug)]
pub enum Importance<'a> {
    /// A storage buffer of `f32`, row by row.
    Buffer(&'a wgpu::Buffer),
    /// A texture of float values, of which the red channel of the view's first mip counts.
    Texture(&'a wgpu::TextureView),
}

impl Sampler {
    /// Compiles the passes and uploads the plan.
    ///
    /// Compute shaders with WebGPU's default limits are all that the device needs.
    #[must_use]
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        plan: Plan,
        source: Source,
        arithmetic: Arithmetic,
    ) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("twelvefold"),
            source: wgpu::ShaderSource::Wgsl(wgsl(source).into()),
        });
        let constants = [("ARITHMETIC", f64::from(arithmetic as u32))];
        let steps = plan
            .passes()
            .into_iter()
            .map(|pass| {
                let layout = layout(device, pass.bindings, source);
                let whole = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some(pass.entry),
                    bind_group_layouts: &[Some(&layout)],
                    immediate_size: 0,
                });
                let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(pass.entry),
                    layout: Some(&whole),
                    module: &module,
                    entry_point: Some(pass.entry),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        constants: &constants,
                        ..Default::default()
                    },
                    cache: None,
                });
                Step { pipeline, layout, bindings: pass.bindings, groups: pass.groups }
            })
            .collect();
        let mut buffers = Vec::new();
        for (binding, usage) in [
            (Binding::Placed, Usage::UNIFORM | Usage::COPY_DST),
            (Binding::Table, Usage::STORAGE | Usage::COPY_DST),
            (Binding::Tiles, Usage::STORAGE | Usage::COPY_DST),
            (Binding::Pyramid, Usage::STORAGE),
            (Binding::Work, Usage::STORAGE),
            (Binding::Counters, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC),
            (Binding::Masks, Usage::STORAGE),
            (Binding::Positions, Usage::STORAGE | Usage::VERTEX | Usage::COPY_SRC),
            (Binding::Keys, Usage::STORAGE | Usage::VERTEX | Usage::COPY_SRC),
            (Binding::Arguments, Usage::STORAGE | Usage::INDIRECT),
            (Binding::Draw, Usage::STORAGE | Usage::INDIRECT | Usage::COPY_SRC),
        ] {
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("twelvefold"),
                size: plan.bytes(binding),
                usage,
                mapped_at_creation: false,
            });
            buffers.push((binding, buffer));
        }
        let sampler = Self { device: device.clone(), plan, source, steps, buffers };
        for (binding, words) in [
            (Binding::Placed, sampler.plan.uniform()),
            (Binding::Table, sampler.plan.table()),
            (Binding::Tiles, sampler.plan.tiles()),
        ] {
            queue.write_buffer(sampler.buffer(binding), 0, bytemuck::cast_slice(words));
        }
        sampler
    }

    /// Records a frame: points of `density` a squared unit where the importance is 1.
    ///
    /// Never submits, waits, reads back or changes a buffer of another recorded frame; the frame's number,
    /// 48 bytes, goes into a new uniform buffer. One frame at a time: the next one overwrites the output.
    ///
    /// # Errors
    /// [`GpuError::Density`], [`GpuError::Importance`].
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        importance: Importance<'_>,
        density: f64,
    ) -> Result<(), GpuError> {
        let words = self.plan.frame(density)?;
        let (width, height) = self.plan.size();
        let fits = match (importance, self.source) {
            (Importance::Buffer(buffer), Source::Buffer) => {
                buffer.size() >= self.plan.bytes(Binding::Importance)
            }
            (Importance::Texture(view), Source::Texture) => {
                let size = view.texture().size();
                (size.width, size.height) == (width, height)
            }
            _ => false,
        };
        if !fits {
            return Err(GpuError::Importance);
        }
        let frame = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("twelvefold frame"),
            size: self.plan.bytes(Binding::Frame),
            usage: Usage::UNIFORM,
            mapped_at_creation: true,
        });
        if let Ok(mut view) = frame.slice(..).get_mapped_range_mut() {
            view.copy_from_slice(bytemuck::cast_slice(&words));
        }
        frame.unmap();
        encoder.clear_buffer(self.buffer(Binding::Counters), 0, None);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("twelvefold"),
            timestamp_writes: None,
        });
        for step in &self.steps {
            let entries: Vec<_> = step
                .bindings
                .iter()
                .map(|binding| wgpu::BindGroupEntry {
                    binding: *binding as u32,
                    resource: match (binding, importance) {
                        (Binding::Frame, _) => frame.as_entire_binding(),
                        (Binding::Importance, Importance::Buffer(buffer)) => {
                            buffer.as_entire_binding()
                        }
                        (Binding::Importance, Importance::Texture(view)) => {
                            wgpu::BindingResource::TextureView(view)
                        }
                        _ => self.buffer(*binding).as_entire_binding(),
                    },
                })
                .collect();
            let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("twelvefold"),
                layout: &step.layout,
                entries: &entries,
            });
            pass.set_pipeline(&step.pipeline);
            pass.set_bind_group(0, &group, &[]);
            match step.groups {
                Groups::Direct([x, y, z]) => pass.dispatch_workgroups(x, y, z),
                Groups::Indirect => {
                    pass.dispatch_workgroups_indirect(self.buffer(Binding::Arguments), 0);
                }
            }
        }
        Ok(())
    }

    /// One of the plan's buffers; the uniform of a frame and the importance are not among them.
    fn buffer(&self, binding: Binding) -> &wgpu::Buffer {
        let found = self.buffers.iter().find(|(known, _)| *known == binding);
        found.map_or(&self.buffers[0].1, |(_, buffer)| buffer)
    }

    /// The points in the caller's coordinates, two `f32` each: a vertex or storage buffer.
    #[must_use]
    pub fn positions(&self) -> &wgpu::Buffer {
        self.buffer(Binding::Positions)
    }

    /// Each point's key, a `u32`, the same in every frame: see [`Keys`](crate::Keys).
    #[must_use]
    pub fn keys(&self) -> &wgpu::Buffer {
        self.buffer(Binding::Keys)
    }

    /// Arguments of an indirect draw, an instance a point.
    #[must_use]
    pub fn draw_arguments(&self) -> &wgpu::Buffer {
        self.buffer(Binding::Draw)
    }

    /// The counters, whose first words [`Status::from_words`] reads.
    #[must_use]
    pub fn counters(&self) -> &wgpu::Buffer {
        self.buffer(Binding::Counters)
    }

    /// The plan.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// How many bytes of [`counters`](Self::counters) a status takes.
    pub const STATUS_BYTES: u64 = 4 * Status::WORDS as u64;
}

fn layout(device: &wgpu::Device, bindings: &[Binding], source: Source) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = bindings
        .iter()
        .map(|binding| {
            let buffer = |ty| wgpu::BindingType::Buffer {
                ty,
                has_dynamic_offset: false,
                min_binding_size: None,
            };
            let ty = match (binding, source) {
                (Binding::Placed | Binding::Frame, _) => buffer(wgpu::BufferBindingType::Uniform),
                (Binding::Importance, Source::Texture) => wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                (Binding::Table | Binding::Tiles | Binding::Importance, _) => {
                    buffer(wgpu::BufferBindingType::Storage { read_only: true })
                }
                _ => buffer(wgpu::BufferBindingType::Storage { read_only: false }),
            };
            wgpu::BindGroupLayoutEntry {
                binding: *binding as u32,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty,
                count: None,
            }
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("twelvefold"),
        entries: &entries,
    })
}
