"""The map of docs/who-wins.md as a picture: in each view and at each error the cheapest method, in the colours of src/report/palette.rs."""

from html import escape

from plot import styles

CELL, ROW, LEFT, TOP, GAP = 64, 19, 168, 62, 14
# Names that fit a cell.
SHORT = {"discrete": "level", "cluster-paper": "paper's", "input-bvh": "bvh*", "input-bvh6": "bvh6*"}


def drawn(title, note, views, groups):
    """An SVG, with `note` below: a row for each view, by name; `groups` are blocks of columns side by side, each a name and its columns, each a name and by view the cheapest method with what ours takes over it (None if ours cannot)."""
    # On light paper some are too dark to be told apart as areas.
    of = styles(dark=True)
    wide = LEFT + sum(len(columns) * CELL + GAP for _, columns in groups)
    tall = TOP + len(views) * ROW + 26
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {tall}" font-family="sans-serif" font-size="10" fill="#464c56">']
    out.append(f'<rect width="{wide}" height="{tall}" fill="white"/><text x="8" y="18" font-size="13">{escape(title)}</text>')
    for k, view in enumerate(views):
        out.append(f'<text x="{LEFT - 6}" y="{TOP + k * ROW + 13}" text-anchor="end" font-size="11">{escape(view)}</text>')
    out.append(f'<text x="8" y="{tall - 9}" font-size="11">{escape(note)}</text>')
    left = LEFT
    for name, columns in groups:
        out.append(f'<text x="{left + len(columns) * CELL / 2:.0f}" y="38" text-anchor="middle" font-size="12">{escape(name)}</text>')
        for column, won in columns:
            out.append(f'<text x="{left + CELL / 2:.0f}" y="54" text-anchor="middle">{escape(column)}</text>')
            for k, view in enumerate(views):
                if view in won:
                    method, over = won[view]
                    text = SHORT.get(method, method) + ("" if method == "lod" else " -" if over is None else f" {over:.1f}")
                    out.append(f'<rect x="{left}" y="{TOP + k * ROW}" width="{CELL - 2}" height="{ROW - 2}" rx="2" fill="{of[method][0]}" stroke="#b0b4bc" stroke-width="0.5"/>')
                    out.append(f'<text x="{left + CELL / 2 - 1:.0f}" y="{TOP + k * ROW + 12}" text-anchor="middle" font-size="9" fill="#202020">{escape(text)}</text>')
            left += CELL
        left += GAP
    return "\n".join(out + ["</svg>\n"])
