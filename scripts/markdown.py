"""Tables of Markdown, and where they stand in documents."""


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
