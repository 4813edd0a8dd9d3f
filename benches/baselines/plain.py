"""The evaluation in NumPy, as a user of NumPy would write it: 6x6 virtual-joint stiffness by matrix algebra, with all
rays of all orientations of the reference grid marched in parallel.

    python benches/baselines/plain.py            # time per pose, and R_w of five designs
"""

import math
import time

import numpy as np

E, G, K_ACT = 210e9, 80e9, 1e7
LEAST = dict(condition=0.1, k_xy=1e6, k_z=1e5, k_phi_z=10 / math.radians(1))
ANGLES = np.radians([210.0, 330.0, 90.0])
DESIGNS = {
    "ID-I": ("3-PRR", 1.412, 0.319, 0.620, 0.026, 0.023),
    "ID-II": ("3-PRR", 3.066, 1.283, 1.896, 0.036, 0.056),
    "ID-III": ("3-PRR", 3.872, 1.947, 1.977, 0.039, 0.096),
    "3-RPR": ("3-RPR", 2.0, 0.8, 2.4, 0.05, 0.05),
    "3-RRR": ("3-RRR", 2.0, 0.8, 1.6, 0.05, 0.05),
}


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def legs(design, x, y, phi):
    """Return anchors, elbows and ends of the legs, the unit vectors of the last links, the transmissions, and the
    poses that all legs reach."""
    kind, R, r, L, _, _ = design
    a = R * np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=-1)
    turned = phi[:, None] + ANGLES
    arm = r * np.stack([np.cos(turned), np.sin(turned)], axis=-1)
    c = np.stack([x, y], axis=-1)[:, None, :] + arm
    v = c - a
    with np.errstate(invalid="ignore", divide="ignore"):
        if kind == "3-PRR":
            e = np.roll(a, -1, axis=0) - a
            e = e / np.linalg.norm(e, axis=-1, keepdims=True)
            h = cross(e, v)
            rho = np.sum(v * e, axis=-1) + np.sqrt(L**2 - h**2)
            reach = (np.abs(h) <= L) & (rho >= 0) & (rho <= math.sqrt(3) * R)
            b = a + rho[..., None] * e
            u = (c - b) / L
            drive = np.sum(u * e, axis=-1)
        elif kind == "3-RPR":
            rho = np.linalg.norm(v, axis=-1)
            reach = (rho >= L / 2) & (rho <= L)
            b = np.broadcast_to(a, c.shape)
            u = v / rho[..., None]
            drive = np.ones_like(rho)
        else:
            d = np.linalg.norm(v, axis=-1)
            reach = (d <= 2 * L) & (d > 0)
            n = np.stack([-v[..., 1], v[..., 0]], axis=-1) / d[..., None]
            b = (a + c) / 2 + np.sqrt(L**2 - d**2 / 4)[..., None] * n
            u = (c - b) / L
            drive = cross(b - a, u)
    return a, b, c, arm, u, drive, reach.all(axis=1)


def bar(radius, length):
    """Return the compliance at the tip of a cantilever, in the axes of the cantilever."""
    area, inertia = math.pi * radius**2, math.pi * radius**4 / 4
    L = np.asarray(length, dtype=float)
    C = np.zeros(L.shape + (6, 6))
    C[..., 0, 0] = L / (E * area)
    C[..., 1, 1] = C[..., 2, 2] = L**3 / (3 * E * inertia)
    C[..., 3, 3] = L / (G * 2 * inertia)
    C[..., 4, 4] = C[..., 5, 5] = L / (E * inertia)
    C[..., 1, 5] = C[..., 5, 1] = L**2 / (2 * E * inertia)
    C[..., 2, 4] = C[..., 4, 2] = -(L**2) / (2 * E * inertia)
    return C


def spring(C, axis, tip, p):
    """Return the compliance at P of a spring at the tip of a bar."""
    n = axis.shape[:-1]
    rotation = np.zeros(n + (3, 3))
    rotation[..., 0, 0], rotation[..., 1, 0] = axis[..., 0], axis[..., 1]
    rotation[..., 0, 1], rotation[..., 1, 1] = -axis[..., 1], axis[..., 0]
    rotation[..., 2, 2] = 1
    d = p - tip
    lever = np.zeros(n + (3, 3))
    lever[..., 0, 2], lever[..., 1, 2] = -d[..., 1], d[..., 0]
    lever[..., 2, 0], lever[..., 2, 1] = d[..., 1], -d[..., 0]
    J = np.zeros(n + (6, 6))
    J[..., :3, :3] = J[..., 3:, 3:] = rotation
    J[..., :3, 3:] = lever @ rotation
    return J @ C @ np.swapaxes(J, -1, -2)


def revolute(joint, p):
    d = p - joint
    twist = np.zeros(d.shape[:-1] + (6,))
    twist[..., 0], twist[..., 1], twist[..., 5] = -d[..., 1], d[..., 0], 1
    return twist


