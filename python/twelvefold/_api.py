"""The functions of the package: documentation and defaults; the work is done in ``_native``."""

import numpy as np

from . import _native


def stipple(
    image,
    n,
    *,
    refine=10,
    best=False,
    exact=False,
    relaxed=True,
    seed=0,
    part=None,
    invert=False,
    linear=False,
    black=0,
    white=None,
    gamma=1.0,
):
    """Dots of one size that draw a picture, dense where it is dark.

    Parameters
    ----------
    image : array (height, width), or (height, width, channels) of 2, 3 or 4
        Brightness, gray or red, green and blue, and perhaps coverage (alpha): uint8 from 0 to 255,
        uint16 from 0 to 65535, floats from 0 to 1, or bool. Numbers are followed as they are: those of a
        photograph's file look right, and so does what ``numpy.asarray`` makes of a Pillow image of mode
        L, LA, RGB or RGBA. Black and opaque gets the most dots, white and transparent none.
    n : int
        How many dots. About as many are made, within 1 % at 20,000, unless `exact`.
    refine : int, 0 to 1000
        How often the dots are moved to draw the picture better; 10 are enough for most, and take some
        3 microseconds a dot. 0 leaves them where the tiling puts them.
    best : bool
        Move the refined dots once more, each to the center of a cell that holds as much of the picture as
        every other: the best there is, in about four times the time.
    exact : bool
        Exactly n dots, instead of about as many.
    relaxed : bool
        Begin with dots that are evenly spread at every density. Without it they begin at the centers of
        tiles, where more only ever add to fewer; with ``exact=True, refine=0`` they then come in an order
        of which each beginning is itself a good stippling.
    seed : int, 0 to 2**64 - 1
        Chooses which of many equally good arrangements is made.
    part : (i, count), optional
        Only part ``i`` of ``count``, from 0, with ``refine=0``: all parts one after the other are the whole, bit
        for bit. For several machines. Parts are made of cells of some million dots, so that pictures of
        fewer are all in the last part.
    invert : bool
        Put dots where the picture is light, to be drawn white on black.
    linear : bool
        Follow light instead of the numbers, which are taken as encoded in sRGB: averaged over an area,
        the dots then reflect as much light as the picture. Numbers that are light already are followed
        without it.
    black, white : float
        What counts as black and as white, in the image's own numbers: ``white=250`` for paper of uint8
        that was scanned a little gray, 0.98 for floats. By default 0 and the largest.
    gamma : float
        Lighten (above 1) or darken the middle: brightness from 0 to 1, after `black` and `white`, is
        raised to 1/gamma.

    Returns
    -------
    array (dots, 2) of float32
        x and y in pixels: x to the right, y down from the upper left corner.

    Raises
    ------
    ValueError
        For a picture that is blank, or not an image; a bad pixel is named by row and column.
    TypeError
        For a dtype or an argument of another kind.

    Notes
    -----
    The same dots as ``twelvefold stipple photo.png -o dots.npy -n N`` (or ``--exact N``) writes for a
    file with these pixels, its options as the ones here; its levels are of 255. Memory: some 100 bytes a dot and 20 a pixel while dots are refined.

    Examples
    --------
    >>> import numpy as np, twelvefold
    >>> ramp = np.tile(np.linspace(0, 1, 200), (100, 1))
    >>> dots = twelvefold.stipple(ramp, 500, exact=True)
    >>> dots.shape, dots.dtype
    ((500, 2), dtype('float32'))
    >>> bool((dots[:, 0] < 100).mean() > 0.7)
    True

    On one of four machines:

    >>> dots = twelvefold.stipple(ramp, 500, refine=0, part=(2, 4))
    """
    return _native.stipple(
        image, n, refine, best, exact, relaxed, seed, part, invert, linear, black, white, gamma
    )


