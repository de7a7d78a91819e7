"""Learns the 256 comparisons of brief_pattern.cpp and prints that file.

Run: python core/vision/learn_brief_pattern.py > core/vision/brief_pattern.cpp (numpy and Pillow; about 2
minutes, 3 GB)

Training data are made here, so that anybody gets the same table: "dead leaves" images and views of them
that are turned, scaled, sheared, re-exposed, blurred and noisy. Corners are found and oriented in both
views separately, as the extractor does, so that errors of place, scale and orientation are those a
descriptor meets in use.

Choice: greedy. Each step adds the comparison that best separates the distances of matching patches from
those of others, J = (mean_other - mean_same) / sqrt(var_other + var_same): a comparison is worth the more
the less often it flips between views, and the less it repeats what the chosen ones already say. (Rublee et
al., ICCV 2011, choose by variance and correlation alone; the criterion here is Fisher's, as in Trzcinski et
al., "BinBoost", CVPR 2013.)
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

Floats = NDArray[np.float64]
Bytes = NDArray[np.uint8]

SEED = 20
IMAGES = 20
LEVELS = 6
FACTOR = 1.2
CORNERS = 500  # per image and level 0; fewer above
RADIUS = 14  # comparisons stay inside this disc, px
BORDER = 17
CANDIDATES = 12000
BITS = 256
CIRCLE = [(0, -3), (1, -3), (2, -2), (3, -1), (3, 0), (3, 1), (2, 2), (1, 3)]
CIRCLE += [(-u, -v) for u, v in CIRCLE]


def dead_leaves(rng: np.random.Generator, width: int = 640, height: int = 480) -> Bytes:
    """Grey image (height, width) of overlapping shaded boxes and discs at all sizes."""
    image = np.full((height, width), 128.0)
    for _ in range(width * height // 300):
        size = 3.0 / np.sqrt(rng.uniform(0.002, 1.0))
        u0, v0, turn = rng.uniform(0, width), rng.uniform(0, height), rng.uniform(0, np.pi)
        reach = int(1.5 * size) + 1
        rows = slice(max(0, int(v0) - reach), min(height, int(v0) + reach + 1))
        cols = slice(max(0, int(u0) - reach), min(width, int(u0) + reach + 1))
        dv, du = np.mgrid[rows, cols].astype(float)
        du, dv = du - u0, dv - v0
        x, y = np.cos(turn) * du + np.sin(turn) * dv, np.cos(turn) * dv - np.sin(turn) * du
        aspect = rng.uniform(0.2, 1.0)
        inside = (
            (abs(x) < size) & (abs(y) < aspect * size)
            if rng.random() < 0.6
            else x**2 + (y / aspect) ** 2 < size**2
        )
        shade = rng.uniform(20, 235) + rng.uniform(-1, 1) * du + rng.uniform(-1, 1) * dv
        image[rows, cols][inside] = shade[inside]
    levels: Bytes = np.clip(image, 0, 255).astype(np.uint8)
    return levels


def smooth(image: Floats, taps: list[float]) -> Floats:
    """Separable convolution with edge padding; same shape."""
    reach = len(taps) // 2
    for axis in (0, 1):
        pad = [(reach, reach) if a == axis else (0, 0) for a in (0, 1)]
        padded = np.pad(image, pad, mode="edge")
        size = image.shape[axis]
        shifted = [t * np.take(padded, range(k, k + size), axis=axis) for k, t in enumerate(taps)]
        image = np.sum(shifted, axis=0)
    return image


def camera_view(rng: np.random.Generator, image: Floats) -> Bytes:
    """What a sensor makes of a view: lens and motion blur, exposure, noise."""
    image = smooth(image, [0.15, 0.7, 0.15])
    if rng.random() < 0.5:
        length = rng.integers(2, 5)
        image = np.mean([np.roll(image, k, axis=int(rng.integers(2))) for k in range(length)], axis=0)
    image = 128 + rng.uniform(0.6, 1.3) * (image - 128) + rng.uniform(-25, 25)
    return np.clip(image + rng.normal(0, rng.uniform(1, 5), image.shape), 0, 255).astype(np.uint8)


def fast_scores(image: Bytes, threshold: int = 10) -> NDArray[np.int16]:
    """FAST-9 score per pixel, 0 where below the threshold, within BORDER of an edge, or no 3x3 maximum."""
    grey = image.astype(np.int16)
    inner = (slice(BORDER, image.shape[0] - BORDER), slice(BORDER, image.shape[1] - BORDER))
    around = np.stack([np.roll(grey, (-v, -u), axis=(0, 1))[inner] - grey[inner] for u, v in CIRCLE])
    best = np.zeros(around.shape[1:], np.int16)
    for sign in (1, -1):
        ring = np.concatenate([sign * around, sign * around[:8]])
        for k in range(16):
            best = np.maximum(best, ring[k : k + 9].min(axis=0))
    scores = np.zeros(image.shape, np.int16)
    scores[inner] = np.where(best > threshold, best, 0)
    peak = np.max([np.roll(scores, (v, u), axis=(0, 1)) for u in (-1, 0, 1) for v in (-1, 0, 1)], axis=0)
    return np.where(scores == peak, scores, 0)


DISC15 = np.array([(u, v) for v in range(-15, 16) for u in range(-15, 16) if u * u + v * v <= 15.5**2])
POINTS = np.array([(u, v) for v in range(-RADIUS, RADIUS + 1) for u in range(-RADIUS, RADIUS + 1)
                   if u * u + v * v <= RADIUS**2])  # fmt: skip


def describe(image: Bytes) -> tuple[Floats, NDArray[np.int64], Bytes]:
    """Corners of all levels: positions (n, 2) px at level 0, levels (n), smooth patches (n, POINTS)."""
    places, levels, patches = [], [], []
    for level in range(LEVELS):
        size = (round(image.shape[1] / FACTOR**level), round(image.shape[0] / FACTOR**level))
        small = np.asarray(Image.fromarray(image).resize(size, Image.Resampling.BILINEAR))
        scores = fast_scores(small)
        v, u = np.nonzero(scores)
        best = np.argsort(-scores[v, u], kind="stable")[: round(CORNERS / FACTOR**level)]
        u, v = u[best], v[best]
        disc = small[v[:, None] + DISC15[:, 1], u[:, None] + DISC15[:, 0]].astype(float)
        angle = np.arctan2(disc @ DISC15[:, 1], disc @ DISC15[:, 0])
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        du = np.rint(c * POINTS[:, 0] - s * POINTS[:, 1]).astype(int)
        dv = np.rint(s * POINTS[:, 0] + c * POINTS[:, 1]).astype(int)
        soft = smooth(small.astype(float), [k / 16 for k in (1, 2, 3, 4, 3, 2, 1)])
        patches.append(np.rint(soft[v[:, None] + dv, u[:, None] + du]).astype(np.uint8))
        ratio = np.array(image.shape[::-1]) / size
        places.append((np.stack([u, v], 1) + 0.5) * ratio - 0.5)
        levels.append(np.full(len(u), level))
    return np.concatenate(places), np.concatenate(levels), np.concatenate(patches)


def matching_patches(rng: np.random.Generator, image: Bytes) -> tuple[Bytes, Bytes]:
    """Patches (n, POINTS) of the same corners in two views of one image."""
    turn, scale = rng.uniform(-np.pi, np.pi), np.exp(rng.uniform(-0.3, 0.3))
    shear = np.eye(2) + rng.uniform(-0.12, 0.12, (2, 2))
    linear = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ shear / scale
    centre = np.array(image.shape[::-1]) / 2
    shift = centre - linear @ centre
    whole = Image.fromarray(image)
    matrix = (*linear[0], shift[0], *linear[1], shift[1])
    other = np.asarray(whole.transform(whole.size, Image.Transform.AFFINE, matrix, Image.Resampling.BICUBIC))
    place_a, level_a, patch_a = describe(camera_view(rng, image.astype(float)))
    place_b, level_b, patch_b = describe(camera_view(rng, other.astype(float)))
    back = (place_b + 0.5) @ linear.T + shift - 0.5
    level_shift = np.log(scale) / np.log(FACTOR)
    distance = np.linalg.norm(place_a[:, None] - back[None], axis=2) / FACTOR ** level_a[:, None]
    distance += np.where(abs(level_b[None] - level_a[:, None] - level_shift) <= 1.0, 0, 1e3)
    a = np.arange(len(place_a))
    b = distance.argmin(axis=1)
    good = (distance[a, b] < 1.5) & (distance.argmin(axis=0)[b] == a)
    return patch_a[good], patch_b[b[good]]


def learn(
    rng: np.random.Generator, same_a: Bytes, same_b: Bytes, groups: NDArray[np.int64]
) -> list[tuple[int, int]]:
    """Indices into POINTS of the chosen comparisons."""
    other = np.concatenate([rng.permutation(np.flatnonzero(groups == g)) for g in np.unique(groups)])
    order = np.argsort(groups, kind="stable")
    other_of = np.empty_like(other)
    other_of[order] = other
    pairs: list[tuple[int, int]] = []
    seen: set[frozenset[int]] = set()
    while len(pairs) < CANDIDATES:
        i, j = (int(k) for k in rng.integers(len(POINTS), size=2))
        if np.hypot(*(POINTS[i] - POINTS[j])) < 2 or frozenset((i, j)) in seen:
            continue
        seen.add(frozenset((i, j)))
        pairs.append((i, j))
    first, second = np.array(pairs).T
    bits_a = (same_a[:, first] < same_a[:, second]).T
    bits_b = (same_b[:, first] < same_b[:, second]).T
    same = (bits_a ^ bits_b).astype(np.float32)  # (candidates, pairs): flips between views of one corner
    apart = (bits_a ^ bits_b[:, other_of]).astype(np.float32)
    chosen: list[int] = []
    stats = []
    for flips in (same, apart):
        mean = flips.mean(axis=1)
        stats.append([flips - mean[:, None], mean, flips.var(axis=1)])
    distance = [np.zeros(same.shape[1], np.float32), np.zeros(same.shape[1], np.float32)]
    mean_sum, var_sum = [0.0, 0.0], [0.0, 0.0]
    free = np.ones(len(pairs), bool)
    for _ in range(BITS):
        var = [var_sum[k] + s[2] + 2 * (s[0] @ distance[k]) / same.shape[1] for k, s in enumerate(stats)]
        gap = mean_sum[1] + stats[1][1] - mean_sum[0] - stats[0][1]
        quality = np.where(free, gap / np.sqrt(var[0] + var[1] + 1e-9), -np.inf)
        best = int(quality.argmax())
        free[best] = False
        chosen.append(best)
        for k, s in enumerate(stats):
            mean_sum[k] += float(s[1][best])
            var_sum[k] = float(var[k][best])
            distance[k] += s[0][best]
    sys.stderr.write(
        f"{same.shape[1]} pairs, J = {quality[best]:.3f}, mean {mean_sum[0]:.1f} / {mean_sum[1]:.1f}" + "\n"
    )
    return [pairs[k] for k in chosen]


def main() -> None:
    """Learn the comparisons and write brief_pattern.cpp to standard output."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--images", type=Path, help="folder of photographs to learn from instead")
    arguments = parser.parse_args()
    rng = np.random.default_rng(SEED)
    files = sorted(arguments.images.iterdir())[:IMAGES] if arguments.images else []
    firsts, seconds, groups = [], [], []
    for k in range(IMAGES):
        image = np.asarray(Image.open(files[k]).convert("L")) if files else dead_leaves(rng)
        a, b = matching_patches(rng, image)
        firsts.append(a)
        seconds.append(b)
        groups.append(np.full(len(a), k))
    chosen = learn(rng, np.concatenate(firsts), np.concatenate(seconds), np.concatenate(groups))
    cells = [f"{{{', '.join(str(c) for c in (*POINTS[i], *POINTS[j]))}}}," for i, j in chosen]
    rows = "\n".join("    " + " ".join(cells[k : k + 5]) for k in range(0, BITS, 5))
    sys.stdout.write('#include "core/vision/brief_pattern.h"\n\nnamespace vsgraphs {\n\n')
    sys.stdout.write("// Made by learn_brief_pattern.py; do not edit.\n// clang-format off\n")
    sys.stdout.write("const std::array<BriefPair, 256> brief_pattern{{\n" + rows + "\n}};\n")
    sys.stdout.write("// clang-format on\n\n}  // namespace vsgraphs\n")


if __name__ == "__main__":
    main()
