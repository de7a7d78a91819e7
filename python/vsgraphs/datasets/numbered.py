"""Folders of images named by frame number, as several formats have them."""

from __future__ import annotations

import re
from pathlib import Path

from vsgraphs.errors import InputError

_NAME = re.compile(r"(?:[A-Za-z]+[-_]?)?(\d+)\.(?:jpg|jpeg|png)$", re.IGNORECASE)


def numbered_images(folder: Path) -> dict[int, Path]:
    """Frame number -> image, in ascending order; other files are not looked at. Raises InputError."""
    try:
        entries = sorted(folder.iterdir())
    except OSError as error:
        raise InputError(f"cannot read {folder}: {error.strerror or error}") from None
    found = {int(match[1]): path for path in entries if (match := _NAME.match(path.name))}
    return dict(sorted(found.items()))


def pair_by_number(colour: Path, depth: Path) -> tuple[list[tuple[int, Path, Path]], list[str]]:
    """(number, colour image, depth image) of the numbers both folders have, and what was left out.

    Raises InputError when a folder holds no numbered image or they have no number in common.
    """
    images = {folder: numbered_images(folder) for folder in (colour, depth)}
    for folder, found in images.items():
        if not found:
            raise InputError(f"{folder} holds no images named by frame number, as 0.jpg or 000000.png")
    both = [number for number in images[colour] if number in images[depth]]
    if not both:
        raise InputError(
            f"{colour} (from {min(images[colour])}) and {depth} (from {min(images[depth])}) have no frame "
            "number in common"
        )
    warnings = []
    for folder, other in ((colour, depth), (depth, colour)):
        alone = len(images[folder]) - len(both)
        if alone:
            warnings.append(
                f"{folder.name}: {alone} of {len(images[folder])} images have no partner in {other.name}, "
                "left out"
            )
    return [(number, images[colour][number], images[depth][number]) for number in both], warnings
