"""Where robots end, by the reference that the package must match."""

import csv
from pathlib import Path

FILE = Path(__file__).parents[1] / "data" / "endpoints.csv"


def reference_endpoints():
    """Of each walk: the maze, the number of steps, the controller and the cell in which the robot ends."""
    with FILE.open() as file:
        for row in csv.DictReader(file):
            controller = [float(row[f"p{i}"]) for i in range(1, 17)]
            yield row["maze"], int(row["steps"]), controller, (int(row["row"]), int(row["column"]))
