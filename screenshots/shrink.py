"""Reduces pictures to a palette of 256 colours, a quarter of their size: `python shrink.py PICTURE…` (needs pillow)."""

import sys

from PIL import Image

for path in sys.argv[1:]:
    picture = Image.open(path).convert("RGB")
    picture.quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.FLOYDSTEINBERG).save(path, optimize=True)
