# The pictures of python/README.md, cell by cell: open it as a notebook (Jupyter, VS Code), or run it:
#
#     pip install ./python[examples] && python python/examples/pictures.py

# %%
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import twelvefold
from PIL import Image

REPOSITORY = Path(__file__).resolve().parents[2]
PICTURES = REPOSITORY / "python" / "pictures"


def panels(count, width, height):
    figure, axes = plt.subplots(1, count, figsize=(width, height), layout="constrained")
    for axis in np.atleast_1d(axes):
        axis.set(xticks=[], yticks=[], aspect="equal")
    return figure, axes


def dots(axis, points, size, shape, **style):
    """Draws points in pixels over an image of this shape, y down."""
    style = {"color": "black", "linewidths": 0, **style}
    axis.scatter(points[:, 0], points[:, 1], s=size, **style)
    axis.set(xlim=(0, shape[1]), ylim=(shape[0], 0))


def save(figure, name):
    path = PICTURES / name
    figure.savefig(path, dpi=110)
    plt.close(figure)
    # A few grays say as much as all of them.
    Image.open(path).convert("RGB").quantize(32).save(path, optimize=True)


# %% [markdown]
# ## A photograph, as dots
# `stipple` takes what Pillow gives: gray or color, 8 or 16 bits, with or without transparency.

# %%
photograph = np.asarray(Image.open(REPOSITORY / "examples/photographs/camera.png"))
stippled = twelvefold.stipple(photograph, 8000)
figure, (left, right) = panels(2, 8, 4)
left.imshow(photograph, cmap="gray", vmin=0, vmax=255, extent=(0, 512, 512, 0))
# As large as makes black black: the dots' areas add up to the picture's darkness.
points_of_a_pixel = 72 * 3.7 / 512
area = (1 - photograph / 255).sum() / len(stippled)
dots(right, stippled, 4 / np.pi * area * points_of_a_pixel**2, photograph.shape)
right.set_title(f"{len(stippled):,} dots", fontsize=9)
left.set_title("512 × 512 pixels", fontsize=9)
save(figure, "photograph.png")

# %% [markdown]
# ## Points of a density
# Relaxed points are even at every density. Unrelaxed ones are an unbiased sample, of which more only add to
# fewer. White noise beside them.

# %%
y, x = np.mgrid[:300, :300] / 300
density = np.exp(-12 * ((x - 0.5) ** 2 + (y - 0.5) ** 2)) + 0.03
relaxed = twelvefold.sample(density, 2000)
fixed = twelvefold.sample(density, 2000, relaxed=False)
random = np.random.default_rng(0)
white = random.random((40_000, 2)) * 300
white = white[random.random(40_000) * density.max() < density[tuple(white.astype(int).T[::-1])]][:2000]
figure, axes = panels(3, 9, 3.4)
for axis, points, title in zip(axes, (relaxed, fixed, white), ("relaxed", "not relaxed", "white")):
    dots(axis, points, 3, density.shape)
    nearest = twelvefold.measure(points, importance=density)["local_nearest_mean"]
    axis.set_title(f"{title}: mean nearest distance {nearest:.2f}", fontsize=9)
save(figure, "density.png")

# %% [markdown]
# ## A placement kept from frame to frame
# Where the importance stays, points stay; where it rises, points are only added.

# %%
placement = twelvefold.Placement((0, 0, 300, 300), seed=5)
figure, axes = panels(3, 9, 3.4)
before = np.empty((0, 2))
for axis, center in zip(axes, (0.3, 0.45, 0.6)):
    frame = 0.15 + np.exp(-40 * ((x - center) ** 2 + (y - 0.5) ** 2))
    points = placement.sample(frame, density=0.04, relaxed=False)
    kept = {tuple(point) for point in before}
    stayed = np.array([tuple(point) in kept for point in points])
    dots(axis, points[stayed], 3, frame.shape, color="0.6")
    dots(axis, points[~stayed], 4, frame.shape)
    title = f"{stayed.sum()} stayed, {(~stayed).sum()} are new"
    axis.set_title(title if before.size else f"{len(points)} points", fontsize=9)
    before = points
