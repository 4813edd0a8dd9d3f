"""Computes what a number of designs of the reference front can have at most: the best choice, by dynamic programming.

    python -m pip install -r benches/comparison/requirements.txt
    python benches/comparison/limit.py [--designs 100]

The choice is the best one for the hypervolume, once by the mass and once by its logarithm. Both percentages of it are printed,
as `reported.py` prints those of a run.
"""

import argparse
import math

import numpy as np

from compare import ALL, front, hypervolume, reference_front

# The reference mass of the hypervolume [kg].
REFERENCE_MASS = 2000.0


def best(points, count, scale):
    """Returns the choice of `count` points of a staircase that covers the most, with masses on a scale."""
    worth = scale(REFERENCE_MASS) - np.array([scale(mass) for mass, _ in points])
    radii = np.array([radius for _, radius in points])
    # A chosen point covers a strip between its own radius and that of the chosen one before it.
    strips = worth[None, :] * (radii[None, :] - radii[:, None])
    strips[np.tril_indices(len(points))] = -np.inf
    covered, before = worth * radii, []
    for _ in range(count - 1):
        candidates = covered[:, None] + strips
        before.append(candidates.argmax(axis=0))
        covered = candidates.max(axis=0)
    place = int(covered.argmax())
    chosen = [place]
    for places in reversed(before):
        place = int(places[place])
        chosen.append(place)
    return [points[place] for place in reversed(chosen)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--designs", type=int, default=100)
    designs = parser.parse_args().designs
    points = [point[1:] for point in front([(None, *point) for point in reference_front(ALL)])]
    print("| best choice by | mass | log mass |")
    print("|---|---:|---:|")
    for name, scale in [("mass", float), ("log mass", math.log)]:
        chosen = best(points, designs, scale)
        shares = [100 * hypervolume(chosen, logarithmic=kind) / hypervolume(points, logarithmic=kind) for kind in (False, True)]
        print(f"| {name} | {shares[0]:.2f} % | {shares[1]:.2f} % |")


if __name__ == "__main__":
    main()
