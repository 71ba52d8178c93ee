"""Arguments mean what they say."""

import copy
import pickle

import numpy as np
import pytest
import twelvefold

IMAGE = (np.arange(64 * 48) % 97).reshape(48, 64).astype("float32")


def test_points_lie_where_importance_is():
    half = np.zeros((10, 20))
    half[:, 10:] = 1
    points = twelvefold.sample(half, 2000)
    assert points.dtype == np.float32 and points.shape[1] == 2
    assert abs(len(points) - 2000) < 40
    assert points[:, 0].min() >= 10 and points[:, 0].max() < 20
    assert 0 <= points[:, 1].min() and points[:, 1].max() < 10


def test_seeds_differ():
    sets = [twelvefold.sample(IMAGE, 1000, seed=seed).tobytes() for seed in (0, 1, 2**64 - 1)]
    assert len(set(sets)) == 3
    assert sets[1] == twelvefold.sample(IMAGE, 1000, seed=np.int64(1)).tobytes()


@pytest.mark.parametrize("relaxed", [True, False])
@pytest.mark.parametrize("importance, n", [(IMAGE, 5000), (None, 200_000)])
@pytest.mark.parametrize("count", [1, 2, 7])
def test_parts_one_after_the_other_are_the_whole(relaxed, importance, n, count):
    wish = dict(relaxed=relaxed, seed=3, ranks=True)
    whole = twelvefold.sample(importance, n, **wish)
    parts = [twelvefold.sample(importance, n, part=(i, count), **wish) for i in range(count)]
    for all_of, column in zip(zip(*parts), whole):
        assert np.concatenate(all_of).tobytes() == column.tobytes()
    points = [
        twelvefold.sample(importance, n, relaxed=relaxed, seed=3, part=(i, count))
        for i in range(count)
    ]
    assert np.concatenate(points).tobytes() == whole[0].tobytes()


def test_a_kept_placement_gives_what_the_functions_give():
    placement = twelvefold.Placement((0, 0, 64, 48), seed=9)
    assert placement.seed == 9 and placement.domain == (0, 0, 64, 48)
    assert placement.density is None
    for same in (placement, pickle.loads(pickle.dumps(placement)), copy.deepcopy(placement)):
        assert same == placement and hash(same) == hash(placement)
        expected = twelvefold.sample(IMAGE, 1000, seed=9)
        assert (same.sample(IMAGE, 1000) == expected).all()
        expected = twelvefold.exactly(IMAGE, 100, seed=9)
        assert all((a == b).all() for a, b in zip(same.exactly(IMAGE, 100), expected))
    assert placement != twelvefold.Placement((0, 0, 64, 48), seed=8)
    assert repr(placement) == "Placement((0.0, 0.0, 64.0, 48.0), seed=9)"
    with pytest.raises(ValueError, match="domain"):
        twelvefold.Placement((0, 0, -1, 1))


def test_an_aligned_placement_has_a_complete_level():
    aligned = twelvefold.Placement(seed=1, density=5000)
    level = aligned.sample(density=5000, relaxed=False)
    between = twelvefold.sample(n=5000, relaxed=False, seed=1)
    least = [twelvefold.measure(points)["nearest_least"] for points in (level, between)]
    assert least[0] > 0.9 > least[1]
    assert pickle.loads(pickle.dumps(aligned)).density == 5000
    with pytest.raises(ValueError, match="density is -1"):
        twelvefold.Placement(density=-1)


def test_ranks_are_unique_and_the_same_at_every_density():
    few, few_ranks = twelvefold.sample(IMAGE, 300, relaxed=False, ranks=True)
    many, many_ranks = twelvefold.sample(IMAGE, 3000, relaxed=False, ranks=True)
    assert few_ranks.dtype == np.uint64 and len(set(few_ranks)) == len(few)
    places = dict(zip(many_ranks, map(tuple, many)))
    assert all(places[rank] == tuple(point) for rank, point in zip(few_ranks, few))


def test_weights_estimate_integrals():
    points, weights = twelvefold.sample(n=4096, relaxed=False, weights=True)
    assert points.dtype == np.float64
    assert abs((points[:, 0] * points[:, 1] * weights).sum() - 0.25) < 0.01
    with_ranks = twelvefold.sample(n=4096, relaxed=False, weights=True, ranks=True)
    assert len(with_ranks) == 3 and (with_ranks[0] == points).all()


