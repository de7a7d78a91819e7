#!/usr/bin/env python3
"""Writes python/vsgraphs/scene_graph/scene_graph.schema.json anew, after a kind of node came or changed."""

from __future__ import annotations

from pathlib import Path

from vsgraphs.scene_graph.schema_document import schema_text

PATH = Path(__file__).parents[1] / "python/vsgraphs/scene_graph/scene_graph.schema.json"

if __name__ == "__main__":
    PATH.write_text(schema_text(), encoding="utf-8")
