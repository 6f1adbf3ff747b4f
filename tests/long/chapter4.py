"""The long runs of docs/track_stress.md and of its note. Numbers of a case may be marked in both."""

import re

from reading import by_pattern, columns, markdown

PAGE = "docs/track_stress.md"
NOTE = "docs/notes/track_stress-2026-11.md"
PINS = ["constraint", "penalty", "bushing", "ancf-linear", "joint-coordinates"]
REASONS = {  # by the first words of the sentence
    "AncfLinear needs markers that are linear": "nonlinear",
    "JointCoordinates supports joints between": "no frame",
    "This joint needs a marker with axes": "tangent only",
    "The slope vector that neighbouring links share": "fixed direction",
}


def matrix(text):
    """Numbers by (links, pins), and a table with a row for each kind of link."""
    numbers, cells, links = {}, {}, []
    for line in text.splitlines():
        words = line.split()
        if len(words) < 3 or words[1] not in PINS:
            continue
        if words[0] not in links:
            links.append(words[0])
        if words[2] == "cannot":
            cells[words[0], words[1]] = next(short for why, short in REASONS.items() if why in line)
            continue
        speeds, rows, _, _, _, forward, strain, force, gap, energy, *turning = map(float, words[2:])
        numbers[f"{words[0]} {words[1]}"] = {"speeds": speeds, "rows": rows, "forward": forward, "strain": strain,
                                             "force": force, "gap": gap, "energy": energy, **({"turning": turning[0]} if turning else {})}
        cells[words[0], words[1]] = f"{turning[0]:.5f}" if turning else f"{strain:.3f}"
    summary = re.search(r"(\d+) run, (\d+) cannot be.*within ([\d.]+) mm, strains within ([\d.]+) %.*at most ([\d.]+) %", text)
    numbers["all"] = dict(zip(["run", "refused", "apart", "strains apart", "energy"], map(float, summary.groups())))
    if turned := re.search(r"Yaw rates within ([\d.]+) %", text):
        numbers["all"]["yaw rates apart"] = float(turned[1])
    table = markdown(["links"] + [f"`{p}`" for p in PINS], [[f"`{k}`"] + [cells[k, p] for p in PINS] for k in links])
    return numbers, table


REPORT = {
    "plateau from": r"from ([\d.]+) s on: speed",
    "speed": r"speed ([\d.]+) m/s",
    "strain": r"strain ([\d.]+)e-5",
    "raw least": r"unfiltered (-?[\d.]+) to",
    "raw most": r"unfiltered -?[\d.]+ to (-?[\d.]+)e-5",
    "filtered most": r"strain [\d.]+e-5 \(-?[\d.]+ to (-?[\d.]+)\)",
    "T0": r"with T0 = ([\d.]+) kN",
    "running strain": r"tensioner: ([\d.]+)e-5",
    "forward": r"at the end ([\d.]+) m ahead",
    "fastest": r"at most ([\d.]+) m/s",
    "force least": r"front pin (-?[\d.]+) to",
    "force most": r"front pin -?[\d.]+ to (-?[\d.]+) kN",
    "bending least": r"middle, unfiltered: (-?[\d.]+) to",
    "bending most": r"middle, unfiltered: -?[\d.]+ to (-?[\d.]+) MPa",
    "bending rms": r"rms from 1 s on (-?[\d.]+) MPa",
    "bending off to 3 s": r"off rigid by ([\d.]+) % to 3 s",
    "bending off after": r"([\d.]+) % after",
    "off from 1 s": r"off ancf: ([\d.]+) % \(rms from 1\.0 s on\)",
    "halved": r"; (\d+) of \d+ steps halved",
    "vibrations off": r"by vibrations, low pass: ([\d.]+) %",
    "energy": r"([\d.]+) % not accounted for",
}
FATIGUE = {
    "cycles": r"^\w+ +(\d+) cycles",
    "largest range": r"largest range ([\d.]+) MPa",
    "equivalent range": r"equivalent range ([\d.]+) MPa",
}