def test_exactly_n_and_its_beginnings():
    points, weights = twelvefold.exactly(IMAGE, 1000)
    assert points.shape == (1000, 2) and weights.shape == (1000,)
    assert (twelvefold.exactly(IMAGE, 100)[0] == points[:100]).all()
    assert [len(column) for column in twelvefold.exactly(n=0)] == [0, 0]
    with pytest.raises(TypeError, match="n, the number of points"):
        twelvefold.exactly(IMAGE)


def test_density_and_domain():
    points = twelvefold.sample(density=100.0, domain=(-1, 5, 3, 2), dtype="float64")
    assert abs(len(points) - 600) < 30
    assert (points >= [-1, 5]).all() and (points < [2, 7]).all()


def test_nothing_is_an_array_too():
    assert twelvefold.sample(n=0).shape == (0, 2)
    assert twelvefold.stipple(np.ones((3, 3)), 0).shape == (0, 2)
    directions, pdf, radiance = twelvefold.environment(np.zeros((2, 4, 3)), 0)
    assert (directions.shape, pdf.shape, radiance.shape) == ((0, 3), (0,), (0, 3))


def test_dots_draw_the_picture(camera):
    dots = twelvefold.stipple(camera, 4000)
    assert dots.dtype == np.float32 and abs(len(dots) - 4000) < 100
    darkness = 1 - camera / 255
    blocks = darkness.reshape(8, 8, 8, 8).sum(axis=(1, 3)) * len(dots) / darkness.sum()
    counts = np.histogram2d(dots[:, 1], dots[:, 0], bins=8, range=[[0, 64], [0, 64]])[0]
    assert np.abs(counts - blocks).max() < 8
    exact = twelvefold.stipple(camera, 777, exact=True, refine=3)
    assert exact.shape == (777, 2)
    beginning = twelvefold.stipple(camera, 100, exact=True, refine=0)
    assert (twelvefold.stipple(camera, 200, exact=True, refine=0)[:100] == beginning).all()


def test_transparent_parts_get_no_dots():
    image = np.zeros((20, 20, 4), "uint8")
    image[:, 10:, 3] = 255
    assert twelvefold.stipple(image, 200)[:, 0].min() >= 10


@pytest.mark.parametrize("method", ["sobol", "progressive", "warp"])
def test_directions_follow_the_light(method):
    sky = np.full((16, 32, 3), 0.1)
    sky[3, 8] = 500.0
    directions, pdf, radiance = twelvefold.environment(sky, 256, method=method)
    assert directions.shape == (256, 3) and radiance.dtype == np.float32
    assert np.allclose(np.linalg.norm(directions, axis=1), 1)
    # A quarter of the width is +y.
    assert (radiance[:, 0] > 1).mean() > 0.8 and directions[:, 1].mean() > 0.3
    mean = (radiance[:, 0] / pdf).mean() / (4 * np.pi)
    assert abs(mean / 1.071 - 1) < 0.05
    # Blender's up is +z as well; what is +y in pbrt's coordinates is +y there.
    turned, _, _ = twelvefold.environment(sky, 256, method=method, frame="blender", rotate=180)
    assert turned[:, 1].mean() < -0.3


def test_measures_tell_even_from_white():
    even, white = twelvefold.sample(n=2000), np.random.default_rng(1).random((2000, 2))
    even, white = twelvefold.measure(even), twelvefold.measure(white)
    assert even["nearest_mean"] > 0.85 and abs(white["nearest_mean"] - 0.465) < 0.03
    assert even["low_frequency_power"] < 0.05 and abs(white["low_frequency_power"] - 1) < 0.3
    assert even["star_discrepancy_at_most"] < white["star_discrepancy_at_least"]
    followed = twelvefold.measure(twelvefold.sample(IMAGE, 2000), importance=IMAGE)
    assert followed["block_variance"] < 0.5
    short = twelvefold.measure(np.array([[0.1, 0.1], [0.9, 0.9]]))
    assert short["points"] == 2 and "low_frequency_power" not in short
