"""The diagrams of scripts: methods in the colours and marks of src/report/palette.rs, both axes logarithmic with ticks and units."""

import math
import re
from html import escape
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WIDE, TALL = 520, 340
LEFT, RIGHT, TOP, BOTTOM = 62, 96, 34, 52
# Outlines around the middle, a mark's size being 1; those without an area are lines.
OUTLINES = {
    "Square": "M-.9,-.9H.9V.9H-.9Z",
    "Triangle": "M0,-1.2L1,.9H-1Z",
    "Diamond": "M0,-1.4L1,0L0,1.4L-1,0Z",
    "Wye": "M0,1.2L1,-.9H-1Z",
    "Cross": "M-1,0H1M0,-1V1",
    "Times": "M-.9,-.9L.9,.9M-.9,.9L.9,-.9",
    "Star": "M-1,0H1M0,-1V1M-.9,-.9L.9,.9M-.9,.9L.9,-.9",
    "Bowtie": "M-1,-.9L1,.9V-.9L-1,.9Z",
    "Arrow": "M-1,-1L1.2,0L-1,1L-.33,0Z",
    "Circle": "M-1,0A1,1,0,1,1,1,0A1,1,0,1,1,-1,0Z",
}


def styles(dark=False):
    """Colour, on light or on dark paper, and mark of each method."""
    text = (ROOT / "src" / "report" / "palette.rs").read_text()
    found = re.findall(r'\("([\w-]+)", style\(\[([\d, ]+)\], \[([\d, ]+)\], Mark::(\w+)\)\)', text)
    return {name: ("#" + "".join(f"{int(part):02x}" for part in colours[dark].split(",")), mark) for name, *colours, mark in found}


def span(values):
    """Ends of a logarithmic axis: room around the values, and at least a factor of 2.5 in all, so that it has ticks."""
    low, high = min(values) / 1.15, max(values) * 1.15
    widen = math.sqrt(max(1.0, 2.5 * low / high))
    return low / widen, high * widen


def ticks(low, high, most):
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for factors in [(1, 1.5, 2, 3, 4, 5, 7), (1, 2, 3, 5), (1, 2, 5), (1, 3), (1,)]:
        found = [v for v in (float(f"{f}e{power}") for power in powers for f in factors) if low <= v <= high]
        if len(found) <= most:
            return found
    return found


def diagram(title, x_name, y_name, lines):
    """An SVG of {method: [(x, y)]}; axes are named with their units."""
    of = styles()
    points = [point for line in lines.values() for point in line]
    (left, right), (low, high) = (span([point[k] for point in points]) for k in (0, 1))
    wide, tall = WIDE - LEFT - RIGHT, TALL - TOP - BOTTOM
    across = lambda x: LEFT + wide * math.log(x / left) / math.log(right / left)
    down = lambda y: TALL - BOTTOM - tall * math.log(y / low) / math.log(high / low)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {TALL}" font-family="sans-serif" font-size="11" fill="#464c56">']
    out.append(f'<rect width="{WIDE}" height="{TALL}" fill="white"/><text x="{LEFT}" y="20" font-size="13">{escape(title)}</text>')
    for v in ticks(left, right, 9):
        out.append(f'<path d="M{across(v):.1f},{TOP}V{TALL - BOTTOM + 4}" stroke="#e2e5ea"/><text x="{across(v):.1f}" y="{TALL - BOTTOM + 16}" text-anchor="middle">{v:g}</text>')
    for v in ticks(low, high, 9):
        out.append(f'<path d="M{LEFT - 4},{down(v):.1f}H{WIDE - RIGHT}" stroke="#e2e5ea"/><text x="{LEFT - 7}" y="{down(v) + 4:.1f}" text-anchor="end">{v:g}</text>')
    out.append(f'<rect x="{LEFT}" y="{TOP}" width="{wide}" height="{tall}" fill="none" stroke="#464c56" stroke-opacity="0.5"/>')
    out.append(f'<text x="{LEFT + wide / 2}" y="{TALL - 14}" text-anchor="middle">{escape(x_name)}</text>')
    out.append(f'<text transform="translate(14,{TOP + tall / 2}) rotate(-90)" text-anchor="middle">{escape(y_name)}</text>')
    for k, (name, line) in enumerate(lines.items()):
        colour, mark = of[name]
        inside = "none" if mark in ("Cross", "Times", "Star") else colour

        def draw(x, y):
            return f'<path transform="translate({x:.1f},{y:.1f}) scale(4)" d="{OUTLINES[mark]}" fill="{inside}" stroke="{colour}" stroke-width="0.45"/>'

        at = [(across(x), down(y)) for x, y in line]
        out.append(f'<path d="M{"L".join(f"{x:.1f},{y:.1f}" for x, y in at)}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        out.extend(draw(x, y) for x, y in at)
        beside = TOP + 12 + 18 * k
        out.append(f'{draw(WIDE - RIGHT + 16, beside)}<text x="{WIDE - RIGHT + 26}" y="{beside + 4}" fill="{colour}">{escape(name)}</text>')
    return "\n".join(out + ["</svg>\n"])
