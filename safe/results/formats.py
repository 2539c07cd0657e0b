"""Numbers as tables show them: each kind in one form, a dash if there is no number."""

from __future__ import annotations

import math

DASH = "–"


def count(successes: float, n: float) -> str:
    """A count of successes.

    Examples
    --------
    >>> count(326, 500), count(math.nan, math.nan)
    ('326 of 500', '–')
    """
    return _show("{:.0f} of {:.0f}", successes, n)


def p_value(p: float) -> str:
    """A value of p: three decimals below 0.1, two above.

    Examples
    --------
    >>> p_value(0.0004), p_value(0.0461), p_value(0.654), p_value(math.nan)
    ('< 0.001', '0.046', '0.65', '–')
    """
    return "< 0.001" if p < 0.001 else _show("{:.3f}" if p < 0.1 else "{:.2f}", p)


def mean_and_sd(mean: float, sd: float, digits: int) -> str:
    """A mean, with its standard deviation in parentheses.

    Examples
    --------
    >>> mean_and_sd(0.85, 0.164, 2)
    '0.85 (0.16)'
    """
    return _show(f"{{:.{digits}f}} ({{:.{digits}f}})", mean, sd)


def difference_of_means(difference: float, low: float, high: float, digits: int) -> str:
    """A difference of means of so many digits, with its interval; a fraction gets a digit more than its means.

    Examples
    --------
    >>> difference_of_means(8.4, -13.2, 27.9, 0), difference_of_means(0.0176, -0.0056, 0.0409, 2)
    ('+8 (-13 to +28)', '+0.018 (-0.006 to +0.041)')
    """
    signed = f"{{:+.{digits + bool(digits)}f}}"
    return _show(f"{signed} ({signed} to {signed})", difference, low, high)


def difference_of_rates(difference: float, low: float, high: float) -> str:
    """A difference of rates with its interval, in percentage points; a digit more for what would round to zero.

    Examples
    --------
    >>> difference_of_rates(0.0178, 0.0004, 0.0351)
    '+1.8 (+0.04 to +3.5)'
    """
    if math.isnan(difference + low + high):
        return DASH
    points = (100 * value for value in (difference, low, high))
    return "{} ({} to {})".format(*(f"{p:+.1f}" if round(p, 1) or not p else f"{p:+.2f}" for p in points))


def _show(template: str, *values: float) -> str:
    return DASH if any(map(math.isnan, values)) else template.format(*values)
