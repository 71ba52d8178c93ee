"""What is wrong with an argument is said, with its name and its place; what is not is read."""

import numpy as np
import pytest
import twelvefold

NAN = float("nan")


@pytest.mark.parametrize(
    "importance, error, words",
    [
        (np.full((2, 3), np.nan), ValueError, r"importance\[0, 0\] is NaN"),
        (np.array([[1.0, 1.0], [1.0, -2.0]]), ValueError, r"importance\[1, 1\] is -2"),
        (np.array([[1.0, np.inf]]), ValueError, r"importance\[0, 1\] is inf"),
        (np.array([[1.0, 1e300]]), ValueError, r"importance\[0, 1\] is inf in float32"),
        (np.zeros((2, 2, 2)), ValueError, r"shape \(2, 2, 2\).*\(height, width\)"),
        (np.zeros(5), ValueError, r"shape \(5,\)"),
        (np.float64(3), ValueError, r"shape \(\)"),
        (np.zeros((0, 3)), ValueError, r"shape \(0, 3\)"),
        (np.zeros((2, 2)), ValueError, "zero everywhere"),
        (np.ones((2, 2), complex), TypeError, "importance has dtype complex128"),
        (np.array([["a"]]), TypeError, "importance has dtype <U1"),
        (np.array([[None]]), TypeError, "importance has dtype object"),
        (np.ma.masked_array([[1.0]], [[True]]), TypeError, "importance is a masked array"),
        ("photo.png", TypeError, "importance has dtype"),
    ],
)
def test_a_bad_importance_is_located(importance, error, words):
    with pytest.raises(error, match=words):
        twelvefold.sample(importance, 100)
    with pytest.raises(error, match=words.replace("zero everywhere", "0 points, not 100")):
        twelvefold.exactly(importance, 100)


@pytest.mark.parametrize(
    "keywords, error, words",
    [
        ({}, ValueError, "n or density"),
        ({"n": 10, "density": 1.0}, ValueError, "not both"),
        ({"n": -1}, ValueError, "-1"),
        ({"n": np.nan}, ValueError, "NaN"),
        ({"n": 1e300}, ValueError, "deepest level|limit"),
        ({"n": "ten"}, TypeError, "n is 'ten'; it should be a number"),
        ({"density": [1]}, TypeError, r"density is \[1\]; it should be a number"),
        ({"n": 10, "relaxed": "no"}, TypeError, "relaxed is 'no'; it should be True or False"),
        ({"n": 10, "ranks": 1}, TypeError, "ranks is 1; it should be True or False"),
        ({"n": 10, "dtype": "float16"}, ValueError, "float16"),
        ({"n": 10, "weights": True}, ValueError, "relaxed=False"),
        ({"n": 10, "weights": True, "relaxed": False, "dtype": "f4"}, ValueError, "float64"),
        ({"n": 10, "weights": True, "relaxed": False, "part": (0, 2)}, ValueError, "part"),
        ({"n": 10, "part": (3, 3)}, ValueError, r"no part 3 \(from 0\) of 3"),
        ({"n": 10, "part": (0, 0)}, ValueError, "no part 0"),
        ({"n": 10, "part": (-1, 2)}, ValueError, r"part\[0\] is -1"),
        ({"n": 10, "part": (0, 2, 3)}, TypeError, r"part should be two .*\(i, count\)"),
        ({"n": 10, "part": 1}, TypeError, "part should be two"),
        ({"n": 10, "domain": (0, 0, 0, 1)}, ValueError, "domain is .0.0, 0.0, 0.0, 1.0.: "),
        ({"n": 10, "domain": (0, NAN, 1, 1)}, ValueError, "domain"),
        ({"n": 10, "domain": (0, 1)}, TypeError, r"domain should be four .*\(x, y, width, height\)"),
        ({"n": 10, "domain": "unit"}, TypeError, "domain should be four"),
        ({"n": 10, "seed": -1}, ValueError, "seed is -1"),
        ({"n": 10, "seed": 2**64}, ValueError, "seed is 18446744073709551616"),
        ({"n": 10, "seed": 1.5}, TypeError, "seed is 1.5"),
        ({"n": 10, "domain": (1e9 + 3, 0, 1, 1)}, ValueError, "precision"),
        ({"n": 10, "seamless": 1}, TypeError, "seamless is 1; it should be True or False"),
        ({"n": 10, "seamless": True, "domain": (0, 0, 17, 1)}, ValueError, "whole numbers.* 17 to 1 "),
        (
            {"n": 10, "seamless": True, "importance": np.ones((512, 513))},
            ValueError,
            "whole numbers up to 16, which 513 to 512 are not",
        ),
    ],
)
def test_bad_keywords_are_refused(keywords, error, words):
    with pytest.raises(error, match=words):
        twelvefold.sample(**keywords)


