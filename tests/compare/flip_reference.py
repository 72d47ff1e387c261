#!/usr/bin/env python3
"""Prints the numbers with which metrics_test.cpp compares FLIP: those of the authors' own program (PyPI: flip-evaluator, numpy) on the same pictures.

Made with flip-evaluator 1.7. Run it again after a change of the pictures and copy what it prints.
"""

import numpy as np
from flip_evaluator import evaluate

WIDTH, HEIGHT = 96, 64


def pictures():
    """Waves, and noise in [0, 1) of a linear congruential generator (Numerical Recipes), channels fastest, then x, then y."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.float64)
    waves = np.stack([0.5 + 0.4 * np.sin(0.31 * x + 0.17 * y + c) * np.cos(0.07 * x * (c + 1) - 0.05 * y) for c in range(3)], -1)
    state, noise = 1, np.empty(WIDTH * HEIGHT * 3)
    for i in range(noise.size):
        state = (1664525 * state + 1013904223) % 2**32
        noise[i] = state / 2**32
    return waves, noise.reshape(HEIGHT, WIDTH, 3)


waves, noise = pictures()
reference, test = np.clip(waves, 0, 1).astype(np.float32), np.clip(waves + 0.3 * (noise - 0.5), 0, 1).astype(np.float32)
for ppd in (67.0206, 30.0, 120.0):
    error, mean, _ = evaluate(reference, test, "LDR", applyMagma=False, parameters={"ppd": ppd})
    print(f"ppd {ppd}: mean {mean:.9f}, at (20, 10) {error[10, 20, 0]:.7f}, at (95, 63) {error[63, 95, 0]:.7f}")

reference = 8 * waves**4 + 0.02
test = reference * (0.7 + 0.6 * noise)
reference[30:33, 40:43] *= 200
test[30:33, 40:43] *= 150
error, mean, used = evaluate(reference.astype(np.float32), test.astype(np.float32), "HDR", applyMagma=False)
print(f"HDR: mean {mean:.9f}, at (20, 10) {error[10, 20, 0]:.7f}, at (41, 31) {error[31, 41, 0]:.7f}, {used}")
