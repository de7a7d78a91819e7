"""A file of one's own beside the others: `python examples/custom_exporter.py FOLDER RESULTS`.

As a package's entry point it is there for the command line too, see plugin/.
"""

import json
import sys

import vsgraphs


def rooms_geojson(result: vsgraphs.Result) -> dict[str, str]:
    """An exporter: a finished run -> {file name: content}. Coordinates are levelled metres, not degrees."""
    rooms = result.scene_graph.rooms.values() if result.scene_graph else ()
    features = [
        {
            "type": "Feature",
            "properties": {"name": room.name, "area_m2": room.area_m2},
            "geometry": {"type": "Polygon", "coordinates": [[*corners, corners[0]]]},
        }
        for room in rooms
        if (corners := room.polygon[:, :2].tolist())
    ]
    return {"rooms.geojson": json.dumps({"type": "FeatureCollection", "features": features}, indent=1) + "\n"}


def main(folder: str, results: str) -> None:
    """Runs, and says where the file is."""
    result = vsgraphs.run(folder, out=results, exporters=["planes", rooms_geojson])
    print(result.files["rooms.geojson"])


if __name__ == "__main__":
    main(*sys.argv[1:3])
