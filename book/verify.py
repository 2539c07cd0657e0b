"""Repeat a sample of the stored runs and of the recorded evidence, which must give the same results.

    python book/verify.py                the project's store
    python book/verify.py my.sqlite      another

Whatever differs is an error, and stops `make book`.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import safe
from isolated import ROOT
from safe.companion import evidence, peers
from safe.companion.project import STORE

SAMPLE = 5  # runs of a store


def main() -> None:
    parser = argparse.ArgumentParser(description="Repeat a sample of the stored runs and of the recorded evidence.")
    parser.add_argument("store", nargs="?", type=Path, default=ROOT / STORE, help=f"default: {STORE} of the project")
    store = parser.parse_args().store
    if store.exists():
        try:
            same = safe.verify(store, SAMPLE, progress=False)
        except safe.StoreError as error:
            sys.exit(f"the stored results cannot be trusted: {error}")
        others = sum(same.sources != "same")
        said = f", although {others} of them were made from other or unknown sources of the science" if others else ""
        print(f"{len(same)} stored runs, drawn at random, were repeated and gave the same results{said}", flush=True)
    try:
        runs, traces = evidence.verify()
        runs += peers.verify()
    except ValueError as error:
        sys.exit(f"the recorded evidence cannot be trusted: {error}")
    said = f"{runs} recorded run{'s' * (runs != 1)} and {traces} recorded trace{'s' * (traces != 1)}"
    print(f"{said}, drawn at random, were repeated and gave the same results", flush=True)


if __name__ == "__main__":
    main()
