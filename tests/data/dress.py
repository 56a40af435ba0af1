"""Writes dress.obj and dress.toml: a shirt of two panels for dummy.obj, which is sewn, slit in front, and ripped.

    python3 dress.py
"""

STEP = 0.03
ROWS = 24  # from the hem to the top of the shoulders
HEM = 0.09
HALF = 9  # columns to each side
ARMHOLE = 13  # the row where the sides end
NECK = 21  # the row where the neck begins
SHOULDER = range(3, 8)  # the points of a shoulder, to each side
FAR = 0.19  # of a panel from the middle of the dummy

SCENE = """\
# A shirt is sewn round a tailor's dummy, hangs from its shoulders, is slit in front, and is ripped at the hem.
seconds = 4.0
drag_per_s = 2

[fabric]
density_kg_per_m2 = 0.2
modulus_n_per_m = 1000

[[collider]]
body = "dummy.obj"
cell_m = 0.008
thickness_m = 0.006
friction = 0.4

[[cut]]
at_s = 2.0
rays = ["0,0.14,0:0,0,1", "0,0.34,0:0,0,1"]

[[hold]]
from_s = 2.2
from = [0.02, 0.08, 0.1]
to = [0.13, 0.13, 0.3]
moves = [[2.2, 0, 0, 0], [3.8, 0.1, 0.3, 0.55]]

[tear]
threshold = 1.5
"""


def is_cut_away(column, row):
    """Whether the cell to the right of a column and above a row is no cloth."""
    aside = abs(column + 0.5)
    return (row >= ARMHOLE and aside > SHOULDER[-1]) or (row >= NECK and aside < SHOULDER[0])


def seam(name, places, number):
    one = [1 + number[at] for at in places]
    return f'\n[[seam]]\nname = "{name}"\none = {one}\nother = {[v + len(number) for v in one]}\n'


def main():
    cells = [(i, j) for j in range(ROWS) for i in range(-HALF, HALF) if not is_cut_away(i, j)]
    used = {(i + a, j + b) for i, j in cells for a in (0, 1) for b in (0, 1)}
    number = {at: k for k, at in enumerate(sorted(used, key=lambda at: at[::-1]))}
    lines = ["# A shirt of two panels for dummy.obj in metres, made by dress.py."]
    for name, side in (("front", 1), ("back", -1)):
        lines.append(f"o {name}")
        lines += [f"v {i * STEP:.2f} {HEM + j * STEP:.2f} {side * FAR}" for i, j in number]
        first = 1 if side > 0 else 1 + len(number)
        for i, j in cells:
            a, b, c, d = (first + number[at] for at in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
            faces = ((a, b, c), (a, c, d)) if (i + j) % 2 else ((a, b, d), (b, c, d))
            lines += ["f {} {} {}".format(*face[::side]) for face in faces]
    sides = [("left", -1), ("right", 1)]
    seams = [seam(f"{name} side", [(side * HALF, j) for j in range(ARMHOLE + 1)], number) for name, side in sides]
    seams += [seam(f"{name} shoulder", [(side * i, ROWS) for i in SHOULDER], number) for name, side in sides]
    with open("dress.obj", "w") as out:
        out.write("\n".join(lines) + "\n")
    with open("dress.toml", "w") as out:
        out.write(SCENE + "".join(seams))


main()
