#!/usr/bin/python3
"""Makes the README's picture: the preview of a bake, made smaller.

    bake.py [ENVIRONMENT]       the committed one is of Poly Haven's "Lebombo" (CC0), 1024 x 512
"""

import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

from pictures import HERE, PROGRAM

with tempfile.TemporaryDirectory() as folder:
    subprocess.run([PROGRAM, "bake", *sys.argv[1:2], "-o", folder, "--levels", "6", "--quiet"], check=True)
    picture = Image.open(pathlib.Path(folder, "preview.png")).convert("RGB")
picture = picture.resize((picture.width * 5 // 8, picture.height * 5 // 8), Image.Resampling.LANCZOS)
picture.save(HERE / "bake.png", optimize=True)
