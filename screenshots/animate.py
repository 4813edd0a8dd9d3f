"""Joins pictures to an animation: `python animate.py OUT.gif SECONDS PICTURE…` (needs pillow)."""

import sys

from PIL import Image

out, seconds, paths = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
frames = []
for path in paths:
    picture = Image.open(path).convert("RGB")
    picture.thumbnail((1120, 700), Image.Resampling.LANCZOS)
    frames.append(picture.quantize(192, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE))
frames[0].save(out, save_all=True, append_images=frames[1:], duration=int(1000 * seconds), loop=0, optimize=True)