def sample(
    importance=None,
    n=None,
    *,
    density=None,
    relaxed=True,
    domain=None,
    seed=0,
    seamless=False,
    dtype=None,
    weights=False,
    ranks=False,
    part=None,
):
    """About ``n`` points whose density follows ``importance``.

    Parameters
    ----------
    importance : array (height, width), optional
        Finite and not negative; of any real dtype and layout. Without it, density is uniform.
    n : float
        About how many points: the number over all seeds is exactly this, and one seed's is within a
        fraction of a percent for thousands of points.
    density : float
        Instead of `n`: points in a unit of area where importance is 1.
    relaxed : bool
        Move points aside so that they are even at every density (for pictures and scattering). Without
        it they are an unbiased sample; more points, by n or importance, only ever add to fewer.
    domain : (x, y, width, height), optional
        The half-open rectangle that receives points, over which the importance is stretched. By default
        the image's pixels, ``(0, 0, width, height)``, or the unit square.
    seed : int, 0 to 2**64 - 1
        Chooses which of many equally good sets is made.
    seamless : bool
        Points without a border: opposite sides of the domain are one, and copies of the points side by
        side in rows and columns show no seam, if the importance shows none. The domain's sides must be as
        k to l, whole numbers up to 16 (1:1, 3:2, 16:9 …). Uniform density gets exactly n points. Where
        density is below that of 780·k·l points, they are not relaxed: choose small k and l.
    dtype : 'float32' or 'float64'
        Of the positions. By default float32; with weights, float64.
    weights : bool
        Return weights: the sum of ``f(point) * weight`` estimates the integral of f over the domain,
        without bias. With ``relaxed=False`` only.
    ranks : bool
        Return ranks: each point's place in the endless sequence of the seed and domain, the same at
        every density. Among uniform points those of the lowest ranks are a good set themselves.
    part : (i, count), optional
        Only part ``i`` of ``count``, from 0: all parts one after the other are the whole, bit for bit.
        For several processes.

    Returns
    -------
    array (points, 2) of `dtype`
        Or, if weights or ranks are asked for, a tuple of it, of weights (points,) of float64, and of
        ranks (points,) of uint64.

    Raises
    ------
    ValueError, TypeError
        For arguments that mean nothing; a bad pixel is named by row and column.

    Examples
    --------
    >>> import numpy as np, twelvefold
    >>> 900 < len(twelvefold.sample(n=1000)) < 1100
    True

    The integral of x·y over the unit square, 1/4:

    >>> points, weights = twelvefold.sample(n=4096, relaxed=False, weights=True)
    >>> bool(abs((points[:, 0] * points[:, 1] * weights).sum() - 0.25) < 0.01)
    True

    A tile that repeats, 3 times in each direction, and how near points come to each other over its borders,
    in the hexagonal lattice's distances:

    >>> tile = twelvefold.sample(n=780, seamless=True)
    >>> nine = np.concatenate([tile + [i, j] for i in range(3) for j in range(3)])
    >>> len(tile), twelvefold.measure(nine, window=(0.9, 0.9, 1.2, 1.2))["nearest_least"] > 0.95
    (780, True)

    In four processes:

    >>> parts = [twelvefold.sample(n=1000, part=(i, 4)) for i in range(4)]
    >>> bool((np.concatenate(parts) == twelvefold.sample(n=1000)).all())
    True
    """
    double = _is_double(dtype, weights)
    return _native.sample(
        None, domain, seed, seamless, importance, n, density, relaxed, double, weights, ranks, part
    )


def exactly(importance=None, n=None, *, domain=None, seed=0, seamless=False):
    """Exactly ``n`` points in progressive order: every beginning of the list is itself a good set.

    Parameters
    ----------
    importance, domain, seed, seamless
        As for `sample`.
    n : int
        How many.

    Returns
    -------
    points : array (n, 2) of float64
    weights : array (n,) of float64
        The sum of ``f(point) * weight`` estimates the integral of f over the domain. Of the first k
        points alone, multiply weights by n/k.

    Examples
    --------
    >>> import twelvefold
    >>> points, weights = twelvefold.exactly(n=100)
    >>> points.shape, round(float(weights.sum()), 6)
    ((100, 2), 1.0)
    >>> bool((twelvefold.exactly(n=50)[0] == points[:50]).all())
    True
    """
    return _native.exactly(None, domain, seed, seamless, importance, _needed(n))


