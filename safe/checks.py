"""Checks of what users pass in, made once, before any compiled function sees it.

A failed check raises a ValueError that names the argument, says what it must be, and shows what it got.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from numbers import Integral, Real

import numpy as np

MOST = 1_000_000  # of anything counted or stored: keeps a mistyped size from filling the memory
LARGEST = 1e100  # magnitude of any number in an array, so that sums of squares stay finite


def shown(value: object) -> str:
    """The value as an error message shows it: its repr on one line, cut if it is long."""
    try:
        text = re.sub(r"\s*\n\s*", " ", repr(value))
    except Exception:  # of an integer with thousands of digits, of a list in thousands of lists, of a broken class
        text = f"a value of type {type(value).__name__}"
    return text if len(text) <= 80 else text[:77] + "..."


def reason(error: Exception) -> str:
    """The message of another library's error, as ours quote it: on one line, cut if it is long."""
    return " ".join(str(error).split())[:100]


def is_text(value: object) -> bool:
    """Is this a non-empty text without control characters, which a title, a page and a database can show?"""
    return isinstance(value, str) and value != "" and value.isprintable()


def text(name: str, value: object) -> str:
    """`value`, which must be a text (see `is_text`)."""
    if not is_text(value):
        raise ValueError(f"{name} must be a text of printable characters; got {shown(value)}")
    return value


def integer(name: str, value: object, low: int, high: int | None = None) -> int:
    """`value` as an int in low..high, both included; no upper bound if `high` is None."""
    allowed = f"from {low} to {high}" if high is not None else f"of at least {low}"
    # numpy counts its durations among the integers
    is_integer = isinstance(value, Integral) and not isinstance(value, bool | np.timedelta64)
    if not is_integer or value < low or (high is not None and value > high):
        raise ValueError(f"{name} must be an integer {allowed}; got {shown(value)}")
    return int(value)


def number(name: str, value: object, low: int, high: int) -> float:
    """`value` as a float in [low, high]."""
    is_real = isinstance(value, Real) and not isinstance(value, bool)
    if not is_real or not low <= value <= high:
        raise ValueError(f"{name} must be a number from {low} to {high}; got {shown(value)}")
    return float(value)


def choice(name: str, value: object, allowed: Collection[str]) -> str:
    """`value`, which must be one of the strings in `allowed`."""
    if not isinstance(value, str) or value not in allowed:
        options = ", ".join(repr(option) for option in allowed)
        raise ValueError(f"{name} must be one of {options}; got {shown(value)}")
    return value


def choices(name: str, value: object, allowed: Collection[str]) -> tuple[str, ...]:
    """`value` as a tuple; it must be a sequence of at least one of the strings in `allowed`, each at most once."""
    chosen = tuple(value) if isinstance(value, Sequence) and not isinstance(value, str) else ()
    if not chosen or any(not isinstance(one, str) or one not in allowed or chosen.count(one) > 1 for one in chosen):
        options = ", ".join(repr(option) for option in allowed)
        raise ValueError(f"{name} must be some of {options}, each at most once; got {shown(value)}")
    return chosen


def array(
    name: str,
    value: object,
    shape: tuple[int | None, ...],
    low: float = -LARGEST,
    high: float = LARGEST,
    *,
    or_empty: bool = False,
) -> np.ndarray:
    """`value` as a C-ordered float64 array of this shape (None: any length), finite, in [low, high].

    With `or_empty`, an empty list is accepted as an array of this shape without rows.
    """
    try:
        given = np.asarray(value)
        if not _are_numbers(given):
            raise TypeError
        with np.errstate(over="ignore"):  # a long double may become infinite, which is refused below
            converted = np.array(given, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} must be an array of numbers; got {shown(value)}") from None
    if or_empty and converted.shape == (0,):
        return converted.reshape(0, *shape[1:])
    fits = converted.ndim == len(shape) and all(
        wanted is None or wanted == length for wanted, length in zip(shape, converted.shape, strict=True)
    )
    if not fits:
        wanted = ", ".join("any" if length is None else str(length) for length in shape)
        raise ValueError(f"{name} must have the shape ({wanted}); got shape {converted.shape}")
    wrong = ~(np.isfinite(converted) & (converted >= low) & (converted <= high))
    if wrong.any():
        index = tuple(int(i) for i in np.argwhere(wrong)[0])
        raise ValueError(f"{name} must be finite and in [{low:g}, {high:g}]; got {converted[index]} at index {index}")
    return converted


def _are_numbers(given: np.ndarray) -> bool:
    """Are these real numbers already? numpy would also convert texts and times, and truncate complex numbers."""
    if given.dtype.kind == "O":
        return all(isinstance(element, Real) for element in given.flat)
    return given.dtype.kind in "biuf"
