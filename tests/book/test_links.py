"""Links in the built book, from rows of tables to the runs and robots that they are about."""

import csv
import html
import json
import re
import sqlite3
from contextlib import closing
from urllib.parse import urljoin

import pytest

from safe.companion import evidence, held_out
from safe.companion.questions import all_questions
from safe.playground.address import drive_address
from tests.helpers.addresses import run_at, values_of
from tests.helpers.checkout import RUNS, build, output_of

ABOUT_RUNS = {
    "tab-coefficients",
    "tab-deception",
    "tab-evolved",
    "tab-fixed",
    "tab-fixed-generations",
    "tab-generations",
    "tab-ledger-comparisons",
    "tab-ledger-evolved",
    "tab-ledger-generations",
    "tab-ledger-readings",
    "tab-ledger-second-look",
    "tab-ledger-successes",
    "tab-power",
    "tab-replay",
    "tab-runs",
    "tab-success",
    "tab-times",
    "tab-unevolved",
    "tab-unevolved-coefficients",
}
ABOUT_RECORDED_RUNS = {"tab-archives", "tab-kinds", "tab-mutualism", "tab-selects", "tab-settings"}
ABOUT_SCENES = {
    "tab-archives-watch",
    "tab-contest-watch",
    "tab-kinds-watch",
    "tab-mutualism-watch",
    "tab-selects-watch",
}
ABOUT_ROBOTS = {"tab-known", "tab-mazes", "tab-mean-controller"}
ABOUT_NEITHER = {
    "tab-archives-answers",
    "tab-archives-inside",
    "tab-beyond",
    *(f"tab-beyond-{name}" for name in (*all_questions(), "contest")),
    "tab-budget",
    "tab-before",
    "tab-class-pooled",
    "tab-class-refused",
    "tab-contest-asked",
    "tab-contest-cost",
    "tab-contest-coevolution",
    "tab-contest-fair",
    "tab-contest-inside",
    "tab-contest-many",
    "tab-contest-novelty",
    "tab-contest-tried",
    "tab-cost",
    "tab-effects",
    "tab-effects-answers",
    "tab-elites",
    "tab-first-use",
    "tab-kinds-engagement",
    "tab-kinds-fields",
    "tab-kinds-pairs",
    "tab-ledger-untestable",
    "tab-machine",
    "tab-missed",
    "tab-mutualism-answers",
    "tab-novelty",
    "tab-parameters",
    "tab-parts",
    "tab-peers",
    "tab-places-answers",
    "tab-playground",
    "tab-project-archive",
    "tab-project-controller",
    "tab-project-front",
    "tab-project-judge",
    "tab-project-maze",
    "tab-project-operators",
    "tab-project-pilot",
    "tab-project-runs",
    "tab-project-transfer",
    "tab-selects-answers",
    "tab-selects-inside",
    "tab-sensors",
    "tab-stored",
    "tab-unseen",
    "tab-verdicts",
}
WATCH = r"view=watch&maze=\w+&algorithm=[\w:]+&seed=0x[0-9a-f]{64}/\d+"
DRIVE = r"view=drive&maze=\w+(&controller=-?[\d.e-]+(,-?[\d.e-]+){15})?"


@pytest.fixture(scope="module")
def linked(checkout):
    """The rows of all tables of results: the texts of their cells by heading, and their links (text, address)."""
    found = {}
    for page in (checkout / "_build" / "html" / "notebooks").glob("*.html"):
        for table in re.findall(r'<table class="results.*?</table>', page.read_text(), re.DOTALL):
            head, *rows = re.findall(r"<tr.*?</tr>", table, re.DOTALL)
            headings = texts_of(head)
            found[re.search(r'id="(.*?)"', table).group(1)] = [
                (dict(zip(headings, texts_of(row), strict=True)), links_of(row)) for row in rows
            ]
    return found


def texts_of(row):
    cells = re.findall(r"<t[hd].*?</t[hd]>", row, re.DOTALL)
    return [html.unescape(re.sub(r"<.*?>", "", cell)).strip() for cell in cells]


