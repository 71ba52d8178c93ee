"""Evenness and time of points on meshes, beside PyMeshLab's, Open3D's and trimesh's.

    pip install ./python scipy pymeshlab open3d-cpu trimesh
    python python/benchmarks/meshes.py 2000 20000 bunny.obj …

Distances are those to the nearest point whose surface faces the same way, straight through space, in parts of the
hexagonal lattice's for the same number and area: least, first percentile, mean. One thread each but Open3D.
"""

import sys
import time

import numpy as np
import open3d
import pymeshlab
import trimesh
import twelvefold
from scipy.spatial import cKDTree


def of_length_1(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-300)[:, None]


def distances(points, normals, area):
    distance, neighbor = cKDTree(points).query(points, k=12)
    facing = (normals[neighbor] * normals[:, None]).sum(axis=2) > 0
    facing[:, 0] = False
    nearest = np.where(facing, distance, np.inf).min(axis=1)
    return nearest[np.isfinite(nearest)] / np.sqrt(2 * area / (np.sqrt(3) * len(points)))


def contenders(vertices, faces, n):
    """Names, how often each is timed, and what makes points and normals."""
    corners = vertices[faces]
    normals = of_length_1(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))

    def ours(steps):
        points, on, _ = twelvefold.mesh_points(vertices, faces, n, relax=steps)
        return points, normals[on]

    def disks(exact):
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
        meshes.generate_sampling_poisson_disk(samplenum=n, exactnumflag=exact)
        made = meshes.current_mesh()
        return made.vertex_matrix(), of_length_1(made.vertex_normal_matrix())

    scene = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(vertices), open3d.utility.Vector3iVector(faces)
    )
    scene.compute_triangle_normals()

    def cloud(made):
        return np.asarray(made.points), np.asarray(made.normals)

    def evened():
        mesh = trimesh.Trimesh(vertices, faces, process=False)
        points, on = trimesh.sample.sample_surface_even(mesh, n, seed=1)
        return np.asarray(points), normals[on]

    for steps in (0, 10, 30, 60):
        yield f"twelvefold, relax={steps}", 3, lambda steps=steps: ours(steps)
    yield "PyMeshLab, Poisson disk", 2, lambda: disks(False)
    yield "PyMeshLab, exactnumflag", 1, lambda: disks(True)
    yield "Open3D, sample elimination", 2, lambda: cloud(
        scene.sample_points_poisson_disk(n, init_factor=5, use_triangle_normal=True)
    )
    yield "Open3D, white", 3, lambda: cloud(
        scene.sample_points_uniformly(n, use_triangle_normal=True)
    )
    yield "trimesh, even", 2, evened


def main(arguments):
    counts = [int(argument) for argument in arguments if argument.isdigit()]
    for path in (argument for argument in arguments if not argument.isdigit()):
        mesh = trimesh.load(path, process=False, force="mesh")
        vertices, faces = np.array(mesh.vertices, "float64"), np.array(mesh.faces, "int32")
        for n in counts:
            print(f"{path}: {len(faces)} triangles, {n} points asked for")
            for name, rounds, make in contenders(vertices, faces, n):
                least = np.inf
                for _ in range(rounds):
                    start = time.perf_counter()
                    points, normals = make()
                    least = min(least, time.perf_counter() - start)
                nearest = distances(points, normals, mesh.area)
                low, mean = np.percentile(nearest, 1), nearest.mean()
                print(
                    f"  {name:28} {len(points):7} points {1000 * least:9.1f} ms"
                    f"  {nearest.min():.3f} {low:.3f} {mean:.3f}",
                    flush=True,
                )


if __name__ == "__main__":
    main(sys.argv[1:])
