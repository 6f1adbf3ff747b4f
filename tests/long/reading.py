"""Output of programs, as numbers by row and column, and as a table of a page."""

import re


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def columns(width, names, head, digits):
    """Numbers of lines with a name of `width` characters and a number for each of `names`; the table contains those of `digits`."""

    def read(text):
        numbers, rows = {}, []
        for line in text.splitlines():
            found = re.findall(r"-?\d+\.\d+(?:e-?\d+)?", line[width:])
            name = line[:width].strip()
            if len(found) != len(names) or not name or re.search(r"[^\d\s.,%e+-]", line[width:]):
                continue
            numbers[name] = dict(zip(names, map(float, found)))
            rows.append([name] + [f"{numbers[name][n]:.{d}f}" for n, d in digits.items()])
        return numbers, markdown(head, rows)

    return read


def by_pattern(patterns):
    """Numbers by {(row, column): pattern}, each the pattern's last match in the text; no table."""

    def read(text):
        numbers = {}
        for (row, column), pattern in patterns.items():
            if found := re.findall(pattern, text):
                numbers.setdefault(row, {})[column] = float(found[-1])
        return numbers, ""

    return read