def links_of(row):
    return [(text, html.unescape(link)) for link, text in re.findall(r'<a [^>]*href="(.*?)"[^>]*>(.*?)</a>', row)]


def addresses_of(links):
    return [link.split("#", 1)[1] for _, link in links]


def test_every_table_is_about_runs_or_robots_or_neither(linked):
    assert set(linked) == ABOUT_RUNS | ABOUT_RECORDED_RUNS | ABOUT_SCENES | ABOUT_ROBOTS | ABOUT_NEITHER


@pytest.mark.parametrize("name", sorted(ABOUT_RUNS | ABOUT_ROBOTS))
def test_every_row_about_runs_or_robots_leads_to_them(checkout, linked, name):
    assert linked[name] or name == "tab-ledger-second-look"  # in a few runs nothing stands out
    for row, links in linked[name]:
        says_none = row.get("successful runs") == "–" or row.get("rates") == "in the paper"
        assert bool(links) != says_none, row
        for text, link in links:
            page, address = link.split("#", 1)
            assert (checkout / "_build" / "html" / urljoin("notebooks/", page)).exists(), link
            assert re.fullmatch(DRIVE if text.startswith("drive") else WATCH, address), link
            values = values_of(address)
            if not text.startswith("drive"):
                assert re.findall(r"\d+", text)[-1] == values["seed"].split("/")[1]
            for key in ("maze", "algorithm"):
                if key in row and key in values:
                    assert values[key].split(":")[0] == row[key], link


def test_every_cell_names_its_heading_for_the_cards_of_narrow_pages(checkout):
    tables = [
        table
        for page in (checkout / "_build" / "html" / "notebooks").glob("*.html")
        for table in re.findall(r'<table class="results.*?</table>', page.read_text(), re.DOTALL)
    ]
    for table in tables:
        head, *rows = re.findall(r"<tr.*?</tr>", table, re.DOTALL)
        for row in rows:
            assert [html.unescape(label) for label in re.findall(r'<t[hd] data-label="(.*?)"', row)] == texts_of(head)
    assert any(" cards" in table.split(">", 1)[0] for table in tables)


def test_every_unseen_maze_on_the_sheets_can_be_driven_in(checkout):
    page = (checkout / "_build" / "html" / "notebooks" / "gallery.html").read_text()
    sheets = re.findall(r'<div class="linked.*?</div>', page, re.DOTALL)
    for name, mazes, sheet in zip(
        ("design", "test"), (held_out.design_set(), held_out.test_set()), sheets, strict=True
    ):
        links = [(text, html.unescape(link)) for link, text in re.findall(r'<a href="(.*?)" title="(.*?)"', sheet)]
        assert [text for text, _ in links] == [f"{name} {number}" for number in range(1, len(mazes) + 1)]
        assert addresses_of(links) == [drive_address(maze) for maze in mazes]
        assert {link.split("#")[0] for _, link in links} == {"../book/playground.html"}
        places = [tuple(map(float, place)) for place in re.findall(r"left: ([\d.]+)%; top: ([\d.]+)%", sheet)]
        assert places == sorted(places, key=lambda place: (place[1], place[0]))
        assert len({top for _, top in places}) == 10


def test_other_rows_have_no_links(linked):
    for name in ABOUT_NEITHER:
        assert [links for _, links in linked[name] if links] == [], name


def test_a_row_of_two_algorithms_leads_to_both(linked):
    for row, links in linked["tab-times"]:
        assert [values_of(address)["algorithm"] for address in addresses_of(links)] == [row["first"], row["second"]]
    for _, links in linked["tab-unevolved"]:
        algorithms = [values_of(address)["algorithm"] for address in addresses_of(links)]
        assert algorithms == ["safe", "unevolved:none:drawn"]
    for row, links in linked["tab-ledger-comparisons"]:
        of_experiments = row["experiments"].split("; ")
        linked_to = [values_of(address) for address in addresses_of(links)]
        assert [experiment.split(":")[0] for experiment in of_experiments] == [
            f"{values['algorithm']} on {values['maze']}" for values in linked_to
        ]


