"""Measures the texts of a figure: none leaves the canvas, none overlaps another, and no panel is empty."""

from itertools import combinations

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

#: Boxes of texts may overlap by this much [pixels of 1/200 inch]: a line of 7 points is 19 high, and its digits 14.
TOUCH = 3.0


def texts(figure):
    """Each text that is seen, with its box [pixels]."""
    canvas = FigureCanvasAgg(figure)
    figure.set_dpi(200)
    figure.draw_without_rendering()  # places everything
    ticks = {id(t): t for axes in figure.axes for axis in (axes.xaxis, axes.yaxis) for t in axis.findobj(Text)}
    seen = [text for text in figure.findobj(Text) if id(text) not in ticks and _is_seen(text)]
    for axes in figure.axes:
        if not axes.get_visible():
            continue
        for axis in (axes.xaxis, axes.yaxis):
            # these ticks alone lie within the limits, and are drawn
            shown = [label for tick in axis._update_ticks() for label in (tick.label1, tick.label2)]
            seen += [text for text in [*shown, axis.label, axis.offsetText] if _is_seen(text)]
    return [(text.get_text(), text.get_window_extent(canvas.get_renderer())) for text in seen]


def _is_seen(text):
    hidden = text.axes is not None and not text.axes.get_visible()
    return text.get_visible() and not hidden and bool(text.get_text().strip())


def faults(figure):
    """What is wrong with a figure's texts and panels, in words."""
    found = []
    boxes = texts(figure)
    width, height = figure.canvas.get_width_height()
    for text, box in boxes:
        if box.x0 < -TOUCH or box.y0 < -TOUCH or box.x1 > width + TOUCH or box.y1 > height + TOUCH:
            found.append(f"'{text}' leaves the canvas: {box.bounds}")
    for (one, a), (other, b) in combinations(boxes, 2):
        wide = min(a.x1, b.x1) - max(a.x0, b.x0)
        high = min(a.y1, b.y1) - max(a.y0, b.y0)
        if wide > TOUCH and high > TOUCH:
            found.append(f"'{one}' overlaps '{other}' by {wide:.0f} x {high:.0f}")
    for axes in figure.axes:
        if axes.get_visible() and not axes.has_data():
            found.append(f"the panel '{axes.get_title()}' is empty")
    return found
