"""Well-spread points with a density you control, and photographs as dots.

Points come from a dodecagonal aperiodic tiling whose tables are inside this package. The same arguments
give the same points, bit for bit, on every machine and for any number of threads, and the same as the
Rust library and the program ``twelvefold``.

=================  ==============================================================
`stipple`          dots that draw a picture
`sample`           about n points whose density follows an importance
`exactly`          n points, every beginning of which is a good set, with weights
`Placement`        a domain and a seed, kept across calls
`environment`      directions towards the light of an environment map
`mesh_points`      exactly n points on a triangle mesh
`measure`          how even points are
=================  ==============================================================

Arrays of importance are ``(height, width)``: how many points are wanted at each pixel, in any unit; only
ratios matter where a number of points is asked for. Row 0 is at the top. Positions are ``(points, 2)``:
x to the right and y down the rows, in pixels, unless a domain is given; ``image[int(y), int(x)]`` is the
pixel under a point.

Work is done by several threads without Python's lock (``RAYON_NUM_THREADS`` says by how many), and
Ctrl-C ends it within a second.

>>> import numpy as np, twelvefold
>>> points = twelvefold.sample(np.array([[0.0, 1.0], [1.0, 3.0]]), 1000)
>>> points.shape[1], points.dtype
(2, dtype('float32'))
"""

from ._api import Placement, environment, exactly, measure, mesh_points, sample, stipple
from ._native import __version__

__all__ = [
    "Placement",
    "environment",
    "exactly",
    "measure",
    "mesh_points",
    "sample",
    "stipple",
    "__version__",
]

# Where everybody finds them, for `help()` and error messages.
for _public in (Placement, environment, exactly, measure, mesh_points, sample, stipple):
    _public.__module__ = __name__
del _public