class Placement:
    """A domain and a seed, kept across calls.

    A placement fixes an endless sequence of points in its domain, dense everywhere, each with a rank; an
    importance decides how far into the sequence each place goes. So frames of one placement are coherent:
    where the importance does not change, the points stay.

    Parameters
    ----------
    domain : (x, y, width, height)
        The half-open rectangle that receives points. Importance is stretched over it.
    seed : int, 0 to 2**64 - 1
        Chooses which of many equally good sequences it is.
    density : float, optional
        Of which the points, in a unit of area, are to be a complete level of the tiling: far more even,
        with ``relaxed=False``, than at other densities.
    seamless : bool
        The domain has no border: as for `sample`. Not with `density`.

    Examples
    --------
    >>> import numpy as np, twelvefold
    >>> placement = twelvefold.Placement((0, 0, 64, 48), seed=7)
    >>> dim = placement.sample(np.full((48, 64), 0.5), density=1, relaxed=False)
    >>> bright = placement.sample(np.full((48, 64), 1.0), density=1, relaxed=False)
    >>> set(map(tuple, dim)) < set(map(tuple, bright))
    True
    """

    __slots__ = ("_arguments", "_native")

    def __init__(self, domain=(0.0, 0.0, 1.0, 1.0), seed=0, *, density=None, seamless=False):
        self._native = _native.Placement(domain, seed, density, seamless)
        self._arguments = (self._native.domain, int(seed), density, bool(seamless))

    @property
    def domain(self):
        """(x, y, width, height) of the half-open rectangle that receives points."""
        return self._arguments[0]

    @property
    def seed(self):
        """Which of many equally good sequences it is."""
        return self._arguments[1]

    @property
    def density(self):
        """Points in a unit of area of a complete level, if one was asked for."""
        return self._arguments[2]

    @property
    def seamless(self):
        """Whether opposite sides of the domain are one."""
        return self._arguments[3]

    def sample(
        self,
        importance=None,
        n=None,
        *,
        density=None,
        relaxed=True,
        dtype=None,
        weights=False,
        ranks=False,
        part=None,
    ):
        """About ``n`` points of this placement: as the function `sample`."""
        double = _is_double(dtype, weights)
        return _native.sample(
            self._native, None, 0, False, importance, n, density, relaxed, double, weights, ranks, part
        )

    def exactly(self, importance=None, n=None):
        """Exactly ``n`` points of this placement and their weights: as the function `exactly`."""
        return _native.exactly(self._native, None, 0, False, importance, _needed(n))

    def __repr__(self):
        density = "" if self.density is None else f", density={self.density}"
        seamless = ", seamless=True" if self.seamless else ""
        return f"Placement({self.domain}, seed={self.seed}{density}{seamless})"

    def __eq__(self, other):
        return isinstance(other, Placement) and self._arguments == other._arguments

    def __hash__(self):
        return hash(self._arguments)

    def __reduce__(self):
        return _remade, self._arguments


def _remade(domain, seed, density, seamless):
    return Placement(domain, seed, density=density, seamless=seamless)


def environment(
    map,
    n,
    *,
    method="sobol",
    frame="pbrt",
    rotate=0.0,
    seed=0,
    filter="nearest",
    negative="reject",
    infinite="reject",
    nan="reject",
):
    """``n`` directions towards the light of an environment map.

    The light that falls on a surface with this normal is estimated by the mean over all directions of
    ``radiance * max(0, direction @ normal) / pdf``.

    Parameters
    ----------
    map : array (height, width, 3)
        Linear red, green and blue radiance of a latitude-longitude image, row 0 at the zenith.
    n : int
        How many, at most 2**32.
    method : 'sobol', 'progressive' or 'warp'
        'sobol': scrambled Sobol points, warped: the least error for any number, and each beginning is
        itself a good set, best with 2**k directions. 'progressive': the tiling's points, thresholded by
        the map, in an order of which each beginning is a good set; where the map does not change, neither
        do its directions. 'warp': a complete level of the tiling, warped, in no useful order.
    frame : 'pbrt', 'mitsuba', 'blender', 'gltf' or 'openexr'
        Which way the image faces. pbrt: z up, left-handed, the image's center is -x, right of it -y.
        mitsuba, openexr (and USD): y up, the center is +z, right of it -x. blender: z up, +x, -y.
        gltf (and three.js): y up, +x, +z.
    rotate : float
        Degrees by which the surroundings are turned about the frame's up axis.
    seed : int, 0 to 2**64 - 1
        Chooses which of many equally good sets is made.
    filter : 'nearest' or 'bilinear'
        How the map is read between its pixels' centers; 'bilinear' for 'sobol' only.
    negative, nan : 'reject' or 'zero'
        What a negative component, or one that is not a number, counts as: an error, or 0.
    infinite : 'reject', 'zero', or float
        The same of infinite ones; a number counts instead.

    Returns
    -------
    directions : array (n, 3) of float64
        Of length 1, towards the light.
    pdf : array (n,) of float64
        Probability density per steradian.
    radiance : array (n, 3) of float32
        Red, green and blue, in the map's units.

    Raises
    ------
    ValueError
        For a map that is black, or has components that are no radiance: the first is named by row,
        column and channel.

    Examples
    --------
    >>> import numpy as np, twelvefold
    >>> sky = np.full((32, 64, 3), 0.5)
    >>> directions, pdf, radiance = twelvefold.environment(sky, 256)
    >>> irradiance = (radiance[:, 0] * directions[:, 2].clip(0) / pdf).mean()
    >>> bool(abs(irradiance - 0.5 * np.pi) < 0.01)
    True
    """
    return _native.environment(
        map, n, method, frame, rotate, seed, filter, negative, infinite, nan
    )


