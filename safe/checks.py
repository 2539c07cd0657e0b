"""Checks of what users pass in, made once, before any compiled function sees it.

Every failed check is a ValueError that names the argument, what it must be, and what it was.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from numbers import Integral, Real

import numpy as np

MOST = 1_000_000  # of anything that is counted or stored: keeps a mistyped size from filling the memory


def shown(value: object) -> str:
    """The value as an error message shows it: its repr, cut where it is long."""
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."


def integer(name: str, value: object, low: int, high: int | None = None) -> int:
    """`value` as an int in low..high, both included; no upper bound where `high` is None."""
    allowed = f"from {low} to {high}" if high is not None else f"of at least {low}"
    is_integer = isinstance(value, Integral) and not isinstance(value, bool)
    if not is_integer or value < low or (high is not None and value > high):
        raise ValueError(f"{name} must be an integer {allowed}; was {shown(value)}")
    return int(value)


def probability(name: str, value: object) -> float:
    """`value` as a float in [0, 1]."""
    is_real = isinstance(value, Real) and not isinstance(value, bool)
    if not is_real or not 0 <= value <= 1:
        raise ValueError(f"{name} must be a number from 0 to 1; was {shown(value)}")
    return float(value)


def choice(name: str, value: object, allowed: Collection[str]) -> str:
    """`value`, which must be one of the strings in `allowed`."""
    if not isinstance(value, str) or value not in allowed:
        options = ", ".join(repr(option) for option in allowed)
        raise ValueError(f"{name} must be one of {options}; was {shown(value)}")
    return value


def array(
    name: str,
    value: object,
    shape: tuple[int | None, ...],
    low: float = -math.inf,
    high: float = math.inf,
    *,
    or_empty: bool = False,
) -> np.ndarray:
    """`value` as a C-ordered float64 array of this shape (None: any length), finite, in [low, high].

    With `or_empty` an empty list is an array of this shape, too.
    """
    try:
        converted = np.array(value, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} must be an array of numbers; was {shown(value)}") from None
    if or_empty and converted.shape == (0,):
        return converted.reshape(0, *shape[1:])
    fits = converted.ndim == len(shape) and all(
        wanted is None or wanted == length for wanted, length in zip(shape, converted.shape, strict=True)
    )
    if not fits:
        wanted = ", ".join("any" if length is None else str(length) for length in shape)
        raise ValueError(f"{name} must have the shape ({wanted}); was of shape {converted.shape}")
    wrong = ~(np.isfinite(converted) & (converted >= low) & (converted <= high))
    if wrong.any():
        index = tuple(int(i) for i in np.argwhere(wrong)[0])
        bounds = "" if math.isinf(low) and math.isinf(high) else f" and in [{low:g}, {high:g}]"
        raise ValueError(f"{name} must be finite{bounds}; was {converted[index]} at index {index}")
    return converted