def report(text):
    """Numbers of each formulation of the links; `all` has their minimum and maximum and the difference."""
    numbers = {}
    blocks = re.split(r"^(?=\w+ +from [\d.]+ s on: speed)", text, flags=re.MULTILINE)[1:]
    for block in blocks:
        found = {name: re.search(pattern, block) for name, pattern in REPORT.items()}
        numbers[block.split()[0]] = {name: float(m[1]) for name, m in found.items() if m}
    for line in re.findall(r"^\w+ +\d+ cycles.*", text, flags=re.MULTILINE):
        numbers[line.split()[0]].update({name: float(re.search(pattern, line)[1]) for name, pattern in FATIGUE.items()})
    links = list(numbers.values())
    names = set.intersection(*(set(of) for of in links))
    least = {name: min(of[name] for of in links) for name in names}
    most = {name: max(of[name] for of in links) for name in names}
    apart = {name: most[name] - least[name] for name in names}
    spread = {name: 100.0 * (most[name] / least[name] - 1.0) for name in names if least[name] > 0.0}
    return {**numbers, "least": least, "most": most, "apart": apart, "spread": spread}, ""


def rows_of(lines):
    """A table of {head: (columns of each kind of links)} in the order of LINKS."""

    def read(text):
        numbers, _ = report(text)
        return numbers, markdown(["", *LINKS], [[head] + [cell(numbers[k]) for k in LINKS] for head, cell in lines.items()])

    return read


LINKS = ["rigid", "ancf", "ffr", "lrvf", "beam", "continuum"]
links = rows_of({
    "strain, mean [10⁻⁵]": lambda of: f"{of['strain']:.3f}",
    "(T₀ + m v²/p)/EA [10⁻⁵]": lambda of: f"{of['running strain']:.3f}",
    "difference from the ANCF cables, rms from 1 s on [%]": lambda of: f"{of['off from 1 s']:.1f}" if "off from 1 s" in of else "–",
    "unexplained energy [%]": lambda of: f"{of['energy']:.3f}",
    "halved steps, of 10⁴": lambda of: f"{of['halved']:.0f}",
    "cycles of stress": lambda of: f"{of['cycles']:.0f}",
    "largest range [MPa]": lambda of: f"{of['largest range']:.2f}",
    "equivalent range [MPa]": lambda of: f"{of['equivalent range']:.3f}",
})
halve = by_pattern({("both", "apart"): r"filtered strain ([\d.]+) % apart"})
twenty = by_pattern({
    ("rigid", "strain"): r"rigid ([\d.]+)e-5", ("ancf", "strain"): r"ancf ([\d.]+)e-5",
    ("rigid", "stress"): r"rigid [\d.]+e-5, ([\d.]+) MPa", ("ancf", "stress"): r"ancf [\d.]+e-5, ([\d.]+) MPa",
    ("both", "apart"): r"at most ([\d.]+) MPa apart", ("both", "running strain"): r"/EA ([\d.]+)e-5"})



def numbers_of(read):
    """The numbers that `read` returns, without its table."""
    return lambda text: (read(text)[0], "")


def with_rows(read, rows):
    """The numbers that `read` returns, and derived rows: {row: {column: function of all rows}}."""

    def more(text):
        numbers, table = read(text)
        made = {row: {column: of(numbers) for column, of in columns_of.items()} for row, columns_of in rows.items()}
        return {**numbers, **made}, table

    return more


def peaks(numbers):
    return [100.0 * (of["most decoupled"] / of["most coupled"] - 1.0) for of in numbers.values()]


def worst_term(column, left_out=()):
    return lambda numbers: max(of[column] for name, of in numbers.items() if name not in left_out)


surface = columns(28, ["mean decoupled", "mean coupled", "most decoupled", "most coupled", "apart from 1 s", "apart", "apart, low pass"],
                  ["node", "mean, decoupled", "mean, coupled", "maximum, decoupled", "maximum, coupled", "rms difference [%]",
                   "difference below 15 Hz [%]"],
                  {"mean decoupled": 3, "mean coupled": 3, "most decoupled": 3, "most coupled": 3, "apart from 1 s": 1, "apart, low pass": 1})
terms = columns(52, ["strain", "low pass", "raw", "bending", "energy"],
                ["floating frames with", "strain [10⁻⁵]", "difference below 15 Hz [%]", "unfiltered [%]", "bending [%]",
                 "unexplained energy [%]"],
                {"strain": 4, "low pass": 2, "raw": 2, "bending": 2, "energy": 4})
