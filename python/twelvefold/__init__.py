"""Well-spread points with a density you control.

Points come from a dodecagonal aperiodic tiling whose tables are inside this package. The same arguments
give the same points, bit for bit, on every machine, and the same as the Rust library and the program.

Arrays of importance are ``(height, width)``: how many points are wanted at each pixel, in any unit; only
ratios matter where a number of points is asked for. Row 0 is at the top. Positions are ``(points, 2)``,
x to the right and y down the rows, in pixels, unless a domain is given.

>>> import numpy as np, twelvefold
>>> points = twelvefold.sample(np.array([[0.0, 1.0], [1.0, 3.0]]), 1000)
>>> points.shape[1], points.dtype
(2, dtype('float32'))
"""

from ._api import Placement, environment, exactly, sample
from ._native import __version__

__all__ = ["Placement", "environment", "exactly", "sample", "__version__"]