save(figure, "frames.png")

# %% [markdown]
# ## A tile that repeats
# `seamless=True` leaves the domain no border. Nine copies, of which the outer ones are cut; ticks in the
# margin tell where they meet.

# %%
u, v = 2 * np.pi * x, 2 * np.pi * y
waves = 1.1 + 0.5 * (np.cos(u + np.sin(2 * v)) + np.cos(v - np.sin(u)))
figure, axes = panels(2, 8, 4)
for axis, seamless in zip(axes, (True, False)):
    tile = twelvefold.sample(waves, 1500, seed=7, seamless=seamless)
    nine = np.concatenate([tile + [300 * i, 300 * j] for i in range(3) for j in range(3)])
    dots(axis, nine, 5, (900, 900))
    axis.set(xlim=(190, 710), ylim=(710, 190))
    axis.set(xticks=[300, 600], yticks=[300, 600], xticklabels=[], yticklabels=[])
    axis.set_title("seamless" if seamless else "with a border", fontsize=9)
save(figure, "seamless.png")

# %% [markdown]
# ## On a mesh
# A ring of 24,000 triangles, seen from above; points are four times as dense on the right as on the left.

# %%
along, around = np.meshgrid(np.arange(400), np.arange(30), indexing="ij")
turn, angle = 2 * np.pi * along / 400, 2 * np.pi * around / 30
radius = 1 + 0.45 * np.cos(angle)
vertices = np.stack([radius * np.cos(turn), radius * np.sin(turn), 0.45 * np.sin(angle)], axis=-1)
vertices = vertices.reshape(-1, 3)
corner = 30 * along + around
right, below = np.roll(corner, -1, axis=1), np.roll(corner, -1, axis=0)
across = np.roll(right, -1, axis=0)
faces = np.stack([corner, below, across, corner, across, right], axis=-1).reshape(-1, 3)
density = 2.4 + vertices[:, 0]
figure, axes = panels(2, 9, 4)
for axis, relax in zip(axes, (0, 10)):
    points, on, weights = twelvefold.mesh_points(
        vertices, faces, 6000, density=density, relax=relax
    )
    above = points[points[:, 2] > 0]
    axis.scatter(above[:, 0], above[:, 1], s=2.5, color="black", linewidths=0)
    axis.set_title(f"relax={relax}", fontsize=9)
save(figure, "mesh.png")

# %% [markdown]
# ## Towards the light
# Directions in proportion to the radiance of a sky with a low sun, over the map.

# %%
row, column = np.mgrid[:128, :256]
height = np.cos(np.pi * (row + 0.5) / 128)
sky = np.where(height > 0, 0.3 + 0.7 * (1 - height), 0.05)[..., None] * [0.5, 0.7, 1.0]
distance = np.hypot(row - 50, column - 80)
sky += (40 * np.exp(-((distance / 5) ** 2)))[..., None] * [1.0, 0.9, 0.7]
figure, axes = panels(3, 9, 2.0)
for axis, method in zip(axes, ("sobol", "progressive", "warp")):
    directions, pdf, radiance = twelvefold.environment(sky, 500, method=method)
    axis.imshow((sky / (1 + sky)) ** 0.45, extent=(0, 256, 128, 0))
    phi = np.arctan2(directions[:, 1], directions[:, 0]) % (2 * np.pi)
    theta = np.arccos(directions[:, 2])
    place = np.stack([phi / (2 * np.pi) * 256, theta / np.pi * 128], axis=1)
    dots(axis, place, 1.5, (128, 256))
    up = (radiance[:, 2] * directions[:, 2].clip(0) / pdf).mean()
    axis.set_title(f"{method}: {up:.3f} falls on the ground", fontsize=9)
save(figure, "light.png")
