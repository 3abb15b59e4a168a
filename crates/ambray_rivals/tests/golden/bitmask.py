"""The visibility bitmask of Therrien et al. 2023 at quality High, from the paper alone, over xegtao.py's scene: makes bitmask.csv.

One slice, 16 even steps, 32 sectors that close when half of them is covered, thickness a quarter of the radius; noise, depth
pyramid and denoiser are XeGTAO's.

Run: python3 bitmask.py > bitmask.csv
"""

from math import acos, cos, hypot, log2, pi, sin, sqrt

from xegtao import FAR, HEIGHT, PIXELS, RADIUS, TAN_X, WIDTH
from xegtao import add, cross, dot, hilbert, normalize, pyramid, rows, sample_level, saturate, view_position

MIPS = pyramid(RADIUS)
STEPS, SECTORS, THICKNESS = 16, 32, RADIUS / 4


def angle_to(a, b):
    return acos(min(max(dot(a, b) / sqrt(dot(a, a)), -1), 1))


def openness(x, y):
    depth, normal = PIXELS[y][x]
    if depth == FAR:
        return 1.0
    u, v = (x + 0.5) / WIDTH, (y + 0.5) / HEIGHT
    centre = view_position(u, v, depth * 0.99999)
    view = normalize(tuple(-c for c in centre))
    radius_pixels = RADIUS / (centre[2] * 2 * TAN_X / WIDTH)
    index = hilbert(x % 64, y % 64)
    phi = (0.5 + index * 0.75487766624669276005) % 1 * pi
    direction = (cos(phi), sin(phi), 0.0)
    axis = normalize(cross(direction, view))
    tangent = cross(view, axis)
    projected = add(normal, axis, -dot(normal, axis))
    n = angle_to(projected, view) * (1 if dot(projected, tangent) > 0 else -1)
    n = min(max(n, -pi / 2), pi / 2)
    closed = [False] * SECTORS
    for step in range(STEPS):
        shift = ((0.5 + index * 0.5698402909980532659114) + step * STEPS * 0.6180339887498948482) % 1
        distance = (step + shift) / STEPS * radius_pixels + 1.3
        offset = (cos(phi) * distance, -sin(phi) * distance)
        mip = max(log2(hypot(*offset)) - 3.3, 0)
        for side in (1, -1):
            px, py = x + side * round(offset[0]), y + side * round(offset[1])
            if not (0 <= px < WIDTH and 0 <= py < HEIGHT):
                continue
            su, sv = (px + 0.5) / WIDTH, (py + 0.5) / HEIGHT
            sample_depth = sample_level(su, sv, mip, MIPS)
            if sample_depth == FAR:
                continue
            front = add(view_position(su, sv, sample_depth), centre, -1.0)
            back = add(front, view, -THICKNESS)
            ends = [saturate((side * angle_to(p, view) - n) / pi + 0.5) * SECTORS for p in (front, back)]
            for sector in range(SECTORS):
                covered = min(max(ends), sector + 1) - max(min(ends), sector)
                closed[sector] |= covered >= 0.5
    return 1 - sum(closed) / SECTORS


if __name__ == "__main__":
    print("# x,y,raw,filtered: made by bitmask.py, which says how.")
    print("\n".join(rows(openness)))
