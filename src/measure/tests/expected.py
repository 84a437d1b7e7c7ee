"""Prints expected.json: what other implementations say of the pictures of tests/mod.rs.

python3 -m venv venv && venv/bin/pip install numpy==2.4.6 scikit-image==0.26.0 flip-evaluator==1.7
venv/bin/python expected.py > expected.json

numpy for the plain measures, scikit-image for SSIM, the evaluator of FLIP's authors for FLIP.
"""

import json

import flip_evaluator
import numpy as np
from skimage.metrics import structural_similarity

WIDTH, HEIGHT = 48, 32
y, x, c = np.meshgrid(np.arange(HEIGHT), np.arange(WIDTH), np.arange(3), indexing="ij")


def chance(salt):
    index = (y * WIDTH + x) * 3 + c + salt * 100_003
    return ((index * 2654435761) % 2**32 >> 8) / 2**24


def pictures():
    """Reference, picture, variance of the reference."""
    truth = x / 48 * (y + 4) / 36 * (0.25 + 0.375 * c) + 0.25 * ((x // 8 + y // 8) % 2)
    truth = np.where(x < 4, 0, truth)
    truth = np.where((36 <= x) & (x < 40) & (8 <= y) & (y < 12), 6 + c, truth).astype(np.float32)
    test = truth.astype(float) * (0.875 + 0.25 * chance(1)) + 0.03125 * chance(2)
    test = np.where((x == 20) & (y == 10), 20 + c, test).astype(np.float32)
    variance = ((truth.astype(float) + 0.125) * chance(3) / 64).astype(np.float32)
    return truth, test, variance


def shown(picture, curve, exposure):
    v = np.maximum(picture.astype(float) * 2.0**exposure, 0)
    v = {"clip": np.minimum(v, 1), "reinhard": v / (1 + v)}[curve]
    v = np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)
    return np.floor(v * 255 + 0.5).astype(np.uint8)


def measures(truth, test, variance, mask, curve, exposure):
    a, b = shown(test, curve, exposure), shown(truth, curve, exposure)
    # Windows that lie wholly inside, as structural_similarity's own mean has them.
    _, similarity = structural_similarity(
        b, a, data_range=255, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, channel_axis=2, full=True
    )
    coded = [np.repeat(p, 3 // p.shape[2], axis=2).astype(np.float32) / 255 for p in (b, a)]
    flip = flip_evaluator.evaluate(*coded, "LDR", inputsRGB=True, applyMagma=False)[0].reshape(HEIGHT, WIDTH)
    t, r, v = (p.astype(float) for p in (test, truth, variance))
    below = r**2 + 0.01 * r.mean() ** 2
    t, r, v, below = (p[mask] for p in (t, r, v, below))
    relative = (t - r) ** 2 / below
    kept = np.sort(relative.mean(axis=1))[: len(relative) - len(relative) // 1000]
    size = np.abs(t) + np.abs(r)
    noise = (v / below).mean()
    return {
        "rmse": np.sqrt(((t - r) ** 2).mean()),
        "relmse": relative.mean(),
        "relmse_trimmed": kept.mean(),
        "relmse_above_noise": max(0, relative.mean() - noise),
        "noise": noise,
        "smape": np.where(size > 0, 2 * np.abs(t - r) / np.where(size > 0, size, 1), 0).mean(),
        "bias": t.mean() / r.mean(),
        "ssim": similarity[5:-5, 5:-5].mean(axis=2)[mask[5:-5, 5:-5]].mean(),
        "flip": flip[mask].astype(float).mean(),
    }


cases = []
every = np.full((HEIGHT, WIDTH), True)
left = (x + y)[:, :, 0] < 30
for channels, masked, curve, exposure in [
    (3, False, "clip", 0),
    (3, True, "clip", 0),
    (3, False, "reinhard", 1.5),
    (1, False, "clip", 0),
]:
    found = measures(*(p[:, :, :channels] for p in pictures()), left if masked else every, curve, exposure)
    found = {name: float(value) for name, value in found.items()}
    case = {"channels": channels, "masked": masked, "curve": curve, "exposure": exposure, "errors": found}
    cases.append(case)
print(json.dumps(cases, indent=1))