ensemble = columns(26, ["decoupled", "vibrating", "coupled", "ratio", "off", "vibrating off", "largest decoupled", "largest coupled",
                        "equivalent decoupled", "equivalent coupled"],
                   ["setting", "decoupled", "decoupled, with vibrations", "coupled", "ratio of decoupled to coupled", "difference, rms [%]",
                    "largest range, decoupled [MPa]", "largest range, coupled [MPa]", "equivalent range, decoupled [MPa]",
                    "equivalent range, coupled [MPa]"],
                   {"decoupled": 3, "vibrating": 3, "coupled": 3, "ratio": 3, "off": 1, "largest decoupled": 2, "largest coupled": 2,
                    "equivalent decoupled": 3, "equivalent coupled": 3})

SURFACE = {"all": {
    "means apart": lambda numbers: max(100.0 * abs(of["mean decoupled"] / of["mean coupled"] - 1.0) for of in numbers.values()),
    "peaks higher": lambda numbers: max(peaks(numbers)),
    "peaks lower": lambda numbers: -min(peaks(numbers))}}
OTHER_MASS = "cables"  # prefix of the settings in which cables have another mass than rigid links
ENSEMBLE = {
    "same links": {"ratio off": lambda numbers: max(100.0 * abs(of["ratio"] - 1.0) for name, of in numbers.items()
                                                    if not name.startswith(OTHER_MASS))},
    "each": {"vibrating off": lambda numbers: max(of["vibrating off"] for of in numbers.values())}}
BENT = ("no m_rf", "none of these")
STIFFNESS = {"all": {"ratio off": lambda numbers: max(100.0 * abs(of["ratio"] - 1.0) for of in numbers.values())}}
TERMS = {"others": {"raw": worst_term("raw", BENT), "bending": worst_term("bending", BENT)}, "each": {"low pass": worst_term("low pass")}}

stiffness = columns(12, ["axial", "decoupled", "coupled", "ratio", "off", "apart"],
                    ["E / E of steel", "EA/p [MN/m]", "decoupled [10⁻⁵]", "coupled [10⁻⁵]", "ratio", "difference, rms [%]",
                     "positions apart [mm]"],
                    {"axial": 1, "decoupled": 3, "coupled": 3, "ratio": 3, "off": 1, "apart": 1})

CASES = {
    "matrix": (PAGE, "track_stress --compare matrix --until 3 --no-plot", matrix),
    "matrix_turn": (NOTE, "track_stress --compare matrix --turn curve --until 3 --no-plot", matrix),
    "matrix_pivot": (PAGE, "track_stress --compare matrix --turn pivot --speed 10 --until 3 --no-plot", numbers_of(matrix)),
    "links_bumps": (PAGE, "track_stress --compare links --bumps --audit --until 7 --no-plot", report),
    "surface_30": (PAGE, "track_stress --compare surface --until 10 --no-plot", with_rows(surface, SURFACE)),
    "surface_80": (NOTE, "track_stress --compare surface --until 10 --speed 80 --no-plot", with_rows(surface, SURFACE)),
    "terms": (PAGE, "track_stress --compare terms --until 4 --speed 80 --no-plot", with_rows(terms, TERMS)),
    "stiffness": (PAGE, "track_stress --compare stiffness --until 4 --no-plot", with_rows(stiffness, STIFFNESS)),
    "links_30": (NOTE, "track_stress --compare --audit --fatigue --no-plot", links),
    "links_80": (NOTE, "track_stress --compare --audit --fatigue --speed 80 --no-plot", links),
    "twenty": (PAGE, "track_stress --figure 4.11 --no-plot", twenty),
    "halved_ancf": (PAGE, "track_stress --body ancf --halve --no-plot", halve),
    "halved_rigid": (PAGE, "track_stress --body rigid --halve --until 4 --no-plot", halve),
    "bending_30": (PAGE, "track_stress --compare pair --elements 2 --no-plot", report),
    "bending_80": (PAGE, "track_stress --compare pair --elements 2 --speed 80 --no-plot", report),
    "ensemble_30": (NOTE, "track_stress --compare ensemble --no-plot", with_rows(ensemble, ENSEMBLE)),
    "ensemble_80": (NOTE, "track_stress --compare ensemble --speed 80 --no-plot", with_rows(ensemble, ENSEMBLE)),
}
