"""Figures of notebooks: on the pages of chapters, panel by panel on narrow pages, and with links to the playground.

A chapter shows a figure of a notebook where its argument needs it, with a caption and a name of its own::

    ```{shown} fig-mazes
    :name: fig-first-mazes

    The mazes of the paper.
    ```

A figure that a notebook shows by `safe.companion.notebook.show_figure` has links, which travel beside its image as
metadata of the output. On the page each is an area over its part of the image. Print has the image alone.

Every image of a page states its size, so that nothing moves once it is loaded.

Where the panels of a figure are travels there, too. A narrow page shows the same image once for each panel and each
entry of the legend, cut to it, one below the other (see `book.css`).

A chapter may also show a view of the playground, small and with few controls, in the place of such a figure::

    ```{live} fig-sensors
    :name: fig-readings
    :address: view=drive&maze=maze1
    :parts: play steps readings
    :height: 30rem 45rem

    What a robot senses.
    ```

For what the address, the parts and the other options mean see `safe/playground/javascript/figure.js`. `choices` are a
title and, behind bars, texts, each with an address behind a colon. The image stands in a box of this height, on a
desktop and on a phone, until `_static/live.js` puts the view over it. In print, in a PDF and without JavaScript it
stays.
"""

from __future__ import annotations

import base64
import html
import json
import re
import zlib
from pathlib import Path
from typing import ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.transforms import SphinxTransform
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util.docutils import SphinxDirective
from sphinx.util.typing import ExtensionMetadata

from executed import EXECUTED, ROOT
from playground import PAGE as PLAYGROUND
from playground import SCRIPT, STYLE

IMAGES = EXECUTED / "figures"
KINDS = {"image/svg+xml": "svg", "application/pdf": "pdf"}  # for pages, and for print
BOX = (
    "left",
    "top",
    "width",
    "height",
    "across",
    "down",
)  # in book.css: in fractions of an image, and its size in points
LIVE = "live.js"
SIZE = re.compile(r'<svg [^>]*width="([\d.]+)pt" height="([\d.]+)pt"')  # as Matplotlib writes it
PIXELS = 96 / 72  # in a point


class Shown(SphinxDirective):
    """A figure of a notebook, by its name there."""

    required_arguments = 1
    option_spec: ClassVar = {"name": directives.unchanged_required}
    has_content = True

    def run(self) -> list[nodes.Node]:
        name = self.arguments[0]
        for copy in sorted(EXECUTED.glob("*.ipynb")):
            for cell in json.loads(copy.read_text(encoding="utf-8"))["cells"]:
                settings = cell["metadata"].get("mystnb", {})
                if settings.get("figure", {}).get("name") == name:
                    self.env.note_dependency(str(copy))
                    return [self._figure(name, cell, settings.get("image", {}))]
        raise ExtensionError(f"shown must name a figure of a notebook; got {name!r}")

    def _figure(self, name: str, cell: dict, settings: dict) -> nodes.figure:
        IMAGES.mkdir(exist_ok=True)
        layout = {}
        for output in cell["outputs"]:
            layout |= _metadata(output).get("layout", {})
            for kind, suffix in KINDS.items():
                if kind in output.get("data", {}):
                    content = "".join(output["data"][kind])
                    (IMAGES / f"{name}.{suffix}").write_bytes(
                        base64.b64decode(content) if suffix == "pdf" else content.encode()
                    )
        image = nodes.image(uri=f"/{IMAGES.relative_to(ROOT).as_posix()}/{name}.*", alt=settings.get("alt", ""))
        image["classes"] = settings.get("classes", "").split()
        image["layout"] = layout
        caption = nodes.caption()
        self.state.nested_parse(self.content, self.content_offset, caption)
        (paragraph,) = caption.children
        caption.children = []
        caption.extend(paragraph.children)
        figure = nodes.figure("", image, caption, classes=["shown"])
        self.set_source_info(figure)
        self.add_name(figure)
        return figure


class Live(Shown):
    """A figure of a notebook that is also a view of the playground."""

    option_spec: ClassVar = Shown.option_spec | {
        "address": directives.unchanged_required,
        "parts": directives.class_option,
        "height": str.split,
        "weights": directives.positive_int_list,
        "robot": directives.nonnegative_int,
        "choices": directives.unchanged_required,
    }

    def run(self) -> list[nodes.Node]:
        (figure,) = super().run()
        settings = {key: self.options[key] for key in ("address", "parts", "weights", "robot") if key in self.options}
        if "choices" in self.options:
            title, *choices = self.options["choices"].split(" | ")
            options = [choice.split(": ", 1) for choice in choices]
            settings["choices"] = {"title": title, "options": [[address, text] for text, address in options]}
        figure["live"] = settings
        figure["height"] = self.options["height"]
        self.env.metadata[self.env.docname]["live"] = True
        return [figure]


class FigureMetadata(SphinxTransform):
    """Keep what the images of every cell carry, for `ArrangedFigures`."""

    default_priority = 400

    def apply(self, **kwargs: object) -> None:
        copy = EXECUTED / f"{self.env.docname.rsplit('/', 1)[-1]}.ipynb"
        cells = [c for c in self.document.findall(nodes.container) if c.get("nb_element") == "cell_code"]
        if not cells or not copy.exists():
            return
        executed = json.loads(copy.read_text(encoding="utf-8"))["cells"]
        for cell in cells:
            outputs = executed[cell["cell_index"]]["outputs"]
            cell["images"] = [_metadata(output) for output in outputs if "image/svg+xml" in output.get("data", {})]