def stiffness(design, a, b, c, arm, u, p):
    """Return the 6x6 stiffness at P."""
    kind, R, r, L, rj, rp = design
    K = np.zeros(p.shape[:1] + (6, 6))
    for i in range(3):
        if kind == "3-RRR":
            twist = revolute(np.broadcast_to(a[i], p.shape), p)
        else:
            axis = u[:, i] if kind == "3-RPR" else np.broadcast_to((a[(i + 1) % 3] - a[i]) / (math.sqrt(3) * R), p.shape)
            twist = np.zeros(p.shape[:1] + (6,))
            twist[:, :2] = axis
        S = twist[:, :, None] * twist[:, None, :] / K_ACT
        if kind == "3-RRR":
            S += spring(bar(rj, L), (b[:, i] - a[i]) / L, b[:, i], p)
        S += spring(bar(rj, np.linalg.norm(c[:, i] - b[:, i], axis=-1)), u[:, i], c[:, i], p)
        S += spring(bar(rp, r), -arm[:, i] / r, p, p)
        J = np.stack([revolute(b[:, i], p), revolute(c[:, i], p)], axis=-1)
        system = np.zeros(p.shape[:1] + (8, 8))
        system[:, :6, :6] = S
        system[:, :6, 6:] = J
        system[:, 6:, :6] = np.swapaxes(J, -1, -2)
        K += np.linalg.inv(system)[:, :6, :6]
    return K


def values(design, x, y, phi):
    """Return which poses are feasible, and the sign of det A."""
    a, b, c, arm, u, drive, reach = legs(design, x, y, phi)
    good, sign = np.zeros(x.shape, bool), np.zeros(x.shape)
    if not reach.any():
        return good, sign
    b, c, arm, u, drive = (column[reach] for column in (b, c, arm, u, drive))
    p = np.stack([x, y], axis=-1)[reach]
    A = np.concatenate([u, cross(arm, u)[..., None]], axis=-1)
    determinant = np.linalg.det(A)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = A / drive[..., None]
        inverse[..., 2] /= design[2]
        M = np.swapaxes(inverse, -1, -2) @ inverse
        trace = np.trace(M, axis1=-2, axis2=-1)
        # The trace of the cofactor matrix divided by the determinant is the trace of the inverse.
        second = 0.5 * (trace**2 - np.trace(M @ M, axis1=-2, axis2=-1)) / np.linalg.det(M)
        condition = 3 / np.sqrt(trace * second)
    K = stiffness(design, a, b, c, arm, u, p)
    k_xy = np.linalg.eigvalsh(K[:, :2, :2])[:, 0]
    good[reach] = (
        (condition >= LEAST["condition"])
        & (k_xy >= LEAST["k_xy"])
        & (K[:, 2, 2] >= LEAST["k_z"])
        & (K[:, 5, 5] >= LEAST["k_phi_z"])
    )
    sign[reach] = np.sign(determinant)
    return good, sign


def workspace_radius(design):
    """Return R_w on the reference grid and the number of poses evaluated."""
    phi = np.radians(np.arange(144) * 2.5)
    angle = np.radians(np.arange(36) * 10.0)
    step = design[1] / 50
    good, sign = values(design, np.zeros(144), np.zeros(144), phi)
    poses = 144
    sign = np.where(good, sign, 0)
    ray_phi, ray_angle = (grid.ravel() for grid in np.meshgrid(phi, angle, indexing="ij"))
    ray_sign = np.repeat(sign, 36)
    low = np.zeros(ray_phi.shape)
    alive = ray_sign != 0

    def passes(rays, radius):
        nonlocal poses
        poses += rays.size
        x, y = radius * np.cos(ray_angle[rays]), radius * np.sin(ray_angle[rays])
        good, sign = values(design, x, y, ray_phi[rays])
        return good & (sign == ray_sign[rays])

    marching = np.flatnonzero(alive)
    k = 0
    while marching.size:
        k += 1
        marching = marching[passes(marching, np.full(marching.shape, k * step))]
        low[marching] = k * step
    rays = np.flatnonzero(alive)
    high = low[rays] + step
    for _ in range(12):
        middle = 0.5 * (low[rays] + high)
        passing = passes(rays, middle)
        low[rays] = np.where(passing, middle, low[rays])
        high = np.where(passing, high, middle)
    radius = low.reshape(144, 36).min(axis=1)
    best = 0.0
    for home in range(144):
        window = np.arange(home - 4, home + 5) % 144
        if (sign[window] == sign[home]).all() and sign[home] != 0:
            best = max(best, radius[window].min())
    return best, poses


def main():
    count = 5184
    for name in ("ID-II", "3-RPR", "3-RRR"):
        design = DESIGNS[name]
        radius = 0.2 * np.sqrt((np.arange(count) + 0.5) / count)
        angle = 2.399963 * np.arange(count)
        start = time.perf_counter()
        good, _ = values(design, radius * np.cos(angle), radius * np.sin(angle), np.full(count, math.radians(30)))
        elapsed = time.perf_counter() - start
        print(f"{design[0]}: {elapsed / count * 1e6:.1f} us per pose ({good.sum()} of {count} feasible)")
    for name, design in DESIGNS.items():
        start = time.perf_counter()
        radius, poses = workspace_radius(design)
        elapsed = time.perf_counter() - start
        print(f"{name} ({design[0]}): R_w {radius:.6f} m, {poses} poses, {elapsed:.2f} s")


if __name__ == "__main__":
    main()
