"""Static pictures for notebooks: SVG texts, drawn here so that no library is needed."""

from __future__ import annotations

import html
from typing import Any, Sequence

import numpy as np
from numpy.typing import NDArray

_COLOURS = ("#0060a8", "#c2410c", "#00785a", "#8e3a86", "#946200", "#2b8bc0")
"""Told apart with every kind of colour blindness, as in the studio; the dashes differ, too."""
_DASHES = ("", "6 3", "2 2", "8 3 2 3", "1 3", "10 4")
_INK = "currentColor"


def _number(value: float) -> str:
    return f"{value:.4g}"


def curves(x: NDArray[Any], rows: Sequence[tuple[str, NDArray[Any]]], x_words: str, y_words: str, size: tuple[int, int] = (460, 220)) -> str:
    """Curves over an abscissa, with the names of the rows."""
    width, height = size
    left, right, top, bottom = 62, width - 12, 12, height - 58
    values = np.concatenate([np.asarray(row, float) for _, row in rows])
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    if high == low:
        low, high = low - 0.5 * (abs(low) or 1.0), high + 0.5 * (abs(high) or 1.0)
    across = left + (right - left) * (x - x[0]) / ((x[-1] - x[0]) or 1.0)

    def up(row: NDArray[Any]) -> NDArray[Any]:
        return bottom - (bottom - top) * (np.asarray(row, float) - low) / (high - low)

    parts = [f'<path d="M{left} {top}V{bottom}H{right}" fill="none" stroke="{_INK}" opacity="0.5"/>']
    for place, value in ((bottom, low), (top, high)):
        parts.append(f'<text x="{left - 5}" y="{place + 4}" text-anchor="end">{_number(value)}</text>')
    for place, value in ((left, x[0]), (right, x[-1])):
        parts.append(f'<text x="{place}" y="{bottom + 15}" text-anchor="middle">{_number(value)}</text>')
    parts.append(f'<text x="{0.5 * (left + right)}" y="{bottom + 28}" text-anchor="middle">{html.escape(x_words)}</text>')
    middle = 0.5 * (top + bottom)
    parts.append(f'<text x="12" y="{middle}" text-anchor="middle" transform="rotate(-90 12 {middle})">{html.escape(y_words)}</text>')
    at = left
    for number, (name, row) in enumerate(rows):
        colour, dash = _COLOURS[number % len(_COLOURS)], _DASHES[number % len(_DASHES)]
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across, up(row)) if np.isfinite(b))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.6" stroke-dasharray="{dash}"/>')
        parts.append(f'<path d="M{at} {height - 10}h18" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        parts.append(f'<text x="{at + 22}" y="{height - 6}">{html.escape(name)}</text>')
        at += 30 + 7 * len(name)
    return _svg(parts, size, f"{y_words} over {x_words}")


def circles(gears: Sequence[tuple[float, Sequence[float], int]], words: str, size: tuple[int, int] = (460, 220)) -> str:
    """Gears as their circles: (place of the axis, radii from the tip inwards, teeth); lengths in one unit."""
    width, height = size
    low = min(place - radii[0] for place, radii, _ in gears)
    high = max(place + radii[0] for place, radii, _ in gears)
    tall = max(radii[0] for _, radii, _ in gears)
    scale = min((width - 20) / (high - low), (height - 20) / (2 * tall))
    parts = []
    for number, (place, radii, teeth) in enumerate(gears):
        x, y = 10 + (place - low) * scale, 0.5 * height
        colour = _COLOURS[number % len(_COLOURS)]
        for rank, radius in enumerate(radii):
            look = 'stroke-dasharray="4 3" opacity="0.6"' if rank == 1 else ""
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius * scale:.1f}" fill="none" stroke="{colour}" stroke-width="1.4" {look}/>')
        if teeth:
            parts.append(f'<text x="{x:.1f}" y="{y + 4:.1f}" text-anchor="middle">{teeth} teeth</text>')
    return _svg(parts, size, words)


def rolling_elements(pitch_mm: float, element_mm: float, count: int, size: int = 220) -> str:
    """A bearing along its axis: its elements on their circle."""
    middle, scale = 0.5 * size, (size - 20) / (pitch_mm + element_mm)
    parts = [f'<circle cx="{middle}" cy="{middle}" r="{0.5 * pitch_mm * scale:.1f}" fill="none" stroke="{_INK}" stroke-dasharray="4 3" opacity="0.6"/>']
    for angle in 2.0 * np.pi * np.arange(count) / max(count, 1):
        x, y = middle + 0.5 * pitch_mm * scale * np.array([np.cos(angle), np.sin(angle)])
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{0.5 * element_mm * scale:.1f}" fill="none" stroke="{_COLOURS[0]}" stroke-width="1.4"/>')
    return _svg(parts, (size, size), f"{count} rolling elements on their circle")


def table(rows: Sequence[tuple[str, str]]) -> str:
    """Names and values."""
    cells = "".join(f"<tr><th style='text-align:left'>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>" for name, value in rows)
    return f"<table>{cells}</table>"


def titled(title: str, *parts: str) -> str:
    return f"<div><b>{html.escape(title)}</b>{''.join(parts)}</div>"


def _svg(parts: Sequence[str], size: tuple[int, int], words: str) -> str:
    width, height = size
    style = f"display:block;max-width:{width}px;width:100%;font:12px sans-serif"
    body = "".join(parts).replace("<text ", f'<text fill="{_INK}" ')
    return f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{html.escape(words)}" viewBox="0 0 {width} {height}" style="{style}">{body}</svg>'
