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


def test_seamless_points_repeat_without_a_seam():
    copies = [(i, j) for i in range(3) for j in range(3)]
    for importance, wish in [
        (None, dict(n=3000)),
        (None, dict(n=3000, relaxed=False)),
        (2 + np.sin(np.arange(32 * 32).reshape(32, 32) * (2 * np.pi / 32)), dict(n=3000)),
    ]:
        domain = (0, 0, 1, 1)
        tile = twelvefold.sample(importance, domain=domain, seamless=True, dtype="f8", **wish)
        nine = np.concatenate([tile + copy for copy in copies])
        within = twelvefold.measure(nine, window=(1.2, 1.2, 0.6, 0.6))
        # Thin about the borders of the tile in the middle.
        for window in [(0.97, 0.5, 0.06, 2), (1.97, 0.5, 0.06, 2), (0.5, 1.97, 2, 0.06)]:
            across = twelvefold.measure(nine, window=window)
            assert across["nearest_mean"] > 0.9 * within["nearest_mean"]
            assert across["points"] > 300
    bordered = twelvefold.sample(n=3000, dtype="f8")
    nine = np.concatenate([bordered + copy for copy in copies])
    across = twelvefold.measure(nine, window=(0.97, 0.5, 0.06, 2))
    assert across["nearest_least"] < 0.3


def test_seamless_numbers_are_exact_and_placements_kept():
    for n in [0, 1, 37, 1000]:
        assert len(twelvefold.sample(n=n, domain=(5, 0, 3, 2), seamless=True)) == n
    wide = np.ones((40, 60))
    placement = twelvefold.Placement((0, 0, 60, 40), seed=3, seamless=True)
    assert placement.seamless and not twelvefold.Placement().seamless
    assert placement != twelvefold.Placement((0, 0, 60, 40), seed=3)
    assert repr(placement) == "Placement((0.0, 0.0, 60.0, 40.0), seed=3, seamless=True)"
    for same in (placement, pickle.loads(pickle.dumps(placement))):
        assert same == placement and hash(same) == hash(placement)
        expected = twelvefold.sample(wide, 500, seed=3, seamless=True)
        assert (same.sample(wide, 500) == expected).all()
        expected = twelvefold.exactly(wide, 100, seed=3, seamless=True)
        assert all((a == b).all() for a, b in zip(same.exactly(wide, 100), expected))
    assert not (twelvefold.exactly(wide, 100, seed=3)[0] == expected[0]).all()
    with pytest.raises(ValueError, match="density is 10, .*seamless"):
        twelvefold.Placement(density=10, seamless=True)
    # As 2 to 7.
    assert len(twelvefold.Placement((0, 0, 1, 3.5), seamless=True).sample(n=9)) == 9
    with pytest.raises(ValueError, match="whole numbers up to 16"):
        twelvefold.Placement((0, 0, 1, 40), seamless=True)


def test_points_on_a_mesh_follow_area_and_density_evenly():
    # A grid bent into a quarter of a cylinder, of unit area, and four times as dense at one end.
    y, x = np.mgrid[:31, :31] / 30
    angle = x * np.pi / 2
    radius = 2 / np.pi
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), y], axis=2).reshape(-1, 3)
    corner = (np.arange(30)[:, None] * 31 + np.arange(30)).reshape(-1, 1)
    faces = (corner + [0, 1, 32, 0, 32, 31]).reshape(-1, 3)
    density = 1 + 3 * y.ravel()
    for relax in [0, 10]:
        points, on, weights = twelvefold.mesh_points(
            vertices, faces, 2000, density=density, relax=relax
        )
        assert points.shape == weights.shape == (2000, 3) and on.shape == (2000,)
        assert points.dtype == weights.dtype == np.float64 and on.dtype == np.int64
        corners = vertices[faces[on]].astype("float32")
        assert np.allclose((corners * weights[:, :, None]).sum(axis=1), points, atol=1e-7)
        assert (weights >= 0).all() and np.allclose(weights.sum(axis=1), 1)
        # ∫ 1 + 3y over the upper half of 5/2 in all.
        assert abs((points[:, 2] > 0.5).sum() - 2000 * 1.625 / 2.5) < 15
    flat = np.stack([np.arctan2(points[:, 1], points[:, 0]) * radius, points[:, 2]], axis=1)
    even = twelvefold.measure(flat, importance=None, window=(0.1, 0.9, 0.8, 0.05))
    assert even["nearest_mean"] > 0.75
    seeds = [twelvefold.mesh_points(vertices, faces, 100, seed=seed)[0] for seed in (1, 2)]
    assert not (seeds[0] == seeds[1]).any()
    assert twelvefold.mesh_points(vertices, faces, 0)[0].shape == (0, 3)


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
    wish = dict(exact=True, relaxed=False, refine=0)
    beginning = twelvefold.stipple(camera, 100, **wish)
    assert (twelvefold.stipple(camera, 200, **wish)[:100] == beginning).all()


def test_parts_of_a_picture_one_after_the_other_are_the_whole():
    # More dots than a cell has: there are 4.
    n = 1_100_000
    y, x = np.mgrid[:150, :200]
    picture = (x * y % 251).astype("uint8")
    wish = dict(refine=0, seed=3, invert=True)
    whole = twelvefold.stipple(picture, n, **wish)
    assert abs(len(whole) / n - 1) < 0.02
    for count in [1, 3, 5]:
        parts = [twelvefold.stipple(picture, n, part=(i, count), **wish) for i in range(count)]
        assert sorted(map(len, parts))[-1] < (0.6 if count > 1 else 1.1) * n
        assert np.concatenate(parts).tobytes() == whole.tobytes()


def test_transparent_parts_get_no_dots():
    image = np.zeros((20, 20, 4), "uint8")
    image[:, 10:, 3] = 255
    assert twelvefold.stipple(image, 200)[:, 0].min() >= 10
    gray = image[:, :, ::3]
    assert (twelvefold.stipple(gray, 200) == twelvefold.stipple(image, 200)).all()


def test_levels_and_light_change_the_tone():
    # Encoded .5 has .214 of white's light.
    image = np.ones((40, 40))
    image[:, :20] = 0.5
    image[:20, 20:] = 0

    def share(**keywords):
        dots = twelvefold.stipple(image, 3000, refine=0, **keywords)
        return (dots[:, 0] < 20).mean()

    def expected(darkness):
        return 2 * darkness / (2 * darkness + 1)

    for keywords, darkness in [
        ({}, 0.5),
        ({"linear": True}, 0.786),
        ({"gamma": 2}, 1 - 0.5**0.5),
        ({"black": 0.25}, 2 / 3),
        ({"white": 0.75}, 1 / 3),
        ({"white": 0.5}, 0),
        ({"black": 0.5}, 1),
    ]:
        assert abs(share(**keywords) - expected(darkness)) < 0.015, keywords


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
