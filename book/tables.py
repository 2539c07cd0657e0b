"""Tables of results as tables of the book: captioned, numbered, and available as CSV.

A notebook cell whose metadata holds `table: {name, caption, stub, class}` shows one table, which carries a CSV copy of
itself. Here that CSV becomes a table of the document, with `stub` columns of headings (1 by default), and with a class
for its looks beside `results`. It can be referred to by its name, and is a table in print as well. Nothing in it is
read as markup. Only the page shows the links of its rows to the playground (see `safe.companion.notebook.show_table`).
A page that is too narrow for a table shows a card for each row, on which every cell has its heading beside it, and of
many cards the first few, until the reader asks for all.
"""

from __future__ import annotations

import csv
import json
import re

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.transforms import SphinxTransform
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util.typing import ExtensionMetadata
from sphinx.writers.html5 import HTML5Translator

from executed import EXECUTED, ROOT
from playground import PAGE as PLAYGROUND

TABLES = EXECUTED / "tables"
PRINTED = 100  # characters that stand side by side in print
LONG = 32  # characters from which on a cell is text, which needs room
PHONE = 44  # characters that stand side by side on a phone, with 2 between columns
MANY = 8  # cards from which on the first few stand alone; see book.css
WHOLE = re.compile(r"\([^()]*\),?|n = \S+|[\d,]+ of [\d,]+|< \S+")  # parts of a cell that are not broken


class ResultTables(SphinxTransform):
    default_priority = 400  # before labels are collected

    def apply(self, **kwargs: object) -> None:
        cells = [
            cell
            for cell in self.document.findall(nodes.container)
            if cell.get("nb_element") == "cell_code" and "table" in cell["cell_metadata"]
        ]
        if not cells:
            return
        copy = EXECUTED / f"{self.env.docname.rsplit('/', 1)[-1]}.ipynb"
        executed = json.loads(copy.read_text(encoding="utf-8"))["cells"]
        for cell in cells:
            (output,) = (part for part in cell.children if part.get("nb_element") == "cell_code_output")
            output.children = []
            settings = cell["cell_metadata"]["table"]
            shown = [o for o in executed[cell["cell_index"]]["outputs"] if "text/csv" in o.get("data", {})]
            if len(shown) != 1:
                raise ExtensionError(f"{copy.name} must show one table as {settings['name']}; showed {len(shown)}")
            replays = shown[0]["metadata"].get("text/csv", {})
            output += self.table("".join(shown[0]["data"]["text/csv"]), settings, replays)

    def table(self, text: str, settings: dict, replays: dict) -> list[nodes.Node]:
        name, stub = settings["name"], settings.get("stub", 1)
        header, *rows = csv.reader(text.splitlines())
        group = nodes.tgroup(
            "",
            *(nodes.colspec(colwidth=1, stub=int(column < stub)) for column in range(len(header))),
            nodes.thead("", _row(header)),
            nodes.tbody("", *map(_row, rows)),
            cols=len(header),
        )
        table = nodes.table("", nodes.title("", settings["caption"]), group, names=[name])
        table["classes"] = ["results", *settings.get("class", "").split()]
        table["replays"] = replays  # for LinkedTables
        self.document.note_explicit_target(table)
        TABLES.mkdir(exist_ok=True)
        file = TABLES / f"{name}.csv"
        file.write_text(text, encoding="utf-8", newline="\n")
        link = addnodes.download_reference(
            "",
            nodes.Text("this table as CSV"),
            reftarget=f"/{file.relative_to(ROOT).as_posix()}",
            refdoc=self.env.docname,
        )
        return [table, nodes.paragraph("", "", link, classes=["results-download"])]


class LabelledTables(SphinxPostTransform):
    """On the page every cell knows its heading, for cards, and columns of texts are marked, as are parts of numbers.

    The cells with their headings are what `_visit_entry` writes.
    """

    default_priority = 710  # after the links are there
    formats = ("html",)

    def run(self, **kwargs: object) -> None:
        for table in list(self.document.findall(nodes.table)):
            if "results" not in table["classes"]:
                continue
            head, *rows = [[*row.children] for row in table.findall(nodes.row)]
            headings = [cell.astext() for cell in head]
            widest = [max((len(cell.astext()) for cell in column), default=0) for column in zip(*rows, strict=True)]
            words = [max(map(len, heading.split()), default=0) for heading in headings]
            if not rows:
                table["classes"].append("empty")
            elif sum(max(min(width, LONG), word) + 2 for width, word in zip(widest, words, strict=False)) > PHONE:
                table["classes"].append("cards")
                if len(rows) > MANY:
                    switch = f'<label class="all-rows"><input type="checkbox"> Show all {len(rows)} rows</label>'
                    table.parent.insert(table.parent.index(table) + 1, nodes.raw("", switch, format="html"))
            for row in rows:
                for heading, width, cell in zip(headings, widest, row, strict=True):
                    cell["heading"] = heading
                    if width >= LONG:
                        cell["classes"].append("text")
                    else:
                        _keep_whole(cell)