@pytest.mark.parametrize(
    "image, keywords, error, words",
    [
        (np.full((4, 4), 255, "uint8"), {}, ValueError, "image is white"),
        (np.zeros((4, 4)), {"invert": True}, ValueError, "image is black"),
        (np.array([[0.5, NAN]]), {}, ValueError, r"image\[0, 1\] is NaN"),
        (np.array([[0.5], [1.5]]), {}, ValueError, r"image\[1, 0\] is 1.5; .*from 0 to 1"),
        (np.zeros((2, 2, 3)) - 1, {}, ValueError, r"image\[0, 0, 0\] is -1"),
        (np.zeros((4, 4), "int64"), {}, TypeError, "image has dtype int64; uint8"),
        (np.zeros((4, 4, 5)), {}, ValueError, r"image has shape \(4, 4, 5\)"),
        (np.zeros((4, 4, 1)), {}, ValueError, r"image has shape \(4, 4, 1\)"),
        (np.zeros((4, 0)), {}, ValueError, r"image has shape \(4, 0\)"),
        (np.zeros((4, 4)), {"n": -3}, ValueError, "n is -3"),
        (np.zeros((4, 4)), {"n": 2.5}, TypeError, "n is 2.5"),
        (np.zeros((4, 4)), {"n": 2**40}, ValueError, "n is 1099511627776"),
        (np.zeros((4, 4)), {"exact": 100}, TypeError, "exact is 100; it should be True or False"),
        (np.zeros((4, 4)), {"refine": -1}, ValueError, "refine is -1"),
        (np.zeros((4, 4)), {"refine": 1001}, ValueError, "refine is 1001.*0 to 1000"),
        (np.zeros((4, 4)), {"best": True, "refine": 0}, ValueError, "best .*refine=0"),
        (np.zeros((4, 4)), {"part": (0, 2)}, ValueError, "part.* refine=0"),
        (np.zeros((4, 4)), {"part": (0, 2), "refine": 0, "exact": True}, ValueError, "exact"),
        (np.zeros((4, 4)), {"part": (0, 2), "refine": 0, "relaxed": False}, ValueError, "fixed centers"),
        (np.zeros((4, 4)), {"part": (2, 2), "refine": 0}, ValueError, r"no part 2 \(from 0\) of 2"),
        (np.zeros((4, 4)), {"part": (0, 0), "refine": 0}, ValueError, "no part 0"),
        (np.zeros((4, 4)), {"part": (-1, 2), "refine": 0}, ValueError, r"part\[0\] is -1"),
        (np.zeros((4, 4)), {"part": (0, 1.5), "refine": 0}, TypeError, r"part\[1\] is 1.5"),
        (np.zeros((4, 4)), {"part": 1, "refine": 0}, TypeError, "part should be two"),
        (np.zeros((4, 4)), {"linear": "yes"}, TypeError, "linear is 'yes'"),
        (np.zeros((4, 4)), {"gamma": 0}, ValueError, "gamma is 0; .*above 0"),
        (np.zeros((4, 4)), {"gamma": NAN}, ValueError, "gamma is NaN"),
        (np.zeros((4, 4)), {"gamma": None}, TypeError, "gamma is None"),
        (np.zeros((4, 4)), {"white": 250}, ValueError, "white is 250; .*from 0 to 1"),
        (np.zeros((4, 4), "u1"), {"white": 256}, ValueError, "white is 256; .*from 0 to 255"),
        (np.zeros((4, 4), "u2"), {"black": -1}, ValueError, "black is -1; .*from 0 to 65535"),
        (np.zeros((4, 4), "u1"), {"black": NAN}, ValueError, "black is NaN"),
        (np.zeros((4, 4)), {"black": 0.5, "white": 0.5}, ValueError, "black is 0.5, not below white"),
        (np.full((4, 4), 251, "u1"), {"white": 250}, ValueError, "image is white"),
    ],
)
def test_a_bad_picture_is_refused(image, keywords, error, words):
    with pytest.raises(error, match=words):
        twelvefold.stipple(image, **{"n": 10, **keywords})


def sky(**at):
    light = np.ones((4, 8, 3))
    for value in at.values():
        light[2, 5, 1] = value
    return light


