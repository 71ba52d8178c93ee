//! Points in Bevy's render world, every frame: Bevy hands out plain wgpu, so that nothing but wgpu's
//! version ties the two together.
//!
//! A system of the render graph records the passes in Bevy's own encoder; what draws later in the same
//! frame binds `PointSampler`'s buffers. Here the importance is a buffer that a real app would write with
//! a pass of its own.

use bevy::asset::AssetPlugin;
use bevy::image::ImagePlugin;
use bevy::prelude::*;
use bevy::render::renderer::{
    RenderContext, RenderDevice, RenderGraph, RenderGraphSystems, RenderQueue,
};
use bevy::render::{Render, RenderApp, RenderPlugin, RenderSystems};
use bevy::window::WindowPlugin;
use twelvefold::{Domain, Placement};
use twelvefold_gpu::{Arithmetic, Capacity, Importance, Order, Plan, Points, Sampler, Source};

const TEXELS: u32 = 256;

/// What makes the points, and the importance they are made of.
#[derive(Resource)]
struct PointSampler {
    sampler: Sampler,
    importance: wgpu::Buffer,
}

/// Makes the sampler once Bevy has a device.
fn prepare(
    mut commands: Commands,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    made: Option<Res<PointSampler>>,
) -> Result {
    if made.is_some() {
        return Ok(());
    }
    let device = device.wgpu_device();
    let placement = Placement::new(Domain::UNIT, 1);
    let plan = Plan::new(
        &placement,
        (TEXELS, TEXELS),
        Capacity::points(120_000),
        Order::Ordered,
        Points::Relaxed,
        4,
    )?;
    let sampler = Sampler::new(device, &queue, plan, Source::Buffer, Arithmetic::Barriers);
    let importance = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("importance"),
        size: u64::from(4 * TEXELS * TEXELS),
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let ramp: Vec<u8> = (0..TEXELS * TEXELS)
        .flat_map(|i| ((i % TEXELS) as f32 / TEXELS as f32).to_le_bytes())
        .collect();
    queue.write_buffer(&importance, 0, &ramp);
    commands.insert_resource(PointSampler { sampler, importance });
    Ok(())
}

/// Records the frame's points before anything draws.
fn make_points(mut context: RenderContext, points: Option<Res<PointSampler>>) -> Result {
    if let Some(points) = points {
        let from = Importance::Buffer(&points.importance);
        points.sampler.record(context.command_encoder(), from, 200_000.0)?;
    }
    Ok(())
}

fn main() {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        WindowPlugin { primary_window: None, ..default() },
        AssetPlugin::default(),
        RenderPlugin::default(),
        ImagePlugin::default(),
    ));
    if let Some(render) = app.get_sub_app_mut(RenderApp) {
        render
            .add_systems(Render, prepare.in_set(RenderSystems::PrepareResources))
            .add_systems(RenderGraph, make_points.in_set(RenderGraphSystems::Begin));
    }
    app.run();
}