def _keep_whole(cell: nodes.entry) -> None:
    """Let no line end within an interval or a count."""
    for text in list(cell.findall(nodes.Text)):
        parts = re.split(f"({WHOLE.pattern})", text.astext())
        kept = [
            nodes.inline("", part, classes=["whole"]) if i % 2 else nodes.Text(part) for i, part in enumerate(parts)
        ]
        text.parent.replace(text, kept)


def _visit_entry(self: HTML5Translator, node: nodes.entry) -> None:
    type(self).visit_entry(self, node)
    if "heading" in node:
        tag = self.body.pop()  # <td> or <th>, perhaps with attributes
        self.body.append(f'{tag[:3]} data-label="{self.attval(node["heading"])}"{tag[3:]}')


def _depart_entry(self: HTML5Translator, node: nodes.entry) -> None:
    type(self).depart_entry(self, node)


class LinkedTables(SphinxPostTransform):
    """On the page a table gets its links to the playground, in the column with their heading or in a new last one."""

    default_priority = 700
    formats = ("html",)

    def run(self, **kwargs: object) -> None:
        for table in self.document.findall(lambda node: isinstance(node, nodes.table) and node.get("replays")):
            links, heading = table["replays"]["links"], table["replays"]["heading"]
            head, *rows = table.findall(nodes.row)
            titles = [cell.astext() for cell in head.children]
            if heading not in titles:
                (group,) = table.findall(nodes.tgroup)
                group["cols"] += 1
                group.insert(len(titles), nodes.colspec(colwidth=1, stub=0))
                head += _cell(heading)
                for row in rows:
                    row += _cell("–")
                titles.append(heading)
            playground = self.app.builder.get_relative_uri(self.env.docname, PLAYGROUND)
            for row, of_row in zip(rows, links, strict=True):
                if of_row:
                    (paragraph,) = row.children[titles.index(heading)].children
                    paragraph.children = []
                    paragraph.parent["classes"].append("links")
                    for number, (text, address) in enumerate(of_row):
                        if number:
                            paragraph += nodes.Text(", ")
                        paragraph += nodes.reference("", text, refuri=f"{playground}#{address}", internal=True)


class PrintedTables(SphinxPostTransform):
    """In print a table breaks between pages, has columns of widths for which it is short, and has no download."""

    default_priority = 700
    formats = ("latex",)

    def run(self, **kwargs: object) -> None:
        for table in list(self.document.findall(nodes.table)):
            if "results" in table["classes"]:
                table["classes"] += ["longtable", "colwidths-given"]
                lines = [[cell.astext() for cell in row.children] for row in table.findall(nodes.row)]
                widths = _printed_widths(list(zip(*lines, strict=True)))
                columns = (rf">{{\raggedright\arraybackslash}}\X{{{width}}}{{{sum(widths)}}}" for width in widths)
                spec = addnodes.tabular_col_spec(spec="".join(columns))
                table.parent.insert(table.parent.index(table), spec)
        for paragraph in list(self.document.findall(nodes.paragraph)):
            if "results-download" in paragraph["classes"]:
                paragraph.parent.remove(paragraph)


def _printed_widths(columns: list[tuple[str, ...]]) -> list[int]:
    """Widths of columns, in characters: enough for the longest word, and more if many cells are long.

    If rows are as high as the fourth powers of their cells' heights add up to, these are the widths for which a table
    is lowest.
    """
    needed = [max(len(word) for cell in column for word in ["", *cell.split()]) for column in columns]
    wanted = [sum(len(cell) ** 4 for cell in column) ** 0.2 for column in columns]
    scale = PRINTED / sum(wanted)
    return [
        min(max(need, round(scale * want)), max(map(len, column))) + 3
        for need, want, column in zip(needed, wanted, columns, strict=True)
    ]


def _row(texts: list[str]) -> nodes.row:
    return nodes.row("", *map(_cell, texts))


def _cell(text: str) -> nodes.entry:
    return nodes.entry("", nodes.paragraph("", text))


def setup(app: Sphinx) -> ExtensionMetadata:
    app.add_transform(ResultTables)
    app.add_post_transform(LinkedTables)
    app.add_post_transform(LabelledTables)
    app.add_node(nodes.entry, override=True, html=(_visit_entry, _depart_entry))
    app.add_post_transform(PrintedTables)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
