from fractions import Fraction

import numpy as np
import pytest

from safe import checks


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (np.eye(2), "array([[1., 0.], [0., 1.]])"),
        ("a\nb", r"'a\nb'"),
        ("x" * 500, "'" + "x" * 76 + "..."),
    ],
)
def test_a_value_is_shown_in_one_short_line(value, text):
    assert checks.shown(value) == text


def test_an_integer_of_more_digits_than_python_writes_is_shown_by_its_type():
    assert checks.shown(10**5000) == "a value of type int"
    assert checks.shown([10**5000]) == "a value of type list"
    with pytest.raises(ValueError, match="n must be an integer of at least 0; got a value of type int"):
        checks.integer("n", -(10**5000), 0)


@pytest.mark.parametrize("value", [10, np.timedelta64(3, "s"), np.timedelta64("NaT", "s"), True, 3.0, "3"])
def test_what_is_no_integer_in_the_range(value):
    with pytest.raises(ValueError, match="n must be an integer from 0 to 9; got"):
        checks.integer("n", value, 0, 9)


@pytest.mark.parametrize(
    "value",
    [
        np.array([1j]),  # numpy cuts the imaginary part off, with a warning
        ["1"],
        np.array(["1"]),
        np.array(["2020-01-01"], "M8[D]"),
        np.array([1], "m8[s]"),
        np.array([0.5, "1"], object),
        [10**30, 1j],
        [None],
        [10**5000],
        [[1], [1, 2]],
        {1, 2},
    ],
)
def test_what_is_no_array_of_numbers(value):
    with pytest.raises(ValueError, match="x must be an array of numbers; got"):
        checks.array("x", value, (None,))


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e308, -1e308, np.finfo(np.longdouble).max])
def test_numbers_whose_squares_are_not_finite(value):
    with pytest.raises(ValueError, match=r"x must be finite and in \[-1e\+100, 1e\+100\]; got .* at index \(0,\)"):
        checks.array("x", np.array([value]), (None,))


def test_numbers_of_all_kinds_make_an_array():
    for value in ([True, 2, 0.5], [Fraction(1), 2, 0.5], np.array([1, 2, 0.5], ">f4"), (1, 2, 0.5)):
        array = checks.array("x", value, (3,))
        assert array.tolist() == [1, 2, 0.5]
        assert array.dtype == np.float64


@pytest.mark.parametrize("value", ["", "a\nb", "\0", "\udcff", None, 7, b"a"])
def test_texts_that_cannot_be_shown_everywhere(value):
    with pytest.raises(ValueError, match="name must be a text of printable characters; got"):
        checks.text("name", value)
