"""Tables of Markdown, their numbers, and where they stand in documents."""


def table(head, rows, left):
    """The first `left` columns stand on the left, all others, numbers, on the right."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * left + "---:|" * (len(head) - left)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def put(path, begin, end, text):
    """Replaces what stands between two marks of a document, each a line of its own."""
    whole = path.read_text(encoding="utf-8")
    if whole.count(f"{begin}\n") != 1 or end not in whole.split(f"{begin}\n")[1]:
        raise SystemExit(f"{path} has no marks {begin} and {end}")
    head, rest = whole.split(f"{begin}\n")
    path.write_text(f"{head}{begin}\n{text}\n{end}{rest.split(end, 1)[1]}", encoding="utf-8")


def number(value, digits=3):
    """A number with so many digits that count, with commas where it is large."""
    if value >= 10 ** (digits - 1):
        return f"{value:,.0f}"
    return f"{value:.{digits}g}"


def among(values):
    """The least and the most of some numbers."""
    low, high = number(min(values)), number(max(values))
    return low if low == high else f"{low} to {high}"
