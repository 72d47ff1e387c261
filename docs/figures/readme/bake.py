#!/usr/bin/python3
"""Makes the README's picture: the preview of a bake with default options, made smaller.

    bake.py [ENVIRONMENT]       the committed one is of Poly Haven's "Lebombo" (CC0), 1024 x 512
"""

import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from pictures import HERE, PROGRAM  # noqa: E402

with tempfile.TemporaryDirectory() as folder:
    subprocess.run([PROGRAM, "bake", *sys.argv[1:2], "-o", folder, "--quiet"], check=True)
    picture = Image.open(pathlib.Path(folder, "preview.png")).convert("RGB")
picture = picture.resize((picture.width * 5 // 8, picture.height * 5 // 8), Image.Resampling.LANCZOS)
picture.save(HERE / "readme/bake.png", optimize=True)
