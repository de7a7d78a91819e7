"""What the shell offers when Tab is pressed. `vsgraphs --install-completion` sets it up."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path


def option_keys(incomplete: str) -> list[str]:
    """Of `config explain`: keys of options."""
    from vsgraphs.cli.show_config import described

    return [option["key"] for option in described() if option["key"].startswith(incomplete)]


def assignments(incomplete: str) -> list[tuple[str, str]]:
    """Of --set: `key=` with its meaning, then the values that are possible."""
    from vsgraphs.cli.show_config import described

    key, equals, value = incomplete.partition("=")
    options = described()
    if not equals:
        return [(f"{o['key']}=", str(o["meaning"])) for o in options if o["key"].startswith(key)]
    found = next((option for option in options if option["key"] == key), None)
    if found is None:
        return []
    values = list(found["allowed"]) or (["true", "false"] if found["type"] == "bool" else [])
    return [(f"{key}={v}", str(found["meaning"])) for v in values if str(v).startswith(value)]


def config_words(incomplete: str) -> list[str]:
    """Of `config`: its one word, and groups of options."""
    groups = dict.fromkeys(key.partition(".")[0] for key in option_keys(""))
    return [word for word in ("explain", *groups) if word.startswith(incomplete)]


def cameras(incomplete: str) -> list[str]:
    """Of --camera: known names, and files as the shell would."""
    from vsgraphs.datasets import CAMERAS

    return [name for name in CAMERAS if name.startswith(incomplete)] or _files(incomplete)


def sources(incomplete: str) -> list[str]:
    """Of `run`: folders as the shell would, and what plug-ins' sources are called."""
    from vsgraphs.plugins import plugins

    named = [f"{name}:" for name in plugins("source") if name.startswith(incomplete)]
    return named + [name for name in _files(incomplete) if name.endswith("/")]


def exporters(incomplete: str) -> list[str]:
    """Of `export` and `run --export`: those of the program and of plug-ins."""
    from vsgraphs.plugins import plugins
    from vsgraphs.run.exporters import BUILT_IN

    return [name for name in sorted({*BUILT_IN, *plugins("exporter")}) if name.startswith(incomplete)]


def plans(incomplete: str) -> list[str]:
    """Of `simulate`: plans that come with the package, and files as the shell would."""
    from vsgraphs.plans.load import plan_names

    return [name for name in plan_names() if name.startswith(incomplete)] or _files(incomplete)


def _files(incomplete: str) -> list[str]:
    start = Path(incomplete) if incomplete.endswith("/") else Path(incomplete or ".").parent
    if not start.is_dir():
        return []
    named = [f"{path}/" if path.is_dir() else str(path) for path in sorted(start.iterdir())]
    return [name for name in named if name.startswith(incomplete)]


def chosen_from(*values: str) -> Callable[[str], list[str]]:
    """A completion that offers these."""

    def complete(incomplete: str) -> list[str]:
        return [value for value in values if value.startswith(incomplete)]

    return complete
