"""Writes dummy.obj: a tailor's dummy from the hips to the neck, in metres, y up.

A stack of ellipses, closed above and below; each row of PROFILE is a height, half the width, half the
depth, and how far the middle is to the front.

    python3 dummy.py > dummy.obj
"""

from math import cos, pi, sin

SIDES = 24
PROFILE = [
    (0.00, 0.150, 0.105, 0.000),
    (0.06, 0.170, 0.118, -0.004),
    (0.13, 0.174, 0.120, -0.006),
    (0.20, 0.160, 0.110, -0.002),
    (0.27, 0.137, 0.096, 0.002),
    (0.33, 0.131, 0.092, 0.004),
    (0.40, 0.140, 0.100, 0.006),
    (0.47, 0.157, 0.112, 0.010),
    (0.53, 0.169, 0.115, 0.008),
    (0.59, 0.182, 0.104, 0.000),
    (0.64, 0.194, 0.088, -0.006),
    (0.675, 0.190, 0.074, -0.010),
    (0.70, 0.165, 0.066, -0.012),
    (0.72, 0.122, 0.062, -0.012),
    (0.735, 0.082, 0.059, -0.010),
    (0.75, 0.062, 0.057, -0.006),
    (0.78, 0.056, 0.055, 0.000),
    (0.82, 0.054, 0.054, 0.004),
]


def main():
    print("# A tailor's dummy in metres, made by dummy.py.")
    for y, width, depth, front in PROFILE:
        for side in range(SIDES):
            angle = 2 * pi * side / SIDES
            print(f"v {width * sin(angle):.5f} {y:.5f} {front + depth * cos(angle):.5f}")
    for y, _, _, front in (PROFILE[0], PROFILE[-1]):
        print(f"v 0 {y:.5f} {front:.5f}")
    rings = len(PROFILE)
    bottom, top = rings * SIDES + 1, rings * SIDES + 2
    for side in range(SIDES):
        here, there = side + 1, (side + 1) % SIDES + 1
        print(f"f {bottom} {there} {here}")
        for ring in range(rings - 1):
            low, high = ring * SIDES, (ring + 1) * SIDES
            print(f"f {low + here} {low + there} {high + there} {high + here}")
        last = (rings - 1) * SIDES
        print(f"f {last + here} {last + there} {top}")


main()
