"""What is wrong with an argument is said, with its place."""

import numpy as np
import pytest
import twelvefold


@pytest.mark.parametrize(
    "importance, error, words",
    [
        (np.full((2, 3), np.nan), ValueError, r"importance\[0, 0\] is NaN"),
        (np.array([[1.0, 1.0], [1.0, -2.0]]), ValueError, r"importance\[1, 1\] is -2"),
        (np.array([[1.0, np.inf]]), ValueError, r"importance\[0, 1\] is inf"),
        (np.zeros((2, 2, 2)), ValueError, r"shape \[2, 2, 2\].*\(height, width\)"),
        (np.zeros(5), ValueError, r"shape \[5\]"),
        (np.zeros((0, 3)), ValueError, "no pixels"),
        (np.zeros((2, 2)), ValueError, "zero everywhere"),
        (np.ones((2, 2), complex), TypeError, "dtype complex128"),
        (np.array([["a"]]), TypeError, "dtype"),
        ("photo.png", TypeError, "dtype"),
    ],
)
def test_a_bad_importance_is_located(importance, error, words):
    with pytest.raises(error, match=words):
        twelvefold.sample(importance, 100)


@pytest.mark.parametrize(
    "keywords, words",
    [
        ({}, "n or density"),
        ({"n": 10, "density": 1.0}, "not both"),
        ({"n": -1}, "-1"),
        ({"n": np.nan}, "NaN"),
        ({"n": 1e300}, "deepest level|limit"),
        ({"n": 10, "dtype": "float16"}, "float16"),
        ({"n": 10, "weights": True}, "relaxed=False"),
        ({"n": 10, "part": (3, 3)}, "part"),
        ({"n": 10, "domain": (0, 0, 0, 1)}, "domain"),
        ({"n": 10, "domain": (0, np.nan, 1, 1)}, "domain"),
    ],
)
def test_bad_keywords_are_refused(keywords, words):
    with pytest.raises(ValueError, match=words):
        twelvefold.sample(**keywords)


@pytest.mark.parametrize("dtype", ["uint8", "int16", "float32", "float64", "bool", ">f4"])
def test_every_real_dtype_and_layout_is_read(dtype):
    image = np.arange(12).reshape(3, 4) % 2
    expected = twelvefold.sample(image.astype("float32"), 500)
    array = image.astype(dtype)
    array.setflags(write=False)
    for same in (array, np.asfortranarray(array), array[::-1][::-1], array.tolist()):
        assert (twelvefold.sample(same, 500) == expected).all()
