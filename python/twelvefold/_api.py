"""The functions of the package: documentation and defaults; the work is done in ``_native``."""

from . import _native
from ._native import Placement


def sample(
    importance=None,
    n=None,
    *,
    density=None,
    relaxed=True,
    domain=None,
    seed=0,
    dtype="float32",
    weights=False,
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
        Instead of ``n``: points a unit of area where importance is 1.
    relaxed : bool
        Move points aside so that they are even at every density (for pictures and scattering). Without
        it they are an unbiased sample whose beginnings, by rank, are samples too.
    domain : (x, y, width, height), optional
        The rectangle that receives points, half-open. By default the image's pixels,
        ``(0, 0, width, height)``, or the unit square.
    seed : int
        Chooses which of many equally good sets is taken.
    dtype : 'float32' or 'float64'
        Of the positions.
    weights : bool
        Return ``(points, weights)``: the sum of ``f(point) * weight`` estimates the integral of f.
        With ``relaxed=False`` only.
    part : (i, count), optional
        Only part ``i`` of ``count``, from 0: all parts one after the other are the whole, in the same
        order. For several processes.

    Returns
    -------
    array (points, 2)

    Raises
    ------
    ValueError, TypeError
        For arguments that mean nothing; a bad pixel is named by row and column.

    Examples
    --------
    >>> import twelvefold
    >>> len(twelvefold.sample(n=1000)) > 900
    True
    """
    return _native.sample(
        importance, n, density, relaxed, domain, seed, dtype, weights, part
    )


def exactly(importance=None, n=0, *, domain=None, seed=0):
    """Exactly ``n`` points in progressive order: every beginning of the list is itself a good set.

    Parameters
    ----------
    importance, domain, seed
        As for :func:`sample`.
    n : int
        How many.

    Returns
    -------
    points : array (n, 2) of float64
    weights : array (n,) of float64
        The sum of ``f(point) * weight`` estimates the integral of f.

    Examples
    --------
    >>> import twelvefold
    >>> points, weights = twelvefold.exactly(n=100)
    >>> points.shape, round(float(weights.sum()), 6)
    ((100, 2), 1.0)
    """
    return _native.exactly(importance, n, domain, seed)


def environment(map, n, *, method="progressive", seed=0, negative="reject"):
    """``n`` directions towards the light of an environment map.

    Parameters
    ----------
    map : array (height, width, 3)
        Linear red, green and blue radiance, latitude-longitude, row 0 at the zenith.
    n : int
        How many.
    method : 'progressive' or 'warp'
        Every beginning a good set, or the least error for this number.
    negative : 'reject' or 'zero'
        What to do with negative radiance.

    Returns
    -------
    directions : array (n, 3) of float64
        Of length 1, z up; column 0, a quarter, half and three quarters of the width are +x, +y, -x, -y.
    pdf : array (n,) of float64
        Probability density per steradian. Light on a surface is the mean of radiance * cosine / pdf.
    radiance : array (n, 3) of float32
    """
    return _native.environment(map, n, method, seed, negative)
