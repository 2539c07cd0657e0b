"""The repertoire: for every cell where a robot of the run has ended, the latest solution that ended there.

The paper takes parents from the present generation. Parents from the repertoire keep every place that has been reached
within reach: without judges this is MAP-Elites on end points (Mouret and Clune, 2015) in which every newcomer replaces
the one before it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from safe.kernel import kernel

POOLS = ("generation", "repertoire")  # from which parents are taken
GENERATION, REPERTOIRE = range(len(POOLS))


class Repertoire(NamedTuple):
    """Solutions and where they end, in the order in which their cells were first reached; changed in place."""

    genomes: np.ndarray  # float64, (places, 16)
    endpoints: np.ndarray  # int64, (places, 2): row and column
    place_of: np.ndarray  # int64, (height, width): the place of the solution that ends in a cell, -1 if there is none
    size: np.ndarray  # int64, (1,): places that are taken


def empty_repertoire(shape: tuple[int, int], weights: int) -> Repertoire:
    """A repertoire with a place for each cell of a maze; without places if the shape is (0, 0)."""
    places = shape[0] * shape[1]
    return Repertoire(
        genomes=np.zeros((places, weights)),
        endpoints=np.zeros((places, 2), dtype=np.int64),
        place_of=np.full(shape, -1),
        size=np.zeros(1, dtype=np.int64),
    )


def known(repertoire: Repertoire) -> tuple[np.ndarray, np.ndarray]:
    """Copies of the genomes, shape (n, 16), and the end points, shape (n, 2), in the order of discovery."""
    size = repertoire.size[0]
    return repertoire.genomes[:size].copy(), repertoire.endpoints[:size].copy()


# Compiled functions


@kernel
def keep_latest(repertoire: Repertoire, genomes: np.ndarray, endpoints: np.ndarray) -> None:
    """Put all solutions of a generation, in order, in the places of the cells where they end."""
    for i in range(len(genomes)):
        row, column = endpoints[i, 0], endpoints[i, 1]
        place = repertoire.place_of[row, column]
        if place < 0:
            place = repertoire.size[0]
            repertoire.place_of[row, column] = place
            repertoire.endpoints[place, 0] = row
            repertoire.endpoints[place, 1] = column
            repertoire.size[0] += 1
        for gene in range(genomes.shape[1]):
            repertoire.genomes[place, gene] = genomes[i, gene]
