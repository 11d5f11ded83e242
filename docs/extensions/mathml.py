"""Formulas as MathML, which browsers draw by themselves: neither a network nor LaTeX is needed."""

from docutils.nodes import Element, SkipNode
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util.math import get_node_equation_number
from sphinx.writers.html5 import HTML5Translator


def inline(translator: HTML5Translator, node: Element) -> None:
    """A formula within a line."""
    translator.body.append(tex2mathml(node.astext()))
    raise SkipNode


def block(translator: HTML5Translator, node: Element) -> None:
    """A formula on lines of its own; if it has a label it has a number, and links lead to it."""
    translator.body.append(translator.starttag(node, "div", CLASS="formula"))
    translator.body.append(f'<div class="drawn">{tex2mathml(node.astext(), as_block=True)}</div>')
    if node["number"]:
        translator.body.append(f'<span class="number">({get_node_equation_number(translator, node)})</span>')
    translator.body.append("</div>\n")
    raise SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_html_math_renderer("mathml", inline_renderers=(inline, None), block_renderers=(block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
