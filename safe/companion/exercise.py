"""Checks of the exercises in notebooks: what a student has not written yet is no error."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps


def check(test: Callable[[], None]) -> Callable[[], None]:
    """Let a check say how it went: "Not yet." if what it checks is unwritten, "Right." if all its assertions hold.

    A function is unwritten as long as it raises `NotImplementedError`. An assertion that fails is an error as usual, so
    its message should help.

    Examples
    --------
    >>> def double(number):
    ...     raise NotImplementedError
    >>> @check
    ... def check_double():
    ...     assert double(2) == 4, f"double(2) should be 4, and is {double(2)}"
    >>> check_double()
    Not yet. A function is still to be written.
    >>> def double(number):
    ...     return number + number
    >>> check_double()
    Right.
    """

    @wraps(test)
    def checked() -> None:
        try:
            test()
        except NotImplementedError:
            print("Not yet. A function is still to be written.")
        else:
            print("Right.")

    return checked
