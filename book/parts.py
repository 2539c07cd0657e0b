"""The parts of the table of contents in a PDF, where Sphinx would leave them out; chapters are numbered as on pages."""

from __future__ import annotations

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform
from sphinx.util.texescape import escape
from sphinx.util.typing import ExtensionMetadata

CHAPTERS, NOTHING = 0, -1  # that has numbers: LaTeX's secnumdepth


class Parts(SphinxTransform):
    default_priority = 450  # after the table of contents is there

    def apply(self, **kwargs: object) -> None:
        for toctree in list(self.document.findall(addnodes.toctree)):
            if toctree.get("caption"):
                numbered = CHAPTERS if toctree["numbered"] else NOTHING
                command = rf"\setcounter{{secnumdepth}}{{{numbered}}}\part{{{escape(toctree['caption'])}}}"
                toctree.parent.insert(toctree.parent.index(toctree), nodes.raw("", command, format="latex"))


def setup(app: Sphinx) -> ExtensionMetadata:
    app.add_transform(Parts)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
