"""SVG elements as text."""

from __future__ import annotations

from collections.abc import Iterable
from xml.sax.saxutils import escape, quoteattr

from vsgraphs.trajectory import Array


class Page:
    """Collects elements. Coordinates in pixels, y down."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def path(self, data: str, **style: object) -> None:
        """A path from its `d`."""
        self._add("path", {"d": data, **style})

    def polygon(self, corners: Array, **style: object) -> None:
        """(N, 2), closed."""
        self.path(path_data(corners, closed=True), **style)

    def line(self, points: Array, **style: object) -> None:
        """(N, 2), open."""
        self.path(path_data(points), **{"fill": "none", **style})

    def circle(self, x: float, y: float, r: float, **style: object) -> None:
        """A circle."""
        self._add("circle", {"cx": number(x), "cy": number(y), "r": number(r), **style})

    def rectangle(self, x: float, y: float, width: float, height: float, **style: object) -> None:
        """From its upper left corner."""
        box = {"x": number(x), "y": number(y), "width": number(width), "height": number(height)}
        self._add("rect", {**box, **style})

    def text(self, x: float, y: float, content: str, *, halo: bool = False, **style: object) -> None:
        """One line; with a white halo where it lies over lines."""
        place = {"x": number(x), "y": number(y)}
        if halo:
            around = {"stroke": "#ffffff", "stroke_width": 3.5, "stroke_linejoin": "round", "opacity": 0.85}
            self._add("text", {**place, **style, **around}, content)
        self._add("text", {**place, **style}, content)

    def open_group(self, **style: object) -> None:
        """Everything up to close_group."""
        self.lines.append(f"<g{_attributes(style)}>")

    def close_group(self) -> None:
        """Ends open_group."""
        self.lines.append("</g>")

    def _add(self, name: str, style: dict[str, object], content: str | None = None) -> None:
        end = "/>" if content is None else f">{escape(content)}</{name}>"
        self.lines.append(f"<{name}{_attributes(style)}{end}")

    def document(self, width: float, height: float, title: str) -> str:
        """The whole file."""
        head = (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
            f'viewBox="0 0 {width:.0f} {height:.0f}" font-family="Helvetica, Arial, DejaVu Sans, sans-serif">'
        )
        return "\n".join([head, f"<title>{escape(title)}</title>", *self.lines, "</svg>"]) + "\n"


def path_data(points: Iterable[Array], *, closed: bool = False) -> str:
    """Corners -> the `d` of a path."""
    data = "L".join(f"{number(x)} {number(y)}" for x, y in points)
    return f"M{data}{'Z' if closed else ''}"


def number(value: float) -> str:
    """A hundredth of a pixel, without trailing zeros and minus zero."""
    return f"{round(float(value), 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def _attributes(style: dict[str, object]) -> str:
    return "".join(f" {name.replace('_', '-')}={quoteattr(str(value))}" for name, value in style.items())