def mesh_points(vertices, faces, n, *, density=None, relax=10, seed=0):
    """Exactly ``n`` points on a triangle mesh, even along its surface.

    Parameters
    ----------
    vertices : array (vertices, 3)
        Positions in any unit, read as float32: move a mesh that lies far from the origin near it before.
        Vertices at the same place count as one where points go from face to face.
    faces : array (faces, 3) of integers
        The rows of `vertices` at each triangle's corners. Triangles without area get no points.
    n : int
        How many.
    density : array (vertices,), optional
        How many points are wanted at each vertex, in any unit: finite and not negative, linear over each
        face. Without it, all of the surface is equally dense.
    relax : int, 0 to 1000
        How often the points push each other along the surface, about half a microsecond a point each.
        10 are enough for most, 30 for the rest. After 0 points are an unbiased sample, as random ones
        are, but with the share of n that is due in every face, to within a point.
    seed : int, 0 to 2**64 - 1
        Chooses which of many equally good sets is made.

    Returns
    -------
    points : array (n, 3) of float64
        Positions, in the unit of the vertices.
    faces : array (n,) of int64
        The row of `faces` on which each point lies.
    barycentrics : array (n, 3) of float64
        Weights of that face's corners, none negative, 1 in all:
        ``(normals[faces[on]] * weights[:, :, None]).sum(axis=1)`` interpolates what is given at vertices.

    Raises
    ------
    ValueError, TypeError
        For a face without its vertex, a coordinate or density that is no number, a mesh without area:
        the first is named by its row.

    Examples
    --------
    >>> import numpy as np, twelvefold
    >>> square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> faces = np.array([[0, 1, 2], [0, 2, 3]])
    >>> points, on, weights = twelvefold.mesh_points(square, faces, 500)
    >>> points.shape, on.shape, weights.shape
    ((500, 3), (500,), (500, 3))
    >>> bool(np.allclose((square[faces[on]] * weights[:, :, None]).sum(axis=1), points))
    True
    """
    return _native.mesh_points(vertices, faces, n, density, relax, seed)


def measure(points, *, window=None, importance=None):
    """How even points are; with an importance, also how well they follow it.

    Parameters
    ----------
    points : array (points, 2)
        Those outside of the window serve as neighbors only.
    window : (x, y, width, height), optional
        The half-open rectangle in which points are measured: by default the importance's pixels, or
        the unit square.
    importance : array (height, width), optional
        What the points should follow, over its own pixels.

    Returns
    -------
    dict of float
        `points` in the window; `star_discrepancy_at_least` and `star_discrepancy_at_most`, equal up to
        16,384 points; `l2_star_discrepancy`; `nearest_least`, `nearest_first_percentile` and
        `nearest_mean`, distances to the nearest point where the hexagonal lattice's is 1;
        `low_frequency_power`, below half the principal frequency, where white noise is 1: up to
        65,536 points. With an importance, `block_variance`, the variance of counts in blocks of 64
        points, where Poisson is 1, and distances in units of the local lattice's,
        `local_nearest_mean` and `local_nearest_first_percentile`. A measure that short lists
        and narrow windows do not have is left out.

    Examples
    --------
    >>> import numpy as np, twelvefold
    >>> even = twelvefold.measure(twelvefold.sample(n=1000))
    >>> white = twelvefold.measure(np.random.default_rng(0).random((1000, 2)))
    >>> even["nearest_mean"] > 0.8 > 0.5 > white["nearest_mean"]
    True
    """
    return _native.measure(points, window, importance)


def _is_double(dtype, weights):
    """Whether positions are of float64."""
    if dtype is None:
        return bool(weights)
    name = np.dtype(dtype).name
    if name not in ("float32", "float64"):
        raise ValueError(f"dtype is {name}; it should be float32 or float64")
    return name == "float64"


def _needed(n):
    """n, which has a default only because importance, before it, has one."""
    if n is None:
        raise TypeError("n, the number of points, is missing")
    return n
