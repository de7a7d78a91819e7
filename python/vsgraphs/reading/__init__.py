"""Reading what somebody gives us: regular files of a bounded size, and values in messages that stay short."""

from vsgraphs.reading.files import LARGE, SMALL, open_regular, read_bytes, read_head, read_text
from vsgraphs.reading.json_text import parse_json, read_json
from vsgraphs.reading.shown import shortened, shown
from vsgraphs.reading.yaml_text import YAML_LIMIT, YamlNode, parse_yaml, plain_value, read_yaml

__all__ = [
    "LARGE",
    "SMALL",
    "YAML_LIMIT",
    "YamlNode",
    "open_regular",
    "parse_json",
    "parse_yaml",
    "plain_value",
    "read_bytes",
    "read_head",
    "read_json",
    "read_text",
    "read_yaml",
    "shortened",
    "shown",
]
