import json
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import pytest

from safe.companion import contest, project, speed

mpl.use("agg")
MEASUREMENTS = Path(__file__).parents[2] / project.MEASUREMENTS


@pytest.fixture(scope="module")
def measured():
    return speed.read_measured(MEASUREMENTS)[0]


def test_the_machine_is_described_without_its_users():
    machine = speed.read_measured(MEASUREMENTS)[1]
    assert list(machine) == ["processor", "system", "packages", "measured"]
    assert all(machine.values())
    assert not {"node", "user", "commit_info"} & json.loads(MEASUREMENTS.read_text()).keys()
    assert "/" not in "".join(machine.values())


def test_by_default_the_measurements_are_those_of_the_project(tmp_path, monkeypatch, measured):
    monkeypatch.chdir(tmp_path)
    assert speed.read_measured("")[0].equals(measured)
    monkeypatch.setattr(project, "folder", lambda: None)
    with pytest.raises(
        ValueError, match=r"^measured must be .*; got '', for benchmarks/results.json of the project, but"
    ):
        speed.read_measured("")


def test_parts_add_up_to_a_generation(measured):
    """Roughly, since the machine also did other things; a part left out or counted twice would show."""
    table = speed.parts_table(measured)
    together = table.drop(columns="all").sum(axis=1)
    assert len(table) == 6
    assert (abs(together / table["all"] - 1) < 0.2).all()
    assert table.loc["maze1", "standard"].isna().sum() == 3


def test_peers_are_compared_with_this_package(measured):
    table = speed.peers_table(measured)
    assert (table.xs("safe", level="method").times_as_long == 1).all()
    assert len(table.xs("safe", level="method")) == 8
    row = table.loc["novelty, end point", "scipy cKDTree"]
    ours = table.loc["novelty, end point", "safe"]
    assert row.times_as_long == pytest.approx(row.microseconds / ours.microseconds)


def test_every_experiment_of_the_paper_has_its_cost(measured):
    table = speed.paper_table(measured)
    assert len(table) == 10
    assert table.notna().all().all()
    assert (table.runs == 500).all()


def test_contestants_are_compared_with_the_first_of_them(measured):
    table = speed.contest_table(measured)
    assert table.index.tolist() == [name for name, _ in contest.LOOKED_INTO]
    assert table.ratio.iloc[0] == 1
    assert table.ratio.iloc[1] == pytest.approx(table.microseconds.iloc[1] / table.microseconds.iloc[0])


def test_growth(measured):
    table = speed.growth_table(measured)
    assert set(table.what) == set(speed.VARIED)
    assert table.notna().all().all()
    assert not table.duplicated(["what", "of", "size"]).any()


def test_stores_of_a_million_runs(measured):
    table = speed.stored_table(measured)
    assert table.index.tolist() == [1000, 10_000, 100_000, 1_000_000]
    assert table.columns.tolist() == ["megabytes", "table", "tables", "verify", "memory"]
    assert table.megabytes.is_monotonic_increasing
    assert 1 <= table.memory[1_000_000] < 2


def test_an_earlier_tree_is_compared_with_this_one(measured):
    table = speed.before_table(measured)
    assert table.ratio.to_numpy() == pytest.approx(table.now / table.before, rel=0.25)
    assert table.ratio["first run, not compiled"] < 0.7


def test_key_figures(measured):
    numbers = speed.key_figures(measured).speed
    assert numbers.core_seconds == pytest.approx(speed.paper_table(measured).core_seconds.sum(), rel=0.05)
    assert numbers.runs == 5000
    assert numbers.days_of_ten_million_runs == pytest.approx(numbers.core_seconds / 5000 * 1e7 / 86400, rel=0.1)


def test_key_figures_need_a_browser(measured):
    for group in (
        measured.group != "twin",
        measured.method.isna() | ~measured.method.astype(str).str.contains("Chrom"),
    ):
        with pytest.raises(ValueError, match="playground in Chromium"):
            speed.key_figures(measured[group])


def test_figures(measured):
    _, panels = speed.plot_parts(speed.parts_table(measured))
    assert [axes.get_title() for axes in panels] == ["maze1", "maze2"]
    parts = speed.parts_table(measured)
    widths = sum(bar.get_width() for bar in panels[0].patches)
    assert widths == pytest.approx(parts.loc["maze1"].drop(columns="all").sum().sum())
    _, panels = speed.plot_growth(speed.growth_table(measured))
    assert sorted(axes.get_xlabel() for axes in panels.flat) == sorted(speed.VARIED.values())
    plt.close("all")


@pytest.mark.parametrize("content", [None, "", "[]", "{}", '{"benchmarks": [{}]}'])
def test_files_without_measurements(tmp_path, content):
    path = tmp_path / "results.json"
    if content is not None:
        path.write_text(content)
    with pytest.raises(ValueError, match="measured must be the path of measurements; got"):
        speed.read_measured(path)