class ArrangedFigures(SphinxPostTransform):
    """On the page an image gets an area for each of its links, and is followed by its panels."""

    default_priority = 700
    formats = ("html",)

    def run(self, **kwargs: object) -> None:
        for cell in self.document.findall(lambda node: isinstance(node, nodes.container) and node.get("images")):
            for image, carried in zip(list(cell.findall(nodes.image)), cell["images"], strict=True):
                image["layout"] = carried.get("layout", {})
                if "links" in carried:
                    image.replace_self(self._linked(image, carried["links"]))
        for image in list(self.document.findall(lambda node: isinstance(node, nodes.image) and "layout" in node)):
            layout = image.attributes.pop("layout")
            if len(layout.get("panels", [])) > 1:
                image["classes"].append("whole")
                image.parent.insert(image.parent.index(image) + 1, _panels(image, layout))

    def _linked(self, image: nodes.image, links: list) -> nodes.container:
        playground = self.app.builder.get_relative_uri(self.env.docname, PLAYGROUND)
        areas = "".join(
            f'<a href="{html.escape(f"{playground}#{address}")}" title="{html.escape(text)}" style="left: {left}%; '
            f'top: {top}%; width: {width}%; height: {height}%"></a>'
            for text, address, left, top, width, height in links
        )
        return nodes.container("", image.deepcopy(), nodes.raw("", areas, format="html"), classes=["linked"])


def _panels(image: nodes.image, layout: dict) -> list[nodes.Node]:
    """The panels of an image, and below them the entries of its legend; for readers of alternative text, one image."""
    alt = html.escape(image.get("alt", ""), quote=True)
    panels = [_raw(f'<div class="panels" role="img" aria-label="{alt}">')]
    for kind, boxes in [*(("panel", boxes) for boxes in layout["panels"]), ("entries", layout["entries"])]:
        cuts = [part for box in boxes for part in _cut(image, box, layout["size"])]
        panels += [_raw(f'<div class="{kind}">'), *cuts, _raw("</div>")]
    return [*panels, _raw("</div>")]


def _cut(image: nodes.image, box: list[float], size: list[float]) -> list[nodes.Node]:
    """An image cut to a box (see `safe.results.figures.layout`)."""
    cut = nodes.image(uri=image["uri"], candidates=image.get("candidates", {}), alt="", loading="lazy")
    style = "; ".join(f"--{name}: {value}" for name, value in zip(BOX, [*box, *size], strict=True))
    return [_raw(f'<span class="cut" style="{style}">'), cut, _raw("</span>")]


def _raw(text: str) -> nodes.raw:
    return nodes.raw("", text, format="html")


def _metadata(output: dict) -> dict:
    return output.get("metadata", {}).get("image/svg+xml", {})


class SizedImages(SphinxPostTransform):
    """On the page an image has its width and height, in pixels."""

    default_priority = 690  # before there are panels
    formats = ("html",)

    def run(self, **kwargs: object) -> None:
        for image in self.document.findall(nodes.image):
            file = image["candidates"].get("image/svg+xml", image["uri"])
            size = SIZE.search(Path(self.app.srcdir, file).read_text(encoding="utf-8"))
            width, height = (PIXELS * float(side) for side in size.groups())
            shown = float(image.get("width", f"{width}px").removesuffix("px"))
            image["width"], image["height"] = f"{shown:.0f}", f"{shown * height / width:.0f}"


class LiveFigures(SphinxPostTransform):
    """On the page the image stands in the box of the view."""

    default_priority = 700
    formats = ("html",)

    def run(self, **kwargs: object) -> None:
        playground = self.app.builder.get_relative_uri(self.env.docname, PLAYGROUND)
        for figure in self.document.findall(lambda node: isinstance(node, nodes.figure) and "live" in node):
            settings = html.escape(json.dumps(figure["live"] | {"href": playground}))
            desktop, phone = figure["height"]
            box = f'<div class="live" data-figure="{settings}" style="--desktop: {desktop}; --phone: {phone}">'
            figure.insert(0, nodes.raw("", box, format="html"))
            figure.insert(len(figure) - 1, nodes.raw("", "</div>", format="html"))  # before the caption


def _read_again(app: Sphinx, env, added: set, changed: set, removed: set) -> list[str]:
    """Pages with views of the playground name its files with their checksums, as its own page does."""
    return [name for name, metadata in env.metadata.items() if "live" in metadata and name not in removed]


def _load(app: Sphinx, pagename: str, templatename: str, context: dict, doctree) -> None:
    if "live" in app.env.metadata.get(pagename, {}):
        checksum = zlib.crc32(Path(app.outdir, "_static", SCRIPT).read_bytes())
        bundle = context["pathto"](f"_static/{SCRIPT}", resource=True)
        app.add_js_file(LIVE, defer="defer", **{"data-bundle": f"{bundle}?v={checksum:08x}"})
        app.add_css_file(STYLE)


def setup(app: Sphinx) -> ExtensionMetadata:
    app.add_directive("shown", Shown)
    app.add_transform(FigureMetadata)
    app.add_post_transform(SizedImages)
    app.add_post_transform(ArrangedFigures)
    app.add_directive("live", Live)
    app.add_post_transform(LiveFigures)
    app.connect("env-get-outdated", _read_again)
    app.connect("html-page-context", _load)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