@pytest.mark.parametrize(
    "light, keywords, error, words",
    [
        (sky(nan=NAN), {}, ValueError, r"map\[2, 5, 1\] is NaN.*nan='zero'"),
        (sky(infinite=np.inf), {}, ValueError, r"map\[2, 5, 1\] is inf.*infinite="),
        (sky(negative=-1), {}, ValueError, r"map\[2, 5, 1\] is -1.*negative='zero'"),
        (sky() * 0, {}, ValueError, "map is black"),
        (np.ones((4, 8)), {}, ValueError, r"map has shape \(4, 8\)"),
        (np.ones((0, 8, 3)), {}, ValueError, r"map has shape \(0, 8, 3\)"),
        (sky(), {"method": "best"}, ValueError, "method is 'best'; .*'sobol'"),
        (sky(), {"frame": "z"}, ValueError, "frame is 'z'; .*'blender'"),
        (sky(), {"rotate": NAN}, ValueError, "rotate"),
        (sky(), {"rotate": "up"}, TypeError, "rotate is 'up'"),
        (sky(), {"frame": None}, TypeError, "frame is None"),
        (sky(), {"infinite": []}, TypeError, "infinite is"),
        (sky(), {"infinite": -1.0}, ValueError, "infinite is -1"),
        (sky(), {"infinite": "big"}, ValueError, "infinite is 'big'"),
        (sky(), {"nan": "no"}, ValueError, "nan is 'no'"),
        (sky(), {"filter": "bilinear", "method": "warp"}, ValueError, "sobol"),
    ],
)
def test_a_bad_environment_is_refused(light, keywords, error, words):
    for method in ["sobol", "progressive", "warp"]:
        with pytest.raises(error, match=words):
            twelvefold.environment(light, 10, **{"method": method, **keywords})


def test_policies_say_what_bad_light_counts_as():
    for bad, keywords in [
        (NAN, {"nan": "zero"}),
        (-1, {"negative": "zero"}),
        (np.inf, {"infinite": "zero"}),
        (-np.inf, {"infinite": "zero", "negative": "zero"}),
    ]:
        expected = twelvefold.environment(sky(value=0.0), 20)
        found = twelvefold.environment(sky(value=bad), 20, **keywords)
        assert all((a == b).all() for a, b in zip(expected, found))
    expected = twelvefold.environment(sky(value=7.0), 20)
    found = twelvefold.environment(sky(value=np.inf), 20, infinite=7)
    assert all((a == b).all() for a, b in zip(expected, found))


@pytest.mark.parametrize(
    "points, keywords, words",
    [
        (np.zeros((3, 3)), {}, r"points has shape \(3, 3\)"),
        (np.array([[0.5, 0.5], [NAN, 0.5]]), {}, r"points\[1, 0\] is NaN"),
        (np.array([[0.5, 0.5]]), {}, "two are needed"),
        (np.array([[0.5, 0.5]] * 2), {"window": (0, 0, -1, 1)}, "window"),
        (np.array([[0.5, 0.5]] * 2), {"importance": np.array([[NAN]])}, r"importance\[0, 0\]"),
    ],
)
def test_bad_points_are_refused(points, keywords, words):
    with pytest.raises(ValueError, match=words):
        twelvefold.measure(points, **keywords)


SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
HALVES = [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    "keywords, error, words",
    [
        ({"vertices": [[0, 0]]}, ValueError, r"vertices has shape \(1, 2\).*\(vertices, 3\)"),
        ({"vertices": [["a", "b", "c"]]}, TypeError, "vertices has dtype <U1"),
        ({"vertices": [[0, NAN, 0]] + SQUARE[1:]}, ValueError, r"vertices\[0\], a corner of faces\[0\]"),
        ({"vertices": SQUARE[:3] + [[1e300, 0, 0]]}, ValueError, r"vertices\[3\].*faces\[1\].*inf"),
        ({"vertices": [[0, 0, 0]] * 4}, ValueError, "no triangle with area"),
        ({"faces": [[0, 1, 2, 3]]}, ValueError, r"faces has shape \(1, 4\).*\(faces, 3\)"),
        ({"faces": [[0.0, 1.0, 2.0]]}, TypeError, "faces has dtype float64; integers"),
        ({"faces": [[0, 1, 2], [0, 4, 2]]}, ValueError, r"faces\[1, 1\] is 4, .* 4 rows"),
        ({"faces": [[0, 1, -1]]}, ValueError, r"faces\[0, 2\] is -1"),
        ({"faces": np.array([[2**63, 1, 2]], "u8")}, ValueError, r"faces\[0, 0\] is 9223"),
        ({"faces": np.zeros((0, 3), int)}, ValueError, "no triangle with area"),
        ({"density": [1, 2, 3]}, ValueError, r"density has shape \(3,\).*\(4,\), one for each vertex"),
        ({"density": [1, 2, -3, 4]}, ValueError, r"density\[2\], at a corner of faces\[0\], is -3"),
        ({"density": [1, 2, 3, NAN]}, ValueError, r"density\[3\], at a corner of faces\[1\], is NaN"),
        ({"density": [0, 0, 0, 0]}, ValueError, "both area and density"),
        ({"n": 1.5}, TypeError, "n is 1.5"),
        ({"relax": -1}, ValueError, "relax is -1.*0 to 1000"),
        ({"relax": True, "seed": "a"}, TypeError, "seed is 'a'"),
    ],
)
def test_a_bad_mesh_is_refused(keywords, error, words):
    with pytest.raises(error, match=words):
        twelvefold.mesh_points(**{"vertices": SQUARE, "faces": HALVES, "n": 10, **keywords})


