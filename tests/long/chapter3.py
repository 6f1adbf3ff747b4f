"""Cases of Chapter 3: the runs whose numbers docs/tracked_vehicle.md quotes, marked CASE/ROW/COLUMN in its text.

A row is the subject of a line of the output, a column a quantity of it: "  path, penalty: taut 1.6 mm, slack 2.8 mm".
Processor times are printed as well, and are not quoted with a mark.

"""

import re

PAGE = "docs/tracked_vehicle.md"
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
    "shared_contacts": (PAGE, VEHICLE + "--shared-contacts --figure 3.7 --until 1", lines),
    "plateau_25": (PAGE, VEHICLE + "--until 20", lines),
    "plateau_30": (PAGE, VEHICLE + "--until 20 --speed 30", lines),
    "plateau_80": (PAGE, VEHICLE + "--until 20 --speed 80", lines),
    "halved": (PAGE, VEHICLE + "--halve --until 4", lines),
    "curve": (PAGE, VEHICLE + "--turn curve --until 20", lines),
    "pivot": (PAGE, VEHICLE + "--turn pivot --speed 10 --until 20", lines),
    "bumps": (PAGE, VEHICLE + "--bumps", lines),
    **{
        f"by_{integrator}": (PAGE, VEHICLE + f"--integrator {integrator} --until 0.1", lines)
        for integrator in ["generalised-alpha", "hht", "radau", "adams", "dormand-prince", "runge-kutta"]
    },
    "pin_cost": (PAGE, VEHICLE + "--compare cost", lines),
    "pin_cost_cables": (
        PAGE,
        VEHICLE + "--compare cost --body rigid,ancf --policy constraint,ancf-linear --integrator generalised-alpha",
        lines,
    ),
    "adams_pins": (PAGE, "track_times --until 0.2 --names", lines),
}
