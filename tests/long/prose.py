"""Numbers in the text of a page: marked numbers, which a case prints, and given numbers."""

import re

NUMBER = r"[−-]?\d+(?:\.\d+)?(?:e[−-]?\d+)?"
MARK = re.compile(rf"({NUMBER})<!--(<= |>= )?([^/>]+)/([^/>]+)/([^/>]+)-->")
# Numbers that need no source: code, tables of cases, marked numbers; identifiers, links, names of figures, years of
# sources, powers of ten after a number.
MADE = [r"```.*?```", r"<!-- tests/long: .*?<!-- end -->", MARK.pattern]
SILENT = [r"`[^`]*`", r"\]\([^)]*\)", r"\[[^\]\n]*\d{4}[a-z]?\]",
          r"(?:Figures?|Fig\.|Tables?|Chapters?|ch\.|§)\s*\(?\d+(?:\.\d+)*[ab]?\)?(?:(?:,| and| to|–|-)\s*\(?\d+(?:\.\d+)+[ab]?\)?)*",
          r"PhD thesis, [^,]*,\s*\d{4}", r"at Chicago, \d{4}, Chapter \d",
          r"·10[⁻⁰¹²³⁴-⁹]+", r"\[10[⁻⁰¹²³⁴-⁹]+\]"]


def value(written):
    return float(written.replace("−", "-"))


def as_written(found, written):
    """`found` with the digits of `written`."""
    mantissa, power, _ = written.partition("e")
    decimals = len(mantissa.partition(".")[2])
    if not power:
        return f"{found:.{decimals}f}".replace("-", "−")
    digits, _, exponent = f"{found:.{decimals}e}".partition("e")
    return f"{digits}e{int(exponent)}"


def marked_numbers(text, case, numbers):
    """The text with the corrected numbers of this case, and (fault, True if the correction removes it) for each wrong one."""
    faults = []

    def right(match):
        written, bound, of, row, column = match.groups()
        if of != case:
            return match[0]
        found = numbers.get(row, {}).get(column)
        name = f"'{written}' of {row}, {column}"
        if found is None:
            faults.append((f"{name}: the command prints no such number.", False))
            return match[0]
        if bound:
            if found > value(written) if bound == "<= " else found < value(written):
                faults.append((f"{name} is a bound, but the command prints {found:g}.", False))
            return match[0]
        rounded = as_written(found, written)
        if value(rounded) == value(written):
            return match[0]
        faults.append((f"{name}: the command prints {found:g}.", True))
        return rounded + match[0][len(written):]

    return MARK.sub(right, text), faults


def numbers_without_source(text, cases, given):
    """Faults: marks without a case, numbers without a mark outside given phrases, and given phrases that are not in the text."""
    faults = [f"'{m[0]}' names no case." for m in MARK.finditer(text) if m[3] not in cases]
    blank = lambda m: "\n" * m[0].count("\n") + " "
    for pattern in MADE:
        text = re.sub(pattern, blank, text, flags=re.DOTALL)
    for phrase in sorted(given, key=len, reverse=True):
        text, found = re.subn(rf"(?<![\w.]){re.escape(phrase)}(?!\w)", " ", text)
        if not found:
            faults.append(f"'{phrase}', given by {given[phrase]}, is not in the page.")
    for pattern in SILENT:
        text = re.sub(pattern, blank, text, flags=re.DOTALL)
    for number, line in enumerate(text.splitlines(), 1):
        for match in re.finditer(rf"(?<![\w.₀-₉⁰-⁹]){NUMBER}(?![\w]*[A-Za-z_]\w)", line):
            faults.append(f"line {number}: {match[0]} has no source: ...{line[max(0, match.start() - 40):match.end() + 20].strip()}...")
    return faults