def test_what_no_face_names_may_be_anything():
    expected = twelvefold.mesh_points(SQUARE, HALVES, 50, density=[1, 2, 3, 4])
    found = twelvefold.mesh_points(
        SQUARE + [[NAN, 0, np.inf]], HALVES, 50, density=[1, 2, 3, 4, NAN]
    )
    assert all((a == b).all() for a, b in zip(expected, found))


def unaligned(array):
    bytes = np.zeros(array.nbytes + 1, "uint8")
    view = bytes[1:].view(array.dtype).reshape(array.shape)
    view[...] = array
    return view


def layouts(array):
    """The same numbers, otherwise stored."""
    padded = np.zeros([2 * size for size in array.shape], array.dtype)
    strided = padded[tuple(slice(None, None, 2) for _ in array.shape)]
    strided[...] = array
    read_only = array.copy()
    read_only.setflags(write=False)
    yield from (read_only, np.asfortranarray(array), array[::-1].copy()[::-1], strided)
    yield from (unaligned(array), array.astype(array.dtype.newbyteorder()))


@pytest.mark.parametrize("dtype", ["bool", "u1", "i2", "i8", "u8", "f2", "f4", "f8", "longdouble"])
def test_every_real_dtype_and_layout_of_importance_is_read(dtype):
    image = np.arange(12).reshape(3, 4) % 2
    expected = twelvefold.sample(image.astype("float32"), 500)
    for same in [*layouts(image.astype(dtype)), image.astype(dtype).tolist()]:
        assert (twelvefold.sample(same, 500) == expected).all()


@pytest.mark.parametrize("dtype", ["u1", "u2", "f4", "f8"])
@pytest.mark.parametrize("channels", [(), (2,), (3,), (4,)])
def test_every_layout_of_a_picture_is_read(dtype, channels):
    random = np.random.default_rng(1)
    image = random.random((9, 7, *channels)) * (1 if dtype[0] == "f" else 200)
    image = image.astype(dtype)
    expected = twelvefold.stipple(image, 100)
    for same in layouts(image):
        assert (twelvefold.stipple(same, 100) == expected).all()


def test_every_layout_of_light_and_points_is_read():
    light = np.random.default_rng(2).random((4, 8, 3))
    expected = twelvefold.environment(light, 10)
    for same in layouts(light):
        assert all((a == b).all() for a, b in zip(twelvefold.environment(same, 10), expected))
    points = np.random.default_rng(3).random((50, 2))
    for same in layouts(points):
        assert twelvefold.measure(same) == twelvefold.measure(points)


@pytest.mark.parametrize("dtype", ["i1", "u2", "i4", "u4", "i8", "u8"])
def test_every_layout_of_a_mesh_is_read(dtype):
    vertices, faces = np.array(SQUARE, "f8") / 3, np.array(HALVES, dtype)
    expected = twelvefold.mesh_points(vertices.astype("f4"), HALVES, 50)
    for corners, triples in zip(layouts(vertices), layouts(faces)):
        found = twelvefold.mesh_points(corners, triples, 50)
        assert all((a == b).all() for a, b in zip(expected, found))


def test_inputs_are_left_alone_and_outputs_are_the_callers():
    image = np.random.default_rng(5).random((8, 8))
    before = image.copy()
    dots = twelvefold.stipple(image, 50)
    assert (image == before).all()
    dots += 1
    assert dots.flags.writeable and dots.flags.c_contiguous


def test_rectangles_and_parts_are_any_sequences():
    expected = twelvefold.sample(n=100, domain=(1, 2, 3, 4), part=(0, 2))
    for sequence in (list, np.array, iter):
        same = twelvefold.sample(n=100, domain=sequence([1, 2, 3, 4]), part=sequence([0, 2]))
        assert (same == expected).all()
