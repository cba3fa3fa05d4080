"""The map of docs/who-wins.md as a picture: in each view and at each error the cheapest method, in the colours of src/report/palette.rs."""

from html import escape

from plot import styles

CELL, ROW, LEFT, TOP = 62, 20, 118, 66
# Names that fit a cell.
SHORT = {"discrete": "level", "cluster-paper": "paper's", "input-bvh": "bvh, mesh", "input-bvh6": "bvh6, mesh"}


def _on(colour):
    """Black or white, whichever is read better on a colour."""
    red, green, blue = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return "#ffffff" if 0.299 * red + 0.587 * green + 0.114 * blue < 140 else "#202020"


def drawn(title, scenes, places, levels, won):
    """An SVG. `won` has, by scene, place and error level, the cheapest method and what ours takes over it (None if ours cannot); what was not measured is left out."""
    # On light paper some are too dark to be told apart as areas.
    of = styles(dark=True)
    group = len(places) * CELL + 10
    wide, tall = LEFT + len(levels) * group, TOP + len(scenes) * ROW + 10
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {tall}" font-family="sans-serif" font-size="10" fill="#464c56">']
    out.append(f'<rect width="{wide}" height="{tall}" fill="white"/><text x="8" y="18" font-size="13">{escape(title)}</text>')
    for i, level in enumerate(levels):
        out.append(f'<text x="{LEFT + i * group + group / 2:.0f}" y="40" text-anchor="middle" font-size="12">within {level:g} pixels</text>')
        for j, place in enumerate(places):
            out.append(f'<text x="{LEFT + i * group + (j + 0.5) * CELL:.0f}" y="57" text-anchor="middle">{escape(place)}</text>')
    for k, scene in enumerate(scenes):
        y = TOP + k * ROW
        out.append(f'<text x="{LEFT - 6}" y="{y + 13}" text-anchor="end" font-size="11">{escape(scene)}</text>')
        for i, level in enumerate(levels):
            for j, place in enumerate(places):
                if (scene, place, level) not in won:
                    continue
                method, over = won[scene, place, level]
                colour = of[method][0]
                x = LEFT + i * group + j * CELL
                text = SHORT.get(method, method) + ("" if method == "lod" else " -" if over is None else f" {over:.1f}")
                out.append(f'<rect x="{x}" y="{y}" width="{CELL - 2}" height="{ROW - 2}" rx="2" fill="{colour}" stroke="#b0b4bc" stroke-width="0.5"/>')
                out.append(f'<text x="{x + CELL / 2 - 1:.0f}" y="{y + 13}" text-anchor="middle" font-size="9" fill="{_on(colour)}">{escape(text)}</text>')
    return "\n".join(out + ["</svg>\n"])
