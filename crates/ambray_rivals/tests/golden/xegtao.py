"""XeGTAO at its defaults (quality High, denoiser "sharp"), after the text of its shaders (XeGTAO 1.30): makes xegtao.csv.

In double precision, in the shaders' own terms (texture coordinates, quads of depths) and sharing nothing with the Rust. It differs
from the shaders where the crate says that it does: exact inverse cosines, no rounding to 8 bits, and no samples in the sky. The
scene is a ball on a floor before the sky; the camera looks along -z from the origin, and view space has z away from it.

Run: python3 xegtao.py > xegtao.csv
"""

from math import acos, cos, hypot, log2, pi, sin, sqrt, tan

WIDTH, HEIGHT, FOV_Y, RADIUS = 96, 64, 0.9, 1.6
FLOOR, BALL, BALL_RADIUS = -1.0, (0.3, -0.4, 4.0), 0.6
FAR = float("inf")

TAN_Y = tan(FOV_Y / 2)
TAN_X = TAN_Y * WIDTH / HEIGHT


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def add(a, b, scale=1.0):
    return tuple(p + scale * q for p, q in zip(a, b))


def normalize(a):
    return tuple(p / sqrt(dot(a, a)) for p in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def saturate(x):
    return min(max(x, 0.0), 1.0)


def view_position(u, v, depth):
    """The point at texture coordinates (u, v), view space: x right, y up, z away."""
    return ((2 * u - 1) * TAN_X * depth, (1 - 2 * v) * TAN_Y * depth, depth)


def see(x, y):
    """Depth and normal of a pixel."""
    ray = normalize(view_position((x + 0.5) / WIDTH, (y + 0.5) / HEIGHT, 1.0))
    best = (FAR, None)
    if ray[1] < 0:
        best = (FLOOR / ray[1], (0.0, 1.0, 0.0))
    along = dot(ray, BALL)
    disc = along**2 - dot(BALL, BALL) + BALL_RADIUS**2
    if disc > 0 and along - sqrt(disc) < best[0]:
        t = along - sqrt(disc)
        best = (t, normalize(add(tuple(t * c for c in ray), BALL, -1.0)))
    t, normal = best
    return (t * ray[2], normal) if normal else (FAR, None)


def weights(radius):
    """The falloff as a multiplication and an addition."""
    width = 0.615 * radius
    start = radius * (1 - 0.615)
    return -1 / width, start / width + 1


def mip_filter(quad, radius):
    farthest = max(quad)
    if farthest == FAR:
        return FAR
    mul, plus = weights(0.75 * radius)
    w = [saturate((farthest - d) * mul + plus) for d in quad]
    return sum(a * b for a, b in zip(w, quad)) / sum(w)


def hilbert(x, y):
    index, level = 0, 32
    while level > 0:
        region_x, region_y = int(x & level > 0), int(y & level > 0)
        index += level * level * ((3 * region_x) ^ region_y)
        if region_y == 0:
            if region_x == 1:
                x, y = 63 - x, 63 - y
            x, y = y, x
        level //= 2
    return index


PIXELS = [[see(x, y) for x in range(WIDTH)] for y in range(HEIGHT)]


def pyramid(radius):
    mips = [[[p[0] for p in row] for row in PIXELS]]
    while len(mips) < 5:
        fine = mips[-1]
        quads = [
            [(fine[y][x], fine[y][x + 1], fine[y + 1][x], fine[y + 1][x + 1]) for x in range(0, len(fine[0]), 2)]
            for y in range(0, len(fine), 2)
        ]
        mips.append([[mip_filter(quad, radius) for quad in row] for row in quads])
    return mips


MIPS = pyramid(RADIUS * 1.457)


def sample_level(u, v, mip, mips=MIPS):
    """A point sampler that clamps."""
    texture = mips[min(round(mip), 4)]
    h, w = len(texture), len(texture[0])
    return texture[min(max(int(v * h // 1), 0), h - 1)][min(max(int(u * w // 1), 0), w - 1)]


def main_pass(x, y):
    depth, normal = PIXELS[y][x]
    if depth == FAR:
        return 1.0
    u, v = (x + 0.5) / WIDTH, (y + 0.5) / HEIGHT
    depth *= 0.99999
    centre = view_position(u, v, depth)
    view = normalize(tuple(-c for c in centre))
    radius = RADIUS * 1.457
    mul, plus = weights(radius)
    index = hilbert(x % 64, y % 64)
    noise_slice, noise_sample = (0.5 + index * 0.75487766624669276005) % 1, (0.5 + index * 0.5698402909980532659114) % 1
    screen_radius = radius / (depth * 2 * TAN_X / WIDTH)
    visibility = saturate((10 - screen_radius) / 100) * 0.5
    min_s = 1.3 / screen_radius
    slices, steps = 3, 3
    for slice_ in range(slices):
        phi = (slice_ + noise_slice) / slices * pi
        omega = (cos(phi) * screen_radius, -sin(phi) * screen_radius)
        direction = (cos(phi), sin(phi), 0.0)
        ortho = add(direction, view, -dot(direction, view))
        axis = normalize(cross(ortho, view))
        projected = add(normal, axis, -dot(normal, axis))
        sign = (dot(ortho, projected) > 0) - (dot(ortho, projected) < 0)
        length = sqrt(dot(projected, projected))
        cos_norm = saturate(dot(projected, view) / length)
        n = sign * acos(cos_norm)
        low = [cos(n + pi / 2), cos(n - pi / 2)]
        high = list(low)
        for step in range(steps):
            shift = (noise_sample + (slice_ + step * steps) * 0.6180339887498948482) % 1
            s = ((step + shift) / steps) ** 2 + min_s
            offset = (s * omega[0], s * omega[1])
            mip = min(max(log2(hypot(*offset)) - 3.3, 0), 5)
            offset = (round(offset[0]) / WIDTH, round(offset[1]) / HEIGHT)
            for side, way in ((0, 1), (1, -1)):
                su, sv = u + way * offset[0], v + way * offset[1]
                sample_depth = sample_level(su, sv, mip)
                if sample_depth == FAR:
                    continue
                delta = add(view_position(su, sv, sample_depth), centre, -1.0)
                distance = sqrt(dot(delta, delta))
                weight = saturate(distance * mul + plus)
                shc = dot(delta, view) / distance
                high[side] = max(high[side], low[side] + (shc - low[side]) * weight)
        length += (1 - length) * 0.05
        h0, h1 = -acos(min(max(high[1], -1), 1)), acos(min(max(high[0], -1), 1))
        for h in (h0, h1):
            visibility += length * (cos_norm + 2 * h * sin(n) - cos(2 * h - n)) / 4
    # Stored as a fraction of 1.5.
    return min(max(0.03, (visibility / slices) ** 2.2), 1.5)


def clamped(grid, x, y):
    return grid[min(max(y, 0), HEIGHT - 1)][min(max(x, 0), WIDTH - 1)]


def packed_edges(x, y):
    centre = MIPS[0][y][x]
    if centre == FAR:
        return (0.0,) * 4
    l, r, t, b = (clamped(MIPS[0], x + dx, y + dy) - centre for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)))
    slope_lr, slope_tb = (r - l) / 2, (b - t) / 2
    adjusted = (l + slope_lr, r - slope_lr, t + slope_tb, b - slope_tb)
    # HLSL's min takes the number where the other one is none.
    jumps = [abs(e) if a != a else min(abs(e), abs(a)) for e, a in zip((l, r, t, b), adjusted)]
    return tuple(round(saturate(1.25 - j / (centre * 0.011)) * 2.9) / 3 for j in jumps)


def denoise(raw, edges, x, y):
    if MIPS[0][y][x] == FAR:
        return 1.0
    el, er, et, eb = (clamped(edges, x + dx, y + dy) for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)))
    c = edges[y][x]
    c = (c[0] * el[1], c[1] * er[0], c[2] * et[3], c[3] * eb[2])
    edginess = saturate(4.0 - 2.5 - sum(c)) / (4 - 2.5) * 0.5
    c = tuple(saturate(e + edginess) for e in c)
    d = 0.85 * 0.5
    taps = (
        ((0, 0), 1.2),
        ((-1, 0), c[0]),
        ((1, 0), c[1]),
        ((0, -1), c[2]),
        ((0, 1), c[3]),
        ((-1, -1), d * (c[0] * el[2] + c[2] * et[0])),
        ((1, -1), d * (c[2] * et[1] + c[1] * er[2])),
        ((-1, 1), d * (c[3] * eb[0] + c[0] * el[3])),
        ((1, 1), d * (c[1] * er[3] + c[3] * eb[1])),
    )
    total = sum(w * clamped(raw, x + dx, y + dy) for (dx, dy), w in taps)
    return min(total / sum(w for _, w in taps), 1.0)


def rows(value):
    """The values of every fourth row's every fifth pixel, before and after the denoiser."""
    raw = [[value(x, y) for x in range(WIDTH)] for y in range(HEIGHT)]
    edges = [[packed_edges(x, y) for x in range(WIDTH)] for y in range(HEIGHT)]
    for y in range(1, HEIGHT, 4):
        for x in range(2, WIDTH, 5):
            yield f"{x},{y},{raw[y][x]:.6f},{denoise(raw, edges, x, y):.6f}"


if __name__ == "__main__":
    print("# x,y,raw,filtered: made by xegtao.py, which says how.")
    print("\n".join(rows(main_pass)))
