"""Drawings of the linear solvers: matrix of a chain of six links, in the order of elimination, with the fill of the factors."""

from sketch import BLUE, GREY, INK, ORANGE, Sketch

LINKS = 6
# Unknowns of the chain: body k is 2k, the joint at its root is 2k + 1. A joint couples body k − 1 and body k.
PAIRS = {(2 * k + 1, 2 * k) for k in range(LINKS)} | {(2 * k + 1, 2 * k - 2) for k in range(1, LINKS)}


def coupled(i, j):
    return i == j or (i, j) in PAIRS or (j, i) in PAIRS


def from_the_tip():
    return [unknown for k in reversed(range(LINKS)) for unknown in (2 * k, 2 * k + 1)]


def bodies_first():
    return [2 * k for k in range(LINKS)] + [2 * k + 1 for k in range(LINKS)]


def least_degree():
    """Order of elimination by the number of remaining neighbours."""
    left = {i: {j for j in range(2 * LINKS) if j != i and coupled(i, j)} for i in range(2 * LINKS)}
    order = []
    while left:
        i = min(left, key=lambda k: (len(left[k]), k))
        for a in left[i]:
            left[a] |= left[i] - {a}
            left[a].discard(i)
        del left[i]
        order.append(i)
    return order


def filled(order):
    """Entries of the factors that are zero in the matrix."""
    n = len(order)
    entry = [[coupled(a, b) for b in order] for a in order]
    fill = set()
    for k in range(n):
        below = [i for i in range(k + 1, n) if entry[i][k]]
        for i in below:
            for j in below:
                if not entry[i][j]:
                    entry[i][j] = True
                    fill.add((i, j))
    return fill


def matrix(s, order, x0, y0, cell=15, lower=False, dense=False):
    n, fill = len(order), filled(order)
    for i in range(n):
        for j in range(n):
            colour = BLUE if coupled(order[i], order[j]) else ORANGE if dense or (i, j) in fill else "#ffffff"
            if lower and j > i:
                colour = "#f1f1f1" if colour == "#ffffff" else GREY
            x, y = x0 + cell * j, y0 + cell * i
            s.path([(x, y), (x + cell, y), (x + cell, y + cell), (x, y + cell)], colour="#dddddd", width=0.8, fill=colour, closed=True)
    s.path([(x0, y0), (x0 + n * cell, y0), (x0 + n * cell, y0 + n * cell), (x0, y0 + n * cell)], colour=INK, width=1.4, closed=True)


def drawing(title, order, **options):
    def draw():
        s = Sketch(title)
        matrix(s, order(), 115, 30, **options)
        return s

    return draw


def auto_lu():
    s = Sketch("Dense and sparse LU")
    matrix(s, bodies_first()[:3] + bodies_first()[6:9], 40, 75, 18, dense=True)
    matrix(s, least_degree(), 200, 30)
    s.text((-1.9, -1.35), "small: dense", size=13)
    s.text((1.6, -1.9), "large: sparse", size=13)
    return s


DRAWINGS = {
    "block_solver": drawing("Block solver", from_the_tip, lower=True),
    "block_ldlt": drawing("Block LDLᵀ", from_the_tip, lower=True),
    "block_lu": drawing("Block LU", from_the_tip),
    "dense_lu": drawing("Dense LU", bodies_first, dense=True),
    "eigen_sparse_lu": drawing("Sparse LU", least_degree),
    "auto_lu": auto_lu,
    "eigen_ldlt": drawing("Sparse LDLᵀ", least_degree, lower=True),
    "klu": drawing("KLU", least_degree),
}