def test_a_link_leads_to_the_run_in_the_results(checkout, linked):
    rows = [row for name in sorted(ABOUT_RUNS) for row in linked[name]]
    every = sorted(
        {address for _, links in rows for address in addresses_of(links) if address.startswith("view=watch")}
    )
    assert len(every) >= 10
    with closing(sqlite3.connect(checkout / "results.sqlite")) as results:
        for address in every:
            entropy, number = values_of(address)["seed"].split("/")
            (found,) = results.execute(
                "SELECT success, generation, distance, runs.controller, evaluations FROM runs JOIN experiments"
                " ON runs.experiment = experiments.id WHERE digest = ? AND run = ?",
                (entropy.removeprefix("0x"), int(number)),
            ).fetchall()
            made = run_at(address)
            success, generation, distance, controller, evaluations = found
            assert (made.success, made.generation, made.distance) == (bool(success), generation, distance), address
            assert list(made.controller) == json.loads(controller)
            assert made.evaluations == evaluations


@pytest.mark.parametrize("name", sorted(ABOUT_RECORDED_RUNS))
def test_a_row_about_recorded_runs_leads_to_them(checkout, linked, name):
    designed = [recorded.experiment for collection in evidence.COLLECTIONS for recorded in collection.designed()]
    experiments = {experiment.digest: experiment for experiment in designed}
    addresses = [addresses_of(links) for _, links in linked[name]]
    assert all(addresses)
    for address in [addresses[0][0], addresses[len(addresses) // 2][0], addresses[-1][-1]]:
        entropy, number = values_of(address)["seed"].split("/")
        experiment = experiments[entropy.removeprefix("0x")]
        recorded = evidence.runs([experiment])[experiment].loc[int(number)]
        made = run_at(address)
        assert (made.success, made.generation, made.distance) == (
            recorded.success,
            recorded.generation,
            recorded.distance,
        )


@pytest.mark.parametrize("name", sorted(ABOUT_SCENES))
def test_every_scene_leads_to_a_run_to_watch(linked, name):
    for _, links in linked[name]:
        ((_, link),) = links
        assert re.match(r"\.\./book/playground\.html#view=watch&maze=[^&]+&algorithm=[^&]+&", link), link


def test_a_row_leads_to_the_first_run_that_succeeded_or_else_to_run_0(checkout, linked):
    for row, links in linked["tab-success"]:
        ((text, link),) = links
        with closing(sqlite3.connect(checkout / "results.sqlite")) as results:
            ((first,),) = results.execute(
                "SELECT min(run) FROM runs JOIN experiments ON runs.experiment = experiments.id"
                " WHERE digest = ? AND success AND run < ?",
                (values_of(link.split("#", 1)[1])["seed"][2:66], int(RUNS)),
            )
        assert (first is None) == row["successes"].startswith("0 of")
        assert text == f"run {first or 0}"


def test_downloaded_tables_have_no_links(checkout, linked):
    for name, rows in linked.items():
        header = next(csv.reader((checkout / "executed" / "tables" / f"{name}.csv").read_text().splitlines()))
        assert not {"replay", "playground"} & set(header)
        for row, _ in rows:
            assert [title for title in row if title not in ("replay", "playground")] == [*dict.fromkeys(header)], name


@pytest.mark.usefixtures("alone_in_checkout")
def test_print_has_parts_and_no_links_to_the_playground(checkout):
    built = build(checkout, "--builder", "latex")
    assert built.returncode == 0, output_of(built)
    text = (checkout / "_build" / "latex" / "safe.tex").read_text()
    captions = re.findall("caption: (.+)", (checkout / "book" / "_toc.yml").read_text())
    assert re.findall(r"\\part\{(.+?)\}", text) == captions != []
    assert "tab-success" in text
    assert "playground.html" not in text
    assert "drive in maze1" not in text
