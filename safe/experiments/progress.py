"""Progress bars, shown in a terminal or a notebook but never in a log."""

from __future__ import annotations

from tqdm import tqdm

from safe.kernel import is_watched


def bar(description: str, progress: bool = True, **options: object) -> tqdm:
    """A tqdm bar with these options of tqdm; silent without `progress`, or if nobody watches."""
    return tqdm(desc=description, disable=not (progress and is_watched()), mininterval=0.5, **options)
