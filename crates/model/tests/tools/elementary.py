"""Values of elementary functions to 50 digits, with which enclosures of zero width are compared.

    python crates/model/tests/tools/elementary.py > crates/model/tests/fixtures/elementary.json

Each value is stored as two doubles, by their bits, whose sum agrees with it to about 32 digits. The arithmetic is that of Python's decimal module;
sine and cosine are their power series at 80 digits.
"""

import json
import random
import struct
from decimal import Decimal, getcontext

getcontext().prec = 80


def series(x, first):
    term = x if first else Decimal(1)
    total, k = term, first
    while abs(term) > Decimal(10) ** -75:
        term = -term * x * x / ((k + 1) * (k + 2))
        total, k = total + term, k + 2
    return total


def two_doubles(value):
    high = float(value)
    return [bits(high), bits(float(value - Decimal(high)))]


def bits(number):
    return struct.unpack("<Q", struct.pack("<d", number))[0]


random.seed(7)
cases = []
for _ in range(300):
    x = random.choice([1, -1]) * 10 ** random.uniform(-3, 1.2)
    y = 10 ** random.uniform(-6, 6)
    z = random.uniform(-3, 3)
    dx, dy, dz = Decimal(x), Decimal(y), Decimal(z)
    cases.append({
        "x": bits(x),
        "y": bits(y),
        "z": bits(z),
        "sine": two_doubles(series(dx, 1)),
        "cosine": two_doubles(series(dx, 0)),
        "root": two_doubles(dy.sqrt()),
        "reciprocal": two_doubles(1 / dy),
        # Several operations in a row, with a difference of like numbers.
        "chain": two_doubles(((dy * dx + dz) * (dy * dx + dz) + 1).sqrt() / (1 + dz * dz) - dx * dx * dx + dz / dy),
    })
print(json.dumps({"note": "made by crates/model/tests/tools/elementary.py", "cases": cases}))
