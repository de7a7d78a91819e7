"""The floor plan's colours."""

INK, SOFT_INK, PAPER = "#232b38", "#667085", "#ffffff"
WALL, ONE_FACE, LINTEL = "#2f3a4c", "#a9b2c1", "#eef0f4"
DOOR, PATH, MARKER = "#b06a1e", "#e4572e", "#c2255c"
GROUND, CORRIDOR = "#f1f4ea", "#f4f1e6"
ROOMS = ("#e3eefb", "#e6f4ea", "#fdeee2", "#efe8f8", "#fbf3d5", "#e0f3f4", "#fae6ec", "#ebf0d9")


def hex_colour(rgb: tuple[int, int, int]) -> str:
    """As SVG writes it."""
    return "#{:02x}{:02x}{:02x}".format(*rgb)
