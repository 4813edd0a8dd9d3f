"""Stiffness of thin-barred designs by the general 6x6 form in 60 digits: writes crates/model/tests/fixtures/thin_bars.json.

An implementation of its own, from the formulas of docs/model.md (virtual joint model, cantilever compliances at the tips, two
passive revolutes per leg), with mpmath. For bars thinner than 5 mm the same form in double precision loses digits, so
the closed form is checked against this.

    python crates/model/tests/tools/thin_bars.py > crates/model/tests/fixtures/thin_bars.json        (needs mpmath)
"""

import json
import random

from mpmath import matrix, mp, mpf, pi, radians, cos, sin, sqrt, zeros

mp.dps = 60
E, G, K_ACT = mpf("210e9"), mpf("80e9"), mpf("1e7")


def cantilever(length, radius):
    area = pi * radius**2
    i = pi * radius**4 / 4
    c = zeros(6)
    c[0, 0] = length / (E * area)
    c[1, 1] = c[2, 2] = length**3 / (3 * E * i)
    c[3, 3] = length / (G * 2 * i)
    c[4, 4] = c[5, 5] = length / (E * i)
    c[1, 5] = c[5, 1] = length**2 / (2 * E * i)
    c[2, 4] = c[4, 2] = -length**2 / (2 * E * i)
    return c


def mapped(compliance, axis, tip, p):
    """Return the compliance at p, in base axes, of a bar along `axis` with its tip at `tip`."""
    ax, ay = axis
    rotation = matrix([[ax, -ay, 0], [ay, ax, 0], [0, 0, 1]])
    lx, ly = p[0] - tip[0], p[1] - tip[1]
    # v_P = v + w x l  =  v - [l]x w
    cross = matrix([[0, 0, ly], [0, 0, -lx], [-ly, lx, 0]])
    j = zeros(6)
    j[0:3, 0:3] = rotation
    j[3:6, 3:6] = rotation
    j[0:3, 3:6] = -cross * rotation
    return j * compliance * j.T


def revolute(joint, p):
    return [-(p[1] - joint[1]), p[0] - joint[0], 0, 0, 0, 1]


def unit(v):
    n = sqrt(v[0] ** 2 + v[1] ** 2)
    return (v[0] / n, v[1] / n)


def stiffness(kind, d, x, y, phi):
    R, r, L, rj, rp = (mpf(repr(d[k])) for k in ("R", "r", "Lb", "rj", "rp"))
    p = (mpf(repr(x)), mpf(repr(y)))
    phi = radians(mpf(repr(phi)))
    angles = [radians(mpf(a)) for a in (210, 330, 90)]
    a = [(R * cos(t), R * sin(t)) for t in angles]
    c = [(p[0] + r * cos(t + phi), p[1] + r * sin(t + phi)) for t in angles]
    total = zeros(6)
    for i in range(3):
        s = zeros(6)
        ai, ci = a[i], c[i]
        if kind == "3-PRR":
            e = unit((a[(i + 1) % 3][0] - ai[0], a[(i + 1) % 3][1] - ai[1]))
            w = (ci[0] - ai[0], ci[1] - ai[1])
            along, height = w[0] * e[0] + w[1] * e[1], e[0] * w[1] - e[1] * w[0]
            if abs(height) >= L:
                return None
            rho = along + sqrt(L**2 - height**2)
            if not 0 <= rho <= sqrt(mpf(3)) * R:
                return None
            b = (ai[0] + rho * e[0], ai[1] + rho * e[1])
            t = matrix([e[0], e[1], 0, 0, 0, 0])
            s += t * t.T / K_ACT
            s += mapped(cantilever(L, rj), unit((ci[0] - b[0], ci[1] - b[1])), ci, p)
        elif kind == "3-RPR":
            b = ai
            rho = sqrt((ci[0] - ai[0]) ** 2 + (ci[1] - ai[1]) ** 2)
            if not L / 2 <= rho <= L:
                return None
            u = unit((ci[0] - ai[0], ci[1] - ai[1]))
            t = matrix([u[0], u[1], 0, 0, 0, 0])
            s += t * t.T / K_ACT
            s += mapped(cantilever(rho, rj), u, ci, p)
        else:
            h = (ci[0] - ai[0], ci[1] - ai[1])
            d2 = h[0] ** 2 + h[1] ** 2
            if d2 >= 4 * L**2:
                return None
            n = unit((-h[1], h[0]))
            q = sqrt(L**2 - d2 / 4)
            b = (ai[0] + h[0] / 2 + q * n[0], ai[1] + h[1] / 2 + q * n[1])
            t = matrix(revolute(ai, p))
            s += t * t.T / K_ACT
            s += mapped(cantilever(L, rj), unit((b[0] - ai[0], b[1] - ai[1])), b, p)
            s += mapped(cantilever(L, rj), unit((ci[0] - b[0], ci[1] - b[1])), ci, p)
        s += mapped(cantilever(r, rp), unit((p[0] - ci[0], p[1] - ci[1])), p, p)
        big = zeros(8)
        big[0:6, 0:6] = s
        for column, joint in enumerate((b, ci)):
            for row, value in enumerate(revolute(joint, p)):
                big[row, 6 + column] = value
                big[6 + column, row] = value
        total += (big**-1)[0:6, 0:6]
    return [[float(total[i, j]) for j in range(6)] for i in range(6)]


def main():
    random.seed(2010)
    cases = []
    for kind in ("3-PRR", "3-RPR", "3-RRR"):
        found = 0
        while found < 12:
            d = {
                "R": round(random.uniform(0.5, 4), 4),
                "r": round(random.uniform(0.1, 2), 4),
                "Lb": round(random.uniform(0.5, 4), 4),
                "rj": float(f"{10 ** random.uniform(-5, -2.3):.3g}"),
                "rp": float(f"{10 ** random.uniform(-5, -2.3):.3g}"),
            }
            x, y = round(random.uniform(-0.5, 0.5), 4), round(random.uniform(-0.5, 0.5), 4)
            phi = round(random.uniform(-60, 60), 2)
            k = stiffness(kind, d, x, y, phi)
            if k is None:
                continue
            found += 1
            cases.append({"architecture": kind, "design": d, "pose": {"x": x, "y": y, "phi_deg": phi}, "stiffness_matrix": k})
    print(json.dumps({"origin": "crates/model/tests/tools/thin_bars.py, mpmath with 60 digits", "poses": cases}, indent=1))


if __name__ == "__main__":
    main()
