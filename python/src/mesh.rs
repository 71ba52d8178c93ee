//! Points on triangle meshes.

use glam::Vec3;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use twelvefold::mesh::{Mesh, MeshError, SurfacePoint};

use crate::arrays::Numbers;
use crate::work::{self, Stop};
use crate::{arguments, error, output};

/// The most steps, as of refined dots.
const MOST_STEPS: usize = 1000;

/// Steps between two looks whether points are still wanted: how triangles are connected is found out anew
/// for each of these runs, which costs about as much as a step.
const STEPS_AT_ONCE: usize = 20;

/// What a mesh is made of.
struct Parts {
    vertices: Vec<Vec3>,
    faces: Vec<[u32; 3]>,
    density: Option<Vec<f32>>,
}

/// Points on a mesh, their faces and their barycentric weights; see the package's documentation.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python's keywords, each by its name")]
pub(crate) fn mesh_points<'py>(
    py: Python<'py>,
    vertices: &Bound<'py, PyAny>,
    faces: &Bound<'py, PyAny>,
    n: &Bound<'py, PyAny>,
    density: Option<&Bound<'py, PyAny>>,
    relax: &Bound<'py, PyAny>,
    seed: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let n = arguments::count(n)?;
    let steps = arguments::whole("relax", relax, MOST_STEPS)?;
    let seed = arguments::seed(seed)?;
    let vertices = corners(vertices)?;
    let faces = triangles(faces, vertices.len())?;
    let density = density.map(|density| densities(density, vertices.len())).transpose()?;
    let parts = Parts { vertices, faces, density };
    let points = work::run(py, move |stop| {
        points(&parts, n, seed, steps, stop).map_err(|reason| explained(&parts, reason))
    })?;
    let positions = points.iter().map(|point| point.position.to_array()).collect();
    let faces = points.iter().map(|point| i64::from(point.triangle)).collect();
    let weights = points.iter().map(|point| point.weights).collect();
    let arrays = [
        output::rows::<f64, 3>(py, positions)?,
        output::column::<i64>(py, faces),
        output::rows::<f64, 3>(py, weights)?,
    ];
    Ok(PyTuple::new(py, arrays)?.into_any())
}

/// The points, evened out as long as they are wanted.
fn points(
    parts: &Parts,
    n: usize,
    seed: u64,
    steps: usize,
    stop: &Stop,
) -> Result<Vec<SurfacePoint>, MeshError> {
    let mesh = Mesh::new(&parts.vertices, &parts.faces)?;
    let mesh = match &parts.density {
        Some(density) => mesh.with_densities(density)?,
        None => mesh,
    };
    let mut points = mesh.points(n, seed)?;
    for first in (0..steps).step_by(STEPS_AT_ONCE) {
        if stop.wanted() {
            break;
        }
        mesh.relax(&mut points, STEPS_AT_ONCE.min(steps - first))?;
    }
    Ok(points)
}

/// An array (vertices, 3) as positions, of any value.
fn corners(argument: &Bound<'_, PyAny>) -> PyResult<Vec<Vec3>> {
    let numbers = Numbers::new("vertices", argument)?;
    let &[_, 3] = numbers.shape() else {
        return Err(numbers.of_shape("(vertices, 3)"));
    };
    let coordinates = numbers.collect(|number| number as f32)?;
    let (corners, _) = coordinates.as_chunks::<3>();
    Ok(corners.iter().map(|corner| Vec3::from_array(*corner)).collect())
}

/// An array (faces, 3) as triples of so many vertices.
fn triangles(argument: &Bound<'_, PyAny>, vertices: usize) -> PyResult<Vec<[u32; 3]>> {
    let numbers = Numbers::new("faces", argument)?;
    let &[_, 3] = numbers.shape() else {
        return Err(numbers.of_shape("(faces, 3)"));
    };
    let indices = numbers.integers()?;
    let mut faces = Vec::new();
    let bytes = size_of_val(&indices[..]) / 2;
    faces.try_reserve_exact(indices.len() / 3).map_err(|_| error::memory(bytes))?;
    let (triples, _) = indices.as_chunks::<3>();
    for (face, triple) in triples.iter().enumerate() {
        let known = |index: &i64| u32::try_from(*index).ok().filter(|i| (*i as usize) < vertices);
        match triple.each_ref().map(known) {
            [Some(a), Some(b), Some(c)] => faces.push([a, b, c]),
            known => {
                let corner = known.iter().position(Option::is_none).unwrap_or(0);
                return Err(error::value(format!(
                    "faces[{face}, {corner}] is {}, and vertices has {vertices} rows, counted from 0",
                    triple[corner]
                )));
            }
        }
    }
    Ok(faces)
}

/// An array (vertices,) as densities, of any value.
fn densities(argument: &Bound<'_, PyAny>, vertices: usize) -> PyResult<Vec<f32>> {
    let numbers = Numbers::new("density", argument)?;
    match *numbers.shape() {
        [count] if count == vertices => numbers.collect(|number| number as f32),
        _ => Err(numbers.of_shape(&format!("({vertices},), one for each vertex"))),
    }
}

/// The library's error in terms of the arrays.
fn explained(parts: &Parts, reason: MeshError) -> PyErr {
    match reason {
        MeshError::NotFinite { triangle, vertex } => {
            let vertex = vertex as usize;
            let position = parts.vertices.get(vertex).copied().unwrap_or(Vec3::NAN);
            error::value(format!(
                "vertices[{vertex}], a corner of faces[{triangle}], is {position} in float32; \
                 coordinates are finite"
            ))
        }
        MeshError::Density { triangle, vertex, density } => error::value(format!(
            "density[{vertex}], at a corner of faces[{triangle}], is {density} in float32; it is finite \
             and not negative"
        )),
        MeshError::Nothing if parts.density.is_some() => {
            error::value("faces has no triangle with both area and density")
        }
        MeshError::Nothing => error::value("faces has no triangle with area"),
        MeshError::Memory { bytes } => error::memory(bytes),
        _ => error::value(reason),
    }
}
