"""Cases of Chapter 3: the runs whose numbers docs/tracked_vehicle.md and docs/chapter3 quote, marked CASE/ROW/COLUMN in its text.

A row is the subject of a line of the output, a column a quantity of it: "  path, penalty: taut 1.6 mm, slack 2.8 mm".
Processor times are printed as well, and are not quoted with a mark.

"""

import re

PAGE = "docs/tracked_vehicle.md"
MODEL, RUNS, COST, COMBINATIONS = (f"docs/chapter3/{name}.md" for name in ["model", "runs", "cost", "combinations"])
PAGES = {PAGE, MODEL, RUNS, COST, COMBINATIONS}
VEHICLE = "tracked_vehicle --no-plot "
QUANTITY = re.compile(r"(\S.*) (-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)(?: \S+)?")


def lines(text):
    """Numbers by the subject of a line and by quantity; there is no table."""
    numbers = {}
    for line in text.splitlines():
        row, colon, rest = line.partition(": ")
        found = [QUANTITY.fullmatch(part) for part in rest.partition(";")[0].split(", ")]
        if colon and re.match(r"  \S", row) and all(found):
            numbers[row.strip()] = {quantity: float(number) for quantity, number in (f.groups() for f in found)}
    return numbers, ""


CASES = {
    "table_3_4": (PAGE, VEHICLE + "--figure table", lines),
    "figures_3": (PAGE, VEHICLE + "--figure all --audit", lines),
    "shared_contacts": (MODEL, VEHICLE + "--shared-contacts --figure 3.7 --until 1", lines),
    "plateau_25": (RUNS, VEHICLE + "--until 20", lines),
    "plateau_30": (RUNS, VEHICLE + "--until 20 --speed 30", lines),
    "plateau_80": (RUNS, VEHICLE + "--until 20 --speed 80", lines),
    "halved": (RUNS, VEHICLE + "--halve --until 4", lines),
    "curve": (RUNS, VEHICLE + "--turn curve --until 20", lines),
    "pivot": (RUNS, VEHICLE + "--turn pivot --speed 10 --until 20", lines),
    "links_3": (RUNS, VEHICLE + "--body rigid,lrvf,se3 --policy constraint,penalty,bushing --until 3", lines),
    "bumps": (RUNS, VEHICLE + "--bumps", lines),
    **{
        f"by_{integrator}": (COST, VEHICLE + f"--integrator {integrator} --until 0.1", lines)
        for integrator in ["generalised-alpha", "hht", "radau", "adams", "dormand-prince", "runge-kutta"]
    },
    "pin_cost": (COST, VEHICLE + "--compare cost", lines),
    "pin_cost_cables": (
        COST,
        VEHICLE + "--compare cost --body rigid,ancf --policy constraint,ancf-linear --integrator generalised-alpha",
        lines,
    ),
    "adams_pins": (COST, "track_times --until 0.2 --names", lines),
}
